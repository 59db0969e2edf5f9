#include "plan/path.h"

#include "plan/joint.h"

#include <assert.h>
#include <string.h>

void path_init(struct path *p, const struct plan_limits *limits, const struct point *start)
{
    memset(p, 0, sizeof(*p));
    p->limits = *limits;
    p->end = *start;
}

/* Has the motion pushed last more pieces than found room? */
static bool is_splitting(const struct path *p)
{
    return p->split_mm < p->whole.length_mm;
}

bool path_has_room(const struct path *p)
{
    return p->pushed - p->kept < PATH_BLOCKS_MAX && !is_splitting(p);
}

static struct block *slot(struct path *p, uint32_t index)
{
    return &p->block[index % PATH_BLOCKS_MAX];
}

const struct block *path_at(const struct path *p, uint32_t index)
{
    return &p->block[index % PATH_BLOCKS_MAX];
}

/* Nothing joins the newest block: it ends at rest. */
static void close_newest(struct path *p)
{
    if (p->closed < p->pushed) {
        joint_stop(slot(p, p->pushed - 1));
        p->closed = p->pushed;
    }
}

static void push_wait(struct path *p, const struct move *move)
{
    struct block *b = slot(p, p->pushed);

    close_newest(p);
    block_set_wait(b, move);
    b->number = p->motions;
    b->start = p->position;
    p->pushed++;
    p->closed = p->pushed;
}

/* The next piece of the motion being split. */
static void push_piece(struct path *p, const struct curve *curve, double to_mm)
{
    struct block *b = slot(p, p->pushed);

    block_set_motion(b, &p->split, curve, &p->limits);
    b->number = p->motions;
    b->start = p->position;
    b->from_mm = p->split_mm;
    b->continues = to_mm < p->whole.length_mm;
    if (p->closed < p->pushed) {
        joint_form(slot(p, p->pushed - 1), b, &p->limits);
        p->closed = p->pushed;
    }
    p->pushed++;
    p->position += b->length;
    p->split_mm = to_mm;
}

/* At a cusp the axes stand. */
static void push_pieces(struct path *p)
{
    while (is_splitting(p) && p->pushed - p->kept < PATH_BLOCKS_MAX) {
        const double to_mm = curve_piece_end(&p->whole, p->split_mm);
        struct curve piece;

        curve_cut(&p->whole, p->split_mm, to_mm, &piece);
        if (curve_starts_at_cusp(&piece)) {
            close_newest(p);
        }
        push_piece(p, &piece, to_mm);
        if (curve_ends_at_cusp(&piece)) {
            close_newest(p);
        }
    }
}

static void push_motion(struct path *p, const struct move *move, const struct curve *curve)
{
    p->split = *move;
    p->whole = *curve;
    p->split_mm = 0.0;
    p->end = move->end;
    push_pieces(p);
}

void path_go_on(struct path *p)
{
    push_pieces(p);
    if (p->finished && !is_splitting(p)) {
        close_newest(p);
    }
}

void path_restart(struct path *p, const struct point *at, uint64_t position)
{
    p->first = p->pushed;
    p->kept = p->pushed;
    p->closed = p->pushed;
    p->end = *at;
    p->position = position;
    p->split_mm = p->whole.length_mm;
}

void path_push(struct path *p, const struct move *move)
{
    struct curve curve;

    assert(path_has_room(p) && !p->finished);
    if (!move_is_motion(move)) {
        push_wait(p, move);
        return;
    }
    p->motions++;
    if (move_curve(move, &p->end, &curve)) {
        push_motion(p, move, &curve);
    }
    if (move->kind == MOVE_PROBE || move->kind == MOVE_TAP) {
        close_newest(p);
    }
}

void path_finish(struct path *p)
{
    p->finished = true;
    if (!is_splitting(p)) {
        close_newest(p);
    }
}

void path_pass(struct path *p)
{
    assert(p->first != p->pushed);
    p->first++;
}
