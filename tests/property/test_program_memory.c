/*
 * The length of a program does not matter: nothing is kept of it but the current line, so a million
 * lines take the memory of a thousand. The text is made on the way, so that it does not take memory
 * either.
 */
#define _DEFAULT_SOURCE

#include "program/program.h"

#include "unity.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#define LINES_FEW  1000UL
#define LINES_MANY 1000000UL
/* A page or two of the C library's, on a first use. A byte for every line would be a megabyte. */
#define GROWTH_MAX_KIB 64
#define LINE_TEXT_MAX  80

/* Text that is written while it is read. */
struct generator {
    unsigned long line, lines;
    size_t at, length;
    char text[LINE_TEXT_MAX];
};

static struct program program;
static struct parameters parameters;

void setUp(void)
{
}

void tearDown(void)
{
}

static void write_line(struct generator *g)
{
    const unsigned long i = g->line++;
    const int length = snprintf(g->text, sizeof(g->text), "N%lu G1 X%lu.%lu Y-%lu.5 Z%lu F%lu\n", i,
                                i % 400, i % 10, i % 300, i % 50, i % 1000 + 1);

    g->at = 0;
    g->length = (size_t)length;
}

static long generate(void *context, char *buffer, size_t size)
{
    struct generator *g = context;

    if (g->at == g->length) {
        if (g->line == g->lines) {
            return SOURCE_END;
        }
        write_line(g);
    }
    const size_t rest = g->length - g->at;
    const size_t count = rest < size ? rest : size;

    memcpy(buffer, g->text + g->at, count);
    g->at += count;
    return (long)count;
}

static long resident_kib(void)
{
    struct rusage usage;

    TEST_ASSERT_EQUAL_INT(0, getrusage(RUSAGE_SELF, &usage));
    return usage.ru_maxrss;
}

static void read_lines(unsigned long lines)
{
    struct program_config config = {.axes = 7U, .parameters = &parameters};
    struct generator generator = {.lines = lines};
    const struct source source = {generate, NULL, &generator};
    struct diagnostic error;
    struct move move;
    unsigned long moves = 0;

    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        config.travel_min[axis] = -500.0;
        config.travel_max[axis] = 500.0;
    }
    takt_parameters_clear(&parameters);
    takt_program_open(&program, &config, &source);
    while (takt_program_next(&program, &move, &error) == PROGRAM_MOVE) {
        moves += move_is_motion(&move) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_UINT64(lines, moves);
}

static void test_a_million_lines_take_the_memory_of_a_thousand(void)
{
    read_lines(LINES_FEW);
    const long few_kib = resident_kib();

    read_lines(LINES_MANY);
    TEST_ASSERT_TRUE(resident_kib() - few_kib <= GROWTH_MAX_KIB);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_million_lines_take_the_memory_of_a_thousand);
    return UNITY_END();
}
