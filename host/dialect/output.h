/*
 * The text that a translation grows.
 */
#ifndef TAKT_HOST_DIALECT_OUTPUT_H
#define TAKT_HOST_DIALECT_OUTPUT_H

#include "dialect/dialect.h"

void output_add(struct dialect_text *t, const char *bytes, size_t length);
__attribute__((format(printf, 2, 3))) void output_print(struct dialect_text *t, const char *format,
                                                        ...);

#endif
