#include "simulation/field.h"

#include "cli/message.h"
#include "config/data_sheet.h"
#include "simulation/inject_bus.h"

#include <string.h>

static bool is_outside(const struct field_options *options)
{
    enum link_kind kind = LINK_EMBEDDED;
    struct link_error error;

    return options->bus != NULL && link_check(options->bus, &kind, &error) && kind != LINK_EMBEDDED;
}

static bool check_bus(const char *bus)
{
    enum link_kind kind;
    struct link_error error;

    if (bus == NULL || link_check(bus, &kind, &error))
        return true;
    message_command_error("--bus: %s", error.text);
    return false;
}

bool field_check_options(const struct field_options *options)
{
    const char *drives = options->drives;

    if (!check_bus(options->bus))
        return false;
    if (options->has_script && is_outside(options)) {
        message_command_error("--inject: what goes wrong on an outside bus is not up to this "
                              "process; give drives their faults by takt drives --inject");
        return false;
    }
    if (drives != NULL && strcmp(drives, "internal") != 0 && strcmp(drives, "external") != 0) {
        message_command_error("--drives %s: internal or external is expected", drives);
        return false;
    }
    if (drives == NULL)
        return true;
    if (strcmp(drives, "external") == 0 && !is_outside(options)) {
        message_command_error("--drives external needs a bus that other processes can reach: "
                              "--bus socketcan:can0, slcan:PATH or socketcand:HOST:PORT");
        return false;
    }
    if (strcmp(drives, "internal") == 0 && is_outside(options)) {
        message_command_error("--drives internal are on the embedded bus; with --bus %s they are "
                              "external, a process of `takt drives` or real ones",
                              options->bus);
        return false;
    }
    return true;
}

/* Faults of the bus whose time counts from this anchor. */
static bool add_faults(struct field *field, const struct inject *script, enum inject_anchor anchor,
                       uint64_t anchor_ns)
{
    uint8_t nodes[VIRTUAL_DRIVES_MAX];

    for (unsigned i = 0; i < field->drives.count; i++)
        nodes[i] = field->drives.drive[i].config.node;
    return inject_bus_add(&field->bus, script, anchor, anchor_ns, nodes, field->drives.count);
}

static bool start_faults(struct field *field)
{
    if (field->script == NULL)
        return true;
    virtual_drives_inject(&field->drives, field->script);
    return add_faults(field, field->script, INJECT_POWER, 0);
}

static void add_enabled_faults(struct field *field)
{
    uint64_t enabled_ns = virtual_drives_get_clock(&field->drives)->enabled_ns;

    if (enabled_ns == INJECT_ALWAYS)
        return;
    field->has_enabled_faults = true;
    (void)add_faults(field, field->script, INJECT_ENABLED, enabled_ns);
}

bool field_add_faults(struct field *field, const struct inject *script, unsigned first)
{
    const uint64_t enabled_ns = virtual_drives_get_clock(&field->drives)->enabled_ns;
    struct inject added = {.count = script->count - first};

    for (unsigned i = 0; i < added.count; i++)
        added.fault[i] = script->fault[first + i];
    field->script = script;
    virtual_drives_inject(&field->drives, script);
    return add_faults(field, &added, INJECT_POWER, 0) &&
           (!field->has_enabled_faults || add_faults(field, &added, INJECT_ENABLED, enabled_ns));
}

static bool open_inside(struct field *field, const struct machine_setup *setup)
{
    struct virtual_drives_config drives;

    const struct frame_rates rates = machine_setup_get_rates(&setup->machine);

    (void)bus_init_rates(&field->bus, &rates); /* checked with the machine */
    field->port = bus_attach(&field->bus, NULL);
    if (!data_sheet_set_machine(&drives, setup, field->sheet))
        return false;
    virtual_drives_init(&field->drives, &field->bus, &drives);
    return start_faults(field);
}

static void count_frame(void *context, const struct wire_frame *frame, uint64_t time_ns)
{
    struct field_traffic *traffic = context;

    if (!(frame->flags & WIRE_ERROR)) {
        traffic->frames++;
        struct frame_length length = frame_bits_count_wire(&traffic->tables, frame);

        length.nominal += FRAME_BITS_INTERMISSION;
        traffic->busy_ns += frame_bits_ns(&traffic->times, &length);
    }
    if (traffic->next.on_frame != NULL)
        traffic->next.on_frame(traffic->next.context, frame, time_ns);
}

static enum command_status open_outside(struct field *field, const struct machine_setup *setup,
                                        const char *bus)
{
    const struct frame_rates rates = machine_setup_get_rates(&setup->machine);
    struct link_config config = {.bitrate = rates.nominal, .data_bitrate = rates.data};
    struct link_error error;
    uint8_t nodes[MACHINE_NODES_MAX];
    const unsigned count = machine_drive_nodes(&setup->machine, nodes);

    field->link = link_open(bus, &config, &error);
    if (field->link == NULL) {
        message_command_error("--bus: %s", error.text);
        return error.is_environment ? STATUS_ENVIRONMENT : STATUS_INPUT;
    }
    frame_bits_init(&field->traffic.tables);
    field->traffic.times = frame_bits_times(&rates);
    link_observe(field->link, &(struct wire_listener){count_frame, &field->traffic});
    bus_return_init(&field->way_back, bus, &config);
    lockstep_init(&field->lockstep, field->link, field->cycle_ns, nodes, count);
    field->port = lockstep_get_port(&field->lockstep);
    return STATUS_DONE;
}

static void start_steppers(struct field *field, const struct machine_setup *setup)
{
    struct virtual_stepper_config config[AXIS_COUNT];

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        config[i] = setup->stepper[i];
        config[i].present = machine_axis_is_stepped(&setup->machine.axis[i]);
    }
    virtual_steppers_init(&field->steppers, config, (uint32_t)field->cycle_ns);
}

static void start_pace(struct field *field)
{
    field->is_paced = true;
    field->permission = pace_ask_permission();
    pace_start(&field->pace, field->cycle_ns);
}

enum command_status field_open(struct field *field, const struct machine_setup *setup,
                               const struct field_options *options)
{
    enum command_status status = STATUS_DONE;

    memset(field, 0, sizeof *field);
    field->cycle_ns = (uint64_t)setup->machine.cycle_us * 1000;
    field->script = options->script;
    field->returns = options->returns;
    start_steppers(field, setup);
    if (is_outside(options))
        status = open_outside(field, setup, options->bus);
    else if (!open_inside(field, setup))
        status = STATUS_INPUT;
    if (status == STATUS_DONE && options->is_paced)
        start_pace(field);
    if (status != STATUS_DONE)
        field_close(field);
    return status;
}

void field_close(struct field *field)
{
    bus_return_stop(&field->way_back);
    link_close(field->link);
    field->link = NULL;
    for (unsigned i = 0; i < DATA_SHEETS_MAX; i++)
        dictionary_free(&field->sheet[i]);
}

void field_watch_drives(struct field *field, const struct drives *drives)
{
    field->lockstep.drives = drives;
}

struct can_port field_get_port(struct field *field)
{
    return field->port;
}

struct step_port field_get_step_port(struct field *field)
{
    return virtual_steppers_get_port(&field->steppers);
}

static void end_inside(struct field *field)
{
    bus_run_until(&field->bus, field->cycles * field->cycle_ns);
    virtual_drives_step(&field->drives, (uint32_t)field->cycle_ns);
    if (field->script != NULL && !field->has_enabled_faults)
        add_enabled_faults(field);
}

/* The controller's port stays the same; what comes over it is new. */
static void take_back(struct field *field, struct link *link)
{
    link_close(field->link);
    field->link = link;
    field->is_lost = false;
    link_observe(link, &(struct wire_listener){count_frame, &field->traffic});
    lockstep_set_link(&field->lockstep, link);
    message_command_warning("the bus is back: %s", field->way_back.spec);
}

static void look_for_bus(struct field *field)
{
    struct link *link;

    if (!field->is_lost)
        message_command_warning("%s; it is looked for", link_get_problem(field->link));
    field->is_lost = true;
    link = bus_return_look(&field->way_back, link_clock_ns());
    if (link != NULL)
        take_back(field, link);
}

static bool end_paced(struct field *field)
{
    bool good = true;

    if (field->link == NULL)
        end_inside(field);
    uint64_t next_ns = pace_end_work(&field->pace);
    if (field->link != NULL)
        good = lockstep_end_cycle_at(&field->lockstep, next_ns);
    pace_sleep(&field->pace);
    pace_begin_cycle(&field->pace);
    if (!good && field->returns)
        look_for_bus(field);
    return good || field->returns;
}

static void tell_warning(struct field *field)
{
    char text[LOCKSTEP_TEXT_MAX + 1];

    if (lockstep_take_warning(&field->lockstep, text))
        message_command_warning("%s", text);
}

bool field_end_cycle(struct field *field)
{
    bool good = true;

    field->cycles++;
    virtual_steppers_end_cycle(&field->steppers);
    if (field->is_paced)
        good = end_paced(field);
    else if (field->link != NULL)
        good = lockstep_end_cycle(&field->lockstep);
    else
        end_inside(field);
    if (field->link != NULL)
        tell_warning(field);
    return good;
}

bool field_is_lost(const struct field *field)
{
    return field->link != NULL && link_get_problem(field->link)[0] != '\0';
}

const char *field_get_problem(const struct field *field)
{
    return field_is_lost(field) ? link_get_problem(field->link) : NULL;
}

void field_observe_outside(struct field *field, const struct wire_listener *listener)
{
    field->traffic.next = *listener;
}

uint64_t field_get_frames(const struct field *field)
{
    return field->link == NULL ? field->bus.counts.frames : field->traffic.frames;
}

double field_get_load_percent(const struct field *field)
{
    if (field->link == NULL)
        return bus_load_percent(&field->bus);
    if (field->cycles == 0)
        return 0;
    return 100.0 * (double)field->traffic.busy_ns / (double)(field->cycles * field->cycle_ns);
}
