/*
 * A torque to and fro: it turns round when the axis is as fast as a first push has made it,
 *
 *     sign (v / V + (x - centre) / X) >= 1
 *
 * so the axis swings about a centre, and is brought there at no more than about twice V if it
 * stands elsewhere. The loops of the drive have no part in it, so it is the same with gains that
 * make them swing. The torque is raised until it moves the axis, and on until two tests, one with
 * twice the torque of the other, find the same inertia and delay: one whose torque is near the
 * friction says little of either.
 */
#include "studies/tune_relay.h"

#include "base/maths.h"

/* Torque in thousandths of the rated one: the first, and the last. */
#define TORQUE_FIRST 50
#define TORQUE_LAST  1000

/*
 * Cycles of a push, which ends when the axis has gone this many encoder steps and this part of a
 * turn of the motor.
 */
#define PUSH_CYCLES_MIN 8
#define PUSH_CYCLES_MAX 100
#define PUSH_STEPS      40
#define PUSH_TURNS      5e-4

/* Times that the torque turns round about the centre; and the longest test. */
#define TURNS      60
#define CYCLES_MAX 60000

/* X: this many times the way of a push. */
#define SWING_WAYS 8

/* The centre is this part of the travel inside of its ends, */
#define INSIDE_PART 0.02
/* and the axis is let go when it is so much farther out than where it began. */
#define OUT_PART 0.01

/*
 * Inertias and delays of two tests are the same if they differ by no more than these parts of them
 * and of a cycle.
 */
#define AGREE_PART  0.03
#define AGREE_CYCLE 0.1

struct relay {
    struct tune_drive *drive;
    struct tuning_record *record;
    double cycle_s, centre, low_end, high_end;
    double v_turn, x_turn; /* V, X */
    double before, now;    /* where it was, and is */
    double low, high;
    int32_t torque;
    int32_t sign;
};

static bool is_out(const struct relay *r)
{
    return r->now < r->low_end || r->now > r->high_end || !tune_drive_is_enabled(r->drive);
}

static void push(struct relay *r, double rated_nm)
{
    const int32_t torque = r->sign * r->torque;

    tuning_record_add(r->record, 1e-3 * torque * rated_nm, r->now);
    tune_drive_push(r->drive, torque);
    tune_drive_cycle(r->drive);
    r->before = r->now;
    r->now = tune_drive_position(r->drive);
    r->low = maths_min(r->low, r->now);
    r->high = maths_max(r->high, r->now);
}

/* The least way of a push. */
static double least_way(const struct relay *r)
{
    const double turn = r->drive->config.plant.travel_per_revolution_mm;

    return maths_max(PUSH_STEPS * r->record->step, PUSH_TURNS * turn);
}

/*
 * A push that moves it sets V and X: at an even acceleration v = 2 way / time. False: it did not
 * move enough.
 */
static bool try_push(struct relay *r, double rated_nm)
{
    const double from = r->now;

    r->record->count = 0; /* what did not move says nothing */
    for (unsigned k = 1; k <= PUSH_CYCLES_MAX && !is_out(r); k++) {
        push(r, rated_nm);
        const double way = maths_abs(r->now - from);

        if (k >= PUSH_CYCLES_MIN && way >= least_way(r)) {
            r->v_turn = 2 * way / (k * r->cycle_s);
            r->x_turn = SWING_WAYS * way;
            return true;
        }
    }
    return false;
}

/* Raises the torque until it moves the axis. */
static const char *find_torque(struct relay *r, double rated_nm)
{
    while (!try_push(r, rated_nm)) {
        if (is_out(r))
            return "it left its place while its torque was being looked for";
        if (r->torque >= TORQUE_LAST)
            return "its rated torque does not move it: is it jammed, or held by a brake?";
        r->torque = (int32_t)maths_min(2 * r->torque, TORQUE_LAST);
        r->sign = -r->sign;
    }
    return NULL;
}

static const char *swing(struct relay *r, double rated_nm)
{
    unsigned turns = 0;

    for (unsigned k = 0; turns < TURNS && k < CYCLES_MAX; k++) {
        const double off = (r->now - r->centre) / r->x_turn;
        const double fast = (r->now - r->before) / r->cycle_s / r->v_turn;

        if (is_out(r))
            return "it left the room for the test: its torque drives it away";
        if (r->sign * (fast + maths_clamp(off, -1.5, 1.5)) >= 1) {
            r->sign = -r->sign;
            turns += maths_abs(off) < 2;
        }
        push(r, rated_nm);
    }
    return turns == TURNS ? NULL : "it does not swing: something holds it";
}

/* A torque to and fro from where it stands. */
static const char *test_with(struct tune_axis *result, struct tune_drive *drive,
                             const struct machine_axis *axis, int32_t torque)
{
    const double travel = axis->travel_max_mm - axis->travel_min_mm;
    const double rated_nm = drive->config.plant.torque_rated_nm;
    const char *wrong;

    tuning_record_free(&result->relay);
    if (!tune_drive_start(drive, CIA402_MODE_CYCLIC_SYNC_TORQUE))
        return "its drive has no mode of cyclic torque (10), or does not come to be enabled";

    const double at = tune_drive_position(drive);
    struct relay r = {
        .drive = drive,
        .record = &result->relay,
        .cycle_s = 1e-9 * drive->cycle_ns,
        .centre = maths_clamp(at, axis->travel_min_mm + INSIDE_PART * travel,
                              axis->travel_max_mm - INSIDE_PART * travel),
        .low_end = maths_min(at, axis->travel_min_mm) - OUT_PART * travel,
        .high_end = maths_max(at, axis->travel_max_mm) + OUT_PART * travel,
        .before = at,
        .now = at,
        .low = at,
        .high = at,
        .torque = torque,
        .sign = 1,
    };

    r.sign = r.centre < at ? -1 : 1;
    wrong = find_torque(&r, rated_nm);
    if (wrong == NULL)
        wrong = swing(&r, rated_nm);
    result->torque_nm = 1e-3 * r.torque * rated_nm;
    result->low = r.low;
    result->high = r.high;
    return wrong;
}

static bool agree(const struct tuning_plant *a, const struct tuning_plant *b, double cycle_s)
{
    const double inertia = maths_max(a->inertia_kg_m2, b->inertia_kg_m2);
    const double delay_s = maths_max(a->delay_s, b->delay_s);

    return maths_abs(a->inertia_kg_m2 - b->inertia_kg_m2) <= AGREE_PART * inertia &&
           maths_abs(a->delay_s - b->delay_s) <= AGREE_PART * delay_s + AGREE_CYCLE * cycle_s;
}

const char *tune_relay_run(struct tune_axis *result, struct tune_drive *drive,
                           const struct machine_axis *axis)
{
    const struct drive_plant_config *plant = &drive->config.plant;
    const double travel_per_rad = plant->travel_per_revolution_mm / MATHS_TWO_PI;
    int32_t torque = TORQUE_FIRST;
    struct tuning_plant before = {0};

    for (;;) {
        const char *wrong = test_with(result, drive, axis, torque);

        if (wrong != NULL)
            return wrong;
        const bool is_found = tuning_identify(&result->relay, travel_per_rad, &result->plant);

        if (is_found && agree(&before, &result->plant, result->relay.cycle_s))
            return NULL;
        torque = (int32_t)takt_maths_round(1e3 * result->torque_nm / plant->torque_rated_nm);
        if (torque >= TORQUE_LAST)
            return "tests of its torque do not agree on an inertia and a delay: is friction near "
                   "its rated torque?";
        torque = (int32_t)maths_min(2 * torque, TORQUE_LAST);
        before = is_found ? result->plant : (struct tuning_plant){0};
    }
}
