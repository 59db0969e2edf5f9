#include "drives/virtual_drive_private.h"

#include <assert.h>
#include <string.h>

static struct servo_config servo_config_of(const struct virtual_drive_config *config)
{
    const struct drive_plant_config *plant = &config->plant;
    return (struct servo_config){
        .node = config->node,
        .is_io = config->is_io,
        .is_nameless = config->is_nameless,
        .is_fd = config->is_fd,
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

void virtual_drive_begin(const struct virtual_drive *drive, const struct twin_order *order)
{
    if (drive->twin != NULL)
        drive->twin->begin(drive->twin->context, order, NULL);
}

void virtual_drive_end(const struct virtual_drive *drive)
{
    if (drive->twin != NULL)
        drive->twin->end(drive->twin->context);
}

void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port)
{
    const struct servo_config servo = servo_config_of(config);
    struct motor_port motor = drive_plant_get_port(&drive->plant);
    struct can_port bus = *port;
    memset(&drive->faults, 0, sizeof drive->faults);
    drive->twin = config->twin;
    drive->bus = config->bus;
    drive_plant_init(&drive->plant, &config->plant, config->increments_per_mm < 0);
    if (drive->twin != NULL)
        drive->twin->open(drive->twin->context, &drive->servo, &servo, target, &bus, &motor);
    takt_servo_init(&drive->servo, &servo, target, &bus, &motor);
}

void virtual_drive_observe(struct virtual_drive *drive, const struct drive_observer *observer)
{
    takt_servo_observe(&drive->servo, observer);
}

void virtual_drive_set_eds(struct virtual_drive *drive, const char *eds, size_t length)
{
    const struct virtual_drive_twin *twin = drive->twin;
    takt_servo_set_eds(&drive->servo, eds, length);
    if (twin == NULL)
        return;
    assert(length <=
           TWIN_EDS_MAX); /* an image has takt's own objects, so this is takt's own sheet */
    twin->begin(twin->context, &(struct twin_order){.kind = TWIN_EDS, .a = (uint32_t)length}, eds);
    twin->end(twin->context);
}

void virtual_drive_boot(struct virtual_drive *drive)
{
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_BOOT});
    takt_servo_boot(&drive->servo);
    virtual_drive_end(drive);
}

static void take_with_twin(struct virtual_drive *drive, const struct can_frame *frame,
                           uint64_t time_ns)
{
    struct twin_order order = {.kind = TWIN_FRAME, .time_ns = time_ns};
    classical_frame_set(&order.frame, frame);
    virtual_drive_begin(drive, &order);
    takt_servo_on_frame_at(&drive->servo, frame, time_ns);
    virtual_drive_end(drive);
}

/* What the drive does not listen to its twin need not be told. */
void virtual_drive_on_frame_at(struct virtual_drive *drive, const struct can_frame *frame,
                               uint64_t time_ns)
{
    if (drive->faults.is_hung)
        return;
    if (drive->twin == NULL)
        takt_servo_on_frame_at(&drive->servo, frame, time_ns);
    else if (servo_accepts(&drive->servo, frame))
        take_with_twin(drive, frame, time_ns);
}

void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame)
{
    virtual_drive_on_frame_at(drive, frame, 0);
}

static void step_with_twin(struct virtual_drive *drive, uint32_t cycle_ns)
{
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_STEP, .a = cycle_ns});
    takt_servo_step(&drive->servo, cycle_ns);
    virtual_drive_end(drive);
}

void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns)
{
    if (drive->faults.script)
        virtual_drive_run_faults(drive);
    if (drive->twin != NULL)
        step_with_twin(drive, cycle_ns);
    else
        takt_servo_step(&drive->servo, cycle_ns);
}

void virtual_drive_touch(struct virtual_drive *drive, bool touches, double ratio)
{
    virtual_drive_begin(drive,
                        &(struct twin_order){.kind = TWIN_TOUCH, .a = touches, .ratio = ratio});
    takt_servo_touch(&drive->servo, touches, ratio);
    virtual_drive_end(drive);
}

void virtual_drive_inject(struct virtual_drive *drive, const struct inject *script,
                          const struct inject_clock *clock)
{
    struct servo_meddler meddler = virtual_drive_meddler(drive);
    drive->faults.script = script;
    drive->faults.clock = clock;
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_MEDDLE});
    if (drive->twin != NULL)
        meddler = drive->twin->meddle(drive->twin->context, &meddler);
    takt_servo_meddle(&drive->servo, &meddler);
    virtual_drive_end(drive);
}

enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive)
{
    return takt_servo_get_state(&drive->servo);
}

enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive)
{
    return takt_servo_get_nmt_state(&drive->servo);
}

bool virtual_drive_read_object(struct virtual_drive *drive, uint32_t object, uint32_t *value)
{
    return takt_servo_read_object(&drive->servo, object, value);
}

bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value)
{
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_WRITE, .a = object, .b = value});
    bool good = takt_servo_write_object(&drive->servo, object, value);
    virtual_drive_end(drive);
    return good;
}

double virtual_drive_get_position_mm(const struct virtual_drive *drive)
{
    return drive_plant_table_mm(&drive->plant);
}
