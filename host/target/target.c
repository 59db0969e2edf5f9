#define _POSIX_C_SOURCE 200809L

#include "target/target.h"

#include "target/process.h"
#include "target/wire.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

__attribute__((format(printf, 2, 3))) static bool fail(struct target *t, const char *format, ...)
{
    va_list arguments;

    if (t->problem[0] != '\0')
        return false;
    va_start(arguments, format);
    (void)vsnprintf(t->problem, sizeof t->problem, format, arguments);
    va_end(arguments);
    return false;
}

bool target_is_known(const char *name)
{
    return process_board(name) != NULL;
}

/* -- start -- */

/* False when there are no more. */
static bool next_parameter(const struct parameters *parameters, struct remote_parameter *next)
{
    unsigned number = next->number;
    const bool found = takt_parameters_next(parameters, &number, &next->value);

    next->number = number;
    return found;
}

static uint32_t count_parameters(const struct parameters *parameters)
{
    struct remote_parameter parameter = {0};
    uint32_t count = 0;

    while (next_parameter(parameters, &parameter))
        count++;
    return count;
}

static void write_parameters(FILE *file, const struct parameters *parameters)
{
    struct remote_parameter parameter = {0};

    while (next_parameter(parameters, &parameter))
        (void)fwrite(&parameter, sizeof parameter, 1, file);
}

static bool write_setup(FILE *file, const struct target_config *config)
{
    const struct remote_setup setup = {
        .magic = REMOTE_MAGIC,
        .parameters = count_parameters(config->parameters),
        .tools = (uint32_t)config->tools->count,
        .tables = config->tables,
        .from_line = config->from_line,
        .exact_path = config->exact_path,
        .block_delete = config->block_delete,
    };

    (void)fwrite(&setup, sizeof setup, 1, file);
    (void)fwrite(config->machine, sizeof *config->machine, 1, file);
    write_parameters(file, config->parameters);
    if (config->tools->count > 0) /* else there may be no array at all */
        (void)fwrite(config->tools->tools, sizeof *config->tools->tools, config->tools->count,
                     file);
    for (unsigned i = 0; i < config->tables; i++) {
        const struct remote_table head = {config->table[i].is_volume,
                                          (uint32_t)config->table[i].size};

        (void)fwrite(&head, sizeof head, 1, file);
        (void)fwrite(config->table[i].bytes, 1, config->table[i].size, file);
    }
    return fflush(file) == 0 && ferror(file) == 0;
}

static bool copy_program(FILE *file, const struct source *program)
{
    char piece[4096];
    long count;

    while ((count = program->read(program->context, piece, sizeof piece)) > 0)
        (void)fwrite(piece, 1, (size_t)count, file);
    return count == SOURCE_END && fflush(file) == 0 && ferror(file) == 0;
}

static bool start_qemu(struct target *t, const struct target_config *config, FILE *setup,
                       FILE *program)
{
    const struct process_board *board = process_board(config->name);
    const int plan = config->plan != NULL ? fileno(config->plan) : -1;

    if (process_start(&t->process, board, config->image,
                      (int[PROCESS_FILES]){fileno(setup), fileno(program), PROCESS_TALK, plan}))
        return true;
    return fail(t, "%s cannot be started: %s (Debian: %s)", board->qemu, strerror(errno),
                board->package);
}

/* The image says what it was built with, and what it makes of the setup. */
static bool shake_hands(struct target *t)
{
    struct remote_hello hello;
    struct remote_ready ready;
    char text[DIAGNOSTIC_TEXT_MAX];

    if (!wire_read(t->process.from, &hello, sizeof hello))
        return fail(t, "QEMU has ended before the image said anything");
    if (hello.magic != REMOTE_MAGIC || hello.machine_size != sizeof(struct machine) ||
        hello.tool_size != sizeof(struct tool))
        return fail(t, "the image is of another version: build it anew");
    if (!wire_read(t->process.from, &ready, sizeof ready))
        return fail(t, "the image has ended at its start");
    if (ready.error == TAKT_OK)
        return true;
    (void)takt_diagnostic_text(&(struct diagnostic){.code = (enum takt_error)ready.error}, text);
    return fail(t, "the image refuses its setup: %s", text);
}

bool target_open(struct target *t, const struct target_config *config)
{
    FILE *setup = tmpfile();
    FILE *program = tmpfile();
    bool good = setup != NULL && program != NULL;

    memset(t, 0, sizeof *t);
    t->name = config->name;
    t->bus = config->bus;
    t->process = (struct process){.to = -1, .from = -1};
    (void)signal(SIGPIPE, SIG_IGN);
    if (access(config->image, R_OK) != 0)
        (void)fail(t, "%s: %s", config->image, strerror(errno));
    else if (!good || !write_setup(setup, config) || !copy_program(program, &config->program))
        (void)fail(t, "no room for temporary files, or the program cannot be read");
    else if (start_qemu(t, config, setup, program))
        (void)shake_hands(t);
    if (setup != NULL)
        (void)fclose(setup);
    if (program != NULL)
        (void)fclose(program);
    return t->problem[0] == '\0';
}

void target_close(struct target *t)
{
    if (t->process.to >= 0) {
        t->given.go_on = 0;
        (void)wire_write(t->process.to, &t->given, offsetof(struct remote_inputs, frame));
    }
    process_end(&t->process);
}

/* -- the bus of the controller in this process -- */

static bool port_send(void *context, const struct can_frame *frame)
{
    struct target *t = context;

    if (t->own_count == REMOTE_FRAMES_MAX)
        return false;
    classical_frame_set(&t->own[t->own_count++], frame);
    return true;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    struct target *t = context;

    if (t->taken == t->given.frames)
        return false;
    classical_frame_get(&t->given.frame[t->taken++], frame);
    return true;
}

struct can_port target_get_port(struct target *t)
{
    return (struct can_port){.send = port_send, .receive = port_receive, .context = t};
}

/* -- cycles -- */

bool target_begin_cycle(struct target *t, const struct inputs *inputs, const double *rise_k)
{
    struct remote_inputs *given = &t->given;
    struct can_frame frame;

    given->go_on = 1;
    given->inputs = *inputs;
    memcpy(given->rise_k, rise_k, sizeof given->rise_k);
    given->frames = 0;
    while (given->frames < REMOTE_FRAMES_MAX && t->bus.receive(t->bus.context, &frame))
        classical_frame_set(&given->frame[given->frames++], &frame);
    t->taken = 0;
    t->own_count = 0;
    if (wire_write(t->process.to, given,
                   offsetof(struct remote_inputs, frame) + given->frames * sizeof given->frame[0]))
        return true;
    return fail(t, "QEMU has ended in the middle of the run");
}

static bool read_outputs(struct target *t)
{
    struct remote_outputs *done = &t->done;

    return wire_read(t->process.from, done, offsetof(struct remote_outputs, frame)) &&
           done->frames <= REMOTE_FRAMES_MAX &&
           wire_read(t->process.from, done->frame, done->frames * sizeof done->frame[0]);
}

static bool is_same_frame(const struct classical_frame *a, const struct classical_frame *b)
{
    return a->id == b->id && a->length == b->length && memcmp(a->data, b->data, a->length) == 0;
}

static bool is_same_traffic(const struct target *t)
{
    bool same = t->own_count == t->done.frames;

    for (uint32_t i = 0; same && i < t->own_count; i++)
        same = is_same_frame(&t->own[i], &t->done.frame[i]);
    return same;
}

/* Bits, not values: -0 is not 0. */
static bool is_same_number(double a, double b)
{
    uint64_t a_bits, b_bits;

    memcpy(&a_bits, &a, sizeof a_bits);
    memcpy(&b_bits, &b, sizeof b_bits);
    return a_bits == b_bits;
}

static bool is_same_point(const struct point *a, const struct point *b)
{
    bool same = true;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        same = same && is_same_number(a->at[i], b->at[i]);
    return same;
}

static bool is_same_record(const struct cycle_record *a, const struct cycle_record *b)
{
    return a->cycle == b->cycle && a->block == b->block && a->line == b->line &&
           a->landed == b->landed && is_same_number(a->feed_mm_s, b->feed_mm_s) &&
           is_same_number(a->override_percent, b->override_percent) &&
           is_same_number(a->limiter, b->limiter) &&
           is_same_number(a->spindle_rev, b->spindle_rev) && is_same_point(&a->cmd, &b->cmd) &&
           is_same_point(&a->set, &b->set) && is_same_point(&a->act, &b->act);
}

static bool is_same(const struct target *t, const struct controller *here)
{
    const struct cycle_record *record = takt_controller_get_record(here);

    return t->done.state == (uint32_t)takt_controller_get_state(here) && is_same_traffic(t) &&
           (t->done.has_record != 0) == (record != NULL) &&
           (record == NULL || is_same_record(record, &t->done.record));
}

/* The clock of the image counts in steps of 40 instructions. */
static void add_cost(struct target *t)
{
    struct target_cost *cost = &t->cost;

    cost->background_sum += t->done.background_ns;
    cost->blocks = t->done.blocks;
    if (t->done.has_record == 0)
        return;
    cost->cycles++;
    cost->sum += t->done.cycle_ns;
    if (t->done.cycle_ns > cost->max)
        cost->max = t->done.cycle_ns;
}

bool target_end_cycle(struct target *t, const struct controller *here)
{
    struct can_frame frame;

    if (!read_outputs(t))
        return fail(t, "QEMU has ended in the middle of the run");
    if (!is_same(t, here) && t->differences++ == 0)
        t->first_difference = t->cycles;
    t->cycles++;
    add_cost(t);
    for (uint32_t i = 0; i < t->done.frames; i++) {
        if (!classical_frame_is_valid(&t->done.frame[i]))
            return fail(t, "the image sends a frame that there is not");
        classical_frame_get(&t->done.frame[i], &frame);
        if (!t->bus.send(t->bus.context, &frame))
            return fail(t, "the bus has no room for the frames of the image");
    }
    return true;
}

const struct cycle_record *target_get_record(const struct target *t)
{
    return t->done.has_record != 0 ? &t->done.record : NULL;
}
