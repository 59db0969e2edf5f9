/*
 * What all lines of a program for a lathe have: diameters, other feeds, and a turret.
 */
#include "lathe/lathe.h"

#include <stdio.h>

/* Which way the spindle turns behind this line. */
static void follow_spindle(struct translator *t)
{
    struct line *l = &t->line;

    for (unsigned code = 3; code <= 4; code++)
        t->turns = line_find_code(l, 'm', 10 * code) != NULL ? code : t->turns;
    if (line_find_code(l, 'm', 50) != NULL || line_find_code(l, 'm', 20) != NULL ||
        line_find_code(l, 'm', 300) != NULL)
        t->turns = 0;
}

/*
 * T0102 turns the turret to tool 1 and takes offset 2, 0 none. The spindle goes on meanwhile; M6
 * stops it.
 */
static void index_turret(struct translator *t, struct line_word *tool)
{
    struct line *l = &t->line;
    const uint32_t both = line_whole(tool->value);
    const bool told = line_find_code(l, 'm', 30) != NULL || line_find_code(l, 'm', 40) != NULL ||
                      line_find_code(l, 'm', 50) != NULL;
    const bool goes_on = t->turns != 0 && !told && line_find_code(l, 'm', 60) == NULL;
    char offset[24] = "G49";
    char text[64];

    if (both % 100 != 0)
        (void)snprintf(offset, sizeof offset, "G43 H%u", (unsigned)(both % 100));
    (void)snprintf(text, sizeof text, "T%u%s %s", (unsigned)(both / 100),
                   line_find_code(l, 'm', 60) != NULL ? "" : " M6", offset);
    (void)line_replace(l, tool, text);
    (void)snprintf(text, sizeof text, "M%u", t->turns);
    if (goes_on)
        (void)line_append(l, text);
}

/*
 * U is a distance in X as a diameter, W one in Z, where the machine file has not made them letters
 * of other axes, and nothing else on the line means something by them.
 */
void lathe_translate_increments(struct translator *t)
{
    static const uint16_t users[] = {40,  100, 280, 300, 500, 650, 660,
                                     700, 710, 720, 730, 740, 750, 760};
    struct line *l = &t->line;
    char text[LINE_MAX_BYTES];

    for (size_t i = 0; i < sizeof users / sizeof users[0]; i++) {
        if (line_find_code(l, 'g', users[i]) != NULL)
            return;
    }
    for (const char *letter = "uw"; *letter != '\0'; letter++) {
        struct line_word *w = line_find(l, *letter, 0);

        if (w == NULL || codes_find(t->codes, w) != NULL)
            continue;
        (void)snprintf(text, sizeof text, "%c[%s%.*s]", *letter == 'u' ? 'X' : 'Z',
                       t->incremental   ? ""
                       : *letter == 'u' ? "2*#<_x>+"
                                        : "#<_z>+",
                       (int)(w->end - w->value_begin), &l->text[w->value_begin]);
        (void)line_replace(l, w, text);
    }
}

/* Turning: feeds per turn, and per minute after G98; T0101 that changes the tool; diameters. */
void lathe_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *minute = line_find_code(l, 'g', 980);
    struct line_word *turn = line_find_code(l, 'g', 990);
    struct line_word *tool = line_find(l, 't', 0);

    if (!t->survey.lathe)
        return;
    if (!t->begun && l->words > 0 && l->word[0].letter != '%' && l->word[0].letter != 'o')
        translate_add(&t->before, t->called == NULL ? "G18 G7 G95" : "G18 G7");
    if (minute != NULL)
        (void)line_replace(l, minute, "G94");
    if (turn != NULL)
        (void)line_replace(l, turn, "G95");
    if (tool != NULL && tool->is_number && tool->value >= 100.0)
        index_turret(t, tool);
    follow_spindle(t);
}
