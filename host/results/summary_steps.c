#include "results/summary_steps.h"

#include <inttypes.h>

static const char *interpolator_name(const struct summary *summary)
{
    static const char *const names[] = {"exact", "integrate", "rotate"};

    return names[summary->machine->interpolator];
}

static void add_stepper(cJSON *steppers, unsigned i, const struct virtual_stepper *axis)
{
    const char name[2] = {AXIS_LETTERS[i], '\0'};
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "name", name);
    cJSON_AddNumberToObject(object, "position_steps", axis->position_steps);
    cJSON_AddNumberToObject(object, "steps", (double)axis->steps);
    cJSON_AddNumberToObject(object, "missed", (double)axis->missed);
    cJSON_AddNumberToObject(object, "rate_peak_hz", axis->rate_peak_hz);
    cJSON_AddItemToArray(steppers, object);
}

static void add_interpolator(cJSON *root, const struct summary *summary)
{
    const struct interpolator_errors *errors = &summary->interpolator;
    cJSON *object = cJSON_AddObjectToObject(root, "interpolator");

    cJSON_AddStringToObject(object, "name", interpolator_name(summary));
    cJSON_AddNumberToObject(object, "along_max_mm", errors->along_mm);
    cJSON_AddNumberToObject(object, "along_bound_mm", errors->along_bound_mm);
    cJSON_AddNumberToObject(object, "contour_max_mm", errors->contour_mm);
    cJSON_AddNumberToObject(object, "contour_bound_mm", errors->contour_bound_mm);
    cJSON_AddNumberToObject(object, "landing_max_mm", errors->landing_mm);
}

void summary_steps_add_json(cJSON *root, const struct summary *summary)
{
    cJSON *steppers = cJSON_AddArrayToObject(root, "step_drives");

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (summary->steppers->axis[i].config.present)
            add_stepper(steppers, i, &summary->steppers->axis[i]);
    }
    add_interpolator(root, summary);
}

static void write_stepper(FILE *stream, unsigned i, const struct virtual_stepper *axis)
{
    (void)fprintf(
        stream,
        "  steps of %c    %" PRIu64 ", %" PRIu64 " missed, at most %.0f steps/s; it stands "
        "at %" PRId32 "\n",
        AXIS_LETTERS[i], axis->steps, axis->missed, axis->rate_peak_hz, axis->position_steps);
}

void summary_steps_write_text(FILE *stream, const struct summary *summary)
{
    const struct interpolator_errors *errors = &summary->interpolator;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (summary->steppers->axis[i].config.present)
            write_stepper(stream, i, &summary->steppers->axis[i]);
    }
    if (summary->machine->interpolator == INTERPOLATOR_EXACT)
        return;
    (void)fprintf(stream,
                  "  interpolator  %s: along the path %.3g mm (bound %.3g), contour %.3g mm (bound "
                  "%.3g), landings set right by %.3g mm\n",
                  interpolator_name(summary), errors->along_mm, errors->along_bound_mm,
                  errors->contour_mm, errors->contour_bound_mm, errors->landing_mm);
}
