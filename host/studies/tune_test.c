#include "studies/tune_test.h"

#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "config/data_sheet.h"
#include "session/session.h"
#include "studies/tune_answer.h"
#include "studies/tune_record.h"
#include "studies/tune_relay.h"

#include <stdlib.h>

/* What 6064 tells apart, and a drive keeps: more following error than that is one. */
#define SAME_STEPS 2

struct run {
    struct session session;
    struct virtual_drives_config drives;
    struct dictionary sheet[DATA_SHEETS_MAX];
    struct tune_drive drive;
};

static bool is_gantry(const struct machine *machine, unsigned axis)
{
    for (unsigned i = 0; i < takt_machine_gantry_count(machine); i++) {
        if (machine->gantry[i].axis == axis)
            return true;
    }
    return false;
}

/* The highest that the drive takes (drive_plant_check), in whole thousandths of a hertz. */
static double bandwidth_max_hz(const struct drive_plant_config *plant)
{
    const double most = SERVO_LOOP_GAIN_STEP_MAX / (MATHS_TWO_PI * 1e-6 * plant->loop_period_us);

    return takt_maths_floor(1e3 * most) / 1e3;
}

static struct tuning_drive model_of(const struct tune_drive *drive)
{
    const struct drive_plant_config *plant = &drive->config.plant;
    const uint32_t period_ns = 1000 * plant->loop_period_us;
    const uint32_t steps = (drive->cycle_ns - 1) / period_ns + 1;
    const uint32_t counts = plant->encoder_counts_per_revolution;

    return (struct tuning_drive){
        .step_s = 1e-9 * drive->cycle_ns / steps,
        .position_step = counts > 0 ? plant->travel_per_revolution_mm / counts : 0,
        .torque_rated_nm = plant->torque_rated_nm,
        .bandwidth_max_hz = bandwidth_max_hz(plant),
    };
}

/* Gains that leave the room that is promised and follow as well are left alone. */
static bool is_as_good(const struct tune_axis *result)
{
    const struct tune_answer *before = &result->before, *after = &result->after;

    return before->is_steady && tuning_margins_are_good(&before->margins) &&
           before->overshoot <= TUNING_OVERSHOOT &&
           before->error_max <= after->error_max + SAME_STEPS * result->position_step;
}

static bool keeps_promise(const struct tune_axis *result)
{
    const struct tune_answer *after = &result->after;
    const double steps = SAME_STEPS * result->position_step / result->step;

    return after->is_steady && after->overshoot <= TUNING_OVERSHOOT + steps;
}

/* NULL; else what is wrong. */
static const char *tune(struct tune_axis *result, struct tune_drive *drive,
                        const struct machine_axis *axis)
{
    const struct tuning_drive model = model_of(drive);
    struct tune_task task;
    const char *wrong = result->relay.count > 0 ? tune_record_use(result, drive, model.step_s)
                                                : tune_relay_run(result, drive, axis);

    if (wrong != NULL)
        return wrong;
    if (!tune_drive_get_gains(drive, &result->before.gains))
        return "its drive has no object of its loops (2020)";
    if (!tuning_find_gains(&result->plant, &model, &result->after.gains))
        return "no gains of what was found of it leave the room that is promised";
    tuning_margins_of(&result->plant, &model, &result->before.gains, &result->before.margins);
    tuning_margins_of(&result->plant, &model, &result->after.gains, &result->after.margins);
    task = tune_task_of(result, &result->after.gains, drive, axis);
    result->step = maths_abs(task.step);
    wrong = tune_answer_run(&result->before, drive, &task);
    if (wrong == NULL)
        wrong = tune_answer_run(&result->after, drive, &task);
    if (wrong != NULL)
        return wrong;
    result->is_kept = is_as_good(result);
    if (!result->is_kept && !keeps_promise(result))
        return "with the gains that were found a step goes farther beyond its end than is "
               "promised, or does not come to rest";
    return NULL;
}

/* The drive of an axis, as it stands in the machine. */
static void set_drive(struct run *run, struct tune_axis *result, unsigned drive)
{
    struct tune_drive *d = &run->drive;
    const struct machine *machine = &run->session.setup.machine;

    d->config = run->drives.drive[drive];
    d->cycle_ns = 1000 * machine->cycle_us;
    const struct drive_plant_config *plant = &d->config.plant;
    const uint32_t counts = plant->encoder_counts_per_revolution;
    const double step = counts > 0 ? plant->travel_per_revolution_mm / counts : 0;

    result->position_step = maths_max(step, 1 / maths_abs(d->config.increments_per_mm));
    result->relay =
        (struct tuning_record){.cycle_s = 1e-9 * d->cycle_ns, .step = result->position_step};
    result->before.step = result->before.move = result->after.step = result->after.move =
        result->relay;
}

static enum command_status tune_axis(struct run *run, struct tune_test *test, unsigned axis,
                                     unsigned drive, const char *record)
{
    const struct machine_axis *machine = &run->session.setup.machine.axis[axis];
    struct tune_axis *result = &test->axis[axis];
    const char *wrong;

    result->bus = machine->drive_bus;
    result->node = machine->drive_node;
    set_drive(run, result, drive);
    if (record != NULL && !tune_record_read(&result->relay, record, axis >= AXIS_LINEAR_COUNT))
        return STATUS_INPUT;
    wrong = is_gantry(&run->session.setup.machine, axis)
                ? "it has two drives, which would be turned against each other"
                : tune(result, &run->drive, machine);
    if (wrong != NULL) {
        message_command_error("axis %c cannot be tuned: %s", AXIS_LETTERS[axis], wrong);
        return STATUS_FAILED;
    }
    result->is_measured = true;
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

static enum command_status tune_axes(struct run *run, struct tune_test *test, unsigned axes,
                                     const char *record)
{
    enum command_status status = STATUS_DONE;
    unsigned drive = 0;
    bool any = false;

    for (unsigned i = 0; i < AXIS_COUNT && status == STATUS_DONE; i++) {
        const bool is_on_can = machine_axis_is_on_can(&run->session.setup.machine.axis[i]);

        if (!is_on_can && (axes & 1U << i) != 0) {
            message_command_error("axis %c has no drive on CAN, whose loops could be tuned",
                                  AXIS_LETTERS[i]);
            return STATUS_INPUT;
        }
        if (is_on_can && (axes == 0 || (axes & 1U << i) != 0)) {
            status = tune_axis(run, test, i, drive, record);
            any = true;
        }
        drive += is_on_can;
    }
    if (!any) {
        message_command_error("no axis has a drive on CAN, whose loops could be tuned");
        return STATUS_INPUT;
    }
    return status;
}

enum command_status tune_test_run(struct tune_test *test, unsigned axes,
                                  const struct options *options)
{
    struct run *run = calloc(1, sizeof *run);
    enum command_status status;

    if (run == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = session_open_machine(&run->session, options);
    if (status == STATUS_DONE &&
        !data_sheet_set_machine(&run->drives, &run->session.setup, run->sheet))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = tune_axes(run, test, axes, options->tune_record);
    session_close(&run->session);
    free(run);
    return status;
}

static void free_answer(struct tune_answer *answer)
{
    tuning_record_free(&answer->step);
    tuning_record_free(&answer->move);
}

void tune_test_free(struct tune_test *test)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        tuning_record_free(&test->axis[i].relay);
        free_answer(&test->axis[i].before);
        free_answer(&test->axis[i].after);
    }
}
