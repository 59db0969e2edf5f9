/* The words that say where a piece of a motion ends. */
#include "base/maths.h"
#include "cli/axis_unit.h"
#include "correct/offline_private.h"
#include "program/coordinates.h"
#include "program/words.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of a thread's pitch: a thousand turns add up to the rounding of a coordinate. */
#define PITCH_PLACES 9

void offline_text_add(struct offline_text *t, const char *bytes, size_t length)
{
    if (t->length + length + 1 > t->room) {
        size_t room = 2 * t->room + length + 128;
        char *larger = realloc(t->bytes, room);

        if (larger == NULL) {
            t->failed = true;
            return;
        }
        t->bytes = larger;
        t->room = room;
    }
    memcpy(t->bytes + t->length, bytes, length);
    t->length += length;
    t->bytes[t->length] = '\0';
}

void offline_text_print(struct offline_text *t, const char *format, ...)
{
    char bytes[128];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(bytes, sizeof bytes, format, arguments);
    va_end(arguments);
    offline_text_add(t, bytes, strlen(bytes));
}

void offline_text_free(struct offline_text *t)
{
    free(t->bytes);
    *t = (struct offline_text){0};
}

/* Without the zeros at its end. Returns the value as it will be read. */
static double print_word(struct offline_text *text, char letter, double value, int places)
{
    char number[64];
    size_t length = (size_t)snprintf(number, sizeof number, "%.*f", places, value);

    while (number[length - 1] == '0')
        length--;
    if (number[length - 1] == '.')
        length--;
    if (strcmp(number, "-0") == 0 || (length == 2 && number[0] == '-' && number[1] == '0'))
        (void)snprintf(number, sizeof number, "0"), length = 1;
    offline_text_print(text, " %c%.*s", letter, (int)length, number);
    return strtod(number, NULL);
}

/* A millionth of a millimetre. */
static int places(const struct offline_line *line)
{
    return line->context.modes.unit_mm != 1.0 ? 8 : 6;
}

/* In the unit and the coordinates of the line. */
static void to_program(const struct offline_line *line, const struct point *machine,
                       struct point *value)
{
    if (words_has_step(&line->context, STEP_MACHINE))
        *value = *machine;
    else
        takt_coordinates_work_of(&line->context, machine, value);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value->at[i] *=
            i < AXIS_LINEAR_COUNT ? 1.0 / line->context.modes.unit_mm : axis_unit_ratio(i);
    if (line->context.modes.diameter)
        value->at[AXIS_X] *= 2.0;
}

/* Back. */
static void to_machine(const struct offline_line *line, const struct point *value,
                       struct point *machine)
{
    struct point work = *value;

    if (line->context.modes.diameter)
        work.at[AXIS_X] *= 0.5;
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        work.at[i] *=
            i < AXIS_LINEAR_COUNT ? line->context.modes.unit_mm : 1.0 / axis_unit_ratio(i);
    if (words_has_step(&line->context, STEP_MACHINE))
        *machine = work;
    else
        takt_coordinates_machine_of(&line->context, &work, machine);
}

/*
 * Rotary axes are left alone, unless the line turns them or correction does. What G28 does not name
 * stays where it is.
 */
static bool is_written(const struct offline_rewriter *r, const struct offline_line *line,
                       const struct offline_piece *piece, unsigned axis)
{
    const bool given = words_has(&line->context, takt_coordinates_letter((enum axis)axis));

    if ((r->axes & 1U << axis) == 0)
        return false;
    if (words_has_step(&line->context, STEP_REFERENCE))
        return given;
    return axis < AXIS_LINEAR_COUNT || piece->end.at[axis] != r->written.at[axis] || given;
}

static void print_centre(const struct offline_line *line, const struct offline_rewriter *r,
                         const struct move *move, const struct offline_piece *piece,
                         struct offline_text *text)
{
    const enum axis none = AXIS_COUNT;
    enum axis axis[2] = {none, none};
    struct point centre = r->written, from, to;

    takt_plane_axes(move->plane, &axis[0], &axis[1]);
    for (unsigned i = 0; i < 2; i++)
        centre.at[axis[i]] = piece->centre_mm[i];
    to_program(line, &r->written, &from);
    to_program(line, &centre, &to);
    for (unsigned i = 0; i < 2; i++) {
        double value =
            to.at[axis[i]] - (line->context.modes.centre_absolute ? 0.0 : from.at[axis[i]]);

        if (line->context.modes.diameter && axis[i] == AXIS_X)
            value *= 0.5;
        (void)print_word(text, (char)('I' + (int)axis[i]), value, places(line));
    }
}

/*
 * The words of the end; returns it as it will be read: what incremental words are rounded by must
 * not add up.
 */
static struct point print_end(const struct offline_rewriter *r, const struct offline_line *line,
                              const struct offline_piece *piece, struct offline_text *text)
{
    const bool incremental =
        line->context.modes.incremental && !words_has_step(&line->context, STEP_MACHINE);
    struct point from, to, read;

    to_program(line, &r->written, &from);
    to_program(line, &piece->end, &to);
    read = from;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double start = incremental ? from.at[i] : 0.0;

        if (is_written(r, line, piece, i))
            read.at[i] = start + print_word(text, AXIS_LETTERS[i], to.at[i] - start, places(line));
    }
    to_machine(line, &read, &read);
    return read;
}

void offline_print_words(struct offline_rewriter *r, const struct offline_line *line,
                         const struct move *move, const struct offline_piece *piece,
                         struct offline_text *text)
{
    const double unit_mm = line->context.modes.unit_mm;
    const struct point end = print_end(r, line, piece, text);

    if (!piece->straight && (move_is_arc(move) || move_is_involute(move)))
        print_centre(line, r, move, piece, text);
    if (!piece->straight && move_is_involute(move))
        (void)print_word(text, 'R', piece->base_radius_mm / unit_mm, places(line));
    if (move->kind == MOVE_THREAD || move->kind == MOVE_TAP)
        (void)print_word(text, 'K', piece->pitch_mm / unit_mm, PITCH_PLACES);
    r->written = end;
}

void offline_print_setting(const struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_text *text)
{
    struct point programmed, written;

    to_program(line, &r->at, &programmed);
    to_program(line, &r->written, &written);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const char letter = takt_coordinates_letter((enum axis)i);

        if (words_has(&line->context, letter))
            (void)print_word(text, AXIS_LETTERS[i],
                             words_value(&line->context, letter) + written.at[i] - programmed.at[i],
                             places(line));
    }
}
