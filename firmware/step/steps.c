#include "base/assert.h"
#include "step/steps_private.h"

#include "base/maths.h"

#include <string.h>

#define STEPS_MAX 2147483647.0

/* Steps beyond the highest rate that rounding can ask for in one cycle. */
#define RATE_ROOM_STEPS 2.0

void takt_steps_init(struct steps *s, const struct steps_config *config, const struct point *start)
{
    memset(s, 0, sizeof(*s));
    s->config = *config;
    s->now = s->next.at = s->read = *start;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i)) {
            TAKT_ASSERT(config->axis[i].steps_per_mm > 0.0);
            s->at[i] = (int64_t)takt_maths_round(start->at[i] * config->axis[i].steps_per_mm);
        }
    }
}

static void raise_fault(struct steps *s, enum takt_error error, unsigned axis, double value)
{
    TAKT_ASSERT(axis < AXIS_COUNT && error != TAKT_OK);
    if (s->fault.code == TAKT_OK) {
        takt_diagnostic_set(&s->fault, error, 0, 0, &AXIS_LETTERS[axis], 1, value);
    }
}

/* Not before the last pulse, and not sooner after the last step of an axis than its drive takes. */
static int64_t earliest_ns(const struct steps *s, const struct evaluate_tick *tick)
{
    int64_t time_ns = s->last_ns;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (evaluate_has(tick->axes, i) && s->free_ns[i] > time_ns) {
            time_ns = s->free_ns[i];
        }
    }
    return time_ns;
}

static void count_step(struct steps *s, unsigned i, bool backwards)
{
    TAKT_ASSERT(i < AXIS_COUNT && s->config.axis[i].rate_max_hz > 0.0);
    s->at[i] += backwards ? -1 : 1;
    s->free_ns[i] = s->last_ns + (int64_t)takt_maths_ceil(1e9 / s->config.axis[i].rate_max_hz);
}

static void send_pulse(struct steps *s, const struct step_port *port,
                       const struct evaluate_tick *tick)
{
    const struct step_pulse pulse = {(uint32_t)s->last_ns, tick->axes, tick->direction};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (evaluate_has(tick->axes, i)) {
            count_step(s, i, evaluate_has(tick->direction, i));
        }
    }
    s->failed = !port->pulse(port->context, &pulse) || s->failed;
}

bool takt_steps_emit(struct steps *s, const struct step_port *port, double part,
                     const struct evaluate_tick *tick)
{
    const int64_t cycle_ns = (int64_t)s->config.cycle_us * 1000;
    const double wanted = maths_clamp(part, 0.0, 1.0) * (double)cycle_ns;
    int64_t time_ns = earliest_ns(s, tick);

    /* A tick at the very end is one of this cycle. */
    if (time_ns < cycle_ns && (int64_t)wanted > time_ns) {
        time_ns = (int64_t)wanted < cycle_ns ? (int64_t)wanted : cycle_ns - 1;
    }
    if (time_ns >= cycle_ns) {
        s->held = *tick;
        return false;
    }
    s->last_ns = time_ns;
    send_pulse(s, port, tick);
    return true;
}

static void begin_cycle(struct steps *s, const struct step_port *port)
{
    const struct evaluate_tick held = s->held;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        s->free_ns[i] -= (int64_t)s->config.cycle_us * 1000;
    }
    s->last_ns = 0;
    s->failed = false;
    s->held.axes = 0;
    if (held.axes != 0) {
        (void)takt_steps_emit(s, port, 0.0, &held);
    }
}

/* What an encoder says, else what has been sent. */
static double read_mm(const struct steps *s, const struct step_port *port, unsigned i)
{
    int32_t steps;

    TAKT_ASSERT(i < AXIS_COUNT);
    if (port->read != NULL && port->read(port->context, (enum axis)i, &steps)) {
        return (double)steps / s->config.axis[i].steps_per_mm;
    }
    return (double)s->at[i] / s->config.axis[i].steps_per_mm;
}

/* lag = where the pulses sent so far should have led - encoder; half a step of it is rounding. */
static void check_following(struct steps *s, unsigned i)
{
    const struct steps_config_axis *axis = &s->config.axis[i];
    const double lag_mm = maths_abs(s->now.at[i] - s->read.at[i]);

    TAKT_ASSERT(i < AXIS_COUNT);
    if (axis->following_error_max_mm > 0.0 &&
        lag_mm > axis->following_error_max_mm + 0.5 / axis->steps_per_mm) {
        raise_fault(s, TAKT_ERROR_DRIVE_FOLLOWING, i, lag_mm);
    }
}

static void read_encoders(struct steps *s, const struct step_port *port)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i)) {
            s->read.at[i] = read_mm(s, port, i);
        }
    }
}

/*
 * Is the way to the target short enough for the drive's rate, and its end a position? NaN fails the
 * comparisons.
 */
static void check_way(struct steps *s, const struct point *to)
{
    const double cycle_s = 1e-6 * (double)s->config.cycle_us;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct steps_config_axis *axis = &s->config.axis[i];
        const double steps = to->at[i] * axis->steps_per_mm;
        const double way = maths_abs(steps - (double)s->at[i]);

        if (!steps_has(s, i)) {
            continue;
        }
        if (!(maths_abs(steps) <= STEPS_MAX)) {
            raise_fault(s, TAKT_ERROR_DRIVE_RANGE, i, to->at[i]);
        } else if (way > axis->rate_max_hz * cycle_s + RATE_ROOM_STEPS) {
            raise_fault(s, TAKT_ERROR_STEP_RATE, i, way / cycle_s);
        }
    }
}

/* Straight-line distance over the step axes; a radian counts as a millimetre. */
static double distance(const struct steps *s, const struct point *a, const struct point *b)
{
    double sum = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double way = steps_has(s, i) ? b->at[i] - a->at[i] : 0.0;

        sum += way * way;
    }
    return maths_sqrt(sum);
}

/*
 * A new block: evenly to its start, which includes whatever the block before has left over and
 * blocks too short to be seen; then along its curve. The cycle is divided in proportion to both
 * ways.
 */
static void enter_path(struct steps *s, const struct step_port *port)
{
    const struct curve *curve = &s->next.curve;
    const double before = distance(s, &s->now, &curve->start);
    const double after = distance(s, &curve->start, &s->next.at);
    const double split = before > 0.0 ? before / (before + after) : 0.0;
    double part;

    s->path.active = false;
    takt_steps_even(s, port, &s->now, &curve->start, (struct steps_span){0.0, split});
    if (s->held.axes == 0 && takt_steps_path_begin(s, &s->next)) {
        part = takt_steps_path_place(s, &s->next.at);
        if (part >= 0.0) {
            takt_steps_path_follow(s, port, part, (struct steps_span){split, 1.0});
            return;
        }
        s->path.active = false;
    }
    takt_steps_even(s, port, &curve->start, &s->next.at, (struct steps_span){split, 1.0});
}

static void go_along(struct steps *s, const struct step_port *port)
{
    const double part = s->path.active ? takt_steps_path_place(s, &s->next.at) : -1.0;

    if (part >= 0.0) {
        takt_steps_path_follow(s, port, part, (struct steps_span){0.0, 1.0});
        return;
    }
    s->path.active = false;
    takt_steps_even(s, port, &s->now, &s->next.at, (struct steps_span){0.0, 1.0});
}

static void step_to_next(struct steps *s, const struct step_port *port)
{
    const bool enters =
        s->config.form != STEPS_EVEN && s->next.has_curve && s->next.number != s->number;

    begin_cycle(s, port);
    if (enters) {
        s->number = s->next.number;
        enter_path(s, port);
    } else {
        go_along(s, port);
    }
    s->now = s->next.at;
    if (s->failed) {
        raise_fault(s, TAKT_ERROR_STEP_PORT, 0, 0.0);
    }
}

bool takt_steps_cycle(struct steps *s, const struct step_port *port, const struct point *setpoint,
                      const struct curve *curve, uint32_t number)
{
    if (s->config.axes == 0U) {
        return true;
    }
    read_encoders(s, port);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i)) {
            check_following(s, i);
        }
    }
    check_way(s, &s->next.at);
    if (s->fault.code != TAKT_OK) {
        return false;
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        s->braking[i] = s->next.at.at[i] - s->now.at[i];
    }
    s->rests = false;
    step_to_next(s, port);
    s->next = (struct steps_target){.at = *setpoint, .has_curve = curve != NULL, .number = number};
    if (curve != NULL) {
        s->next.curve = *curve;
    }
    return s->fault.code == TAKT_OK;
}

void takt_steps_leave_path(struct steps *s)
{
    s->path.active = false;
    s->next.has_curve = false;
    s->number = 0;
}

static bool brakes(const struct steps *s)
{
    bool any = false;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        any = any || (steps_has(s, i) && s->braking[i] != 0.0);
    }
    return any;
}

/* Each cycle's way is shorter than the last by a T^2, until it is none. */
void takt_steps_brake(struct steps *s, const struct step_port *port)
{
    const double cycle_s = 1e-6 * (double)s->config.cycle_us;
    struct point to = s->now;

    if (s->config.axes == 0U) {
        return;
    }
    read_encoders(s, port);
    s->rests = !brakes(s);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double less = s->config.axis[i].stop_mm_s2 * cycle_s * cycle_s;
        const double way = maths_max(0.0, maths_abs(s->braking[i]) - less);

        s->braking[i] = s->braking[i] < 0.0 ? -way : way;
        to.at[i] += steps_has(s, i) ? s->braking[i] : 0.0;
    }
    s->path.active = false;
    begin_cycle(s, port);
    takt_steps_even(s, port, &s->now, &to, (struct steps_span){0.0, 1.0});
    s->now = s->next.at = to;
}

void takt_steps_restart(struct steps *s)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i)) {
            s->at[i] = (int64_t)takt_maths_round(s->read.at[i] * s->config.axis[i].steps_per_mm);
        }
        s->braking[i] = 0.0;
    }
    s->now = s->next.at = s->read;
    s->path.active = false;
    s->held.axes = 0;
    s->fault.code = TAKT_OK;
}

void takt_steps_get_actual(const struct steps *s, struct point *actual)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i)) {
            actual->at[i] = s->read.at[i];
        }
    }
}

const struct diagnostic *takt_steps_get_fault(const struct steps *s)
{
    return &s->fault;
}
