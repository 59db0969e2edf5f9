/*
 * Power fails at every step of storing a set, in a flash that keeps what such a step may leave: any
 * part of a word's zeros, anything in a sector being erased. Afterwards the old or the new set must
 * be there.
 */
#include "storage/store.h"
#include "unity.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECTOR_BYTES 256U
#define HEAD_USED    20U /* the rest is blank */
#define SET_MAX      (SECTOR_BYTES - STORE_HEAD_BYTES)

/*
 * The flash, and when its power fails: at step cut_at, counted from 0; what the step leaves is kind
 * of cut.
 */
enum cut { CUT_BEFORE, CUT_AFTER, CUT_HALF, CUT_RANDOM, CUT_LOW_BITS, CUTS };

static struct {
    uint64_t memory[FLASH_SECTORS][SECTOR_BYTES / 8];
    unsigned steps, cut_at;
    enum cut cut;
    jmp_buf power;
    bool refuses;
} flash;

#define NEVER 1000000U

/* Steps of storing the longest set: an erasure, and all words. */
#define STEPS (1U + SECTOR_BYTES / FLASH_WORD_BYTES)

static uint8_t *sector(unsigned i)
{
    return (uint8_t *)flash.memory[i];
}

/* Which of the bits that a step changes have been changed when the power failed. */
static uint8_t part_of(uint8_t bits, unsigned at)
{
    switch (flash.cut) {
    case CUT_BEFORE:
        return 0;
    case CUT_AFTER:
        return bits;
    case CUT_HALF:
        return at % 8 < 4 ? bits : 0;
    case CUT_RANDOM:
        return bits & (uint8_t)rand();
    case CUT_LOW_BITS:
    case CUTS:
        break;
    }
    return bits & 0x0F;
}

static bool fails_now(void)
{
    return flash.steps++ == flash.cut_at;
}

static bool erase(void *context, unsigned number)
{
    const bool fails = fails_now();

    (void)context;
    for (unsigned i = 0; i < SECTOR_BYTES && !flash.refuses; i++) {
        const uint8_t zeros = (uint8_t)~sector(number)[i];

        sector(number)[i] |= fails ? part_of(zeros, i / 16) : zeros;
    }
    if (fails)
        longjmp(flash.power, 1);
    return !flash.refuses;
}

static void program_word(uint8_t *to, const uint8_t *bytes, bool fails)
{
    for (unsigned i = 0; i < FLASH_WORD_BYTES; i++) {
        const uint8_t ones = (uint8_t)(to[i] & ~bytes[i]);

        to[i] &= (uint8_t) ~(fails ? part_of(ones, 2 * i) : ones);
    }
}

static bool program(void *context, unsigned number, uint32_t offset, const uint8_t *bytes,
                    uint32_t words)
{
    (void)context;
    TEST_ASSERT_EQUAL(0, offset % FLASH_WORD_BYTES);
    TEST_ASSERT_LESS_OR_EQUAL(SECTOR_BYTES, offset + words * FLASH_WORD_BYTES);
    for (uint32_t i = 0; i < words && !flash.refuses; i++) {
        const uint8_t *from = bytes + (size_t)FLASH_WORD_BYTES * i;
        uint8_t *to = sector(number) + offset + (size_t)FLASH_WORD_BYTES * i;
        const bool fails = fails_now();

        program_word(to, from, fails);
        if (fails)
            longjmp(flash.power, 1);
        if (memcmp(to, from, FLASH_WORD_BYTES) != 0)
            return false;
    }
    return !flash.refuses;
}

static struct store store;

/* Power comes. */
static void start(void)
{
    const struct flash_port port = {.sector_bytes = SECTOR_BYTES,
                                    .sector = {sector(0), sector(1)},
                                    .erase = erase,
                                    .program = program};

    takt_store_open(&store, &port);
}

void setUp(void)
{
    srand(1);
    memset(&flash, 0, sizeof flash);
    memset(flash.memory, 0xFF, sizeof flash.memory);
    flash.cut_at = NEVER;
    start();
}

void tearDown(void)
{
}

/* A set by its number: 1 to SET_MAX bytes. */
static uint32_t make_set(unsigned number, uint8_t *bytes)
{
    const uint32_t size = 1 + number * 37U % 199U;

    for (uint32_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(number * 101U + i * 13U);
    return size;
}

/* In pieces of seven bytes, as they may come. */
static bool save(unsigned number)
{
    uint8_t bytes[SET_MAX];
    const uint32_t size = make_set(number, bytes);
    bool good = takt_store_begin(&store, size);

    for (uint32_t i = 0; i < size && good; i += 7)
        good = takt_store_write(&store, bytes + i, size - i < 7 ? size - i : 7);
    return good && takt_store_commit(&store);
}

static bool holds(unsigned number)
{
    uint8_t expected[SET_MAX];
    const uint8_t *bytes;
    uint32_t size;

    return takt_store_get(&store, &bytes, &size) && size == make_set(number, expected) &&
           memcmp(bytes, expected, size) == 0;
}

static void test_a_blank_flash_holds_nothing(void)
{
    const uint8_t *bytes;
    uint32_t size;

    TEST_ASSERT_FALSE(takt_store_get(&store, &bytes, &size));
    TEST_ASSERT_FALSE(takt_store_commit(&store));
    TEST_ASSERT_NULL(takt_store_look(&store));
}

static void test_the_last_set_stored_is_there_after_power_off(void)
{
    for (unsigned i = 1; i <= 100; i++) {
        TEST_ASSERT_TRUE(save(i));
        TEST_ASSERT_TRUE(holds(i));
        start();
        TEST_ASSERT_TRUE(holds(i));
    }
}

static void test_every_size_up_to_the_room_can_be_stored_and_none_beyond(void)
{
    uint8_t bytes[SET_MAX + 1];
    const uint8_t *found;
    uint32_t size;

    memset(bytes, 0x5A, sizeof bytes);
    for (uint32_t i = 1; i <= takt_store_room(&store); i++) {
        TEST_ASSERT_TRUE(takt_store_begin(&store, i) && takt_store_write(&store, bytes, i));
        TEST_ASSERT_TRUE(takt_store_commit(&store));
        start();
        TEST_ASSERT_TRUE(takt_store_get(&store, &found, &size));
        TEST_ASSERT_EQUAL(i, size);
        TEST_ASSERT_EQUAL(0, (uintptr_t)found % 8);
    }
    TEST_ASSERT_FALSE(takt_store_begin(&store, takt_store_room(&store) + 1));
    TEST_ASSERT_FALSE(takt_store_begin(&store, 0));
}

static void test_a_set_that_is_not_complete_cannot_be_committed(void)
{
    TEST_ASSERT_TRUE(save(1));
    TEST_ASSERT_TRUE(takt_store_begin(&store, 10) &&
                     takt_store_write(&store, (const uint8_t *)"123456789", 9));
    TEST_ASSERT_NULL(takt_store_look(&store));
    TEST_ASSERT_FALSE(takt_store_commit(&store));
    TEST_ASSERT_TRUE(takt_store_write(&store, (const uint8_t *)"0", 1));
    TEST_ASSERT_EQUAL_MEMORY("1234567890", takt_store_look(&store), 10);
    TEST_ASSERT_FALSE(takt_store_write(&store, (const uint8_t *)"x", 1));
    TEST_ASSERT_FALSE_MESSAGE(takt_store_commit(&store), "given up");
    TEST_ASSERT_TRUE(holds(1));
}

static void test_a_flash_that_refuses_leaves_the_old_set(void)
{
    TEST_ASSERT_TRUE(save(1) && save(2) && save(3));
    flash.refuses = true;
    TEST_ASSERT_FALSE(save(4));
    TEST_ASSERT_TRUE(holds(3));
    flash.refuses = false;
    start();
    TEST_ASSERT_TRUE(holds(3));
    TEST_ASSERT_TRUE(save(4));
    TEST_ASSERT_TRUE(holds(4));
}

static void test_a_bit_lost_in_the_newer_set_brings_the_older_one_back(void)
{
    for (unsigned bit = 0; bit < 8 * HEAD_USED; bit++) {
        setUp();
        TEST_ASSERT_TRUE(save(1) && save(2));
        sector(1)[bit / 8] ^= (uint8_t)(1U << bit % 8);
        start();
        TEST_ASSERT_TRUE(holds(1));
    }
}

static void test_sequences_may_wrap(void)
{
    TEST_ASSERT_TRUE(save(1));
    store.sequence = UINT32_MAX - 1;
    for (unsigned i = 2; i < 8; i++) {
        TEST_ASSERT_TRUE(save(i));
        if (i > 2)
            start(); /* both sectors are near the wrap now */
        TEST_ASSERT_TRUE_MESSAGE(holds(i), "around the wrap");
    }
}

/* Three sets are there already, so that the sector to be written has to be erased first. */
static void prepare(void)
{
    memset(flash.memory, 0xFF, sizeof flash.memory);
    flash.cut_at = NEVER;
    start();
    TEST_ASSERT_TRUE(save(1) && save(2) && save(3));
}

/* Stores a set and has the power fail at a step. False: it was complete before that. */
static bool save_until(unsigned number, unsigned cut_at, enum cut cut)
{
    flash.steps = 0;
    flash.cut_at = cut_at;
    flash.cut = cut;
    if (setjmp(flash.power) == 0) {
        TEST_ASSERT_TRUE(save(number));
        flash.cut_at = NEVER;
        return false;
    }
    flash.cut_at = NEVER;
    return true;
}

static void test_after_a_cut_at_every_step_the_old_or_the_new_set_is_there(void)
{
    unsigned cuts = 0, old = 0, new = 0;

    for (unsigned cut = 0; cut < CUTS; cut++) {
        for (unsigned step = 0;; step++) {
            bool failed;

            prepare();
            failed = save_until(4, step, (enum cut)cut);
            start();
            TEST_ASSERT_TRUE_MESSAGE(holds(3) || holds(4), "neither the old nor the new set");
            if (!failed)
                break;
            cuts++;
            old += holds(3);
            new += holds(4);
            TEST_ASSERT_TRUE_MESSAGE(save(5) && holds(5), "nothing can be stored any more");
        }
    }
    printf("%u cuts: %u times the old set, %u times the new\n", cuts, old, new);
    TEST_ASSERT_GREATER_THAN(0, new);
    TEST_ASSERT_EQUAL(cuts, old + new);
}

/* The power fails again while what the first cut has left is written over. */
static void test_after_two_cuts_at_every_pair_of_steps_a_set_is_there(void)
{
    unsigned cuts = 0;

    for (unsigned kind = 0; kind < CUTS * CUTS; kind++) {
        for (unsigned first = 0, second = 0;; second++) {
            bool failed, failed_again;
            unsigned before;

            prepare();
            failed = save_until(4, first, (enum cut)(kind % CUTS));
            start();
            before = holds(4) ? 4 : 3;
            TEST_ASSERT_TRUE(holds(before));
            failed_again = save_until(5, second, (enum cut)(kind / CUTS));
            start();
            TEST_ASSERT_TRUE_MESSAGE(holds(before) || holds(5), "neither the old nor the new set");
            cuts += failed && failed_again;
            if (!failed)
                break;
            if (!failed_again) {
                first++;
                second = UINT32_MAX; /* 0 next */
            }
        }
    }
    printf("%u pairs of cuts\n", cuts);
    TEST_ASSERT_GREATER_THAN(1000, cuts);
}

static void test_random_cuts_one_after_the_other_never_lose_both_sets(void)
{
    unsigned last = 3, cuts = 0;

    prepare();
    for (unsigned number = 4; number < 20000; number++) {
        const bool failed =
            save_until(number, (unsigned)rand() % STEPS, (enum cut)((unsigned)rand() % CUTS));

        start();
        TEST_ASSERT_TRUE_MESSAGE(holds(last) || holds(number), "neither the old nor the new set");
        cuts += failed;
        if (holds(number))
            last = number;
    }
    printf("%u cuts in a row\n", cuts);
    TEST_ASSERT_GREATER_THAN(5000, cuts);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_blank_flash_holds_nothing);
    RUN_TEST(test_the_last_set_stored_is_there_after_power_off);
    RUN_TEST(test_every_size_up_to_the_room_can_be_stored_and_none_beyond);
    RUN_TEST(test_a_set_that_is_not_complete_cannot_be_committed);
    RUN_TEST(test_a_flash_that_refuses_leaves_the_old_set);
    RUN_TEST(test_a_bit_lost_in_the_newer_set_brings_the_older_one_back);
    RUN_TEST(test_sequences_may_wrap);
    RUN_TEST(test_after_a_cut_at_every_step_the_old_or_the_new_set_is_there);
    RUN_TEST(test_after_two_cuts_at_every_pair_of_steps_a_set_is_there);
    RUN_TEST(test_random_cuts_one_after_the_other_never_lose_both_sets);
    return UNITY_END();
}
