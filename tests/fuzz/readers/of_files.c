#define _POSIX_C_SOURCE 200809L

/* The files that takt is given: texts by path. */
#include "readers.h"

#include "config/correction_file.h"
#include "config/data_sheet.h"
#include "config/machine_file.h"
#include "drives/dictionary_read.h"
#include "tables/inject_file.h"
#include "tables/override_file.h"
#include "tables/parameter_file.h"
#include "tables/probe_file.h"
#include "tables/tool_file.h"
#include "trace/trace_check.h"
#include "trace/trace_reader.h"

#include <stdio.h>

#define PERCENT_MAX 200.0

static struct machine_setup setup;

/* What was taken for a machine is written again, and read as the same. */
void read_machine(const char *path)
{
    const struct options options = {.machine = path};
    static struct machine_setup again;
    char *text = NULL;
    size_t length = 0;
    FILE *stream;

    if (!machine_file_load(&setup, &options))
        return;
    stream = open_memstream(&text, &length);
    require(stream != NULL);
    machine_file_write(stream, &setup);
    require(fclose(stream) == 0);
    stream = fopen(path, "w");
    require(stream != NULL && fwrite(text, 1, length, stream) == length && fclose(stream) == 0);
    free(text);
    require(machine_file_load(&again, &options));
}

void read_tools(const char *path)
{
    static struct tool_file tools;

    (void)tool_file_read(&tools, path);
    tool_file_close(&tools);
}

void read_parameters(const char *path)
{
    static struct parameter_file parameters;

    (void)parameter_file_read(&parameters, path);
}

void read_correction(const char *path)
{
    static struct table table;

    machine_setup_set_default(&setup);
    (void)correction_file_read(&table, path, &setup.machine);
}

void read_triplets(const char *path)
{
    static struct table table;

    machine_setup_set_default(&setup);
    for (unsigned type = 0; type < 3; type++)
        (void)correction_file_read_triplets(&table, path, AXIS_X, type, &setup.machine);
}

void read_override(const char *path)
{
    struct override_file override = {0};

    if (override_file_load(&override, path, PERCENT_MAX)) {
        for (unsigned i = 0; i < 40; i++) {
            const double percent = override_file_at(&override, 0.25 * i);

            require(percent >= 0.0 && percent <= PERCENT_MAX);
        }
    }
    override_file_free(&override);
}

void read_inject(const char *path)
{
    static struct inject script;
    static const uint16_t nodes[] = {1, 2, 3};

    if (inject_file_load(&script, path))
        (void)inject_file_check_nodes(&script, path, nodes, sizeof nodes / sizeof nodes[0]);
}

static bool send_nowhere(void *context, const struct can_frame *frame)
{
    (void)context;
    require(frame->length <= CAN_CLASSIC_MAX);
    return true;
}

static bool receive_nothing(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

/* A drive of this data sheet is switched on. */
void read_sheet(const char *path)
{
    static struct virtual_drive drive;
    static const struct can_port nowhere = {.send = send_nowhere, .receive = receive_nothing};
    struct dictionary dictionary = {0};
    struct virtual_drive_config config = {
        .node = 1, .increments_per_mm = 1000.0, .dictionary = &dictionary};

    if (!data_sheet_load(&dictionary, path))
        return;
    drive_plant_set_default(&config.plant);
    virtual_drive_init(&drive, &config, NULL, &nowhere);
    dictionary_free(&dictionary);
}

void read_probe(const char *path)
{
    static struct virtual_probe probe;

    (void)probe_file_load(&probe, path);
}

void read_trace(const char *path)
{
    struct trace_reader reader = {0};

    machine_setup_set_default(&setup);
    if (trace_reader_open(&reader, path))
        (void)trace_check_limits(&reader, &setup.machine);
    trace_reader_close(&reader);
}
