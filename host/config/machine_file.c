#include "config/machine_file.h"

#include "cli/message.h"
#include "cli/text.h"
#include "config/machine_keys.h"
#include "config/machine_lines.h"

#include <ini.h>
#include <stdint.h>
#include <string.h>

#define MACHINE_FILE_WORD_MAX 63

/* The section whose keys are codes of programs. */
#define MACHINE_FILE_CODES "codes"
/* The section whose keys are parameters that programs ask for. */
#define MACHINE_FILE_VALUES "values"

/* Where reading is. inih calls back for lines it has asked for, one line at a time. */
struct machine_reader {
    struct machine_setup *setup;
    const struct text *text;
    size_t position;
    uint32_t line;
    const char *current; /* the line, in text */
    size_t length;
    unsigned errors;
    bool axes_named;
    bool in_codes;    /* the section this line stands in is [codes], */
    bool in_values;   /* or [values] */
    bool place_known; /* it is another one that is known */
    struct machine_place place;
    struct machine_lines *lines;
};

/* Column of the first character from offset on that is no space. */
static uint32_t column_of(const struct machine_reader *r, size_t offset)
{
    while (offset < r->length && (r->current[offset] == ' ' || r->current[offset] == '\t'))
        offset++;
    return (uint32_t)offset + 1;
}

static void reader_error(struct machine_reader *r, size_t offset, const char *text)
{
    message_error(r->text->name, r->line, column_of(r, offset), "%s", text);
    r->errors++;
}

/* "axis X" is word "axis" and instance "X". */
static void split_section(const char *section, char word[], char instance[])
{
    size_t first = strspn(section, " \t");
    size_t length = strcspn(section + first, " \t");
    const char *rest = section + first + length;

    rest += strspn(rest, " \t");
    (void)snprintf(word, MACHINE_FILE_WORD_MAX + 1, "%.*s", (int)length, section + first);
    (void)snprintf(instance, MACHINE_FILE_WORD_MAX + 1, "%.*s", (int)strcspn(rest, " \t"), rest);
}

static void forget_default_axes(struct machine_reader *r)
{
    for (unsigned i = 0; i < AXIS_COUNT && !r->axes_named; i++)
        r->setup->machine.axis[i].present = false;
    r->axes_named = true;
}

/*
 * inih tells of a section with its first key only; an axis without keys has the default ones all
 * the same. False: the line is no section, as has been reported.
 */
static bool reader_enter_section(struct machine_reader *r, size_t offset)
{
    char section[MACHINE_FILE_WORD_MAX + 1], word[MACHINE_FILE_WORD_MAX + 1],
        instance[MACHINE_FILE_WORD_MAX + 1];
    const char *start = r->current + offset + 1;
    const char *end = memchr(start, ']', r->length - offset - 1);
    struct machine_problem wrong;

    r->place_known = false;
    if (end == NULL) {
        reader_error(r, offset, "a ']' is missing");
        return false;
    }
    (void)snprintf(section, sizeof section, "%.*s", (int)(end - start), start);
    split_section(section, word, instance);
    if (strcmp(word, machine_section_names[SECTION_AXIS]) == 0)
        forget_default_axes(r);
    r->in_codes = strcmp(word, MACHINE_FILE_CODES) == 0 && instance[0] == '\0';
    r->in_values = strcmp(word, MACHINE_FILE_VALUES) == 0 && instance[0] == '\0';
    r->place_known = !r->in_codes && !r->in_values &&
                     machine_section_find(r->setup, word, instance, &r->place, &wrong);
    if (!r->place_known && !r->in_codes && !r->in_values)
        reader_error(r, offset + 1, wrong.text);
    return true;
}

static bool is_plain(const char *line, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)line[i] < ' ' && line[i] != '\t')
            return false;
    }
    return true;
}

/*
 * fgets for inih: the next line, without leading spaces, because inih takes an indented line as the
 * continuation of the value before.
 */
static char *reader_next_line(char *buffer, int size, void *context)
{
    struct machine_reader *r = context;
    size_t offset = 0;

    if (!text_next_line(r->text, &r->position, &r->current, &r->length))
        return NULL;
    r->line++;
    buffer[0] = '\0';
    if (!is_plain(r->current, r->length)) {
        reader_error(r, 0, "this is no text: it holds control characters");
        return buffer;
    }
    offset = column_of(r, 0) - 1;
    if (r->length - offset >= (size_t)size) {
        reader_error(r, 0, "the line is too long");
        return buffer;
    }
    if (offset < r->length && r->current[offset] == '[' && !reader_enter_section(r, offset))
        return buffer;
    memcpy(buffer, r->current + offset, r->length - offset);
    buffer[r->length - offset] = '\0';
    return buffer;
}

static bool reader_is_new(struct machine_reader *r, const struct machine_key *key, size_t value)
{
    struct machine_line *line = machine_lines_find(r->lines, r->place, key);
    char text[MACHINE_FILE_WORD_MAX + 64];

    if (line->file == r->text->name) {
        (void)snprintf(text, sizeof text, "%s is given twice; first in line %u", key->name,
                       (unsigned)line->line);
        reader_error(r, 0, text);
        return false;
    }
    *line = (struct machine_line){r->text->name, r->line, column_of(r, value)};
    return true;
}

/* NULL: it is taken; else what is wrong. A code that is there already changes. */
static const char *set_code(struct machine_setup *setup, const char *name, const char *value)
{
    struct dialect_codes *codes = &setup->codes;
    struct dialect_code code;
    const char *wrong = dialect_code_read(&code, name, value);

    for (unsigned i = 0; i < codes->count && wrong == NULL; i++) {
        if (codes->code[i].letter == code.letter && codes->code[i].number_x10 == code.number_x10) {
            codes->code[i] = code;
            return NULL;
        }
    }
    if (wrong == NULL && codes->count == DIALECT_CODES_MAX)
        wrong = "there is no room for more codes";
    if (wrong == NULL)
        codes->code[codes->count++] = code;
    return wrong;
}

/* What came of a key that is in no table. */
static void take_free(struct machine_reader *r, const char *wrong)
{
    if (wrong != NULL)
        reader_error(r, 0, wrong);
}

static int reader_take(void *context, const char *section, const char *name, const char *value)
{
    struct machine_reader *r = context;
    const struct machine_key *key;
    struct machine_problem wrong;
    size_t value_offset = 0;

    if (section[0] == '\0') {
        reader_error(r, 0, "a key stands before the first [section]");
        return 1;
    }
    if (r->in_codes)
        take_free(r, set_code(r->setup, name, value));
    if (r->in_values)
        take_free(r, dialect_value_set(&r->setup->codes, name, value));
    if (!r->place_known)
        return 1; /* no key of the table, or reported with the section */
    key = machine_key_find(r->setup, r->place, name, &wrong);
    if (key == NULL) {
        reader_error(r, 0, wrong.text);
        return 1;
    }
    while (value_offset < r->length && r->current[value_offset] != '=' &&
           r->current[value_offset] != ':')
        value_offset++;
    if (reader_is_new(r, key, value_offset + 1) &&
        !machine_key_set_in(r->setup, r->place, key, value, r->text->name, &wrong))
        reader_error(r, value_offset + 1, wrong.text);
    return 1;
}

/* over: sections that change a machine that has its axes already. */
static bool read_file(struct machine_setup *setup, const char *path, bool over,
                      struct machine_lines *lines)
{
    struct text text;
    struct machine_reader reader = {
        .setup = setup, .text = &text, .axes_named = over, .lines = lines};
    int bad_line;

    if (!text_read(&text, path))
        return false;
    bad_line = ini_parse_stream(reader_next_line, &reader, reader_take, &reader);
    if (bad_line > 0) {
        message_error(text.name, (uint32_t)bad_line, 1, "neither a [section] nor key = value");
        reader.errors++;
    }
    text_free(&text);
    return reader.errors == 0;
}

bool machine_file_read(struct machine_setup *setup, const char *path)
{
    struct machine_lines lines = {0};

    return read_file(setup, path, false, &lines);
}

/* The parts of "axis.X.key" or "bus.key". False: there are not two or three. */
static bool split_assignment(const char *assignment, char word[], char instance[], char key[],
                             const char **value)
{
    size_t name = strcspn(assignment, "=");
    size_t first = strcspn(assignment, ".=");
    size_t last = name;

    while (last > first && assignment[last] != '.')
        last--;
    if (assignment[name] != '=' || first == name)
        return false;
    (void)snprintf(word, MACHINE_FILE_WORD_MAX + 1, "%.*s", (int)first, assignment);
    (void)snprintf(instance, MACHINE_FILE_WORD_MAX + 1, "%.*s",
                   last > first ? (int)(last - first - 1) : 0, assignment + first + 1);
    (void)snprintf(key, MACHINE_FILE_WORD_MAX + 1, "%.*s", (int)(name - last - 1),
                   assignment + last + 1);
    *value = assignment + name + 1;
    return true;
}

/* "codes.M31=ignore", "values._hal[a.b]=1": names of their own, which may have points. */
static bool assign_free(struct machine_setup *setup, const char *assignment, bool code)
{
    const char *begin = strchr(assignment, '.') + 1;
    const size_t length = strcspn(begin, "=");
    char name[MACHINE_FILE_WORD_MAX + 1];
    const char *wrong = "NAME=VALUE is expected, such as codes.M31=ignore";

    (void)snprintf(name, sizeof name, "%.*s", (int)length, begin);
    if (begin[length] == '=' && code)
        wrong = set_code(setup, name, begin + length + 1);
    else if (begin[length] == '=')
        wrong = dialect_value_set(&setup->codes, name, begin + length + 1);
    if (wrong != NULL)
        message_command_error("--set %s: %s", assignment, wrong);
    return wrong == NULL;
}

bool machine_file_assign(struct machine_setup *setup, const char *assignment)
{
    char word[MACHINE_FILE_WORD_MAX + 1], instance[MACHINE_FILE_WORD_MAX + 1],
        name[MACHINE_FILE_WORD_MAX + 1];
    struct machine_problem wrong;
    struct machine_place place;
    const struct machine_key *key;
    const char *value;

    const bool code = strncmp(assignment, MACHINE_FILE_CODES ".", sizeof MACHINE_FILE_CODES) == 0;

    if (code || strncmp(assignment, MACHINE_FILE_VALUES ".", sizeof MACHINE_FILE_VALUES) == 0)
        return assign_free(setup, assignment, code);
    if (!split_assignment(assignment, word, instance, name, &value)) {
        message_command_error(
            "--set %s: expected SECTION.KEY=VALUE, such as axis.X.max_jerk_mm_s3=20000",
            assignment);
        return false;
    }
    if (machine_section_find(setup, word, instance, &place, &wrong)) {
        key = machine_key_find(setup, place, name, &wrong);
        if (key != NULL && machine_key_set(setup, place, key, value, &wrong))
            return true;
    }
    message_command_error("--set %s: %s", assignment, wrong.text);
    return false;
}

/* An option that is short for --set of one key. False after a message in terms of the option. */
static bool set_by_option(struct machine_setup *setup, struct machine_place place, const char *key,
                          const char *option, const char *value, const char *given)
{
    struct machine_problem wrong;
    const struct machine_key *found = machine_key_find(setup, place, key, &wrong);

    if (found != NULL && machine_key_set(setup, place, found, value, &wrong))
        return true;
    message_command_error("--%s %s: %s", option, given, wrong.text);
    return false;
}

/* "step" is for all axes, "X=step" for one. */
static bool set_drive_type(struct machine_setup *setup, const char *given)
{
    const char *equals = strchr(given, '=');
    const char *value = equals != NULL ? equals + 1 : given;
    const char *letter = equals == given + 1 ? strchr(AXIS_LETTERS, given[0]) : NULL;

    if (equals != NULL && (letter == NULL || !setup->machine.axis[letter - AXIS_LETTERS].present)) {
        message_command_error("--drive-type %s: the machine has no axis '%.*s'", given,
                              (int)(equals - given), given);
        return false;
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_place place = {SECTION_AXIS, i};

        if (letter != NULL && letter != &AXIS_LETTERS[i])
            continue;
        if (!set_by_option(setup, place, "drive_type", "drive-type", value, given))
            return false;
    }
    return true;
}

static bool set_driven(struct machine_setup *setup, const struct options *options)
{
    const struct machine_place machine = {SECTION_MACHINE, 0};

    for (unsigned i = 0; i < options->drive_type.count; i++) {
        if (!set_drive_type(setup, options->drive_type.item[i]))
            return false;
    }
    if (options->override_method != NULL &&
        !set_by_option(setup, machine, "override_method", "override-method",
                       options->override_method, options->override_method))
        return false;
    return options->interpolator == NULL ||
           set_by_option(setup, machine, "interpolator", "interpolator", options->interpolator,
                         options->interpolator);
}

bool machine_file_load(struct machine_setup *setup, const struct options *options)
{
    struct machine_lines lines = {0};
    const char *wrong;

    machine_setup_set_default(setup);
    if (options->machine != NULL && !read_file(setup, options->machine, false, &lines))
        return false;
    for (unsigned i = 0; i < options->with.count; i++) {
        if (!read_file(setup, options->with.item[i], true, &lines))
            return false;
    }
    for (unsigned i = 0; i < options->set.count; i++) {
        if (!machine_file_assign(setup, options->set.item[i]))
            return false;
    }
    if (!set_driven(setup, options))
        return false;
    wrong = machine_setup_check(setup);
    if (wrong != NULL)
        machine_lines_report(&lines, setup, options->machine, wrong);
    return wrong == NULL;
}

static void write_section(FILE *file, const struct machine_setup *setup, struct machine_place place)
{
    for (size_t i = 0; i < machine_keys_count; i++) {
        const struct machine_key *key = &machine_keys[i];
        char name[MACHINE_KEY_NAME_MAX + 1], value[MACHINE_SETUP_PATH_MAX + 1];

        if (key->section != place.section)
            continue;
        machine_key_name(setup, place, key, name);
        machine_key_get(setup, place, key, value, sizeof value);
        (void)fprintf(file, "# %s\n%s = %s\n", key->meaning, name, value);
    }
}

static void write_drive_head(FILE *file, unsigned bus, unsigned node)
{
    if (bus > 0)
        (void)fprintf(file, "\n[drive %u:%u]\n", bus, node);
    else
        (void)fprintf(file, "\n[drive %u]\n", node);
}

static void write_places_of_axes(FILE *file, const struct machine_setup *setup,
                                 enum machine_section section)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!setup->machine.axis[i].present)
            continue;
        if (section == SECTION_AXIS)
            (void)fprintf(file, "\n[axis %c]\n", AXIS_LETTERS[i]);
        else if (section == SECTION_STEPPER)
            (void)fprintf(file, "\n[stepper %c]\n", AXIS_LETTERS[i]);
        else
            write_drive_head(file, setup->machine.axis[i].drive_bus,
                             setup->machine.axis[i].drive_node);
        write_section(file, setup, (struct machine_place){section, i});
    }
}

static void write_codes(FILE *file, const struct dialect_codes *codes)
{
    char text[DIALECT_CODE_TEXT_MAX];

    if (codes->count > 0)
        (void)fprintf(file, "\n[%s]\n", MACHINE_FILE_CODES);
    for (unsigned i = 0; i < codes->count; i++) {
        dialect_code_write(&codes->code[i], text);
        (void)fprintf(file, "%s\n", text);
    }
    if (codes->values > 0)
        (void)fprintf(file, "\n[%s]\n", MACHINE_FILE_VALUES);
    for (unsigned i = 0; i < codes->values; i++)
        (void)fprintf(file, "%s = %.9g\n", codes->value[i].name, codes->value[i].value);
}

static void write_io_nodes(FILE *file, const struct machine_setup *setup)
{
    for (unsigned i = 0; i < takt_machine_io_count(&setup->machine); i++) {
        (void)fprintf(file, "\n[io %u]\n", i + 1);
        write_section(file, setup, (struct machine_place){SECTION_IO, i});
    }
}

static void write_gantry(FILE *file, const struct machine_setup *setup, unsigned i)
{
    (void)fprintf(file, i == 0 ? "\n[%s]\n" : "\n[%s %u]\n", machine_section_names[SECTION_GANTRY],
                  i + 1);
    write_section(file, setup, (struct machine_place){SECTION_GANTRY, i});
    write_drive_head(file, setup->machine.gantry[i].drive_bus, setup->machine.gantry[i].drive_node);
    write_section(file, setup, (struct machine_place){SECTION_DRIVE, MACHINE_SECOND_DRIVE + i});
}

void machine_file_write(FILE *file, const struct machine_setup *setup)
{
    static const enum machine_section single[] = {SECTION_MACHINE,    SECTION_SPINDLE,
                                                  SECTION_BUS,        SECTION_PANEL,
                                                  SECTION_CORRECTION, SECTION_GEOMETRY};

    (void)fputs("# A machine, every key spelled out. Keys that are left out have the values of the "
                "built-in mill.\n",
                file);
    for (size_t i = 0; i < sizeof single / sizeof single[0]; i++) {
        (void)fprintf(file, "\n[%s]\n", machine_section_names[single[i]]);
        write_section(file, setup, (struct machine_place){single[i], 0});
    }
    write_places_of_axes(file, setup, SECTION_AXIS);
    write_places_of_axes(file, setup, SECTION_DRIVE);
    write_places_of_axes(file, setup, SECTION_STEPPER);
    for (unsigned i = 0; i < takt_machine_gantry_count(&setup->machine); i++)
        write_gantry(file, setup, i);
    write_io_nodes(file, setup);
    write_codes(file, &setup->codes);
}
