/*
 * An encoder with two tracks, an index pulse and a switch at a timer (TIM3): it counts four times a
 * line, and keeps its count at the very edge of the index pulse and of the switch. It counts 16
 * bits; read once every 32767 counts, it is as many as there are.
 */
#ifndef TAKT_STM32_QUADRATURE_H
#define TAKT_STM32_QUADRATURE_H

#include <stdbool.h>
#include <stdint.h>

enum quadrature_edge { QUADRATURE_INDEX, QUADRATURE_SWITCH, QUADRATURE_EDGES };

/* Private. */
struct quadrature {
    uint16_t seen;
    int64_t counts;
};

/* Counts from 0. */
void takt_quadrature_open(struct quadrature *quadrature);

/* Counts up since it was opened. */
int64_t takt_quadrature_read(struct quadrature *quadrature);

/*
 * Where the last edge was, told once: the rising one of the index pulse, both of the switch. False:
 * there was none. To be asked as often as it is read.
 */
bool takt_quadrature_take_edge(struct quadrature *quadrature, enum quadrature_edge edge,
                               int64_t *counts);

#endif
