/* A path of feed moves along X on a small mill, for tests of what is planned over it. */
#ifndef TAKT_TEST_PLAN_ALONG_X_H
#define TAKT_TEST_PLAN_ALONG_X_H

#include "plan/path.h"

#include <string.h>

/* A/J is 20 cycles. */
static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

static struct path path;
static double x_mm; /* where it ends */

static void begin_path(void)
{
    const struct point start = {{0}};

    x_mm = 0.0;
    takt_path_init(&path, &limits, &start);
}

static void push(double length_mm, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    x_mm += length_mm;
    m.end.at[AXIS_X] = x_mm;
    takt_path_push(&path, &m);
}

#endif
