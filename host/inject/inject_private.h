/*
 * Shared by the sources of this room.
 */
#ifndef TAKT_INJECT_INJECT_PRIVATE_H
#define TAKT_INJECT_INJECT_PRIVATE_H

#include "inject/inject.h"

/* What may stand behind a fault, KEY=VALUE. */
enum inject_key {
    INJECT_KEY_NODE,
    INJECT_KEY_ID,
    INJECT_KEY_SKIP,
    INJECT_KEY_FRAMES,
    INJECT_KEY_RATIO,
    INJECT_KEY_SEED,
    INJECT_KEY_BY,
    INJECT_KEY_BY_MM,
    INJECT_KEY_FOR,
    INJECT_KEY_OBJECT,
    INJECT_KEY_VALUE,
    INJECT_KEY_CODE,
    INJECT_KEY_REGISTER,
    INJECT_KEY_WHAT,
    INJECT_KEYS
};

#define INJECT_BIT(key) (1u << (key))

struct inject_key_row {
    const char *name;
    const char *form; /* of the value, for help and messages */
    const char *meaning;
};

struct inject_kind_row {
    bool of_bus;
    const char *name;
    uint32_t allowed;  /* keys, by INJECT_BIT */
    uint32_t required; /* keys */
    const char *meaning;
};

extern const struct inject_key_row inject_keys[INJECT_KEYS];
extern const struct inject_kind_row inject_kinds[INJECT_KINDS];

#define INJECT_WORD_MAX 63

/*
 * Reads the value of a key. False: it has not the form of inject_keys[key]; fault is unchanged.
 */
bool inject_read_value(struct inject_fault *fault, enum inject_key key, const char *value);

/* "0.5s", "20ms", "300us": at most a day. False: not a time. */
bool inject_read_time(const char *text, uint64_t *time_ns);

/* "1" ... "127", decimal. False: not a node id. */
bool inject_read_node(const char *text, uint8_t *node);
/* The same, or on another bus than the first "1:20". False: neither. */
bool inject_read_address(const char *text, uint8_t *bus, uint8_t *node);

#endif
