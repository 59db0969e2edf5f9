#include "program/turning.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* -- the frame -- */

/* From the profile's frame back to that of the caller. */
static struct profile_point back(const struct turning *t, struct profile_point q)
{
    q.u = t->mirror_u ? -q.u : q.u;
    q.v = t->mirror_v ? -q.v : q.v;
    return t->turned ? (struct profile_point){-q.v, q.u} : q;
}

/* So that it falls in u and rises in v. */
static void mirror(struct turning *t, struct profile *p)
{
    const struct profile_point *first = &p->segment[0].end;
    const struct profile_point *last = &p->segment[p->count - 1].end;

    t->mirror_v = first->v > last->v;
    t->mirror_u = first->u < last->u;
    takt_profile_mirror(p, t->mirror_u, t->mirror_v);
}

/* G70 goes along Z, or along X if the profile turns back in Z. */
static void set_frame(struct turning *t)
{
    if (t->words.kind == TURNING_FINISH) {
        mirror(t, &t->profile);
        t->turned = !takt_profile_falls(&t->profile, 1);
        takt_profile_mirror(&t->profile, t->mirror_u, t->mirror_v);
    } else {
        t->turned = t->words.facing;
    }
    if (t->turned) {
        takt_profile_turn(&t->profile);
    }
    mirror(t, &t->profile);
}

/* -- moves -- */

static void add(struct turning *t, bool rapid, struct profile_point end)
{
    TAKT_ASSERT(t->moves < sizeof(t->move) / sizeof(t->move[0]));
    t->move[t->moves++] = (struct turning_move){.rapid = rapid, .end = end};
}

/*
 * Along a segment to a point of it; an arc of no length would be a circle, a short one is as good
 * as its chord.
 */
static void add_along(struct turning *t, bool rapid, const struct profile_segment *s,
                      struct profile_point end)
{
    const double length = takt_profile_distance(&t->at, &end);

    if (s->kind == PROFILE_ARC && length <= PROFILE_SAME_MM) {
        t->at = end;
        return;
    }
    add(t, rapid && s->kind == PROFILE_LINE, end);
    t->move[t->moves - 1].arc = s->kind == PROFILE_ARC && length > PROFILE_SHORT_MM;
    t->move[t->moves - 1].left = s->left;
    t->move[t->moves - 1].centre = s->centre;
    t->at = end;
}

/*
 * -- pieces that rise or fall: of arcs one on each side of the centre; of what has no second the
 * second is empty --
 */

static unsigned pieces(const struct turning *t)
{
    return 2 * t->path.count;
}

static bool has_two(const struct profile_segment *s)
{
    return s->kind == PROFILE_ARC && s->start.u > s->centre.u + PROFILE_SAME_MM &&
           s->end.u < s->centre.u - PROFILE_SAME_MM;
}

/* False: it is empty. */
static bool get_piece(const struct turning *t, unsigned number, struct profile_segment *piece)
{
    const struct profile_segment *s = &t->path.segment[number / 2];

    *piece = *s;
    if (!has_two(s)) {
        return number % 2 == 0;
    }
    const double r = takt_profile_distance(&s->start, &s->centre);
    const struct profile_point middle = {s->centre.u, s->centre.v + (s->left ? r : -r)};

    if (number % 2 == 0) {
        piece->end = middle;
    } else {
        piece->start = middle;
    }
    return true;
}

static bool is_falling(const struct profile_segment *s)
{
    return s->start.v > s->end.v + PROFILE_SAME_MM;
}

/* -- roughing -- */

/* The next level that is not above the tool. */
static void lower_level(struct turning *t)
{
    const double above = t->level_mm - PROFILE_SAME_MM - t->at.v;

    if (above > 0.0) {
        t->level_mm -= takt_maths_ceil(above / t->words.step_mm) * t->words.step_mm;
    }
}

/*
 * Down along a falling piece, to the level or to its end; an arc that the level does not reach to
 * its other end.
 */
static void go_down(struct turning *t, const struct profile_segment *s)
{
    const bool first = t->piece == 0;
    struct profile_point end = {0.0, t->level_mm};

    if (t->level_mm >= s->end.v && takt_profile_cross(s, t->level_mm, &end.u)) {
        add_along(t, first, s, end);
        return;
    }
    const struct profile_segment *whole = &t->path.segment[t->piece / 2];

    if (t->piece % 2 == 0 && has_two(whole) && !whole->left) {
        t->piece++;
        end = whole->end;
    } else {
        end = s->end;
    }
    add_along(t, first, s, end);
}

/* Along the level, off the profile at 45 degrees, and back to where the cut began. */
static void cut(struct turning *t, double to_u)
{
    const double length = maths_abs(to_u - t->at.u);
    const double off = 2.0 * t->words.retract_mm > length ? 0.5 * length : t->words.retract_mm;
    const struct profile_point begin = t->at;

    add(t, false, (struct profile_point){to_u, begin.v});
    add(t, true, (struct profile_point){to_u + off, begin.v + off});
    add(t, true, (struct profile_point){begin.u - off, begin.v + off});
    add(t, t->piece == 0, begin);
    t->level_mm -= t->words.step_mm;
}

/* From the tool along its level to what it meets first. */
static void cut_level(struct turning *t)
{
    for (unsigned i = t->piece; i < pieces(t); i++) {
        struct profile_segment s;
        double u;

        if (!get_piece(t, i, &s) || !takt_profile_cross(&s, t->at.v, &u) ||
            u - PROFILE_SAME_MM > t->at.u) {
            continue;
        }
        if (maths_abs(u - t->at.u) >= PROFILE_SAME_MM) {
            cut(t, u);
            return;
        }
        if (i == t->piece) {
            continue;
        }
        if (takt_profile_distance(&t->at, &s.start) < PROFILE_SAME_MM) {
            t->piece = i;
        } else {
            t->level_mm -= t->words.step_mm;
        }
        return;
    }
    t->stage = TURNING_DONE;
}

static void step_down(struct turning *t, const struct profile_segment *s)
{
    lower_level(t);
    if (!is_falling(s)) {
        t->stage = t->words.kind == TURNING_NO_POCKETS ? TURNING_RISES : TURNING_UP;
        return;
    }
    go_down(t, s);
    if (t->piece + 2 >= pieces(t)) {
        t->stage = TURNING_DONE;
    } else if (maths_abs(t->at.v - t->level_mm) > PROFILE_SAME_MM ||
               takt_profile_distance(&t->at, &s->end) == 0.0) {
        t->piece++;
    } else {
        cut_level(t);
    }
}

/*
 * The levels of a pocket count from the tool's first place, those of G71.2 from where the pocket
 * begins.
 */
static void enter_pocket(struct turning *t)
{
    if (t->words.kind == TURNING_POCKETS) {
        t->top_mm = t->in_pocket ? maths_max(t->top_mm, t->at.v) : t->at.v;
        t->in_pocket = true;
    }
    t->level_mm = t->top_mm;
    t->stage = TURNING_DOWN;
}

static void step_up(struct turning *t, const struct profile_segment *s)
{
    if (is_falling(s)) {
        enter_pocket(t);
        return;
    }
    add_along(t, false, s, s->end);
    t->piece++;
}

static void step_skip(struct turning *t, const struct profile_segment *s)
{
    if (is_falling(s)) {
        add_along(t, t->piece == 0, s, s->end);
        t->piece++;
    } else {
        t->stage = TURNING_DOWN;
    }
}

/* Over the pocket to where the profile rises again, and along that. */
static void step_rises(struct turning *t, const struct profile_segment *s)
{
    double u;

    if (s->end.v >= s->start.v && takt_profile_cross(s, t->at.v, &u)) {
        const struct profile_point over = {u, t->at.v};

        if (takt_profile_distance(&over, &t->at) > PROFILE_SAME_MM) {
            add(t, false, over);
        }
        t->at = over;
        add_along(t, false, s, s->end);
    }
    t->piece++;
}

/* -- finishing -- */

/* Passes from D down to E, the last at E. False: the profile is too narrow for one. */
static bool begin_pass(struct turning *t)
{
    const double share = (double)(t->pass - 1) / (double)t->words.passes;

    if (!takt_profile_offset(&t->profile,
                             t->words.last_mm + share * (t->words.distance_mm - t->words.last_mm),
                             &t->path)) {
        return false;
    }
    add(t, true, t->path.segment[0].start);
    add(t, true, t->path.segment[0].end);
    t->piece = 2;
    return true;
}

static void step_draw(struct turning *t)
{
    if (t->piece < pieces(t)) {
        const struct profile_segment *s = &t->path.segment[t->piece / 2];

        add_along(t, false, s, s->end);
        t->piece += 2;
    } else if (--t->pass == 0 || !begin_pass(t)) {
        t->stage = TURNING_DONE;
    }
}

/* -- the whole -- */

static void step(struct turning *t)
{
    struct profile_segment s;

    if (t->stage == TURNING_DRAW) {
        step_draw(t);
        return;
    }
    if (t->piece >= pieces(t)) {
        t->stage = TURNING_DONE;
        return;
    }
    if (!get_piece(t, t->piece, &s)) {
        t->piece++;
        return;
    }
    switch ((enum turning_stage)t->stage) {
    case TURNING_DOWN:
        step_down(t, &s);
        break;
    case TURNING_SKIP:
        step_skip(t, &s);
        break;
    case TURNING_UP:
        step_up(t, &s);
        break;
    case TURNING_RISES:
        step_rises(t, &s);
        break;
    case TURNING_DRAW:
    case TURNING_DONE:
        break;
    }
}

/* Straight up from the end of the path to where the tool is at first: every level ends there. */
static void close_path(struct turning *t)
{
    struct profile_path *path = &t->path;
    const struct profile_point end = path->segment[path->count - 1].end;
    const struct profile_point above = {end.u, path->segment[0].start.v};

    if (end.v < above.v && path->count < PROFILE_PATH_MAX) {
        path->segment[path->count++] = (struct profile_segment){.start = end, .end = above};
    }
}

/* A start that is not before the profile is moved there. */
static void start_before(struct profile *p)
{
    struct profile_segment *way = &p->segment[0];

    way->start.u = maths_max(way->start.u, way->end.u);
}

enum turning_result takt_turning_open(struct turning *t)
{
    set_frame(t);
    start_before(&t->profile);
    if (!takt_profile_falls(&t->profile, 0)) {
        return TURNING_NOT_MONOTONE;
    }
    if (!takt_profile_round(&t->profile) || !takt_profile_falls(&t->profile, 0)) {
        return TURNING_CORNER;
    }
    takt_turning_begin(t);
    return t->stage == TURNING_DONE ? TURNING_SWALLOWED : TURNING_GOOD;
}

void takt_turning_begin(struct turning *t)
{
    t->moves = 0;
    t->fetched = 0;
    t->in_pocket = false;
    t->piece = 0;
    t->at = t->profile.segment[0].start;
    t->top_mm = t->at.v;
    t->level_mm = t->at.v;
    t->pass = t->words.passes;
    if (t->words.kind == TURNING_FINISH) {
        t->stage = begin_pass(t) ? TURNING_DRAW : TURNING_DONE;
        return;
    }
    if (!takt_profile_offset(&t->profile, t->words.distance_mm, &t->path)) {
        t->stage = TURNING_DONE;
        return;
    }
    close_path(t);
    add(t, true, t->at);
    t->stage = t->words.kind == TURNING_POCKETS ? TURNING_SKIP : TURNING_DOWN;
}

bool takt_turning_next(struct turning *t, struct turning_move *move)
{
    while (t->fetched == t->moves) {
        if (t->stage == TURNING_DONE) {
            return false;
        }
        t->moves = 0;
        t->fetched = 0;
        step(t);
    }
    *move = t->move[t->fetched++];
    move->left = move->left != (t->mirror_u != t->mirror_v);
    move->end = back(t, move->end);
    move->centre = back(t, move->centre);
    return true;
}
