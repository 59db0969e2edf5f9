/*
 * The compiled file, written and read: where blocks end comes back in order and as closely as the
 * format says, however many end at once, and many cost few bytes.
 */
#include "ahead/encode.h"
#include "base/maths.h"
#include "replay/intake.h"

#include <stdlib.h>
#include <unity.h>

#define INTERVALS 4000
#define ENDS_MAX  100000
#define STEP_S    0.002
#define KB_MOST   4.0
#define BLOCKS    9000 /* of a second */
#define COARSE    (REPLAY_END_PARTS / 32)

static uint64_t seed;
static uint64_t ends[ENDS_MAX]; /* as they should be, in parts of intervals */
static size_t count;
static uint64_t came[ENDS_MAX];
static struct intake intake;

void setUp(void)
{
    seed = 1;
    count = 0;
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/*
 * An element of the path that begins, and so the one before ends, at a place; an interval is 1 mm.
 */
static void add_element(struct ahead_path *path, double start_mm)
{
    path->element[path->count].start_mm = start_mm;
    path->element[path->count].block = (uint32_t)path->count + 1;
    if (path->count > 0)
        ends[count++] = (uint64_t)takt_maths_ceil(start_mm * REPLAY_END_PARTS);
    path->count++;
}

static size_t read_file(void *context, uint8_t *bytes, size_t size)
{
    return fread(bytes, 1, size, context);
}

/* Writes a section with these elements and reads it; returns its bytes. */
static uint64_t write_and_read(const struct ahead_path *path)
{
    const struct replay_header header = {.cycle_us = 1000,
                                         .step_cycles = 2,
                                         .quantum_bits = 20,
                                         .ceiling_percent = 100,
                                         .kept = 0.9};
    FILE *file = tmpfile();
    const struct replay_source source = {.context = file, .read = read_file};
    struct encoder encoder;
    struct trail trail;
    uint64_t at = 0;
    size_t read = 0;

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(trail_allocate(&trail, INTERVALS, 0));
    for (size_t site = 0; site <= 2 * trail.intervals; site++)
        trail.place_mm[site] = 0.5 * (double)site;
    encoder_begin(&encoder, file, &header);
    encoder_add(&encoder, path, &trail);
    TEST_ASSERT_TRUE(encoder_end(&encoder, 1));
    trail_free(&trail);
    rewind(file);
    takt_intake_open(&intake, &source);
    while (intake.next != INTAKE_NOTHING) {
        takt_intake_read(&intake);
        TEST_ASSERT_EQUAL_INT(REPLAY_GOOD, intake.fault);
        intake.intervals_taken = intake.intervals_came;
        intake.sections_taken = intake.sections_came;
        for (; intake.ends_taken != intake.ends_came; intake.ends_taken++) {
            at += intake.end[intake.ends_taken % INTAKE_ENDS_MAX];
            came[read++] = at;
        }
    }
    (void)fclose(file);
    TEST_ASSERT_EQUAL_UINT32(INTERVALS, intake.intervals_came);
    TEST_ASSERT_EQUAL_UINT64(count, read);
    return encoder.bytes;
}

static size_t takt_interval_of(uint64_t end)
{
    return end > 0 ? (size_t)((end - 1) / REPLAY_END_PARTS) : 0;
}

/* How many end in the interval of an end. */
static size_t neighbours(size_t k)
{
    size_t first = k;
    size_t last = k;

    while (first > 0 && takt_interval_of(ends[first - 1]) == takt_interval_of(ends[k]))
        first--;
    while (last + 1 < count && takt_interval_of(ends[last + 1]) == takt_interval_of(ends[k]))
        last++;
    return last - first + 1;
}

static void check_ends(void)
{
    for (size_t k = 0; k < count; k++) {
        const size_t crowd = neighbours(k);
        const uint64_t off = came[k] > ends[k] ? came[k] - ends[k] : ends[k] - came[k];

        TEST_ASSERT_TRUE(k == 0 || came[k] >= came[k - 1]);
        TEST_ASSERT_TRUE(off < (crowd == 1 ? 1 : crowd == 2 ? COARSE : REPLAY_END_PARTS + 1));
    }
}

static void test_ends_come_back_as_closely_as_the_format_says(void)
{
    struct ahead_path path = {.element = calloc(ENDS_MAX + 1, sizeof *path.element)};
    double at = 0;

    TEST_ASSERT_NOT_NULL(path.element);
    add_element(&path, 0);
    while (at < INTERVALS && path.count < ENDS_MAX) {
        at += takt_maths_power(10, between(-3, 1));
        if (at < INTERVALS)
            add_element(&path, at);
    }
    (void)write_and_read(&path);
    check_ends();
    free(path.element);
}

static void test_more_ends_in_an_interval_than_a_record_holds_all_come(void)
{
    struct ahead_path path = {.element = calloc(ENDS_MAX + 1, sizeof *path.element)};

    TEST_ASSERT_NOT_NULL(path.element);
    add_element(&path, 0);
    for (int k = 1; k <= 900; k++)
        add_element(&path, 7 + k / 1000.0);
    for (int k = 1; k <= 300; k++)
        add_element(&path, INTERVALS - 1 + k / 300.0);
    (void)write_and_read(&path);
    check_ends();
    free(path.element);
}

static void test_thousands_of_blocks_a_second_take_less_than_four_kilobytes(void)
{
    for (int each = 1; each <= BLOCKS; each = each * 3 / 2 + 1) {
        const double seconds = INTERVALS * STEP_S;
        struct ahead_path path = {.element = calloc(ENDS_MAX + 1, sizeof *path.element)};

        TEST_ASSERT_NOT_NULL(path.element);
        count = 0;
        add_element(&path, 0);
        for (int k = 1; k < each * seconds; k++)
            add_element(&path, (k + between(-0.4, 0.4)) * INTERVALS / (each * seconds));
        TEST_ASSERT_TRUE(1e-3 * (double)write_and_read(&path) / seconds <= KB_MOST);
        check_ends();
        free(path.element);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ends_come_back_as_closely_as_the_format_says);
    RUN_TEST(test_more_ends_in_an_interval_than_a_record_holds_all_come);
    RUN_TEST(test_thousands_of_blocks_a_second_take_less_than_four_kilobytes);
    return UNITY_END();
}
