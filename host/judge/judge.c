#include "judge/judge.h"

#include "base/fnv.h"
#include "base/maths.h"
#include "judge/judge_curve.h"

#include <string.h>

/* Cycles from the one that begins a block on in which its joint shows, when no cycle ended at the joint. */
#define JUDGE_JOINT_CYCLES 2

void judge_init(struct judge *j, const struct machine *machine,
                const struct program_config *program, const struct source *source)
{
    memset(j, 0, sizeof *j);
    takt_program_open(&j->program, program, source);
    takt_offset_open(&j->offset, program);
    j->rate_hz = 1e6 / (double)machine->cycle_us;
    j->block.end = program->start;
    j->read_end = program->start;
    j->block.landed = true;
    j->cmd = program->start;
    j->figures.digest = FNV_START;
    for (unsigned i = 0; i < JUDGE_HISTORY; i++)
        j->sent[i] = program->start;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            j->axis[j->axes++] =
                (struct judge_axis){.axis = (enum axis)i, .x = program->start.at[i]};
    }
}

void judge_follow(struct judge *j, const struct machine *machine,
                  const struct program_config *program, const struct source *source, bool rounds)
{
    tube_judge_init(&j->tube, program, source, 1 / machine->resolution_per_mm);
    j->tube.exact_elsewhere = !rounds;
    j->rounds = rounds;
}

void judge_follow_tool(struct judge *j, const struct vibration_config *modes)
{
    struct point tool = j->cmd;

    vibration_init(&j->vibration, modes, 1 / j->rate_hz);
    vibration_follow(&j->vibration, &tool); /* it rests at the start */
}

void judge_free(struct judge *j)
{
    tube_judge_free(&j->tube);
}

static void raise_to(double *largest, double value)
{
    if (value > *largest)
        *largest = value;
}

/* The next motion of the judge's own reading. False: there is none. */
static bool next_motion(struct judge *j)
{
    struct move move = {0};
    struct diagnostic diagnostic;
    enum program_result result = PROGRAM_END;

    while (!j->program_ended) {
        result = takt_offset_next(&j->offset, &j->program, &move, &diagnostic);
        j->program_ended = result != PROGRAM_MOVE && result != PROGRAM_WAIT;
        if (result != PROGRAM_MOVE || move_is_motion(&move))
            break;
    }
    if (result != PROGRAM_MOVE)
        return false;
    j->block = (struct judge_block){
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
static double missed_end(const struct judge_block *block)
{
    struct point end;

    takt_curve_point(&block->curve, block->curve.length_mm, &end);
    return judge_distance(&end, &block->end);
}

/* Has the tap been as deep as the spindle lets it be? The deepest place is that of the last cycle. */
static bool has_turned(const struct judge *j)
{
    return j->block.turning_mm > 0 && judge_distance(&j->cmd, &j->block.end) <= j->block.turning_mm;
}

/* The block is left: has its end been hit? */
static void leave_block(struct judge *j)
{
    const struct judge_block *block = &j->block;

    if (block->landed || has_turned(j) || j->rounds)
        return;
    if (!block->ending && block->has_length)
        raise_to(&j->figures.landing_error_mm, missed_end(block));
    else
        raise_to(&j->figures.landing_error_mm,
                 block->passed ? block->passed_mm : judge_distance(&j->cmd, &block->end));
}

/* A block in which no cycle ended. */
static void pass_block(struct judge *j)
{
    if (j->block.has_length)
        raise_to(&j->figures.landing_error_mm, missed_end(&j->block));
}

/* What the executed path comes to at the end of its block. */
static double evaluate_end(const struct block *block, const struct point *end)
{
    struct point p;

    takt_curve_point(&block->curve, block->length_mm * block->scale, &p);
    return judge_distance(&p, end);
}

/* The block that leads to the block's end: of several pieces the last. */
static void begin_ending(struct judge *j, const struct block *block)
{
    j->block.ending = true;
    j->block.passed = block->end == JOINT_PASSED;
    if (j->block.passed)
        j->block.passed_mm = evaluate_end(block, &j->block.end);
}

static void enter_block(struct judge *j, const struct cycle_record *record)
{
    leave_block(j);
    j->joint_near = j->block.landed ? 1 : JUDGE_JOINT_CYCLES;
    j->step_inside = j->block.landed;
    j->strayed = record->block < j->block.number;
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

static void judge_path(struct judge *j, const struct cycle_record *record)
{
    double error;

    if (j->rounds) {
        j->block.landed = j->block.landed || record->landed;
        return;
    }
    if (!j->block.has_length) {
        raise_to(&j->figures.path_error_mm, judge_distance(&record->cmd, &j->block.end));
        return;
    }
    error = judge_curve_distance(&j->block.curve, &record->cmd, &j->block.fraction);
    raise_to(&j->figures.path_error_mm, error);
    if (j->step_inside)
        raise_to(&j->figures.chord_error_mm,
                 judge_curve_chord_error(&j->block.curve, &j->cmd, &record->cmd));
    if (record->landed) {
        raise_to(&j->figures.landing_error_mm, judge_distance(&record->cmd, &j->block.end));
        j->block.landed = true;
    }
    j->step_inside = true;
}

/* Feed step at a joint: change of the distance between setpoints from one cycle to the next. */
static void judge_feed(struct judge *j, const struct cycle_record *record)
{
    double feed = judge_distance(&record->cmd, &j->cmd) * j->rate_hz;

    if (j->joint_near > 0) {
        raise_to(&j->figures.joint_feed_step_mm_s, maths_abs(feed - j->feed_mm_s));
        j->joint_near--;
    }
    j->feed_mm_s = feed;
}

static void judge_axes(struct judge *j, const struct cycle_record *record)
{
    const struct point *expected = &j->sent[(j->figures.cycles + 1) % JUDGE_HISTORY];

    for (unsigned i = 0; i < j->axes; i++) {
        struct judge_axis *axis = &j->axis[i];
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

/* A setpoint of a path within a tolerance, which the tube judges: only ends of programmed motions are hit exactly. */
static void judge_smoothed(struct judge *j, const struct cycle_record *record,
                           const struct block *block)
{
    if (record->landed && !block->continues && point_is_same(&block->curve.end, &block->move.end))
        raise_to(&j->figures.landing_error_mm, judge_distance(&record->cmd, &j->block.end));
    j->block.landed = true;
    j->block.fraction = 1;
    j->step_inside = false;
}

static bool judge_tube(struct judge *j, const struct cycle_record *record)
{
    struct point place = record->cmd;

    if (j->vibration.any)
        vibration_follow(&j->vibration, &place);
    return tube_judge_add(&j->tube, &place, record->block);
}

bool judge_add(struct judge *j, const struct cycle_record *record, const struct block *block)
{
    if (record->block != j->block.number && !j->strayed)
        enter_block(j, record);
    const bool smoothed =
        block_is_motion(block) && (block->curve.kind == CURVE_SPLINE || j->block.rounded);

    if (!smoothed && !j->block.ending && !block->continues && !j->block.landed)
        begin_ending(j, block);
    j->sent[j->figures.cycles % JUDGE_HISTORY] = record->set;
    if (smoothed)
        judge_smoothed(j, record, block);
    else
        judge_path(j, record);
    judge_feed(j, record);
    judge_axes(j, record);
    raise_to(&j->figures.correction_mm, judge_distance(&record->cmd, &record->set));
    j->cmd = record->cmd;
    j->figures.cycles++;
    return judge_tube(j, record);
}

/* A probing move may end early: where the axes have come to rest. That this is on its way has been seen by judge_path. */
static void end_probing(struct judge *j, const struct point *rest_at)
{
    raise_to(&j->figures.landing_error_mm, judge_distance(&j->cmd, rest_at));
    j->block.end = *rest_at;
    j->read_end = *rest_at;
    j->block.landed = true;
    j->block.probing = false;
}

void judge_answer(struct judge *j, const struct program_answer *answer)
{
    tube_judge_answer(&j->tube, answer);
    if (j->strayed)
        return;
    if (j->block.probing && j->block.has_length)
        end_probing(j, &answer->rest_at);
    leave_block(j);
    j->block.landed = true;
    while (next_motion(j))
        pass_block(j);
    takt_offset_answer(&j->offset, &j->program, answer);
}

/* What the tube has found. Corners that have not been come to are not judged. */
static void take_tube(struct judge *j, bool completed)
{
    const struct tube_figures *tube = &j->tube.figures;

    if (completed)
        tube_judge_finish(&j->tube);
    else
        tube_judge_stop(&j->tube);
    j->figures.path_length_mm = tube->path_length_mm;
    raise_to(&j->figures.path_error_mm, tube->beyond_mm);
    j->figures.smoothed_path_part = tube->path_part;
    j->figures.smoothed_corner_part = tube->corner_part;
}

void judge_finish(struct judge *j, bool completed)
{
    if (completed) {
        j->block.passed = false; /* nothing follows that it could be passed into */
        leave_block(j);
    }
    take_tube(j, completed);
}

int judge_get_missing(const struct judge *j)
{
    struct judge copy = *j;
    int missing = 0;

    if (j->strayed)
        return -1;
    while (next_motion(&copy))
        missing += copy.block.has_length ? 1 : 0;
    return missing;
}
