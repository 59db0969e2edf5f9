#include "simulation/field.h"

#include "base/maths.h"
#include "cli/message.h"
#include "config/data_sheet.h"
#include "drives/dictionary_read.h"
#include "simulation/inject_bus.h"

#include <stdio.h>
#include <string.h>

/* The next of several addresses. False: there is none. */
static bool next_address(const char **list, char address[FIELD_ADDRESS_MAX + 1])
{
    const char *at = *list;

    if (at == NULL)
        return false;
    const char *comma = strchr(at, ',');
    const size_t length = comma != NULL ? (size_t)(comma - at) : strlen(at);

    (void)snprintf(address, FIELD_ADDRESS_MAX + 1, "%.*s", (int)length, at);
    *list = comma != NULL ? comma + 1 : NULL;
    return true;
}

static bool is_outside(const struct field_options *options)
{
    char address[FIELD_ADDRESS_MAX + 1];
    enum link_kind kind = LINK_EMBEDDED;
    struct link_error error;
    const char *list = options->bus;

    return next_address(&list, address) && link_check(address, &kind, &error) &&
           kind != LINK_EMBEDDED;
}

static bool check_bus(const char *list)
{
    char address[FIELD_ADDRESS_MAX + 1];
    const bool is_single = list == NULL || strchr(list, ',') == NULL;
    enum link_kind kind;
    struct link_error error;

    while (next_address(&list, address)) {
        if (!link_check(address, &kind, &error)) {
            message_command_error("--bus: %s", error.text);
            return false;
        }
        if (kind == LINK_EMBEDDED && !is_single) {
            message_command_error("--bus: embedded are all buses, or none: it stands alone");
            return false;
        }
    }
    return true;
}

/* Where the drives are images, and nowhere else, their file is given. */
static bool check_images(const struct field_options *options)
{
    const char *drives = options->drives;
    const bool has_images = drives != NULL && drive_image_is_known(drives);

    if (drives != NULL && !has_images && strcmp(drives, "internal") != 0 &&
        strcmp(drives, "external") != 0) {
        message_command_error("--drives %s: internal, external, or m4f or m7 is expected", drives);
        return false;
    }
    if (has_images == (options->drive_image != NULL))
        return true;
    message_command_error("--drives m4f or m7 and --drive-image belong together; host/run --drives "
                          "NAME builds the image and gives both");
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
    if (!check_images(options))
        return false;
    if (drives == NULL)
        return true;
    if (strcmp(drives, "external") == 0 && !is_outside(options)) {
        message_command_error("--drives external needs a bus that other processes can reach: "
                              "--bus socketcan:can0, slcan:PATH or socketcand:HOST:PORT");
        return false;
    }
    if (strcmp(drives, "external") != 0 && is_outside(options)) {
        message_command_error("--drives %s are on the embedded bus; with --bus %s they are "
                              "external, a process of `takt drives` or real ones",
                              drives, options->bus);
        return false;
    }
    return true;
}

/* Faults of the buses whose time counts from this anchor. */
static bool add_faults(struct field *field, const struct inject *script, enum inject_anchor anchor,
                       uint64_t anchor_ns)
{
    bool good = true;

    for (unsigned i = 0; i < field->buses && good; i++) {
        uint8_t nodes[VIRTUAL_DRIVES_MAX];
        const unsigned count = virtual_drives_on_bus(&field->drives, i, nodes);

        good = inject_bus_add(&field->bus[i], i, script, anchor, anchor_ns, nodes, count);
    }
    return good;
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

static bool open_inside(struct field *field, const struct machine_setup *setup,
                        const struct field_options *options)
{
    struct virtual_drives_config drives;

    const struct frame_rates rates = machine_setup_get_rates(&setup->machine);

    for (unsigned i = 0; i < field->buses; i++) {
        (void)bus_init_rates(&field->bus[i], &rates); /* checked with the machine */
        field->can.port[i] = bus_attach(&field->bus[i], NULL);
    }
    if (!data_sheet_set_machine(&drives, setup, field->sheet))
        return false;
    if (options->drive_image != NULL &&
        !drive_images_open(&field->images, options->drives, options->drive_image, &drives))
        return false;
    virtual_drives_init(&field->drives, field->bus, &drives);
    return start_faults(field);
}

static void count_frame(void *context, const struct wire_frame *frame, uint64_t time_ns)
{
    struct field_link *outside = context;

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

static enum command_status open_link(struct field *field, const struct machine_setup *setup,
                                     unsigned bus)
{
    struct field_link *outside = &field->outside[bus];
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
    lockstep_init(&outside->lockstep, outside->link, bus, field->cycle_ns, nodes, count);
    field->can.port[bus] = lockstep_get_port(&outside->lockstep);
    return STATUS_DONE;
}

/* An address for each bus. */
static enum command_status open_outside(struct field *field, const struct machine_setup *setup,
                                        const char *list)
{
    enum command_status status = STATUS_DONE;
    char address[FIELD_ADDRESS_MAX + 1];
    unsigned count = 0;

    field->is_outside = true;
    for (; next_address(&list, address); count++) {
        if (count < field->buses)
            memcpy(field->outside[count].address, address, sizeof address);
    }
    if (count != field->buses) {
        message_command_error("--bus: %u address%s, and the machine has %u bus%s: one for each, "
                              "with commas between them",
                              count, count == 1 ? "" : "es", field->buses,
                              field->buses == 1 ? "" : "es");
        return STATUS_INPUT;
    }
    for (unsigned bus = 0; bus < field->buses && status == STATUS_DONE; bus++)
        status = open_link(field, setup, bus);
    return status;
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
    field->buses = takt_machine_bus_count(&setup->machine);
    field->cycle_ns = (uint64_t)setup->machine.cycle_us * 1000;
    field->script = options->script;
    field->returns = options->returns;
    start_steppers(field, setup);
    if (is_outside(options))
        status = open_outside(field, setup, options->bus);
    else if (!open_inside(field, setup, options))
        status = STATUS_INPUT;
    if (status == STATUS_DONE && options->is_paced)
        start_pace(field);
    if (status != STATUS_DONE)
        field_close(field);
    return status;
}

void field_close(struct field *field)
{
    for (unsigned i = 0; i < field->buses && field->is_outside; i++) {
        bus_return_stop(&field->outside[i].way_back);
        link_close(field->outside[i].link);
        field->outside[i].link = NULL;
    }
    drive_images_close(&field->images);
    for (unsigned i = 0; i < DATA_SHEETS_MAX; i++)
        dictionary_free(&field->sheet[i]);
}

void field_watch_drives(struct field *field, const struct drives *drives)
{
    for (unsigned i = 0; i < field->buses; i++)
        field->outside[i].lockstep.drives = drives;
}

struct can_buses field_get_port(struct field *field)
{
    return field->can;
}

struct step_port field_get_step_port(struct field *field)
{
    return virtual_steppers_get_port(&field->steppers);
}

static void end_inside(struct field *field)
{
    for (unsigned i = 0; i < field->buses; i++)
        bus_run_until(&field->bus[i], field->cycles * field->cycle_ns);
    virtual_drives_step(&field->drives, (uint32_t)field->cycle_ns);
    if (field->script != NULL && !field->has_enabled_faults)
        add_enabled_faults(field);
}

static bool is_gone(const struct field_link *outside)
{
    return link_get_problem(outside->link)[0] != '\0';
}

/* The controller's port stays the same; what comes over it is new. */
static void take_back(struct field_link *outside, struct link *link)
{
    link_close(outside->link);
    outside->link = link;
    outside->is_lost = false;
    link_observe(link, &(struct wire_listener){count_frame, outside});
    lockstep_set_link(&outside->lockstep, link);
    message_command_warning("the bus is back: %s", outside->way_back.spec);
}

static void look_for_bus(struct field_link *outside)
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
static bool end_outside_at(struct field *field, uint64_t next_ns)
{
    bool good = true;

    for (unsigned i = 0; i < field->buses; i++)
        good = lockstep_end_cycle_at(&field->outside[i].lockstep, next_ns) && good;
    return good;
}

static bool end_outside(struct field *field)
{
    bool good = true;

    for (unsigned i = 0; i < field->buses && good; i++)
        good = lockstep_end_cycle(&field->outside[i].lockstep);
    return good;
}

static bool end_paced(struct field *field)
{
    bool good = true;

    if (!field->is_outside)
        end_inside(field);
    uint64_t next_ns = pace_end_work(&field->pace);
    if (field->is_outside)
        good = end_outside_at(field, next_ns);
    pace_sleep(&field->pace);
    pace_begin_cycle(&field->pace);
    for (unsigned i = 0; i < field->buses && !good && field->returns; i++) {
        if (is_gone(&field->outside[i]))
            look_for_bus(&field->outside[i]);
    }
    return good || field->returns;
}

static void tell_warnings(struct field *field)
{
    char text[LOCKSTEP_TEXT_MAX + 1];

    for (unsigned i = 0; i < field->buses; i++) {
        if (lockstep_take_warning(&field->outside[i].lockstep, text))
            message_command_warning("%s", text);
    }
}

bool field_end_cycle(struct field *field)
{
    bool good = true;

    field->cycles++;
    virtual_steppers_end_cycle(&field->steppers);
    if (field->is_paced)
        good = end_paced(field);
    else if (field->is_outside)
        good = end_outside(field);
    else
        end_inside(field);
    tell_warnings(field);
    return good && drive_images_problem(&field->images) == NULL;
}

static const struct field_link *find_lost(const struct field *field)
{
    for (unsigned i = 0; i < field->buses && field->is_outside; i++) {
        if (is_gone(&field->outside[i]))
            return &field->outside[i];
    }
    return NULL;
}

bool field_is_lost(const struct field *field)
{
    return find_lost(field) != NULL;
}

void field_get_axes(const struct field *field, const struct machine *machine, struct point *at)
{
    unsigned drive = 0;

    *at = (struct point){{0}};
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (machine_axis_is_on_can(axis))
            at->at[i] = virtual_drive_get_position_mm(&field->drives.drive[drive++]);
        else if (machine_axis_is_stepped(axis))
            at->at[i] = field->steppers.axis[i].position_steps / axis->steps_per_mm;
    }
}

unsigned field_get_lost_bus(const struct field *field)
{
    return (unsigned)(find_lost(field) - field->outside);
}

const char *field_get_problem(struct field *field)
{
    const struct field_link *lost = find_lost(field);

    return lost != NULL ? link_get_problem(lost->link) : drive_images_problem(&field->images);
}

void field_log(struct field *field, struct frame_buffer *frames, struct candump *log)
{
    for (unsigned i = 0; i < field->buses; i++)
        field->outside[i].log = log;
    if (!field->is_outside)
        frame_buffer_attach(frames, field->bus, field->buses, log);
}

void field_clear_responses(struct field *field)
{
    for (unsigned i = 0; i < field->buses && !field->is_outside; i++)
        bus_clear_responses(&field->bus[i]);
}

void field_end_responses(struct field *field)
{
    for (unsigned i = 0; i < field->buses && !field->is_outside; i++)
        bus_end_responses(&field->bus[i]);
}

bool field_is_sound(const struct field *field)
{
    bool is_sound = true;

    for (unsigned i = 0; i < field->buses; i++)
        is_sound = is_sound && field->bus[i].fault_count == 0;
    return is_sound;
}

uint64_t field_get_frames(const struct field *field, unsigned bus)
{
    return field->is_outside ? field->outside[bus].frames : field->bus[bus].counts.frames;
}

double field_get_load_percent(const struct field *field, unsigned bus)
{
    if (!field->is_outside)
        return bus_load_percent(&field->bus[bus]);
    if (field->cycles == 0)
        return 0;
    return 100.0 * (double)field->outside[bus].busy_ns / (double)(field->cycles * field->cycle_ns);
}

double field_get_highest_load_percent(const struct field *field)
{
    double highest = 0;

    for (unsigned i = 0; i < field->buses; i++)
        highest = maths_max(highest, field_get_load_percent(field, i));
    return highest;
}
