/*
 * Polar words: @ is the distance from the zero of the work coordinates, ^ the angle. What one of
 * them leaves out is as where the tool is.
 *
 *     #<_polar_radius> = [@] #<_polar_angle> = [^]
 *     X = radius cos angle,  Y = radius sin angle
 * Fanuc's X and Y between G16 and G15 are the same.
 *
 * With G91 they are differences, and so are X and Y; a repeated cycle (L) then is a line for each
 * hole, since the holes may lie on a circle.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

#define TEXT_MAX    256
#define REPEATS_MAX 1000

#define RADIUS_HERE "SQRT[#5420*#5420+#5421*#5421]"
#define ANGLE_HERE  "ATAN[#5421]/[#5420]"

/*
 * From G16 to G15 X is the distance and Y the angle, in G17 and with G90; otherwise G16 stays, and
 * is told.
 */
static void rename_words(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *begin = line_find_code(l, 'g', 160);
    struct line_word *x = line_find(l, 'x', 0);
    struct line_word *y = line_find(l, 'y', 0);
    const bool clear = t->across == 'k' && !t->incremental && line_find_code(l, 'g', 910) == NULL;

    t->polar = (t->polar || begin != NULL) && line_find_code(l, 'g', 150) == NULL;
    if (!t->polar)
        return;
    if (clear && begin != NULL)
        line_blank(l, begin);
    else if (!clear && begin == NULL && (x != NULL || y != NULL))
        (void)line_append(l, "G16");
    if (clear && x != NULL)
        l->text[x->begin] = '@';
    if (clear && y != NULL)
        l->text[y->begin] = '^';
    (void)line_read(l, l->text, l->length);
}

static void write_value(const struct line *l, const struct line_word *w, const char *here,
                        const char *mode, char text[TEXT_MAX])
{
    if (w == NULL)
        (void)snprintf(text, TEXT_MAX, "[%s]", here);
    else
        (void)snprintf(text, TEXT_MAX, "[[%.*s]+%s*[%s]]", (int)(w->end - w->value_begin),
                       &l->text[w->value_begin], mode, here);
}

static unsigned take_repeats(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *w = line_find(l, 'l', 0);
    const bool relative = line_find_code(l, 'g', 910) != NULL ||
                          (t->incremental && line_find_code(l, 'g', 900) == NULL);

    if (w == NULL || !relative || !w->is_number || !(w->value >= 1.0 && w->value <= REPEATS_MAX))
        return 1;
    line_blank(l, w);
    return (unsigned)w->value;
}

void polar_translate(struct translator *t)
{
    struct line *l = &t->line;

    if (t->dialect == DIALECT_FANUC || t->dialect == DIALECT_HAAS || t->dialect == DIALECT_MACH3)
        rename_words(t);
    struct line_word *radius = line_find(l, '@', 0);
    struct line_word *angle = line_find(l, '^', 0);
    char text[2][TEXT_MAX];
    char words[TEXT_MAX];
    const char *mode = motion_distance_mode(l);

    if (radius == NULL && angle == NULL)
        return;
    write_value(l, radius, RADIUS_HERE, mode, text[0]);
    write_value(l, angle, ANGLE_HERE, mode, text[1]);
    for (unsigned i = 0; i < 2; i++) {
        struct line_word *w = i == 0 ? radius : angle;

        if (w != NULL)
            line_blank(l, w);
    }
    (void)snprintf(words, sizeof words,
                   "X[#<_polar_radius>*COS[#<_polar_angle>]-%s*#5420] "
                   "Y[#<_polar_radius>*SIN[#<_polar_angle>]-%s*#5421]",
                   mode, mode);
    (void)line_append(l, words);
    const unsigned repeats = take_repeats(t);

    translate_add(&t->before, "#<_polar_radius>=%s #<_polar_angle>=%s", text[0], text[1]);
    for (unsigned i = 1; i < repeats; i++) {
        translate_add(&t->behind, "#<_polar_radius>=%s #<_polar_angle>=%s", text[0], text[1]);
        translate_add(&t->behind, "%s", l->text);
    }
}
