/*
 * Planner and motion on involutes: whatever the base circle, the ends and the feed, setpoints keep
 * the axes' limits by differences, through the start and the end on the base circle too; the end is
 * hit; and wherever no limit binds, equal cycles go equal lengths.
 *
 * test_involutes NUMBER runs this many seeds of each family and machine instead of SEEDS.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3
#define SEEDS   50

static const struct plan_limits machines[] = {
    {7,
     {100, 100, 100},
     {1000, 1000, 1000},
     {50000, 50000, 50000},
     CYCLE_S,
     1e-3,
     RAMP_PROFILE_JERK,
     LANDING_SPAN},
    {7,
     {100, 60, 20},
     {1000, 400, 2000},
     {50000, 8000, 200000},
     CYCLE_S,
     1e-3,
     RAMP_PROFILE_JERK,
     LANDING_SPAN},
    {7,
     {500, 500, 500},
     {200, 5000, 5000},
     {1e6, 1e6, 1e5},
     CYCLE_S,
     1e-2,
     RAMP_PROFILE_JERK,
     LANDING_SPAN},
    {7,
     {500, 500, 500},
     {20000, 20000, 20000},
     {2e6, 2e6, 2e6},
     CYCLE_S,
     1e-4,
     RAMP_PROFILE_JERK,
     LANDING_SPAN},
};

static unsigned seeds = SEEDS;
static struct path path;
static struct motion motion;
static struct chain_verifier seen;

/* What a run is about. */
struct task {
    double radius_mm; /* of the base circle */
    double from_rad;  /* unrolled, at the start */
    double to_rad;
    double turned_rad; /* of the whole */
    bool mirrored;
    double rise_mm;
    double feed_mm_s;
    bool lines; /* a line before and behind, in the direction of the ends */
};

void setUp(void)
{
}

void tearDown(void)
{
}

static double heading_of(const struct task *t, double phi)
{
    return (t->mirrored ? -1.0 : 1.0) * (phi + t->turned_rad);
}

/* Seed 001, eq. 11, about the centre of the base circle. */
static struct point point_of(const struct task *t, double phi)
{
    const double angle = phi + t->turned_rad;
    struct point p = {{0}};

    p.at[AXIS_X] = t->radius_mm * (takt_maths_cos(angle) + phi * takt_maths_sin(angle));
    p.at[AXIS_Y] = t->radius_mm * (takt_maths_sin(angle) - phi * takt_maths_cos(angle));
    p.at[AXIS_Y] *= t->mirrored ? -1.0 : 1.0;
    return p;
}

static void push_line(const struct task *t, struct point *at, double phi, double length_mm)
{
    const double way = t->to_rad > t->from_rad ? length_mm : -length_mm;
    struct move m = {.kind = MOVE_FEED, .feed_mm_s = t->feed_mm_s, .turns = 1};

    m.end = *at;
    m.end.at[AXIS_X] += way * takt_maths_cos(heading_of(t, phi));
    m.end.at[AXIS_Y] += way * takt_maths_sin(heading_of(t, phi));
    *at = m.end;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    takt_path_push(&path, &m);
}

static void push_all(const struct task *t, struct point *at)
{
    const bool outward = t->to_rad > t->from_rad;
    struct move m = {.plane = PLANE_XY, .feed_mm_s = t->feed_mm_s, .turns = 1};

    if (t->lines) {
        push_line(t, at, t->from_rad, 5.0);
    }
    m.kind = outward == t->mirrored ? MOVE_INVOLUTE_CW : MOVE_INVOLUTE_CCW;
    m.base_radius_mm = t->radius_mm;
    m.end = point_of(t, t->to_rad);
    m.end.at[AXIS_Z] = t->rise_mm;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    takt_path_push(&path, &m);
    *at = m.end;
}

static struct point start_of(const struct task *t)
{
    struct point at = point_of(t, t->from_rad);

    if (t->lines) {
        const double way = t->to_rad > t->from_rad ? -5.0 : 5.0;

        at.at[AXIS_X] += way * takt_maths_cos(heading_of(t, t->from_rad));
        at.at[AXIS_Y] += way * takt_maths_sin(heading_of(t, t->from_rad));
    }
    return at;
}

/*
 * Calls each for every setpoint. Few blocks of look-ahead: an involute has more pieces than find
 * room at once.
 */
static void run(const struct task *t, const struct plan_limits *limits, uint32_t look_ahead,
                void (*each)(const struct task *t, const struct cycle_record *record))
{
    struct point at = start_of(t);
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct move stop = {.kind = MOVE_END};
    struct cycle_record record;
    enum motion_result result;
    unsigned pushed = 0;

    memset(&seen, 0, sizeof(seen));
    takt_path_init(&path, limits, &at);
    takt_motion_init(&motion, &path, &at, false);
    for (int axis = 0; axis < CHAIN_AXES; axis++) {
        for (int i = 0; i < 4; i++) {
            seen.history[axis][i] = at.at[axis];
        }
    }
    for (;;) {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            while (!path.finished && takt_path_has_room(&path) &&
                   takt_motion_ahead(&motion) < look_ahead) {
                if (pushed == 0) {
                    push_all(t, &at);
                } else if (pushed == 1 && t->lines) {
                    push_line(t, &at, t->to_rad, 5.0);
                } else {
                    takt_path_push(&path, &stop);
                    takt_path_finish(&path);
                }
                pushed++;
            }
            takt_motion_build(&motion);
        }
        result = takt_motion_cycle(&motion, &as_programmed, &record);
        if (result != MOTION_CYCLE) {
            break;
        }
        chain_verifier_setpoint(&seen, limits, &record.cmd);
        if (each != NULL) {
            each(t, &record);
        }
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    TEST_ASSERT_EQUAL_MEMORY(&at, &record.cmd, sizeof(at));
}

static struct task random_task(uint64_t task_seed)
{
    struct chain c = {.seed = task_seed};
    struct task t = {0};

    t.radius_mm = chain_decades(&c, -2.0, 2.0);
    const double near = chain_between(&c, 0, 1) < 0.5 ? 0.0 : chain_decades(&c, -3, 1);
    const double far = near + chain_decades(&c, -1, 2.0) / maths_sqrt(t.radius_mm);
    const bool inward = chain_between(&c, 0, 1) < 0.5;

    t.from_rad = inward ? far : near;
    t.to_rad = inward ? near : far;
    t.turned_rad = chain_between(&c, -3, 3);
    t.mirrored = chain_between(&c, 0, 1) < 0.5;
    t.rise_mm = chain_between(&c, 0, 1) < 0.5 ? 0.0 : chain_between(&c, -20, 20);
    t.feed_mm_s = chain_between(&c, 0, 1) < 0.5 ? 500.0 : chain_between(&c, 5, 105);
    t.lines = chain_between(&c, 0, 1) < 0.5;
    return t;
}

static void check_limits(uint32_t look_ahead)
{
    double most = 0.0;

    for (unsigned m = 0; m < sizeof(machines) / sizeof(machines[0]); m++) {
        for (unsigned s = 1; s <= seeds; s++) {
            const struct task t = random_task(s);
            char where[160];

            run(&t, &machines[m], look_ahead, NULL);
            (void)snprintf(where, sizeof(where),
                           "seed %u, machine %u, look-ahead %u: r %g, %g to %g rad: v %g a %g j %g",
                           s, m, (unsigned)look_ahead, t.radius_mm, t.from_rad, t.to_rad,
                           seen.velocity, seen.acceleration, seen.jerk);
            TEST_ASSERT_TRUE_MESSAGE(seen.velocity <= 1.0001, where);
            TEST_ASSERT_TRUE_MESSAGE(seen.acceleration <= 1.0001, where);
            TEST_ASSERT_TRUE_MESSAGE(seen.jerk <= 1.001, where);
            most = maths_max(most, seen.jerk);
        }
    }
    TEST_ASSERT_TRUE(most > 0.5);
}

static void test_random_involutes_keep_the_limits(void)
{
    check_limits(256);
}

static void test_small_windows_keep_the_limits(void)
{
    check_limits(1);
    check_limits(2);
    check_limits(5);
}

/*
 * Where on the involute a setpoint is, from its distance d from the centre alone: (d^2 - r^2) / (2
 * r)
 */
static struct {
    double last_mm;
    bool cruised;
    unsigned equal;
    double worst;
} steps;

static void measure_step(const struct task *t, const struct cycle_record *record)
{
    const double x = record->cmd.at[AXIS_X];
    const double y = record->cmd.at[AXIS_Y];
    const double at_mm = 0.5 * (x * x + y * y) / t->radius_mm;
    const double step_mm = maths_abs(at_mm - steps.last_mm);
    const bool cruising = maths_abs(record->feed_mm_s / t->feed_mm_s - 1.0) < 1e-10;

    if (cruising && steps.cruised) {
        steps.worst = maths_max(steps.worst, maths_abs(step_mm / (t->feed_mm_s * CYCLE_S) - 1.0));
        steps.equal++;
    }
    steps.cruised = cruising;
    steps.last_mm = at_mm;
}

/*
 * The hole of the page: r 0.63, 20 turns, out and in again. Distances are known to 1e-13 mm,
 * lengths to 1e-11.
 */
static void test_equal_cycles_go_equal_lengths_where_no_limit_binds(void)
{
    const double turns = 20.0 * MATHS_TWO_PI;
    struct task t = {.radius_mm = 79.0 / turns, .to_rad = turns, .feed_mm_s = 25.0};

    for (int way = 0; way < 2; way++) {
        memset(&steps, 0, sizeof(steps));
        run(&t, &machines[0], 256, measure_step);
        TEST_ASSERT_TRUE(steps.equal > 190000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, steps.worst);
        t.from_rad = turns;
        t.to_rad = 0.0;
    }
}

int main(int argc, char **argv)
{
    read_number(argc, argv, &seeds);
    UNITY_BEGIN();
    RUN_TEST(test_random_involutes_keep_the_limits);
    RUN_TEST(test_small_windows_keep_the_limits);
    RUN_TEST(test_equal_cycles_go_equal_lengths_where_no_limit_binds);
    return UNITY_END();
}
