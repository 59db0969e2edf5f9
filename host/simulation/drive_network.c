#include "simulation/drive_network.h"

#include "base/maths.h"
#include "cli/message.h"
#include "config/data_sheet.h"
#include "drives/dictionary_read.h"
#include "simulation/inject_bus.h"

#include <stdio.h>
#include <string.h>

/* Faults of the buses whose time counts from this anchor. */
static bool add_faults(struct drive_network *network, const struct inject *script,
                       enum inject_anchor anchor, uint64_t anchor_ns)
{
    bool good = true;

    for (unsigned i = 0; i < network->buses && good; i++) {
        uint8_t nodes[VIRTUAL_DRIVES_MAX];
        const unsigned count = virtual_drives_on_bus(&network->drives, i, nodes);

        good = inject_bus_add(&network->bus[i], i, script, anchor, anchor_ns, nodes, count);
    }
    return good;
}

static bool start_faults(struct drive_network *network)
{
    if (network->script == NULL)
        return true;
    virtual_drives_inject(&network->drives, network->script);
    return add_faults(network, network->script, INJECT_POWER, 0);
}

static void add_enabled_faults(struct drive_network *network)
{
    uint64_t enabled_ns = virtual_drives_get_clock(&network->drives)->enabled_ns;

    if (enabled_ns == INJECT_ALWAYS)
        return;
    network->has_enabled_faults = true;
    (void)add_faults(network, network->script, INJECT_ENABLED, enabled_ns);
}

bool drive_network_add_faults(struct drive_network *network, const struct inject *script,
                              unsigned first)
{
    const uint64_t enabled_ns = virtual_drives_get_clock(&network->drives)->enabled_ns;
    struct inject added = {.count = script->count - first};

    for (unsigned i = 0; i < added.count; i++)
        added.fault[i] = script->fault[first + i];
    network->script = script;
    virtual_drives_inject(&network->drives, script);
    return add_faults(network, &added, INJECT_POWER, 0) &&
           (!network->has_enabled_faults ||
            add_faults(network, &added, INJECT_ENABLED, enabled_ns));
}

static bool open_inside(struct drive_network *network, const struct machine_setup *setup,
                        const struct drive_network_options *options)
{
    struct virtual_drives_config drives;

    const struct frame_rates rates = machine_setup_get_rates(&setup->machine);

    for (unsigned i = 0; i < network->buses; i++) {
        (void)bus_init_rates(&network->bus[i], &rates); /* checked with the machine */
        network->can.port[i] = bus_attach(&network->bus[i], NULL);
    }
    if (!data_sheet_set_machine(&drives, setup, network->sheet))
        return false;
    if (options->drive_image != NULL &&
        !drive_images_open(&network->images, options->drives, options->drive_image, &drives))
        return false;
    virtual_drives_init(&network->drives, network->bus, &drives);
    return start_faults(network);
}

static void count_frame(void *context, const struct wire_frame *frame, uint64_t time_ns)
{
    struct drive_network_link *outside = context;

    if (!(frame->flags & WIRE_ERROR)) {
        outside->frames++;
        struct frame_length length = frame_bits_count_wire(&outside->tables, frame);

        length.nominal += FRAME_BITS_INTERMISSION;
        outside->busy_ns += frame_bits_ns(&outside->times, &length);
    }
    if (outside->log != NULL) {
        candump_select(outside->log, outside->bus);
        candump_wire(outside->log, frame, time_ns);
    }
}

static enum command_status open_link(struct drive_network *network,
                                     const struct machine_setup *setup, unsigned bus)
{
    struct drive_network_link *outside = &network->outside[bus];
    const struct frame_rates rates = machine_setup_get_rates(&setup->machine);
    struct link_config config = {.bitrate = rates.nominal, .data_bitrate = rates.data};
    struct link_error error;
    uint8_t nodes[MACHINE_NODES_MAX];
    const unsigned count = takt_machine_bus_nodes(&setup->machine, bus, nodes);

    outside->bus = bus;
    outside->link = link_open(outside->address, &config, &error);
    if (outside->link == NULL) {
        message_command_error("--bus: %s", error.text);
        return error.is_environment ? STATUS_ENVIRONMENT : STATUS_INPUT;
    }
    frame_bits_init(&outside->tables);
    outside->times = frame_bits_times(&rates);
    link_observe(outside->link, &(struct wire_listener){count_frame, outside});
    bus_return_init(&outside->way_back, outside->address, &config);
    lockstep_init(&outside->lockstep, outside->link, bus, network->cycle_ns, nodes, count);
    network->can.port[bus] = lockstep_get_port(&outside->lockstep);
    return STATUS_DONE;
}

/* An address for each bus. */
static enum command_status open_outside(struct drive_network *network,
                                        const struct machine_setup *setup, const char *list)
{
    enum command_status status = STATUS_DONE;
    char address[DRIVE_NETWORK_ADDRESS_MAX + 1];
    unsigned count = 0;

    network->is_outside = true;
    for (; drive_network_next_address(&list, address); count++) {
        if (count < network->buses)
            memcpy(network->outside[count].address, address, sizeof address);
    }
    if (count != network->buses) {
        message_command_error("--bus: %u address%s, and the machine has %u bus%s: one for each, "
                              "with commas between them",
                              count, count == 1 ? "" : "es", network->buses,
                              network->buses == 1 ? "" : "es");
        return STATUS_INPUT;
    }
    for (unsigned bus = 0; bus < network->buses && status == STATUS_DONE; bus++)
        status = open_link(network, setup, bus);
    return status;
}

static void start_steppers(struct drive_network *network, const struct machine_setup *setup)
{
    struct virtual_stepper_config config[AXIS_COUNT];

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        config[i] = setup->stepper[i];
        config[i].present = machine_axis_is_stepped(&setup->machine.axis[i]);
    }
    virtual_steppers_init(&network->steppers, config, (uint32_t)network->cycle_ns);
}

static void start_pace(struct drive_network *network)
{
    network->is_paced = true;
    network->permission = pace_ask_permission();
    pace_start(&network->pace, network->cycle_ns);
}

enum command_status drive_network_open(struct drive_network *network,
                                       const struct machine_setup *setup,
                                       const struct drive_network_options *options)
{
    enum command_status status = STATUS_DONE;

    network->buses = takt_machine_bus_count(&setup->machine);
    network->cycle_ns = (uint64_t)setup->machine.cycle_us * 1000;
    network->script = options->script;
    network->returns = options->returns;
    start_steppers(network, setup);
    if (drive_network_is_outside(options))
        status = open_outside(network, setup, options->bus);
    else if (!open_inside(network, setup, options))
        status = STATUS_INPUT;
    if (status == STATUS_DONE && options->is_paced)
        start_pace(network);
    if (status != STATUS_DONE)
        drive_network_close(network);
    return status;
}

void drive_network_close(struct drive_network *network)
{
    for (unsigned i = 0; i < network->buses && network->is_outside; i++) {
        bus_return_stop(&network->outside[i].way_back);
        link_close(network->outside[i].link);
        network->outside[i].link = NULL;
    }
    drive_images_close(&network->images);
    for (unsigned i = 0; i < DATA_SHEETS_MAX; i++)
        dictionary_free(&network->sheet[i]);
}

void drive_network_watch_drives(struct drive_network *network, const struct drives *drives)
{
    for (unsigned i = 0; i < network->buses; i++)
        network->outside[i].lockstep.drives = drives;
}

struct can_buses drive_network_get_port(struct drive_network *network)
{
    return network->can;
}

struct step_port drive_network_get_step_port(struct drive_network *network)
{
    return virtual_steppers_get_port(&network->steppers);
}

static void end_inside(struct drive_network *network)
{
    for (unsigned i = 0; i < network->buses; i++)
        bus_run_until(&network->bus[i], network->cycles * network->cycle_ns);
    virtual_drives_step(&network->drives, (uint32_t)network->cycle_ns);
    if (network->script != NULL && !network->has_enabled_faults)
        add_enabled_faults(network);
}

static bool is_gone(const struct drive_network_link *outside)
{
    return link_get_problem(outside->link)[0] != '\0';
}

/* The controller's port stays the same; what comes over it is new. */
static void take_back(struct drive_network_link *outside, struct link *link)
{
    link_close(outside->link);
    outside->link = link;
    outside->is_lost = false;
    link_observe(link, &(struct wire_listener){count_frame, outside});
    lockstep_set_link(&outside->lockstep, link);
    message_command_warning("the bus is back: %s", outside->way_back.spec);
}

static void look_for_bus(struct drive_network_link *outside)
{
    struct link *link;

    if (!outside->is_lost)
        message_command_warning("%s; it is looked for", link_get_problem(outside->link));
    outside->is_lost = true;
    link = bus_return_look(&outside->way_back, link_clock_ns());
    if (link != NULL)
        take_back(outside, link);
}

/* Those that are gone end at once, the others when they should. */
static bool end_outside_at(struct drive_network *network, uint64_t next_ns)
{
    bool good = true;

    for (unsigned i = 0; i < network->buses; i++)
        good = lockstep_end_cycle_at(&network->outside[i].lockstep, next_ns) && good;
    return good;
}

static bool end_outside(struct drive_network *network)
{
    bool good = true;

    for (unsigned i = 0; i < network->buses && good; i++)
        good = lockstep_end_cycle(&network->outside[i].lockstep);
    return good;
}

static bool end_paced(struct drive_network *network)
{
    bool good = true;

    if (!network->is_outside)
        end_inside(network);
    uint64_t next_ns = pace_end_work(&network->pace);
    if (network->is_outside)
        good = end_outside_at(network, next_ns);
    pace_sleep(&network->pace);
    pace_begin_cycle(&network->pace);
    for (unsigned i = 0; i < network->buses && !good && network->returns; i++) {
        if (is_gone(&network->outside[i]))
            look_for_bus(&network->outside[i]);
    }
    return good || network->returns;
}

static void tell_warnings(struct drive_network *network)
{
    char text[LOCKSTEP_TEXT_MAX + 1];

    for (unsigned i = 0; i < network->buses; i++) {
        if (lockstep_take_warning(&network->outside[i].lockstep, text))
            message_command_warning("%s", text);
    }
}

bool drive_network_end_cycle(struct drive_network *network)
{
    bool good = true;

    network->cycles++;
    virtual_steppers_end_cycle(&network->steppers);
    if (network->is_paced)
        good = end_paced(network);
    else if (network->is_outside)
        good = end_outside(network);
    else
        end_inside(network);
    if (network->is_outside)
        tell_warnings(network);
    return good && drive_images_problem(&network->images) == NULL;
}

static const struct drive_network_link *find_lost(const struct drive_network *network)
{
    for (unsigned i = 0; i < network->buses && network->is_outside; i++) {
        if (is_gone(&network->outside[i]))
            return &network->outside[i];
    }
    return NULL;
}

bool drive_network_is_lost(const struct drive_network *network)
{
    return find_lost(network) != NULL;
}

void drive_network_get_axes(const struct drive_network *network, const struct machine *machine,
                            struct point *at)
{
    unsigned drive = 0;

    *at = (struct point){{0}};
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (machine_axis_is_on_can(axis))
            at->at[i] = virtual_drive_get_position_mm(&network->drives.drive[drive++]);
        else if (machine_axis_is_stepped(axis))
            at->at[i] = network->steppers.axis[i].position_steps / axis->steps_per_mm;
    }
}

unsigned drive_network_get_lost_bus(const struct drive_network *network)
{
    return (unsigned)(find_lost(network) - network->outside);
}

const char *drive_network_get_problem(struct drive_network *network)
{
    const struct drive_network_link *lost = find_lost(network);

    return lost != NULL ? link_get_problem(lost->link) : drive_images_problem(&network->images);
}

void drive_network_log(struct drive_network *network, struct frame_buffer *frames,
                       struct candump *log)
{
    for (unsigned i = 0; i < network->buses; i++)
        network->outside[i].log = log;
    if (!network->is_outside)
        frame_buffer_attach(frames, network->bus, network->buses, log);
}

void drive_network_clear_responses(struct drive_network *network)
{
    for (unsigned i = 0; i < network->buses && !network->is_outside; i++)
        bus_clear_responses(&network->bus[i]);
}

void drive_network_end_responses(struct drive_network *network)
{
    for (unsigned i = 0; i < network->buses && !network->is_outside; i++)
        bus_end_responses(&network->bus[i]);
}

bool drive_network_is_sound(const struct drive_network *network)
{
    bool is_sound = true;

    for (unsigned i = 0; i < network->buses; i++)
        is_sound = is_sound && network->bus[i].fault_count == 0;
    return is_sound;
}

uint64_t drive_network_get_frames(const struct drive_network *network, unsigned bus)
{
    return network->is_outside ? network->outside[bus].frames : network->bus[bus].counts.frames;
}

double drive_network_get_load_percent(const struct drive_network *network, unsigned bus)
{
    if (!network->is_outside)
        return bus_load_percent(&network->bus[bus]);
    if (network->cycles == 0)
        return 0;
    return 100.0 * (double)network->outside[bus].busy_ns /
           (double)(network->cycles * network->cycle_ns);
}

double drive_network_get_highest_load_percent(const struct drive_network *network)
{
    double highest = 0;

    for (unsigned i = 0; i < network->buses; i++)
        highest = maths_max(highest, drive_network_get_load_percent(network, i));
    return highest;
}
