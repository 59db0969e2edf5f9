/* What the machine file declares codes as: read, printed, and what becomes of a line by it. */
#include "dialect/translate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first word of each, as it is written; those up to DIALECT_STOP are all of it. */
static const char *const words[] = {[DIALECT_IGNORE] = "ignore",
                                    [DIALECT_STOP] = "stop",
                                    [DIALECT_OUTPUT_ON] = "output",
                                    [DIALECT_FEED] = "",
                                    [DIALECT_OUTPUT_OFF] = "output",
                                    [DIALECT_SUBROUTINE] = "subroutine",
                                    [DIALECT_AXIS] = "",
                                    [DIALECT_HEIGHT] = "height",
                                    [DIALECT_DISTANCE] = "distance"};

/* "M31", "G187", "M31.1" */
static bool read_name(struct dialect_code *code, const char *name)
{
    char *end;

    code->letter = line_lower(name[0]);
    if (code->letter == '\0')
        return false;
    const double number = strtod(name + 1, &end);

    if ((code->letter != 'g' && code->letter != 'm') || end == name + 1 || *end != '\0' ||
        !(number >= 0.0 && number < 6500.0))
        return false;
    code->number_x10 = (uint16_t)(number * 10.0 + 0.5);
    return true;
}

static bool is_subroutine(const char *name)
{
    const size_t length = strlen(name);

    return length > 0 && length <= DIALECT_SUBROUTINE_MAX && strpbrk(name, " \t<>[]()#;") == NULL;
}

static const char *read_feed(struct dialect_code *code, const char *value)
{
    char behind;

    code->letter = 'f';
    code->use = DIALECT_FEED;
    return sscanf(value, "%u%c", &code->number, &behind) == 1 && code->number > 0
               ? NULL
               : "a feed in whole mm/min is expected";
}

/* A letter that no axis of its own answers. */
static const char *read_letter(struct dialect_code *code, const char *name, const char *value)
{
    code->letter = line_lower(name[0]);
    if (strcmp(value, "ignore") == 0)
        return NULL;
    code->use = DIALECT_AXIS;
    code->axis = value[0];
    return strchr("ABCXYZ", value[0]) != NULL && value[0] != '\0' && value[1] == '\0'
               ? NULL
               : "the letter of an axis of the machine is expected, or ignore";
}

static const char *read_height(struct dialect_code *code, const char *value)
{
    code->letter = 'r';
    code->use = strcmp(value, "distance") == 0 ? DIALECT_DISTANCE : DIALECT_HEIGHT;
    return code->use == DIALECT_DISTANCE || strcmp(value, "height") == 0
               ? NULL
               : "height or distance is expected";
}

const char *dialect_code_read(struct dialect_code *code, const char *name, const char *value)
{
    char state[4];
    char behind;

    *code = (struct dialect_code){0};
    if (line_lower(name[0]) == 'f' && name[1] == '\0')
        return read_feed(code, value);
    if (line_lower(name[0]) == 'r' && name[1] == '\0')
        return read_height(code, value);
    if (strchr("uvw", line_lower(name[0])) != NULL && name[1] == '\0')
        return read_letter(code, name, value);
    if (!read_name(code, name))
        return "a code is expected, such as M31 or G187, or F, R, U, V or W";
    for (unsigned use = 0; use <= DIALECT_STOP; use++) {
        code->use = (enum dialect_use)use;
        if (strcmp(value, words[use]) == 0)
            return NULL;
    }
    if (strncmp(value, "subroutine ", 11) == 0) {
        code->use = DIALECT_SUBROUTINE;
        (void)snprintf(code->subroutine, sizeof code->subroutine, "%s", value + 11);
        return is_subroutine(value + 11) ? NULL : "the name of a subroutine is expected";
    }
    if (sscanf(value, "output %u %3s%c", &code->number, state, &behind) == 2 &&
        (strcmp(state, "on") == 0 || strcmp(state, "off") == 0)) {
        code->use = strcmp(state, "on") == 0 ? DIALECT_OUTPUT_ON : DIALECT_OUTPUT_OFF;
        return NULL;
    }
    return "known are ignore, stop, output NUMBER on, output NUMBER off and subroutine NAME";
}

void dialect_code_write(const struct dialect_code *code, char text[DIALECT_CODE_TEXT_MAX])
{
    char number[16] = "";
    char behind[DIALECT_SUBROUTINE_MAX + 2] = "";

    if (code->number_x10 % 10U != 0)
        (void)snprintf(number, sizeof number, "%u.%u", code->number_x10 / 10U,
                       code->number_x10 % 10U);
    else if (code->letter == 'g' || code->letter == 'm')
        (void)snprintf(number, sizeof number, "%u", code->number_x10 / 10U);
    if (code->use == DIALECT_FEED)
        (void)snprintf(behind, sizeof behind, "%u", code->number);
    if (code->use == DIALECT_AXIS)
        (void)snprintf(behind, sizeof behind, "%c", code->axis);
    if (code->use == DIALECT_OUTPUT_ON || code->use == DIALECT_OUTPUT_OFF)
        (void)snprintf(behind, sizeof behind, " %u %s", code->number,
                       code->use == DIALECT_OUTPUT_ON ? "on" : "off");
    if (code->use == DIALECT_SUBROUTINE)
        (void)snprintf(behind, sizeof behind, " %s", code->subroutine);
    (void)snprintf(text, DIALECT_CODE_TEXT_MAX, "%c%s = %s%s", code->letter - 'a' + 'A', number,
                   words[code->use], behind);
}

bool declared_is_letter(const struct line_word *w)
{
    return w->kind == WORD_VALUE && strchr("uvw", w->letter) != NULL;
}

/*
 * A letter whose axis bears another one. U V W are lengths: in inches where X is, while A B C count the same in all units.
 */
static void use_axis(struct translator *t, struct line_word *w, const struct dialect_code *code)
{
    struct line *l = &t->line;
    const bool converts = strchr("ABC", code->axis) != NULL;
    const char *inch = line_find_code(l, 'g', 200) != NULL   ? "1"
                       : line_find_code(l, 'g', 210) != NULL ? "0"
                                                             : "#<_imperial>";
    char text[LINE_MAX_BYTES];

    if (converts)
        (void)snprintf(text, sizeof text, "%c[[%.*s]*[1+24.4*%s]]", code->axis,
                       (int)(w->end - w->value_begin), &l->text[w->value_begin], inch);
    else
        (void)snprintf(text, sizeof text, "%c%.*s", code->axis, (int)(w->end - w->value_begin),
                       &l->text[w->value_begin]);
    (void)line_replace(l, w, text);
}

/* The value of a word behind the code, which the code has for itself. */
static void take_argument(struct line *l, unsigned from, char letter, char *text, size_t size)
{
    (void)snprintf(text, size, "0");
    for (unsigned i = from; i < l->words && strchr(TRANSLATE_OWN_WORDS, l->word[i].letter) != NULL;
         i++) {
        const struct line_word *w = &l->word[i];

        if (w->kind == WORD_VALUE && w->letter == letter)
            (void)snprintf(text, size, "%.*s", (int)(w->end - w->value_begin),
                           &l->text[w->value_begin]);
    }
}

static void call_subroutine(struct translator *t, struct line_word *w,
                            const struct dialect_code *code)
{
    const unsigned from = (unsigned)(w - t->line.word) + 1;
    char p[64];
    char q[64];
    char r[64];

    take_argument(&t->line, from, 'p', p, sizeof p);
    take_argument(&t->line, from, 'q', q, sizeof q);
    take_argument(&t->line, from, 'r', r, sizeof r);
    translate_add(&t->behind, "o<%s> call [%s] [%s] [%s]", code->subroutine, p, q, r);
}

void declared_use(struct translator *t, struct line_word *w, const struct dialect_code *code)
{
    switch (code->use) {
    case DIALECT_IGNORE:
        break;
    case DIALECT_STOP:
        translate_add(&t->behind, "M0");
        break;
    case DIALECT_OUTPUT_ON:
    case DIALECT_OUTPUT_OFF:
        translate_add(&t->behind, "M%u P%u", code->use == DIALECT_OUTPUT_ON ? 64U : 65U,
                      code->number);
        break;
    case DIALECT_FEED:
    case DIALECT_HEIGHT:
    case DIALECT_DISTANCE:
        return;
    case DIALECT_SUBROUTINE:
        call_subroutine(t, w, code);
        break;
    case DIALECT_AXIS:
        use_axis(t, w, code);
        return;
    }
    if (declared_is_letter(w))
        line_blank(&t->line, w);
    else
        codes_drop(t, w);
}
