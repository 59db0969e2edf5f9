#include "controller/controller_probe.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "base/maths.h"

/* Longer than any machine waits. */
#define CYCLES_MAX 1e15

static bool is_probing(const struct controller_probe *q)
{
    return q->state == PROBE_ASKED && q->move.kind == MOVE_PROBE;
}

bool takt_controller_probe_ask(struct controller_probe *q, const struct move *move, double cycle_s,
                               bool latches)
{
    if (move->kind != MOVE_PROBE && move->kind != MOVE_INPUT &&
        !(move->kind == MOVE_SETUP && move->setup_ends)) {
        return true;
    }
    *q = (struct controller_probe){.move = *move, .answers = q->answers, .taken = q->taken};
    q->cycles_left = (uint64_t)maths_min(takt_maths_ceil(move->timeout_s / cycle_s), CYCLES_MAX);
    q->latches = latches && move->kind == MOVE_PROBE;
    handoff_order();
    q->state = q->latches ? PROBE_HELD : PROBE_ASKED;
    return !q->latches;
}

bool takt_controller_probe_begin(struct controller_probe *q)
{
    if (q->state != PROBE_ARMED) {
        return false;
    }
    handoff_order();
    q->state = PROBE_ASKED;
    return true;
}

/* What the move looks for: contact, or none any more. */
static bool is_found(const struct controller_probe *q, const struct inputs *inputs)
{
    return inputs->probe_contact != q->move.probe_away;
}

/* Until the axes rest, rest_at is where the drives have reported them at contact. */
static void find(struct controller_probe *q, const struct controller_place *at)
{
    TAKT_ASSERT(!q->answer.contact);
    q->answer.contact = true;
    q->answer.contact_at = at->actual;
    q->answer.rest_at = at->reported;
}

/*
 * As in LinuxCNC, a move that must find what it looks for may not begin where it is found already.
 */
bool takt_controller_probe_watch(struct controller_probe *q, const struct move *executed,
                                 const struct inputs *inputs, const struct controller_place *at)
{
    const bool begins = !q->begun;

    if (!is_probing(q) || executed->kind != MOVE_PROBE || q->answer.contact ||
        q->error != TAKT_OK) {
        return false;
    }
    q->begun = true;
    if (!is_found(q, inputs)) {
        return false;
    }
    if (begins && !q->move.probe_optional) {
        q->error = q->move.probe_away ? TAKT_ERROR_PROBE_CLEAR : TAKT_ERROR_PROBE_TOUCHES;
    } else {
        find(q, at);
    }
    return true;
}

/*
 * contact = what the cycle has seen + (latched - reported in that cycle)
 *
 * So what correction has added there is left out of both.
 */
static void take_latched(struct program_answer *answer, const struct drives *drives)
{
    struct point latched = answer->rest_at;

    takt_drives_get_latched(drives, &latched);
    for (int i = 0; i < AXIS_COUNT; i++) {
        answer->contact_at.at[i] += latched.at[i] - answer->rest_at.at[i];
    }
}

/* Touch probes are being read; false: they have been, or there is nothing to be read. */
static bool is_reading(struct controller_probe *q, struct drives *drives)
{
    if (!q->latches || !q->answer.contact) {
        return false;
    }
    if (!q->reads) {
        takt_drives_read_probe(drives);
        q->reads = true;
    }
    if (drives_probe_is_busy(drives)) {
        return true;
    }
    take_latched(&q->answer, drives);
    return false;
}

static void end_without_contact(struct controller_probe *q, const struct point *rest)
{
    q->answer.contact_at = *rest;
    if (!q->move.probe_optional) {
        q->error = q->move.probe_away ? TAKT_ERROR_PROBE_NO_RELEASE : TAKT_ERROR_PROBE_NO_CONTACT;
    }
}

/*
 * The drives may follow up to the end after the last setpoint: the probe is looked at once more.
 * False: not yet.
 */
static bool end_probing(struct controller_probe *q, const struct inputs *inputs,
                        struct drives *drives, const struct point *rest,
                        const struct controller_place *at)
{
    if (q->error == TAKT_OK && !q->answer.contact && is_found(q, inputs)) {
        find(q, at);
    }
    if (is_reading(q, drives)) {
        return false;
    }
    q->answer.rest_at = *rest;
    if (!q->answer.contact && q->error == TAKT_OK) {
        end_without_contact(q, rest);
    }
    return true;
}

/* The axes rest before the move: the touch probes are told to look for its edge. */
static void arm(struct controller_probe *q, struct drives *drives)
{
    TAKT_ASSERT(q->state == PROBE_HELD);
    if (!q->begun) {
        takt_drives_arm_probe(drives, q->move.probe_away);
        q->begun = true;
    } else if (!drives_probe_is_busy(drives)) {
        q->begun = false;
        handoff_order();
        q->state = PROBE_ARMED;
    }
}

/* Has come what M66 waits for? before: the level in the cycle before. */
static bool is_reached(enum input_wait wait, bool before, bool level)
{
    switch (wait) {
    case INPUT_READ:
        return true;
    case INPUT_RISE:
        return level && !before;
    case INPUT_FALL:
        return !level && before;
    case INPUT_HIGH:
        return level;
    case INPUT_LOW:
        return !level;
    }
    return true;
}

/* False: neither the input nor its time has come. */
static bool end_waiting(struct controller_probe *q, const struct inputs *inputs)
{
    const bool level = (inputs->digital >> q->move.channel & 1U) != 0;
    const bool before = q->begun ? q->level_before : level;

    TAKT_ASSERT(q->move.channel < OUTPUTS_DIGITAL_MAX);
    q->begun = true;
    q->level_before = level;
    if (is_reached(q->move.input_wait, before, level)) {
        q->answer.value = level ? 1.0 : 0.0;
        return true;
    }
    if (q->cycles_left == 0) {
        q->answer.value = PROGRAM_INPUT_TIMED_OUT;
        return true;
    }
    q->cycles_left--;
    return false;
}

bool takt_controller_probe_rest(struct controller_probe *q, const struct inputs *inputs,
                                struct drives *drives, const struct point *rest,
                                const struct controller_place *at)
{
    if (q->state == PROBE_HELD) {
        arm(q, drives);
    }
    if (q->state != PROBE_ASKED) {
        return false;
    }
    if (q->move.kind == MOVE_PROBE) {
        if (!end_probing(q, inputs, drives, rest, at)) {
            return false;
        }
    } else if (q->move.kind == MOVE_INPUT && q->move.analogue) {
        q->answer.value = inputs->analogue[q->move.channel];
    } else if (q->move.kind == MOVE_INPUT && !end_waiting(q, inputs)) {
        return false;
    }
    handoff_order();
    q->state = PROBE_ANSWERED;
    return true;
}

bool takt_controller_probe_take(struct controller_probe *q, struct program_answer *answer,
                                struct diagnostic *error)
{
    if (q->state != PROBE_ANSWERED) {
        return false;
    }
    handoff_order();
    *answer = q->answer;
    takt_diagnostic_set(error, q->error, q->move.line, 0, "", 0, 0.0);
    q->answers++;
    q->taken = q->answer;
    handoff_order();
    q->state = PROBE_IDLE;
    return true;
}
