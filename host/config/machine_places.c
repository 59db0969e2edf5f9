/* Which section and which key the words of a machine file name. */
#include "config/machine_keys.h"

#include "cli/message.h"
#include "cli/suggest.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void machine_problem_say(struct machine_problem *wrong, const char *format, ...)
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
        machine_problem_say(wrong, "there is no axis '%.40s': takt has X Y Z A B C", instance);
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
    machine_problem_say(
        wrong, "no axis has drive_node '%.40s'; a drive's section comes after its axis", instance);
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
    machine_problem_say(wrong,
                        "the machine has no axis %c; a stepper's section comes after its axis",
                        AXIS_LETTERS[*index]);
    return false;
}

static bool find_io(const char *instance, unsigned *index, struct machine_problem *wrong)
{
    *index = strlen(instance) == 1 ? (unsigned)(instance[0] - '1') : IO_NODES_MAX;
    if (*index < IO_NODES_MAX)
        return true;
    machine_problem_say(wrong, "there is no I/O node '%.40s': they are io 1 to io %d", instance,
                        IO_NODES_MAX);
    return false;
}

/* [gantry] is the first. */
static bool find_gantry(const char *instance, unsigned *index, struct machine_problem *wrong)
{
    const unsigned length = (unsigned)strlen(instance);

    *index = length == 0 ? 0 : length == 1 ? (unsigned)(instance[0] - '1') : MACHINE_GANTRIES_MAX;
    if (*index < MACHINE_GANTRIES_MAX)
        return true;
    machine_problem_say(wrong, "there is no gantry '%.40s': they are gantry 1 to gantry %d",
                        instance, MACHINE_GANTRIES_MAX);
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
    machine_problem_say(
        wrong, "unknown section '%.40s'%s", word,
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
    machine_problem_say(wrong, "there is only one section '%s': '%.40s' is too much", word,
                        instance);
    return false;
}

bool machine_place_is_rotary(const struct machine_setup *setup, struct machine_place place)
{
    return (place.section == SECTION_AXIS || place.section == SECTION_DRIVE) &&
           place.index < AXIS_COUNT && setup->machine.axis[place.index].rotary;
}

void machine_key_name(const struct machine_setup *setup, struct machine_place place,
                      const struct machine_key *key, char name[MACHINE_KEY_NAME_MAX + 1])
{
    const char *unit = strstr(key->name, "_mm");

    if (key->scale == SCALE_NONE || unit == NULL || !machine_place_is_rotary(setup, place))
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
    machine_problem_say(wrong, "unknown key '%.60s' in section '%s'%s", name,
                        machine_section_names[place.section],
                        message_did_you_mean("", suggest_word(name, words, count)));
    return NULL;
}
