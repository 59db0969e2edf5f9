/* What tests of modes of operation and of stops share: controlwords, a drive alone, its targets. */
#ifndef TAKT_TESTS_DRIVE_MODES_BENCH_H
#define TAKT_TESTS_DRIVE_MODES_BENCH_H

#include "lone_drive.h"

#include <math.h>

#define PP  1
#define HM  6
#define IP  7
#define CSP 8

#define ENABLE 0x000F
#define NEW    0x0010
#define NOW    0x0020
#define REL    0x0040
#define HALT   0x0100

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static inline double command_mm(void)
{
    return lone.drive.servo.loop.command_mm;
}

static inline void target_by_pdo(int32_t target_inc)
{
    lone_take(&lone, 0x300 + LONE_NODE, 4, (uint32_t)target_inc, 0);
    lone_sync(&lone);
}

#endif
