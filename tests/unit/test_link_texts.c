/*
 * The text forms of frames: SLCAN, socketcand, candump. What one end writes the other reads; what
 * nobody would write is refused; no bytes at all do harm.
 */
#include "bus/candump.h"
#include "bus/candump_read.h"
#include "link/slcan.h"
#include "link/socketcand.h"
#include "random_frame.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES 20000

static uint64_t state;

void setUp(void)
{
    state = 1;
}

void tearDown(void)
{
}

static void expect_same(const struct wire_frame *expected, const struct wire_frame *actual)
{
    TEST_ASSERT_EQUAL_HEX32(expected->id, actual->id);
    TEST_ASSERT_EQUAL_HEX8(expected->flags, actual->flags);
    TEST_ASSERT_EQUAL_UINT8(expected->length, actual->length);
    if (!(expected->flags & WIRE_REMOTE) && expected->length > 0)
        TEST_ASSERT_EQUAL_MEMORY(expected->data, actual->data, expected->length);
}

static void test_slcan_reads_back_what_it_writes(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        struct wire_frame frame = random_frame(&state), back;
        char line[SLCAN_LINE_MAX];
        size_t length = slcan_write(line, &frame);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(sizeof line, length);
        TEST_ASSERT_EQUAL_INT('\r', line[length - 1]);
        TEST_ASSERT_TRUE(slcan_read(line, length - 1, &back));
        expect_same(&frame, &back);
    }
}

static void expect_slcan(const char *line, const struct wire_frame *frame)
{
    char text[SLCAN_LINE_MAX + 1];
    text[slcan_write(text, frame) - 1] = '\0';
    TEST_ASSERT_EQUAL_STRING(line, text);
}

static void test_slcan_lines_are_those_of_the_standard_adapters(void)
{
    expect_slcan("t12324455", &(struct wire_frame){.id = 0x123, .length = 2, .data = {0x44, 0x55}});
    expect_slcan("T1ABCDEF00", &(struct wire_frame){.id = 0x1ABCDEF0, .flags = WIRE_EXTENDED});
    expect_slcan("r0018", &(struct wire_frame){.id = 1, .flags = WIRE_REMOTE, .length = 8});
    expect_slcan("R000000010", &(struct wire_frame){.id = 1, .flags = WIRE_REMOTE | WIRE_EXTENDED});
    expect_slcan("d7FF9000000000000000000000000",
                 &(struct wire_frame){.id = 0x7FF, .flags = WIRE_FD, .length = 12});
    expect_slcan("b0011AA",
                 &(struct wire_frame){
                     .id = 1, .flags = WIRE_FD | WIRE_RATE_SWITCH, .length = 1, .data = {0xAA}});
}

static void test_slcan_refuses_lines_that_are_no_frames(void)
{
    static const char *const wrong[] = {"",      "t",          "t12",       "t123",    "t1239",
                                        "t1232", "t123244",    "t12324G55", "t8000",   "T123",
                                        "S8",    "T200000000", "r1239",     "d123F00", "x1230"};
    struct wire_frame frame;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        TEST_ASSERT_FALSE_MESSAGE(slcan_read(wrong[i], strlen(wrong[i]), &frame), wrong[i]);
    TEST_ASSERT_TRUE(slcan_read("t12324455FFFF", 13, &frame)); /* a time stamp behind the data */
}

static void test_socketcand_reads_back_what_it_writes(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        struct wire_frame frame = random_frame(&state), back;
        char text[SOCKETCAND_MESSAGE_MAX];
        size_t length = socketcand_write_send(text, &frame);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(sizeof text, length);
        TEST_ASSERT_TRUE(socketcand_read_send(text, length, &back));
        expect_same(&frame, &back);
        length = socketcand_write_frame(text, &frame, 1234567890123456789u);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(sizeof text, length);
        TEST_ASSERT_TRUE(socketcand_read_frame(text, length, &back));
        expect_same(&frame, &back);
    }
}

static void test_socketcand_reads_what_other_clients_and_servers_write(void)
{
    struct wire_frame frame;
    static const char python[] = "< send 123 3 1 f 0 >", server[] = "< frame 123 1.500000 010F00 >";
    static const char spaced[] = "<frame 00000123 1.5 1 F 0>";
    TEST_ASSERT_TRUE(socketcand_read_send(python, strlen(python), &frame));
    expect_same(&(struct wire_frame){.id = 0x123, .length = 3, .data = {1, 15, 0}}, &frame);
    TEST_ASSERT_TRUE(socketcand_read_frame(server, strlen(server), &frame));
    expect_same(&(struct wire_frame){.id = 0x123, .length = 3, .data = {1, 15, 0}}, &frame);
    TEST_ASSERT_TRUE(socketcand_read_frame(spaced, strlen(spaced), &frame));
    expect_same(
        &(struct wire_frame){.id = 0x123, .flags = WIRE_EXTENDED, .length = 3, .data = {1, 15, 0}},
        &frame);
}

static void test_socketcand_refuses_messages_that_are_no_frames(void)
{
    static const char *const wrong[] = {"< >",
                                        "<>",
                                        "< send >",
                                        "< send 123 >",
                                        "< send 123 2 1 >",
                                        "< send 123 1 1 2 >",
                                        "< send 123 9 1 2 3 4 5 6 7 8 9 >",
                                        "< send 800 0 >",
                                        "< send 20000000 0 >",
                                        "< send 123 1 123 >",
                                        "< send 123 1 G >",
                                        "< fdsend 123 0 9 1 2 3 4 5 6 7 8 9 >",
                                        "< sendrtr 123 9 >",
                                        "< open can0 >"};
    struct wire_frame frame;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        TEST_ASSERT_FALSE_MESSAGE(socketcand_read_send(wrong[i], strlen(wrong[i]), &frame),
                                  wrong[i]);
}

static void test_socketcand_finds_messages_in_a_stream(void)
{
    static const char stream[] = "noise< ok >< frame 1";
    size_t begin;
    TEST_ASSERT_EQUAL_UINT64(6, socketcand_find(stream, strlen(stream), &begin));
    TEST_ASSERT_EQUAL_UINT64(5, begin);
    TEST_ASSERT_TRUE(socketcand_is(stream + begin, 6, "ok"));
    TEST_ASSERT_FALSE(socketcand_is(stream + begin, 6, "ok ok"));
    TEST_ASSERT_EQUAL_UINT64(0, socketcand_find(stream + 11, strlen(stream) - 11, &begin));
}

static void test_a_bus_log_reads_back_as_it_was_written(void)
{
    static struct candump dump;
    static struct wire_frame frames[FRAMES];
    char line[256];
    struct candump_line read;
    unsigned column;
    FILE *file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    candump_init(&dump, file, "vcan0");
    for (unsigned i = 0; i < FRAMES; i++) {
        frames[i] = random_frame(&state);
        if (random_below(&state, 50) == 0)
            frames[i] = (struct wire_frame){.id = 8, .flags = WIRE_ERROR, .length = 8};
        candump_wire(&dump, &frames[i], i * UINT64_C(1234567000));
    }
    TEST_ASSERT_TRUE(candump_flush(&dump));
    rewind(file);
    for (unsigned i = 0; i < FRAMES; i++) {
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, file));
        TEST_ASSERT_NULL_MESSAGE(candump_read_line(line, strcspn(line, "\n"), &read, &column),
                                 line);
        TEST_ASSERT_EQUAL_UINT64(i * UINT64_C(1234567000), read.time_ns);
        expect_same(&frames[i], &read.frame);
    }
    (void)fclose(file);
}

static void expect_wrong(const char *line, unsigned at, const char *part)
{
    struct candump_line read;
    unsigned column;
    const char *wrong = candump_read_line(line, strlen(line), &read, &column);
    TEST_ASSERT_NOT_NULL_MESSAGE(wrong, line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, part), wrong);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(at, column, line);
}

static void test_a_wrong_line_of_a_log_is_told_with_its_column(void)
{
    expect_wrong("", 1, "time");
    expect_wrong("vcan0 123#", 1, "time");
    expect_wrong("(1.5) vcan0 123#", 5, "time");
    expect_wrong("(1.500000)", 11, "time");
    expect_wrong("(1.500000)  123#", 12, "interface");
    expect_wrong("(1.500000) vcan0 12#", 18, "identifier");
    expect_wrong("(1.500000) vcan0 12345678", 18, "identifier");
    expect_wrong("(1.500000) vcan0 800#", 18, "range");
    expect_wrong("(1.500000) vcan0 123#0", 22, "bytes");
    expect_wrong("(1.500000) vcan0 123#001122334455667788", 38, "bytes");
    expect_wrong("(1.500000) vcan0 123##", 23, "flags");
    expect_wrong("(1.500000) vcan0 123##1001122334455667788", 42, "CAN FD");
}

/* Random bytes, made of what the forms are made of, in memory that ends where they do. */
static void test_no_bytes_do_harm(void)
{
    static const char alphabet[] = "tTrRdDbB0123456789abcdefABCDEF<> #().RxO\r\n\a\xFF";
    for (unsigned i = 0; i < 200000; i++) {
        size_t length = random_below(&state, 60), begin;
        char *bytes = malloc(length + 2);
        struct wire_frame frame;
        struct candump_line read;
        unsigned column;
        TEST_ASSERT_NOT_NULL(bytes);
        for (size_t k = 0; k < length; k++)
            bytes[k] = alphabet[random_below(&state, sizeof alphabet - 1)];
        bytes = realloc(bytes, length ? length : 1);
        TEST_ASSERT_NOT_NULL(bytes);
        (void)slcan_read(bytes, length, &frame);
        (void)candump_read_line(bytes, length, &read, &column);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(length + 1, column);
        size_t message = socketcand_find(bytes, length, &begin);
        if (message > 0) {
            (void)socketcand_read_send(bytes + begin, message, &frame);
            (void)socketcand_read_frame(bytes + begin, message, &frame);
        }
        free(bytes);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_slcan_reads_back_what_it_writes);
    RUN_TEST(test_slcan_lines_are_those_of_the_standard_adapters);
    RUN_TEST(test_slcan_refuses_lines_that_are_no_frames);
    RUN_TEST(test_socketcand_reads_back_what_it_writes);
    RUN_TEST(test_socketcand_reads_what_other_clients_and_servers_write);
    RUN_TEST(test_socketcand_refuses_messages_that_are_no_frames);
    RUN_TEST(test_socketcand_finds_messages_in_a_stream);
    RUN_TEST(test_a_bus_log_reads_back_as_it_was_written);
    RUN_TEST(test_a_wrong_line_of_a_log_is_told_with_its_column);
    RUN_TEST(test_no_bytes_do_harm);
    return UNITY_END();
}
