/*
 * Reads a compiled program as its bytes come, a record at a time, into rings that the control cycle
 * empties.
 *
 * Only the background writes the rings and what counts what has come; only the cycle moves what
 * counts what is taken.
 */
#ifndef TAKT_REPLAY_INTAKE_H
#define TAKT_REPLAY_INTAKE_H

#include "replay/format.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Powers of two. */
#define INTAKE_INTERVALS_MAX 1024
#define INTAKE_ENDS_MAX      512
#define INTAKE_SECTIONS_MAX  8

/*
 * Where the bytes come from, in order. Returns how many there were; fewer than asked for: no more
 * at the moment.
 */
struct replay_source {
    void *context;
    size_t (*read)(void *context, uint8_t *bytes, size_t size);
    /* No more will ever come, or what came was not what was announced. NULL: that cannot be. */
    bool (*is_lost)(void *context);
};

struct intake_section {
    uint32_t first_block;
    uint32_t blocks;
    uint32_t intervals;
    int64_t start[AXIS_LINEAR_COUNT]; /* quanta */
};

/* What comes next. */
enum intake_next { INTAKE_HEADER, INTAKE_RECORD, INTAKE_NOTHING };

struct intake {
    struct replay_source source;
    struct replay_header header;
    enum intake_next next;
    enum replay_fault fault; /* nothing more is read */
    uint32_t crc;
    uint64_t intervals; /* of all sections that came */
    uint8_t bytes[REPLAY_RECORD_MAX];
    size_t length; /* of what has come of the next record */
    uint32_t intervals_came, intervals_taken;
    uint32_t ends_came, ends_taken;
    uint32_t sections_came, sections_taken;
    /* of the next interval that comes, and of the last end, in parts from the section's start */
    uint64_t place;
    uint64_t last_end;
    int16_t third[INTAKE_INTERVALS_MAX][AXIS_LINEAR_COUNT];
    uint32_t end[INTAKE_ENDS_MAX]; /* behind the end before it */
    struct intake_section section[INTAKE_SECTIONS_MAX];
};

void takt_intake_open(struct intake *s, const struct replay_source *source);

/* Is there room for whatever the next record holds? */
bool takt_intake_has_room(const struct intake *s);

/* Background: reads what has come, as far as there is room. */
void takt_intake_read(struct intake *s);

#endif
