/*
 * What the chip was doing when it had to stop: a record in RAM that a reset leaves alone and a
 * check that says whether it is one.
 */
#ifndef TAKT_STM32_CRASH_H
#define TAKT_STM32_CRASH_H

#include <stdbool.h>
#include <stdint.h>

enum crash_cause {
    CRASH_HARD_FAULT,
    CRASH_MEMORY_FAULT,
    CRASH_BUS_FAULT,
    CRASH_USAGE_FAULT,
    CRASH_CRYSTAL,   /* it has stopped */
    CRASH_INVARIANT, /* a broken one */
    CRASH_CAUSES
};

/* The end of a file's name, with its zero. */
#define CRASH_FILE_SIZE 32

struct crash_record {
    uint32_t cause;   /* enum crash_cause */
    uint32_t address; /* of the instruction; of an invariant: its line */
    uint32_t caller;  /* the link register */
    uint32_t status;  /* fault status registers: CFSR */
    union {
        struct {
            uint32_t hard;   /* HFSR */
            uint32_t access; /* the address that could not be accessed, if the status says so */
            uint32_t registers[5]; /* r0 ... r3, r12 */
            uint32_t cycles;       /* control cycles since power-on */
        };
        char file
            [CRASH_FILE_SIZE]; /* of an invariant: the end of its name, or all of it, with a zero */
    };
};

/* In memory that is neither cleared nor loaded at the start. */
struct crash_memory {
    uint32_t mark;
    struct crash_record record;
    uint32_t check;
};

void takt_crash_keep(struct crash_memory *memory, const struct crash_record *record);

/* False: there is none. It is told once. */
bool takt_crash_take(struct crash_memory *memory, struct crash_record *record);

/* Of an invariant: as much of the end of the name as there is room for. */
void crash_set_file(struct crash_record *record, const char *name);

/* "a hard fault" and so on. */
const char *takt_crash_name(uint32_t cause);

#endif
