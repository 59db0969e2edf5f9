/*
 * Scripted faults of the drive: when they begin and end, and what they do.
 */
#include "drives/virtual_drive_private.h"

#include <assert.h>

static_assert(INJECT_FAULTS_MAX <= 64, "faults in force are bits of a word");

static const struct inject_fault *fault_of(const struct virtual_drive *drive, unsigned i)
{
    return &drive->faults.script->fault[i];
}

static bool is_in_force(const struct virtual_drive *drive, unsigned i)
{
    return drive->faults.in_force >> i & 1;
}

/* The bits of the error register that CiA 301 gives the classes of error codes. */
static uint8_t register_of(const struct inject_fault *fault)
{
    if (fault->error_register != 0)
        return fault->error_register;
    switch (fault->code >> 12) {
    case 2:
        return EMCY_REGISTER_GENERIC | EMCY_REGISTER_CURRENT;
    case 3:
        return EMCY_REGISTER_GENERIC | EMCY_REGISTER_VOLTAGE;
    case 4:
        return EMCY_REGISTER_GENERIC | EMCY_REGISTER_TEMPERATURE;
    case 8:
        return EMCY_REGISTER_GENERIC |
               (fault->code >> 8 == 0x86 ? EMCY_REGISTER_PROFILE : EMCY_REGISTER_COMMUNICATION);
    default:
        return EMCY_REGISTER_GENERIC;
    }
}

static bool overrides(const struct inject_fault *fault)
{
    return fault->kind == INJECT_FREEZE || fault->kind == INJECT_REPORT;
}

/* What the object shows from now on, whatever happens. */
static uint32_t shown_by(struct virtual_drive *drive, const struct inject_fault *fault)
{
    bool has_index;
    const struct object_row *row =
        takt_dictionary_find(drive->servo.dictionary, fault->index, fault->sub, &has_index);
    if (fault->kind == INJECT_REPORT || !row)
        return fault->value;
    takt_servo_refresh(&drive->servo);
    return takt_object_read(row, &drive->servo.objects);
}

static void look_at_motor(struct virtual_drive *drive)
{
    if (drive->servo.config.is_io)
        return;
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_LOOK});
    takt_servo_loop_look(&drive->servo.loop);
    virtual_drive_end(drive);
}

/* Faults that last: their sum. */
static void sum_up(struct virtual_drive *drive)
{
    struct drive_faults *f = &drive->faults;
    struct drive_plant_damage damage = {.torque_ratio = 1};
    f->mute = 0;
    f->is_hung = false;
    for (unsigned i = 0; i < f->script->count; i++) {
        const struct inject_fault *fault = fault_of(drive, i);
        if (!is_in_force(drive, i))
            continue;
        if (fault->kind == INJECT_MUTE)
            f->mute |= (uint8_t)(1u << fault->what);
        f->is_hung = f->is_hung || fault->kind == INJECT_HANG;
        damage.is_jammed = damage.is_jammed || fault->kind == INJECT_JAM;
        if (fault->kind == INJECT_WEAK)
            damage.torque_ratio *= fault->ratio;
    }
    drive->plant.damage = damage;
    look_at_motor(drive);
}

static void tell_of_error(struct virtual_drive *drive, const struct inject_fault *fault)
{
    const struct twin_order order = {.kind =
                                         fault->kind == INJECT_EMCY ? TWIN_FAIL : TWIN_EMERGENCY,
                                     .a = fault->code,
                                     .b = register_of(fault)};
    virtual_drive_begin(drive, &order);
    if (fault->kind == INJECT_EMCY)
        takt_servo_fail(&drive->servo, (uint16_t)order.a, (uint8_t)order.b);
    else
        takt_servo_send_emergency(&drive->servo, (uint16_t)order.a, (uint8_t)order.b);
    virtual_drive_end(drive);
}

static void reboot(struct virtual_drive *drive)
{
    virtual_drive_begin(drive, &(struct twin_order){.kind = TWIN_REBOOT});
    takt_servo_reboot(&drive->servo);
    virtual_drive_end(drive);
}

/* Faults that happen once. */
static void happen(struct virtual_drive *drive, const struct inject_fault *fault)
{
    if (fault->kind == INJECT_EMCY || fault->kind == INJECT_WARN) {
        tell_of_error(drive, fault);
    } else if (fault->kind == INJECT_REBOOT) {
        reboot(drive);
    } else if (fault->kind == INJECT_ENCODER_JUMP) {
        drive_plant_shift_encoder(&drive->plant, fault->by_mm);
        look_at_motor(drive);
    }
}

static void begin_or_end(struct virtual_drive *drive, unsigned i)
{
    struct drive_faults *f = &drive->faults;
    const struct inject_fault *fault = fault_of(drive, i);
    f->in_force ^= UINT64_C(1) << i;
    bool begins = is_in_force(drive, i);
    takt_servo_tell(&drive->servo, begins ? DRIVE_EVENT_FAULT : DRIVE_EVENT_FAULT_END, fault->line,
                    (uint32_t)fault->kind);
    if (begins && overrides(fault))
        f->shown[i] = shown_by(drive, fault);
    sum_up(drive);
    if (begins)
        happen(drive, fault);
}

void virtual_drive_run_faults(struct virtual_drive *drive)
{
    const struct drive_faults *f = &drive->faults;
    for (unsigned i = 0; i < f->script->count; i++) {
        const struct inject_fault *fault = fault_of(drive, i);
        if (inject_is_of_bus(fault->kind) || fault->node != drive->servo.config.node ||
            fault->bus != drive->bus)
            continue;
        if (inject_is_in_force(fault, f->clock) != is_in_force(drive, i))
            begin_or_end(drive, i);
    }
}

static bool holds_back(void *context, enum servo_frame kind)
{
    static const enum inject_mute mute[] = {
        [SERVO_FRAME_HEARTBEAT] = INJECT_MUTE_HEARTBEAT,
        [SERVO_FRAME_TPDO] = INJECT_MUTE_TPDO,
        [SERVO_FRAME_SDO] = INJECT_MUTE_SDO,
        [SERVO_FRAME_EMCY] = INJECT_MUTE_EMCY,
    };
    const struct virtual_drive *drive = context;
    return drive->faults.is_hung || drive->faults.mute & (1u << mute[kind] | 1u << INJECT_MUTE_ALL);
}

static bool aborts_sdo(void *context, uint32_t object, uint32_t *code)
{
    const struct virtual_drive *drive = context;
    for (unsigned i = 0; i < drive->faults.script->count; i++) {
        const struct inject_fault *fault = fault_of(drive, i);
        if (!is_in_force(drive, i) || fault->kind != INJECT_SDO_ABORT ||
            SDO_OBJECT(fault->index, fault->sub) != object)
            continue;
        *code = fault->code;
        return true;
    }
    return false;
}

static bool shows(void *context, const struct object_row *row, uint32_t *value)
{
    const struct virtual_drive *drive = context;
    for (unsigned i = 0; i < drive->faults.script->count; i++) {
        const struct inject_fault *fault = fault_of(drive, i);
        if (!is_in_force(drive, i) || !overrides(fault) || fault->index != row->index ||
            fault->sub != row->sub)
            continue;
        *value = drive->faults.shown[i];
        return true;
    }
    return false;
}

struct servo_meddler virtual_drive_meddler(struct virtual_drive *drive)
{
    return (struct servo_meddler){
        .holds_back = holds_back, .aborts_sdo = aborts_sdo, .overrides = shows, .context = drive};
}
