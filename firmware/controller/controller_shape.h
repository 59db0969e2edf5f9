/*
 * What shaping makes of the setpoints of a controller. Where it has none, and in a build without
 * it, nothing.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_SHAPE_H
#define TAKT_CONTROLLER_CONTROLLER_SHAPE_H

#include "controller/controller.h"

#include <stddef.h>

/* NULL: none. */
static inline struct shape *controller_shape_of(const struct controller *c)
{
#ifdef SHAPE_IS_ABSENT
    (void)c;
    return NULL;
#else
    return c->shape;
#endif
}

static inline void controller_shape_init(struct controller *c,
                                         const struct controller_config *config)
{
#ifdef SHAPE_IS_ABSENT
    (void)c;
    (void)config;
#else
    c->shape = config->shape;
#endif
}

/* Takes what shaping needs from the planner's limits. */
static inline void controller_shape_leave(const struct controller *c, struct plan_limits *limits)
{
    if (controller_shape_of(c) != NULL) {
        takt_shape_leave(controller_shape_of(c), limits);
    }
}

/* The axes stand where they are sent. */
static inline void controller_shape_restart(struct controller *c)
{
    if (controller_shape_of(c) != NULL) {
        takt_shape_restart(controller_shape_of(c), &c->record.set);
    }
}

/*
 * Shapes what correction has made of this cycle's setpoint. passes: it goes by as it is, since
 * nothing may come between the axes and the spindle; it begins and ends at rest.
 */
static inline void controller_shape_cycle(struct controller *c, bool passes)
{
    if (passes) {
        controller_shape_restart(c);
    } else if (controller_shape_of(c) != NULL) {
        takt_shape_cycle(controller_shape_of(c), &c->record.set);
    }
}

/* Is what is sent where the setpoint is? */
static inline bool controller_shape_is_settled(const struct controller *c)
{
    return controller_shape_of(c) == NULL || takt_shape_is_settled(controller_shape_of(c));
}

/* What correction has made of the last setpoint. */
static inline const struct point *controller_shape_input(const struct controller *c)
{
    return controller_shape_of(c) == NULL ? &c->record.set
                                          : takt_shape_input(controller_shape_of(c));
}

#endif
