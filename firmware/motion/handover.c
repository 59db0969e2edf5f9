#include "motion/handover.h"

#include "base/assert.h"

void takt_handover_allow(struct motion *m, enum motion_handover which)
{
    TAKT_ASSERT(which != MOTION_HANDS_OVER_LINEAR || m->path->pushed == 0);
    m->hands_over = which;
}

void takt_handover_add_cycle(struct motion *m, const struct point *at, double feed_mm_s,
                             bool landed, struct cycle_record *record)
{
    const struct block *b = path_first(m->path);
    struct reference_start start;

    (void)takt_reference_step(&m->reference, m->setpoint, true,
                              &start); /* it stands, and takes ceilings */
    m->current = m->path->first;
    m->at = *at;
    m->feed = feed_mm_s * m->cycle_s;
    record->cycle = m->cycles;
    record->block = b->number;
    record->line = b->move.line;
    record->feed_mm_s = feed_mm_s;
    record->override_percent = 100.0;
    record->limiter = 1.0;
    record->cmd = *at;
    record->landed = landed;
    m->cycles++;
}

void takt_handover_pass_block(struct motion *m)
{
    takt_path_pass(m->path);
    m->current = m->path->first;
}

void takt_handover_end(struct motion *m)
{
    const struct block *b = path_first(m->path);

    takt_reference_stand(&m->reference, b->start + b->length);
    takt_average_start(&m->mover.average, m->path->limits.profile, 1, m->reference.at, 0);
    m->setpoint = m->reference.at;
    m->feed = 0.0;
    m->at = b->curve.end;
    m->end = MOTION_ARRIVED;
    m->rested = 0;
}
