/*
 * A first trajectory along a section: feeds that axes, curvature and corners allow by simple
 * formulas, reached by an even acceleration. It is on the path but not legal.
 */
#ifndef TAKT_HOST_AHEAD_GUESS_H
#define TAKT_HOST_AHEAD_GUESS_H

#include "ahead/limits.h"
#include "ahead/path.h"
#include "ahead/trail.h"

/* False: out of memory. The caller frees the trail. */
bool guess_trail(const struct ahead_path *path, const struct ahead_limits *limits,
                 struct trail *trail);

#endif
