/*
 * The image of a run on the desk: the firmware's controller, told every cycle by the desk what its
 * inputs are and what has come over the bus. It runs as fast as both sides go; time is counted in
 * cycles. remote/remote.h has the messages.
 *
 * The words it is started with name its files: setup, program, the two ends of the talk, and the
 * program as planned ahead, if it is to be replayed.
 */
#include "base/assert.h"
#include "correction/table_store.h"
#include "correction/tables.h"
#include "port/image.h"
#include "remote/remote.h"
#include "semihosting/desk_clock.h"
#include "semihosting/files.h"
#include "semihosting/semihosting.h"

#include <stdbool.h>
#include <string.h>

#define TOOLS_MAX 1000

/*
 * The frames of a cycle: of those received, what the controller has not had; and room for those it
 * sends.
 */
struct bus {
    const struct classical_frame *received, *received_end;
    struct classical_frame *sent, *sent_end;
    uint32_t refused;
};

/* For the whole image: one controller and what it stands on. */
struct desk {
    int program, in, out;
    int plan; /* -1: the controller plans */
    struct remote_setup setup;
    struct machine machine;
    struct parameters parameters;
    struct tool tools[TOOLS_MAX];
    struct tool_table table;
    struct correction_tables correction;
    struct bus bus;
    struct remote_inputs received;
    struct remote_outputs sent;
    struct controller controller;
    struct controller_reader reader;
    /* while tables are read */
    struct table stored;
    uint8_t bytes[REMOTE_TABLE_MAX];
};

static struct desk desk;

/* The run ends, and with it the talk. */
void takt_assert_failed(const char *file, int line, const char *text)
{
    (void)file;
    (void)line;
    (void)text;
    takt_semihosting_exit(3);
}

/* -- bus and program -- */

static bool bus_send(void *context, const struct can_frame *frame)
{
    struct bus *bus = context;

    if (bus->sent == bus->sent_end) {
        bus->refused++;
        return false;
    }
    classical_frame_set(bus->sent++, frame);
    return true;
}

static bool bus_receive(void *context, struct can_frame *frame)
{
    struct bus *bus = context;

    if (bus->received == bus->received_end)
        return false;
    classical_frame_get(bus->received++, frame);
    return true;
}

static long program_read(void *context, char *buffer, size_t size)
{
    const struct desk *d = context;
    const size_t count = takt_semihosting_read(d->program, buffer, size);

    return count > 0 ? (long)count : SOURCE_END;
}

static bool program_seek(void *context, uint64_t offset)
{
    const struct desk *d = context;

    return takt_semihosting_seek(d->program, (uint32_t)offset);
}

static size_t plan_read(void *context, uint8_t *bytes, size_t size)
{
    const struct desk *d = context;

    return takt_semihosting_read(d->plan, bytes, size);
}

/* -- start -- */

/* The handle of the setup; -1: one of the files is not there. */
static int open_files(struct desk *d)
{
    struct files files;
    int setup;

    if (!takt_files_begin(&files))
        return -1;
    setup = takt_files_open_next(&files, SEMIHOSTING_READ);
    d->program = takt_files_open_next(&files, SEMIHOSTING_READ);
    d->in = takt_files_open_next(&files, SEMIHOSTING_READ);
    d->out = takt_files_open_next(&files, SEMIHOSTING_WRITE);
    d->plan = takt_files_open_next(&files, SEMIHOSTING_READ);
    return d->program < 0 || d->in < 0 || d->out < 0 ? -1 : setup;
}

static enum takt_error read_table(struct desk *d, int file)
{
    const struct table_rules rules = {
        .axes = takt_machine_axes(&d->machine),
        .largest_mm = d->machine.correction.largest_mm,
        .steepest_ratio = d->machine.correction.steepest_ratio,
    };
    struct diagnostic wrong = {.code = TAKT_ERROR_TABLE_DAMAGED};
    struct remote_table head;

    if (!takt_files_read_all(file, &head, sizeof head) || head.size > sizeof d->bytes ||
        !takt_files_read_all(file, d->bytes, head.size) ||
        !takt_table_restore(d->bytes, head.size, &rules, &d->stored, &wrong))
        return wrong.code;
    if (head.is_volume != 0)
        return takt_grid_set(&d->correction.volume, &d->stored, &wrong) ? TAKT_OK : wrong.code;
    return takt_axis_tables_add(&d->correction.axes, &d->stored, &wrong) ? TAKT_OK : wrong.code;
}

static enum takt_error read_parameters(struct desk *d, int file)
{
    struct remote_parameter parameter;

    for (uint32_t i = 0; i < d->setup.parameters; i++) {
        if (!takt_files_read_all(file, &parameter, sizeof parameter))
            return TAKT_ERROR_SOURCE_UNREADABLE;
        if (!takt_parameters_set(&d->parameters, parameter.number, parameter.value))
            return TAKT_ERROR_PARAMETERS_FULL;
    }
    return TAKT_OK;
}

static enum takt_error read_setup(struct desk *d, int file)
{
    enum takt_error error;

    if (!takt_files_read_all(file, &d->setup, sizeof d->setup) || d->setup.magic != REMOTE_MAGIC ||
        !takt_files_read_all(file, &d->machine, sizeof d->machine))
        return TAKT_ERROR_SOURCE_UNREADABLE;
    error = read_parameters(d, file);
    if (error == TAKT_OK &&
        (d->setup.tools > TOOLS_MAX ||
         !takt_files_read_all(file, d->tools, d->setup.tools * sizeof d->tools[0])))
        error = TAKT_ERROR_SOURCE_UNREADABLE;
    d->table = (struct tool_table){d->tools, d->setup.tools};
    for (uint32_t i = 0; i < d->setup.tables && error == TAKT_OK; i++)
        error = read_table(d, file);
    return error;
}

static void open_controller(struct desk *d)
{
    const struct replay_source plan = {.context = d, .read = plan_read};
    const struct controller_config config = {
        .machine = &d->machine,
        .source = {.read = program_read, .seek = program_seek, .context = d},
        .can = {.port = {{.send = bus_send, .receive = bus_receive, .context = &d->bus}}},
        .tools = &d->table,
        .reader = &d->reader,
        .parameters = &d->parameters,
        .correction = &d->correction,
        .compiled = d->plan >= 0 ? &plan : NULL,
        .exact_path = d->setup.exact_path != 0,
        .block_delete = d->setup.block_delete != 0,
        .from_line = d->setup.from_line,
    };

    takt_controller_init(&d->controller, &config);
}

/* Compares notes with the desk. False: the run ends here. */
static bool begin(struct desk *d, int setup)
{
    const struct remote_hello hello = {REMOTE_MAGIC, sizeof d->machine, sizeof d->tools[0]};
    struct remote_ready ready = {.clock_hz = takt_desk_clock_hz()};
    struct diagnostic damage;

    if (!takt_semihosting_write(d->out, &hello, sizeof hello))
        return false;
    ready.error = takt_image_is_sound(&damage) ? read_setup(d, setup) : damage.code;
    if (ready.error == TAKT_OK)
        open_controller(d);
    return takt_semihosting_write(d->out, &ready, sizeof ready) && ready.error == TAKT_OK;
}

/* -- cycles -- */

static void set_rise(struct desk *d)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        takt_correction_set_rise(takt_controller_get_correction(&d->controller), (enum axis)i,
                                 d->received.rise_k[i]);
}

static void open_bus(struct desk *d)
{
    d->bus.received = d->received.frame;
    d->bus.received_end = d->received.frame + d->received.frames;
    d->bus.sent = d->sent.frame;
    d->bus.sent_end = d->sent.frame + REMOTE_FRAMES_MAX;
}

static void run_cycle(struct desk *d)
{
    uint32_t start = takt_desk_clock_now();

    takt_controller_background(&d->controller);
    d->sent.background_ns = takt_desk_clock_ns_since(start);
    start = takt_desk_clock_now();
    takt_controller_cycle(&d->controller, &d->received.inputs);
    d->sent.cycle_ns = takt_desk_clock_ns_since(start);
}

static void fill_outputs(struct desk *d)
{
    const struct cycle_record *record = takt_controller_get_record(&d->controller);

    d->sent.frames = (uint32_t)(d->bus.sent - d->sent.frame);
    d->sent.refused = d->bus.refused;
    d->sent.state = takt_controller_get_state(&d->controller);
    d->sent.fault = takt_controller_get_fault(&d->controller)->code;
    d->sent.blocks = d->controller.path.pushed;
    d->sent.has_record = record != NULL;
    if (record != NULL)
        d->sent.record = *record;
}

/* Without the room for frames that are not there. */
static bool answer(const struct desk *d)
{
    const size_t size =
        offsetof(struct remote_outputs, frame) + d->sent.frames * sizeof d->sent.frame[0];

    return takt_semihosting_write(d->out, &d->sent, size);
}

static bool ask(struct desk *d)
{
    const size_t head = offsetof(struct remote_inputs, frame);

    return takt_files_read_all(d->in, &d->received, head) &&
           d->received.frames <= REMOTE_FRAMES_MAX &&
           takt_files_read_all(d->in, d->received.frame,
                               d->received.frames * sizeof d->received.frame[0]);
}

static void run(struct desk *d)
{
    while (ask(d) && d->received.go_on != 0) {
        open_bus(d);
        set_rise(d);
        run_cycle(d);
        fill_outputs(d);
        if (!answer(d))
            return;
    }
}

int main(void)
{
    int setup;

    takt_desk_clock_start();
    setup = open_files(&desk);
    if (setup < 0)
        takt_semihosting_exit(2);
    if (begin(&desk, setup))
        run(&desk);
    takt_semihosting_exit(0);
}
