/*
 * The machine's chain as a machine file has it, from the part to the tool: "w C X b Y Z t"
 * (base/unit_chain.h).
 */
#ifndef TAKT_HOST_CHAIN_TEXT_H
#define TAKT_HOST_CHAIN_TEXT_H

#include "base/unit_chain.h"

#include <stdint.h>

/* Bytes of the text, its zero included. */
#define CHAIN_TEXT_MAX 32

/*
 * NULL: read; else what is wrong. An empty text is Z on Y, Y on X and X on the bed, with the
 * turning axis on the bed too (AXIS_COUNT: there is none).
 */
const char *chain_text_read(const char *text, uint32_t turn_axis, struct unit_chain *chain);

#endif
