#include "verifier/verifier.h"

#include "base/fnv.h"
#include "base/maths.h"
#include "verifier/verifier_curve.h"

#include <string.h>

/*
 * Cycles from the one that begins a block on in which its junction shows, when no cycle ended at
 * the junction.
 */
#define VERIFIER_JUNCTION_CYCLES 2

void verifier_init(struct verifier *j, const struct machine *machine,
                   const struct program_config *program, const struct source *source)
{
    memset(j, 0, sizeof *j);
    takt_program_open(&j->program, program, source);
    takt_cutter_compensation_open(&j->offset, program);
    j->rate_hz = 1e6 / (double)machine->cycle_us;
    j->block.end = program->start;
    j->read_end = program->start;
    j->block.landed = true;
    j->cmd = program->start;
    j->figures.digest = FNV_START;
    for (unsigned i = 0; i < VERIFIER_HISTORY; i++)
        j->sent[i] = program->start;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            j->axis[j->axes++] =
                (struct verifier_axis){.axis = (enum axis)i, .x = program->start.at[i]};
    }
}

void verifier_follow(struct verifier *j, const struct machine *machine,
                     const struct program_config *program, const struct source *source, bool rounds)
{
    tube_verifier_init(&j->tube, program, source, 1 / machine->resolution_per_mm);
    j->tube.exact_elsewhere = !rounds;
    j->rounds = rounds;
}

void verifier_follow_tool(struct verifier *j, const struct vibration_config *modes)
{
    struct point tool = j->cmd;

    vibration_init(&j->vibration, modes, 1 / j->rate_hz);
    vibration_follow(&j->vibration, &tool); /* it rests at the start */
}

void verifier_free(struct verifier *j)
{
    tube_verifier_free(&j->tube);
}

static void raise_to(double *largest, double value)
{
    if (value > *largest)
        *largest = value;
}

/* The next motion of the verifier's own reading. False: there is none. */
static bool next_motion(struct verifier *j)
{
    struct move move = {0};
    struct diagnostic diagnostic;
    enum program_result result = PROGRAM_END;

    while (!j->program_ended) {
        result = takt_cutter_compensation_next(&j->offset, &j->program, &move, &diagnostic);
        j->program_ended = result != PROGRAM_MOVE && result != PROGRAM_WAIT;
        if (result != PROGRAM_MOVE || move_is_motion(&move))
            break;
    }
    if (result != PROGRAM_MOVE)
        return false;
    j->block = (struct verifier_block){
        .number = ++j->read,
        .end = move.end,
        .landed = true,
        .rounded = move.path == PATH_BLEND && move.tolerance_mm > 0 && move.kind < MOVE_THREAD &&
                   move.feed_rev_mm == 0,
        .probing = move.kind == MOVE_PROBE,
        .turning_mm = move.kind == MOVE_TAP ? TUBE_TURNING_REV * move.feed_rev_mm : 0};
    j->block.has_length = takt_move_curve(&move, &j->read_end, &j->block.curve);
    j->read_end = move.end;
    return true;
}

/* A block whose end no cycle has seen: its evaluated path must end where the program says. */
static double missed_end(const struct verifier_block *block)
{
    struct point end;

    takt_curve_point(&block->curve, block->curve.length_mm, &end);
    return verifier_distance(&end, &block->end);
}

/*
 * Has the tap been as deep as the spindle lets it be? The deepest place is that of the last cycle.
 */
static bool has_turned(const struct verifier *j)
{
    return j->block.turning_mm > 0 &&
           verifier_distance(&j->cmd, &j->block.end) <= j->block.turning_mm;
}

/* The block is left: has its end been hit? */
static void leave_block(struct verifier *j)
{
    const struct verifier_block *block = &j->block;

    if (block->landed || has_turned(j) || j->rounds)
        return;
    if (!block->ending && block->has_length)
        raise_to(&j->figures.landing_error_mm, missed_end(block));
    else
        raise_to(&j->figures.landing_error_mm,
                 block->passed ? block->passed_mm : verifier_distance(&j->cmd, &block->end));
}

/* A block in which no cycle ended. */
static void pass_block(struct verifier *j)
{
    if (j->block.has_length)
        raise_to(&j->figures.landing_error_mm, missed_end(&j->block));
}

/* What the executed path comes to at the end of its block. */
static double evaluate_end(const struct block *block, const struct point *end)
{
    struct point p;

    takt_curve_point(&block->curve, block->length_mm * block->scale, &p);
    return verifier_distance(&p, end);
}

/* The block that leads to the block's end: of several pieces the last. */
static void begin_ending(struct verifier *j, const struct block *block)
{
    j->block.ending = true;
    j->block.passed = block->end == JUNCTION_PASSED;
    if (j->block.passed)
        j->block.passed_mm = evaluate_end(block, &j->block.end);
}

static void enter_block(struct verifier *j, const struct cycle_record *record)
{
    leave_block(j);
    j->junction_near = j->block.landed ? 1 : VERIFIER_JUNCTION_CYCLES;
    j->step_inside = j->block.landed;
    j->strayed = record->block < j->told;
    while (j->block.number < record->block) {
        if (!next_motion(j)) {
            j->strayed = true;
            return;
        }
        if (j->block.number < record->block)
            pass_block(j);
    }
    j->figures.blocks = j->block.number;
    j->block.landed = false;
}

static void verify_path(struct verifier *j, const struct cycle_record *record)
{
    double error;

    if (j->rounds) {
        j->block.landed = j->block.landed || record->landed;
        return;
    }
    if (!j->block.has_length) {
        raise_to(&j->figures.path_error_mm, verifier_distance(&record->cmd, &j->block.end));
        return;
    }
    error = verifier_curve_distance(&j->block.curve, &record->cmd, &j->block.fraction);
    raise_to(&j->figures.path_error_mm, error);
    if (j->step_inside)
        raise_to(&j->figures.chord_error_mm,
                 verifier_curve_chord_error(&j->block.curve, &j->cmd, &record->cmd));
    if (record->landed) {
        raise_to(&j->figures.landing_error_mm, verifier_distance(&record->cmd, &j->block.end));
        j->block.landed = true;
    }
    j->step_inside = true;
}

/* Feed step at a junction: change of the distance between setpoints from one cycle to the next. */
static void verify_feed(struct verifier *j, const struct cycle_record *record)
{
    double feed = verifier_distance(&record->cmd, &j->cmd) * j->rate_hz;

    if (j->junction_near > 0) {
        raise_to(&j->figures.junction_feed_step_mm_s, maths_abs(feed - j->feed_mm_s));
        j->junction_near--;
    }
    j->feed_mm_s = feed;
}

static void verify_axes(struct verifier *j, const struct cycle_record *record)
{
    const struct point *expected = &j->sent[(j->figures.cycles + 1) % VERIFIER_HISTORY];

    for (unsigned i = 0; i < j->axes; i++) {
        struct verifier_axis *axis = &j->axis[i];
        double x = record->set.at[axis->axis];
        double v = (x - axis->x) * j->rate_hz;
        double a = (v - axis->v) * j->rate_hz;

        raise_to(&j->figures.velocity_mm_s[axis->axis], maths_abs(v));
        raise_to(&j->figures.acceleration_mm_s2[axis->axis], maths_abs(a));
        raise_to(&j->figures.jerk_mm_s3[axis->axis], maths_abs((a - axis->a) * j->rate_hz));
        raise_to(&j->figures.following_error_mm[axis->axis],
                 maths_abs(expected->at[axis->axis] - record->act.at[axis->axis]));
        j->figures.digest = takt_fnv_add_double(j->figures.digest, x);
        axis->x = x;
        axis->v = v;
        axis->a = a;
    }
}

/*
 * A setpoint of a path within a tolerance, which the tube verifies: only ends of programmed motions
 * are hit exactly.
 */
static void verify_smoothed(struct verifier *j, const struct cycle_record *record,
                            const struct block *block)
{
    if (record->landed && !block->continues && point_is_same(&block->curve.end, &block->move.end))
        raise_to(&j->figures.landing_error_mm, verifier_distance(&record->cmd, &j->block.end));
    j->block.landed = true;
    j->block.fraction = 1;
    j->step_inside = false;
}

static bool verify_tube(struct verifier *j, const struct cycle_record *record)
{
    struct point place = record->cmd;

    if (j->vibration.any)
        vibration_follow(&j->vibration, &place);
    return tube_verifier_add(&j->tube, &place, record->block);
}

/* Of X, Y and Z: that of a rotary axis is an angle. */
static double corrected_mm(const struct cycle_record *record)
{
    struct point set = record->cmd;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        set.at[i] = record->set.at[i];
    return verifier_distance(&record->cmd, &set);
}

bool verifier_add(struct verifier *j, const struct cycle_record *record, const struct block *block)
{
    if ((record->block > j->block.number || record->block < j->told) && !j->strayed)
        enter_block(j, record);
    j->told = record->block;
    const bool smoothed =
        block_is_motion(block) && (block->curve.kind == CURVE_SPLINE || j->block.rounded);

    if (!smoothed && !j->block.ending && !block->continues && !j->block.landed)
        begin_ending(j, block);
    j->sent[j->figures.cycles % VERIFIER_HISTORY] = record->set;
    if (smoothed)
        verify_smoothed(j, record, block);
    else
        verify_path(j, record);
    verify_feed(j, record);
    verify_axes(j, record);
    raise_to(&j->figures.correction_mm, corrected_mm(record));
    j->cmd = record->cmd;
    j->figures.cycles++;
    return verify_tube(j, record);
}

/*
 * A probing move may end early: where the axes have come to rest. That this is on its way has been
 * seen by judge_path.
 */
static void end_probing(struct verifier *j, const struct point *rest_at)
{
    raise_to(&j->figures.landing_error_mm, verifier_distance(&j->cmd, rest_at));
    j->block.end = *rest_at;
    j->read_end = *rest_at;
    j->block.landed = true;
    j->block.probing = false;
}

void verifier_answer(struct verifier *j, const struct program_answer *answer)
{
    tube_verifier_answer(&j->tube, answer);
    if (j->strayed)
        return;
    if (j->block.probing && j->block.has_length)
        end_probing(j, &answer->rest_at);
    leave_block(j);
    j->block.landed = true;
    while (next_motion(j))
        pass_block(j);
    takt_cutter_compensation_answer(&j->offset, &j->program, answer);
}

/* What the tube has found. Corners that have not been come to are not verified. */
static void take_tube(struct verifier *j, bool completed)
{
    const struct tube_figures *tube = &j->tube.figures;

    if (completed)
        tube_verifier_finish(&j->tube);
    else
        tube_verifier_stop(&j->tube);
    j->figures.path_length_mm = tube->path_length_mm;
    raise_to(&j->figures.path_error_mm, tube->beyond_mm);
    j->figures.smoothed_path_part = tube->path_part;
    j->figures.smoothed_corner_part = tube->corner_part;
}

void verifier_finish(struct verifier *j, bool completed)
{
    if (completed) {
        j->block.passed = false; /* nothing follows that it could be passed into */
        leave_block(j);
    }
    take_tube(j, completed);
}

int verifier_get_missing(const struct verifier *j)
{
    struct verifier copy = *j;
    int missing = 0;

    if (j->strayed)
        return -1;
    while (next_motion(&copy))
        missing += copy.block.has_length ? 1 : 0;
    return missing;
}
