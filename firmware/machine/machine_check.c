#include "machine/machine_check.h"

#include "base/assert.h"
#include "base/maths.h"
#include "canopen/node.h"
#include "classic/classic.h"
#include "classic/interpolator.h"
#include "classic/limiter.h"
#include "drive/drives.h"
#include "hal/outputs.h"

#define DEGREE (MATHS_PI / 180.0)
#define PER_US 1e-6
#define RANGE  2147483647.0 /* of 32 bits */

/*
 * Setpoints are doubles: X mm from zero they are rounded, and differences over a cycle t turn that
 * into noise of up to 4.5e-16 X / t^2 in acceleration and 9e-16 X / t^3 in jerk. The limits are
 * kept to 1e-4 and 1e-3 of themselves, so they must stand that far above the noise.
 */
#define ROUNDING_ACCELERATION 5e-12
#define ROUNDING_JERK         1e-12

/* An axis of the machine; what its numbers are in a machine file: mm, or degrees. */
struct checked {
    const struct machine_axis *axis;
    char letter;
    double unit; /* of the file, in mm or rad */
    double farthest_mm;
    struct diagnostic *wrong;
};

static bool refuse(const struct checked *c, enum takt_error code, double value, double limit)
{
    TAKT_ASSERT(code != TAKT_OK);
    takt_diagnostic_set(c->wrong, code, 0, 0, &c->letter, 1, value);
    takt_diagnostic_set_limit(c->wrong, limit);
    return false;
}

static bool check_travel(const struct checked *c)
{
    const struct machine_axis *axis = c->axis;
    const double increments = maths_abs(axis->increments_per_mm);

    if (axis->travel_min_mm >= axis->travel_max_mm)
        return refuse(c, TAKT_ERROR_MACHINE_TRAVEL, 0, 0);
    if (axis->travel_min_mm > 0 || axis->travel_max_mm < 0)
        return refuse(c, TAKT_ERROR_MACHINE_TRAVEL_ZERO, 0, 0);
    if (increments <= 0 || c->farthest_mm * increments > RANGE)
        return refuse(c, TAKT_ERROR_MACHINE_INCREMENTS, axis->increments_per_mm * c->unit, 0);
    return true;
}

static bool check_limits(const struct checked *c, double cycle_s)
{
    const double acceleration = ROUNDING_ACCELERATION * c->farthest_mm / (cycle_s * cycle_s);
    const double jerk = ROUNDING_JERK * c->farthest_mm / (cycle_s * cycle_s * cycle_s);

    TAKT_ASSERT(cycle_s > 0.0);
    if (c->axis->max_acceleration_mm_s2 < acceleration)
        return refuse(c, TAKT_ERROR_MACHINE_ACCELERATION, acceleration / c->unit, 0);
    if (c->axis->max_jerk_mm_s3 < jerk)
        return refuse(c, TAKT_ERROR_MACHINE_JERK, jerk / c->unit, 0);
    return true;
}

static bool check_steps(const struct checked *c)
{
    const double rate_hz = c->axis->max_velocity_mm_s * c->axis->steps_per_mm;

    if (!machine_axis_is_stepped(c->axis))
        return true;
    if (rate_hz > c->axis->step_rate_max_hz * (1 + 1e-9))
        return refuse(c, TAKT_ERROR_MACHINE_STEP_RATE, rate_hz, c->axis->step_rate_max_hz);
    if (c->farthest_mm * c->axis->steps_per_mm > RANGE)
        return refuse(c, TAKT_ERROR_MACHINE_STEPS, 0, 0);
    return true;
}

static bool check_home(const struct checked *c)
{
    if (c->axis->home_method == 0)
        return refuse(c, TAKT_ERROR_MACHINE_HOME_METHOD, 0, 0);
    return maths_abs(c->axis->home_offset_mm * c->axis->increments_per_mm) <= RANGE ||
           refuse(c, TAKT_ERROR_MACHINE_HOME, 0, 0);
}

/* Each node id once on a bus, and none the controller's own. */
static bool check_node(const struct checked *c, const struct machine *machine, unsigned number)
{
    const uint8_t node = c->axis->drive_node;

    TAKT_ASSERT(number < AXIS_COUNT);
    for (unsigned i = 0; i < number; i++) {
        if (machine->axis[i].present && machine->axis[i].drive_node == node &&
            machine->axis[i].drive_bus == c->axis->drive_bus) {
            const char both[] = {AXIS_LETTERS[i], ' ', 'a', 'n', 'd', ' ', c->letter};

            takt_diagnostic_set(c->wrong, TAKT_ERROR_MACHINE_NODES, 0, 0, both, sizeof both, node);
            return false;
        }
    }
    return node != machine->controller_node ||
           refuse(c, TAKT_ERROR_MACHINE_CONTROLLER_NODE, node, 0);
}

static bool check_axis(const struct machine *machine, unsigned i, struct diagnostic *wrong)
{
    const struct machine_axis *axis = &machine->axis[i];
    const struct checked c = {
        .axis = axis,
        .letter = AXIS_LETTERS[i],
        .unit = axis->rotary ? DEGREE : 1.0,
        .farthest_mm = maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm)),
        .wrong = wrong,
    };

    TAKT_ASSERT(i < AXIS_COUNT);
    return check_travel(&c) && check_limits(&c, PER_US * (double)machine->cycle_us) &&
           check_steps(&c) && check_home(&c) && check_node(&c, machine, i);
}

/* "io 2". */
static bool refuse_io(const struct machine *machine, unsigned number, enum takt_error code,
                      struct diagnostic *wrong)
{
    const char name[] = {'i', 'o', ' ', (char)('1' + number)};

    TAKT_ASSERT(number < IO_NODES_MAX);
    takt_diagnostic_set(wrong, code, 0, 0, name, sizeof name, machine->io[number].node);
    return false;
}

static bool is_wired_well(const struct io_wiring *wiring)
{
    bool good = true;

    for (unsigned i = 0; i < IO_BITS_MAX; i++)
        good = good && io_is_output(wiring->output[i]) && io_is_input(wiring->input[i]);
    for (unsigned i = 0; i < IO_ANALOGUE_MAX; i++)
        good = good && io_get_analogue(wiring, i) <= OUTPUTS_ANALOGUE_MAX;
    return good;
}

static bool is_axis_node(const struct machine *machine, unsigned bus, unsigned node)
{
    bool is_one = false;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        is_one = is_one || (axis->present && axis->drive_node == node && axis->drive_bus == bus);
    }
    return is_one;
}

/* Is it the node of the second drive of one of the first gantries? */
static bool is_gantry_node(const struct machine *machine, unsigned count, unsigned bus,
                           unsigned node)
{
    bool is_one = false;

    for (unsigned i = 0; i < count; i++)
        is_one = is_one ||
                 (machine->gantry[i].drive_node == node && machine->gantry[i].drive_bus == bus);
    return is_one;
}

/* Its id is that of nobody else on its bus. */
static bool is_alone(const struct machine *machine, unsigned number)
{
    const struct io_wiring *io = &machine->io[number];
    bool alone = io->node != machine->controller_node &&
                 !is_axis_node(machine, io->bus, io->node) &&
                 !is_gantry_node(machine, takt_machine_gantry_count(machine), io->bus, io->node);

    TAKT_ASSERT(number < IO_NODES_MAX);
    for (unsigned i = 0; i < number; i++)
        alone = alone && !(machine->io[i].node == io->node && machine->io[i].bus == io->bus);
    return alone;
}

/* One after the other from the first on, each id once. */
static bool check_io(const struct machine *machine, struct diagnostic *wrong)
{
    const unsigned count = takt_machine_io_count(machine);

    for (unsigned i = 0; i < IO_NODES_MAX; i++) {
        const bool is_there = machine->io[i].node != 0;

        if (!is_wired_well(&machine->io[i]) || machine->io[i].node > NODE_MAX ||
            is_there != (i < count))
            return refuse_io(machine, i, TAKT_ERROR_MACHINE_IO, wrong);
        if (is_there && !is_alone(machine, i))
            return refuse_io(machine, i, TAKT_ERROR_MACHINE_IO_NODE, wrong);
    }
    return true;
}

/*
 * Its axis is one of the linear ones, on CAN; its node nobody else's but perhaps an I/O node's,
 * which check_io sees.
 */
static bool gantry_is_well(const struct machine *machine, unsigned number)
{
    const struct machine_gantry *gantry = &machine->gantry[number];
    uint8_t node[MACHINE_NODES_MAX];
    bool good = gantry->axis < AXIS_LINEAR_COUNT &&
                machine_axis_is_on_can(&machine->axis[gantry->axis]) && gantry->skew_max_mm > 0 &&
                takt_machine_drive_nodes(machine, node) <= MACHINE_DRIVES_MAX &&
                gantry->drive_node != machine->controller_node &&
                !is_axis_node(machine, gantry->drive_bus, gantry->drive_node) &&
                !is_gantry_node(machine, number, gantry->drive_bus, gantry->drive_node);

    TAKT_ASSERT(number < MACHINE_GANTRIES_MAX);
    for (unsigned i = 0; i < number; i++)
        good = good && machine->gantry[i].axis != gantry->axis;
    return good && maths_abs(gantry->home_offset_mm *
                             machine->axis[gantry->axis].increments_per_mm) <= RANGE;
}

/* On which side a maker's own method looks for a home nobody can tell. */
static bool check_gantry_home(const struct machine *machine, unsigned number,
                              struct diagnostic *wrong)
{
    const struct machine_gantry *gantry = &machine->gantry[number];

    TAKT_ASSERT(number < MACHINE_GANTRIES_MAX);
    if (gantry->is_reversed == 0 || gantry->home_method != 0 ||
        machine->axis[gantry->axis].home_method > 0)
        return true;
    takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_GANTRY_HOME, 0, 0, &AXIS_LETTERS[gantry->axis], 1,
                        0);
    return false;
}

/* One after the other from the first on. */
static bool check_gantries(const struct machine *machine, struct diagnostic *wrong)
{
    const unsigned count = takt_machine_gantry_count(machine);
    bool good = true;

    for (unsigned i = 0; i < MACHINE_GANTRIES_MAX; i++)
        good = good &&
               (i < count ? gantry_is_well(machine, i) : machine->gantry[i].axis >= AXIS_COUNT);
    if (!good)
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_GANTRY, 0, 0, "", 0, MACHINE_DRIVES_MAX);
    for (unsigned i = 0; i < count && good; i++)
        good = check_gantry_home(machine, i, wrong);
    return good;
}

bool takt_machine_predict_load(const struct machine *machine, unsigned bus,
                               struct drives_load *load)
{
    uint8_t node[MACHINE_NODES_MAX];
    const struct drives_traffic traffic = {.count = takt_machine_bus_nodes(machine, bus, node),
                                           .bus = bus,
                                           .heartbeat_ms = machine->heartbeat_ms,
                                           .wiring = machine->io,
                                           .io_count = takt_machine_io_count(machine),
                                           .rates = takt_machine_get_rates(machine),
                                           .no_error_pdo = machine->error_pdo == 0};

    TAKT_ASSERT(machine->cycle_us > 0);
    return takt_drives_predict_whole_load(&traffic, machine->cycle_us, load);
}

/* Each carries its own. */
static bool check_buses(const struct machine *machine, struct diagnostic *wrong)
{
    const unsigned count = takt_machine_bus_count(machine);
    struct drives_load load;

    if (count > CAN_BUSES_MAX) {
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_BUS, 0, 0, "", 0, count - 1);
        takt_diagnostic_set_limit(wrong, CAN_BUSES_MAX - 1);
        return false;
    }
    for (unsigned bus = 0; bus < count; bus++) {
        if (!takt_machine_predict_load(machine, bus, &load)) {
            takt_drives_set_overload(&load, bus, wrong);
            return false;
        }
    }
    return true;
}

/* size: of the name with its zero */
static bool check_form(bool is_there, const char *name, size_t size, struct diagnostic *wrong)
{
    if (!is_there)
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_FORM, 0, 0, name, size - 1, 0);
    return is_there;
}

/* Not every build has all forms of interpolation and feed. */
static bool check_forms(const struct machine *machine, struct diagnostic *wrong)
{
    static const char interpolator[] = "interpolator", limiter[] = "limiter", landing[] = "landing";
    const bool all = takt_classic_is_there();

    return check_form(all || machine->interpolator == INTERPOLATOR_EXACT, interpolator,
                      sizeof interpolator, wrong) &&
           check_form(all || machine->limiter == LIMITER_CEILING, limiter, sizeof limiter, wrong) &&
           check_form(all || machine->landing != LANDING_SCALE, landing, sizeof landing, wrong);
}

/* CAN FD is of the build, and no slower than the rest of a frame. */
static bool check_rates(const struct machine *machine, struct diagnostic *wrong)
{
    const uint32_t data = machine->can_data_bitrate;

    if (data > 0 && CAN_DATA_MAX == CAN_CLASSIC_MAX)
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_FD, 0, 0, "", 0, data);
    else if (data > 0 && data < machine->can_bitrate)
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_DATA_RATE, 0, 0, "", 0, data);
    else
        return true;
    return false;
}

bool takt_machine_check(const struct machine *machine, struct diagnostic *wrong)
{
    if (takt_machine_axes(machine) == 0) {
        takt_diagnostic_set(wrong, TAKT_ERROR_MACHINE_NO_AXIS, 0, 0, "", 0, 0);
        return false;
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present && !check_axis(machine, i, wrong))
            return false;
    }
    return check_forms(machine, wrong) && check_gantries(machine, wrong) &&
           check_io(machine, wrong) && check_rates(machine, wrong) && check_buses(machine, wrong);
}
