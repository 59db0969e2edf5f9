/*
 * What a series of drilling cycles of Fanuc and Haas keeps from hole to hole.
 *
 *     G90 G81 Z-10. R2.          R and Z are places for all holes that follow, also with G91:
 *     G91 X10. L2                X10. L2 R[#<_hole_r>-#<_hole_level>] Z[#<_hole_z>-#<_hole_r>]
 *     G81 X1. K3 (Fanuc)         L3
 *     G82 Z-5. R1.               P0
 *     G76 Z-9. R1. Q.1 P300      G89: the bar does not stop turned and step aside, but leaves at the feed
 *
 * Programs that never change between G90 and G91 in a series stay as they are.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/* M97 P30 and M98 P30 are not the same. */
#define LINES_FIRST 100000000U

struct line_word *series_find_cycle(struct line *l)
{
    static const uint16_t others[] = {730, 740};

    for (unsigned code = 810; code <= 890; code += 10) {
        struct line_word *w = line_find_code(l, 'g', code);

        if (w != NULL)
            return w;
    }
    struct line_word *w = line_find_code(l, 'g', others[0]);

    return w != NULL ? w : line_find_code(l, 'g', others[1]);
}

bool series_ends(struct line *l)
{
    for (unsigned code = 0; code <= 30; code += 10) {
        if (line_find_code(l, 'g', code) != NULL)
            return true;
    }
    return line_find_code(l, 'g', 800) != NULL;
}

/* ---- what the whole text has ---- */

static bool is_called(const struct survey *s, uint32_t number)
{
    for (unsigned i = 0; i < s->drilled; i++) {
        if (s->drills[i] == number)
            return true;
    }
    return false;
}

static void note_call(struct survey *s, uint32_t number)
{
    if (s->drilled < TRANSLATE_PROGRAMS_MAX && !is_called(s, number))
        s->drills[s->drilled++] = number;
}

/* Subprograms that are called in a series go on with it. */
static void note_calls(struct survey *s, struct line *l)
{
    const struct line_word *p = line_find(l, 'p', 0);

    if (p == NULL || !p->is_number)
        return;
    if (line_find_code(l, 'm', 980) != NULL) {
        note_call(s, line_whole(p->value));
        note_call(s, line_whole(p->value) % 10000U);
    }
    if (line_find_code(l, 'm', 970) != NULL)
        note_call(s, LINES_FIRST + line_whole(p->value));
}

/* A program begins here; *inside: in a series of who calls it. */
static bool begins_program(const struct survey *s, const struct line *l, bool *inside)
{
    const struct line_word *first = l->words > 0 ? &l->word[0] : NULL;
    const struct line_word *number = line_number(l);

    if (first != NULL && first->letter == 'o' && first->is_number) {
        *inside = is_called(s, line_whole(first->value));
        return true;
    }
    *inside = number != NULL && is_called(s, LINES_FIRST + line_whole(number->value));
    return *inside;
}

void series_survey(struct survey *s, struct line *l)
{
    const bool begins = series_find_cycle(l) != NULL;
    const bool was = s->relative;
    bool inside;

    if (begins_program(s, l, &inside))
        s->drilling = inside;
    s->relative =
        (s->relative || line_find_code(l, 'g', 910) != NULL) && line_find_code(l, 'g', 900) == NULL;
    if (!begins && series_ends(l))
        s->drilling = false;
    s->mixes = s->mixes || (s->drilling && s->relative != was);
    s->drilling = s->drilling || begins;
    if (s->drilling)
        note_calls(s, l);
}

/* ---- lines ---- */

/* A line without a cycle of its own that makes a hole. */
static bool repeats(const struct translator *t, struct line *l)
{
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    return t->has_height && !motion && !other && (line_has_axis(l) || line_find(l, 'r', 0) != NULL);
}

static void drop(struct line *l, const char *letters)
{
    for (; *letters != '\0'; letters++) {
        struct line_word *w = line_find(l, *letters, 0);

        if (w != NULL)
            line_blank(l, w);
    }
}

/* G76 of a mill; of a lathe it is a thread. */
void series_translate_fine_boring(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *w = line_find_code(l, 'g', 760);

    if (t->survey.lathe)
        return;
    if (w == NULL) {
        t->bores_fine = t->bores_fine && series_find_cycle(l) == NULL && !series_ends(l);
        if (t->bores_fine && repeats(t, l))
            drop(l, "qij");
        return;
    }
    if (line_find(l, 'k', 0) != NULL || (line_find(l, 'r', 0) == NULL && !t->has_height))
        return;
    translate_note(t, w, "stop and step aside of fine boring, the tool leaves at the feed");
    (void)line_replace(l, w, line_find(l, 'p', 0) != NULL ? "G89" : "G85");
    drop(l, "qij");
    t->bores_fine = true;
}

/* I, J and K of Haas are pecks that get smaller, by J, from I down to K. */
static void take_shrinking_pecks(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *i = line_find(l, 'i', 0);
    struct line_word *k = line_find(l, 'k', 0);

    if (t->dialect != DIALECT_HAAS || i == NULL || k == NULL || line_find(l, 'q', 0) != NULL ||
        (line_find_code(l, 'g', 830) == NULL && line_find_code(l, 'g', 730) == NULL))
        return;
    translate_note(t, i, "pecks that get smaller, all are as the last");
    l->text[k->begin] = 'Q';
    (void)line_read(l, l->text, l->length);
    drop(l, "ij");
}

/* K3 of Fanuc is L3; with I and J it is a word of G87. */
static void name_repeats(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *k = line_find(l, 'k', 0);

    if (t->dialect != DIALECT_FANUC || k == NULL || line_find(l, 'l', 0) != NULL ||
        line_find(l, 'i', 0) != NULL || line_find(l, 'j', 0) != NULL)
        return;
    l->text[k->begin] = 'L';
    (void)line_read(l, l->text, l->length);
}

/* A cycle that waits, and has not been told how long. */
static void give_dwell(struct translator *t, const struct line_word *cycle)
{
    const unsigned code = (unsigned)line_code(cycle);
    const bool waits = code == 820 || code == 860 || code == 880 || code == 890;
    const bool known = t->cycle == code;

    t->cycle = code;
    if (waits && !known && line_find(&t->line, 'p', 0) == NULL)
        (void)line_append(&t->line, "P0");
}

static void put_place(struct line *l, char letter, const char *value)
{
    struct line_word *w = line_find(l, letter, 0);
    char text[80];

    (void)snprintf(text, sizeof text, "%c[%s]", letter - 'a' + 'A', value);
    if (w != NULL)
        (void)line_replace(l, w, text);
    else
        (void)line_append(l, text);
}

/* What a word says, as a place that is so far from another with G91. */
static void note_place(struct translator *t, const char *name, char letter, const char *mode,
                       const char *from)
{
    const struct line_word *w = line_find(&t->line, letter, 0);

    if (w != NULL)
        translate_add(&t->before, "#<_hole_%s>=[[%.*s]+%s*#<_hole_%s>]", name,
                      (int)(w->end - w->value_begin), &t->line.text[w->value_begin], mode, from);
}

static void keep_places(struct translator *t, bool first)
{
    const char across = (char)('z' - ('k' - t->across));
    const char *mode = motion_distance_mode(&t->line);
    char text[64];

    if (first)
        translate_add(&t->before, "#<_hole_level>=#<_%c>", across);
    note_place(t, "r", 'r', mode, "level");
    note_place(t, "z", across, mode, "r");
    (void)snprintf(text, sizeof text, "#<_hole_r>-%s*#<_hole_level>", mode);
    put_place(&t->line, 'r', text);
    (void)snprintf(text, sizeof text, "#<_hole_z>-%s*#<_hole_r>", mode);
    put_place(&t->line, across, text);
}

void series_translate(struct translator *t, bool first)
{
    const struct line_word *cycle = series_find_cycle(&t->line);

    if (cycle == NULL && !repeats(t, &t->line))
        return;
    take_shrinking_pecks(t);
    if (!t->has_two_heights)
        name_repeats(t);
    cycle = series_find_cycle(&t->line);
    if (cycle != NULL)
        give_dwell(t, cycle);
    if (t->survey.mixes && !t->survey.lathe)
        keep_places(t, first);
}

void series_follow_programs(struct translator *t)
{
    bool inside;

    if (begins_program(&t->survey, &t->line, &inside)) {
        t->has_height = inside;
        t->cycle = 0;
    }
}
