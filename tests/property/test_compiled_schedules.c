/*
 * Programs planned ahead, whatever the operator does: random programs on random machines are
 * compiled, and replayed under random schedules of overrides, holds and single block, the file as a
 * stream that is now and then late. The setpoints keep every axis's limits by differences, are
 * within the tolerance of the programmed path, stop only on it, and end in the programmed end.
 *
 * test_compiled_schedules NUMBER runs this many programs instead of PROGRAMS,
 * test_compiled_schedules NUMBER FIRST from that seed on.
 */
#include "ahead/compile.h"
#include "chain_distance.h"
#include "motion/handover.h"
#include "property_arguments.h"
#include "random_schedule.h"
#include "replay/replay.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

/* Programs in each run of all tests, and schedules of each. */
#define PROGRAMS  3
#define SCHEDULES 6

#define MOVES_MAX 60

/* A program that takes longer stands still for ever. */
#define CYCLES_MAX 1000000

/* Moves around the present one that a setpoint may be beside. */
#define AROUND 40

static struct path path;
static struct motion motion;
static struct replay replay;
static struct compile compile;
static unsigned programs = PROGRAMS;
static unsigned first_seed = 1;

struct run {
    struct chain chain;
    struct plan_limits limits;
    enum chain_family family;
    double tolerance_mm;
    uint32_t ceiling_percent;
    unsigned moves;
    struct move move[MOVES_MAX];
    struct curve curve[MOVES_MAX];
    bool has_length[MOVES_MAX];
    struct point end;
    FILE *compiled;
    /* of one schedule */
    /* the compiled program comes while it runs: bytes_a_cycle in each, from a cycle on */
    bool is_stream;
    size_t came, taken;
    double bytes_a_cycle;
    uint64_t comes_from;
    unsigned pushed;
    struct schedule schedule;
    bool single_block;
    uint64_t single_until; /* cycle in which it is switched */
    uint64_t start_at;     /* cycle in which the operator goes on after a block */
    unsigned landed;       /* blocks that ended at rest */
    uint32_t last_landed;
    struct chain_verifier verifier;
    struct point last;
    double path_mm;
    bool stands_well; /* whatever record said to be landed on stood still */
};

static struct run run;

void setUp(void)
{
}

void tearDown(void)
{
}

static void random_machine(struct run *r)
{
    static const double cycles_s[] = {5e-4, 1e-3, 2e-3};
    struct chain *c = &r->chain;
    struct plan_limits *l = &r->limits;

    memset(l, 0, sizeof(*l));
    l->axes = 7;
    l->cycle_s = cycles_s[(unsigned)chain_between(c, 0, 3)];
    l->chord_error_max_mm = 1e-3;
    l->landing = LANDING_SPAN;
    for (int i = 0; i < CHAIN_AXES; i++) {
        l->velocity_mm_s[i] = chain_decades(c, 1.3, 2.5);
        l->acceleration_mm_s2[i] = chain_decades(c, 2.5, 3.8);
        l->jerk_mm_s3[i] = chain_decades(c, 3.9, 5.5);
    }
}

static void add_move(struct run *r, const struct move *m)
{
    r->has_length[r->moves] = takt_move_curve(m, &r->end, &r->curve[r->moves]);
    r->move[r->moves++] = *m;
    r->end = m->end;
}

static void random_program(struct run *r, unsigned seed)
{
    memset(r, 0, sizeof(*r));
    r->chain.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    random_machine(r);
    r->family = (enum chain_family)chain_between(&r->chain, 0, CHAIN_MIXED + 1);
    r->tolerance_mm = chain_decades(&r->chain, -2.5, -0.7);
    r->ceiling_percent = chain_between(&r->chain, 0, 1) < 0.5 ? 100 : 120;
    const unsigned moves = (unsigned)chain_decades(&r->chain, 0.5, 1.7);

    for (unsigned i = 0; i < moves; i++) {
        struct move m = chain_next(&r->chain, r->family, i);

        m.path = PATH_BLEND;
        m.tolerance_mm = r->tolerance_mm;
        add_move(r, &m);
    }
}

static const struct move end_of_program = {.kind = MOVE_END};

static enum compile_result compile_program(struct run *r)
{
    const struct point start = {{0}};
    const struct compile_config config = {.limits = r->limits,
                                          .cycle_us =
                                              (uint32_t)takt_maths_round(1e6 * r->limits.cycle_s),
                                          .ceiling_percent = r->ceiling_percent,
                                          .tolerance_part = 1,
                                          .tolerance_mm = r->tolerance_mm,
                                          .workers = 1,
                                          .blocks = r->moves};
    enum compile_result result = compile_begin(&compile, &config, &start, r->compiled);

    for (unsigned i = 0; i < r->moves && result == COMPILE_DONE; i++) {
        result = compile_add(&compile, &r->move[i]);
    }
    if (result == COMPILE_DONE) {
        result = compile_add(&compile, &end_of_program);
    }
    if (result == COMPILE_DONE) {
        result = compile_end(&compile);
    }
    compile_free(&compile);
    return result;
}

static size_t read_compiled(void *context, uint8_t *bytes, size_t size)
{
    struct run *r = context;
    const size_t there = r->came - r->taken;
    const size_t count = fread(bytes, 1, size < there ? size : there, r->compiled);

    r->taken += count;
    return count;
}

static bool is_never_lost(void *context)
{
    (void)context;
    return false;
}

static void push_next(struct run *r)
{
    struct move m = r->pushed < r->moves ? r->move[r->pushed] : end_of_program;

    takt_replay_prepare(&m);
    takt_path_push(&path, &m);
    if (r->pushed++ >= r->moves) {
        takt_path_finish(&path);
    }
}

/* Now and then the stream pauses. */
static void receive(struct run *r)
{
    if (!r->is_stream) {
        r->came = r->taken + REPLAY_RECORD_MAX;
    } else if (motion.cycles >= r->comes_from) {
        r->came += (size_t)(r->bytes_a_cycle + chain_between(&r->chain, 0, 1));
    }
    if (r->is_stream && chain_between(&r->chain, 0, 1) < 0.0005) {
        r->comes_from = motion.cycles + (uint64_t)chain_decades(&r->chain, 0, 3.5);
        r->bytes_a_cycle = chain_decades(&r->chain, 0, 2);
    }
}

static void background(struct run *r)
{
    receive(r);
    takt_replay_read(&replay, &r->limits);
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    takt_path_go_on(&path);
    while (!path.finished && takt_path_has_room(&path)) {
        push_next(r);
    }
    takt_motion_build(&motion);
}

/* A schedule's operator, who now and then wants single block, and then goes on when it pleases. */
static struct motion_operator operator_at(struct run *r)
{
    struct motion_operator wanted;

    schedule_follow(&r->schedule, &r->chain, motion.cycles);
    if (motion.cycles >= r->single_until) {
        r->single_block = !r->single_block;
        r->single_until = motion.cycles + (uint64_t)chain_decades(&r->chain, 0, 3.5);
    }
    wanted = r->schedule.now;
    wanted.single_block = r->single_block;
    wanted.hold = wanted.hold || motion.cycles < r->start_at;
    return wanted;
}

static void verify_cycle(struct run *r, const struct cycle_record *record)
{
    const unsigned first = record->block > AROUND ? record->block - AROUND : 0;
    const unsigned last = record->block + AROUND < r->moves ? record->block + AROUND : r->moves;
    double least = MATHS_INFINITY;

    for (unsigned i = first; i < last && least > 0.1 * r->tolerance_mm; i++) {
        if (r->has_length[i]) {
            least = maths_min(least, chain_distance_from(&r->curve[i], &record->cmd));
        }
    }
    if (least < MATHS_INFINITY) {
        r->path_mm = maths_max(r->path_mm, least);
    }
    chain_verifier_setpoint(&r->verifier, &r->limits, &record->cmd);
    r->last = record->cmd;
}

/* After a block the operator looks at it for a while. */
static void look_at_landing(struct run *r, const struct motion_operator *wanted,
                            const struct cycle_record *record)
{
    if (!record->landed) {
        return;
    }
    r->stands_well = r->stands_well && takt_motion_rests(&motion) && record->block > r->last_landed;
    r->last_landed = record->block;
    r->landed++;
    if (wanted->single_block) {
        r->start_at = motion.cycles + (uint64_t)chain_decades(&r->chain, 0, 2);
    }
}

static void begin_replay(struct run *r, bool is_stream)
{
    const struct point start = {{0}};
    const struct replay_source source = {
        .context = r, .read = read_compiled, .is_lost = is_stream ? is_never_lost : NULL};

    rewind(r->compiled);
    takt_path_init(&path, &r->limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    takt_handover_allow(&motion, MOTION_HANDS_OVER_LINEAR);
    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    memset(&r->schedule, 0, sizeof(r->schedule));
    r->schedule.now = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    r->schedule.target = 1.0;
    r->is_stream = is_stream;
    r->came = 0;
    r->taken = 0;
    r->bytes_a_cycle = 10.0;
    r->comes_from = 0;
    r->pushed = 0;
    r->single_block = false;
    r->single_until = (uint64_t)chain_decades(&r->chain, 0, 3);
    r->start_at = 0;
    r->landed = 0;
    r->last_landed = 0;
    r->stands_well = true;
    memset(&r->verifier, 0, sizeof(r->verifier));
    memset(&r->last, 0, sizeof(r->last));
    r->path_mm = 0.0;
}

static enum motion_result cycle(struct run *r)
{
    const struct motion_operator wanted = operator_at(r);
    struct cycle_record record = {0};
    enum motion_result result;

    background(r);
    result = takt_motion_cycle(&motion, &wanted, &record);
    if (result == MOTION_HANDED_OVER) {
        if (takt_replay_cycle(&replay, &motion, &wanted, &record) == REPLAY_FAILED) {
            return MOTION_EMPTY;
        }
        result = MOTION_CYCLE;
    }
    if (result == MOTION_CYCLE) {
        verify_cycle(r, &record);
        look_at_landing(r, &wanted, &record);
    }
    return result;
}

static enum motion_result run_schedule(struct run *r, bool is_stream)
{
    enum motion_result result;

    begin_replay(r, is_stream);
    do {
        result = cycle(r);
    } while ((result == MOTION_CYCLE || result == MOTION_NOT_YET) && motion.cycles < CYCLES_MAX);
    return result;
}

/*
 * What takt compile asks of a program before it writes it, as it would run with nobody near. A path
 * that turns back on itself may not keep it.
 */
static bool is_written(struct run *r)
{
    begin_replay(r, false);
    r->single_until = UINT64_MAX;
    r->schedule.until = UINT64_MAX;
    while (cycle(r) != MOTION_DONE && motion.cycles < CYCLES_MAX) {
    }
    return r->path_mm <= r->tolerance_mm;
}

static void check_run(const struct run *r, enum motion_result result, unsigned seed,
                      unsigned schedule)
{
    char message[240];

    (void)snprintf(message, sizeof(message),
                   "seed %u schedule %u family %d moves %u cycle %g s P %g: %llu cycles, %u stops, "
                   "v %.5f a %.5f j %.5f, path %.4f P, alarm %d",
                   seed, schedule, (int)r->family, r->moves, r->limits.cycle_s, r->tolerance_mm,
                   (unsigned long long)motion.cycles, r->landed, r->verifier.velocity,
                   r->verifier.acceleration, r->verifier.jerk, r->path_mm / r->tolerance_mm,
                   (int)replay.alarm.code);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MOTION_DONE, result, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.velocity <= 1.0001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.acceleration <= 1.0001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.jerk <= 1.001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->path_mm <= r->tolerance_mm, message);
    TEST_ASSERT_TRUE_MESSAGE(r->stands_well, message);
    TEST_ASSERT_TRUE_MESSAGE(chain_distance(&r->last, &r->end) == 0.0, message);
}

/*
 * What the compiler finds no motion for, or its verifier refuses, it says so: that is no matter of
 * the replay.
 */
static void test_limits_and_path_are_kept_under_any_schedule(void)
{
    unsigned compiled = 0;

    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        random_program(&run, seed);
        run.compiled = tmpfile();
        TEST_ASSERT_NOT_NULL(run.compiled);
        if (compile_program(&run) == COMPILE_DONE && is_written(&run)) {
            compiled++;
            for (unsigned schedule = 0; schedule < SCHEDULES; schedule++) {
                const enum motion_result result = run_schedule(&run, schedule % 2 == 1);

                check_run(&run, result, seed, schedule);
            }
        }
        (void)fclose(run.compiled);
    }
    TEST_ASSERT_TRUE(10 * compiled >= 9 * programs);
}

static struct motion_operator operator_of_single_blocks(void)
{
    return (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0, .single_block = true};
}

/* Lines of 0.2 to 20 mm with corners, single block all along. */
static void test_single_block_stops_at_the_end_of_every_block(void)
{
    uint32_t next = 1;

    random_program(&run, 1);
    random_machine(&run);
    memset(&run.end, 0, sizeof(run.end));
    memset(&run.chain.at, 0, sizeof(run.chain.at));
    run.moves = 0;
    run.tolerance_mm = 0.01;
    for (unsigned i = 0; i < MOVES_MAX; i++) {
        run.chain.heading_rad += chain_between(&run.chain, -2.0, 2.0);
        struct move m = chain_line(&run.chain, chain_decades(&run.chain, -0.7, 1.3), 0.0);

        m.path = PATH_BLEND;
        m.tolerance_mm = run.tolerance_mm;
        add_move(&run, &m);
        run.chain.at = m.end;
    }
    run.compiled = tmpfile();
    TEST_ASSERT_NOT_NULL(run.compiled);
    TEST_ASSERT_EQUAL_INT(COMPILE_DONE, compile_program(&run));
    begin_replay(&run, false);
    for (enum motion_result result = MOTION_CYCLE; result != MOTION_DONE;) {
        const struct motion_operator wanted = operator_of_single_blocks();
        struct cycle_record record = {0};

        background(&run);
        result = takt_motion_cycle(&motion, &wanted, &record);
        if (result == MOTION_HANDED_OVER) {
            TEST_ASSERT_EQUAL_INT(REPLAY_CYCLE,
                                  takt_replay_cycle(&replay, &motion, &wanted, &record));
        }
        if (record.landed) {
            TEST_ASSERT_EQUAL_UINT32(next, record.block);
            TEST_ASSERT_TRUE(takt_motion_rests(&motion));
            TEST_ASSERT_TRUE(chain_distance(&record.cmd, &run.move[next - 1].end) <=
                             2.0 * run.tolerance_mm);
            next++;
        }
        TEST_ASSERT_TRUE(motion.cycles < CYCLES_MAX);
    }
    TEST_ASSERT_EQUAL_UINT32(MOVES_MAX + 1, next);
    (void)fclose(run.compiled);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_limits_and_path_are_kept_under_any_schedule);
    RUN_TEST(test_single_block_stops_at_the_end_of_every_block);
    return UNITY_END();
}
