#include "serving/serving_page.h"

#include "base/error.h"
#include "base/maths.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cutter_compensation/cutter_compensation.h"
#include "drives/virtual_drives.h"
#include "serving/serving.h"
#include "simulation/inject_bus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Chords of a curve that is drawn: about this long, this many at least and at most. */
#define CHORD_MM   0.5
#define CHORDS_MIN 8
#define CHORDS_MAX 96

/* ---- what pages are told once ---- */

static void set_axes(struct page_setup *setup, const struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        setup->axis[i] = (struct page_axis){
            .is_present = axis->present,
            .velocity = axis->max_velocity_mm_s,
            .acceleration = axis->max_acceleration_mm_s2,
            .jerk = axis->max_jerk_mm_s3,
            .following = axis->following_error_max_mm,
            .travel_min = axis->travel_min_mm,
            .travel_max = axis->travel_max_mm,
        };
    }
}

/* The axis whose drive has this node, else the node as it is. */
static void name_drive(struct page_drive *drive, unsigned bus, const struct machine *machine)
{
    (void)snprintf(drive->name, sizeof drive->name, "node %u", drive->node);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present && machine->axis[i].drive_node == drive->node &&
            machine->axis[i].drive_bus == bus)
            (void)snprintf(drive->name, sizeof drive->name, "%c", AXIS_LETTERS[i]);
    }
}

static void set_drives(struct page_setup *setup, const struct drive_network *network,
                       const struct machine *machine)
{
    if (network->is_outside)
        return;
    for (unsigned i = 0; i < network->drives.count && i < PAGE_DRIVES_MAX; i++) {
        struct page_drive *drive = &setup->drive[setup->drives++];

        drive->node = network->drives.drive[i].servo.config.node;
        drive->dictionary = network->drives.drive[i].servo.dictionary;
        name_drive(drive, network->drives.drive[i].bus, machine);
    }
}

void serving_page_set_up(struct page_setup *setup, const struct machine *machine)
{
    (void)snprintf(setup->machine, sizeof setup->machine, "%s", machine->name);
    (void)snprintf(setup->version, sizeof setup->version, "%s", TAKT_VERSION);
    setup->cycle_us = machine->cycle_us;
    setup->bitrate = machine->can_bitrate;
    set_axes(setup, machine);
}

void serving_page_print(const char *host, const struct page_server *server)
{
    const bool is_ipv6 = strchr(host, ':') != NULL;

    (void)printf("page on http://%s%s%s:%u/\n", is_ipv6 ? "[" : "", host, is_ipv6 ? "]" : "",
                 (unsigned)page_server_get_port(server));
    (void)fflush(stdout);
}

/* ---- the program ---- */

static bool get_program(void *context, const char **text, size_t *size)
{
    const struct serving *s = context;

    return program_store_get(&s->store, text, size);
}

struct drawing {
    struct program program;
    struct cutter_compensation offset;
    struct source_text text;
    struct tool_table tools;
};

/* False: it is no longer wanted. */
static bool draw_move(struct page_path *path, const struct move *move, const struct point *at)
{
    struct curve curve;
    unsigned chords = 1;

    if (!takt_move_curve(move, at, &curve))
        return true;
    if (curve.kind != CURVE_LINE)
        chords = (unsigned)maths_clamp(curve.length_mm / CHORD_MM, CHORDS_MIN, CHORDS_MAX);
    for (unsigned i = 1; i <= chords; i++) {
        struct point point;

        takt_curve_point(&curve, curve.length_mm * (double)i / (double)chords, &point);
        if (!page_path_add(path, &point, move->line, move->kind == MOVE_RAPID))
            return false;
    }
    return true;
}

static void draw_moves(struct drawing *d, const struct program_config *config,
                       struct page_path *path)
{
    struct diagnostic diagnostic = {0};
    struct point at = config->start;
    enum program_result result;
    struct move move;

    (void)page_path_add(path, &at, 0, true);
    while ((result = takt_cutter_compensation_next(&d->offset, &d->program, &move, &diagnostic)) ==
           PROGRAM_MOVE) {
        if (!move_is_motion(&move))
            continue;
        if (!draw_move(path, &move, &at))
            return;
        at = move.end;
    }
    if (result == PROGRAM_ERROR)
        (void)takt_diagnostic_text(&diagnostic, path->problem);
}

/* In a thread of its own, on copies of all that the control thread changes. */
static void draw(void *context, const struct page_source *page, struct page_path *path)
{
    const struct serving *s = context;
    struct drawing *d = malloc(sizeof *d);
    struct parameters parameters = page->parameters;
    struct program_config config;
    struct source source;

    if (d == NULL)
        return;
    d->tools = (struct tool_table){page->tools, page->tools_count};
    const struct controller_config controller = {.machine = &s->session.setup.machine,
                                                 .tools = &d->tools,
                                                 .parameters = &parameters,
                                                 .exact_path = s->session.options->exact_path};
    takt_controller_program_config(&controller, &config);
    config.waits = false;
    config.repeats_max = OPTIONS_LINES_MAX;
    takt_source_open_text(&source, &d->text, page->text, page->size);
    takt_program_open(&d->program, &config, &source);
    takt_cutter_compensation_open(&d->offset, &config);
    draw_moves(d, &config, path);
    free(d);
}

/* ---- what the control thread does for pages ---- */

static void read_tables(const struct serving *s, struct page_job *job)
{
    const struct service_config *config = &s->service.config;

    job->parameters = *config->parameters;
    job->tools_count = config->tools_count < job->tools_max ? config->tools_count : job->tools_max;
    if (job->tools_count > 0)
        memcpy(job->tools, config->tools, job->tools_count * sizeof *job->tools);
}

static void read_responses(const struct drive_network *network, struct page_bus *shown)
{
    shown->responses = 0;
    for (unsigned id = 0; id < BUS_ID_COUNT && shown->responses < PAGE_RESPONSES_MAX; id++) {
        uint32_t longest_ns = 0;

        for (unsigned i = 0; i < network->buses; i++) {
            const uint32_t own_ns = bus_get_response_max_ns(&network->bus[i], id);

            longest_ns = own_ns > longest_ns ? own_ns : longest_ns;
        }
        if (longest_ns > 0)
            shown->response[shown->responses++] = (struct page_response){(uint16_t)id, longest_ns};
    }
}

/* Figures of several buses: their frames together, the highest load, the longest response. */
static void read_bus(const struct serving *s, struct page_bus *shown)
{
    const struct inject_clock *clock = virtual_drives_get_clock(&s->network.drives);

    shown->load_percent = drive_network_get_highest_load_percent(&s->network);
    for (unsigned i = 0; i < s->network.buses; i++) {
        const struct bus_counts *counts = &s->network.bus[i].counts;

        shown->frames += counts->frames;
        shown->error_frames += counts->error_frames;
        shown->dropped += counts->dropped;
        shown->refused += counts->refused + counts->receive_lost;
    }
    read_responses(&s->network, shown);
    shown->faults = s->page.faults.count;
    for (unsigned i = 0; i < shown->faults; i++)
        shown->fault[i] = (struct page_fault){s->page.faults.fault[i],
                                              inject_is_in_force(&s->page.faults.fault[i], clock)};
}

static void read_objects(struct serving *s, struct page_job *job)
{
    struct virtual_drive *drive = &s->network.drives.drive[job->drive];
    const struct dictionary *dictionary = drive->servo.dictionary;
    struct page_values *values = &job->values;

    values->count = dictionary->count < PAGE_OBJECTS_MAX ? dictionary->count : PAGE_OBJECTS_MAX;
    for (unsigned i = 0; i < values->count; i++) {
        const struct object_row *row = &dictionary->row[i];
        const unsigned bytes = takt_object_type_bytes((enum object_type)row->type);

        values->is_there[i] =
            bytes > 0 && row->access != OBJECT_WO &&
            virtual_drive_read_object(drive, PDO_MAPPED((uint32_t)row->index, row->sub, 8 * bytes),
                                      &values->value[i]);
    }
}

static void write_object(struct serving *s, struct page_job *job)
{
    if (!virtual_drive_write_object(&s->network.drives.drive[job->drive], job->object, job->value))
        (void)snprintf(job->problem, sizeof job->problem, "the drive does not take it");
}

/* Those of drives are found in the script; those of the bus are added to it. */
static bool begin_fault(struct serving *s, const struct inject_fault *fault)
{
    struct virtual_drives *drives = &s->network.drives;
    uint8_t nodes[VIRTUAL_DRIVES_MAX];
    struct inject one = {.count = 1, .fault = {*fault}};

    if (fault->bus >= s->network.buses)
        return false;
    s->page.faults.fault[s->page.faults.count++] = *fault;
    if (!inject_is_of_bus(fault->kind))
        return true;
    const unsigned count = virtual_drives_on_bus(drives, fault->bus, nodes);

    return inject_bus_add(&s->network.bus[fault->bus], fault->bus, &one, INJECT_POWER, 0, nodes,
                          count);
}

static void add_fault(struct serving *s, struct page_job *job)
{
    struct inject_fault fault = job->fault;

    fault.after_ns += virtual_drives_get_clock(&s->network.drives)->now_ns;
    if (s->page.faults.count == INJECT_FAULTS_MAX || !begin_fault(s, &fault))
        (void)snprintf(job->problem, sizeof job->problem,
                       "no more than %d faults between two starts", INJECT_FAULTS_MAX);
}

/* What has happened has happened; what lasts is over. */
static void end_faults(struct serving *s)
{
    const uint64_t now_ns = virtual_drives_get_clock(&s->network.drives)->now_ns;

    for (unsigned i = 0; i < s->page.faults.count; i++) {
        struct inject_fault *fault = &s->page.faults.fault[i];

        if (fault->for_ns != 0 && now_ns > fault->after_ns &&
            fault->for_ns > now_ns - fault->after_ns)
            fault->for_ns = now_ns - fault->after_ns;
    }
    for (unsigned i = 0; i < s->network.buses; i++)
        bus_end_faults(&s->network.bus[i]);
}

static void do_job(struct serving *s, struct page_job *job)
{
    switch (job->kind) {
    case PAGE_JOB_TABLES:
        read_tables(s, job);
        break;
    case PAGE_JOB_BUS:
        read_bus(s, &job->bus);
        break;
    case PAGE_JOB_OBJECTS:
        read_objects(s, job);
        break;
    case PAGE_JOB_WRITE:
        write_object(s, job);
        break;
    case PAGE_JOB_FAULT:
        add_fault(s, job);
        break;
    case PAGE_JOB_CLEAR:
        end_faults(s);
        break;
    }
}

/* A position that is reported belongs to a setpoint of some cycles ago. */
static void put_cycle(struct serving *s)
{
    const struct service *service = &s->service;
    struct page_cycle cycle = {.number = service->cycles, .set = service->sent[0]};
    struct point actual;

    takt_controller_get_actual(&service->controller, &actual);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        cycle.following.at[i] = service->sent[DRIVES_LATENCY_CYCLES - 1].at[i] - actual.at[i];
    page_link_put(&s->page.link, &cycle);
}

void serving_page_cycle(struct serving *s)
{
    struct page_job *job;

    if (s->page.server == NULL)
        return;
    put_cycle(s);
    job = page_link_get_job(&s->page.link);
    if (job == NULL)
        return;
    do_job(s, job);
    page_link_finish(&s->page.link);
}

/* ---- open and close ---- */

/* Asked for: an error. By default: told where the service says what it serves. */
static enum command_status has_failed(struct serving *s, const char *problem)
{
    s->page.problem = problem;
    if (s->session.options->panel.http == NULL)
        return STATUS_DONE;
    message_command_error("--http %s: %s", s->session.options->panel.http, problem);
    return STATUS_ENVIRONMENT;
}

enum command_status serving_page_open(struct serving *s)
{
    struct page_server_config config = {.panel = &s->panel,
                                        .link = &s->page.link,
                                        .setup = &s->page.setup,
                                        .owner = {get_program, draw, s},
                                        .tools_max = s->session.tools.table.count};
    const char *problem;

    if (!serving_options_read_page(&s->options, &s->session, &config))
        return STATUS_INPUT;
    if (config.address == NULL)
        return STATUS_DONE;
    serving_page_set_up(&s->page.setup, &s->session.setup.machine);
    set_drives(&s->page.setup, &s->network, &s->session.setup.machine);
    if (!s->network.is_outside)
        virtual_drives_inject(&s->network.drives, &s->page.faults);
    s->page.server = page_server_open(&config, &problem);
    return s->page.server != NULL ? STATUS_DONE : has_failed(s, problem);
}

void serving_page_close(struct serving *s)
{
    page_server_close(s->page.server);
    s->page.server = NULL;
}
