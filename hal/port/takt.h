/*
 * takt for whoever builds it into an image of their own: find_package(takt), link takt::port,
 * include this.
 *
 *     static struct embedded embedded;
 *     static struct embedded_core core;          the rest of its memory
 *
 *     takt_embedded_init(&embedded, &config);         what the image has: machine, CAN, a serial line, time
 *     interrupt of the control cycle:            takt_embedded_cycle(&embedded, &inputs, late);
 *     interrupt of the panel's line:             takt_embedded_take_byte(&embedded, byte, now_us);
 *     main, for ever:                            takt_embedded_background(&embedded);
 *
 * port/embedded.h has the contracts. Those who bring their own panel and program take
 * service/service.h or controller/controller.h, on which it stands.
 */
#ifndef TAKT_H
#define TAKT_H

#include "port/embedded.h"

#endif
