/* Replaying beside a path: what does not fit the program, or is damaged, moves nothing. */
#include "base/crc32.h"
#include "motion/handover.h"
#include "replay/replay.h"

#include <string.h>
#include <unity.h>

static uint8_t bytes[512];
static size_t length, given;
static uint32_t crc;
static struct path path;
static struct motion motion;
static struct replay replay;
static struct plan_limits limits;

static size_t read_bytes(void *context, uint8_t *to, size_t size)
{
    const size_t count = length - given < size ? length - given : size;

    (void)context;
    memcpy(to, bytes + given, count);
    given += count;
    return count;
}

static void add_record(enum replay_kind kind, const uint8_t *holds, size_t size)
{
    uint8_t *record = bytes + length;

    record[0] = (uint8_t)kind;
    takt_replay_put(record + 1, size, 2);
    memcpy(record + REPLAY_RECORD_HEAD, holds, size);
    crc = takt_crc32_add(crc, record, REPLAY_RECORD_HEAD + size);
    takt_replay_put(record + REPLAY_RECORD_HEAD + size, crc, REPLAY_RECORD_TAIL);
    length += REPLAY_RECORD_HEAD + size + REPLAY_RECORD_TAIL;
}

/* Bytes of what tells four intervals in which no block ends. */
#define KNOTS_BYTES 26

/* A section of so many blocks and four intervals that stands where it starts. */
static void add_section_of(uint32_t first_block, uint32_t blocks, size_t knots_bytes)
{
    uint8_t section[REPLAY_SECTION_BYTES] = {0};
    uint8_t knots[KNOTS_BYTES + 1] = {4};

    takt_replay_put(section, first_block, 4);
    takt_replay_put(section + 4, blocks, 4);
    takt_replay_put(section + 8, 4, 4);
    add_record(REPLAY_SECTION, section, sizeof(section));
    add_record(REPLAY_KNOTS, knots, knots_bytes);
    add_record(REPLAY_END, section, 0);
}

static void add_section(uint32_t first_block)
{
    add_section_of(first_block, 1, KNOTS_BYTES);
}

static void push_line(double to_mm)
{
    struct move line = {.kind = MOVE_FEED, .feed_mm_s = 10, .turns = 1};

    line.end.at[AXIS_X] = to_mm;
    takt_path_push(&path, &line);
}

static void begin_path(void)
{
    const struct point start = {{0}};

    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    takt_handover_allow(&motion, MOTION_HANDS_OVER_ALL);
}

void setUp(void)
{
    const struct replay_header header = {.cycle_us = 1000,
                                         .step_cycles = 2,
                                         .quantum_bits = 20,
                                         .ceiling_percent = 100,
                                         .intervals = 4,
                                         .kept = 0.99};

    memset(&limits, 0, sizeof(limits));
    limits.axes = 7;
    limits.cycle_s = 1e-3;
    limits.chord_error_max_mm = 1e-3;
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = 100;
        limits.acceleration_mm_s2[i] = 1000;
        limits.jerk_mm_s3[i] = 50000;
    }
    begin_path();
    push_line(1);
    takt_path_finish(&path);
    takt_path_go_on(&path);
    takt_motion_build(&motion);
    takt_replay_header_write(&header, bytes);
    length = REPLAY_HEADER_BYTES;
    given = 0;
    crc = CRC32_START;
}

void tearDown(void)
{
}

/* Cycles until replaying fails, and how far X has come. */
static double run_until_it_fails(void)
{
    const struct replay_source source = {.read = read_bytes};
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record;
    double farthest = 0;

    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    for (int i = 0; i < 100; i++) {
        takt_replay_read(&replay, &limits);
        if (takt_motion_cycle(&motion, &as_programmed, &record) != MOTION_HANDED_OVER) {
            continue;
        }
        if (takt_replay_cycle(&replay, &motion, &as_programmed, &record) == REPLAY_FAILED) {
            return farthest;
        }
        farthest = record.cmd.at[AXIS_X];
    }
    TEST_FAIL_MESSAGE("it went on");
    return 0;
}

static void test_a_section_of_another_block_moves_nothing(void)
{
    add_section(2);
    TEST_ASSERT_EQUAL_DOUBLE(0, run_until_it_fails());
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_STRAYED, replay.alarm.code);
}

static void test_a_curve_that_does_not_lead_to_the_end_is_told(void)
{
    add_section(1);
    TEST_ASSERT_EQUAL_DOUBLE(0, run_until_it_fails());
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_STRAYED, replay.alarm.code);
}

/*
 * Forth and back in four blocks, of which the path knows three at first: cycles until the axes are
 * at the end of all.
 */
static unsigned cycles_with_a_late_block(unsigned late)
{
    const struct replay_source source = {.read = read_bytes};
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record;
    unsigned cycles = 0;

    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    for (unsigned i = 0; i < 200; i++) {
        takt_replay_read(&replay, &limits);
        if (i == late) {
            push_line(0);
            takt_path_finish(&path);
        }
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            takt_motion_build(&motion);
        }
        const enum motion_result result = takt_motion_cycle(&motion, &as_programmed, &record);

        if (result == MOTION_EMPTY) {
            return cycles;
        }
        if (result == MOTION_HANDED_OVER) {
            TEST_ASSERT_EQUAL(REPLAY_CYCLE,
                              takt_replay_cycle(&replay, &motion, &as_programmed, &record));
            TEST_ASSERT_EQUAL_DOUBLE(0, record.cmd.at[AXIS_X]);
            cycles = i;
        }
    }
    TEST_FAIL_MESSAGE("it does not end");
    return 0;
}

static void test_a_block_that_the_path_does_not_know_yet_is_waited_for_at_the_end_of_the_curve(void)
{
    begin_path();
    push_line(1);
    push_line(0);
    push_line(1);
    add_section_of(1, 4, KNOTS_BYTES);
    TEST_ASSERT_EQUAL(80, cycles_with_a_late_block(80));
    TEST_ASSERT_EQUAL(TAKT_OK, replay.alarm.code);
}

static void test_of_many_blocks_no_cycle_passes_more_than_64(void)
{
    const struct replay_source source = {.read = read_bytes};
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record;
    unsigned most = 0;

    begin_path();
    for (unsigned i = 0; i < 200; i++) {
        push_line(i % 2 == 0 ? 1 : 0);
    }
    takt_path_finish(&path);
    takt_path_go_on(&path);
    takt_motion_build(&motion);
    add_section_of(1, 200, KNOTS_BYTES);
    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    for (unsigned i = 0; i < 100 && path.first != path.pushed; i++) {
        const uint32_t first = path.first;

        takt_replay_read(&replay, &limits);
        if (takt_motion_cycle(&motion, &as_programmed, &record) == MOTION_HANDED_OVER) {
            TEST_ASSERT_EQUAL(REPLAY_CYCLE,
                              takt_replay_cycle(&replay, &motion, &as_programmed, &record));
        }
        most = path.first - first > most ? path.first - first : most;
    }
    TEST_ASSERT_EQUAL(TAKT_OK, replay.alarm.code);
    TEST_ASSERT_EQUAL(path.pushed, path.first);
    TEST_ASSERT_EQUAL(64, most);
}

/* The end's record is damaged, and comes when the axes stand there. */
static void test_a_damaged_record_is_told_while_a_block_is_waited_for(void)
{
    const struct replay_source source = {.read = read_bytes};
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record;
    enum replay_result result = REPLAY_CYCLE;

    begin_path();
    push_line(1);
    push_line(0);
    push_line(1);
    add_section_of(1, 4, KNOTS_BYTES);
    bytes[length - 1] ^= 1U;
    length -= REPLAY_RECORD_HEAD + REPLAY_RECORD_TAIL;
    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    for (unsigned i = 0; i < 100 && result == REPLAY_CYCLE; i++) {
        length += i == 50 ? REPLAY_RECORD_HEAD + REPLAY_RECORD_TAIL : 0;
        takt_replay_read(&replay, &limits);
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            takt_motion_build(&motion);
        }
        if (takt_motion_cycle(&motion, &as_programmed, &record) == MOTION_HANDED_OVER) {
            result = takt_replay_cycle(&replay, &motion, &as_programmed, &record);
            TEST_ASSERT_EQUAL(i >= 50 ? REPLAY_FAILED : REPLAY_CYCLE, result);
        }
    }
    TEST_ASSERT_EQUAL(REPLAY_FAILED, result);
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_DAMAGED, replay.alarm.code);
}

static double run_with_three_blocks(void (*what_follows)(void))
{
    begin_path();
    push_line(1);
    push_line(0);
    push_line(1);
    what_follows();
    takt_path_finish(&path);
    takt_path_go_on(&path);
    takt_motion_build(&motion);
    add_section_of(1, 4, KNOTS_BYTES);
    return run_until_it_fails();
}

static void nothing(void)
{
}

static void dwell(void)
{
    const struct move move = {.kind = MOVE_DWELL, .dwell_s = 1.0};

    takt_path_push(&path, &move);
}

static void test_a_block_that_never_comes_is_told_at_the_end_of_the_curve(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0, run_with_three_blocks(nothing));
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_STRAYED, replay.alarm.code);
}

static void test_what_follows_and_is_no_motion_is_told_at_the_end_of_the_curve(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0, run_with_three_blocks(dwell));
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_STRAYED, replay.alarm.code);
}

static void test_a_damaged_record_moves_nothing(void)
{
    add_section(1);
    bytes[REPLAY_HEADER_BYTES + 5] ^= 1U;
    TEST_ASSERT_EQUAL_DOUBLE(0, run_until_it_fails());
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_DAMAGED, replay.alarm.code);
}

static void test_a_record_that_is_longer_than_what_it_tells_moves_nothing(void)
{
    add_section_of(1, 1, KNOTS_BYTES + 1);
    TEST_ASSERT_EQUAL_DOUBLE(0, run_until_it_fails());
    TEST_ASSERT_EQUAL(TAKT_ERROR_PLAN_DAMAGED, replay.alarm.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_section_of_another_block_moves_nothing);
    RUN_TEST(test_a_curve_that_does_not_lead_to_the_end_is_told);
    RUN_TEST(test_a_block_that_the_path_does_not_know_yet_is_waited_for_at_the_end_of_the_curve);
    RUN_TEST(test_of_many_blocks_no_cycle_passes_more_than_64);
    RUN_TEST(test_a_damaged_record_is_told_while_a_block_is_waited_for);
    RUN_TEST(test_a_block_that_never_comes_is_told_at_the_end_of_the_curve);
    RUN_TEST(test_what_follows_and_is_no_motion_is_told_at_the_end_of_the_curve);
    RUN_TEST(test_a_damaged_record_moves_nothing);
    RUN_TEST(test_a_record_that_is_longer_than_what_it_tells_moves_nothing);
    return UNITY_END();
}
