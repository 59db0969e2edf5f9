#include "bus/candump.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

static struct candump dump;
static FILE *file;
static char text[1 << 20];

void setUp(void)
{
    file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
}

void tearDown(void)
{
    (void)fclose(file);
}

static const char *read_back(void)
{
    rewind(file);
    size_t length = fread(text, 1, sizeof text - 1, file);
    text[length] = '\0';
    return text;
}

static void test_a_frame_is_a_line_as_candump_writes_it(void)
{
    struct can_frame frame = {.id = 0x123, .length = 4, .data = {0xDE, 0xAD, 0xBE, 0xEF}};
    candump_init(&dump, file, "can0");
    candump_frame(&dump, &frame, UINT64_C(12345678901234));
    TEST_ASSERT_TRUE(candump_flush(&dump));
    TEST_ASSERT_EQUAL_STRING("(0000012345.678901) can0 123#DEADBEEF\n", read_back());
}

static void test_a_frame_without_data_and_small_numbers_keep_their_zeros(void)
{
    struct can_frame frame = {.id = 0x080};
    candump_init(&dump, file, "vcan12");
    candump_frame(&dump, &frame, 1999);
    TEST_ASSERT_TRUE(candump_flush(&dump));
    TEST_ASSERT_EQUAL_STRING("(0000000000.000001) vcan12 080#\n", read_back());
}

static void test_a_remote_frame_has_an_r_and_its_length(void)
{
    struct can_frame frame = {.id = CAN_REMOTE | 0x701, .length = 1};
    candump_init(&dump, file, "can0");
    candump_frame(&dump, &frame, 0);
    TEST_ASSERT_TRUE(candump_flush(&dump));
    TEST_ASSERT_EQUAL_STRING("(0000000000.000000) can0 701#R1\n", read_back());
}

static void test_an_overlong_interface_name_is_cut(void)
{
    struct can_frame frame = {.id = 0x001};
    candump_init(&dump, file, "0123456789abcdefXYZ");
    candump_frame(&dump, &frame, 0);
    TEST_ASSERT_TRUE(candump_flush(&dump));
    TEST_ASSERT_EQUAL_STRING("(0000000000.000000) 0123456789abcde 001#\n", read_back());
}

static void test_a_line_names_the_bus_that_was_selected_for_it(void)
{
    struct can_frame frame = {.id = 0x001};
    candump_init(&dump, file, "vcan12");
    for (unsigned bus = 2; bus-- > 0;) {
        candump_select(&dump, bus);
        candump_frame(&dump, &frame, 0);
    }
    TEST_ASSERT_TRUE(candump_flush(&dump));
    TEST_ASSERT_EQUAL_STRING("(0000000000.000000) can1 001#\n(0000000000.000000) can0 001#\n",
                             read_back());
}

/* More than the buffer holds: each line must say what printf says. */
static void test_many_lines_equal_those_of_printf(void)
{
    enum { LINES = 5000 };
    struct can_frame frame = {.length = 8};
    candump_init(&dump, file, "can0");
    for (unsigned i = 0; i < LINES; i++) {
        frame.id = (uint16_t)(i * 37 & 0x7FF);
        frame.data[i & 7] = (uint8_t)(i * 91);
        candump_frame(&dump, &frame, UINT64_C(987654321) * i);
    }
    TEST_ASSERT_TRUE(candump_flush(&dump));
    const char *at = read_back();
    memset(frame.data, 0, sizeof frame.data);
    for (unsigned i = 0; i < LINES; i++) {
        const uint8_t *d = frame.data;
        unsigned long long micros = UINT64_C(987654321) * i / 1000;
        char expected[80];
        frame.data[i & 7] = (uint8_t)(i * 91);
        int length = snprintf(expected, sizeof expected,
                              "(%010llu.%06llu) can0 %03X#%02X%02X%02X%02X%02X%02X%02X%02X\n",
                              micros / 1000000, micros % 1000000, i * 37 & 0x7FF, d[0], d[1], d[2],
                              d[3], d[4], d[5], d[6], d[7]);
        TEST_ASSERT_EQUAL_INT(0, strncmp(expected, at, (size_t)length));
        at += length;
    }
    TEST_ASSERT_EQUAL_INT('\0', *at);
}

static void test_a_file_that_cannot_be_written_is_told(void)
{
    struct can_frame frame = {.id = 1};
    FILE *full = fopen("/dev/full", "w");
    TEST_ASSERT_NOT_NULL(full);
    candump_init(&dump, full, "can0");
    candump_frame(&dump, &frame, 0);
    bool written = candump_flush(&dump);
    (void)fclose(full);
    TEST_ASSERT_FALSE(written);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_frame_is_a_line_as_candump_writes_it);
    RUN_TEST(test_a_frame_without_data_and_small_numbers_keep_their_zeros);
    RUN_TEST(test_a_remote_frame_has_an_r_and_its_length);
    RUN_TEST(test_an_overlong_interface_name_is_cut);
    RUN_TEST(test_a_line_names_the_bus_that_was_selected_for_it);
    RUN_TEST(test_many_lines_equal_those_of_printf);
    RUN_TEST(test_a_file_that_cannot_be_written_is_told);
    return UNITY_END();
}
