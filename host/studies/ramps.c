#include "studies/ramps.h"

#include "base/maths.h"

/* What is followed of one line: its way in the cycle before, and how that has changed. */
struct follower {
    struct point way;
    double step_mm, change_mm;
};

void ramps_init(struct ramps *r, const struct machine *machine, double unit_mm)
{
    *r = (struct ramps){.cycle_s = 1e-6 * (double)machine->cycle_us,
                        .unit_mm = unit_mm,
                        .end_shift = machine->interpolator_end_shift};
}

static void raise_to(double *largest, double value)
{
    *largest = maths_max(*largest, value);
}

static double length(const struct point *p)
{
    double squares = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        squares += p->at[i] * p->at[i];
    return maths_sqrt(squares);
}

/* Distance of a way done from the line. */
static double off_line(const struct curve *c, const struct point *way)
{
    struct point off;
    double along = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        along += way->at[i] * (c->end.at[i] - c->start.at[i]) / c->length_mm;
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        off.at[i] = way->at[i] - along * (c->end.at[i] - c->start.at[i]) / c->length_mm;
    return length(&off);
}

static double count_axes(const struct curve *c)
{
    double count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        count += c->start.at[i] != c->end.at[i] ? 1 : 0;
    return count;
}

static void look_at_end_rule(struct ramps *r, const struct integrate_line *line, double step_mm)
{
    const double part = step_mm / line->config.end_mm;

    if (line->phase != INTEGRATE_AIMED)
        return;
    r->slowest = r->slowest > 0 ? maths_min(r->slowest, part) : part;
    raise_to(&r->fastest, part);
}

static void look(struct ramps *r, const struct integrate_line *line, struct follower *f)
{
    const struct curve *c = &r->line.curve;
    struct point way, moved;
    double step_mm, change_mm;

    takt_integrate_get_way(&line->axes, &way);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        moved.at[i] = way.at[i] - f->way.at[i];
    step_mm = length(&moved);
    change_mm = step_mm - f->step_mm;
    raise_to(&r->off_mm, off_line(c, &way));
    raise_to(&r->off_bound_mm, maths_sqrt(count_axes(c)) * (line->axes.loss_ulp + 1) * r->unit_mm);
    if (line->phase != INTEGRATE_LANDED)
        raise_to(&r->step_mm_s2, maths_abs(change_mm - f->change_mm) / (r->cycle_s * r->cycle_s));
    look_at_end_rule(r, line, step_mm);
    *f = (struct follower){way, step_mm, change_mm};
}

/*
 * Way in a cycle at a feed. What is below a cycle's change of it, a dt, is a stop: ramps of such
 * steps cannot meet it.
 */
static double end_mm(const struct ramps *r, double feed_mm_s)
{
    return feed_mm_s < r->line.a_mm_s2 * r->cycle_s ? 0 : feed_mm_s * r->cycle_s;
}

static void drive_line(struct ramps *r)
{
    const struct curve *c = &r->line.curve;
    const struct integrate_line_config config = {
        .unit_mm = r->unit_mm,
        .length_mm = c->length_mm,
        .start_mm = end_mm(r, r->start_mm_s),
        .feed_mm = r->most_mm_s * r->cycle_s,
        .end_mm = end_mm(r, r->feed_mm_s),
        .acceleration_mm = r->line.a_mm_s2 * r->cycle_s * r->cycle_s,
        .end_shift = r->end_shift,
    };
    struct follower f = {.step_mm = config.start_mm};
    struct integrate_line line;

    takt_integrate_line_begin(&line, &config, &c->start, &c->end);
    while (takt_integrate_line_cycle(&line)) {
        r->cycles++;
        look(r, &line, &f);
    }
    r->lines++;
}

void ramps_finish(struct ramps *r)
{
    if (r->follows && r->most_mm_s > 0)
        drive_line(r);
    r->follows = false;
}

static void begin_line(struct ramps *r, const struct cycle_record *record,
                       const struct block *block)
{
    r->block = record->block;
    r->follows = block->curve.kind == CURVE_LINE && block->curve.length_mm > 0;
    r->start_mm_s = r->feed_mm_s;
    r->most_mm_s = r->feed_mm_s;
}

/* The cycle ends at rest, or is one: its mean feed is not that of its end. */
static bool is_rest(const struct cycle_record *record, const struct block *block)
{
    return block == NULL || (record->landed && block->end == JUNCTION_STOP);
}

void ramps_add(struct ramps *r, const struct cycle_record *record, const struct block *block)
{
    const bool moves = block != NULL && block_is_motion(block);

    if (!moves || record->block != r->block)
        ramps_finish(r);
    if (moves && record->block != r->block)
        begin_line(r, record, block);
    if (moves)
        r->line = *block;
    r->feed_mm_s = is_rest(record, block) ? 0 : record->feed_mm_s;
    raise_to(&r->most_mm_s, record->feed_mm_s);
    r->run_cycles += r->follows ? 1 : 0;
}
