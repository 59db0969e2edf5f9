/*
 * `takt run` with an operator's hands on single block and feed hold, for `hunt`: the library's run,
 * cycle by cycle.
 *
 *     hunt_run HANDS TRACE.csv SUMMARY.json run PROGRAM [options of takt run]
 *
 * HANDS: lines of CYCLE SINGLE HOLD END: from this cycle of the program on, single block and feed
 * hold are on (1) or off (0); 1: the run is ended, as by Ctrl-C, and the axes come to rest on the
 * path. The status is that of the run.
 */
#include "library/library.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define HANDS_MAX 256

/* Running, as struct takt_state has it. */
#define RUNNING 1

/* The status of a run that Ctrl-C has ended. */
#define INTERRUPTED 130

struct hand {
    unsigned long long cycle;
    int single, hold, end;
};

static struct hand hand[HANDS_MAX];
static unsigned hands;

static bool read_hands(const char *name)
{
    FILE *file = fopen(name, "r");
    struct hand *h = hand;

    if (file == NULL)
        return false;
    while (h < hand + HANDS_MAX &&
           fscanf(file, "%llu %d %d %d", &h->cycle, &h->single, &h->hold, &h->end) == 4)
        h++;
    hands = (unsigned)(h - hand);
    return fclose(file) == 0;
}

static void lay_hand(struct takt_job *job, const struct hand *h)
{
    struct takt_inputs inputs;

    takt_get_inputs(job, &inputs);
    inputs.single_block = h->single;
    inputs.feed_hold = h->hold;
    (void)takt_set_inputs(job, &inputs);
}

/* Cycle by cycle while a change is still to come: those before the program begins do not count. */
static int run(struct takt_job *job)
{
    struct takt_state state;
    int status = takt_start(job, TAKT_KEEPS_TRACE);
    unsigned next = 0;
    bool ends = false;

    while (status == 0 && !ends && !takt_is_over(job)) {
        takt_get_state(job, &state);
        while (next < hands && state.state >= RUNNING && state.cycles >= hand[next].cycle) {
            ends = ends || hand[next].end;
            lay_hand(job, &hand[next++]);
        }
        if (!ends)
            status = takt_step(job, next < hands ? 1 : 4096);
    }
    return status != 0 ? status : takt_finish(job, ends ? INTERRUPTED : 0);
}

static bool is_setpoint(const struct takt_job *job, unsigned column)
{
    return strncmp(takt_get_column_name(job, column), "set_", 4) == 0;
}

/* Setpoints alone, with the decimals of a trace. */
static void write_row(FILE *file, const struct takt_job *job, uint64_t row)
{
    (void)fprintf(file, "%llu", (unsigned long long)row);
    for (unsigned c = 0; c < takt_count_columns(job); c++) {
        if (is_setpoint(job, c))
            (void)fprintf(file, ",%.9f", takt_get_column(job, c)[row]);
    }
    (void)fprintf(file, "\n");
}

static bool write_trace(const char *name, const struct takt_job *job)
{
    FILE *file = fopen(name, "w");

    if (file == NULL)
        return false;
    (void)fprintf(file, "cycle");
    for (unsigned c = 0; c < takt_count_columns(job); c++) {
        if (is_setpoint(job, c))
            (void)fprintf(file, ",%s", takt_get_column_name(job, c));
    }
    (void)fprintf(file, "\n");
    for (uint64_t row = 0; row < takt_count_rows(job); row++)
        write_row(file, job, row);
    return fclose(file) == 0;
}

static bool write_summary(const char *name, const struct takt_job *job)
{
    FILE *file = fopen(name, "w");
    size_t length;
    const char *text = takt_get_text(job, &length);

    if (file == NULL)
        return false;
    (void)fwrite(text, 1, length, file);
    return fclose(file) == 0;
}

static void tell_messages(const struct takt_job *job)
{
    unsigned count;
    const struct takt_message *m = takt_get_messages(job, &count);

    for (unsigned i = 0; i < count; i++)
        (void)fprintf(stderr, "%s:%u: %s: %s\n", m[i].file, (unsigned)m[i].line, m[i].kind,
                      m[i].text);
}

int main(int count, char **word)
{
    const char *const *words = (const char *const *)word;
    struct takt_job *job;
    int status;

    if (count < 6 || !read_hands(word[1])) {
        (void)fprintf(stderr,
                      "usage: hunt_run HANDS TRACE.csv SUMMARY.json run PROGRAM [options]\n");
        return 2;
    }
    job = takt_open(count - 4, words + 4, NULL, 0);
    if (job == NULL)
        return 3;
    status = run(job);
    tell_messages(job);
    if (!write_trace(word[2], job) || !write_summary(word[3], job))
        status = 3;
    takt_close(job);
    return status;
}
