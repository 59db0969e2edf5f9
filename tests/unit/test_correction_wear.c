/*
 * Wear of tools that point anywhere. Verified by the worn tool itself: corrected, it is to touch
 * the floor and the wall that the unworn one has touched. The head turns by Rodrigues' formula, and
 * the wall's normal is what is left of "to the right" when the way and the tool have been taken out
 * of it (Gram-Schmidt).
 */
#include "correction/correction.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define CYCLE_S 0.001
#define TRIALS  400
#define CYCLES  4000 /* of a trial; in the second half all fades end */
#define SIDE    AXIS_LINEAR_COUNT

static struct correction c;
static struct correction_settings settings;
static struct move move;
static uint64_t state;
static const struct point origin = {{0}};

void setUp(void)
{
    takt_correction_settings_set_default(&settings);
    settings.fade_s = 0.5;
    memset(&move, 0, sizeof move);
    move.kind = MOVE_FEED;
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

static double dot(const double a[SIDE], const double b[SIDE])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* v -= its part along the unit vector e */
static void take_out(const double e[SIDE], double v[SIDE])
{
    const double part = dot(e, v);

    for (int i = 0; i < SIDE; i++)
        v[i] -= part * e[i];
}

static double to_unit(double v[SIDE])
{
    const double length = sqrt(dot(v, v));

    for (int i = 0; i < SIDE; i++)
        v[i] /= length;
    return length;
}

static void random_direction(double v[SIDE])
{
    do {
        for (int i = 0; i < SIDE; i++)
            v[i] = between(-1, 1);
    } while (to_unit(v) < 0.2);
}

/* v cos + (e x v) sin + e (e . v) (1 - cos), e one of the axes. */
static void turn(int about, double angle, double v[SIDE])
{
    double e[SIDE] = {0};

    e[about] = 1;
    const double cross[SIDE] = {e[1] * v[2] - e[2] * v[1], e[2] * v[0] - e[0] * v[2],
                                e[0] * v[1] - e[1] * v[0]};
    const double along = dot(e, v) * (1 - cos(angle));

    for (int i = 0; i < SIDE; i++)
        v[i] = v[i] * cos(angle) + cross[i] * sin(angle) + e[i] * along;
}

/* "To the right" of the way, seen from the plane's third axis. */
static void get_right(const double way[SIDE], double right[SIDE])
{
    static const int third[] = {[PLANE_XY] = 2, [PLANE_ZX] = 1, [PLANE_YZ] = 0};
    double down[SIDE];

    memcpy(down, way, sizeof down);
    down[third[move.plane]] = 0;
    turn(third[move.plane], -acos(0), down);
    memcpy(right, down, sizeof down);
}

static void start(void)
{
    takt_correction_init(&c, &settings, 0x3f, CYCLE_S, NULL, &origin);
    move.tool = 5;
    takt_correction_set_wear(&c, 5, between(0, 20000), between(0, 600));
}

/* Cuts along way, the head at angle, and stands until K has come. */
static void cut(const double way[SIDE], double angle, double k[SIDE])
{
    struct point at, set;

    for (int i = 0; i <= CYCLES; i++) {
        const int gone = i < CYCLES / 2 ? i : CYCLES / 2;

        at = (struct point){{gone * way[0], gone * way[1], gone * way[2]}};
        move.kind = i < CYCLES / 2 ? MOVE_FEED : MOVE_DWELL;
        if (settings.head_axis < AXIS_COUNT)
            at.at[settings.head_axis] = angle;
        takt_correction_cycle(&c, &at, &move, &set);
    }
    for (int i = 0; i < SIDE; i++)
        k[i] = set.at[i] - at.at[i];
}

/* What the tool has lost by now, along or across. */
static double lost(double per_mm, double mm_s)
{
    double length_mm, time_s;

    takt_correction_get_wear(&c, 5, &length_mm, &time_s);
    return per_mm * length_mm + mm_s * time_s;
}

static void random_wear(void)
{
    settings.wear_along_per_mm = between(0, 2e-6);
    settings.wear_along_mm_s = between(0, 5e-5);
    settings.wear_across_per_mm = between(0, 2e-6);
    settings.wear_across_mm_s = between(0, 5e-5);
}

/*
 * A tool somewhere, the plane, and the side of its contour. Returns the head's angle; d is where
 * the tool points.
 */
static double random_tool(double d[SIDE])
{
    const double angle = between(-7, 7);

    settings.head_axis = (uint32_t)between(AXIS_A, AXIS_COUNT + 0.999);
    move.plane = (enum plane)between(0, 2.999);
    move.contour_side = (uint8_t)between(0, 2.999);
    random_direction(d);
    for (int i = 0; i < SIDE; i++)
        settings.tool_direction[i] = 7 * d[i]; /* its length says nothing */
    if (settings.head_axis < AXIS_COUNT)
        turn((int)settings.head_axis - AXIS_A, angle, d);
    return angle;
}

/* The normal of the wall on the right. False: the plane hardly tells which side that is. */
static bool get_normal(const double way[SIDE], const double d[SIDE], double normal[SIDE])
{
    double beside[SIDE];

    memcpy(beside, d, sizeof beside);
    take_out(way, beside);
    const double slant = to_unit(beside);

    get_right(way, normal);
    take_out(way, normal);
    take_out(beside, normal);
    return to_unit(normal) > 0.05 && slant > 0.05;
}

/* Where the worn tool's point is, beside the unworn one's. */
static bool check_tool(void)
{
    static const double side[] = {[CUTTER_OFF] = 0, [CUTTER_LEFT] = 1, [CUTTER_RIGHT] = -1};
    double d[SIDE], way[SIDE], normal[SIDE], k[SIDE];
    const double angle = random_tool(d);

    random_wear();
    random_direction(way);
    if (!get_normal(way, d, normal))
        return false;
    for (int i = 0; i < SIDE; i++)
        way[i] *= 0.01;
    start();
    cut(way, angle, k);
    const double along = lost(settings.wear_along_per_mm, settings.wear_along_mm_s);
    const double across = lost(settings.wear_across_per_mm, settings.wear_across_mm_s);

    for (int i = 0; i < SIDE; i++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, side[move.contour_side] * across * normal[i],
                                  k[i] + along * d[i]);
    return true;
}

static void test_a_worn_tool_touches_what_it_has_touched_whichever_way_it_points(void)
{
    int checked = 0;

    state = 20250;
    for (int i = 0; i < TRIALS; i++)
        checked += check_tool() ? 1 : 0;
    TEST_ASSERT_TRUE(checked > TRIALS * 3 / 4);
}

static void test_a_tool_that_says_nothing_of_its_direction_stands_along_z(void)
{
    double k[SIDE];

    settings.wear_along_per_mm = 1e-6;
    takt_correction_init(&c, &settings, 0x7, CYCLE_S, NULL, &origin);
    takt_correction_set_wear(&c, 0, 5000, 0);
    cut((double[]){0, 0, 0}, 0, k);
    TEST_ASSERT_EQUAL_DOUBLE(0, k[AXIS_X]);
    TEST_ASSERT_EQUAL_DOUBLE(0, k[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -5e-3, k[AXIS_Z]);
}

/* The largest velocity, acceleration and jerk so far. */
static void see_differences(double k[4][SIDE], double most_seen[3][SIDE])
{
    const double t = CYCLE_S;

    for (int i = 0; i < SIDE; i++) {
        const double v = (k[0][i] - k[1][i]) / t;
        const double a = (k[0][i] - 2 * k[1][i] + k[2][i]) / (t * t);
        const double j = (k[0][i] - 3 * k[1][i] + 3 * k[2][i] - k[3][i]) / (t * t * t);

        most_seen[0][i] = fmax(most_seen[0][i], fabs(v));
        most_seen[1][i] = fmax(most_seen[1][i], fabs(a));
        most_seen[2][i] = fmax(most_seen[2][i], fabs(j));
    }
}

/* The head swings as fast as its axis may, while the tool is set and reset. */
static void test_a_head_that_turns_takes_no_more_of_the_axes_than_it_asked_for(void)
{
    const double swing = 0.5, rate = 4;
    struct motion_bound most = {.velocity_mm_s[AXIS_B] = swing * rate,
                                .acceleration_mm_s2[AXIS_B] = swing * rate * rate,
                                .jerk_mm_s3[AXIS_B] = swing * rate * rate * rate};
    struct need need;
    double k[4][SIDE] = {{0}}, most_seen[3][SIDE] = {{0}};

    settings.head_axis = AXIS_B;
    settings.wear_along_per_mm = 1e-6;
    takt_correction_init(&c, &settings, 0x3f, CYCLE_S, NULL, &origin);
    memset(&need, 0, sizeof need);
    takt_correction_get_need(&c, &most, &need);
    for (int i = 0; i < 20000; i++) {
        const struct point at = {{0, 0, 0, 0, swing * sin(rate * CYCLE_S * i)}};
        struct point set;

        if (i % 700 == 0)
            takt_correction_set_wear(&c, 0, i / 700 % 2 == 0 ? 1e5 : 0, 0);
        takt_correction_cycle(&c, &at, &move, &set);
        memmove(k[1], k[0], 3 * sizeof k[0]);
        for (int j = 0; j < SIDE; j++)
            k[0][j] = set.at[j] - at.at[j];
        see_differences(k, most_seen);
    }
    for (int j = 0; j < SIDE; j++) {
        TEST_ASSERT_TRUE(most_seen[0][j] <= need.velocity_mm_s[j]);
        TEST_ASSERT_TRUE(most_seen[1][j] <= need.acceleration_mm_s2[j]);
        TEST_ASSERT_TRUE(most_seen[2][j] <= need.jerk_mm_s3[j]);
    }
    TEST_ASSERT_TRUE(most_seen[0][AXIS_X] > 0.1 * need.velocity_mm_s[AXIS_X]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_worn_tool_touches_what_it_has_touched_whichever_way_it_points);
    RUN_TEST(test_a_tool_that_says_nothing_of_its_direction_stands_along_z);
    RUN_TEST(test_a_head_that_turns_takes_no_more_of_the_axes_than_it_asked_for);
    return UNITY_END();
}
