/*
 * Which motion a line makes: codes that stay in effect, what goes on behind cycles, and ways to the
 * reference.
 */
#include "dialect/translate.h"

#include <string.h>

void motion_follow_modes(struct translator *t)
{
    struct line *l = &t->line;
    static const char across[] = {'k', 'j', 'i'};

    for (unsigned plane = 0; plane < 3; plane++) {
        if (line_find_code(l, 'g', 170 + 10 * plane) != NULL)
            t->across = across[plane];
    }
    if (line_find_code(l, 'g', 900) != NULL)
        t->incremental = false;
    if (line_find_code(l, 'g', 910) != NULL)
        t->incremental = true;
}

const char *motion_distance_mode(struct line *l)
{
    if (line_find_code(l, 'g', 900) != NULL)
        return "0";
    return line_find_code(l, 'g', 910) != NULL ? "1" : "#<_incremental>";
}

/*
 * Behind a cycle G0 or G1 is in effect again, as it was before it. What is executed before is the
 * text before, as long as there are no jumps and calls.
 */
static void go_on_behind_cycle(struct translator *t, bool motion, bool other)
{
    struct line *l = &t->line;
    const bool elsewhere = t->survey.jumps || (l->words > 0 && l->word[0].letter == 'o') ||
                           line_find_code(l, 'm', 980) != NULL;

    if (!motion && !other && t->ended_cycle && t->straight != NULL && line_has_axis(l) &&
        translate_is(t, TRANSLATE_INDUSTRY)) {
        (void)line_append(l, t->straight);
        t->ended_cycle = false;
    }
    if (elsewhere || line_find_code(l, 'g', 20) != NULL || line_find_code(l, 'g', 30) != NULL)
        t->straight = NULL;
    else if (line_find_code(l, 'g', 0) != NULL || line_find_code(l, 'g', 10) != NULL)
        t->straight = line_find_code(l, 'g', 0) != NULL ? "G0" : "G1";
    t->ended_cycle = line_ends_cycle(l) || (t->ended_cycle && !motion);
}

void motion_translate(struct translator *t)
{
    bool motion;
    bool other;

    line_look_for_motion(&t->line, &motion, &other);
    go_on_behind_cycle(t, motion, other);
    if (line_has_axis(&t->line) && !motion && !other &&
        (t->motion_is_owed ||
         (translate_is(t, TRANSLATE_GRBL) && !t->has_motion && line_is_plain(&t->line)))) {
        (void)line_append(&t->line, "G0");
        motion = true;
    }
    t->has_motion = t->has_motion || motion;
    t->motion_is_owed = t->motion_is_owed && !motion;
}

void motion_translate_machine(struct translator *t)
{
    if (translate_is(t, TRANSLATE_INDUSTRY) && (!t->has_motion || t->ended_cycle) &&
        line_is_bare_machine(&t->line))
        (void)line_append(&t->line, "G0");
}

/* ---- reference ---- */

/* An axis that is named, whatever its value: it goes there straight. */
static bool make_bare(struct translator *t, struct line_word *w)
{
    const bool counts = w->kind == WORD_BARE || translate_is(t, TRANSLATE_MARLIN);
    char text[] = "x0";

    if (strchr(LINE_AXES, w->letter) == NULL || w->letter == ' ' || !counts)
        return false;
    text[0] = t->line.text[w->begin];
    (void)line_replace(&t->line, w, text);
    return true;
}

/* U V W are distances along X Y Z. */
static bool make_distance(struct line *l, struct line_word *w)
{
    if (w->kind != WORD_VALUE || (w->letter != 'u' && w->letter != 'v' && w->letter != 'w'))
        return false;
    l->text[w->begin] = (char)(w->letter - 'u' + 'X');
    return line_read(l, l->text, l->length);
}

static void set_incremental(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *absolute = line_find_code(l, 'g', 900);

    if (absolute != NULL)
        line_blank(l, absolute);
    if (t->incremental || line_find_code(l, 'g', 910) != NULL)
        return;
    (void)line_append(l, "G91");
    translate_add(&t->behind, "G90");
}

static void drop_motion(struct translator *t)
{
    for (unsigned number = 0; number <= 10; number += 10) {
        struct line_word *w = line_find_code(&t->line, 'g', number);

        if (w != NULL && line_has_axis(&t->line)) {
            line_blank(&t->line, w);
            t->motion_is_owed = number == 0;
        }
    }
}

/* G30 P2 is the reference that G30 goes to without P; there are no others. */
static void drop_second(struct translator *t)
{
    struct line_word *p = line_find(&t->line, 'p', 0);

    if (p != NULL && p->is_number && p->value == 2.0 && translate_is(t, TRANSLATE_INDUSTRY))
        line_blank(&t->line, p);
}

void motion_translate_reference(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *second = line_find_code(l, 'g', 300);
    bool relative = false;

    if (line_find_code(l, 'g', 280) == NULL && second == NULL)
        return;
    if (second != NULL)
        drop_second(t);
    for (unsigned i = 0; i < l->words; i++) {
        if (make_bare(t, &l->word[i]) ||
            (translate_is(t, TRANSLATE_MACROS) && make_distance(l, &l->word[i])))
            relative = true;
        else if (l->word[i].kind == WORD_BARE)
            line_blank(l, &l->word[i]);
    }
    drop_motion(t);
    if (relative)
        set_incremental(t);
}
