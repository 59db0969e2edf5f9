#include "studies/tune_record.h"

#include "base/maths.h"
#include "cli/message.h"
#include "tables/rows.h"

static bool read_row(struct rows *rows, struct tuning_record *record, double unit)
{
    double torque_nm, position;

    if (!rows_read_number(rows, "a torque in Nm is missing", &torque_nm) ||
        !rows_read_number(rows, "a position is missing behind the torque", &position))
        return false;
    if (!rows_is_at_end(rows))
        return rows_refuse(rows, "nothing may follow torque and position");
    tuning_record_add(record, torque_nm, unit * position);
    return true;
}

bool tune_record_read(struct tuning_record *record, const char *path, bool is_rotary)
{
    const double unit = is_rotary ? MATHS_PI / 180 : 1;
    struct rows rows;
    bool good = true;

    if (!rows_open(&rows, path))
        return false;
    while (good && rows_next(&rows))
        good = read_row(&rows, record, unit);
    rows_close(&rows);
    if (good && record->failed)
        message_command_error("%s: out of memory", path);
    if (good && record->count == 0)
        message_error(path, 0, 0, "there is no row of torque and position");
    return good && record->count > 0 && !record->failed;
}

static void set_range(struct tune_axis *result)
{
    const struct tuning_record *r = &result->relay;

    result->low = result->high = r->position[0];
    for (size_t k = 0; k < r->count; k++) {
        result->torque_nm = maths_max(result->torque_nm, maths_abs(r->input[k]));
        result->low = maths_min(result->low, r->position[k]);
        result->high = maths_max(result->high, r->position[k]);
    }
}

/*
 * Its torque acts half a step early (drive_plant.c), so it comes half a step later than what was
 * found.
 */
static void give(struct drive_plant_config *plant, const struct tuning_plant *found, double step_s)
{
    const double steps = takt_maths_round(found->delay_s / step_s + 0.5);

    if (!(plant->told_inertia_kg_m2 > 0))
        plant->told_inertia_kg_m2 = plant->inertia_kg_m2;
    plant->inertia_kg_m2 = found->inertia_kg_m2;
    plant->viscous_friction_nm_s_per_rad = found->viscous_nm_s_per_rad;
    plant->coulomb_friction_nm = found->dry_nm;
    plant->torque_delay_steps = (uint32_t)maths_clamp(steps, 0, DRIVE_PLANT_DELAY_MAX - 1);
}

const char *tune_record_use(struct tune_axis *result, struct tune_drive *drive, double step_s)
{
    struct drive_plant_config *plant = &drive->config.plant;

    if (!tuning_identify(&result->relay, plant->travel_per_revolution_mm / MATHS_TWO_PI,
                         &result->plant))
        return "its record is not the answer of an inertia with friction to a torque that comes "
               "later, or too short";
    set_range(result);
    give(plant, &result->plant, step_s);
    return tune_drive_start(drive, CIA402_MODE_CYCLIC_SYNC_POSITION)
               ? NULL
               : "its drive does not come to be enabled";
}
