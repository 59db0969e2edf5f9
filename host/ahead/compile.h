/*
 * A program's canonical moves in, a compiled program out: sections from rest to rest are collected,
 * planned and written one after the other.
 */
#ifndef TAKT_HOST_AHEAD_COMPILE_H
#define TAKT_HOST_AHEAD_COMPILE_H

#include "ahead/encode.h"
#include "ahead/solver.h"
#include "plan/limits.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Time between knots of the curve, at most, and so three axes' 3 kB a second; a slower control
 * cycle has one knot each. Less where the time in which the tolerance is crossed,
 * T = max(cbrt(P / J), sqrt(P / A)), is less than so many knots, and one cycle where nothing is
 * blended, for every section takes two knots longer than its exact path.
 */
#define COMPILE_STEP_S         0.002
#define COMPILE_CROSSING_KNOTS 2

/*
 * Part of acceleration and jerk left to changes of the rate (firmware/replay/rate.h), and of
 * velocity to rounding.
 */
#define COMPILE_RESERVE      0.005
#define COMPILE_RESERVE_KEPT 0.004
#define COMPILE_SPEED_PART   0.9995

/*
 * A quantum is no more than this part of the least J tau^3, if there are so few cycles between
 * knots.
 */
#define COMPILE_QUANTUM_PART 0.01

enum compile_result {
    COMPILE_DONE,
    COMPILE_STOPPED, /* as asked */
    COMPILE_MEMORY,
    COMPILE_UNFIT, /* a move that cannot be compiled: compile.wrong */
    COMPILE_UNWRITTEN
};

struct compile_config {
    struct plan_limits limits;         /* after correction's share */
    struct vibration_config vibration; /* of the machine: modes; has passed its check */
    uint32_t cycle_us;
    uint32_t ceiling_percent;
    uint32_t
        text_size; /* of the program, and its CRC-32: for whoever has no time to read it twice */
    uint32_t text_crc;
    double tolerance_part; /* of the tolerance that is used; 0: every section on the exact path */
    bool stops;            /* at every junction, there */
    double tolerance_mm;   /* the smallest of motions that are blended; 0: none is */
    unsigned workers;
    uint32_t blocks; /* about so many in the program: for the progress */
    bool (*progress)(void *context, double part, double time_s);
    void *context;
};

struct compile {
    struct compile_config config;
    struct ahead_limits limits;
    uint32_t step_cycles;     /* between knots */
    struct plan_limits exact; /* the same for the planner on board, a cycle for each knot */
    struct solver *solver;
    struct encoder encoder;
    struct ahead_path path; /* of the section that is being collected */
    double tolerance_mm;    /* of the element collected last, as programmed */
    struct point at;
    uint32_t blocks; /* motions so far */
    uint32_t solved; /* of them, planned */
    double time_s;   /* of sections planned so far */
    uint64_t digest;
    struct {
        uint32_t line;
        const char *why;
    } wrong;
};

/*
 * COMPILE_DONE or COMPILE_MEMORY. stream: as encoder_begin has it. compile_free is due in either
 * case.
 */
enum compile_result compile_begin(struct compile *c, const struct compile_config *config,
                                  const struct point *start, FILE *stream);
enum compile_result compile_add(struct compile *c, const struct move *move);
enum compile_result compile_end(struct compile *c);
void compile_free(struct compile *c);

/* The digest of canonical moves that binds a compiled program to its program. */
uint64_t compile_digest(uint64_t digest, const struct move *move);

#endif
