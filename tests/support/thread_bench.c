#include "support/thread_bench.h"

#include <string.h>
#include <unity.h>

void bench_set_default(struct bench *b)
{
    memset(b, 0, sizeof(*b));
    b->limits = (struct plan_limits){.axes = 7, .cycle_s = 1e-3, .chord_error_max_mm = 1e-3};
    for (int i = 0; i < BENCH_AXES; i++) {
        b->limits.velocity_mm_s[i] = 100.0;
        b->limits.acceleration_mm_s2[i] = 1000.0;
        b->limits.jerk_mm_s3[i] = 50000.0;
    }
    virtual_spindle_set_default(&b->spindle_config);
    b->operator=(struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    b->look_ahead = 64;
    b->spindle_sync_config = (struct spindle_sync_config){
        .ahead_cycles = BENCH_AHEAD,
        .tolerance_mm = 0.1,
        .wait_s = 10.0,
    };
}

static void bench_add(struct bench *b, const struct move *m)
{
    TEST_ASSERT_TRUE(b->moves < BENCH_MOVES_MAX);
    b->move[b->moves++] = *m;
}

void bench_turn(struct bench *b, double rpm)
{
    const struct move m = {.kind = MOVE_SPINDLE,
                           .direction = rpm < 0.0 ? SPINDLE_CCW : SPINDLE_CW,
                           .speed_rpm = maths_abs(rpm)};

    bench_add(b, &m);
}

void bench_go(struct bench *b, enum move_kind kind, double x, double z, double pitch_mm)
{
    const struct move m = {
        .kind = kind,
        .line = b->moves + 1,
        .end = {{x, 0.0, z}},
        .feed_mm_s = kind == MOVE_RAPID ? 0.0 : 10.0,
        .feed_rev_mm = pitch_mm,
        .overrides = OVERRIDE_HOLD,
        .speed_ratio = 1.0,
        .turns = 1,
    };

    bench_add(b, &m);
}

void bench_tap(struct bench *b, double z, double pitch_mm, double ratio)
{
    const double start = b->moves > 0 ? b->move[b->moves - 1].end.at[AXIS_Z] : 0.0;
    const double x = b->moves > 0 ? b->move[b->moves - 1].end.at[AXIS_X] : 0.0;

    bench_go(b, MOVE_TAP, x, z, pitch_mm);
    bench_go(b, MOVE_TAP_OUT, x, start, pitch_mm);
    b->move[b->moves - 1].speed_ratio = ratio;
}

void bench_start(struct bench *b)
{
    const struct point start = {{0}};
    const struct move end = {.kind = MOVE_END};

    bench_add(b, &end);
    TEST_ASSERT_NULL(virtual_spindle_check(&b->spindle_config));
    virtual_spindle_init(&b->spindle, &b->spindle_config);
    b->spindle_sync_config.cycle_s = b->limits.cycle_s;
    b->spindle_sync_config.counts =
        maths_max(1.0, (double)b->spindle_config.encoder_counts_per_revolution);
    b->spindle_sync_config.ramp_rpm_s = b->spindle_config.ramp_rpm_s;
    b->spindle_sync_config.max_rpm = b->spindle_config.max_rpm;
    takt_spindle_sync_init(&b->sync, &b->spindle_sync_config);
    takt_path_init(&b->path, &b->limits, &start);
    takt_motion_init(&b->motion, &b->path, &start, false);
    takt_handover_allow(&b->motion, MOTION_HANDS_OVER_SYNCHRONIZED);
}

static void bench_plan(struct bench *b)
{
    if (takt_motion_wanted(&b->motion) == NULL) {
        return;
    }
    while (b->pushed < b->moves && takt_path_has_room(&b->path) &&
           takt_motion_ahead(&b->motion) < b->look_ahead) {
        takt_path_push(&b->path, &b->move[b->pushed++]);
    }
    if (b->pushed == b->moves) {
        takt_path_finish(&b->path);
    }
    takt_motion_build(&b->motion);
}

static void bench_verifier(struct bench *b)
{
    const double t = b->limits.cycle_s;
    struct bench_verifier *j = &b->verifier;

    for (int i = 0; i < BENCH_AXES; i++) {
        double *h = j->history[i];

        memmove(h + 1, h, 3 * sizeof(*h));
        h[0] = b->record.cmd.at[i];
        const double v = maths_abs(h[0] - h[1]) / t;
        const double a = maths_abs(h[0] - 2 * h[1] + h[2]) / (t * t);
        const double k = maths_abs(h[0] - 3 * h[1] + 3 * h[2] - h[3]) / (t * t * t);

        j->velocity = maths_max(j->velocity, v / b->limits.velocity_mm_s[i]);
        j->acceleration = maths_max(j->acceleration, a / b->limits.acceleration_mm_s2[i]);
        j->jerk = maths_max(j->jerk, k / b->limits.jerk_mm_s3[i]);
    }
}

void bench_check_limits(const struct bench *b)
{
    TEST_ASSERT_TRUE(b->verifier.velocity <= 1.0001);
    TEST_ASSERT_TRUE(b->verifier.acceleration <= 1.0001);
    TEST_ASSERT_TRUE(b->verifier.jerk <= 1.001);
}

static void bench_apply_events(struct bench *b)
{
    for (uint32_t i = b->motion.passed_first; i != b->path.first; i++) {
        const struct move *m = &path_read(&b->path, i)->move;

        if (m->kind == MOVE_SPINDLE) {
            b->command_rpm = m->direction == SPINDLE_CCW ? -m->speed_rpm : m->speed_rpm;
        }
    }
    (void)spindle_sync_get_command(&b->sync, &b->command_rpm);
}

static void bench_turn_spindle(struct bench *b)
{
    b->feedback = virtual_spindle_step(&b->spindle, b->limits.cycle_s, b->command_rpm, 0.0);
    b->feedback.silent = b->is_silent;
    memmove(b->true_rev + 1, b->true_rev, BENCH_AHEAD * sizeof(double));
    b->true_rev[0] = b->spindle.angle_rev;
}

bool bench_cycle(struct bench *b)
{
    bench_plan(b);
    spindle_sync_measure(&b->sync, &b->feedback);
    b->is_locked = false;
    b->locked = SPINDLE_SYNC_CYCLE;
    b->result = takt_motion_cycle(&b->motion, &b->operator, & b->record);
    if (b->result == MOTION_HANDED_OVER) {
        b->is_locked = true;
        b->locked =
            takt_spindle_sync_cycle(&b->sync, &b->motion, &b->operator, b->command_rpm, &b->record);
    }
    bench_apply_events(b);
    if (b->locked == SPINDLE_SYNC_FAILED || b->result == MOTION_DONE) {
        return false;
    }
    if (b->is_locked || b->result == MOTION_CYCLE) {
        bench_verifier(b);
        b->point = b->record.cmd;
        b->cycles++;
    }
    memmove(b->sent_mm + 1, b->sent_mm, BENCH_AHEAD * sizeof(double));
    b->sent_mm[0] = b->sync.follower.at.x_mm;
    bench_turn_spindle(b);
    return true;
}

double bench_off_mm(const struct bench *b)
{
    const double rev = b->sync.sense * b->true_rev[1] - b->sync.at.zero_rev;

    return b->sent_mm[BENCH_AHEAD] - (b->sync.at.start_mm + b->sync.at.pitch_mm * rev);
}

bool bench_is_on_thread(const struct bench *b)
{
    const double rev = b->sync.sense * b->true_rev[BENCH_AHEAD];

    return b->is_locked && b->sync.phase == SPINDLE_SYNC_FOLLOWS &&
           b->sync.follower.state == FOLLOWER_FOLLOWS &&
           takt_lead_in_is_over(&b->sync.lead_in, rev);
}
