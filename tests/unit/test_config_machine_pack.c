/*
 * What a machine file says of the machine is all stored on a target, and nothing a file may say is
 * refused there.
 */
#include "config/machine_keys.h"
#include "storage/settings_fields.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

static struct machine_setup setup;

void setUp(void)
{
    machine_setup_set_default(&setup);
}

void tearDown(void)
{
}

/* In the setup. Keys of an I/O node, or of a gantry: of the first. */
static size_t offset_of(const struct machine_key *key)
{
    if (key->section == SECTION_GANTRY)
        return key->offset + offsetof(struct machine_setup, machine.gantry);
    return key->offset +
           (key->section == SECTION_IO ? offsetof(struct machine_setup, machine.io) : 0);
}

/* Keys of the machine itself; others are of virtual drives and of this computer. */
static bool is_of_machine(const struct machine_key *key)
{
    if (key->section == SECTION_AXIS)
        return key->type != KEY_AXIS_TYPE;
    return key->section != SECTION_DRIVE && key->section != SECTION_STEPPER &&
           offset_of(key) - offsetof(struct machine_setup, machine) < sizeof(struct machine);
}

static const struct settings_field *field_of(const struct machine_key *key)
{
    const bool of_axis = key->section == SECTION_AXIS;
    const size_t at =
        of_axis ? key->offset : offset_of(key) - offsetof(struct machine_setup, machine);

    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        const struct settings_field *field = &takt_settings_fields[i];
        const size_t size = field->type == SETTINGS_DOUBLE  ? 8 * (size_t)field->count
                            : field->type == SETTINGS_BYTES ? field->count
                                                            : 1;

        if (field->of_axis == of_axis && at >= field->offset && at < field->offset + size)
            return field;
    }
    return NULL;
}

static void test_every_key_of_the_machine_is_stored(void)
{
    unsigned count = 0;

    for (size_t i = 0; i < machine_keys_count; i++) {
        if (!is_of_machine(&machine_keys[i]))
            continue;
        TEST_ASSERT_NOT_NULL_MESSAGE(field_of(&machine_keys[i]), machine_keys[i].name);
        count++;
    }
    TEST_ASSERT_GREATER_THAN(60, count);
}

/* X or C: a rotary axis is told in degrees. */
static void check_value(const struct machine_key *key, unsigned axis, double number)
{
    const struct machine_place place = {key->section, key->section == SECTION_AXIS ? axis : 0};
    const struct settings_field *field = field_of(key);
    const void *base = key->section == SECTION_AXIS ? (const void *)&setup.machine.axis[axis]
                                                    : (const void *)&setup.machine;
    struct machine_problem wrong;
    char text[64];
    double value;

    (void)snprintf(text, sizeof text, "%.17g", number);
    TEST_ASSERT_TRUE_MESSAGE(machine_key_set(&setup, place, key, text, &wrong), wrong.text);
    TEST_ASSERT_TRUE_MESSAGE(takt_settings_field_check(field, base, &value), key->name);
}

static void check_range(const struct machine_key *key, unsigned axis)
{
    if (!key->above_min)
        check_value(key, axis, key->min);
    check_value(key, axis, key->max);
}

static void test_every_value_a_file_may_have_may_be_stored(void)
{
    for (size_t i = 0; i < machine_keys_count; i++) {
        const struct machine_key *key = &machine_keys[i];
        const bool is_number = key->type == KEY_DOUBLE || key->type == KEY_UINT32 ||
                               key->type == KEY_UINT8 || key->type == KEY_INT8;

        if (!is_number || !is_of_machine(key))
            continue;
        setUp();
        check_range(key, AXIS_X);
        check_range(key, AXIS_C);
    }
}

/* Words are numbers in the struct: "jerk", "smooth" and "gentle" are 0, 1 and 2. */
static void test_every_word_a_file_may_have_may_be_stored(void)
{
    static const struct {
        const char *key, *word;
    } words[] = {{"law", "gentle"},          {"landing", "scale"},
                 {"limiter", "smooth"},      {"override_method", "proportional"},
                 {"interpolator", "rotate"}, {"step_form", "plain"}};

    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        const struct machine_place place = {SECTION_MACHINE, 0};
        struct machine_problem wrong;
        const struct machine_key *key = machine_key_find(&setup, place, words[i].key, &wrong);
        double value;

        TEST_ASSERT_NOT_NULL(key);
        TEST_ASSERT_TRUE(machine_key_set(&setup, place, key, words[i].word, &wrong));
        TEST_ASSERT_TRUE_MESSAGE(takt_settings_field_check(field_of(key), &setup.machine, &value),
                                 words[i].key);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_key_of_the_machine_is_stored);
    RUN_TEST(test_every_value_a_file_may_have_may_be_stored);
    RUN_TEST(test_every_word_a_file_may_have_may_be_stored);
    return UNITY_END();
}
