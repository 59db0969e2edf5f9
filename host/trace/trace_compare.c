/* takt trace A B: where two traces differ, column by column. */
#include "trace/trace_check.h"

#include "base/maths.h"
#include "cli/message.h"

#include <stdio.h>

/* A column that both traces have. */
struct column_pair {
    int a, b;
    double most;  /* largest difference, without sign */
    double first; /* the first above the tolerance, b - a */
    double first_cycle, most_cycle;
    uint64_t over; /* rows */
};

struct comparison {
    struct trace_reader *a, *b;
    double tolerance;
    int cycle; /* column of a */
    uint64_t rows;
    unsigned pairs;
    struct column_pair pair[TRACE_COLUMNS_MAX];
    bool equal;
};

static void pair_columns(struct comparison *c)
{
    for (unsigned i = 0; i < c->a->columns; i++) {
        int other = trace_reader_find(c->b, c->a->column[i]);

        if (other >= 0) {
            c->pair[c->pairs++] = (struct column_pair){.a = (int)i, .b = other};
        } else {
            (void)printf("column %s is in %s alone\n", c->a->column[i], c->a->name);
            c->equal = false;
        }
    }
    for (unsigned i = 0; i < c->b->columns; i++) {
        if (trace_reader_find(c->a, c->b->column[i]) < 0) {
            (void)printf("column %s is in %s alone\n", c->b->column[i], c->b->name);
            c->equal = false;
        }
    }
}

static void compare_row(struct comparison *c)
{
    double cycle = c->a->value[c->cycle];

    for (unsigned i = 0; i < c->pairs; i++) {
        struct column_pair *pair = &c->pair[i];
        double difference = c->b->value[pair->b] - c->a->value[pair->a];

        if (maths_abs(difference) > pair->most) {
            pair->most = maths_abs(difference);
            pair->most_cycle = cycle;
        }
        if (maths_abs(difference) <= c->tolerance)
            continue;
        if (pair->over++ == 0) {
            pair->first = difference;
            pair->first_cycle = cycle;
        }
    }
    c->rows++;
}

static enum command_status compare_rows(struct comparison *c)
{
    for (;;) {
        enum trace_row a = trace_reader_next(c->a);
        enum trace_row b = trace_reader_next(c->b);

        if (a == TRACE_BAD || b == TRACE_BAD)
            return STATUS_INPUT;
        if (a != b) {
            (void)printf("%s has more rows: the other ends after %llu\n",
                         a == TRACE_ROW ? c->a->name : c->b->name, (unsigned long long)c->rows);
            c->equal = false;
        }
        if (a == TRACE_END || b == TRACE_END)
            return STATUS_DONE;
        compare_row(c);
    }
}

static void print_pairs(struct comparison *c)
{
    for (unsigned i = 0; i < c->pairs; i++) {
        const struct column_pair *pair = &c->pair[i];

        if (pair->over == 0)
            continue;
        c->equal = false;
        (void)printf(
            "%-18s differs in %llu rows: first by %.9g in cycle %.0f, most by %.9g in cycle %.0f\n",
            c->a->column[pair->a], (unsigned long long)pair->over, pair->first, pair->first_cycle,
            pair->most, pair->most_cycle);
    }
}

enum command_status trace_check_equal(struct trace_reader *a, struct trace_reader *b,
                                      double tolerance)
{
    struct comparison c = {.a = a,
                           .b = b,
                           .tolerance = tolerance,
                           .cycle = trace_reader_find(a, "cycle"),
                           .equal = true};
    enum command_status status;

    pair_columns(&c);
    status = compare_rows(&c);
    if (status != STATUS_DONE)
        return status;
    print_pairs(&c);
    if (!c.equal)
        return STATUS_FAILED;
    (void)printf("equal: %llu rows, %u columns, tolerance %.9g\n", (unsigned long long)c.rows,
                 c.pairs, tolerance);
    return STATUS_DONE;
}
