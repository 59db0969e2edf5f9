/*
 * What a service keeps over power-off: as text and back, and on a disk that loses power at every
 * one of its writes.
 */
#include "serve/state_keeper.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHANGES      300
#define SECTOR_BYTES 16384U
#define TOOLS        3

static struct tool tools[TOOLS], read_tools[TOOLS], offered_tools[TOOLS];
static struct state state, read;

/*
 * A disk: what has been brought to it, and what has only been written. When power fails at a step,
 * any part of what has only been written may be there.
 */
static struct disk {
    uint8_t kept[FLASH_SECTORS][SECTOR_BYTES], written[FLASH_SECTORS][SECTOR_BYTES];
    unsigned steps, fails_at; /* writes and syncs so far; the one power fails in */
    unsigned torn; /* how much of what is under way arrives: 0 nothing, 1 a half, 2 all */
    bool is_off;
} disk;

static void lose_power(unsigned file)
{
    const size_t arrives = disk.torn == 0 ? 0 : disk.torn == 1 ? SECTOR_BYTES / 7 : SECTOR_BYTES;

    disk.is_off = true;
    memcpy(disk.kept[file], disk.written[file], arrives);
}

static bool write_disk(void *context, unsigned file, uint32_t offset, const uint8_t *bytes,
                       size_t size)
{
    (void)context;
    if (disk.is_off)
        return false;
    TEST_ASSERT_TRUE(offset + size <= SECTOR_BYTES);
    if (disk.steps++ == disk.fails_at) {
        memcpy(disk.written[file] + offset, bytes, disk.torn == 1 ? size / 2 : size);
        lose_power(file);
        return false;
    }
    memcpy(disk.written[file] + offset, bytes, size);
    return true;
}

static bool sync_disk(void *context, unsigned file)
{
    (void)context;
    if (disk.is_off)
        return false;
    if (disk.steps++ == disk.fails_at) {
        lose_power(file);
        return false;
    }
    memcpy(disk.kept[file], disk.written[file], SECTOR_BYTES);
    return true;
}

static const struct state_disk_ops ops = {write_disk, sync_disk, NULL};

static void open_disk(struct state_disk *at, struct store *store)
{
    struct flash_port port;

    TEST_ASSERT_TRUE(state_disk_open_on(at, &ops, SECTOR_BYTES));
    for (unsigned i = 0; i < FLASH_SECTORS; i++)
        memcpy(state_disk_mirror(at, i), disk.kept[i], SECTOR_BYTES);
    port = state_disk_get_port(at);
    takt_store_open(store, &port);
}

/* Change number k of a session: an offset, a tool, its wear, the line. */
static void change(unsigned k)
{
    TEST_ASSERT_TRUE(takt_parameters_set(&state.parameters, 5221 + k % 6, 0.1 * k - 7));
    state.tools[k % TOOLS].offset.at[AXIS_Z] = 1.0 / 3 * k;
    state.wear[0] = (struct state_wear){3, 1.5 * k, 0.001 * k};
    state.line = k;
}

void setUp(void)
{
    memset(&disk, 0, sizeof disk);
    memset(disk.kept, 0xFF, sizeof disk.kept);
    memset(disk.written, 0xFF, sizeof disk.written);
    disk.fails_at = UINT32_MAX;
    memset(tools, 0, sizeof tools);
    for (unsigned i = 0; i < TOOLS; i++)
        tools[i].number = i + 1;
    state = (struct state){
        .machine = "mill, of two words", .tools = tools, .tools_count = TOOLS, .wears = 1};
    read = (struct state){.tools = read_tools, .tools_max = TOOLS};
}

void tearDown(void)
{
}

/* The change that the disk has now; 0: nothing. */
static unsigned look_at_disk(void)
{
    struct state_disk at;
    struct store store;
    char problem[STATE_PROBLEM_MAX + 1] = "";
    const uint8_t *bytes;
    uint32_t size;
    unsigned line = 0;

    open_disk(&at, &store);
    if (takt_store_get(&store, &bytes, &size)) {
        TEST_ASSERT_TRUE_MESSAGE(state_read(&read, (const char *)bytes, size, problem), problem);
        line = read.line;
    }
    state_disk_close(&at);
    return line;
}

static void expect_whole(unsigned k)
{
    TEST_ASSERT_TRUE(takt_parameters_get(&read.parameters, 5221 + k % 6) == 0.1 * k - 7);
    TEST_ASSERT_TRUE(read.tools[k % TOOLS].offset.at[AXIS_Z] == 1.0 / 3 * k);
    TEST_ASSERT_TRUE(read.wear[0].length_mm == 1.5 * k && read.wear[0].time_s == 0.001 * k);
}

/* Writes changes until power fails. Returns the last that the service was told is kept. */
static unsigned run_session(unsigned changes)
{
    struct state_disk at;
    struct store store;
    unsigned kept = 0;

    open_disk(&at, &store);
    for (unsigned k = 1; k <= changes && !disk.is_off; k++) {
        change(k);
        if (state_keeper_keep(&store, &state))
            kept = k;
    }
    state_disk_close(&at);
    return kept;
}

/* A change that is written to the disk as it is now; bytes, sync, head, sync are its four steps. */
#define STEPS 4

static bool keep_change(unsigned k)
{
    struct state_disk at;
    struct store store;
    bool good;

    open_disk(&at, &store);
    change(k);
    disk.steps = 0;
    good = state_keeper_keep(&store, &state);
    state_disk_close(&at);
    return good;
}

/* Power fails at one step of change k: the change before is there, or this one, and whole. */
static void cut_power(unsigned k, unsigned step, unsigned torn)
{
    static struct disk before;

    before = disk;
    disk.fails_at = step;
    disk.torn = torn;
    TEST_ASSERT_FALSE(keep_change(k));
    const unsigned found = look_at_disk();
    TEST_ASSERT_TRUE(found == k - 1 || found == k);
    if (found > 0)
        expect_whole(found);
    disk = before;
}

static void test_a_power_cut_at_every_write_leaves_the_last_state_or_the_one_before(void)
{
    for (unsigned k = 1; k <= CHANGES; k++) {
        for (unsigned i = 0; i < 3 * STEPS; i++)
            cut_power(k, i / 3, i % 3);
        TEST_ASSERT_TRUE(keep_change(k));
        TEST_ASSERT_EQUAL_UINT(STEPS, disk.steps);
        TEST_ASSERT_EQUAL_UINT(k, look_at_disk());
        expect_whole(k);
    }
}

/*
 * A session in virtual time: changes at random moments, a control thread that looks every
 * millisecond, a disk on which a state takes WRITE_NS. Power fails at one of the disk's steps.
 */
#define MILLISECOND_NS UINT64_C(1000000)
#define AGE_MAX_NS     (1000 * MILLISECOND_NS)

/*
 * The slowest disk for that age: a change waits until the write before it is done, at least
 * STATE_KEEPER_OFFER_NS from its offer on, and for its own write; and is seen two looks late.
 */
#define WRITE_NS ((AGE_MAX_NS - 2 * MILLISECOND_NS) / 2)

struct session {
    struct state_keeper keeper;
    uint64_t now_ns, next_change_ns,
        written_ns;                   /* written_ns: when the write under way is; 0: none is */
    uint64_t changed_ns[CHANGES + 1]; /* when each was made */
    unsigned changes, writes;
};

static uint32_t draw(uint32_t *state_of_dice, uint32_t below)
{
    *state_of_dice = *state_of_dice * 1664525U + 1013904223U;
    return (*state_of_dice >> 8) % below;
}

/* What the service's thread does, at the time at which it is done. */
static void finish_write(struct session *s)
{
    (void)state_keeper_keep(&s->keeper.store, &s->keeper.offered);
    atomic_store(&s->keeper.is_full, false);
    s->written_ns = 0;
    s->writes++;
}

static void offer(struct session *s)
{
    struct state *wanted = state_keeper_wants(&s->keeper, s->now_ns);

    if (wanted == NULL)
        return;
    struct tool *own = wanted->tools;
    *wanted = state;
    wanted->tools = own;
    memcpy(own, state.tools, sizeof tools);
    atomic_store(&s->keeper.is_full, true);
    s->written_ns = s->now_ns + WRITE_NS;
}

/* Until power fails, or all changes have been made and written. */
static void live(struct session *s, uint32_t seed)
{
    while (!disk.is_off && (s->changes < CHANGES || s->now_ns < s->next_change_ns + AGE_MAX_NS)) {
        s->now_ns += MILLISECOND_NS;
        if (s->changes < CHANGES && s->now_ns >= s->next_change_ns) {
            change(++s->changes);
            s->changed_ns[s->changes] = s->now_ns;
            s->next_change_ns += (1 + draw(&seed, 200)) * MILLISECOND_NS;
        }
        if (s->written_ns != 0 && s->now_ns >= s->written_ns)
            finish_write(s);
        offer(s);
    }
}

static void begin_session(struct session *s)
{
    struct flash_port port;

    setUp();
    memset(s, 0, sizeof *s);
    TEST_ASSERT_TRUE(state_disk_open_on(&s->keeper.disk, &ops, SECTOR_BYTES));
    for (unsigned i = 0; i < FLASH_SECTORS; i++)
        memset(state_disk_mirror(&s->keeper.disk, i), 0xFF, SECTOR_BYTES);
    port = state_disk_get_port(&s->keeper.disk);
    takt_store_open(&s->keeper.store, &port);
    s->keeper.offered.tools = offered_tools;
    s->keeper.is_running = true;
}

static void test_a_power_cut_at_every_write_of_a_session_loses_nothing_older_than_a_second(void)
{
    static struct session s;
    unsigned steps = 1;

    for (unsigned fails_at = 0; fails_at < steps; fails_at++) {
        begin_session(&s);
        disk.fails_at = fails_at;
        disk.torn = fails_at % 3;
        live(&s, 1);
        steps = disk.is_off ? fails_at + 2 : fails_at;
        const unsigned found = look_at_disk();
        if (found > 0)
            expect_whole(found);
        if (found < s.changes)
            TEST_ASSERT_LESS_OR_EQUAL_UINT64(AGE_MAX_NS, s.now_ns - s.changed_ns[found + 1]);
        state_disk_close(&s.keeper.disk);
    }
    TEST_ASSERT_EQUAL_UINT(CHANGES, s.changes);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(4 * 40, disk.steps);
    TEST_ASSERT_EQUAL_UINT(CHANGES, look_at_disk());
}

static void test_a_state_goes_on_after_a_power_cut(void)
{
    for (unsigned fails_at = 0; fails_at < 12; fails_at++) {
        setUp();
        disk.fails_at = fails_at;
        disk.torn = 1;
        (void)run_session(10);
        disk.is_off = false;
        memcpy(disk.written, disk.kept, sizeof disk.kept);
        disk.fails_at = UINT32_MAX;
        TEST_ASSERT_EQUAL_UINT(20, run_session(20));
        TEST_ASSERT_EQUAL_UINT(20, look_at_disk());
        expect_whole(20);
    }
}

static void test_what_has_not_changed_is_not_written(void)
{
    struct state_disk at;
    struct store store;

    open_disk(&at, &store);
    change(1);
    TEST_ASSERT_TRUE(state_keeper_keep(&store, &state));
    const unsigned steps = disk.steps;
    TEST_ASSERT_TRUE(state_keeper_keep(&store, &state));
    TEST_ASSERT_EQUAL_UINT(steps, disk.steps);
    state_disk_close(&at);
}

static bool reads(const char *text, char *problem)
{
    return state_read(&read, text, strlen(text), problem);
}

static void test_a_state_of_a_later_version_is_refused_and_lines_it_adds_are_skipped(void)
{
    char problem[STATE_PROBLEM_MAX + 1];

    TEST_ASSERT_FALSE(reads("takt-state 2\n", problem));
    TEST_ASSERT_NOT_NULL(strstr(problem, "later version"));
    TEST_ASSERT_TRUE(reads("takt-state 1\nfuture 1 2 3\nparameter 31 5\n", problem));
    TEST_ASSERT_TRUE(takt_parameters_get(&read.parameters, 31) == 5);
}

static void test_a_line_that_makes_no_sense_is_told(void)
{
    static const char *const wrong[] = {
        "parameter 0 1",    "parameter 5602 1", "parameter 31 nan", "parameter 31",
        "tool 1 0 1 2 3",   "wear -1 1 1",      "program 1 2",      "base 1",
        "parameter 31.5 1", "wear 1 inf 1",     "program 1 2 x",    "tool x",
    };
    char problem[STATE_PROBLEM_MAX + 1], text[200];

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        (void)snprintf(text, sizeof text, "takt-state 1\n%s\n", wrong[i]);
        TEST_ASSERT_FALSE_MESSAGE(reads(text, problem), wrong[i]);
        TEST_ASSERT_NOT_NULL(strstr(problem, wrong[i]));
    }
    TEST_ASSERT_FALSE(reads("takt-state 1\nparameter 31 5", problem)); /* no line end */
}

/*
 * Every text that is cut off or has one byte changed is read, or told to be wrong: nothing else
 * happens.
 */
static void test_any_bytes_are_read_or_refused(void)
{
    char problem[STATE_PROBLEM_MAX + 1];
    size_t length;
    char *text;

    change(17);
    text = state_write(&state, &length);
    TEST_ASSERT_NOT_NULL(text);
    for (size_t i = 0; i < length; i++) {
        const char before = text[i];

        (void)state_read(&read, text, i, problem);
        for (unsigned byte = 0; byte < 256; byte += 5) {
            text[i] = (char)byte;
            (void)state_read(&read, text, length, problem);
        }
        text[i] = before;
    }
    TEST_ASSERT_TRUE(state_read(&read, text, length, problem));
    expect_whole(17);
    TEST_ASSERT_EQUAL_STRING("mill, of two words", read.machine);
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_power_cut_at_every_write_leaves_the_last_state_or_the_one_before);
    RUN_TEST(test_a_power_cut_at_every_write_of_a_session_loses_nothing_older_than_a_second);
    RUN_TEST(test_a_state_goes_on_after_a_power_cut);
    RUN_TEST(test_what_has_not_changed_is_not_written);
    RUN_TEST(test_a_state_of_a_later_version_is_refused_and_lines_it_adds_are_skipped);
    RUN_TEST(test_a_line_that_makes_no_sense_is_told);
    RUN_TEST(test_any_bytes_are_read_or_refused);
    return UNITY_END();
}
