#include "correction/correction.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "base/maths.h"
#include "correction/layer.h"
#include "correction/setup.h"

#include <string.h>

#define CORRECTION_DECLARE(NAME, name) extern const struct correction_layer takt_layer_##name;
CORRECTION_LAYERS(CORRECTION_DECLARE)
#undef CORRECTION_DECLARE

#define CORRECTION_LIST(NAME, name) &takt_layer_##name,
static const struct correction_layer *const layers[] = {CORRECTION_LAYERS(CORRECTION_LIST)};
#undef CORRECTION_LIST

_Static_assert(CORRECTION_LAYERS_COUNT <= 8, "a move has a byte for the layers a program switches");

/* The layers that read tables. */
#define LAYERS_OF_TABLES (1U << CORRECTION_AXES | 1U << CORRECTION_VOLUME)

unsigned takt_correction_axis_of(const struct correction *c, unsigned coordinate)
{
    return coordinate < AXIS_LINEAR_COUNT ? coordinate : c->settings.turn_axis;
}

/* Lets a layer look at its settings and tables anew. */
static void begin_layer(struct correction *c, unsigned i)
{
    const unsigned bit = 1U << i;

    TAKT_ASSERT(i < CORRECTION_LAYERS_COUNT);
    memset(&c->notes[i], 0, sizeof(c->notes[i]));
    if (i == CORRECTION_VOLUME) {
        memset(&c->patches, 0, sizeof(c->patches));
    }
    c->present &= ~bit;
    c->followers &= ~bit;
    if (layers[i]->begin(c, &c->notes[i])) {
        c->present |= bit;
        c->followers |= layers[i]->follow != NULL ? bit : 0U;
    }
}

void takt_correction_restart(struct correction *c, const struct point *start)
{
    c->at = start;
    c->fading = c->running = c->program_off = 0;
    memset(c->weight, 0, sizeof(c->weight));
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT; i++) {
        begin_layer(c, i);
    }
    c->at = NULL;
}

void takt_correction_init(struct correction *c, const struct correction_settings *settings,
                          unsigned axes, double cycle_s, const struct correction_tables *tables,
                          const struct point *start)
{
    TAKT_ASSERT(cycle_s > 0.0 && axes != 0 && axes < 1U << AXIS_COUNT);
    memset(c, 0, sizeof(*c));
    c->settings = *settings;
    c->axes = axes;
    while (axes >> c->axes_end != 0) {
        c->axes_end++;
    }
    c->cycle_s = cycle_s;
    c->tables = tables;
    c->off = settings->off;
    takt_fade_pace_set(&c->layer_pace, settings->fade_s, cycle_s);
    takt_fade_pace_set(&c->reversal_pace, settings->reversal_fade_s, cycle_s);
    takt_correction_forget_setup(c);
    takt_correction_restart(c, start);
}

/* ---- the control cycle ---- */

static unsigned wanted(const struct correction *c)
{
    const unsigned loading = (c->pending != NULL ? LAYERS_OF_TABLES : 0U) |
                             (c->setup_waits ? 1U << CORRECTION_SETUP : 0U);

    return c->present & ~(c->off | c->program_off | loading);
}

/* The lowest layer of a set that is not empty. */
static unsigned first_of(unsigned set)
{
    return (unsigned)__builtin_ctz(set);
}

static bool is_prepared(struct correction *c, unsigned i)
{
    return layers[i]->prepare == NULL || layers[i]->prepare(c);
}

/* on: the layers that are wanted. */
static __attribute__((noinline)) void fade_layers(struct correction *c, unsigned on)
{
    const unsigned before = c->running;
    unsigned rest = (on ^ before) | c->fading;

    c->running &= ~rest;
    for (c->fading = 0; rest != 0; rest &= rest - 1U) {
        const unsigned i = first_of(rest);
        const unsigned bit = 1U << i;
        const bool is_on = (on & bit) != 0 && ((before & bit) != 0 || is_prepared(c, i));

        if (fade_cycle(&c->weight[i], is_on ? 1.0 : 0.0, &c->layer_pace)) {
            c->fading |= bit;
            c->running |= bit;
        } else {
            c->running |= is_on ? bit : 0U;
        }
    }
    if (((on | c->running) & 1U << CORRECTION_VOLUME) == 0) {
        c->patches.is_known = c->patches.is_ready = false;
    }
}

/* New tables take the place of the old ones when nobody reads them any more. */
static __attribute__((noinline)) void exchange_tables(struct correction *c)
{
    TAKT_ASSERT(c->pending != NULL);
    c->tables = c->pending;
    c->pending = NULL;
    begin_layer(c, CORRECTION_AXES);
    begin_layer(c, CORRECTION_VOLUME);
}

/* The new set-up takes the place of the old one when nobody reads that any more. */
static void exchange_setup(struct correction *c)
{
    const unsigned bit = 1U << CORRECTION_SETUP;
    const bool any = takt_setup_exchange(c, &c->notes[CORRECTION_SETUP]);

    TAKT_ASSERT(c->setup_waits);
    c->present = any ? c->present | bit : c->present & ~bit;
    handoff_order();
    c->setup_waits = false;
}

static void follow(struct correction *c)
{
    for (unsigned rest = c->followers; rest != 0; rest &= rest - 1U) {
        const unsigned i = first_of(rest);

        layers[i]->follow(c, &c->notes[i]);
        c->notes[i].started = true;
    }
}

static void add_layers(struct correction *c, struct point *set)
{
    struct correction_sum sum;

    memset(sum.fine, 0, sizeof(sum.fine));
    sum.coarse = set->at;
    sum.outside = 0;
    for (unsigned rest = c->running; rest != 0; rest &= rest - 1U) {
        const unsigned i = first_of(rest);

        layers[i]->add(c, &c->notes[i], c->weight[i].value, &sum);
    }
    for (unsigned i = 0; i < c->axes_end; i++) {
        set->at[i] += (double)sum.fine[i];
    }
    c->outside |= sum.outside;
}

void takt_correction_cycle(struct correction *c, const struct point *cmd, const struct move *move,
                           struct point *set)
{
    *set = *cmd;
    if (c->present == 0 && c->pending == NULL && !c->setup_waits) {
        return;
    }
    c->move = move;
    c->at = cmd;
    if (move_is_motion(move)) {
        c->program_off = move->correction_off;
    }
    follow(c);
    const unsigned on = wanted(c);

    if (c->fading != 0 || c->running != on) {
        fade_layers(c, on);
    }
    if (c->running != 0) {
        add_layers(c, set);
    }
    if (c->pending != NULL && ((c->running | c->fading) & LAYERS_OF_TABLES) == 0) {
        exchange_tables(c);
    }
    if (c->setup_waits && ((c->running | c->fading) & 1U << CORRECTION_SETUP) == 0) {
        handoff_order();
        exchange_setup(c);
    }
}

void takt_correction_stand(struct correction *c, const struct point *cmd, struct point *set)
{
    static const struct move standing = {.kind = MOVE_DWELL};

    takt_correction_cycle(c, cmd, &standing, set);
}

/* A layer as it is when everything has settled. */
static void add_settled(struct correction *c, unsigned i, struct correction_sum *sum)
{
    struct layer_notes *notes = &c->notes[i];

    begin_layer(c, i);
    if (i == CORRECTION_WEAR) {
        return;
    }
    if (i == CORRECTION_AXES) {
        memset(notes->coefficient, 0, sizeof(notes->coefficient));
    } else if ((c->followers & 1U << i) != 0) {
        layers[i]->follow(c, notes);
    }
    layers[i]->add(c, notes, 1.0, sum);
}

void takt_correction_evaluate(const struct correction *c, const struct point *at,
                              const struct move *move, struct point *k)
{
    struct correction settled = *c;
    struct correction_sum sum;

    memset(&sum, 0, sizeof(sum));
    memset(k, 0, sizeof(*k));
    sum.coarse = k->at;
    settled.at = at;
    settled.move = move;
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT; i++) {
        if ((c->present & ~(c->off | (unsigned)move->correction_off) & 1U << i) != 0) {
            add_settled(&settled, i, &sum);
        }
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        k->at[i] += (double)sum.fine[i];
    }
}

/* ---- what others set and ask ---- */

void takt_correction_switch(struct correction *c, enum correction_layer_number layer, bool on)
{
    TAKT_ASSERT(layer < CORRECTION_LAYERS_COUNT);
    c->off = on ? c->off & ~(1U << layer) : c->off | 1U << layer;
}

void takt_correction_set_rise(struct correction *c, enum axis axis, double rise_k)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    c->rise_k[axis] = rise_k;
}

bool takt_correction_is_loading(const struct correction *c)
{
    return c->pending != NULL;
}

unsigned takt_correction_get_running(const struct correction *c)
{
    return c->running | c->fading;
}

unsigned takt_correction_get_present(const struct correction *c)
{
    return c->present;
}

const char *takt_correction_layer_name(enum correction_layer_number layer)
{
    TAKT_ASSERT(layer < CORRECTION_LAYERS_COUNT);
    return layers[layer]->name;
}

unsigned takt_correction_take_outside(struct correction *c)
{
    const unsigned outside = c->outside;

    c->outside = 0;
    return outside;
}

/* ---- shares of the axes' limits ---- */

/* A layer K faded by w: products of the derivatives of both (Leibniz). */
static void add_faded(struct need *sum, const struct need *k, const struct fade_pace *pace,
                      unsigned i)
{
    const double w1 = takt_fade_velocity_per_s(pace);
    const double w2 = takt_fade_acceleration_per_s2(pace);
    const double w3 = takt_fade_jerk_per_s3(pace);

    sum->size_mm[i] += k->size_mm[i];
    sum->noise_mm[i] += k->noise_mm[i];
    sum->velocity_mm_s[i] += k->velocity_mm_s[i] + w1 * k->size_mm[i];
    sum->acceleration_mm_s2[i] +=
        k->acceleration_mm_s2[i] + 2.0 * w1 * k->velocity_mm_s[i] + w2 * k->size_mm[i];
    sum->jerk_mm_s3[i] += k->jerk_mm_s3[i] + 3.0 * w1 * k->acceleration_mm_s2[i] +
                          3.0 * w2 * k->velocity_mm_s[i] + w3 * k->size_mm[i];
}

/* Rounding of K in differences over a cycle: up to 2, 4 and 8 times itself. */
static void add_noise(struct need *need, double cycle_s, unsigned i)
{
    const double step_mm_s = 2.0 * need->noise_mm[i] / cycle_s;

    TAKT_ASSERT(i < AXIS_COUNT && cycle_s > 0.0);
    need->velocity_mm_s[i] += step_mm_s;
    need->acceleration_mm_s2[i] += 2.0 * step_mm_s / cycle_s;
    need->jerk_mm_s3[i] += 4.0 * step_mm_s / (cycle_s * cycle_s);
}

/* next: the set-up that is to be weighed; NULL: the one in force. */
static void weigh(const struct correction *c, const struct setup *next,
                  const struct motion_bound *most, struct need *need)
{
    const unsigned present = next != NULL ? c->present | 1U << CORRECTION_SETUP : c->present;

    memset(need, 0, sizeof(*need));
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT; i++) {
        struct need of_layer;

        if ((present & 1U << i) == 0) {
            continue;
        }
        memset(&of_layer, 0, sizeof(of_layer));
        if (i == CORRECTION_SETUP && next != NULL) {
            takt_setup_need(c, next, most, &of_layer);
        } else {
            layers[i]->need(c, &c->notes[i], most, &of_layer);
        }
        for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
            add_faded(need, &of_layer, &c->layer_pace, axis);
        }
    }
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        add_noise(need, c->cycle_s, axis);
    }
}

void takt_correction_get_need(const struct correction *c, const struct motion_bound *most,
                              struct need *need)
{
    weigh(c, NULL, most, need);
}

static void raise(double *value, double least)
{
    *value = maths_max(*value, least);
}

void takt_correction_reserve(struct correction *c, const struct motion_bound *most,
                             struct need *need)
{
    const double reserve = c->settings.reserve_ratio;

    if (c->setup_waits) { /* has been weighed against it; the old one still fades out */
        *need = c->reserved;
        return;
    }
    takt_correction_get_need(c, most, need);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        raise(&need->velocity_mm_s[i], reserve * most->velocity_mm_s[i]);
        raise(&need->acceleration_mm_s2[i], reserve * most->acceleration_mm_s2[i]);
        raise(&need->jerk_mm_s3[i], reserve * most->jerk_mm_s3[i]);
    }
    c->reserved = *need;
    c->most = *most;
    c->is_reserved = true;
}

static double share_of(double need, double most)
{
    TAKT_ASSERT(need >= 0.0);
    return most > 0.0 ? need / most : 0.0;
}

double takt_correction_largest_share(const struct need *need, const struct motion_bound *most,
                                     enum axis *axis)
{
    double largest = 0.0;

    *axis = AXIS_X;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double share = share_of(need->velocity_mm_s[i], most->velocity_mm_s[i]);

        raise(&share, share_of(need->acceleration_mm_s2[i], most->acceleration_mm_s2[i]));
        raise(&share, share_of(need->jerk_mm_s3[i], most->jerk_mm_s3[i]));
        if (share > largest) {
            largest = share;
            *axis = (enum axis)i;
        }
    }
    return largest;
}

/* The need of other tables than those in use. */
static void need_with(const struct correction *c, const struct correction_tables *tables,
                      struct need *need)
{
    static const struct point somewhere = {{0.0}};
    struct correction other = *c;

    other.at = &somewhere;
    other.tables = tables;
    begin_layer(&other, CORRECTION_AXES);
    begin_layer(&other, CORRECTION_VOLUME);
    takt_correction_get_need(&other, &c->most, need);
}

/* More than was reserved, on some axis? */
static bool exceeds_reserve(const struct correction *c, const struct need *need)
{
    for (unsigned i = 0; c->is_reserved && i < AXIS_COUNT; i++) {
        if (need->velocity_mm_s[i] > c->reserved.velocity_mm_s[i] ||
            need->acceleration_mm_s2[i] > c->reserved.acceleration_mm_s2[i] ||
            need->jerk_mm_s3[i] > c->reserved.jerk_mm_s3[i]) {
            return true;
        }
    }
    return false;
}

bool takt_correction_load(struct correction *c, const struct correction_tables *tables,
                          struct diagnostic *wrong)
{
    struct need need;

    TAKT_ASSERT(c->pending == NULL);
    need_with(c, tables, &need);
    if (exceeds_reserve(c, &need)) {
        enum axis axis;
        const double share = takt_correction_largest_share(&need, &c->most, &axis);

        takt_diagnostic_set(wrong, TAKT_ERROR_TABLE_RESERVE, 0, 0, &AXIS_LETTERS[axis], 1,
                            100.0 * share);
        return false;
    }
    c->pending = tables;
    return true;
}

/* ---- the set-up of the part ---- */

bool takt_correction_take_setup(struct correction *c)
{
    struct need need;

    TAKT_ASSERT(!c->setup_waits);
    memcpy(c->setup_next.number, c->setup_told, sizeof(c->setup_told));
    takt_setup_prepare(&c->setup_next);
    weigh(c, &c->setup_next, &c->most, &need);
    if (exceeds_reserve(c, &need)) {
        takt_correction_forget_setup(c);
        return false;
    }
    handoff_order();
    c->setup_waits = true;
    return true;
}

bool takt_correction_is_setting_up(const struct correction *c)
{
    const unsigned bit = 1U << CORRECTION_SETUP;

    return c->setup_waits || ((c->fading | (wanted(c) ^ c->running)) & bit) != 0;
}

void takt_correction_settle_setup(struct correction *c)
{
    if (c->setup_waits) {
        exchange_setup(c);
    }
}
