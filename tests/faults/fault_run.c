#include "fault_run.h"

#include "bus/bus.h"
#include "controller/controller.h"
#include "drives/virtual_drives.h"
#include "inject/inject.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Object 1018:02 of virtual drives. */
#define VIRTUAL_DRIVE_PRODUCT 0x402

/* Towards the lower limit switch. */
#define HOME_METHOD    17
#define HOME_TIMEOUT_S 3

#define DRIVES 3U
#define FOURTH 4U /* node attached to the bus behind the drives: I/O, or second drive of Y */

/* Less than the following error that is allowed. */
#define SKEW_MAX_MM 0.5

#define OBJECT_TABLE_MAX 1024U

#define CYCLE_NS   1000000U
#define CYCLES_MAX 12000U

/* Cycles after the end of everything in which an axis that has not been stopped would be seen. */
#define AFTER_CYCLES 1000U

/* An axis that is slower stands: 0.1 mm/s. */
#define MOVING_MM_PER_CYCLE 1e-4

/*
 * A straight line out and back at 100 mm/s and the axes' limits: the three axes have different
 * velocities, so drives that brake each for themselves leave it.
 */
static const char program[] = "G21 G90 G64 F7200 G1 X100 Y60 Z-30\nX0 Y0 Z0\nM2\n";
static const double line_mm[DRIVES] = {100, 60, -30};

struct world {
    struct bus bus;
    struct virtual_drives drives;
    struct controller controller;
    struct controller_reader reader;
    struct parameters parameters;
    struct source_text text;
    struct inject script;
    struct inject_clock clock;
    bool is_on_bus[INJECT_FAULTS_MAX]; /* the bus has been told of this fault */
    uint64_t fault_ns; /* when the first fault begins; INJECT_ALWAYS: not known yet */
    double at_mm[DRIVES + 1];
};

/* Ports of the bus in the order they are attached: the controller, then the drives. */
static uint32_t ports_of(uint8_t node)
{
    if (node == INJECT_ANY_NODE)
        return 0;
    return node == INJECT_CONTROLLER ? 1U : 1U << node;
}

static enum bus_fault_kind kind_of(enum inject_kind kind)
{
    switch ((int)kind) {
    case INJECT_DROP:
        return BUS_FAULT_DROP;
    case INJECT_CORRUPT:
        return BUS_FAULT_CORRUPT;
    case INJECT_DUPLICATE:
        return BUS_FAULT_DUPLICATE;
    case INJECT_DELAY:
        return BUS_FAULT_DELAY;
    case INJECT_BUS_OFF:
        return BUS_FAULT_BUS_OFF;
    case INJECT_ERROR_PASSIVE:
        return BUS_FAULT_ERROR_PASSIVE;
    default:
        return BUS_FAULT_CUT;
    }
}

static void tell_bus(struct world *w, const struct inject_fault *fault, uint64_t from_ns)
{
    (void)bus_add_fault(&w->bus,
                        &(struct bus_fault){
                            .kind = kind_of(fault->kind),
                            .id = fault->id == INJECT_ANY_ID ? 0 : fault->id,
                            .id_mask = fault->id == INJECT_ANY_ID ? 0 : 0x7FF,
                            .ports = ports_of(fault->node),
                            .from_ns = from_ns,
                            .until_ns = fault->for_ns == INJECT_ALWAYS || fault->for_ns == 0
                                            ? 0
                                            : from_ns + fault->for_ns,
                            .skip = fault->skip,
                            .count = fault->frames == INJECT_ALL ? BUS_FAULT_ALWAYS : fault->frames,
                            .probability = fault->ratio < 1 ? fault->ratio : 0,
                            .seed = fault->seed,
                            .delay_ns = fault->by_ns,
                        });
}

static void add_io_node(struct machine *machine, struct virtual_drives_config *virtual)
{
    machine->io[0] = (struct io_wiring){
        .node = FOURTH, .output = {IO_FLOOD}, .input = {IO_STOP, IO_LIMIT, IO_PROGRAM}};
    virtual->drive[virtual->count] = virtual->drive[0];
    virtual->drive[virtual->count].node = FOURTH;
    virtual->drive[virtual->count].is_io = true;
    virtual->drive[virtual->count].closed = 3;
    virtual->count++;
}

static void add_second_drive(struct machine *machine, struct virtual_drives_config *virtual)
{
    machine->gantry[0].axis = AXIS_Y;
    machine->gantry[0].drive_node = FOURTH;
    machine->gantry[0].skew_max_mm = SKEW_MAX_MM;
    virtual->drive[virtual->count] = virtual->drive[AXIS_Y];
    virtual->drive[virtual->count++].node = FOURTH;
}

/* Their dictionary without a heartbeat (1017) and without watching one (1016). */
static void take_heartbeats(struct virtual_drives_config *virtual)
{
    static struct object_row rows[OBJECT_TABLE_MAX];
    static struct dictionary mute;
    mute = takt_dictionary_own;
    mute.row = rows;
    mute.count = 0;
    for (unsigned i = 0; i < takt_dictionary_own.count; i++)
        if (takt_dictionary_own.row[i].index != 0x1016 &&
            takt_dictionary_own.row[i].index != 0x1017)
            rows[mute.count++] = takt_dictionary_own.row[i];
    for (unsigned i = 0; i < DRIVES; i++)
        virtual->drive[i].dictionary = &mute;
}

/* Beginnings of faults become known with the moment the drives are enabled. */
static void place_faults(struct world *w)
{
    for (unsigned i = 0; i < w->script.count; i++) {
        const struct inject_fault *fault = &w->script.fault[i];
        uint64_t anchor_ns = fault->anchor == INJECT_POWER ? 0 : w->clock.enabled_ns;
        if (w->is_on_bus[i] || anchor_ns == INJECT_ALWAYS)
            continue;
        w->is_on_bus[i] = true;
        if (w->fault_ns > anchor_ns + fault->after_ns)
            w->fault_ns = anchor_ns + fault->after_ns;
        if (inject_is_of_bus(fault->kind))
            tell_bus(w, fault, anchor_ns + fault->after_ns);
    }
}

static void open_world(struct world *w, const struct fault_case *fault)
{
    struct virtual_drives_config virtual;
    struct machine machine;
    struct controller_config config = {.machine = &machine,
                                       .reader = &w->reader,
                                       .parameters = &w->parameters,
                                       .exact_path = true};
    virtual_drives_set_default(&virtual, DRIVES);
    takt_machine_set_default(&machine);
    for (unsigned i = 0; i < DRIVES; i++)
        machine.axis[i].drive_product = VIRTUAL_DRIVE_PRODUCT;
    if (fault->machine == FAULT_HOMED) {
        machine.axis[AXIS_X].home_order = 1;
        machine.axis[AXIS_X].home_method = HOME_METHOD;
        machine.axis[AXIS_X].home_timeout_s = HOME_TIMEOUT_S;
    }
    if (fault->machine == FAULT_WITH_IO)
        add_io_node(&machine, &virtual);
    if (fault->machine == FAULT_GANTRY)
        add_second_drive(&machine, &virtual);
    if (fault->machine == FAULT_GUARDED)
        take_heartbeats(&virtual);
    (void)bus_init(&w->bus, machine.can_bitrate);
    config.can = can_single(bus_attach(&w->bus, NULL));
    virtual_drives_init(&w->drives, &w->bus, &virtual);
    for (unsigned i = 0; i < w->drives.count; i++)
        virtual_drive_inject(&w->drives.drive[i], &w->script, &w->clock);
    takt_parameters_clear(&w->parameters);
    takt_source_open_text(&config.source, &w->text, program, sizeof program - 1);
    takt_controller_init(&w->controller, &config);
    w->clock.enabled_ns = INJECT_ALWAYS;
    w->fault_ns = INJECT_ALWAYS;
}

static void cycle(struct world *w)
{
    const struct inputs inputs = inputs_idle();
    place_faults(w);
    takt_controller_background(&w->controller);
    takt_controller_cycle(&w->controller, &inputs);
    if (w->clock.enabled_ns == INJECT_ALWAYS &&
        takt_controller_get_state(&w->controller) == CONTROLLER_RUNNING)
        w->clock.enabled_ns = w->clock.now_ns;
    w->clock.now_ns += CYCLE_NS;
    bus_run_until(&w->bus, w->clock.now_ns);
    virtual_drives_step(&w->drives, CYCLE_NS);
}

/*
 * Distance of the tool from the straight line through 0: |p - (p u) u| with u the line's direction.
 */
static double distance_mm(const double at_mm[DRIVES])
{
    double length2 = 0, along = 0, distance2 = 0;
    for (unsigned i = 0; i < DRIVES; i++) {
        length2 += line_mm[i] * line_mm[i];
        along += at_mm[i] * line_mm[i];
    }
    for (unsigned i = 0; i < DRIVES; i++) {
        double off_mm = at_mm[i] - along / length2 * line_mm[i];
        distance2 += off_mm * off_mm;
    }
    return sqrt(distance2);
}

/* Way of the fastest axis in the cycle just made. */
static double observe(struct world *w, struct fault_result *result)
{
    double fastest_mm = 0;
    for (unsigned i = 0; i < w->drives.motors; i++) {
        double now_mm = virtual_drive_get_position_mm(&w->drives.drive[i]);
        fastest_mm = fmax(fastest_mm, fabs(now_mm - w->at_mm[i]));
        w->at_mm[i] = now_mm;
    }
    if (w->clock.now_ns <= w->fault_ns)
        return fastest_mm;
    result->off_mm = fmax(result->off_mm, distance_mm(w->at_mm));
    if (fastest_mm > MOVING_MM_PER_CYCLE)
        result->stop_ms = 1e-6 * (double)(w->clock.now_ns - w->fault_ns);
    return fastest_mm;
}

static void note_alarm(const struct world *w, struct fault_result *result)
{
    enum drives_state state = drives_get_state(&w->controller.drives);
    if (state > DRIVES_ENABLED && result->alarm_ms == 0 && w->clock.now_ns > w->fault_ns)
        result->alarm_ms = 1e-6 * (double)(w->clock.now_ns - w->fault_ns);
}

bool fault_run(const struct fault_case *fault, struct fault_result *result)
{
    static struct world world;
    struct world *w = &world;
    struct inject_error error;
    memset(w, 0, sizeof *w);
    memset(result, 0, sizeof *result);
    if (!inject_read(&w->script, fault->script, strlen(fault->script), &error)) {
        (void)snprintf(result->text, sizeof result->text, "%u:%u: %.150s", (unsigned)error.line,
                       (unsigned)error.column, error.text);
        return false;
    }
    open_world(w, fault);
    for (unsigned k = 0, after = 0; k < CYCLES_MAX && after < AFTER_CYCLES; k++) {
        cycle(w);
        result->end_mm_s = 1e9 / CYCLE_NS * observe(w, result);
        note_alarm(w, result);
        after += takt_controller_get_state(&w->controller) >= CONTROLLER_COMPLETED;
    }
    result->completed = takt_controller_get_state(&w->controller) == CONTROLLER_COMPLETED;
    result->alarm = *takt_controller_get_fault(&w->controller);
    if (result->alarm.code != TAKT_OK)
        (void)takt_diagnostic_text(&result->alarm, result->text);
    return true;
}
