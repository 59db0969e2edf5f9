/*
 * A virtual drive: a drive's firmware (servo/servo.h) with a virtual motor, which scripted faults
 * may happen to. It knows a port, not a bus: whoever owns it hands in the frames and the time.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_H

#include "drives/drive_plant.h"
#include "drives/virtual_drive_twin.h"
#include "inject/inject.h"
#include "servo/servo.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* As of struct servo_config. */
struct virtual_drive_config {
    uint8_t node;
    uint8_t bus; /* of the machine that it is on */
    double increments_per_mm;
    double velocity_units_per_mm_s;
    uint32_t cycle_us;
    uint32_t boot_us;
    uint32_t sdo_us;
    bool is_fd;
    bool is_nameless;
    const struct dictionary *dictionary;
    struct drive_plant_config plant;
    bool is_io;
    uint16_t closed;
    const struct virtual_drive_twin *twin; /* must stay; NULL: the drive runs here alone */
};

/* Private. */
struct drive_faults {
    const struct inject *script;
    const struct inject_clock *clock;
    uint64_t in_force; /* bit i: fault i of the script has begun and not ended */
    uint8_t mute;      /* bit: 1 << enum inject_mute */
    bool is_hung;
    uint32_t shown[INJECT_FAULTS_MAX]; /* what its object shows by fault i */
};

struct virtual_drive {
    struct servo servo;
    struct drive_plant plant;
    struct drive_faults faults;
    const struct virtual_drive_twin *twin;
    uint8_t bus;
};

/*
 * Switches the drive on; it has not booted yet. config is copied and has been checked
 * (drive_plant_check). target: its RPDO2, see canopen/target_pdo.h; NULL: what the dictionary says.
 * The drive must stay where it is, port usable as long as it.
 */
void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port);

/* As those of servo.h. */
void virtual_drive_observe(struct virtual_drive *drive, const struct drive_observer *observer);
void virtual_drive_set_eds(struct virtual_drive *drive, const char *eds, size_t length);
void virtual_drive_boot(struct virtual_drive *drive);
void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame);
void virtual_drive_on_frame_at(struct virtual_drive *drive, const struct can_frame *frame,
                               uint64_t time_ns);
void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns);
void virtual_drive_touch(struct virtual_drive *drive, bool touches, double ratio);
enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive);
enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive);
bool virtual_drive_read_object(struct virtual_drive *drive, uint32_t object, uint32_t *value);
bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value);

/*
 * Faults of the script that name this drive happen by the clock, which the caller keeps running.
 * Both must stay where they are. NULL: none.
 */
void virtual_drive_inject(struct virtual_drive *drive, const struct inject *script,
                          const struct inject_clock *clock);

/* True position of the axis, unrounded. */
double virtual_drive_get_position_mm(const struct virtual_drive *drive);

#endif
