#include "translation/codes.h"

#include "words/line.h"

#include <math.h>
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

/* ---- values ---- */

/* The name of #NAME, or of #<_NAME>. */
static bool is_plain(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz";

    name += name[0] == '_' ? 1 : 0;
    if (name[0] == '\0' || strchr(letters, line_lower(name[0])) == NULL)
        return false;
    for (; *name != '\0'; name++) {
        if (strchr(letters, line_lower(*name)) == NULL && strchr("_0123456789", *name) == NULL)
            return false;
    }
    return true;
}

const char *dialect_value_set(struct dialect_codes *codes, const char *name, const char *value)
{
    char *end;
    const double number = strtod(value, &end);
    unsigned i = 0;

    if ((strncmp(name, "_ini[", 5) != 0 && strncmp(name, "_hal[", 5) != 0 && !is_plain(name)) ||
        strlen(name) >= sizeof codes->value[0].name)
        return "the name of a value is expected, such as _ini[TRAJ]MAX_LINEAR_VELOCITY, _hal[PIN] "
               "that of #NAME or _NAME";
    if (end == value || *end != '\0' || !isfinite(number))
        return "a number is expected";
    while (i < codes->values && strcmp(codes->value[i].name, name) != 0)
        i++;
    if (i == DIALECT_CODES_MAX)
        return "there is no room for more values";
    codes->values = i == codes->values ? i + 1 : codes->values;
    codes->value[i].value = number;
    (void)snprintf(codes->value[i].name, sizeof codes->value[i].name, "%s", name);
    return NULL;
}

bool codes_is_letter(const struct line_word *w)
{
    return w->kind == WORD_VALUE && strchr("uvw", w->letter) != NULL;
}

const struct dialect_code *codes_find(const struct dialect_codes *codes, const struct line_word *w)
{
    const int number = codes_is_letter(w) ? 0 : line_code(w);

    for (unsigned i = 0; i < codes->count && number >= 0; i++) {
        if (codes->code[i].letter == w->letter && codes->code[i].number_x10 == number)
            return &codes->code[i];
    }
    return NULL;
}
