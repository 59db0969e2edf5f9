#include "stepper/pulse_log.h"

#include <inttypes.h>
#include <string.h>

#define SECOND_NS UINT64_C(1000000000)

/* No edge to come. */
#define NEVER UINT64_MAX

/* Names of signals in a dump are printable characters, from '!' on: two for each axis. */
#define STEP_NAME(axis)      ((char)('!' + 2 * (axis)))
#define DIRECTION_NAME(axis) ((char)('!' + 2 * (axis) + 1))

static bool ends_with(const char *path, const char *end)
{
    const size_t length = strlen(path), size = strlen(end);

    return length > size && strcmp(path + length - size, end) == 0;
}

bool pulse_log_form_of(const char *path, enum pulse_log_form *form)
{
    *form = ends_with(path, ".vcd") ? PULSE_LOG_VCD : PULSE_LOG_CSV;
    return ends_with(path, ".vcd") || ends_with(path, ".csv") || strcmp(path, "-") == 0;
}

static bool has(unsigned axes, unsigned axis)
{
    return (axes >> axis & 1) != 0;
}

static void begin_csv(const struct pulse_log *log)
{
    (void)fputs("time_s", log->stream);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has(log->config.axes, i))
            (void)fprintf(log->stream, ",%c", AXIS_LETTERS[i]);
    }
    (void)fputc('\n', log->stream);
}

static void begin_vcd(const struct pulse_log *log)
{
    (void)fputs("$timescale 1 ns $end\n$scope module takt $end\n", log->stream);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has(log->config.axes, i))
            (void)fprintf(log->stream, "$var wire 1 %c %c_step $end\n$var wire 1 %c %c_dir $end\n",
                          STEP_NAME(i), AXIS_LETTERS[i], DIRECTION_NAME(i), AXIS_LETTERS[i]);
    }
    (void)fputs("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n", log->stream);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has(log->config.axes, i))
            (void)fprintf(log->stream, "0%c\n1%c\n", STEP_NAME(i), DIRECTION_NAME(i));
    }
    (void)fputs("$end\n", log->stream);
}

void pulse_log_begin(struct pulse_log *log, FILE *stream, const struct pulse_log_config *config)
{
    *log = (struct pulse_log){.stream = stream, .config = *config};
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        log->falls_ns[i] = NEVER;
    if (config->form == PULSE_LOG_CSV)
        begin_csv(log);
    else
        begin_vcd(log);
}

/* All changes of one time stand below it. */
static void go_to(struct pulse_log *log, uint64_t time_ns)
{
    if (time_ns > log->now_ns) {
        log->now_ns = time_ns;
        (void)fprintf(log->stream, "#%" PRIu64 "\n", time_ns);
    }
}

/* The axis whose step line falls first; AXIS_COUNT: all are low. */
static unsigned first_to_fall(const struct pulse_log *log)
{
    unsigned first = AXIS_COUNT;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (log->falls_ns[i] != NEVER &&
            (first == AXIS_COUNT || log->falls_ns[i] < log->falls_ns[first]))
            first = i;
    }
    return first;
}

static void let_fall(struct pulse_log *log, uint64_t until_ns)
{
    for (unsigned i = first_to_fall(log); i < AXIS_COUNT && log->falls_ns[i] <= until_ns;
         i = first_to_fall(log)) {
        go_to(log, log->falls_ns[i]);
        (void)fprintf(log->stream, "0%c\n", STEP_NAME(i));
        log->falls_ns[i] = NEVER;
    }
}

/* Half of the shortest time between two steps: 1/2 T, T = 1/f. */
static uint64_t length_ns(const struct pulse_log *log, unsigned axis)
{
    return (uint64_t)(0.5 * (double)SECOND_NS / log->config.rate_max_hz[axis]);
}

static void rise(struct pulse_log *log, unsigned axis, bool backwards)
{
    if (has(log->backwards, axis) != backwards) {
        log->backwards ^= 1u << axis;
        (void)fprintf(log->stream, "%c%c\n", backwards ? '0' : '1', DIRECTION_NAME(axis));
    }
    (void)fprintf(log->stream, "1%c\n", STEP_NAME(axis));
    log->falls_ns[axis] = log->now_ns + length_ns(log, axis);
}

static void take_vcd(struct pulse_log *log, uint64_t time_ns, const struct step_pulse *pulse)
{
    let_fall(log, time_ns);
    go_to(log, time_ns);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has(pulse->axes & log->config.axes, i))
            rise(log, i, has(pulse->direction, i));
    }
}

static void take_csv(const struct pulse_log *log, uint64_t time_ns, const struct step_pulse *pulse)
{
    (void)fprintf(log->stream, "%" PRIu64 ".%09" PRIu64, time_ns / SECOND_NS, time_ns % SECOND_NS);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const int forwards = has(pulse->direction, i) ? -1 : 1;

        if (has(log->config.axes, i))
            (void)fprintf(log->stream, ",%d", has(pulse->axes, i) ? forwards : 0);
    }
    (void)fputc('\n', log->stream);
}

void pulse_log_take(void *log, uint64_t time_ns, const struct step_pulse *pulse)
{
    struct pulse_log *l = log;

    if (l->config.form == PULSE_LOG_CSV)
        take_csv(l, time_ns, pulse);
    else
        take_vcd(l, time_ns, pulse);
}

bool pulse_log_end(struct pulse_log *log)
{
    let_fall(log, NEVER - 1);
    return fflush(log->stream) == 0 && !pulse_log_has_failed(log);
}

bool pulse_log_has_failed(const struct pulse_log *log)
{
    return ferror(log->stream) != 0;
}
