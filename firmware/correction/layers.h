/*
 * The layers of correction, in the order they are summed. A new layer is a file layer_NAME.c that
 * defines `const struct correction_layer takt_layer_NAME`, and a line at the end here: programs
 * (M120 P) and the panel's coils know a layer by its place.
 */
#ifndef TAKT_CORRECTION_LAYERS_H
#define TAKT_CORRECTION_LAYERS_H

#define CORRECTION_LAYERS(LAYER)                                                                   \
    LAYER(MATRIX, matrix)                                                                          \
    LAYER(SETUP, setup)                                                                            \
    LAYER(AXES, axes)                                                                              \
    LAYER(VOLUME, volume)                                                                          \
    LAYER(THERMAL, thermal)                                                                        \
    LAYER(WEAR, wear)

#define CORRECTION_LAYER_NUMBER(NAME, name) CORRECTION_##NAME,
enum correction_layer_number { CORRECTION_LAYERS(CORRECTION_LAYER_NUMBER) CORRECTION_LAYERS_COUNT };
#undef CORRECTION_LAYER_NUMBER

/* " matrix setup ...", for texts. */
#define CORRECTION_LAYER_WORD(NAME, name) " " #name
#define CORRECTION_LAYER_WORDS            CORRECTION_LAYERS(CORRECTION_LAYER_WORD)

#define CORRECTION_ALL_LAYERS ((1U << CORRECTION_LAYERS_COUNT) - 1U)

#endif
