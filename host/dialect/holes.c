/*
 * Holes as other controls write them, in the cycles of LinuxCNC:
 *
 *     G81 Z-5 F100                  without R, where none of the same series has one, the tool drills from where it is
 *     G83 Z-30 Q5000                pecks in thousandths
 *     G83 X0 Z-30 (a lathe)         along Z, whatever the plane of its arcs is
 *     G83 Z-30 R-5 (a lathe)        R may be a height or a distance: the machine file says so
 *     G81 X1 Y2 Z2 I-5 (Fagor)      Z is the height that R has here, I the bottom
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/*
 * From here on a peck without a point is in thousandths: nothing is bored at one go that is so
 * long.
 */
#define WHOLE_MIN 100.0

/* Fagor's G81, where K would be a dwell and has another unit. */
static bool has_two_heights(struct line *l)
{
    return line_find_code(l, 'g', 810) != NULL && line_find(l, 'z', 0) != NULL &&
           line_find(l, 'i', 0) != NULL && line_find(l, 'r', 0) == NULL &&
           line_find(l, 'k', 0) == NULL;
}

/* On the line of the cycle and on those that repeat it. */
static void rename_heights(struct line *l)
{
    const struct line_word *z = line_find(l, 'z', 0);
    const struct line_word *i = line_find(l, 'i', 0);

    if (z != NULL)
        l->text[z->begin] = 'R';
    if (i != NULL)
        l->text[i->begin] = 'Z';
    (void)line_read(l, l->text, l->length);
}

/* Thousandths; inches: ten-thousandths. */
static void write_peck(struct line *l)
{
    struct line_word *q = line_find(l, 'q', 0);
    char text[64];

    if (q == NULL || !q->is_number || q->has_point || q->value < WHOLE_MIN)
        return;
    (void)snprintf(text, sizeof text, "Q[%.0f*[0.001-0.0009*#<_imperial>]]", q->value);
    (void)line_replace(l, q, text);
}

/*
 * A lathe of Fanuc has a distance in R, one of Haas a height: of a program for either it is not
 * clear. False then, unless the machine file says so.
 */
static bool read_meaning(const struct translator *t, bool *distance)
{
    for (unsigned i = 0; i < t->codes->count; i++) {
        if (t->codes->code[i].letter == 'r') {
            *distance = t->codes->code[i].use == DIALECT_DISTANCE;
            return true;
        }
    }
    return t->dialect == DIALECT_HAAS;
}

static bool is_incremental(struct translator *t)
{
    return line_find_code(&t->line, 'g', 910) != NULL ||
           (t->incremental && line_find_code(&t->line, 'g', 900) == NULL);
}

/* R-5 as a height, of the line that begins a series and of those that go on with it. */
static void write_height(struct line *l)
{
    struct line_word *r = line_find(l, 'r', 0);
    char text[LINE_MAX_BYTES];

    if (r == NULL)
        return;
    (void)snprintf(text, sizeof text, "R[#<_level>+[%.*s]]", (int)(r->end - r->value_begin),
                   &l->text[r->value_begin]);
    (void)line_replace(l, r, text);
}

static void give_height(struct translator *t)
{
    struct line *l = &t->line;
    const bool incremental = is_incremental(t);
    bool distance = false;

    if (line_find(l, 'z', 0) == NULL ||
        (t->survey.lathe && !read_meaning(t, &distance) && line_find(l, 'r', 0) != NULL))
        return;
    if (t->survey.lathe) {
        (void)line_append(l, "G17");
        t->has_level = distance && !incremental;
    }
    if (t->has_level)
        translate_add(&t->before, "#<_level>=#<_z>");
    t->bores_along = t->survey.lathe;
    if (line_find(l, 'r', 0) == NULL)
        (void)line_append(l, incremental ? "R0" : "R#<_z>");
}

void holes_translate(struct translator *t)
{
    struct line *l = &t->line;
    const bool begins = series_find_cycle(l) != NULL;
    bool first;

    series_follow_programs(t);
    first = begins && !t->has_height;
    if (begins)
        t->has_two_heights = has_two_heights(l);
    if (t->has_two_heights && !series_ends(l))
        rename_heights(l);
    if (first)
        give_height(t);
    if (begins) {
        t->has_height = true;
    } else if (series_ends(l)) {
        if (t->bores_along && line_find_code(l, 'g', 170) == NULL)
            (void)line_append(l, "G18");
        t->has_height = t->has_two_heights = t->bores_along = t->has_level = false;
        t->cycle = 0;
    }
    if (t->has_level)
        write_height(l);
    if (t->has_height && (begins || line_has_axis(l)))
        write_peck(l);
    series_translate(t, first);
}
