/* Reading and writing of what machine_keys.c lists. */
#include "config/machine_keys.h"

#include "base/maths.h"
#include "cli/message.h"
#include "cli/suggest.h"
#include "config/machine_io.h"
#include "correction/correction.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (MATHS_PI / 180.0)

__attribute__((format(printf, 2, 3))) static void say(struct machine_problem *wrong,
                                                      const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(wrong->text, sizeof wrong->text, format, arguments);
    va_end(arguments);
}

static bool find_letter(const char *instance, unsigned *index, struct machine_problem *wrong)
{
    const char *letter =
        strlen(instance) == 1 ? strchr(AXIS_LETTERS, toupper((unsigned char)instance[0])) : NULL;

    if (letter == NULL) {
        say(wrong, "there is no axis '%.40s': takt has X Y Z A B C", instance);
        return false;
    }
    *index = (unsigned)(letter - AXIS_LETTERS);
    return true;
}

static bool find_axis(struct machine_setup *setup, const char *instance, unsigned *index,
                      struct machine_problem *wrong)
{
    if (!find_letter(instance, index, wrong))
        return false;
    setup->machine.axis[*index].present = true;
    return true;
}

/* "2": node 2; on another bus than the first "1:2". */
static bool find_drive(const struct machine_setup *setup, const char *instance, unsigned *index,
                       struct machine_problem *wrong)
{
    char *end;
    unsigned long node = strtoul(instance, &end, 10);
    unsigned long bus = 0;

    if (end != instance && *end == ':') {
        bus = node;
        node = strtoul(end + 1, &end, 10);
    }
    for (unsigned i = 0; i < AXIS_COUNT && end != instance && *end == '\0'; i++) {
        if (setup->machine.axis[i].present && setup->machine.axis[i].drive_node == node &&
            setup->machine.axis[i].drive_bus == bus) {
            *index = i;
            return true;
        }
    }
    for (unsigned i = 0; i < takt_machine_gantry_count(&setup->machine) && *end == '\0'; i++) {
        if (end != instance && setup->machine.gantry[i].drive_node == node &&
            setup->machine.gantry[i].drive_bus == bus) {
            *index = MACHINE_SECOND_DRIVE + i;
            return true;
        }
    }
    say(wrong, "no axis has drive_node '%.40s'; a drive's section comes after its axis", instance);
    return false;
}

/* For an axis that is there: naming it here does not bring it into being. */
static bool find_stepper(const struct machine_setup *setup, const char *instance, unsigned *index,
                         struct machine_problem *wrong)
{
    if (!find_letter(instance, index, wrong))
        return false;
    if (setup->machine.axis[*index].present)
        return true;
    say(wrong, "the machine has no axis %c; a stepper's section comes after its axis",
        AXIS_LETTERS[*index]);
    return false;
}

static bool find_io(const char *instance, unsigned *index, struct machine_problem *wrong)
{
    *index = strlen(instance) == 1 ? (unsigned)(instance[0] - '1') : IO_NODES_MAX;
    if (*index < IO_NODES_MAX)
        return true;
    say(wrong, "there is no I/O node '%.40s': they are io 1 to io %d", instance, IO_NODES_MAX);
    return false;
}

/* [gantry] is the first. */
static bool find_gantry(const char *instance, unsigned *index, struct machine_problem *wrong)
{
    const unsigned length = (unsigned)strlen(instance);

    *index = length == 0 ? 0 : length == 1 ? (unsigned)(instance[0] - '1') : MACHINE_GANTRIES_MAX;
    if (*index < MACHINE_GANTRIES_MAX)
        return true;
    say(wrong, "there is no gantry '%.40s': they are gantry 1 to gantry %d", instance,
        MACHINE_GANTRIES_MAX);
    return false;
}

static bool find_word(const char *word, enum machine_section *section,
                      struct machine_problem *wrong)
{
    for (unsigned i = 0; i < SECTION_COUNT; i++) {
        if (strcmp(word, machine_section_names[i]) == 0) {
            *section = (enum machine_section)i;
            return true;
        }
    }
    say(wrong, "unknown section '%.40s'%s", word,
        message_did_you_mean("", suggest_word(word, machine_section_names, SECTION_COUNT)));
    return false;
}

bool machine_section_find(struct machine_setup *setup, const char *word, const char *instance,
                          struct machine_place *place, struct machine_problem *wrong)
{
    *place = (struct machine_place){0};
    if (!find_word(word, &place->section, wrong))
        return false;
    if (place->section == SECTION_AXIS)
        return find_axis(setup, instance, &place->index, wrong);
    if (place->section == SECTION_STEPPER)
        return find_stepper(setup, instance, &place->index, wrong);
    if (place->section == SECTION_DRIVE)
        return find_drive(setup, instance, &place->index, wrong);
    if (place->section == SECTION_IO)
        return find_io(instance, &place->index, wrong);
    if (place->section == SECTION_GANTRY)
        return find_gantry(instance, &place->index, wrong);
    if (instance[0] == '\0')
        return true;
    say(wrong, "there is only one section '%s': '%.40s' is too much", word, instance);
    return false;
}

static bool is_rotary(const struct machine_setup *setup, struct machine_place place)
{
    return (place.section == SECTION_AXIS || place.section == SECTION_DRIVE) &&
           place.index < AXIS_COUNT && setup->machine.axis[place.index].rotary;
}

void machine_key_name(const struct machine_setup *setup, struct machine_place place,
                      const struct machine_key *key, char name[MACHINE_KEY_NAME_MAX + 1])
{
    const char *unit = strstr(key->name, "_mm");

    if (key->scale == SCALE_NONE || unit == NULL || !is_rotary(setup, place))
        (void)snprintf(name, MACHINE_KEY_NAME_MAX + 1, "%s", key->name);
    else
        (void)snprintf(name, MACHINE_KEY_NAME_MAX + 1, "%.*s_deg%s", (int)(unit - key->name),
                       key->name, unit + 3);
}

const struct machine_key *machine_key_find(const struct machine_setup *setup,
                                           struct machine_place place, const char *name,
                                           struct machine_problem *wrong)
{
    char names[MACHINE_KEYS_MAX][MACHINE_KEY_NAME_MAX + 1];
    const char *words[MACHINE_KEYS_MAX];
    unsigned count = 0;

    for (size_t i = 0; i < machine_keys_count; i++) {
        if (machine_keys[i].section != place.section)
            continue;
        machine_key_name(setup, place, &machine_keys[i], names[count]);
        if (strcmp(name, names[count]) == 0)
            return &machine_keys[i];
        words[count] = names[count];
        count++;
    }
    say(wrong, "unknown key '%.60s' in section '%s'%s", name, machine_section_names[place.section],
        message_did_you_mean("", suggest_word(name, words, count)));
    return NULL;
}

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
        return is_rotary(setup, place) ? DEGREE : 1.0;
    case SCALE_PER_LENGTH:
        return is_rotary(setup, place) ? 1.0 / DEGREE : 1.0;
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

static bool read_number(const struct machine_key *key, const char *value, double *number,
                        struct machine_problem *wrong)
{
    char *end;

    *number = strtod(value, &end);
    if (end == value || *end != '\0' || !isfinite(*number)) {
        say(wrong, "%s: a number is expected, not '%.60s'", key->name, value);
        return false;
    }
    if (*number < key->min || *number > key->max || (key->above_min && *number <= key->min)) {
        say(wrong, "%s: %s is out of range: it must be %s %.10g and at most %.10g", key->name,
            value, key->above_min ? "above" : "at least", key->min, key->max);
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
    say(wrong, "%s: a whole number is expected, not %s", key->name, value);
    return false;
}

static bool read_axis_type(const struct machine_setup *setup, struct machine_place place,
                           const char *value, struct machine_problem *wrong)
{
    const char *expected = is_rotary(setup, place) ? "rotary" : "linear";

    if (strcmp(value, expected) == 0)
        return true;
    say(wrong, "type: axis %c is %s, not '%.40s'", AXIS_LETTERS[place.index], expected, value);
    return false;
}

/* The words of a key that has some, in the order of the enumeration they stand for. */
static const char *const *words_of(const struct machine_key *key)
{
    static const char *const drive_types[] = {"can", "step", NULL};
    static const char *const step_forms[] = {"even", "improved", "plain", NULL};
    static const char *const shapers[] = {"none", "neutral", "zv", "mzv", "ei", NULL};
    static const char *const interpolators[] = {"exact", "integrate", "rotate", NULL};
    static const char *const profiles[] = {"jerk", "smooth", "gentle", NULL};
    static const char *const landings[] = {"span", "block", "scale", NULL};
    static const char *const limiters[] = {"ceiling", "threshold", "smooth", NULL};
    static const char *const methods[] = {"adaptive", "proportional", NULL};

    if (key->type == KEY_DRIVE_TYPE)
        return drive_types;
    if (key->type == KEY_SHAPER)
        return shapers;
    if (key->type == KEY_RAMP_PROFILE)
        return profiles;
    if (key->type == KEY_LANDING)
        return landings;
    if (key->type == KEY_LIMITER)
        return limiters;
    if (key->type == KEY_OVERRIDE_METHOD)
        return methods;
    return key->type == KEY_STEP_FORM ? step_forms : interpolators;
}

/* "law: jerk, smooth or gentle is expected, not 'fast'" */
static void say_words(const struct machine_key *key, const char *const *words, const char *value,
                      struct machine_problem *wrong)
{
    char list[MACHINE_PROBLEM_MAX + 1] = "";
    size_t used = 0;

    for (unsigned i = 0; words[i] != NULL && used < sizeof list; i++) {
        const char *before = i == 0 ? "" : words[i + 1] == NULL ? " or " : ", ";

        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", before, words[i]);
    }
    say(wrong, "%s: %.120s is expected, not '%.40s'", key->name, list, value);
}

static bool read_word(const struct machine_key *key, const char *value, uint32_t *field,
                      struct machine_problem *wrong)
{
    const char *const *words = words_of(key);
    unsigned count = 0;

    for (; words[count] != NULL; count++) {
        if (strcmp(value, words[count]) == 0) {
            *field = count;
            return true;
        }
    }
    say_words(key, words, value, wrong);
    return false;
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

static bool read_vector(const struct machine_key *key, const char *value, double scale,
                        double *field, struct machine_problem *wrong)
{
    double numbers[MACHINE_VECTOR_MAX];
    const char *rest = value;
    size_t count = 0;

    while (count < key->size && next_number(&rest, &numbers[count])) {
        if (numbers[count] < key->min || numbers[count] > key->max) {
            say(wrong, "%s: %.10g is out of range: it must be at least %.10g and at most %.10g",
                key->name, numbers[count], key->min, key->max);
            return false;
        }
        count++;
    }
    rest += strspn(rest, " \t");
    if (count < key->size || *rest != '\0') {
        say(wrong, "%s: %zu numbers are expected, not '%.60s'", key->name, key->size, value);
        return false;
    }
    for (size_t i = 0; i < count; i++)
        field[i] = numbers[i] * scale;
    return true;
}

/* A rotary axis, or a linear one, or none. */
static bool read_axis(const struct machine_key *key, const char *value, uint32_t *field,
                      struct machine_problem *wrong)
{
    const char *letter =
        strlen(value) == 1 ? strchr(AXIS_LETTERS, toupper((unsigned char)value[0])) : NULL;

    if (strcmp(value, "none") == 0) {
        *field = AXIS_COUNT;
        return true;
    }
    const bool is_linear = key->type == KEY_LINEAR_AXIS;

    if (letter == NULL || *letter == '\0' ||
        (letter - AXIS_LETTERS < AXIS_LINEAR_COUNT) != is_linear) {
        say(wrong, "%s: %s or none is expected, not '%.40s'", key->name,
            is_linear ? "X, Y, Z" : "A, B, C", value);
        return false;
    }
    *field = (uint32_t)(letter - AXIS_LETTERS);
    return true;
}

/* Names of layers of correction. */
static bool read_layers(const struct machine_key *key, const char *value, uint32_t *field,
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
            say(wrong, "%s: there is no layer '%.*s': matrix setup axes volume thermal wear",
                key->name, (int)(length < 40 ? length : 40), value);
            return false;
        }
        layers |= 1U << i;
        value += length;
    }
    *field = layers;
    return true;
}

static bool read_text(const struct machine_key *key, const char *value, char *field,
                      struct machine_problem *wrong)
{
    if (strlen(value) >= key->size) {
        say(wrong, "%s: longer than %zu characters", key->name, key->size - 1);
        return false;
    }
    (void)snprintf(field, key->size, "%s", value);
    return true;
}

bool machine_key_set(struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, const char *value,
                     struct machine_problem *wrong)
{
    void *field = (char *)setup + ((const char *)field_of(setup, place, key) - (const char *)setup);
    double number = 0;

    switch (key->type) {
    case KEY_AXIS_TYPE:
        return read_axis_type(setup, place, value, wrong);
    case KEY_DRIVE_TYPE:
    case KEY_STEP_FORM:
    case KEY_SHAPER:
    case KEY_RAMP_PROFILE:
    case KEY_LANDING:
    case KEY_LIMITER:
    case KEY_OVERRIDE_METHOD:
    case KEY_INTERPOLATOR:
        return read_word(key, value, field, wrong);
    case KEY_TEXT:
        return read_text(key, value, field, wrong);
    case KEY_DOUBLE:
        if (!read_number(key, value, &number, wrong))
            return false;
        *(double *)field = number * scale_of(setup, place, key);
        return true;
    case KEY_VECTOR:
        return read_vector(key, value, scale_of(setup, place, key), field, wrong);
    case KEY_AXIS:
    case KEY_LINEAR_AXIS:
        return read_axis(key, value, field, wrong);
    case KEY_LAYERS:
        return read_layers(key, value, field, wrong);
    case KEY_OUTPUTS:
    case KEY_INPUTS:
        return machine_io_read(field, value, key->type == KEY_OUTPUTS, key->name, wrong);
    case KEY_ANALOGUES:
        return machine_io_read_analogues(field, value, key->name, wrong);
    case KEY_UINT32:
        if (!read_count(key, value, &number, wrong))
            return false;
        *(uint32_t *)field = (uint32_t)number;
        return true;
    case KEY_UINT8:
        if (!read_count(key, value, &number, wrong))
            return false;
        *(uint8_t *)field = (uint8_t)number;
        return true;
    case KEY_INT8:
        if (!read_count(key, value, &number, wrong))
            return false;
        *(int8_t *)field = (int8_t)number;
        return true;
    }
    return false;
}

/*
 * The shortest decimal number that, read and scaled, gives the same bits; the nearest if rounding lets none. No
 * exponent for numbers people read without one.
 */
static void write_number(double value, double scale, char *text, size_t size)
{
    bool plain = fabs(value / scale) >= 1e-4 && fabs(value / scale) < 1e15;

    for (int digits = 1; digits <= 17; digits++) {
        (void)snprintf(text, size, "%.*g", digits, value / scale);
        if (strtod(text, NULL) * scale == value && !(plain && strchr(text, 'e') != NULL))
            return;
    }
}

static void write_vector(const double *numbers, size_t count, double scale, char *text, size_t size)
{
    size_t used = 0;

    text[0] = '\0';
    for (size_t i = 0; i < count && used + 2 < size; i++) {
        if (i > 0)
            text[used++] = ' ';
        write_number(numbers[i], scale, text + used, size - used);
        used = strlen(text);
    }
}

static void write_layers(uint32_t layers, char *text, size_t size)
{
    size_t used = 0;

    text[0] = '\0';
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT && used < size; i++) {
        if ((layers & 1U << i) != 0)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? " " : "",
                                     takt_correction_layer_name((enum correction_layer_number)i));
    }
}

static void write_axis_letter(uint32_t axis, char *text, size_t size)
{
    if (axis < AXIS_COUNT)
        (void)snprintf(text, size, "%c", AXIS_LETTERS[axis]);
    else
        (void)snprintf(text, size, "none");
}

void machine_key_get(const struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, char *text, size_t size)
{
    const void *field = field_of(setup, place, key);

    switch (key->type) {
    case KEY_AXIS_TYPE:
        (void)snprintf(text, size, "%s", is_rotary(setup, place) ? "rotary" : "linear");
        break;
    case KEY_DRIVE_TYPE:
    case KEY_STEP_FORM:
    case KEY_SHAPER:
    case KEY_RAMP_PROFILE:
    case KEY_LANDING:
    case KEY_LIMITER:
    case KEY_OVERRIDE_METHOD:
    case KEY_INTERPOLATOR:
        (void)snprintf(text, size, "%s", words_of(key)[*(const uint32_t *)field]);
        break;
    case KEY_TEXT:
        (void)snprintf(text, size, "%s", (const char *)field);
        break;
    case KEY_DOUBLE:
        write_number(*(const double *)field, scale_of(setup, place, key), text, size);
        break;
    case KEY_VECTOR:
        write_vector(field, key->size, scale_of(setup, place, key), text, size);
        break;
    case KEY_AXIS:
    case KEY_LINEAR_AXIS:
        write_axis_letter(*(const uint32_t *)field, text, size);
        break;
    case KEY_LAYERS:
        write_layers(*(const uint32_t *)field, text, size);
        break;
    case KEY_OUTPUTS:
    case KEY_INPUTS:
        machine_io_write(field, text, size);
        break;
    case KEY_ANALOGUES:
        machine_io_write_analogues(field, text, size);
        break;
    case KEY_UINT32:
        (void)snprintf(text, size, "%u", (unsigned)*(const uint32_t *)field);
        break;
    case KEY_INT8:
        (void)snprintf(text, size, "%d", *(const int8_t *)field);
        break;
    case KEY_UINT8:
        (void)snprintf(text, size, "%u", (unsigned)*(const uint8_t *)field);
        break;
    }
}
