/*
 * Variables of the control of Fanuc and Haas, as what LinuxCNC calls the same:
 *
 *     #5003 #5041                 #5422 #5420          where the tool is, work coordinates
 *     #5021                       #<_abs_x>            the same, machine coordinates
 *     #5221                       [#5221/[1+24.4*#<_imperial>]]    G54, in the units in effect
 *     #5041 (a lathe)             [2*#5420]            X is a diameter
 *     #[5221+20*#1]               the same, by the axis that it turns out to be
 *     #5221=#1                    G10 L2 P1 X[#1]      which counts at once
 *     #4003 #4109                 [90+#<_incremental>] #<_feed>    what is in effect
 *
 * All others would be 0 here without a word, so reading them is an error.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A line of the interpreter is no longer. */
#define CALCULATION_MAX 256U

#define OWN_LAST       999U /* the program's own */
#define POSITIONS      6U
#define SYSTEM_FIRST   5221U
#define SYSTEM_SIZE    20U
#define SYSTEM_LAST    (SYSTEM_FIRST + 6U * SYSTEM_SIZE - 1U)
#define OFFSETS_FIRST  5201U /* what cannot be read as it stands, nor given a value */
#define OFFSETS        140U
#define RUNNING_OFFSET 200U /* #4201 is #4001 of the block that runs */

static const char axes[] = "xyzabc";

static const struct mode {
    uint32_t number;
    const char *text;
} modes[] = {
    {4001, "[#<_motion_mode>/10*[#<_motion_mode> LE 30]]"},
    {4002, "[#<_plane>/10]"},
    {4003, "[90+#<_incremental>]"},
    {4006, "[20+#<_metric>]"},
    {4007, "[#<_ccomp>/10]"},
    {4008, "[49-6*#<_tool_offset>]"},
    {4010, "[98+#<_retract_r_plane>]"},
    {4014, "[#<_coord_system>/10]"},
    {4109, "#<_feed>"},
    {4119, "#<_rpm>"},
    {4120, "#<_selected_tool>"},
};

struct place {
    size_t at, length; /* #5041 in the line */
    uint32_t number;
};

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* The next #5041 from a place on, comments aside. False: there is none. */
static bool find_next(const struct line *l, size_t at, struct place *found)
{
    bool comment = false;

    for (; at < l->length && l->text[at] != ';'; at++) {
        comment = (comment || l->text[at] == '(') && l->text[at] != ')';
        if (comment || l->text[at] != '#' || !is_digit(l->text[at + 1]))
            continue;
        char *end;

        found->number = line_whole((double)strtoul(&l->text[at + 1], &end, 10));
        found->at = at;
        found->length = (size_t)(end - &l->text[at]);
        return true;
    }
    return false;
}

static bool is_within(uint32_t number, uint32_t first, uint32_t count)
{
    return number >= first && number < first + count;
}

/* Where X is, or what shifts it: lathes have diameters there. */
static bool is_x(uint32_t number)
{
    return number == 5001U || number == 5021U || number == 5041U || number == 5061U ||
           (number >= SYSTEM_FIRST && number <= SYSTEM_LAST &&
            (number - SYSTEM_FIRST) % SYSTEM_SIZE == 0);
}

static void offset_text(uint32_t number, char *text, size_t size)
{
    const uint32_t axis = (number - SYSTEM_FIRST) % SYSTEM_SIZE;

    (void)snprintf(text, size, axis < 3 ? "[#%u" TRANSLATE_IN_UNITS "]" : "#%u", (unsigned)number);
}

static const char *mode_text(uint32_t number)
{
    number -= is_within(number, 4201, 130) ? RUNNING_OFFSET : 0;
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        if (modes[i].number == number)
            return modes[i].text;
    }
    return NULL;
}

/* What the variable is here. False: it has no other name, or none at all. */
static bool read_text(uint32_t number, char *text, size_t size)
{
    const char *mode = mode_text(number);

    if (is_within(number, 5001, POSITIONS))
        (void)snprintf(text, size, "#%u", (unsigned)(5420U + number - 5001U));
    else if (is_within(number, 5041, POSITIONS))
        (void)snprintf(text, size, "#%u", (unsigned)(5420U + number - 5041U));
    else if (is_within(number, 5021, POSITIONS))
        (void)snprintf(text, size, "#<_abs_%c>", axes[number - 5021U]);
    else if (number == 5061U)
        (void)snprintf(text, size, "#%u", (unsigned)number);
    else if (number >= SYSTEM_FIRST && number <= SYSTEM_LAST)
        offset_text(number, text, size);
    else if (mode != NULL)
        (void)snprintf(text, size, "%s", mode);
    else
        return false;
    return true;
}

/* The program's own, those that mean the same in LinuxCNC, and what is only kept (#3003 = 1). */
static bool is_known(uint32_t number, bool is_given)
{
    const bool linuxcnc = is_within(number, 5061, 10) || is_within(number, 5161, 449);
    const bool more = number >= 20000 || is_within(number, 10000, 1000);

    return number <= OWN_LAST || linuxcnc || more || is_within(number, 3000, is_given ? 1000 : 1);
}

static void put_variable(struct translator *t, struct place *p, const char *text)
{
    struct line_word w = {.begin = (uint16_t)p->at, .end = (uint16_t)(p->at + p->length)};
    char twice[80];

    if (t->survey.lathe && is_x(p->number)) {
        (void)snprintf(twice, sizeof twice, "[2*%s]", text);
        text = twice;
    }
    (void)line_replace(&t->line, &w, text);
    p->at += strlen(text) - 1;
}

static void refuse(struct translator *t, const struct place *p)
{
    const struct line_word w = {.begin = (uint16_t)p->at};

    translate_wrong(t, &w,
                    "'#%u' is a variable of the control that is not known here: a number has to "
                    "stand in its place",
                    (unsigned)p->number);
}

/* #5221=#1: a line of its own, in front; a condition before it would not count. */
static bool set_offset(struct translator *t, struct line_word *w, uint32_t number)
{
    const struct line *l = &t->line;
    const uint32_t index = number - SYSTEM_FIRST;
    const uint32_t axis = index % SYSTEM_SIZE;

    if (number < SYSTEM_FIRST || axis >= POSITIONS || t->survey.lathe ||
        l->word[0].kind == WORD_KEYWORD)
        return false;
    translate_add(&t->before, "G10 L2 P%u %c[%.*s]", (unsigned)(1 + index / SYSTEM_SIZE),
                  axes[axis], (int)(w->end - w->value_begin), &l->text[w->value_begin]);
    line_blank(&t->line, w);
    return true;
}

void variables_set(struct translator *t)
{
    for (unsigned i = 0; i < t->line.words; i++) {
        struct line_word *w = &t->line.word[i];
        struct place p;

        if (w->kind == WORD_ASSIGNED && find_next(&t->line, w->begin, &p) && p.at == w->begin &&
            is_within(p.number, OFFSETS_FIRST, OFFSETS) && !set_offset(t, w, p.number))
            translate_wrong(t, w,
                            "'#%u' cannot be given a value here: G10 L2 P1 X10 on a line of its "
                            "own sets G54",
                            (unsigned)p.number);
    }
}

/* Behind the bracket that closes the one at a place; 0: none does. */
static size_t close_of(const struct line *l, size_t at)
{
    unsigned depth = 0;

    for (; at < l->length; at++) {
        depth += l->text[at] == '[' ? 1U : 0U;
        depth -= l->text[at] == ']' ? 1U : 0U;
        if (depth == 0)
            return at + 1;
    }
    return 0;
}

static void put(struct translator *t, struct line_word *w, const char *text)
{
    if (strlen(text) + t->line.length <= CALCULATION_MAX)
        (void)line_replace(&t->line, w, text);
    else
        translate_wrong(t, w,
                        "this line is too long for what stands for a part of it in LinuxCNC: work "
                        "that out on a line of its own");
}

/* Which variable it may be, by the numbers in the brackets. */
static uint32_t look_worked_out(struct translator *t, size_t at)
{
    const struct line *l = &t->line;
    uint32_t offset = 0;

    for (size_t i = at + 2; i < l->length && l->text[i] != ']'; i++) {
        const char before = l->text[i - 1];
        struct place p = {.at = at};

        if (!is_digit(l->text[i]) || is_digit(before) || before == '.' || before == '#')
            continue;
        p.number = line_whole((double)strtoul(&l->text[i], NULL, 10));
        if (!is_known(p.number, false))
            refuse(t, &p);
        offset = is_within(p.number, OFFSETS_FIRST, OFFSETS) ? p.number : offset;
    }
    return offset;
}

/*
 * #[2000+#4]: numbers of variables that are only known when they are worked out. Of an offset
 *
 *     #[e]       [#[e]/[1+24.4*#<_imperial>*[[[e]-5221] MOD 20 LT 3]]]    X, Y and Z have units
 */
static void translate_worked_out(struct translator *t)
{
    struct line *l = &t->line;
    char text[LINE_MAX_BYTES];

    for (size_t at = 0; at + 1 < l->length && strchr("(;", l->text[at]) == NULL; at++) {
        if (l->text[at] != '#' || l->text[at + 1] != '[' || look_worked_out(t, at) == 0)
            continue;
        const size_t end = close_of(l, at + 1);
        const int length = (int)(end - at - 1);
        struct line_word w = {.begin = (uint16_t)at, .end = (uint16_t)end};

        if (end == 0)
            return;
        if (line_is_assigned(l, end) || t->survey.lathe) {
            translate_wrong(
                t, &w,
                "an offset of a number that is worked out cannot be given a value here, nor "
                "read on lathes: G10 L2 P#1 X10 sets one");
            return;
        }
        (void)snprintf(text, sizeof text, "[#%.*s/[1+24.4*#<_imperial>*[[%.*s-%u] MOD %u LT 3]]]",
                       length, &l->text[at + 1], length, &l->text[at + 1], SYSTEM_FIRST,
                       SYSTEM_SIZE);
        put(t, &w, text);
        at += strlen(text) - 1;
    }
}

/*
 * FIX goes towards 0 and FUP away from it; those of LinuxCNC go down and up:
 *
 *     FIX[e]     [FIX[ABS[e]]*[1-2*[[e] LT 0]]]
 */
static void round_by_sign(struct translator *t)
{
    struct line *l = &t->line;
    char text[LINE_MAX_BYTES];

    for (size_t at = 0; at + 4 < l->length && strchr("(;", l->text[at]) == NULL; at++) {
        const char *name = &l->text[at];
        const size_t end =
            line_begins(name, "fix") || line_begins(name, "fup") ? close_of(l, at + 3) : 0;
        const bool is_done =
            end > 0 && line_begins(name + 4, "abs") && close_of(l, at + 7) + 1 == end;
        struct line_word w = {.begin = (uint16_t)at, .end = (uint16_t)end};

        if (end <= at + 4 || is_done)
            continue;
        (void)snprintf(text, sizeof text, "[%.3s[ABS%.*s]*[1-2*[%.*s LT 0]]]", name,
                       (int)(end - at - 3), name + 3, (int)(end - at - 3), name + 3);
        put(t, &w, text);
    }
}

void variables_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct place p = {0};
    char text[64];

    translate_worked_out(t);
    round_by_sign(t);
    for (size_t at = 0; find_next(l, at, &p); at = p.at + 1) {
        const bool is_given = line_is_assigned(l, p.at + p.length);

        if (!is_given && read_text(p.number, text, sizeof text)) {
            put_variable(t, &p, text);
        } else if (!is_known(p.number, is_given)) {
            refuse(t, &p);
        }
    }
}
