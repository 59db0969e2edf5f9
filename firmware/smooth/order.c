#include "smooth/order.h"

#include "base/assert.h"
#include "smooth/single.h"

#include <string.h>

/* A curved element is gone along in lines that leave it by this part of the tolerance at most. */
#define CURVED_OFF 0.01f

/*
 * A line as long as its arc leaves its tangent stays within a quarter of that of it; half of it,
 * lest the bend grows.
 */
#define CURVED_LEAVES (2.0f * CURVED_OFF)

/*
 * Lines of the route beside one chord, at most: what lies farther on is come to with the next ones.
 */
#define LINKS_MAX 256

/* Corners of lines that turn less are within the tube anyway. */
#define CORNER_MIN 0.005f

/* A straight part of the route, beside a chord. */
struct link {
    uint32_t element;
    double at_mm, end_mm;
    double at[AXIS_COUNT], end[AXIS_COUNT]; /* the places there, by slot */
    float start[SMOOTH_SLOTS_MAX];          /* from the chord's beginning, weighted */
    float way[SMOOTH_SLOTS_MAX];
    float within_mm;
};

/* Parts of a line; first > last: none. */
struct parts {
    float first, last;
};

static const struct parts nowhere = {SINGLE_INFINITY, 0.0f};
static const struct parts wherever = {0.0f, 1.0f};

static bool is_there(struct parts p)
{
    return p.first <= p.last;
}

/*
 * Where a line is within a distance of a point: |f - g| <= sqrt((within^2 - d^2) / way^2), g the
 * closest point, d away.
 */
static struct parts near_point(const struct route *r, const float start[], const float way[],
                               const float point[], float within_mm)
{
    float dot = 0.0f;
    float square = 0.0f;
    float off_square = 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        dot += (point[i] - start[i]) * way[i];
        square += way[i] * way[i];
    }
    const float closest = square > 0.0f ? dot / square : 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        const float off = point[i] - start[i] - closest * way[i];

        off_square += off * off;
    }
    const float room = within_mm * within_mm - off_square;

    if (room < 0.0f || within_mm < 0.0f) {
        return nowhere;
    }
    const float half = square > 0.0f ? single_sqrt(room / square) : 1.0f;

    return (struct parts){single_max(closest - half, 0.0f), single_min(closest + half, 1.0f)};
}

/*
 * Where a link ends: on a line where nothing can be near the chord any more, on a bend where it is
 * no longer straight.
 */
static double link_end(const struct route *r, const struct order_chord *chord, struct link *l,
                       float chord_mm)
{
    const double end_mm = route_end_of(r, l->element);
    const float tolerance_mm = (float)r->tolerance_mm;
    const bool curved = route_element(r, l->element)->curved;
    const float reach_mm =
        curved ? takt_route_straight(r, l->element, l->at_mm, CURVED_LEAVES * tolerance_mm)
               : chord_mm + 3.0f * tolerance_mm;

    TAKT_ASSERT(l->at_mm <= end_mm);
    l->within_mm = curved ? chord->corner_mm - CURVED_OFF * tolerance_mm : chord->within_mm;
    return maths_min(l->at_mm + (double)reach_mm, end_mm);
}

static void set_at(const struct route *r, struct link *l, double at_mm)
{
    l->at_mm = at_mm;
    l->element = takt_route_find(r, at_mm, l->element);
    takt_route_place(r, l->element, at_mm, l->at);
}

/* The route from at_mm on. */
static void set_link(const struct route *r, const struct order_chord *chord, float chord_mm,
                     struct link *l)
{
    uint32_t hint = l->element;

    l->end_mm = link_end(r, chord, l, chord_mm);
    TAKT_ASSERT(l->end_mm >= l->at_mm);
    takt_route_point(r, l->end_mm, &hint, l->end);
    for (unsigned i = 0; i < r->slots.count; i++) {
        l->start[i] = r->slots.weight[i] * (float)(l->at[i] - chord->from[i]);
        l->way[i] = r->slots.weight[i] * (float)(l->end[i] - l->at[i]);
    }
}

/* May no way stay on it? */
static bool is_passed(const struct route *r, const struct order_chord *chord, const struct link *l)
{
    const struct route_element *e = route_element(r, l->element);

    return e->programmed_mm_s < chord->least_mm_s[e->rotary];
}

/* Is its end that of an element? */
static bool is_whole(const struct route *r, const struct link *l)
{
    return l->end_mm == route_end_of(r, l->element);
}

/* On from a link to the next one, of the same element or a later one. */
static void go_on(const struct route *r, struct link *l)
{
    TAKT_ASSERT(l->element < r->count);
    l->element += is_whole(r, l) ? 1 : 0;
    l->at_mm = l->end_mm;
    memcpy(l->at, l->end, sizeof l->at);
}

/*
 * Can the curve leave the start of an element aside? A bend of a few tolerances it can cut short
 * within the tube.
 */
static bool is_corner(const struct route *r, uint32_t element)
{
    return element < r->count &&
           (route_turn(r, element) > CORNER_MIN || route_element(r, element)->curved ||
            route_element(r, element - 1)->curved);
}

/*
 * The parts of the chord at which the end of a link is passed, when its start is at some: not
 * before that, and in the same instant if no way may stay. Where a line ends before its element
 * does, all that is near lies before that end.
 */
static struct parts pass_end(const struct route *r, const struct order_chord *chord,
                             const struct link *l, struct parts start)
{
    static const float here[SMOOTH_SLOTS_MAX];
    const bool whole = is_whole(r, l);
    const bool corner = whole && is_corner(r, l->element + 1);
    float end[SMOOTH_SLOTS_MAX];

    if (!whole && !route_element(r, l->element)->curved) {
        return nowhere;
    }
    for (unsigned i = 0; i < r->slots.count; i++) {
        end[i] = l->start[i] + l->way[i];
    }
    struct parts near =
        near_point(r, here, chord->way, end, corner ? chord->corner_mm : l->within_mm);

    near.first = single_max(start.first, near.first);
    near.last = is_passed(r, chord, l) ? single_min(start.last, near.last) : near.last;
    return is_there(near) ? near : nowhere;
}

/* Where there are too many, the lowest goes. */
static void add_span(struct order *o, double first_mm, double last_mm)
{
    TAKT_ASSERT(first_mm <= last_mm && o->count <= ORDER_SPANS);
    if (o->count > 0 && o->span[o->count - 1].last_mm == first_mm) {
        o->span[o->count - 1].last_mm = last_mm;
        return;
    }
    if (o->count == ORDER_SPANS) {
        o->count--;
        for (unsigned i = 0; i < o->count; i++) {
            o->span[i] = o->span[i + 1];
        }
    }
    o->span[o->count].first_mm = first_mm;
    o->span[o->count].last_mm = last_mm;
    o->count++;
}

/* Adds the places of a link that are near the end of the chord. */
static void add_link(struct order *o, const struct route *r, const struct order_chord *chord,
                     const struct link *l)
{
    const struct parts near = near_point(r, l->start, l->way, chord->way, l->within_mm);
    const double way_mm = l->end_mm - l->at_mm;

    if (is_there(near)) {
        add_span(o, l->at_mm + (double)near.first * way_mm,
                 near.last < 1.0f ? l->at_mm + (double)near.last * way_mm : l->end_mm);
    }
}

void takt_order_start(struct order *o, double at_mm, uint32_t element)
{
    o->count = 1;
    o->element = element;
    o->span[0].first_mm = at_mm;
    o->span[0].last_mm = at_mm;
}

/*
 * Link after link: it is come to where the curve could be beside it before, or has passed its
 * start. What of it lies within the tolerance of the chord's end can be come to then; and its own
 * end, where that is passed after its start. To have come to the end of a link is not to have
 * passed it.
 */
void takt_order_go(struct order *o, const struct route *r, const struct order_chord *chord)
{
    const struct order before = *o;
    const float chord_mm = route_length(r, chord->way);
    struct link l = {.element = before.element, .at_mm = route_element(r, r->first)->start_mm};
    struct parts start = nowhere;
    unsigned next = 0;

    o->count = 0;
    for (unsigned i = 0; i < LINKS_MAX && l.element < r->count; i++) {
        if (!is_there(start)) {
            if (next == before.count) {
                break;
            }
            set_at(r, &l, maths_max(l.at_mm, before.span[next].first_mm));
        }
        set_link(r, chord, chord_mm, &l);
        const bool stays = !is_passed(r, chord, &l);

        if (next < before.count && before.span[next].first_mm <= l.end_mm && stays) {
            start = wherever;
        }
        if (o->count == 0) {
            o->element = l.element;
        }
        if (is_there(start) && stays) {
            add_link(o, r, chord, &l);
        }
        start = pass_end(r, chord, &l, start);
        while (next < before.count && before.span[next].last_mm <= l.end_mm) {
            next++;
        }
        go_on(r, &l);
    }
}

double takt_order_place(const struct order *o, double at_mm)
{
    unsigned i = o->count - 1;

    TAKT_ASSERT(o->count > 0 && o->count <= ORDER_SPANS);
    while (i > 0 && o->span[i].first_mm > at_mm) {
        i--;
    }
    return maths_clamp(at_mm, o->span[i].first_mm, o->span[i].last_mm);
}
