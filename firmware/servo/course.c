/*
 * With N cycles t averaged, the acceleration of the average changes by (a(k) - a(k - N)) / N in a
 * cycle. Accelerations of the trapezoid are between A and -D, in its last cycle -2 D, so that
 *
 *     |jerk| <= (A + 2 D) / (N t) <= J   with   N = ceil((A + 2 D) / (J t))
 *
 * whatever the target does. The average comes to the target N cycles after the trapezoid, and stays
 * between the places that it has been at: no overshoot. Rejected: seven segments planned at each
 * target, which is as exact at rest only, and a jerk chosen in each cycle by the way to stop, which
 * lands in steps of its own rounding.
 */
#include "servo/course.h"

#include "base/assert.h"
#include "base/maths.h"

#define COURSE_PLACES_PER_MM 1e9

/*
 * The highest velocity u' at the end of a cycle t from which the rest of the way s can still be
 * braked to e by d, when the cycle itself begins with u towards the target:
 *     s - (u + u') t / 2 >= (u'^2 - e^2) / (2 d)
 * so  u' = -d t / 2 + sqrt((d t / 2)^2 + d (2 s - u t) + e^2)
 */
static double allowed_velocity(double way_mm, double u_mm_s, const struct course_ramps *ramps,
                               double t_s)
{
    double d_mm_s2 = ramps->deceleration_mm_s2;
    double half = d_mm_s2 * t_s / 2;
    double square =
        half * half + d_mm_s2 * (2 * way_mm - u_mm_s * t_s) + ramps->end_mm_s * ramps->end_mm_s;
    TAKT_ASSERT(way_mm >= 0.0 && t_s > 0.0);
    return square > half * half ? maths_sqrt(square) - half : 0;
}

double takt_course_approach(double value, double goal, double by)
{
    TAKT_ASSERT(by >= 0.0);
    if (maths_abs(goal - value) <= by)
        return goal;
    return goal > value ? value + by : value - by;
}

void takt_course_step(struct course *course, double target_mm, const struct course_ramps *ramps,
                      double cycle_s)
{
    double way_mm = target_mm - course->at_mm;
    double sign = way_mm < 0 ? -1 : 1;
    double u_mm_s = sign * course->velocity_mm_s;
    double brake_mm_s = ramps->deceleration_mm_s2 * cycle_s;
    TAKT_ASSERT(cycle_s > 0.0);
    if (maths_abs(way_mm) <= brake_mm_s * cycle_s && maths_abs(u_mm_s) <= 2 * brake_mm_s) {
        *course = (struct course){target_mm, 0};
        return;
    }
    double allowed_mm_s = allowed_velocity(maths_abs(way_mm), u_mm_s, ramps, cycle_s);
    double wanted_mm_s = maths_min(ramps->velocity_mm_s, allowed_mm_s);
    double by_mm_s =
        wanted_mm_s > u_mm_s && u_mm_s >= 0 ? ramps->acceleration_mm_s2 * cycle_s : brake_mm_s;
    double velocity_mm_s = sign * takt_course_approach(u_mm_s, wanted_mm_s, by_mm_s);
    double mean_mm_s = (course->velocity_mm_s + velocity_mm_s) / 2;
    *course = (struct course){course->at_mm + mean_mm_s * cycle_s, velocity_mm_s};
}

static int64_t place_of(double at_mm)
{
    return (int64_t)takt_maths_round(at_mm * COURSE_PLACES_PER_MM);
}

/*
 * Begins with this many cycles in which the axis has moved evenly, so that their average is where
 * it is now.
 */
static void begin(struct course_average *average, const struct course *command, uint32_t count,
                  double cycle_s)
{
    double step_mm = command->velocity_mm_s * cycle_s;
    TAKT_ASSERT(count >= 1 && count <= COURSE_CYCLES_MAX);
    average->course =
        (struct course){command->at_mm + step_mm * (count - 1) / 2, command->velocity_mm_s};
    average->count = count;
    average->next = 0;
    average->sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        average->place[i] = place_of(average->course.at_mm - step_mm * (count - 1 - i));
        average->sum += average->place[i];
    }
}

static uint32_t cycles_of(const struct course_ramps *ramps, double cycle_s)
{
    double change_mm_s2 = ramps->acceleration_mm_s2 + 2 * ramps->deceleration_mm_s2;
    TAKT_ASSERT(cycle_s > 0.0);
    return (uint32_t)maths_clamp(takt_maths_ceil(change_mm_s2 / (ramps->jerk_mm_s3 * cycle_s)), 1,
                                 COURSE_CYCLES_MAX);
}

/* Once all places are the same, that is exactly where the trapezoid is. */
static double push(struct course_average *average)
{
    int64_t place = place_of(average->course.at_mm);
    TAKT_ASSERT(average->count > 0 && average->next < average->count);
    average->sum += place - average->place[average->next];
    average->place[average->next] = place;
    average->next = (average->next + 1) % average->count;
    return average->sum == place * average->count
               ? average->course.at_mm
               : (double)average->sum / (COURSE_PLACES_PER_MM * average->count);
}

bool takt_course_is_elsewhere(const struct course_average *average, const struct course *command)
{
    return average->count == 0 || average->out_mm != command->at_mm;
}

void takt_course_step_average(struct course_average *average, struct course *command,
                              double target_mm, const struct course_ramps *ramps, double cycle_s)
{
    uint32_t count = cycles_of(ramps, cycle_s);
    bool rests = command->velocity_mm_s == 0 && average->course.velocity_mm_s == 0;
    if (takt_course_is_elsewhere(average, command) || (rests && average->count != count))
        begin(average, command, count, cycle_s);
    takt_course_step(&average->course, target_mm, ramps, cycle_s);
    average->out_mm = push(average);
    command->velocity_mm_s = (average->out_mm - command->at_mm) / cycle_s;
    command->at_mm = average->out_mm;
}
