/* Shared by the sources of a route: its curved elements. */
#ifndef TAKT_SMOOTH_ROUTE_CURVED_H
#define TAKT_SMOOTH_ROUTE_CURVED_H

#include "smooth/route.h"

/* Route for a mm of a curved element. */
float takt_route_per_mm(const struct route *r, uint32_t index);

/* The curve of a curved element: outside its plane every axis goes in proportion to the length. */
void takt_route_curve(const struct route *r, uint32_t index, struct curve *c);

#endif
