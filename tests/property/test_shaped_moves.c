/*
 * Planner, motion and shaping together, on random chains and random machines with random modes:
 * setpoints that are sent keep the axes' limits by differences, and where they come to rest nothing
 * of any mode is left.
 *
 * test_shaped_moves NUMBER [FIRST] runs this many seeds from FIRST on instead of SEEDS.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"
#include "shape/shape.h"
#include "vibration/vibration.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define SEEDS      60
#define MOVES      12
#define CYCLES_MAX 2000000

/*
 * A swing of this part of what a whole step of the acceleration makes of the softest mode is
 * rounding.
 */
#define NOTHING 1e-9

static unsigned seeds = SEEDS;
static unsigned first_seed = 1;
static struct path path;
static struct motion motion;
static struct shape shape;
static struct vibration swings;
static struct chain_verifier seen;

/* Lengths in mm, times in s. */
struct task {
    struct plan_limits limits;
    struct shape_config shape;
    struct vibration_config modes;
    enum chain_family family;
    double softest_s; /* 1/w */
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void random_modes(struct chain *c, struct task *t, double ramp_s)
{
    const bool two = chain_between(c, 0, 1) < 0.5;

    for (unsigned i = 0; i < CHAIN_AXES; i++) {
        for (unsigned n = 0; n < (two ? SHAPE_MODES : 1U); n++) {
            double *number = &t->modes.mode[i][(size_t)n * VIBRATION_NUMBERS];

            number[VIBRATION_HZ] = maths_clamp(chain_decades(c, -1.0, 0.5) / ramp_s, 10.0, 60.0);
            number[VIBRATION_DAMPING] = chain_between(c, 0.02, 0.1);
            number[VIBRATION_PART] = two ? 0.5 : 1.0;
            t->shape.mode[i][n] = (struct shape_mode){
                number[VIBRATION_HZ], number[VIBRATION_DAMPING], number[VIBRATION_PART]};
            t->softest_s = maths_max(t->softest_s, 1.0 / (MATHS_TWO_PI * number[VIBRATION_HZ]));
        }
    }
}

/*
 * A machine by what has no dimension: cycles of a ramp of acceleration, such ramps in one to the
 * highest feed, and periods of the modes in a ramp, clamped to 10 ... 60 Hz.
 */
static struct task random_task(uint64_t task_seed)
{
    struct chain c = {.seed = task_seed};
    struct task t = {.limits = {.axes = 7, .chord_error_max_mm = 1e-3, .landing = LANDING_SPAN}};
    const double cycle_s = chain_between(&c, 0, 1) < 0.5 ? 1e-3 : 5e-4;
    const double ramp_s = cycle_s * chain_decades(&c, 0.5, 2.0);
    const double a = chain_decades(&c, 2.0, 4.0);

    t.limits.cycle_s = t.shape.cycle_s = cycle_s;
    t.limits.profile = chain_between(&c, 0, 1) < 0.7 ? RAMP_PROFILE_JERK : RAMP_PROFILE_SMOOTH;
    for (unsigned i = 0; i < CHAIN_AXES; i++) {
        t.limits.acceleration_mm_s2[i] = a * chain_decades(&c, -0.3, 0.3);
        t.limits.jerk_mm_s3[i] = a / ramp_s * chain_decades(&c, -0.3, 0.3);
        t.limits.velocity_mm_s[i] = a * ramp_s * chain_decades(&c, 0.0, 1.0);
    }
    t.shape.train = takt_zv_train;
    t.shape.keeps_way = chain_between(&c, 0, 1) < 0.5;
    t.family = (enum chain_family)chain_between(&c, 0, CHAIN_MIXED + 0.99);
    random_modes(&c, &t, ramp_s);
    return t;
}

static void push_moves(struct chain *c, const struct task *t)
{
    struct move end = {.kind = MOVE_END};

    for (unsigned i = 0; i < MOVES; i++) {
        struct move m = chain_next(c, t->family, i);

        takt_path_push(&path, &m);
    }
    takt_path_push(&path, &end);
    takt_path_finish(&path);
}

/*
 * What goes on swinging on the tool's side of an axis: (away, rate) of each mode by its amplitude.
 */
static double swing_of(const struct task *t, unsigned axis)
{
    double sum = 0;

    for (unsigned n = 0; n < VIBRATION_MODES; n++) {
        const struct vibration_mode *mode = &swings.axis[axis].mode[n];
        const double w = MATHS_TWO_PI * t->modes.mode[axis][(size_t)n * VIBRATION_NUMBERS];
        const double rate = w > 0 ? mode->rate_mm_s / w : 0;

        sum += mode->away_mm * mode->away_mm + rate * rate;
    }
    return maths_sqrt(sum);
}

static void check_rest(const struct task *t, uint64_t seed)
{
    char text[80];

    (void)snprintf(text, sizeof text, "seed %lu", (unsigned long)seed);
    for (unsigned i = 0; i < CHAIN_AXES; i++) {
        const double whole = t->limits.acceleration_mm_s2[i] * t->softest_s * t->softest_s;

        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(NOTHING * whole, 0, swing_of(t, i), text);
    }
}

/*
 * What is sent instead of the setpoint, verified and followed by the modes; also when the program
 * is done.
 */
static void send(const struct task *t, struct point at)
{
    takt_shape_cycle(&shape, &at);
    chain_verifier_setpoint(&seen, &t->limits, &at);
    vibration_follow(&swings, &at);
}

static unsigned run(const struct task *t, uint64_t seed)
{
    struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record = {0};
    enum motion_result cycle = MOTION_CYCLE;
    unsigned rests = 0;
    bool rested = true;

    while (cycle == MOTION_CYCLE && motion.cycles < CYCLES_MAX) {
        const bool rests_now = takt_shape_is_settled(&shape);

        if (takt_motion_wanted(&motion) != NULL) {
            takt_motion_build(&motion);
        }
        as_programmed.settles = !rests_now;
        cycle = takt_motion_cycle(&motion, &as_programmed, &record);
        send(t, record.cmd);
        if (rests_now && !rested && takt_shape_is_settled(&shape)) {
            rests++;
            check_rest(t, seed);
        }
        rested = rests_now;
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, cycle);
    return rests;
}

static void run_seed(uint64_t seed)
{
    const struct task t = random_task(seed);
    const struct point start = {{0}};
    struct chain c = {.seed = seed + 1000};
    struct plan_limits limits = t.limits;
    char text[80];

    memset(&seen, 0, sizeof seen);
    TEST_ASSERT_NULL(takt_shape_init(&shape, &t.shape));
    takt_shape_leave(&shape, &limits);
    vibration_init(&swings, &t.modes, limits.cycle_s);
    vibration_follow(&swings, &(struct point){{0}});
    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    push_moves(&c, &t);
    (void)snprintf(text, sizeof text, "seed %lu", (unsigned long)seed);
    TEST_ASSERT_TRUE_MESSAGE(run(&t, seed) > 0, text);
    TEST_ASSERT_TRUE_MESSAGE(seen.velocity <= 1.0001, text);
    TEST_ASSERT_TRUE_MESSAGE(seen.acceleration <= 1.0001, text);
    TEST_ASSERT_TRUE_MESSAGE(seen.jerk <= 1.001, text);
}

static void test_limits_are_kept_and_nothing_swings_at_rest(void)
{
    for (unsigned i = 0; i < seeds; i++) {
        run_seed(first_seed + i);
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &seeds, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_limits_are_kept_and_nothing_swings_at_rest);
    return UNITY_END();
}
