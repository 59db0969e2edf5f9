#include "motion/motion.h"

#include <assert.h>
#include <string.h>

void motion_init(struct motion *m, double cycle_s, const struct point *start)
{
    memset(m, 0, sizeof(*m));
    m->cycle_s = cycle_s;
    m->at = *start;
}

bool motion_has_room(const struct motion *m)
{
    return m->count < MOTION_QUEUE_MAX;
}

struct segment *motion_next_slot(struct motion *m)
{
    assert(motion_has_room(m));
    return &m->queue[(m->first + m->count) % MOTION_QUEUE_MAX];
}

void motion_push(struct motion *m)
{
    m->count++;
}

const struct segment *motion_segment(const struct motion *m)
{
    return &m->queue[m->first];
}

/* Leaves the segments whose cycles are over. False: none is left. */
static bool advance(struct motion *m)
{
    while (m->count > 0 && motion_segment(m)->move.kind != MOVE_END &&
           m->passed == motion_segment(m)->cycles) {
        m->passed = 0;
        m->first = (m->first + 1) % MOTION_QUEUE_MAX;
        m->count--;
    }
    return m->count > 0;
}

/* Where the segment's motion is in this cycle. */
static void move_along(struct motion *m, const struct segment *s, struct cycle_record *record)
{
    struct profile_state state;

    record->landed = s->end != JOINT_PASSED && m->passed + 1 == s->cycles;
    if (record->landed) {
        m->at = s->curve.end;
        record->feed_mm_s = s->profile.feed_end_mm_s;
        return;
    }
    profile_evaluate(&s->profile, s->first_s + (double)m->passed * m->cycle_s, &state);
    curve_point(&s->curve, state.s_mm, &m->at);
    record->feed_mm_s = state.v_mm_s;
}

enum motion_result motion_cycle(struct motion *m, struct cycle_record *record)
{
    const struct segment *s;

    if (!advance(m)) {
        return MOTION_STARVED;
    }
    s = motion_segment(m);
    if (s->move.kind == MOVE_END) {
        return MOTION_DONE;
    }
    memset(record, 0, sizeof(*record));
    if (move_is_motion(&s->move)) {
        move_along(m, s, record);
    }
    record->cycle = m->cycles;
    record->block = s->block;
    record->line = s->move.line;
    record->cmd = m->at;
    m->cycles++;
    m->passed++;
    return MOTION_CYCLE;
}
