/*
 * Writes a compiled program: sections of trajectory as firmware/replay/format.h has them.
 */
#ifndef TAKT_HOST_AHEAD_ENCODE_H
#define TAKT_HOST_AHEAD_ENCODE_H

#include "ahead/path.h"
#include "ahead/trail.h"
#include "replay/format.h"

#include <stdbool.h>
#include <stdio.h>

struct encoder {
    FILE *stream; /* can be sought in; the caller's */
    struct replay_header header;
    uint32_t crc;
    uint64_t bytes; /* written so far */
    bool failed;    /* to write */
};

/* h: everything but what is counted. */
void encoder_begin(struct encoder *e, FILE *stream, const struct replay_header *h);
/* One section; its path's elements are its blocks. */
void encoder_add(struct encoder *e, const struct ahead_path *path, const struct trail *t);
/* Counts and digest are known now. False: not everything could be written. */
bool encoder_end(struct encoder *e, uint64_t program);

/*
 * Bits below 1 mm of the quantum: third differences of control points up to so much fit into 16
 * bits.
 */
uint32_t encoder_quantum_bits(double third_mm);

#endif
