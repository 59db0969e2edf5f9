/* Values of machine files: each type of machine_keys.h is read and written in one way. */
#include "base/maths.h"
#include "config/machine_io.h"
#include "config/machine_keys.h"
#include "correction/correction.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (MATHS_PI / 180.0)

/* Whose value it is. */
struct value_place {
    const struct machine_key *key;
    double scale; /* value in the setup per value in the file */
    bool is_rotary;
    unsigned axis; /* of an axis' section */
};

struct value_type {
    /* False: *wrong says why, and nothing has changed. */
    bool (*read)(const struct value_place *at, void *field, const char *value,
                 struct machine_problem *wrong);
    void (*write)(const struct value_place *at, const void *field, char *text, size_t size);
};

/* ---- where a value is ---- */

/* Value in the setup per value in the file. */
static double scale_of(const struct machine_setup *setup, struct machine_place place,
                       const struct machine_key *key)
{
    switch (key->scale) {
    case SCALE_DEGREE:
        return DEGREE;
    case SCALE_PPM:
        return 1e-6;
    case SCALE_UM_MIN:
        return 1e-3 / 60.0;
    case SCALE_LENGTH:
        return machine_place_is_rotary(setup, place) ? DEGREE : 1.0;
    case SCALE_PER_LENGTH:
        return machine_place_is_rotary(setup, place) ? 1.0 / DEGREE : 1.0;
    case SCALE_NONE:
        break;
    }
    return 1.0;
}

static const void *field_of(const struct machine_setup *setup, struct machine_place place,
                            const struct machine_key *key)
{
    const void *base = setup;

    if (place.section == SECTION_AXIS)
        base = &setup->machine.axis[place.index];
    else if (place.section == SECTION_DRIVE)
        base = &setup->drive[place.index];
    else if (place.section == SECTION_STEPPER)
        base = &setup->stepper[place.index];
    else if (place.section == SECTION_GANTRY)
        base = &setup->machine.gantry[place.index];
    else if (place.section == SECTION_IO)
        base = &setup->machine.io[place.index];
    return (const char *)base + key->offset;
}

static struct value_place place_of(const struct machine_setup *setup, struct machine_place place,
                                   const struct machine_key *key)
{
    return (struct value_place){.key = key,
                                .scale = scale_of(setup, place, key),
                                .is_rotary = machine_place_is_rotary(setup, place),
                                .axis = place.index};
}

/* ---- numbers ---- */

static bool read_number(const struct machine_key *key, const char *value, double *number,
                        struct machine_problem *wrong)
{
    char *end;

    *number = strtod(value, &end);
    if (end == value || *end != '\0' || !isfinite(*number)) {
        machine_problem_say(wrong, "%s: a number is expected, not '%.60s'", key->name, value);
        return false;
    }
    if (*number < key->min || *number > key->max || (key->above_min && *number <= key->min)) {
        machine_problem_say(wrong, "%s: %s is out of range: it must be %s %.10g and at most %.10g",
                            key->name, value, key->above_min ? "above" : "at least", key->min,
                            key->max);
        return false;
    }
    return true;
}

static bool read_count(const struct machine_key *key, const char *value, double *number,
                       struct machine_problem *wrong)
{
    if (!read_number(key, value, number, wrong))
        return false;
    if (*number == floor(*number))
        return true;
    machine_problem_say(wrong, "%s: a whole number is expected, not %s", key->name, value);
    return false;
}

static bool read_double(const struct value_place *at, void *field, const char *value,
                        struct machine_problem *wrong)
{
    double number;

    if (!read_number(at->key, value, &number, wrong))
        return false;
    *(double *)field = number * at->scale;
    return true;
}

static bool read_uint32(const struct value_place *at, void *field, const char *value,
                        struct machine_problem *wrong)
{
    double number;

    if (!read_count(at->key, value, &number, wrong))
        return false;
    *(uint32_t *)field = (uint32_t)number;
    return true;
}

static bool read_uint8(const struct value_place *at, void *field, const char *value,
                       struct machine_problem *wrong)
{
    double number;

    if (!read_count(at->key, value, &number, wrong))
        return false;
    *(uint8_t *)field = (uint8_t)number;
    return true;
}

static bool read_int8(const struct value_place *at, void *field, const char *value,
                      struct machine_problem *wrong)
{
    double number;

    if (!read_count(at->key, value, &number, wrong))
        return false;
    *(int8_t *)field = (int8_t)number;
    return true;
}

/* Next number of a list: separated by spaces or commas. False: there is none. */
static bool next_number(const char **value, double *number)
{
    char *end;

    *value += strspn(*value, " \t,");
    *number = strtod(*value, &end);
    if (end == *value || (*end != '\0' && strchr(" \t,", *end) == NULL) || !isfinite(*number))
        return false;
    *value = end;
    return true;
}

static bool read_vector(const struct value_place *at, void *field, const char *value,
                        struct machine_problem *wrong)
{
    const struct machine_key *key = at->key;
    double numbers[MACHINE_VECTOR_MAX];
    const char *rest = value;
    size_t count = 0;

    while (count < key->size && next_number(&rest, &numbers[count])) {
        if (numbers[count] < key->min || numbers[count] > key->max) {
            machine_problem_say(
                wrong, "%s: %.10g is out of range: it must be at least %.10g and at most %.10g",
                key->name, numbers[count], key->min, key->max);
            return false;
        }
        count++;
    }
    rest += strspn(rest, " \t");
    if (count < key->size || *rest != '\0') {
        machine_problem_say(wrong, "%s: %zu numbers are expected, not '%.60s'", key->name,
                            key->size, value);
        return false;
    }
    for (size_t i = 0; i < count; i++)
        ((double *)field)[i] = numbers[i] * at->scale;
    return true;
}

/*
 * The shortest decimal number that, read and scaled, gives the same bits; the nearest if rounding
 * lets none. No exponent for numbers people read without one.
 */
static void write_scaled(double value, double scale, char *text, size_t size)
{
    bool plain = fabs(value / scale) >= 1e-4 && fabs(value / scale) < 1e15;

    for (int digits = 1; digits <= 17; digits++) {
        (void)snprintf(text, size, "%.*g", digits, value / scale);
        if (strtod(text, NULL) * scale == value && !(plain && strchr(text, 'e') != NULL))
            return;
    }
}

static void write_double(const struct value_place *at, const void *field, char *text, size_t size)
{
    write_scaled(*(const double *)field, at->scale, text, size);
}

static void write_uint32(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)at;
    (void)snprintf(text, size, "%u", (unsigned)*(const uint32_t *)field);
}

static void write_uint8(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)at;
    (void)snprintf(text, size, "%u", *(const uint8_t *)field);
}

static void write_int8(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)at;
    (void)snprintf(text, size, "%d", *(const int8_t *)field);
}

static void write_vector(const struct value_place *at, const void *field, char *text, size_t size)
{
    const double *numbers = field;
    size_t used = 0;

    text[0] = '\0';
    for (size_t i = 0; i < at->key->size && used + 2 < size; i++) {
        if (i > 0)
            text[used++] = ' ';
        write_scaled(numbers[i], at->scale, text + used, size - used);
        used = strlen(text);
    }
}

/* ---- words ---- */

/* Up to what no line of a machine file can hold: control characters, and a comment. */
static size_t text_length(const char *value)
{
    size_t i = 0;

    while (((unsigned char)value[i] >= ' ' || value[i] == '\t') &&
           !(value[i] == ';' && (i == 0 || isblank((unsigned char)value[i - 1]))))
        i++;
    return i;
}

static bool read_text(const struct value_place *at, void *field, const char *value,
                      struct machine_problem *wrong)
{
    const char *begin = value + strspn(value, " \t");
    const size_t size = at->key->size;
    size_t length = text_length(begin);

    if (begin[length] != '\0') {
        machine_problem_say(wrong, "%s: neither ' ;' nor control characters can stand in it",
                            at->key->name);
        return false;
    }
    while (length > 0 && isblank((unsigned char)begin[length - 1]))
        length--;
    if (length >= size) {
        machine_problem_say(wrong, "%s: longer than %zu characters", at->key->name, size - 1);
        return false;
    }
    (void)snprintf(field, size, "%.*s", (int)length, begin);
    return true;
}

static void write_text(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)at;
    (void)snprintf(text, size, "%s", (const char *)field);
}

/* "law: jerk, smooth or gentle is expected, not 'fast'" */
static void say_words(const struct machine_key *key, const char *value,
                      struct machine_problem *wrong)
{
    const char *const *words = key->words;
    char list[MACHINE_PROBLEM_MAX + 1] = "";
    size_t used = 0;

    for (unsigned i = 0; words[i] != NULL && used < sizeof list; i++) {
        const char *before = i == 0 ? "" : words[i + 1] == NULL ? " or " : ", ";

        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", before, words[i]);
    }
    machine_problem_say(wrong, "%s: %.120s is expected, not '%.40s'", key->name, list, value);
}

static bool read_word(const struct value_place *at, void *field, const char *value,
                      struct machine_problem *wrong)
{
    for (uint32_t i = 0; at->key->words[i] != NULL; i++) {
        if (strcmp(value, at->key->words[i]) == 0) {
            *(uint32_t *)field = i;
            return true;
        }
    }
    say_words(at->key, value, wrong);
    return false;
}

static void write_word(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)snprintf(text, size, "%s", at->key->words[*(const uint32_t *)field]);
}

/* It is told by the letter of the axis: there is nothing to keep. */
static bool read_axis_type(const struct value_place *at, void *field, const char *value,
                           struct machine_problem *wrong)
{
    const char *expected = at->is_rotary ? "rotary" : "linear";

    (void)field;
    if (strcmp(value, expected) == 0)
        return true;
    machine_problem_say(wrong, "type: axis %c is %s, not '%.40s'", AXIS_LETTERS[at->axis], expected,
                        value);
    return false;
}

static void write_axis_type(const struct value_place *at, const void *field, char *text,
                            size_t size)
{
    (void)field;
    (void)snprintf(text, size, "%s", at->is_rotary ? "rotary" : "linear");
}

/* A rotary axis, or a linear one, or none. */
static bool read_axis(const struct value_place *at, void *field, const char *value,
                      struct machine_problem *wrong)
{
    const bool is_linear = at->key->type == KEY_LINEAR_AXIS;
    uint32_t *axis = field;
    const char *letter =
        strlen(value) == 1 ? strchr(AXIS_LETTERS, toupper((unsigned char)value[0])) : NULL;

    if (strcmp(value, "none") == 0) {
        *axis = AXIS_COUNT;
        return true;
    }
    if (letter == NULL || *letter == '\0' ||
        (letter - AXIS_LETTERS < AXIS_LINEAR_COUNT) != is_linear) {
        machine_problem_say(wrong, "%s: %s or none is expected, not '%.40s'", at->key->name,
                            is_linear ? "X, Y, Z" : "A, B, C", value);
        return false;
    }
    *axis = (uint32_t)(letter - AXIS_LETTERS);
    return true;
}

static void write_axis(const struct value_place *at, const void *field, char *text, size_t size)
{
    const uint32_t axis = *(const uint32_t *)field;

    (void)at;
    if (axis < AXIS_COUNT)
        (void)snprintf(text, size, "%c", AXIS_LETTERS[axis]);
    else
        (void)snprintf(text, size, "none");
}

/* Names of layers of correction. */
static bool read_layers(const struct value_place *at, void *field, const char *value,
                        struct machine_problem *wrong)
{
    uint32_t layers = 0;

    while (*(value += strspn(value, " \t,")) != '\0') {
        size_t length = strcspn(value, " \t,");
        unsigned i = 0;

        while (i < CORRECTION_LAYERS_COUNT &&
               (strlen(takt_correction_layer_name((enum correction_layer_number)i)) != length ||
                strncmp(takt_correction_layer_name((enum correction_layer_number)i), value,
                        length) != 0))
            i++;
        if (i == CORRECTION_LAYERS_COUNT) {
            machine_problem_say(wrong, "%s: there is no layer '%.*s':" CORRECTION_LAYER_WORDS,
                                at->key->name, (int)(length < 40 ? length : 40), value);
            return false;
        }
        layers |= 1U << i;
        value += length;
    }
    *(uint32_t *)field = layers;
    return true;
}

static void write_layers(const struct value_place *at, const void *field, char *text, size_t size)
{
    const uint32_t layers = *(const uint32_t *)field;
    size_t used = 0;

    (void)at;
    text[0] = '\0';
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT && used < size; i++) {
        if ((layers & 1U << i) != 0)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? " " : "",
                                     takt_correction_layer_name((enum correction_layer_number)i));
    }
}

static bool read_io(const struct value_place *at, void *field, const char *value,
                    struct machine_problem *wrong)
{
    return machine_io_read(field, value, at->key->type == KEY_OUTPUTS, at->key->name, wrong);
}

static void write_io(const struct value_place *at, const void *field, char *text, size_t size)
{
    (void)at;
    machine_io_write(field, text, size);
}

static bool read_analogues(const struct value_place *at, void *field, const char *value,
                           struct machine_problem *wrong)
{
    return machine_io_read_analogues(field, value, at->key->name, wrong);
}

static void write_analogues(const struct value_place *at, const void *field, char *text,
                            size_t size)
{
    (void)at;
    machine_io_write_analogues(field, text, size);
}

/* ---- all of them ---- */

static const struct value_type types[] = {
    [KEY_TEXT] = {read_text, write_text},
    [KEY_PATH] = {read_text, write_text},
    [KEY_WORD] = {read_word, write_word},
    [KEY_UINT32] = {read_uint32, write_uint32},
    [KEY_UINT8] = {read_uint8, write_uint8},
    [KEY_INT8] = {read_int8, write_int8},
    [KEY_DOUBLE] = {read_double, write_double},
    [KEY_VECTOR] = {read_vector, write_vector},
    [KEY_AXIS] = {read_axis, write_axis},
    [KEY_LINEAR_AXIS] = {read_axis, write_axis},
    [KEY_LAYERS] = {read_layers, write_layers},
    [KEY_OUTPUTS] = {read_io, write_io},
    [KEY_INPUTS] = {read_io, write_io},
    [KEY_ANALOGUES] = {read_analogues, write_analogues},
    [KEY_AXIS_TYPE] = {read_axis_type, write_axis_type},
};

bool machine_key_set(struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, const char *value,
                     struct machine_problem *wrong)
{
    void *field = (char *)setup + ((const char *)field_of(setup, place, key) - (const char *)setup);
    const struct value_place at = place_of(setup, place, key);

    return types[key->type].read(&at, field, value, wrong);
}

bool machine_key_set_in(struct machine_setup *setup, struct machine_place place,
                        const struct machine_key *key, const char *value, const char *machine_file,
                        struct machine_problem *wrong)
{
    const char *slash = strrchr(machine_file, '/');
    const size_t folder = slash != NULL ? (size_t)(slash - machine_file) + 1 : 0;
    char path[2 * (MACHINE_SETUP_PATH_MAX + 1)];

    if (key->type != KEY_PATH || value[0] == '\0' || value[0] == '/')
        return machine_key_set(setup, place, key, value, wrong);
    if (folder + strlen(value) > MACHINE_SETUP_PATH_MAX) {
        machine_problem_say(wrong, "%s: with the folder of this file, longer than %d characters",
                            key->name, MACHINE_SETUP_PATH_MAX);
        return false;
    }
    (void)snprintf(path, sizeof path, "%.*s%s", (int)folder, machine_file, value);
    return machine_key_set(setup, place, key, path, wrong);
}

void machine_key_get(const struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, char *text, size_t size)
{
    const struct value_place at = place_of(setup, place, key);

    types[key->type].write(&at, field_of(setup, place, key), text, size);
}
