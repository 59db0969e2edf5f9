#include "config/machine_lines.h"

#include "cli/message.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#define WORD_MAX 63

struct machine_line *machine_lines_find(struct machine_lines *lines, struct machine_place place,
                                        const struct machine_key *key)
{
    return &lines->at[key - machine_keys][place.index];
}

/* "axis X: ...", "drive 1:2: ...": false: it is about a section there is one of. */
static bool find_place(struct machine_setup *setup, const char *wrong, struct machine_place *place)
{
    char section[WORD_MAX + 1], instance[WORD_MAX + 1];
    const char *end = strstr(wrong, ": ");
    const char *space = strchr(wrong, ' ');
    struct machine_problem problem;

    if (end == NULL || space == NULL || space > end || space - wrong > WORD_MAX ||
        end - space > WORD_MAX)
        return false;
    (void)snprintf(section, sizeof section, "%.*s", (int)(space - wrong), wrong);
    (void)snprintf(instance, sizeof instance, "%.*s", (int)(end - space - 1), space + 1);
    return machine_section_find(setup, section, instance, place, &problem);
}

static bool is_of_many(enum machine_section section)
{
    return section == SECTION_AXIS || section == SECTION_DRIVE || section == SECTION_STEPPER ||
           section == SECTION_IO || section == SECTION_GANTRY;
}

/* The unit may be left out, since rotary axes have another: max_jerk for max_jerk_mm_s3. */
static bool is_named(const struct machine_key *key, const char *word, size_t length)
{
    const bool begins = strncmp(key->name, word, length) == 0;

    return begins && (key->name[length] == '\0' ||
                      (key->name[length] == '_' && memchr(word, '_', length) != NULL));
}

/* NULL: there is none. place: where it is to be, or false of has_place and it is found out. */
static const struct machine_key *find_key(const char *word, size_t length, bool has_place,
                                          struct machine_place *place)
{
    for (size_t i = 0; i < machine_keys_count; i++) {
        const struct machine_key *key = &machine_keys[i];

        if (has_place ? key->section != place->section : is_of_many(key->section))
            continue;
        if (!is_named(key, word, length))
            continue;
        place->section = key->section;
        return key;
    }
    return NULL;
}

/* What stands behind a ';' is advice, and names what else would do. */
static const struct machine_key *find_first_key(struct machine_setup *setup, const char *wrong,
                                                struct machine_place *place)
{
    const bool has_place = find_place(setup, wrong, place);
    const char *end = wrong + strcspn(wrong, ";");
    const struct machine_key *key = NULL;

    if (!has_place)
        place->index = 0;
    while (wrong < end && key == NULL) {
        size_t length = 0;

        while (isalnum((unsigned char)wrong[length]) || wrong[length] == '_')
            length++;
        if (length > 0)
            key = find_key(wrong, length, has_place, place);
        wrong += length > 0 ? length : 1;
    }
    return key;
}

static void report(const char *file, uint32_t line, uint32_t column, const char *text)
{
    if (file != NULL)
        message_error(file, line, column, "%s", text);
    else
        message_command_error("%s", text);
}

void machine_lines_report(struct machine_lines *lines, struct machine_setup *setup,
                          const char *file, const char *wrong)
{
    char name[MACHINE_KEY_NAME_MAX + 1], value[MACHINE_SETUP_PATH_MAX + 1];
    char text[MACHINE_SETUP_PATH_MAX + 1024];
    struct machine_place place = {SECTION_MACHINE, 0};
    const struct machine_key *key = find_first_key(setup, wrong, &place);
    const struct machine_line *line;

    if (key == NULL) {
        report(file, 0, 0, wrong);
        return;
    }
    line = machine_lines_find(lines, place, key);
    machine_key_name(setup, place, key, name);
    machine_key_get(setup, place, key, value, sizeof value);
    (void)snprintf(text, sizeof text, "%s (%s = %s)", wrong, name, value);
    if (line->file != NULL)
        report(line->file, line->line, line->column, text);
    else
        report(file, 0, 0, text);
}
