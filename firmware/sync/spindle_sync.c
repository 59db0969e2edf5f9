#include "sync/spindle_sync.h"

#include "base/assert.h"
#include "base/maths.h"
#include "motion/handover.h"

#include <string.h>

#define SECONDS_PER_MINUTE 60.0

/* Rounding of velocities that are compared. */
#define SLACK 1e-6

/* Counts that an angle may be off by itself. */
#define COUNTS_OFF 2.0

/* A spindle at its limit may be faster than it by this part: the axes lag a little then. */
#define SPEED_ROOM 0.01

#define COUNT_PART 0.1

/* Feedback is older than the command by less than this. */
#define FEEDBACK_CYCLES 4

static void tune(struct spindle_sync *l, double bandwidth_rad_s)
{
    const double rad_cycle =
        maths_min(bandwidth_rad_s * l->config.cycle_s, ANGLE_BANDWIDTH_RAD_CYCLE);

    takt_angle_tune(&l->angle, rad_cycle);
    takt_follower_tune(&l->follower, rad_cycle);
}

void takt_spindle_sync_init(struct spindle_sync *l, const struct spindle_sync_config *config)
{
    TAKT_ASSERT(config->cycle_s > 0.0);
    memset(l, 0, sizeof(*l));
    l->config = *config;
    takt_angle_init(&l->angle);
    takt_follower_init(&l->follower, config->cycle_s);
    tune(l, ANGLE_BANDWIDTH_RAD_S);
    l->next_block = UINT32_MAX;
}

void takt_spindle_sync_restart(struct spindle_sync *l)
{
    l->phase = SPINDLE_SYNC_IDLE;
    l->alarm.code = TAKT_OK;
    l->next_block = UINT32_MAX;
}

static void command(struct spindle_sync *l, double rpm)
{
    l->commands = true;
    l->command_rpm = rpm;
}

/* For the spindle, in the direction it was commanded: rev, rev/s, rev/s2. */
static struct angle_ahead view(const struct spindle_sync *l, double cycles)
{
    const struct angle_ahead ahead = takt_angle_look_ahead(&l->angle, cycles);
    const double rate = l->sense / l->config.cycle_s;

    return (struct angle_ahead){l->sense * ahead.rev, rate * ahead.speed,
                                rate * ahead.acceleration / l->config.cycle_s};
}

/* Axes and spindle stop, and the program ends when the axes stand. */
static void fail(struct spindle_sync *l, enum takt_error code, double value, double limit)
{
    const struct block *b = path_first(l->chain.path);

    TAKT_ASSERT(code != TAKT_OK);
    takt_diagnostic_set(&l->alarm, code, b->move.line, 0, "", 0, value);
    takt_diagnostic_set_limit(&l->alarm, limit);
    takt_follower_brake(&l->follower);
}

/* -- before the thread -- */

/*
 * Steps of an encoder's counts, pitch/counts each, come through the filters as jerk of about their
 * height times the bandwidth cubed: they get COUNT_PART of the axes' jerk.
 */
static double bandwidth_of(const struct spindle_sync *l)
{
    const double count_mm = l->at.pitch_mm / l->config.counts;

    TAKT_ASSERT(l->config.counts > 0.0);
    return maths_min(ANGLE_BANDWIDTH_RAD_S,
                     takt_maths_cbrt(COUNT_PART * l->chain.limits.jerk_mm_s3 / count_mm));
}

static void begin(struct spindle_sync *l, double commanded_rpm)
{
    const struct block *b = path_first(l->chain.path);

    takt_follower_start(&l->follower, &l->chain.limits);
    l->at = takt_chain_first_leg(&l->chain, 0.0);
    tune(l, bandwidth_of(l));
    l->sense = commanded_rpm < 0.0 ? -1.0 : 1.0;
    l->stood = 0;
    l->waited = 0;
    l->tap.phase = b->move.kind == MOVE_TAP ? TAP_IN : TAP_NONE;
    l->before_rpm = commanded_rpm;
    l->phase = SPINDLE_SYNC_WAITS;
}

/*
 * May it be begun? Not in the cycle that has passed something, which may command the spindle; not
 * before the way out of the hole is on the path.
 */
static bool can_begin(const struct motion *m)
{
    const struct path *path = m->path;
    const bool taps = takt_path_kind(path, path->first) == MOVE_TAP;

    return m->passed_first == path->first && (!taps || path->closed - path->first >= 2);
}

static double out_ratio(const struct spindle_sync *l)
{
    return path_read(l->chain.path, l->chain.path->first + 1)->move.speed_ratio;
}

static bool is_turning(const struct spindle_sync *l)
{
    return l->spindle->at_speed && !l->spindle->tripped && !l->spindle->silent &&
           view(l, 0.0).speed * SECONDS_PER_MINUTE > SPINDLE_SYNC_STANDS_RPM;
}

static bool has_waited(struct spindle_sync *l)
{
    l->waited++;
    return (double)l->waited * l->config.cycle_s > l->config.wait_s;
}

static void set_tap(struct spindle_sync *l)
{
    const double in_rpm = maths_abs(l->before_rpm);
    const double out_rpm = in_rpm * out_ratio(l);
    const double most_rpm = l->config.max_rpm > 0.0 ? l->config.max_rpm : out_rpm;

    l->tap = (struct tap){.phase = TAP_IN,
                          .in_rev_s = in_rpm / SECONDS_PER_MINUTE,
                          .out_rev_s = maths_min(out_rpm, most_rpm) / SECONDS_PER_MINUTE,
                          .ramp_rev_s2 = l->config.ramp_rpm_s / SECONDS_PER_MINUTE};
}

/* Can the axes be as fast as the spindle asks for? */
static bool check_speed(struct spindle_sync *l, double pitch_mm, double rev_s)
{
    const double v = pitch_mm * rev_s;

    if (v <= l->chain.limits.velocity_mm_s * (1.0 + SLACK)) {
        return true;
    }
    fail(l, TAKT_ERROR_THREAD_FAST, v, l->chain.limits.velocity_mm_s);
    return false;
}

/* Is there room for the lead-in, and behind it for coming to rest? */
static bool check_length(struct spindle_sync *l, double rev_s)
{
    const double pitch_mm = l->at.pitch_mm;
    const struct brake_state at_speed = {.v_mm_s = pitch_mm * rev_s};
    const double in_mm = 0.5 * pitch_mm * l->lead_in.way_rev;
    const double out_mm = tap_is(&l->tap) ? pitch_mm * takt_tap_turns(&l->tap)
                                          : takt_brake_reach(&at_speed, &l->chain.limits);
    const bool fits = l->at.end_mm >= in_mm && l->chain.end_mm >= in_mm + out_mm;

    if (!fits) {
        fail(l, TAKT_ERROR_THREAD_SHORT, l->chain.end_mm, in_mm + out_mm);
    }
    return fits;
}

/*
 * The zero angle: a whole revolution, where the encoder's index is; for a thread that goes on,
 * where the one before ended. The next one whose lead-in has not begun.
 */
static double zero_angle(const struct spindle_sync *l, double rev)
{
    const bool goes_on = l->chain.path->first == l->next_block;
    const double base = goes_on ? l->next_zero_rev : 0.0;

    return base + takt_maths_ceil(rev + 0.5 * l->lead_in.way_rev - base);
}

/* What the lead-in is made for: one below the command by more than its room may come up. */
static double lead_in_speed(const struct spindle_sync *l, double now_rev_s)
{
    const double commanded = maths_abs(l->before_rpm) / SECONDS_PER_MINUTE;

    return LEAD_IN_ROOM * now_rev_s < commanded ? commanded : now_rev_s;
}

static void start(struct spindle_sync *l)
{
    const struct angle_ahead now = view(l, l->config.ahead_cycles);

    takt_chain_extend(&l->chain);
    l->lead_in.pitch_mm = l->at.pitch_mm;
    l->lead_in.way_rev = takt_lead_in_way(l->at.pitch_mm, lead_in_speed(l, now.speed),
                                          &l->chain.limits, l->config.cycle_s);
    if (tap_is(&l->tap)) {
        set_tap(l);
    }
    if (!check_speed(l, l->at.pitch_mm, now.speed) ||
        (tap_is(&l->tap) && !check_speed(l, l->at.pitch_mm, l->tap.out_rev_s)) ||
        !check_length(l, now.speed)) {
        return;
    }
    l->lead_in.zero_rev = zero_angle(l, now.rev);
    l->at.zero_rev = l->lead_in.zero_rev;
    l->ahead = l->at;
    l->waited = 0;
    l->phase = SPINDLE_SYNC_FOLLOWS;
}

static void wait_for_spindle(struct spindle_sync *l, const struct motion_operator *wanted)
{
    if (wanted->hold != MOTION_GOES || wanted->wait) {
        l->waited = 0;
    } else if (++l->stood > FEEDBACK_CYCLES && is_turning(l)) {
        start(l);
    } else if (has_waited(l)) {
        fail(l, TAKT_ERROR_THREAD_WAITS, l->config.wait_s, 0.0);
    }
}

/* -- on the thread -- */

/* The position that belongs to an angle. Out of a hole the thread is left at its start only. */
static struct lead_in_place place_at(const struct spindle_sync *l, double rev)
{
    if (l->tap.phase != TAP_OUT && !takt_lead_in_is_over(&l->lead_in, rev)) {
        return takt_lead_in_at(&l->lead_in, rev);
    }
    return (struct lead_in_place){
        .x = l->ahead.start_mm + l->ahead.pitch_mm * (rev - l->ahead.zero_rev),
        .first = l->ahead.pitch_mm,
    };
}

/* x' = f' w, x'' = f'' w^2 + f' a, x''' = f''' w^3 + 3 f'' w a; w, a: of the spindle */
static struct follower_target target_of(const struct spindle_sync *l)
{
    const double before = l->config.ahead_cycles - 1.0;
    const struct angle_ahead now = view(l, before);
    const struct angle_ahead middle = view(l, before + 0.5);
    const struct lead_in_place p = place_at(l, now.rev);
    const struct lead_in_place q = place_at(l, middle.rev);
    const double w = middle.speed;

    return (struct follower_target){
        .x_mm = p.x,
        .v_mm_s = p.first * now.speed,
        .a_mm_s2 = p.second * now.speed * now.speed + p.first * now.acceleration,
        .j_mm_s3 = q.third * w * w * w + 3.0 * q.second * w * middle.acceleration,
    };
}

/* How far the axes are off the angle just measured. */
static double lag_of(const struct spindle_sync *l)
{
    const double before = l->config.ahead_cycles - 1.0;
    const double off = l->sense * (l->spindle->angle_rev - l->angle.rev);

    return place_at(l, view(l, before).rev + off).x - l->follower.at.x_mm;
}

static double tolerance_of(const struct spindle_sync *l)
{
    return l->config.tolerance_mm + COUNTS_OFF * l->ahead.pitch_mm / l->config.counts;
}

/* Does it turn as it should? Where it turns back it may stand for a while. */
static bool has_stopped(struct spindle_sync *l, const struct angle_ahead *now)
{
    const double rpm = now->speed * SECONDS_PER_MINUTE;

    if (l->tap.phase <= TAP_IN) {
        return rpm < SPINDLE_SYNC_STANDS_RPM;
    }
    if (-rpm >= SPINDLE_SYNC_STANDS_RPM) {
        l->waited = 0;
        return false;
    }
    return has_waited(l);
}

static void watch(struct spindle_sync *l)
{
    const struct angle_ahead now = view(l, 0.0);
    const double lag_mm = maths_abs(lag_of(l));
    const double v = l->ahead.pitch_mm * maths_abs(now.speed);

    if (l->spindle->tripped) {
        fail(l, TAKT_ERROR_SPINDLE_TRIPPED, 0.0, 0.0);
    } else if (l->spindle->silent) {
        fail(l, TAKT_ERROR_SPINDLE_SILENT, 0.0, 0.0);
    } else if (has_stopped(l, &now)) {
        fail(l, TAKT_ERROR_THREAD_STOPPED, 0.0, 0.0);
    } else if (v > l->chain.limits.velocity_mm_s * (1.0 + SPEED_ROOM)) {
        fail(l, TAKT_ERROR_THREAD_FAST, v, l->chain.limits.velocity_mm_s);
    } else if (lag_mm > tolerance_of(l)) {
        fail(l, TAKT_ERROR_THREAD_LAG, lag_mm, tolerance_of(l));
    }
}

/* The end that is not passed: of the thread; a little below the hole's bottom; then the start. */
static struct follower_end end_of(const struct spindle_sync *l)
{
    if (l->tap.phase == TAP_OUT) {
        return (struct follower_end){.sense = -1.0, .x_mm = 0.0};
    }
    return (struct follower_end){
        .sense = 1.0, .x_mm = l->chain.end_mm + (tap_is(&l->tap) ? l->config.tolerance_mm : 0.0)};
}

/* Blocks of the angle, and of the setpoint, that have been left behind. */
static void pass_blocks(struct spindle_sync *l, struct motion *m)
{
    const double rev = view(l, l->config.ahead_cycles).rev;

    if (takt_lead_in_is_over(&l->lead_in, rev) && place_at(l, rev).x >= l->ahead.end_mm) {
        (void)takt_chain_next_leg(&l->chain, &l->ahead);
    }
    while (l->follower.at.x_mm >= l->at.end_mm && l->at.block != l->chain.last) {
        (void)takt_chain_next_leg(&l->chain, &l->at);
        takt_handover_pass_block(m);
    }
}

/* The spindle's part, and the axes' turning round with it. */
static void follow_tap(struct spindle_sync *l, struct motion *m)
{
    const struct angle_ahead now = view(l, 0.0);
    const double left = (l->chain.end_mm - place_at(l, now.rev).x) / l->at.pitch_mm;

    command(l, l->sense * SECONDS_PER_MINUTE * takt_tap_command(&l->tap, left, now.speed));
    if (l->tap.phase == TAP_TURNS && l->follower.at.v_mm_s <= 0.0) {
        l->tap.phase = TAP_OUT;
        takt_handover_pass_block(m);
    }
}

/* Still at rest before the zero angle, a hold can be obeyed. */
static bool may_hold(const struct spindle_sync *l)
{
    const double rev = view(l, l->config.ahead_cycles + 1.0).rev;

    return takt_lead_in_at(&l->lead_in, rev).x == 0.0 && l->follower.at.x_mm == 0.0;
}

static void follow(struct spindle_sync *l, struct motion *m, const struct motion_operator *wanted)
{
    if (wanted->hold != MOTION_GOES && may_hold(l)) {
        l->phase = SPINDLE_SYNC_WAITS;
        return;
    }
    if (l->follower.state == FOLLOWER_FOLLOWS) {
        takt_chain_extend(&l->chain);
        watch(l);
    } else if (tap_is(&l->tap) && l->tap.phase != TAP_OUT && l->follower.state == FOLLOWER_LANDS) {
        fail(l, TAKT_ERROR_TAP_DEEP, l->config.tolerance_mm, 0.0);
    }
    if (wanted->hold == MOTION_STOPS) {
        takt_follower_brake(&l->follower);
    }
    const struct follower_target target = target_of(l);
    const struct follower_end end = end_of(l);

    takt_follower_step(&l->follower, &target, &end);
    pass_blocks(l, m);
    if (tap_is(&l->tap) && l->follower.state == FOLLOWER_STOPS) {
        command(l, 0.0);
    } else if (tap_is(&l->tap)) {
        follow_tap(l, m);
    }
}

/* -- after it -- */

/* Tapped: not before the spindle turns as it did. */
static void return_spindle(struct spindle_sync *l, struct motion *m)
{
    command(l, l->before_rpm);
    if (is_turning(l)) {
        l->phase = SPINDLE_SYNC_IDLE;
        takt_handover_end(m);
    } else if (has_waited(l)) {
        fail(l, TAKT_ERROR_THREAD_WAITS, l->config.wait_s, 0.0);
    }
}

static void finish(struct spindle_sync *l, struct motion *m)
{
    if (tap_is(&l->tap)) {
        l->phase = SPINDLE_SYNC_RETURNS;
        l->waited = 0;
        return;
    }
    l->next_block = l->at.block + 1;
    l->next_zero_rev = l->at.zero_rev + (l->at.end_mm - l->at.start_mm) / l->at.pitch_mm;
    l->phase = SPINDLE_SYNC_IDLE;
    takt_handover_end(m);
}

/* -- the cycle -- */

static bool has_landed(const struct spindle_sync *l)
{
    return l->phase == SPINDLE_SYNC_FOLLOWS && follower_rests(&l->follower) &&
           l->follower.state == FOLLOWER_LANDS;
}

/* From the start of the block the setpoint is in: its line is straight. */
static void set_point(const struct spindle_sync *l, struct point *at)
{
    const struct block *b = path_first(l->chain.path);
    const double x = l->follower.at.x_mm;
    const double way = l->tap.phase == TAP_OUT ? l->chain.end_mm - x : x - l->at.start_mm;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        at->at[i] =
            b->curve.start.at[i] + way / b->length_mm * (b->curve.end.at[i] - b->curve.start.at[i]);
    }
}

/* The setpoint of this cycle; before_mm: where it was. */
static void report(struct spindle_sync *l, struct motion *m, double before_mm,
                   struct cycle_record *record)
{
    const bool landed = has_landed(l);
    const double way_mm = maths_abs(l->follower.at.x_mm - before_mm) * path_first(m->path)->scale;
    struct point at;

    at = landed ? path_first(m->path)->curve.end : m->at;
    if (l->phase == SPINDLE_SYNC_FOLLOWS && !landed) {
        set_point(l, &at);
    }
    takt_handover_add_cycle(m, &at, way_mm / l->config.cycle_s, landed, record);
    if (landed) {
        finish(l, m);
    }
}

static void act(struct spindle_sync *l, struct motion *m, const struct motion_operator *wanted)
{
    switch (l->phase) {
    case SPINDLE_SYNC_IDLE:
        break;
    case SPINDLE_SYNC_WAITS:
        wait_for_spindle(l, wanted);
        break;
    case SPINDLE_SYNC_FOLLOWS:
        follow(l, m, wanted);
        break;
    case SPINDLE_SYNC_RETURNS:
        return_spindle(l, m);
        break;
    }
}

enum spindle_sync_result takt_spindle_sync_cycle(struct spindle_sync *l, struct motion *m,
                                                 const struct motion_operator *wanted,
                                                 double commanded_rpm, struct cycle_record *record)
{
    if (l->alarm.code != TAKT_OK) {
        command(l, 0.0);
    }
    if (l->alarm.code != TAKT_OK &&
        (l->phase != SPINDLE_SYNC_FOLLOWS || follower_rests(&l->follower))) {
        return SPINDLE_SYNC_FAILED;
    }
    if (l->phase == SPINDLE_SYNC_IDLE && can_begin(m)) {
        takt_chain_begin(&l->chain, m->path);
        begin(l, commanded_rpm);
    }
    const double before_mm = l->follower.at.x_mm;

    act(l, m, wanted);
    report(l, m, before_mm, record);
    return SPINDLE_SYNC_CYCLE;
}
