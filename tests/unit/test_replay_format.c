/* The header of a compiled program, and what is refused. */
#include "replay/intake.h"

#include <string.h>
#include <unity.h>

static uint8_t bytes[REPLAY_HEADER_BYTES + 64];
static size_t length;
static size_t given;

void setUp(void)
{
    memset(bytes, 0, sizeof(bytes));
    length = 0;
    given = 0;
}

void tearDown(void)
{
}

static struct replay_header header(void)
{
    struct replay_header h;

    memset(&h, 0, sizeof(h));
    h.cycle_us = 1000;
    h.step_cycles = 2;
    h.quantum_bits = 26;
    h.ceiling_percent = 120;
    h.blocks = 7;
    h.sections = 3;
    h.intervals = UINT64_C(0x123456789a);
    h.program = UINT64_C(0xfedcba9876543210);
    h.kept = 0.996;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        h.velocity_mm_s[i] = 100.0 + i;
        h.acceleration_mm_s2[i] = 1000.0 + i;
        h.jerk_mm_s3[i] = 50000.0 + i;
    }
    return h;
}

/* A few bytes at a time, as a slow line brings them. */
static size_t read_slowly(void *context, uint8_t *to, size_t size)
{
    const size_t left = length - given;
    const size_t part = size < 7 ? size : 7;
    const size_t count = left < part ? left : part;

    (void)context;
    memcpy(to, bytes + given, count);
    given += count;
    return count;
}

static struct intake read_all(void)
{
    const struct replay_source source = {.read = read_slowly};
    static struct intake intake;

    takt_intake_open(&intake, &source);
    for (unsigned i = 0; i < sizeof(bytes); i++) {
        takt_intake_read(&intake);
    }
    return intake;
}

static void test_a_header_reads_as_it_was_written(void)
{
    const struct replay_header written = header();
    struct replay_header read;

    takt_replay_header_write(&written, bytes);
    TEST_ASSERT_EQUAL(REPLAY_GOOD, takt_replay_header_read(&read, bytes));
    TEST_ASSERT_EQUAL_UINT32(written.step_cycles, read.step_cycles);
    TEST_ASSERT_EQUAL_UINT32(written.ceiling_percent, read.ceiling_percent);
    TEST_ASSERT_EQUAL_UINT64(written.intervals, read.intervals);
    TEST_ASSERT_EQUAL_UINT64(written.program, read.program);
    TEST_ASSERT_EQUAL_DOUBLE(written.kept, read.kept);
    TEST_ASSERT_EQUAL_DOUBLE(written.jerk_mm_s3[2], read.jerk_mm_s3[2]);
}

static void test_every_changed_byte_of_a_header_is_seen(void)
{
    const struct replay_header written = header();
    struct replay_header read;

    for (unsigned i = 0; i < REPLAY_HEADER_BYTES; i++) {
        takt_replay_header_write(&written, bytes);
        bytes[i] ^= 0x10U;
        TEST_ASSERT_NOT_EQUAL(REPLAY_GOOD, takt_replay_header_read(&read, bytes));
    }
}

static void put_record(enum replay_kind kind, uint32_t crc)
{
    bytes[length] = (uint8_t)kind;
    takt_replay_put(bytes + length + 1, 0, 2);
    takt_replay_put(bytes + length + 3, crc, 4);
    length += 7;
}

static void test_an_unknown_record_and_a_wrong_checksum_are_refused(void)
{
    struct replay_header written = header();

    written.intervals = 0;
    takt_replay_header_write(&written, bytes);
    length = REPLAY_HEADER_BYTES;
    put_record(REPLAY_END, 0x12345678U);
    TEST_ASSERT_EQUAL(REPLAY_DAMAGED, read_all().fault);
}

static void test_a_file_that_ends_early_waits_and_never_ends(void)
{
    const struct replay_header written = header();
    struct intake intake;

    takt_replay_header_write(&written, bytes);
    length = REPLAY_HEADER_BYTES;
    intake = read_all();
    TEST_ASSERT_EQUAL_INT(INTAKE_RECORD, intake.next);
    TEST_ASSERT_EQUAL(REPLAY_GOOD, intake.fault);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_header_reads_as_it_was_written);
    RUN_TEST(test_every_changed_byte_of_a_header_is_seen);
    RUN_TEST(test_an_unknown_record_and_a_wrong_checksum_are_refused);
    RUN_TEST(test_a_file_that_ends_early_waits_and_never_ends);
    return UNITY_END();
}
