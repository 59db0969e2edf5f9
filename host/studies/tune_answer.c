#include "studies/tune_answer.h"

#include "base/maths.h"

#include <math.h>

/*
 * The step: part of the motor's torque that it asks for at first, and how many steps of the encoder
 * it has at least.
 */
#define STEP_TORQUE 0.5
#define STEP_STEPS  40

/*
 * The move: parts of the travel and of the motor's acceleration, and turns of the motor, at most.
 */
#define MOVE_TRAVEL 0.05
#define MOVE_TORQUE 0.4
#define MOVE_TURNS  2

/* Time constants until a loop has settled, and limits of that. */
#define SETTLE_TIMES 12
#define SETTLE_MIN_S 0.2
#define SETTLE_MAX_S 4.0

/* Rests of the move: before it, and between its ways; behind it is as long as behind the step. */
#define REST_S 0.2

/*
 * In the last part of the time of a step, or of the rest behind a move, the axis stays within this
 * part of the step, or this many steps of the encoder.
 */
#define LAST_PART    0.2
#define STEADY_PART  0.1
#define STEADY_STEPS 4

/* Until the slower of both has settled, whose integral part unloads as its Kv lets it. */
static double settle_s_of(const struct tuning_gains *before, const struct tuning_gains *found)
{
    const double kv = maths_min(before->position_gain_per_s, found->position_gain_per_s);
    const double ti = maths_max(before->velocity_integral_s, found->velocity_integral_s);

    return maths_clamp(SETTLE_TIMES * (1 / kv + ti / 2), SETTLE_MIN_S, SETTLE_MAX_S);
}

struct tune_task tune_task_of(const struct tune_axis *result, const struct tuning_gains *found,
                              const struct tune_drive *drive, const struct machine_axis *axis)
{
    const struct drive_plant_config *plant = &drive->config.plant;
    const double travel = axis->travel_max_mm - axis->travel_min_mm;
    const double most =
        result->plant.travel_per_rad * plant->torque_max_nm / result->plant.inertia_kg_m2;
    const double kp = MATHS_TWO_PI * found->velocity_bandwidth_hz, kv = found->position_gain_per_s;
    const double a = maths_min(axis->max_acceleration_mm_s2, MOVE_TORQUE * most);
    const double window = plant->following_error_window_mm;
    const double inwards =
        plant->start_mm > (axis->travel_min_mm + axis->travel_max_mm) / 2 ? -1 : 1;
    struct tune_task task = {
        .step = maths_max(STEP_TORQUE * most / (kp * kv), STEP_STEPS * result->position_step),
        .settle_s = settle_s_of(&result->before.gains, found),
        .way = maths_min(MOVE_TRAVEL * travel, MOVE_TURNS * plant->travel_per_revolution_mm),
    };

    if (window > 0)
        task.step = maths_min(task.step, window / 2);
    task.step = inwards * maths_min(task.step, MOVE_TRAVEL * travel);
    /*
     * s = 10 u^3 - 15 u^4 + 6 u^5: 1.875 of way/time, 5.774 of way/time^2, 60 of way/time^3 at
     * most.
     */
    task.move_s = maths_max(
        1.875 * task.way / axis->max_velocity_mm_s,
        maths_max(sqrt(5.774 * task.way / a), cbrt(60 * task.way / axis->max_jerk_mm_s3)));
    task.way *= inwards;
    return task;
}

static void cycle(struct tuning_record *record, struct tune_drive *drive, double told)
{
    tune_drive_aim(drive, told);
    tune_drive_cycle(drive);
    tuning_record_add(record, told, tune_drive_position(drive));
}

/* The axis is where it was told to be at the end, and does not swing about it. */
static bool is_at_rest(const struct tuning_record *r, double waited_s, double step)
{
    const size_t last = r->count - (size_t)(LAST_PART * waited_s / r->cycle_s);
    const double room = maths_max(STEADY_PART * maths_abs(step), STEADY_STEPS * r->step);

    for (size_t k = last; k < r->count; k++) {
        if (maths_abs(r->position[k] - r->input[k]) > room)
            return false;
    }
    return true;
}

static const char *start(struct tune_answer *answer, struct tune_drive *drive,
                         struct tuning_record *record, const struct tuning_gains *gains)
{
    tuning_record_free(record);
    if (!tune_drive_start(drive, CIA402_MODE_CYCLIC_SYNC_POSITION))
        return "its drive has no mode of cyclic position (8), or does not come to be enabled";
    if (!tune_drive_set_gains(drive, gains))
        return "its drive does not take these gains";
    answer->is_steady = true;
    return NULL;
}

static const char *run_step(struct tune_answer *answer, struct tune_drive *drive,
                            const struct tune_task *task)
{
    struct tuning_record *r = &answer->step;
    struct tuning_gains gains = answer->gains;
    const double cycle_s = 1e-9 * drive->cycle_ns;
    const char *wrong;
    double most = 0;

    gains.velocity_forward = gains.torque_forward = 0;
    wrong = start(answer, drive, r, &gains);
    if (wrong != NULL)
        return wrong;
    const double from = tune_drive_position(drive);

    for (unsigned k = 0; k < task->settle_s / cycle_s; k++) {
        cycle(r, drive, from + task->step);
        most = maths_max(most, (r->position[r->count - 1] - from) / task->step - 1);
    }
    answer->overshoot = most;
    answer->is_steady = tune_drive_is_enabled(drive) && is_at_rest(r, task->settle_s, task->step);
    return r->failed ? "out of memory" : NULL;
}

/* Part of the move's way at a part of its time. */
static double part_of(double u)
{
    const double at = maths_clamp(u, 0, 1);

    return at * at * at * (10 + at * (6 * at - 15));
}

static const char *run_move(struct tune_answer *answer, struct tune_drive *drive,
                            const struct tune_task *task)
{
    struct tuning_record *r = &answer->move;
    const double cycle_s = 1e-9 * drive->cycle_ns;
    const bool was_steady = answer->is_steady;
    const char *wrong = start(answer, drive, r, &answer->gains);
    const double back_s = 2 * REST_S + task->move_s, end_s = back_s + task->move_s + task->settle_s;
    double square = 0;

    if (wrong != NULL)
        return wrong;
    const double from = tune_drive_position(drive);

    answer->error_max = 0;
    for (unsigned k = 0; k < end_s / cycle_s; k++) {
        const double t = (k + 1) * cycle_s;
        const double there =
            part_of((t - REST_S) / task->move_s) - part_of((t - back_s) / task->move_s);

        cycle(r, drive, from + task->way * there);
        const double error = r->input[r->count - 1] - r->position[r->count - 1];

        answer->error_max = maths_max(answer->error_max, maths_abs(error));
        square += error * error;
    }
    answer->error_rms = sqrt(square / (double)r->count);
    answer->is_steady =
        was_steady && tune_drive_is_enabled(drive) && is_at_rest(r, task->settle_s, task->step);
    return r->failed ? "out of memory" : NULL;
}

const char *tune_answer_run(struct tune_answer *answer, struct tune_drive *drive,
                            const struct tune_task *task)
{
    const char *wrong;

    answer->step.cycle_s = answer->move.cycle_s = 1e-9 * drive->cycle_ns;
    wrong = run_step(answer, drive, task);
    return wrong != NULL ? wrong : run_move(answer, drive, task);
}
