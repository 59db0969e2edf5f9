/*
 * Does a compiled program belong to this machine and this text of a program? Asked before anything
 * of it moves.
 */
#ifndef TAKT_REPLAY_FIT_H
#define TAKT_REPLAY_FIT_H

#include "base/error.h"
#include "plan/limits.h"
#include "replay/format.h"

#include <stdbool.h>

struct replay_fit {
    uint32_t cycle_us;
    struct plan_limits limits; /* after correction's share */
    uint32_t text_size;        /* of the program's text, and its CRC-32 */
    uint32_t text_crc;
};

/* The header's bytes: false after saying in *why what is wrong with them. */
bool takt_replay_fit_read(struct replay_header *h, const uint8_t bytes[REPLAY_HEADER_BYTES],
                          struct diagnostic *why);

/* False: *why says what differs. */
bool takt_replay_fit_machine(const struct replay_header *h, const struct replay_fit *here,
                             struct diagnostic *why);
bool takt_replay_fit_text(const struct replay_header *h, const struct replay_fit *here,
                          struct diagnostic *why);

#endif
