/* What tests of O-words share: where a move ends, and a refusal with its line. */
#ifndef TAKT_TESTS_PROGRAM_FLOW_BENCH_H
#define TAKT_TESTS_PROGRAM_FLOW_BENCH_H

#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

/* The next move ends at this X, and nothing else has moved. */
static inline void expect_x(double x)
{
    (void)reader_expect(&reader, MOVE_RAPID, x, 0.0, 0.0);
}

/* The text is refused, at its first error, with this code in this line. */
static inline void expect_refused(const char *text, enum takt_error code, unsigned line)
{
    reader_expect_refused(&reader, text, code);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(line, reader.diagnostic.line, text);
}

#endif
