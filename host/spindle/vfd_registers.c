#include "spindle/vfd_registers.h"

#include "base/maths.h"
#include "vfd/vfd.h"

#include <string.h>

/* What it says of itself: model, rated current 0.1 A, version, rated voltage 0.1 V. */
#define MODEL_AT         0x0000
#define RATED_CURRENT_AT 0x0001
#define VERSION_AT       0x0006
#define MAX_FREQUENCY_AT 0x0100
#define RATED_VOLTAGE_AT 0x0102
#define MODEL            11
#define RATED_CURRENT    100
#define VERSION          310
#define RATED_VOLTAGE    2200

/* Monitoring registers, of which those that are not ours read 0. */
#define MONITOR_FIRST VFD_ERROR
#define MONITOR_LAST  0x211F
#define VOLTAGE_AT    0x2106

#define HZ_PER_COUNT 0.01
#define WORD_MAX     65535.0

void vfd_registers_init(struct vfd_registers *registers,
                        const struct virtual_spindle_config *config)
{
    memset(registers, 0, sizeof *registers);
    virtual_spindle_init(&registers->spindle, config);
    registers->pole_pairs = 1.0;
    registers->command = VFD_STOP;
}

/* rpm = 60 f / pole pairs */
static double commanded_rpm(const struct vfd_registers *r)
{
    const double rpm = (double)r->frequency * HZ_PER_COUNT * 60.0 / r->pole_pairs;

    if (r->command == VFD_FORWARD)
        return rpm;
    return r->command == VFD_REVERSE ? -rpm : 0.0;
}

void vfd_registers_step(struct vfd_registers *r, double dt_s)
{
    const double cut_nm = 0.001 * (double)r->cut * r->spindle.config.rated_torque_nm;

    r->feedback = virtual_spindle_step(&r->spindle, dt_s, commanded_rpm(r), cut_nm);
}

static uint16_t word_of(double value)
{
    return (uint16_t)maths_clamp(takt_maths_round(value), 0.0, WORD_MAX);
}

static uint16_t frequency_of(const struct vfd_registers *r, double rpm)
{
    return word_of(maths_abs(rpm) / 60.0 * r->pole_pairs / HZ_PER_COUNT);
}

static uint16_t status(const struct vfd_registers *r)
{
    const bool runs = r->command != VFD_STOP;
    const bool turns = frequency_of(r, r->feedback.speed_rpm) > 0;
    uint16_t word = VFD_FREQUENCY_REMOTE | VFD_COMMAND_REMOTE;

    if (runs)
        word |= VFD_RUNS;
    else if (turns)
        word |= VFD_STOPS;
    if (r->feedback.speed_rpm < 0.0 && turns)
        word |= VFD_TURNS_REVERSE;
    if (r->command == VFD_REVERSE)
        word |= VFD_REVERSE_ORDERED;
    return word;
}

static uint16_t monitor(const struct vfd_registers *r, uint16_t address)
{
    switch (address) {
    case VFD_ERROR:
        return (uint16_t)r->spindle.trip;
    case VFD_STATUS:
        return status(r);
    case VFD_COMMANDED:
        return r->frequency;
    case VFD_OUTPUT:
        return frequency_of(r, r->feedback.speed_rpm);
    case VFD_CURRENT:
        return word_of(RATED_CURRENT * 0.01 * r->feedback.load_percent);
    case VOLTAGE_AT:
        return word_of(RATED_VOLTAGE * maths_abs(r->feedback.speed_rpm) /
                       r->spindle.config.max_rpm);
    case VFD_TORQUE:
        return word_of(10.0 * r->feedback.load_percent);
    case VFD_RPM:
        return word_of(maths_abs(r->feedback.speed_rpm));
    default:
        return 0;
    }
}

/* False: there is no such register. */
static bool read_word(const struct vfd_registers *r, uint16_t address, uint16_t *word)
{
    static const struct {
        uint16_t address, word;
    } fixed[] = {
        {MODEL_AT, MODEL},     {RATED_CURRENT_AT, RATED_CURRENT},
        {VERSION_AT, VERSION}, {RATED_VOLTAGE_AT, RATED_VOLTAGE},
        {VFD_CONTROL, 0},      {SPINDLE_TRIP, 0},
    };

    for (unsigned i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        *word = fixed[i].word;
        if (address == fixed[i].address)
            return true;
    }
    if (address >= MONITOR_FIRST && address <= MONITOR_LAST)
        *word = monitor(r, address);
    else if (address == MAX_FREQUENCY_AT)
        *word = frequency_of(r, r->spindle.config.max_rpm);
    else if (address == VFD_COMMAND)
        *word = r->command;
    else if (address == VFD_FREQUENCY)
        *word = r->frequency;
    else if (address == SPINDLE_CUT)
        *word = r->cut;
    else
        return false;
    return true;
}

static enum modbus_exception read_map(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    const struct vfd_registers *r = context;

    if (table != MODBUS_HOLDINGS)
        return MODBUS_FUNCTION;
    for (unsigned i = 0; i < count; i++) {
        uint16_t word;

        if (!read_word(r, (uint16_t)(address + i), &word))
            return MODBUS_ADDRESS;
        modbus_write16(data + (size_t)2 * i, word);
    }
    return MODBUS_GOOD;
}

/*
 * Bits 1 and 0: 01 stop, 10 run, 00 as before; bits 5 and 4: 01 forward, 10 reverse, 00 as before.
 */
static uint16_t command_of(const struct vfd_registers *r, uint16_t word)
{
    const bool runs = (word & 3U) == 0 ? r->command != VFD_STOP : (word & 3U) == 2;
    const bool reverse = (word & 0x30U) == 0 ? r->command == VFD_REVERSE : (word & 0x30U) == 0x20U;

    if (!runs)
        return VFD_STOP;
    return reverse ? VFD_REVERSE : VFD_FORWARD;
}

static void write_word(struct vfd_registers *r, uint16_t address, uint16_t word)
{
    if (address == VFD_COMMAND)
        r->command = command_of(r, word);
    else if (address == VFD_FREQUENCY)
        r->frequency = word;
    else if (address == VFD_CONTROL && (word & VFD_RESET) != 0)
        virtual_spindle_set_trip(&r->spindle, VIRTUAL_SPINDLE_GOOD);
    else if (address == SPINDLE_CUT)
        r->cut = word;
    else if (address == SPINDLE_TRIP && word != 0)
        virtual_spindle_set_trip(&r->spindle, (enum virtual_spindle_trip)word);
}

static bool is_writable(uint16_t address)
{
    return (address >= VFD_COMMAND && address <= VFD_CONTROL) || address == SPINDLE_CUT ||
           address == SPINDLE_TRIP;
}

static enum modbus_exception write_map(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    struct vfd_registers *r = context;

    if (table != MODBUS_HOLDINGS)
        return MODBUS_FUNCTION;
    for (unsigned i = 0; i < count; i++) {
        if (!is_writable((uint16_t)(address + i)))
            return MODBUS_ADDRESS;
    }
    for (unsigned i = 0; i < count; i++)
        write_word(r, (uint16_t)(address + i), modbus_read16(data + (size_t)2 * i));
    return MODBUS_GOOD;
}

struct modbus_map vfd_registers_get_map(struct vfd_registers *registers)
{
    return (struct modbus_map){.read = read_map, .write = write_map, .context = registers};
}
