#include "studies/tune_drive.h"

#include "base/maths.h"
#include "canopen/nmt.h"
#include "tuning/loop_object.h"

/* Cycles in which it comes to be enabled. */
#define ENABLE_CYCLES 100

/* Nobody else is on the bus. */
static bool send(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return true;
}

static bool receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

bool tune_drive_read(struct tune_drive *drive, uint16_t index, uint8_t sub, unsigned bits,
                     uint32_t *value)
{
    return virtual_drive_read_object(&drive->drive, PDO_MAPPED(index, sub, bits), value);
}

bool tune_drive_write(struct tune_drive *drive, uint16_t index, uint8_t sub, unsigned bits,
                      uint32_t value)
{
    return virtual_drive_write_object(&drive->drive, PDO_MAPPED(index, sub, bits), value);
}

bool tune_drive_start(struct tune_drive *drive, int8_t mode)
{
    static const uint16_t controlwords[] = {CIA402_SHUTDOWN, CIA402_SWITCH_ON,
                                            CIA402_ENABLE_OPERATION};
    const struct can_port port = {.send = send, .receive = receive, .context = drive};
    const struct can_frame start = {.length = 2, .data = {NMT_START, drive->config.node}};

    drive->config.boot_us = 0;
    virtual_drive_init(&drive->drive, &drive->config, NULL, &port);
    virtual_drive_boot(&drive->drive);
    virtual_drive_on_frame(&drive->drive, &start);
    if (!tune_drive_write(drive, 0x6060, 0, 8, (uint8_t)mode))
        return false;
    for (unsigned i = 0; i < ENABLE_CYCLES && !tune_drive_is_enabled(drive); i++) {
        const unsigned next = i < 2 ? i : 2;

        (void)tune_drive_write(drive, 0x6040, 0, 16, controlwords[next]);
        tune_drive_cycle(drive);
    }
    return tune_drive_is_enabled(drive);
}

bool tune_drive_get_gains(struct tune_drive *drive, struct tuning_gains *gains)
{
    for (unsigned i = 0; i < LOOP_NUMBERS; i++) {
        uint32_t value;

        if (!tune_drive_read(drive, LOOP_OBJECT, (uint8_t)(i + 1), 8 * loop_number[i].bytes,
                             &value))
            return false;
        loop_object_take(gains, i, value);
    }
    return true;
}

bool tune_drive_set_gains(struct tune_drive *drive, const struct tuning_gains *gains)
{
    for (unsigned i = 0; i < LOOP_NUMBERS; i++) {
        if (!tune_drive_write(drive, LOOP_OBJECT, (uint8_t)(i + 1), 8 * loop_number[i].bytes,
                              loop_object_of(gains, i)))
            return false;
    }
    return true;
}

static double sign_of(const struct tune_drive *drive)
{
    return drive->config.increments_per_mm < 0 ? -1 : 1;
}

void tune_drive_push(struct tune_drive *drive, int32_t torque)
{
    const int32_t told = (int32_t)(sign_of(drive) * torque);

    (void)tune_drive_write(drive, 0x6071, 0, 16, (uint16_t)(int16_t)told);
}

void tune_drive_aim(struct tune_drive *drive, double position)
{
    const double increments = takt_maths_round(position * drive->config.increments_per_mm);

    (void)tune_drive_write(drive, 0x607A, 0, 32, (uint32_t)(int32_t)increments);
}

void tune_drive_cycle(struct tune_drive *drive)
{
    const struct can_frame sync = {.id = 0x80};

    virtual_drive_on_frame(&drive->drive, &sync);
    virtual_drive_step(&drive->drive, drive->cycle_ns);
}

double tune_drive_position(struct tune_drive *drive)
{
    uint32_t value = 0;

    (void)tune_drive_read(drive, 0x6064, 0, 32, &value);
    return (int32_t)value / drive->config.increments_per_mm;
}

bool tune_drive_is_enabled(const struct tune_drive *drive)
{
    return virtual_drive_get_state(&drive->drive) == CIA402_ENABLED;
}
