#include "controller/controller_probe.h"

#include "base/handoff.h"
#include "base/maths.h"

/* Longer than any machine waits. */
#define CYCLES_MAX 1e15

static bool is_probing(const struct controller_probe *q)
{
    return q->state == PROBE_ASKED && q->move.kind == MOVE_PROBE;
}

void controller_probe_ask(struct controller_probe *q, const struct move *move, double cycle_s)
{
    if (move->kind != MOVE_PROBE && move->kind != MOVE_INPUT) {
        return;
    }
    *q = (struct controller_probe){.move = *move, .answers = q->answers, .taken = q->taken};
    q->cycles_left = (uint64_t)maths_min(maths_ceil(move->timeout_s / cycle_s), CYCLES_MAX);
    handoff_order();
    q->state = PROBE_ASKED;
}

/* What the move looks for: contact, or none any more. */
static bool is_found(const struct controller_probe *q, const struct inputs *inputs)
{
    return inputs->probe_contact != q->move.probe_away;
}

static void find(struct controller_probe *q, const struct point *actual)
{
    q->answer.contact = true;
    q->answer.contact_at = *actual;
}

/* As in LinuxCNC, a move that must find what it looks for may not begin where it is found already. */
bool controller_probe_watch(struct controller_probe *q, const struct move *executed,
                            const struct inputs *inputs, const struct point *actual)
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
        find(q, actual);
    }
    return true;
}

/* The drives may follow up to the end after the last setpoint: the probe is looked at once more. */
static void end_probing(struct controller_probe *q, const struct inputs *inputs,
                        const struct point *rest, const struct point *actual)
{
    q->answer.rest_at = *rest;
    if (q->error == TAKT_OK && !q->answer.contact && is_found(q, inputs)) {
        find(q, actual);
    }
    if (q->answer.contact || q->error != TAKT_OK) {
        return;
    }
    q->answer.contact_at = *rest;
    if (!q->move.probe_optional) {
        q->error = q->move.probe_away ? TAKT_ERROR_PROBE_NO_RELEASE : TAKT_ERROR_PROBE_NO_CONTACT;
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

bool controller_probe_rest(struct controller_probe *q, const struct inputs *inputs,
                           const struct point *rest, const struct point *actual)
{
    if (q->state != PROBE_ASKED) {
        return false;
    }
    if (q->move.kind == MOVE_PROBE) {
        end_probing(q, inputs, rest, actual);
    } else if (q->move.analogue) {
        q->answer.value = inputs->analogue[q->move.channel];
    } else if (!end_waiting(q, inputs)) {
        return false;
    }
    handoff_order();
    q->state = PROBE_ANSWERED;
    return true;
}

bool controller_probe_take(struct controller_probe *q, struct program_answer *answer,
                           struct diagnostic *error)
{
    if (q->state != PROBE_ANSWERED) {
        return false;
    }
    handoff_order();
    *answer = q->answer;
    diagnostic_set(error, q->error, q->move.line, 0, "", 0, 0.0);
    q->answers++;
    q->taken = q->answer;
    handoff_order();
    q->state = PROBE_IDLE;
    return true;
}
