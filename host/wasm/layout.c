/*
 * The offsets by which takt.mjs reads and writes structs of library.h.
 */
#include "library/library.h"

#include <assert.h>

static_assert(sizeof(struct takt_text) == 12 && offsetof(struct takt_text, bytes) == 4 &&
                  offsetof(struct takt_text, length) == 8,
              "TEXT in takt.mjs");
static_assert(sizeof(struct takt_message) == 24 && offsetof(struct takt_message, line) == 8 &&
                  offsetof(struct takt_message, text) == 16,
              "MESSAGE in takt.mjs");
static_assert(sizeof(struct takt_state) == 216 && offsetof(struct takt_state, cycles) == 8 &&
                  offsetof(struct takt_state, line) == 28 &&
                  offsetof(struct takt_state, cycle_s) == 40 &&
                  offsetof(struct takt_state, digest) == 208,
              "STATE in takt.mjs");
