/*
 * The keys of machine files: one table that reads them, checks them, prints them and documents
 * them.
 */
#ifndef TAKT_HOST_MACHINE_KEYS_H
#define TAKT_HOST_MACHINE_KEYS_H

#include "config/machine_setup.h"

#include <stdbool.h>
#include <stddef.h>

enum machine_section {
    SECTION_MACHINE,
    SECTION_AXIS,
    SECTION_SPINDLE,
    SECTION_BUS,
    SECTION_PANEL,
    SECTION_CORRECTION,
    SECTION_GEOMETRY,
    SECTION_DRIVE,
    SECTION_STEPPER,
    SECTION_IO,
    SECTION_GANTRY,
    SECTION_COUNT
};

enum machine_key_type {
    KEY_TEXT,
    KEY_PATH, /* a text, in a file from that file's folder */
    KEY_WORD, /* one of struct machine_key.words: its place among them is the value */
    KEY_UINT32,
    KEY_UINT8,
    KEY_INT8,
    KEY_DOUBLE,
    KEY_VECTOR, /* size numbers */
    KEY_AXIS,
    KEY_LINEAR_AXIS,
    KEY_LAYERS,
    KEY_OUTPUTS, /* what the bits of an I/O node are */
    KEY_INPUTS,
    KEY_ANALOGUES,
    KEY_AXIS_TYPE
};

/*
 * How a value in a file becomes one of the setup for a rotary axis, whose keys end in _deg instead
 * of _mm.
 */
enum machine_key_scale {
    SCALE_NONE,
    SCALE_LENGTH,
    SCALE_PER_LENGTH,
    /* for every axis: degrees, millionths, um/min */
    SCALE_DEGREE,
    SCALE_PPM,
    SCALE_UM_MIN
};

struct machine_key {
    enum machine_section section;
    const char *name; /* of a linear axis */
    enum machine_key_type type;
    enum machine_key_scale scale;
    /*
     * SECTION_AXIS: in struct machine_axis; SECTION_DRIVE: in the drive; SECTION_STEPPER: in the
     * stepper; SECTION_IO: in the I/O node; else in the setup
     */
    size_t offset;
    size_t size;     /* of a text, with its zero */
    double min, max; /* in the unit of the file */
    bool above_min;  /* min itself is not allowed */
    const char *meaning;
    const char *const *words; /* of KEY_WORD, by their enumeration; ends with NULL */
};

/* Numbers of a vector. */
#define MACHINE_VECTOR_MAX   8
#define MACHINE_KEY_NAME_MAX 47
#define MACHINE_KEYS_MAX     256

extern const struct machine_key machine_keys[];
extern const size_t machine_keys_count;
extern const char *const machine_section_names[SECTION_COUNT];

/*
 * A section in use. index: the axis, also of a drive or stepper; of an I/O node its number from 0;
 * 0 for sections there is one of.
 */
struct machine_place {
    enum machine_section section;
    unsigned index;
};

#define MACHINE_PROBLEM_MAX 255

/* What is wrong with a word or a value, without saying where. */
struct machine_problem {
    char text[MACHINE_PROBLEM_MAX + 1];
};

__attribute__((format(printf, 2, 3))) void machine_problem_say(struct machine_problem *wrong,
                                                               const char *format, ...);

/* Angles instead of lengths are what its keys count. */
bool machine_place_is_rotary(const struct machine_setup *setup, struct machine_place place);

/*
 * Finds a section: word "axis", instance "X"; word "drive", instance "1" (a node some axis has);
 * else the word alone, instance "". An axis comes into being by being named. False: *wrong says
 * why.
 */
bool machine_section_find(struct machine_setup *setup, const char *word, const char *instance,
                          struct machine_place *place, struct machine_problem *wrong);

/* The key of that name in a place; NULL: *wrong says why, with the nearest name. */
const struct machine_key *machine_key_find(const struct machine_setup *setup,
                                           struct machine_place place, const char *name,
                                           struct machine_problem *wrong);

/* Reads value into the setup. False: *wrong says why, and nothing has changed. */
bool machine_key_set(struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, const char *value,
                     struct machine_problem *wrong);

/* The same of a machine file: paths in it count from its folder. */
bool machine_key_set_in(struct machine_setup *setup, struct machine_place place,
                        const struct machine_key *key, const char *value, const char *machine_file,
                        struct machine_problem *wrong);

/* Name of a key in a place: _mm becomes _deg for rotary axes. */
void machine_key_name(const struct machine_setup *setup, struct machine_place place,
                      const struct machine_key *key, char name[MACHINE_KEY_NAME_MAX + 1]);

/* The value as a file would say it: reading it gives the same bits. */
void machine_key_get(const struct machine_setup *setup, struct machine_place place,
                     const struct machine_key *key, char *text, size_t size);

#endif
