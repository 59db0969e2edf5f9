
#include "panel_bench.h"

static bool is_number(const struct panel_register *row)
{
    return row->form != PANEL_TEXT && row->form != PANEL_BYTES;
}

static void test_rows_stand_in_order_and_do_not_overlap(void)
{
    for (unsigned i = 1; i < REGISTER_COUNT; i++) {
        const struct panel_register *before = &takt_panel_registers[i - 1],
                                    *row = &takt_panel_registers[i];

        TEST_ASSERT_TRUE_MESSAGE(
            row->table > before->table ||
                (row->table == before->table && row->address >= before->address + before->words),
            panel_text(row)->name);
    }
}

static void test_every_row_is_found_by_each_address_and_by_its_name(void)
{
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];

        for (unsigned k = 0; k < row->words; k++)
            TEST_ASSERT_EQUAL_UINT(i, takt_panel_find(row->table, (uint16_t)(row->address + k)));
        TEST_ASSERT_EQUAL_UINT(i, takt_panel_find_name(panel_text(row)->name));
    }
    TEST_ASSERT_EQUAL_UINT(REGISTER_FEED_OVERRIDE, takt_panel_find_name("feed_override"));
    TEST_ASSERT_EQUAL_UINT(REGISTER_COUNT, takt_panel_find_name("FEED"
                                                                "_OVERRIDES"));
    TEST_ASSERT_EQUAL_UINT(REGISTER_COUNT, takt_panel_find(MODBUS_COILS, 40000));
}

static void test_an_order_has_room_for_all_that_one_request_can_write(void)
{
    unsigned rows[3] = {0};

    for (unsigned i = 0; i < REGISTER_COUNT; i++)
        rows[takt_panel_registers[i].table] += takt_panel_registers[i].states != PANEL_NEVER;
    TEST_ASSERT_TRUE(rows[MODBUS_COILS] <= PANEL_ORDER_MAX);
    TEST_ASSERT_TRUE(rows[MODBUS_HOLDINGS] <= PANEL_ORDER_MAX);
}

/* The server's own requests are as long as a mailbox: one function 16. */
static void test_the_mailbox_is_one_request_long(void)
{
    const struct panel_register *bytes = &takt_panel_registers[REGISTER_UPLOAD_DATA];

    TEST_ASSERT_EQUAL_UINT(MODBUS_WRITE_WORDS_MAX,
                           bytes->address + bytes->words -
                               takt_panel_registers[REGISTER_UPLOAD_OFFSET].address);
}

/* Registers that are the panel's own, and not the controller's. */
static bool is_own(enum panel_id id)
{
    return id == REGISTER_VERSION || id == REGISTER_CONTROL || id == REGISTER_REFUSAL ||
           id == REGISTER_PASSWORD || id == REGISTER_PROGRAM_MAX || id == REGISTER_UPLOAD_STATE ||
           id == REGISTER_UPLOAD_RECEIVED || id == REGISTER_UPLOAD_ROOM ||
           (id >= REGISTER_UPLOAD_SIZE && id <= REGISTER_UPLOAD_CHECK);
}

static void test_every_value_of_the_snapshot_is_read_back(void)
{
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];
        const enum panel_id id = (enum panel_id)i;

        if (!is_number(row) || id == REGISTER_STATE)
            continue;
        shown.value[i] = row->form == PANEL_BIT   ? 1
                         : row->form == PANEL_S32 ? (uint32_t)-1234567
                                                  : 54321;
    }
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];
        const enum panel_id id = (enum panel_id)i;
        const int64_t value = is_number(row) ? value_of(&one, id) : panel_value(&shown, id);

        if (!is_own(id))
            TEST_ASSERT_EQUAL_INT64_MESSAGE(panel_value(&shown, id), value, panel_text(row)->name);
    }
}

static void test_the_text_of_an_alarm_is_read_two_characters_a_word(void)
{
    memcpy(shown.alarm_text, "axis X lags", sizeof "axis X lags");
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, read_row(&one, REGISTER_ALARM_TEXT));
    TEST_ASSERT_EQUAL_STRING("axis X lags", (const char *)data);
}

/* Of a table, from this address on: the first that is no row's. */
static uint16_t free_address(enum modbus_table table, uint16_t address)
{
    while (takt_panel_find(table, address) != REGISTER_COUNT)
        address++;
    return address;
}

static void test_addresses_that_are_not_there_are_exception_2(void)
{
    const struct modbus_map map = takt_panel_client_map(&one);
    const uint16_t coil =
        free_address(MODBUS_COILS, takt_panel_registers[REGISTER_SETUP_TAKE].address);
    const uint16_t gap = free_address(MODBUS_HOLDINGS, 0);

    TEST_ASSERT_EQUAL_INT(MODBUS_ADDRESS, map.read(map.context, MODBUS_COILS, coil, 1, data));
    TEST_ASSERT_EQUAL_INT(MODBUS_ADDRESS, map.read(map.context, MODBUS_INPUTS, 399, 2, data));
    TEST_ASSERT_EQUAL_INT(MODBUS_ADDRESS, map.read(map.context, MODBUS_HOLDINGS, 420, 1, data));
    TEST_ASSERT_EQUAL_INT(MODBUS_ADDRESS, map.write(map.context, MODBUS_HOLDINGS, gap, 1, data));
    TEST_ASSERT_EQUAL_INT(MODBUS_ADDRESS, map.write(map.context, MODBUS_INPUTS, 0, 1, data));
    TEST_ASSERT_EQUAL_INT64(PANEL_REFUSAL_ADDRESS, value_of(&one, REGISTER_REFUSAL));
    TEST_ASSERT_EQUAL_INT64(PANEL_REFUSAL_NONE, value_of(&other, REGISTER_REFUSAL));
}

static bool is_order(enum panel_id id)
{
    return id != REGISTER_PASSWORD && !(id >= REGISTER_UPLOAD_SIZE && id <= REGISTER_MDI_TEXT);
}

static void test_every_number_is_ordered_within_its_range_and_refused_outside(void)
{
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];
        const enum panel_id id = (enum panel_id)i;

        if (row->states == PANEL_NEVER || !is_number(row) || !is_order(id))
            continue;
        shown.value[REGISTER_WATCHDOG] = 0;
        shown.value[REGISTER_STATE] = PANEL_IDLE;
        if (!takt_panel_may_write(id, PANEL_IDLE))
            shown.value[REGISTER_STATE] = PANEL_HELD;
        TEST_ASSERT_EQUAL_INT_MESSAGE(MODBUS_GOOD, write_row(&one, id, panel_most(row)),
                                      panel_text(row)->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MODBUS_GOOD, write_row(&one, id, takt_panel_least(row)),
                                      panel_text(row)->name);
        TEST_ASSERT_EQUAL_UINT(1, ordered.count);
        TEST_ASSERT_EQUAL_INT(id, ordered.item[0].id);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(takt_panel_least(row), ordered.item[0].value,
                                        panel_text(row)->name);
        orders = 0;
        if (row->form == PANEL_U16 && panel_most(row) < PANEL_U16_MOST)
            TEST_ASSERT_EQUAL_INT_MESSAGE(MODBUS_VALUE, write_row(&one, id, panel_most(row) + 1),
                                          panel_text(row)->name);
        if (row->form != PANEL_BIT && takt_panel_least(row) > 0)
            TEST_ASSERT_EQUAL_INT_MESSAGE(MODBUS_VALUE,
                                          write_row(&one, id, takt_panel_least(row) - 1),
                                          panel_text(row)->name);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, orders, panel_text(row)->name);
    }
}

static void test_the_table_says_in_which_states_a_register_is_written(void)
{
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];
        const enum panel_id id = (enum panel_id)i;

        if (row->states == PANEL_NEVER || !is_number(row) || !is_order(id))
            continue;
        for (unsigned state = 0; state < PANEL_STATES; state++) {
            const bool allowed = (row->states & PANEL_IN(state)) != 0;

            shown.value[REGISTER_STATE] = state;
            shown.value[REGISTER_WATCHDOG] = 0;
            TEST_ASSERT_EQUAL_INT_MESSAGE(allowed ? MODBUS_GOOD : MODBUS_STATE,
                                          write_row(&one, id, panel_most(row)),
                                          panel_text(row)->name);
        }
    }
}

static void test_a_request_is_ordered_as_a_whole_or_not_at_all(void)
{
    /* FEED_OVERRIDE 50 %, RAPID_OVERRIDE 25 %, and a SPINDLE_OVERRIDE out of range, then in it */
    uint8_t bytes[] = {0x01, 0xF4, 0x00, 0xFA, 0x00, 0x01};

    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_words(&one, 0, 3, bytes));
    TEST_ASSERT_EQUAL_UINT(0, orders);
    bytes[4] = 0x03;
    bytes[5] = 0xE8;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_words(&one, 0, 3, bytes));
    TEST_ASSERT_EQUAL_UINT(1, orders);
    TEST_ASSERT_EQUAL_UINT(3, ordered.count);
    TEST_ASSERT_EQUAL_INT64(250, ordered.item[1].value);
}

static void test_half_a_number_is_not_written(void)
{
    static const uint8_t bytes[] = {0, 1};
    const uint16_t address = takt_panel_registers[REGISTER_JOG_DISTANCE].address;

    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_words(&one, address, 1, bytes));
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_words(&one, (uint16_t)(address + 1), 1, bytes));
    TEST_ASSERT_EQUAL_UINT(0, orders);
}

static void test_what_the_controller_refuses_is_the_exception(void)
{
    verdict = PANEL_WRONG_STATE;
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_FEED_OVERRIDE, 500));
    verdict = PANEL_WRONG_VALUE;
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_row(&one, REGISTER_FEED_OVERRIDE, 500));
    verdict = PANEL_TRY_AGAIN;
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_row(&one, REGISTER_FEED_OVERRIDE, 500));
    TEST_ASSERT_EQUAL_INT64(PANEL_REFUSAL_BUSY, value_of(&one, REGISTER_REFUSAL));
}

static void test_the_password_unlocks_one_client(void)
{
    start_with(4711);
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_MODE, 1));
    TEST_ASSERT_EQUAL_INT64(PANEL_REFUSAL_LOCKED, value_of(&one, REGISTER_REFUSAL));
    TEST_ASSERT_EQUAL_INT(MODBUS_VALUE, write_row(&one, REGISTER_PASSWORD, 4712));
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_MODE, 1));
    TEST_ASSERT_EQUAL_UINT(0, orders);
    shown.value[REGISTER_CYCLES] += 1000;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_PASSWORD, 4711));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_MODE, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&other, REGISTER_MODE, 2));
    TEST_ASSERT_EQUAL_INT64(0, value_of(&one, REGISTER_PASSWORD));
}

static void test_anybody_may_hold_the_feed_and_stop(void)
{
    start_with(4711);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_FEED_HOLD, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_EMERGENCY_STOP, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_STATE, write_row(&one, REGISTER_EMERGENCY_STOP, 0));
    TEST_ASSERT_EQUAL_UINT(2, orders);
}

static void test_whoever_claims_control_is_the_only_one_to_write(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_WATCHDOG, 500));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_MODE, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_row(&other, REGISTER_MODE, 2));
    TEST_ASSERT_EQUAL_INT64(PANEL_REFUSAL_CONTROL, value_of(&other, REGISTER_REFUSAL));
    TEST_ASSERT_EQUAL_INT64(PANEL_CONTROL_MINE, value_of(&one, REGISTER_CONTROL));
    TEST_ASSERT_EQUAL_INT64(PANEL_CONTROL_OTHER, value_of(&other, REGISTER_CONTROL));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&other, REGISTER_FEED_HOLD, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_WATCHDOG, 0));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&other, REGISTER_MODE, 2));
    TEST_ASSERT_EQUAL_INT64(PANEL_CONTROL_FREE, value_of(&one, REGISTER_CONTROL));
}

/* WATCHDOG and PASSWORD are neighbours. */
static void test_a_password_does_not_take_control_from_another(void)
{
    uint8_t words[6] = {0x0B, 0xB8, 0, 0, 0, 0};

    (void)write_row(&one, REGISTER_WATCHDOG, 500);
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_words(&other, 36, 3, words));
    TEST_ASSERT_EQUAL_INT64(PANEL_CONTROL_MINE, value_of(&one, REGISTER_CONTROL));
    TEST_ASSERT_EQUAL_INT64(500, shown.value[REGISTER_WATCHDOG]);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&other, REGISTER_PASSWORD, 0));
}

static void test_each_request_of_the_panel_in_control_is_a_sign_of_life(void)
{
    (void)value_of(&one, REGISTER_STATE);
    TEST_ASSERT_EQUAL_UINT(0, alive);
    (void)write_row(&one, REGISTER_WATCHDOG, 500);
    alive = 0;
    (void)value_of(&one, REGISTER_STATE);
    (void)write_row(&one, REGISTER_FEED_OVERRIDE, 65535);
    TEST_ASSERT_EQUAL_UINT(2, alive);
    (void)value_of(&other, REGISTER_STATE);
    TEST_ASSERT_EQUAL_UINT(2, alive);
}

static void test_control_of_a_client_that_has_left_stays_until_the_watchdog_bites(void)
{
    (void)write_row(&one, REGISTER_WATCHDOG, 500);
    takt_panel_client_leave(&one);
    takt_panel_client_enter(&one, &panel);
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_row(&one, REGISTER_MODE, 1));
    shown.value[REGISTER_WATCHDOG] = 0;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_MODE, 1));
}

static void test_a_line_goes_to_the_controller_with_its_start(void)
{
    static const uint8_t text[] = "G1 X5 F100\0";

    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_words(&one, 300, 6, text));
    TEST_ASSERT_EQUAL_UINT(0, orders);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_MDI_START, 1));
    TEST_ASSERT_EQUAL_STRING("G1 X5 F100", ordered.mdi);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, read_row(&one, REGISTER_MDI_TEXT));
    TEST_ASSERT_EQUAL_STRING("G1 X5 F100", (const char *)data);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_stand_in_order_and_do_not_overlap);
    RUN_TEST(test_every_row_is_found_by_each_address_and_by_its_name);
    RUN_TEST(test_an_order_has_room_for_all_that_one_request_can_write);
    RUN_TEST(test_the_mailbox_is_one_request_long);
    RUN_TEST(test_every_value_of_the_snapshot_is_read_back);
    RUN_TEST(test_the_text_of_an_alarm_is_read_two_characters_a_word);
    RUN_TEST(test_addresses_that_are_not_there_are_exception_2);
    RUN_TEST(test_every_number_is_ordered_within_its_range_and_refused_outside);
    RUN_TEST(test_the_table_says_in_which_states_a_register_is_written);
    RUN_TEST(test_a_request_is_ordered_as_a_whole_or_not_at_all);
    RUN_TEST(test_half_a_number_is_not_written);
    RUN_TEST(test_what_the_controller_refuses_is_the_exception);
    RUN_TEST(test_the_password_unlocks_one_client);
    RUN_TEST(test_anybody_may_hold_the_feed_and_stop);
    RUN_TEST(test_whoever_claims_control_is_the_only_one_to_write);
    RUN_TEST(test_a_password_does_not_take_control_from_another);
    RUN_TEST(test_each_request_of_the_panel_in_control_is_a_sign_of_life);
    RUN_TEST(test_control_of_a_client_that_has_left_stays_until_the_watchdog_bites);
    RUN_TEST(test_a_line_goes_to_the_controller_with_its_start);
    return UNITY_END();
}
