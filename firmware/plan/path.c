#include "plan/path.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "base/maths.h"
#include "plan/jerk_budget.h"
#include "plan/junction.h"
#include "plan/path_unit.h"
#include "plan/scale.h"

#include <stddef.h>
#include <string.h>

_Static_assert(JERK_BUDGET_BLOCKS_MAX <= PATH_MODES_MAX,
               "blocks that are not closed leave room for more, without which they never are");

/* Path counts as much as the fastest axis goes in that time: a length that looks like mm. */
static void init_smooth(struct path *p)
{
    struct smooth_limits limits = {.axes = p->limits.axes,
                                   .chord_error_max_mm = p->limits.chord_error_max_mm,
                                   .cycle_s = p->limits.cycle_s,
                                   .windows = takt_ramp_profile_windows(p->limits.profile)};

    for (int i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = p->limits.velocity_mm_s[i];
        limits.acceleration_mm_s2[i] = p->limits.acceleration_mm_s2[i];
        limits.jerk_mm_s3[i] = p->limits.jerk_mm_s3[i];
        p->unit_mm = maths_max(p->unit_mm, limits.velocity_mm_s[i]);
    }
    takt_smooth_init(&p->smooth, &limits);
}

/*
 * Has it been appended? That alone is asked of an index here: the cycle may pass blocks, or drop
 * the path, while the background reads them, which is safe as long as it appends none meanwhile.
 */
static bool is_pushed(const struct path *p, uint32_t index)
{
    return (int32_t)(p->pushed - index) > 0;
}

void takt_path_init(struct path *p, const struct plan_limits *limits, const struct point *start)
{
    TAKT_ASSERT(limits->cycle_s > 0.0);
    memset(p, 0, sizeof(*p));
    p->limits = *limits;
    p->end = *start;
    p->ring.scale = takt_scale_of_machine(limits);
    takt_record_begin_chain(&p->ring.chain);
    TAKT_ASSERT(p->ring.scale.linear > 0.0 && p->ring.scale.rotary > 0.0);
    init_smooth(p);
}

/* Where smoothing keeps its chain. */
void *takt_path_lend(struct path *p, size_t size)
{
    _Static_assert(offsetof(struct path, smooth.route) % sizeof(uint64_t) == 0,
                   "at a multiple of 8");
    (void)size;
    TAKT_ASSERT(size <= PATH_LENT_MAX && !smooth_is_open(&p->smooth));
    p->lent = true;
    return (unsigned char *)&p->smooth + offsetof(struct smooth, route);
}

/* Has the motion pushed last more pieces than found room? */
static bool is_splitting(const struct path *p)
{
    return p->split_mm < p->length_mm;
}

/* For a block whose record has size bytes at most. */
static bool has_slot(const struct path *p, uint32_t size)
{
    return takt_ring_has_room(&p->ring, handoff_get_count(&p->kept), p->pushed, size);
}

bool takt_path_has_room(const struct path *p)
{
    const uint64_t ahead = p->position - path_start(p, handoff_get_count(&p->kept));

    return has_slot(p, RECORD_SHORT_MAX) && !is_splitting(p) && !p->has_next &&
           ahead < SCALE_LENGTH_UNITS && takt_smooth_has_room(&p->smooth);
}

uint32_t takt_path_look_ahead(const struct path *p, uint32_t blocks)
{
    return (smooth_is_open(&p->smooth) || p->lent) && blocks < SMOOTH_AHEAD_PIECES
               ? SMOOTH_AHEAD_PIECES
               : blocks;
}

/* The newest block, or the one that becomes it. */
static struct block *edge(struct path *p, uint32_t index)
{
    return &p->edge[index % 2];
}

double takt_path_length(const struct path *p, uint32_t index)
{
    TAKT_ASSERT(is_pushed(p, index));
    return path_mm(path_at(p, index)->start, path_end(p, index));
}

enum move_kind takt_path_kind(const struct path *p, uint32_t index)
{
    TAKT_ASSERT(is_pushed(p, index));
    return takt_record_kind(ring_record(&p->ring, index));
}

double takt_path_feed_rev(const struct path *p, uint32_t index)
{
    TAKT_ASSERT(is_pushed(p, index));
    return takt_record_feed_rev(ring_record(&p->ring, index));
}

void takt_path_read_move(const struct path *p, uint32_t index, struct move *move)
{
    TAKT_ASSERT(is_pushed(p, index));
    takt_ring_read_move(&p->ring, index, move);
}

/* Nothing joins the newest block: it ends at rest. */
static void close_newest(struct path *p)
{
    if (p->closed < p->pushed) {
        takt_junction_stop(edge(p, p->pushed - 1));
        takt_jerk_budget_note(p, p->pushed - 1, edge(p, p->pushed - 1));
        takt_jerk_budget_close(p);
    }
}

/* control: of a piece of a smoothed curve, else NULL. */
static void append(struct path *p, const struct block *b, const struct point control[4])
{
    TAKT_ASSERT(p->pushed - p->closed < JERK_BUDGET_BLOCKS_MAX);
    takt_ring_push(&p->ring, handoff_get_count(&p->kept), p->pushed, b, control);
    takt_jerk_budget_begin(p, p->pushed, b);
    handoff_set_count(&p->pushed, p->pushed + 1U);
    handoff_order(); /* until then position is the end of the block before */
    p->position += b->length;
}

static void push_wait(struct path *p, const struct move *move)
{
    struct block *b = edge(p, p->pushed);

    close_newest(p);
    takt_block_set_wait(b, move);
    b->number = p->motions;
    b->start = p->position;
    append(p, b, NULL);
    handoff_set_count(&p->closed, p->pushed);
}

/* The newest block but for its start, joined to the one before. */
static void append_joined(struct path *p, struct block *b)
{
    b->start = p->position;
    if (p->closed < p->pushed) {
        takt_junction_form(edge(p, p->pushed - 1), b, &p->limits);
        takt_jerk_budget_note(p, p->pushed - 1, edge(p, p->pushed - 1));
    }
    append(p, b, NULL);
    if (p->pushed - p->closed > 1) {
        takt_jerk_budget_spread(p);
    }
}

/* The next piece of the motion being split. */
static void push_piece(struct path *p, const struct curve *curve, double to_mm)
{
    struct block *b = edge(p, p->pushed);

    TAKT_ASSERT(to_mm > p->split_mm && to_mm <= p->length_mm);
    takt_block_set_motion(b, &p->split, curve, &p->limits);
    b->number = p->split_number;
    b->continues = to_mm < p->length_mm;
    append_joined(p, b);
    p->split_mm = to_mm;
}

/* Pushes pieces of the whole curve. At a cusp the axes stand. */
static void push_pieces(struct path *p, const struct curve *whole)
{
    const uint32_t size = whole->kind == CURVE_INVOLUTE || whole->kind == CURVE_QUINTIC
                              ? RECORD_MAX
                              : RECORD_SHORT_MAX;

    while (is_splitting(p) && has_slot(p, size)) {
        const double to_mm = takt_curve_piece_end(whole, p->split_mm);
        struct curve piece;

        takt_curve_cut(whole, p->split_mm, to_mm, &piece);
        if (takt_curve_starts_at_cusp(&piece)) {
            close_newest(p);
        }
        push_piece(p, &piece, to_mm);
        if (takt_curve_ends_at_cusp(&piece)) {
            close_newest(p);
        }
    }
}

static void push_motion(struct path *p, const struct move *move, uint32_t number,
                        const struct curve *curve)
{
    TAKT_ASSERT(!is_splitting(p));
    p->split = *move;
    p->split_number = number;
    p->from = p->end;
    p->length_mm = curve->length_mm;
    p->split_mm = 0.0;
    p->end = move->end;
    push_pieces(p, curve);
}

static void go_on_splitting(struct path *p)
{
    struct curve whole;

    if (is_splitting(p) && takt_move_curve(&p->split, &p->from, &whole)) {
        push_pieces(p, &whole);
    }
}

/* Is the newest block a piece of a smoothed curve that goes on? Its last one is closed. */
static bool is_smoothing(const struct path *p)
{
    return p->closed < p->pushed && path_at(p, p->pushed - 1)->smooth;
}

/* The next piece of the smoothed chain. Nothing joins its first and its last one. */
static void push_smooth_piece(struct path *p, const struct smooth_piece *piece)
{
    struct block *b = edge(p, p->pushed);

    takt_block_set_smooth(b, piece, p->unit_mm);
    b->start = p->position;
    if (is_smoothing(p)) {
        takt_block_join_smooth(edge(p, p->pushed - 1), b);
        takt_jerk_budget_note(p, p->pushed - 1, edge(p, p->pushed - 1));
        takt_jerk_budget_close(p);
    } else {
        close_newest(p);
    }
    if (piece->end == SMOOTH_ENDS) {
        b->curve.end = piece->move->end;
    }
    append(p, b, piece->control);
    if (piece->end != SMOOTH_GOES_ON) {
        close_newest(p);
    }
}

/* The next motion of a chain that is taken as it is programmed. */
static void push_smooth_motion(struct path *p, const struct smooth_piece *piece,
                               const struct curve *curve)
{
    struct block *b = edge(p, p->pushed);

    if (piece->starts) {
        close_newest(p);
    }
    takt_block_set_motion(b, piece->move, curve, &p->limits);
    b->number = piece->number;
    b->continues = piece->continues;
    append_joined(p, b);
}

/* The next of the smoothed chain; false: there is none. */
static bool push_smooth(struct path *p, union smooth_scratch *scratch)
{
    struct smooth_piece piece;
    struct curve curve;

    switch (takt_smooth_take(&p->smooth, scratch, &piece, &curve)) {
    case SMOOTH_NONE:
        return false;
    case SMOOTH_PIECE:
        push_smooth_piece(p, &piece);
        break;
    case SMOOTH_MOTION:
        push_smooth_motion(p, &piece, &curve);
        break;
    }
    return true;
}

/* Nothing joins the end of a chain. */
static void push_smooth_pieces(struct path *p)
{
    if (p->spare == PATH_NO_SPARE) {
        return;
    }
    union path_spare *spare = p->spare == 0 ? &p->area.high.spare : &p->area.low.spare;
    TAKT_ASSERT(p->spare < PATH_NO_SPARE);
    const bool open = smooth_is_open(&p->smooth);

    while (has_slot(p, RECORD_MAX) && push_smooth(p, &spare->scratch)) {
    }
    if (open && !smooth_is_open(&p->smooth)) {
        close_newest(p);
    }
}

static bool turns_rotary(const struct path *p, const struct move *move)
{
    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        if (move->end.at[i] != p->end.at[i]) {
            return true;
        }
    }
    return false;
}

/*
 * Where position begins or ceases to follow the spindle the axes stand; so they do in the hole, and
 * out of it; and where others than the planner move the linear axes, but not the rotary ones.
 */
static bool is_divided(const struct path *p, const struct move *move)
{
    const struct block *newest = &p->edge[(p->pushed - 1) % 2];

    return p->closed < p->pushed &&
           (newest->move.kind == MOVE_TAP_OUT ||
            move_is_synchronized(&newest->move) != move_is_synchronized(move) ||
            (p->lent && turns_rotary(p, move) != takt_block_turns(newest)));
}

static void push_move(struct path *p, const struct move *move)
{
    struct curve curve;

    if (!move_is_motion(move)) {
        push_wait(p, move);
        return;
    }
    p->motions++;
    p->has_revolution_feed = p->has_revolution_feed || move->feed_rev_mm != 0.0;
    if (is_divided(p, move)) {
        close_newest(p);
    }
    if (takt_move_curve(move, &p->end, &curve)) {
        if (takt_smooth_takes(move, &curve)) {
            TAKT_ASSERT(!p->lent);
            p->end = move->end;
            takt_smooth_push(&p->smooth, move, p->motions, &curve);
            push_smooth_pieces(p);
        } else {
            push_motion(p, move, p->motions, &curve);
        }
    }
    if (move->kind == MOVE_PROBE || move->kind == MOVE_TAP) {
        close_newest(p);
    }
}

static bool is_all_in_ring(const struct path *p)
{
    return !is_splitting(p) && !smooth_is_open(&p->smooth) && !p->has_next;
}

void takt_path_go_on(struct path *p)
{
    go_on_splitting(p);
    push_smooth_pieces(p);
    if (p->has_next && !smooth_is_open(&p->smooth) && has_slot(p, RECORD_SHORT_MAX)) {
        p->has_next = false;
        push_move(p, &p->split);
    }
    if (p->finished && is_all_in_ring(p)) {
        close_newest(p);
        TAKT_ASSERT(p->closed == p->pushed);
    }
}

void takt_path_restart(struct path *p, const struct point *at, uint64_t position)
{
    p->first = p->pushed;
    p->kept = p->pushed;
    p->closed = p->pushed;
    p->end = *at;
    p->position = position;
    p->split_mm = p->length_mm;
    p->has_next = false;
    takt_smooth_reset(&p->smooth);
    TAKT_ASSERT(!is_splitting(p) && !smooth_is_open(&p->smooth));
}

/* May it be smoothed together with what is being smoothed? */
static bool joins_chain(struct path *p, const struct move *move)
{
    struct curve curve;

    if (!smooth_is_open(&p->smooth)) {
        return true;
    }
    if (!move_is_motion(move)) {
        return false;
    }
    return !takt_move_curve(move, &p->end, &curve) ||
           (takt_smooth_takes(move, &curve) && takt_smooth_joins(&p->smooth, move, &curve));
}

/*
 * Nothing follows in the chain. One line from rest to rest is planned like an exact one: nothing is
 * quicker. There was room for it when it came, and nothing has been appended since.
 */
static void finish_chain(struct path *p)
{
    if (!takt_smooth_is_line(&p->smooth)) {
        takt_smooth_finish(&p->smooth);
        return;
    }
    const struct move move = p->smooth.merge.move;
    const uint32_t number = p->smooth.merge.number; /* motions without length may have followed */
    const struct curve line = p->smooth.merge.curve;

    takt_smooth_end(&p->smooth);
    close_newest(p);
    p->end = line.start;
    push_motion(p, &move, number, &line);
    close_newest(p);
}

void takt_path_push(struct path *p, const struct move *move)
{
    TAKT_ASSERT(takt_path_has_room(p) && !p->finished);
    if (joins_chain(p, move)) {
        push_move(p, move);
        return;
    }
    finish_chain(p);
    p->has_next = true;
    p->split = *move;
    takt_path_go_on(p);
}

void takt_path_finish(struct path *p)
{
    p->finished = true;
    finish_chain(p);
    takt_path_go_on(p);
}

void takt_path_pass(struct path *p)
{
    TAKT_ASSERT(p->first != p->closed); /* only those that the cycle may see */
    handoff_set_count(&p->first, p->first + 1U);
}
