/*
 * `takt circle`: the tool's way around a circle, both ways, on the virtual machine.
 */
#ifndef TAKT_HOST_CIRCLE_TEST_H
#define TAKT_HOST_CIRCLE_TEST_H

#include "circle/figures.h"
#include "circle/turn.h"
#include "cli/options.h"
#include "cli/status.h"
#include "program/program.h"

struct circle_test {
    enum plane plane;
    bool has_centre;
    double
        centre_mm[2]; /* in the order of the plane's axes; without: the middle of their travels */
    double radius_mm, feed_mm_min;
    double reached_mm_min;                /* the highest feed of both turns that are measured */
    struct circle_turn turn[CIRCLE_WAYS]; /* measured; the caller's to free */
};

/* Fills in the centre and the turns. STATUS_DONE; else after messages. */
enum command_status circle_test_run(struct circle_test *test, const struct options *options);

#endif
