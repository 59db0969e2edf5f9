#define _POSIX_C_SOURCE 200809L

#include "compiled/compiled.h"

#include "ahead/compile.h"
#include "ahead/crew.h"
#include "base/crc32.h"
#include "base/fnv.h"
#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "cli/stopwatch.h"
#include "cli/text.h"
#include "compiled/compiled_verifier.h"
#include "config/shaper.h"
#include "replay/fit.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --ceiling, per cent. */
#define CEILING_MIN 100
#define CEILING_MAX 120

/* tolerance_part: of the tolerance that is used; 0: nothing is optimised. */
struct attempt {
    double tolerance_part;
    bool stops;
};

struct making {
    struct session_reading reading;
    struct compile compile;
    struct progress progress;
};

bool compiled_read_ceiling(const struct options *options, uint32_t *percent)
{
    const double given = options->ceiling;

    *percent = given > 0 ? (uint32_t)given : CEILING_MIN;
    if (given == 0 || (given >= CEILING_MIN && given <= CEILING_MAX && given == (double)*percent))
        return true;
    message_command_error("--ceiling %g must be a whole number from %d to %d per cent", given,
                          CEILING_MIN, CEILING_MAX);
    return false;
}

void compiled_limits(const struct session *s, const struct point *start, struct plan_limits *limits)
{
    static _Thread_local struct correction correction;

    shaper_plan_limits(&s->setup, limits);
    takt_correction_init(&correction, &s->setup.machine.correction, limits->axes, limits->cycle_s,
                         s->correction, start);
    takt_controller_reserve_correction(&correction, &s->setup.machine, limits);
}

bool compiled_check_machine(const struct session *s)
{
    const struct machine *m = &s->setup.machine;

    if (m->interpolator != INTERPOLATOR_EXACT) {
        message_command_error("a program planned ahead needs the exact interpolator");
        return false;
    }
    if (m->landing == LANDING_SCALE || m->limiter != LIMITER_CEILING) {
        message_command_error("a program planned ahead needs machine.landing span or block and "
                              "machine.limiter ceiling: the others plan while they run");
        return false;
    }
    return true;
}

static bool show(void *context, double part, double time_s)
{
    struct making *m = context;

    progress_show(&m->progress, part, time_s);
    return !interrupt_asked();
}

static enum command_status status_of(const struct session *s, const struct compile *c,
                                     enum compile_result result)
{
    switch (result) {
    case COMPILE_DONE:
        return STATUS_DONE;
    case COMPILE_STOPPED:
        return STATUS_INTERRUPTED;
    case COMPILE_MEMORY:
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    case COMPILE_UNFIT:
        message_error(s->program.name, c->wrong.line, 0, "%s", c->wrong.why);
        return STATUS_INPUT;
    case COMPILE_UNWRITTEN:
        break;
    }
    message_command_error("the compiled program cannot be written: %s", strerror(errno));
    return STATUS_ENVIRONMENT;
}

/* Every move of the program into the compiler. */
static enum compile_result add_moves(struct making *m)
{
    enum compile_result result = COMPILE_DONE;
    struct diagnostic error;
    struct move move;

    while (result == COMPILE_DONE &&
           takt_cutter_compensation_next(&m->reading.offset, &m->reading.program, &move, &error) ==
               PROGRAM_MOVE)
        result = compile_add(&m->compile, &move);
    return result == COMPILE_DONE ? compile_end(&m->compile) : result;
}

/* Size and CRC-32 of the program's text, which is what a controller knows of it. */
static void set_text(const struct session *s, struct compile_config *config)
{
    static _Thread_local struct program_text_reader reader;
    struct source source;
    char bytes[PROGRAM_TEXT_PIECE];
    long length;

    program_text_read(&s->program, &reader, &source);
    config->text_crc = CRC32_START;
    while ((length = source.read(source.context, bytes, sizeof bytes)) > 0) {
        config->text_crc = takt_crc32_add(config->text_crc, bytes, (size_t)length);
        config->text_size += (uint32_t)length;
    }
}

static enum command_status compile(struct making *m, const struct session *s,
                                   const struct session_totals *totals, uint32_t ceiling_percent,
                                   const struct attempt *attempt, FILE *stream)
{
    struct compile_config config = {.cycle_us = s->setup.machine.cycle_us,
                                    .ceiling_percent = ceiling_percent,
                                    .tolerance_part = attempt->tolerance_part,
                                    .stops = attempt->stops,
                                    .tolerance_mm = totals->tolerance_mm,
                                    .workers = crew_cores(),
                                    .blocks = totals->motions,
                                    .progress = show,
                                    .context = m};
    struct program_config program;
    struct source source;
    enum compile_result result;

    session_begin_reading(s, &m->reading, &program, &source);
    takt_program_open(&m->reading.program, &program, &source);
    takt_cutter_compensation_open(&m->reading.offset, &program);
    compiled_limits(s, &program.start, &config.limits);
    shaper_planned_modes(&s->setup, &config.vibration);
    set_text(s, &config);
    progress_start(&m->progress, !s->options->quiet);
    result = compile_begin(&m->compile, &config, &program.start, stream);
    if (result == COMPILE_DONE)
        result = add_moves(m);
    progress_end(&m->progress);
    return status_of(s, &m->compile, result);
}

/* Anew, from an empty file. */
static bool empty(FILE *stream)
{
    rewind(stream);
    return ftruncate(fileno(stream), 0) == 0;
}

/* Compiled and verified. */
static enum command_status make(const struct session *s, const struct session_totals *totals,
                                uint32_t ceiling_percent, const struct attempt *attempt,
                                FILE *stream, struct compiled_figures *figures)
{
    struct making *m = calloc(1, sizeof *m);
    enum command_status status;

    *figures = (struct compiled_figures){0};
    if (m == NULL || !empty(stream)) {
        message_command_error("no memory, or the compiled program cannot be written");
        free(m);
        return STATUS_ENVIRONMENT;
    }
    status = compile(m, s, totals, ceiling_percent, attempt, stream);
    figures->bytes = m->compile.encoder.bytes;
    compile_free(&m->compile);
    free(m);
    return status == STATUS_DONE ? compiled_verifier(s, stream, figures) : status;
}

enum command_status compiled_make(const struct session *s, const struct session_totals *totals,
                                  uint32_t ceiling_percent, FILE *stream,
                                  struct compiled_figures *figures)
{
    /*
     * What the verifier refuses is made with less of the tolerance, then on the exact path, at last
     * with a stop at each junction.
     */
    static const struct attempt attempts[] = {
        {1, false}, {0.8, false}, {0.4, false}, {0, false}, {0, true}};
    const uint64_t start_ns = stopwatch_now_ns();
    enum command_status status = STATUS_FAILED;

    *figures = (struct compiled_figures){0};
    if (totals->is_open || totals->sets_up) {
        message_error(
            s->program.name, 0, 0,
            "what follows a probing move, M66 or a set-up of the part (G10 L13) cannot be "
            "planned ahead");
        return STATUS_INPUT;
    }
    for (size_t i = 0; i < sizeof attempts / sizeof attempts[0] && status == STATUS_FAILED; i++)
        status = make(s, totals, ceiling_percent, &attempts[i], stream, figures);
    if (status == STATUS_FAILED)
        message_error(s->program.name, figures->why_line, 0, "%s: nothing is written",
                      figures->why);
    figures->compile_s = 1e-9 * (double)(stopwatch_now_ns() - start_ns);
    return status;
}

/* -- a file that is there -- */

static size_t read_stream(void *context, uint8_t *bytes, size_t size)
{
    return fread(bytes, 1, size, context);
}

static uint64_t digest_of(const struct session *s)
{
    static _Thread_local struct session_reading reading;
    struct program_config config;
    struct source source;
    struct diagnostic error;
    struct move move;
    uint64_t digest = FNV_START;

    session_begin_reading(s, &reading, &config, &source);
    takt_program_open(&reading.program, &config, &source);
    takt_cutter_compensation_open(&reading.offset, &config);
    while (takt_cutter_compensation_next(&reading.offset, &reading.program, &move, &error) ==
           PROGRAM_MOVE)
        digest = compile_digest(digest, &move);
    return digest;
}

static bool report(const struct compiled *c, const struct diagnostic *why)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)takt_diagnostic_text(why, text);
    message_error(c->name, 0, 0, "%s: takt compile writes what fits", text);
    return false;
}

static bool fits_machine(const struct compiled *c, const struct session *s,
                         const struct replay_header *h)
{
    const struct point start = {{0}};
    struct replay_fit here = {.cycle_us = s->setup.machine.cycle_us};
    struct diagnostic why;

    compiled_limits(s, &start, &here.limits);
    return takt_replay_fit_machine(h, &here, &why) || report(c, &why);
}

/* Every record's checksum, before anything moves. */
static bool is_whole(const struct compiled *c)
{
    static _Thread_local struct intake intake;
    struct diagnostic why;

    takt_intake_open(&intake, &c->source);
    do {
        intake.intervals_taken = intake.intervals_came;
        intake.ends_taken = intake.ends_came;
        intake.sections_taken = intake.sections_came;
        takt_intake_read(&intake);
    } while (intake.fault == REPLAY_GOOD && intake.next != INTAKE_NOTHING &&
             intake.intervals_taken != intake.intervals_came);
    if (intake.fault == REPLAY_GOOD && intake.next == INTAKE_NOTHING)
        return true;
    takt_diagnostic_set(&why, TAKT_ERROR_PLAN_DAMAGED, 0, 0, "", 0, 0.0);
    return report(c, &why);
}

static bool read_header(const struct compiled *c, struct replay_header *h)
{
    uint8_t bytes[REPLAY_HEADER_BYTES];
    struct diagnostic why;
    const size_t got = fread(bytes, 1, sizeof bytes, c->stream);

    memset(bytes + got, 0, sizeof bytes - got); /* what is missing is 0, and damaged */
    return takt_replay_fit_read(h, bytes, &why) || report(c, &why);
}

static enum command_status check_file(const struct compiled *c, const struct session *s)
{
    struct replay_header h;

    if (!read_header(c, &h) || !fits_machine(c, s, &h))
        return STATUS_INPUT;
    rewind(c->stream);
    if (!is_whole(c))
        return STATUS_INPUT;
    rewind(c->stream);
    if (h.program == digest_of(s))
        return STATUS_DONE;
    message_error(c->name, 0, 0,
                  "was compiled from another program than %s, or with other tools, offsets or "
                  "options: compile it again",
                  s->program.name);
    return STATUS_INPUT;
}

/* NULL: errno says why. A text in memory is only read. */
static FILE *open_stream(const char *path)
{
    const struct text_held *held = text_find_held(path);

    if (held == NULL)
        return fopen(path, "rb");
    return fmemopen(held->bytes, held->length, "rb");
}

static enum command_status open_file(struct compiled *c, const struct session *s, const char *path)
{
    c->name = path;
    c->stream = open_stream(path);
    if (c->stream == NULL) {
        message_command_error("%s cannot be opened: %s", path, strerror(errno));
        return STATUS_INPUT;
    }
    c->source = (struct replay_source){.context = c->stream, .read = read_stream};
    return check_file(c, s);
}

enum command_status compiled_open(struct compiled *c, const struct session *s,
                                  const struct session_totals *totals, const char *path)
{
    struct compiled_figures figures;
    enum command_status status;

    *c = (struct compiled){0};
    if (!compiled_check_machine(s))
        return STATUS_INPUT;
    if (path != NULL)
        return open_file(c, s, path);
    c->name = s->program.name;
    c->stream = tmpfile();
    if (c->stream == NULL) {
        message_command_error("a temporary file cannot be created: %s", strerror(errno));
        return STATUS_ENVIRONMENT;
    }
    c->source = (struct replay_source){.context = c->stream, .read = read_stream};
    status = compiled_make(s, totals, 100, c->stream, &figures);
    rewind(c->stream);
    return status;
}

void compiled_close(struct compiled *c)
{
    if (c->stream != NULL)
        (void)fclose(c->stream);
    c->stream = NULL;
}
