/* A program that comes over the panel in chunks. */
#include "panel_bench.h"

/* One request of function 16: offset, length, check, bytes. */
static enum modbus_exception send_chunk(uint32_t offset, const char *bytes, uint16_t size,
                                        uint16_t check)
{
    uint8_t chunk[8 + PANEL_CHUNK_MAX] = {0};

    modbus_write16(chunk, (uint16_t)(offset >> 16));
    modbus_write16(chunk + 2, (uint16_t)offset);
    modbus_write16(chunk + 4, size);
    modbus_write16(chunk + 6, check);
    memcpy(chunk + 8, bytes, size);
    return write_words(&one, takt_panel_registers[REGISTER_UPLOAD_OFFSET].address,
                       MODBUS_WRITE_WORDS_MAX, chunk);
}

static enum modbus_exception send_good(uint32_t offset, const char *bytes)
{
    const uint16_t size = (uint16_t)strlen(bytes);

    return send_chunk(offset, bytes, size, takt_crc16((const uint8_t *)bytes, size));
}

static const char program[] = "G21 G90\nG1 X10 F600\nM2\n";

static uint32_t program_crc(void)
{
    return takt_crc32_add(CRC32_START, program, sizeof program - 1);
}

static void test_a_program_is_brought_in_chunks_and_committed(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin(sizeof program - 1, program_crc()));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, send_good(0, "G21 G90\n"));
    TEST_ASSERT_EQUAL_INT64(8, value_of(&one, REGISTER_UPLOAD_RECEIVED));
    TEST_ASSERT_EQUAL_INT64(PANEL_UPLOAD_OPEN, value_of(&one, REGISTER_UPLOAD_STATE));
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, send_good(8, program + 8));
    TEST_ASSERT_EQUAL_INT64(PANEL_UPLOAD_WHOLE, value_of(&one, REGISTER_UPLOAD_STATE));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_MEMORY(program, stored, sizeof program - 1);
    TEST_ASSERT_EQUAL_UINT(1, prepared);
    TEST_ASSERT_EQUAL_UINT(1, placed);
    TEST_ASSERT_EQUAL_UINT(3, ordered.count);
    TEST_ASSERT_EQUAL_INT64(sizeof program - 1, ordered.item[0].value);
    TEST_ASSERT_EQUAL_INT64(program_crc(), ordered.item[1].value);
    TEST_ASSERT_EQUAL_INT64(PANEL_UPLOAD_NONE, value_of(&one, REGISTER_UPLOAD_STATE));
}

static void test_an_upload_goes_on_where_it_was_left(void)
{
    (void)begin(sizeof program - 1, program_crc());
    (void)send_good(0, "G21 G90\n");
    takt_panel_client_leave(&one);
    takt_panel_client_enter(&one, &panel);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin(sizeof program - 1, program_crc()));
    TEST_ASSERT_EQUAL_INT64(8, value_of(&one, REGISTER_UPLOAD_RECEIVED));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin(5, 5));
    TEST_ASSERT_EQUAL_INT64(0, value_of(&one, REGISTER_UPLOAD_RECEIVED));
}

static void test_a_chunk_may_be_repeated_but_not_left_out(void)
{
    (void)begin(sizeof program - 1, program_crc());
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, send_good(1, "21 G90"));
    (void)send_good(0, "G21 G90\n");
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, send_good(0, "G21 G90\n"));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, send_good(4, program + 4));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_MEMORY(program, stored, sizeof program - 1);
}

static void test_a_chunk_with_a_wrong_check_changes_nothing(void)
{
    (void)begin(sizeof program - 1, program_crc());
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, send_chunk(0, "G21", 3, 1));
    TEST_ASSERT_EQUAL_INT64(0, value_of(&one, REGISTER_UPLOAD_RECEIVED));
    TEST_ASSERT_EQUAL_INT64(0, value_of(&one, REGISTER_UPLOAD_LENGTH));
}

static void test_a_chunk_beyond_the_announced_size_is_refused(void)
{
    (void)begin(4, 0);
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, send_good(0, "G21 G90"));
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE,
                          (write_row(&one, REGISTER_UPLOAD_COMMAND, 3), send_good(0, "G21")));
}

static void test_bytes_that_are_not_those_announced_are_no_program(void)
{
    (void)begin(3, 12345);
    (void)send_good(0, "G21");
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_UINT(0, orders + prepared + placed);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin(3, 12345));
    TEST_ASSERT_EQUAL_INT64(0, value_of(&one, REGISTER_UPLOAD_RECEIVED));
}

static void test_a_commit_that_the_controller_refuses_keeps_the_upload(void)
{
    (void)begin(sizeof program - 1, program_crc());
    (void)send_good(0, program);
    verdict = PANEL_WRONG_STATE;
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_UINT(0, placed);
    verdict = PANEL_DONE;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_UINT(1, placed);
}

static void test_a_program_for_which_there_is_no_room_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, begin(sizeof stored + 1, 0));
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, begin(PANEL_PROGRAM_BYTES_MAX + 1, 0));
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, begin(0, 0));
}

static void test_a_stream_begins_in_idle_alone(void)
{
    for (unsigned state = 0; state < PANEL_STATES; state++) {
        if (state == PANEL_IDLE)
            continue;
        shown.value[REGISTER_STATE] = state;
        TEST_ASSERT_EQUAL_INT(MODBUS_STATE, begin_by(PANEL_UPLOAD_STREAM, 20, 1));
    }
    TEST_ASSERT_EQUAL_UINT(0, streams + orders);
    shown.value[REGISTER_STATE] = PANEL_IDLE;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin_by(PANEL_UPLOAD_STREAM, 20, 1));
}

static void test_a_stream_that_the_controller_does_not_take_is_not_open(void)
{
    verdict = PANEL_TRY_AGAIN;
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, begin_by(PANEL_UPLOAD_STREAM, 20, 1));
    TEST_ASSERT_EQUAL_INT64(PANEL_UPLOAD_NONE, value_of(&one, REGISTER_UPLOAD_STATE));
    TEST_ASSERT_EQUAL_UINT(1, ended);
}

static void test_no_other_upload_ends_a_stream_that_runs(void)
{
    (void)begin_by(PANEL_UPLOAD_STREAM, 20, 1);
    for (unsigned state = PANEL_RUNNING; state <= PANEL_STOPPING; state++) {
        shown.value[REGISTER_STATE] = state;
        TEST_ASSERT_EQUAL_INT(MODBUS_STATE, begin(30, 2));
        for (int64_t kind = PANEL_UPLOAD_SETTINGS; kind <= PANEL_UPLOAD_PLAN; kind++) {
            TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_KIND, kind));
            TEST_ASSERT_TRUE(begin(30, 2) != MODBUS_GOOD);
            TEST_ASSERT_TRUE(begin_by(PANEL_UPLOAD_STREAM, 30, 2) != MODBUS_GOOD);
        }
        (void)write_row(&one, REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PROGRAM);
    }
    TEST_ASSERT_EQUAL_UINT(0, ended);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, begin(20, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, send_good(0, "G21 G90\n"));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_COMMAND, 3));
    TEST_ASSERT_EQUAL_UINT(1, ended);
}

static void test_nothing_is_stored_while_a_program_cannot_be_taken(void)
{
    (void)begin(sizeof program - 1, program_crc());
    (void)send_good(0, program);
    shown.value[REGISTER_STATE] = PANEL_RUNNING;
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_UINT(0, prepared + orders);
}

static void test_a_program_that_cannot_be_kept_leaves_the_one_before(void)
{
    shown.value[REGISTER_PROGRAM_SIZE] = 77;
    shown.value[REGISTER_PROGRAM_CRC] = 88;
    (void)begin(sizeof program - 1, program_crc());
    (void)send_good(0, program);
    no_place = true;
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
    TEST_ASSERT_EQUAL_UINT(2, orders);
    TEST_ASSERT_EQUAL_UINT(3, ordered.count);
    TEST_ASSERT_EQUAL_INT64(77, ordered.item[0].value);
    TEST_ASSERT_EQUAL_INT64(88, ordered.item[1].value);
    no_place = false;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_UPLOAD_COMMAND, 2));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_program_is_brought_in_chunks_and_committed);
    RUN_TEST(test_an_upload_goes_on_where_it_was_left);
    RUN_TEST(test_a_chunk_may_be_repeated_but_not_left_out);
    RUN_TEST(test_a_chunk_with_a_wrong_check_changes_nothing);
    RUN_TEST(test_a_chunk_beyond_the_announced_size_is_refused);
    RUN_TEST(test_bytes_that_are_not_those_announced_are_no_program);
    RUN_TEST(test_a_commit_that_the_controller_refuses_keeps_the_upload);
    RUN_TEST(test_a_program_for_which_there_is_no_room_is_refused);
    RUN_TEST(test_a_stream_begins_in_idle_alone);
    RUN_TEST(test_a_stream_that_the_controller_does_not_take_is_not_open);
    RUN_TEST(test_no_other_upload_ends_a_stream_that_runs);
    RUN_TEST(test_nothing_is_stored_while_a_program_cannot_be_taken);
    RUN_TEST(test_a_program_that_cannot_be_kept_leaves_the_one_before);
    return UNITY_END();
}
