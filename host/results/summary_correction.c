#include "results/summary_correction.h"

#include "cli/axis_unit.h"

static void add_of_axis(cJSON *object, unsigned axis, const char *name, const char *per,
                        double value)
{
    char key[64];

    (void)snprintf(key, sizeof key, "%s_%s%s%s", name, axis_unit_name(axis),
                   per[0] != '\0' ? "_" : "", per);
    cJSON_AddNumberToObject(object, key, value * axis_unit_ratio(axis));
}

static void add_axis(cJSON *axes, const struct correction_watch *watch, unsigned i)
{
    const char name[2] = {AXIS_LETTERS[i], '\0'};
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "name", name);
    add_of_axis(object, i, "max", "", watch->max_mm[i]);
    add_of_axis(object, i, "max_velocity", "s", watch->max_velocity_mm_s[i]);
    add_of_axis(object, i, "max_acceleration", "s2", watch->max_acceleration_mm_s2[i]);
    add_of_axis(object, i, "max_jerk", "s3", watch->max_jerk_mm_s3[i]);
    cJSON_AddItemToArray(axes, object);
}

static void add_correction(cJSON *root, const struct summary *summary)
{
    const struct correction_watch *watch = &summary->correction;
    cJSON *object, *list;

    if (watch->present == 0) {
        cJSON_AddNullToObject(root, "correction");
        return;
    }
    object = cJSON_AddObjectToObject(root, "correction");
    list = cJSON_AddArrayToObject(object, "layers");
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT; i++) {
        if ((watch->present & 1U << i) != 0)
            cJSON_AddItemToArray(list, cJSON_CreateString(takt_correction_layer_name(
                                           (enum correction_layer_number)i)));
    }
    list = cJSON_AddArrayToObject(object, "axes");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (summary->machine->axis[i].present)
            add_axis(list, watch, i);
    }
}

static void add_tool_point(cJSON *root, const struct summary *summary)
{
    const struct tool_point *tool = &summary->tool_point;
    cJSON *object;

    if (!tool->is_watched) {
        cJSON_AddNullToObject(root, "tool_point");
        return;
    }
    object = cJSON_AddObjectToObject(root, "tool_point");
    if (tool->vibration.any) {
        cJSON_AddNumberToObject(object, "way_error_max_mm", tool->way.max_mm);
        cJSON_AddNumberToObject(object, "way_error_rms_mm", tool_way_rms_mm(&tool->way));
    }
    cJSON_AddNumberToObject(object, "rests", (double)tool->at_rest.count);
    cJSON_AddNumberToObject(object, "rest_error_max_mm", tool->at_rest.max_mm);
    cJSON_AddNumberToObject(object, "rest_error_mean_mm", tool_point_mean(&tool->at_rest));
    if (tool->is_shaped)
        return;
    cJSON_AddNumberToObject(object, "setpoint_error_max_mm", tool->of_setpoints.max_mm);
    cJSON_AddNumberToObject(object, "setpoint_error_mean_mm", tool_point_mean(&tool->of_setpoints));
}

void summary_correction_add_json(cJSON *root, const struct summary *summary)
{
    add_correction(root, summary);
    add_tool_point(root, summary);
}

static void write_correction(FILE *stream, const struct summary *summary)
{
    const struct correction_watch *watch = &summary->correction;

    if (watch->present == 0)
        return;
    (void)fputs("  correction   ", stream);
    for (unsigned i = 0; i < CORRECTION_LAYERS_COUNT; i++) {
        if ((watch->present & 1U << i) != 0)
            (void)fprintf(stream, " %s",
                          takt_correction_layer_name((enum correction_layer_number)i));
    }
    (void)fprintf(stream, ", %.4g mm at most; of each axis, and what it cost\n",
                  summary->figures.correction_mm);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double ratio = axis_unit_ratio(i);

        if (summary->machine->axis[i].present)
            (void)fprintf(stream, "                %c %.3g %s, %.3g %s/s, %.3g %s/s2, %.3g %s/s3\n",
                          AXIS_LETTERS[i], watch->max_mm[i] * ratio, axis_unit_name(i),
                          watch->max_velocity_mm_s[i] * ratio, axis_unit_name(i),
                          watch->max_acceleration_mm_s2[i] * ratio, axis_unit_name(i),
                          watch->max_jerk_mm_s3[i] * ratio, axis_unit_name(i));
    }
}

static void write_tool_point(FILE *stream, const struct summary *summary)
{
    const struct tool_point *tool = &summary->tool_point;

    if (!tool->is_watched)
        return;
    (void)fprintf(stream,
                  "  tool point    off by %.2f um at most, %.2f um on average, in %u rests\n",
                  1e3 * tool->at_rest.max_mm, 1e3 * tool_point_mean(&tool->at_rest),
                  (unsigned)tool->at_rest.count);
    if (!tool->is_shaped)
        (void)fprintf(stream,
                      "                %.2f um at most, %.2f um on average, by the setpoints\n",
                      1e3 * tool->of_setpoints.max_mm, 1e3 * tool_point_mean(&tool->of_setpoints));
    if (tool->vibration.any)
        (void)fprintf(stream,
                      "                %.2f um at most, %.2f um rms, off the way, swinging\n",
                      1e3 * tool->way.max_mm, 1e3 * tool_way_rms_mm(&tool->way));
}

void summary_correction_write_text(FILE *stream, const struct summary *summary)
{
    write_correction(stream, summary);
    write_tool_point(stream, summary);
}
