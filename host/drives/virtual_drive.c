#include "drives/virtual_drive_private.h"

#include <string.h>

static struct servo_config servo_config_of(const struct virtual_drive_config *config)
{
    const struct drive_plant_config *plant = &config->plant;
    return (struct servo_config){
        .node = config->node,
        .is_io = config->is_io,
        .is_nameless = config->is_nameless,
        .is_absolute = plant->absolute_encoder != 0,
        .closed = config->closed,
        .increments_per_mm = config->increments_per_mm,
        .velocity_units_per_mm_s = config->velocity_units_per_mm_s,
        .cycle_us = config->cycle_us,
        .boot_us = config->boot_us,
        .sdo_us = config->sdo_us,
        .following_error_window_mm = plant->following_error_window_mm,
        .following_error_timeout_ms = plant->following_error_timeout_ms,
        .quick_stop_deceleration_mm_s2 = plant->quick_stop_deceleration_mm_s2,
        .temperature_max_c = plant->temperature_max_c,
        .loop = drive_plant_get_loop(plant),
        .dictionary = config->dictionary,
    };
}

void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port)
{
    const struct servo_config servo = servo_config_of(config);
    const struct motor_port motor = drive_plant_get_port(&drive->plant);
    memset(&drive->faults, 0, sizeof drive->faults);
    drive_plant_init(&drive->plant, &config->plant, config->increments_per_mm < 0);
    servo_init(&drive->servo, &servo, target, port, &motor);
}

void virtual_drive_observe(struct virtual_drive *drive, const struct drive_observer *observer)
{
    servo_observe(&drive->servo, observer);
}

void virtual_drive_boot(struct virtual_drive *drive)
{
    servo_boot(&drive->servo);
}

void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame)
{
    if (!drive->faults.is_hung)
        servo_on_frame(&drive->servo, frame);
}

void virtual_drive_on_frame_at(struct virtual_drive *drive, const struct can_frame *frame,
                               uint64_t time_ns)
{
    if (!drive->faults.is_hung)
        servo_on_frame_at(&drive->servo, frame, time_ns);
}

void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns)
{
    if (drive->faults.script)
        virtual_drive_run_faults(drive);
    servo_step(&drive->servo, cycle_ns);
}

void virtual_drive_inject(struct virtual_drive *drive, const struct inject *script,
                          const struct inject_clock *clock)
{
    const struct servo_meddler meddler = virtual_drive_meddler(drive);
    drive->faults.script = script;
    drive->faults.clock = clock;
    servo_meddle(&drive->servo, &meddler);
}

enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive)
{
    return servo_get_state(&drive->servo);
}

enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive)
{
    return servo_get_nmt_state(&drive->servo);
}

bool virtual_drive_read_object(struct virtual_drive *drive, uint32_t object, uint32_t *value)
{
    return servo_read_object(&drive->servo, object, value);
}

bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value)
{
    return servo_write_object(&drive->servo, object, value);
}

double virtual_drive_get_position_mm(const struct virtual_drive *drive)
{
    return drive_plant_table_mm(&drive->plant);
}
