/*
 * What reads a part program. It stands beside the controller, since a processor may have memories
 * of several kinds: only the background touches it, and no peripheral.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_READER_H
#define TAKT_CONTROLLER_CONTROLLER_READER_H

#include "cutter_compensation/cutter_compensation.h"
#include "program/program.h"

/* Private, but the caller owns it. */
struct controller_reader {
    struct program program;
    struct cutter_compensation offset;
};

#endif
