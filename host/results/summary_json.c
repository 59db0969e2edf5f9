/*
 * The summary as JSON: the fields and their order are those of README.md and summary.schema.json.
 */
#include "cli/axis_unit.h"
#include "results/summary.h"
#include "results/summary_correction.h"
#include "results/summary_steps.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Length of the UTF-8 sequence at s, or 0 when the bytes are none. RFC 3629, section 4. */
static size_t utf8_length(const unsigned char *s)
{
    size_t length = s[0] < 0x80                   ? 1
                    : s[0] >= 0xC2 && s[0] < 0xE0 ? 2
                    : s[0] >= 0xE0 && s[0] < 0xF0 ? 3
                    : s[0] >= 0xF0 && s[0] < 0xF5 ? 4
                                                  : 0;

    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xC0) != 0x80)
            return 0;
    }
    return length;
}

/* File names may hold any bytes, JSON only UTF-8: others become '?'. */
static void add_text(cJSON *object, const char *key, const char *text)
{
    char *clean = malloc(strlen(text) + 1);
    size_t used = 0;

    if (clean == NULL)
        return;
    while (*text != '\0') {
        size_t length = utf8_length((const unsigned char *)text);

        if (length == 0)
            clean[used++] = '?';
        else
            memcpy(clean + used, text, length);
        used += length;
        text += length == 0 ? 1 : length;
    }
    clean[used] = '\0';
    cJSON_AddStringToObject(object, key, clean);
    free(clean);
}

/* "max_velocity" and "s": max_velocity_mm_s, or _deg_s for a rotary axis. */
static void add_of_axis(cJSON *object, unsigned axis, const char *name, const char *per,
                        double value)
{
    char key[64];

    (void)snprintf(key, sizeof key, "%s_%s%s%s", name, axis_unit_name(axis),
                   per[0] != '\0' ? "_" : "", per);
    cJSON_AddNumberToObject(object, key, value * axis_unit_ratio(axis));
}

static void add_axis(cJSON *axes, const struct summary *summary, unsigned i)
{
    const struct machine_axis *axis = &summary->machine->axis[i];
    const struct verifier_figures *figures = &summary->figures;
    char name[2] = {AXIS_LETTERS[i], '\0'};
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "name", name);
    add_of_axis(object, i, "max_velocity", "s", figures->velocity_mm_s[i]);
    add_of_axis(object, i, "max_acceleration", "s2", figures->acceleration_mm_s2[i]);
    add_of_axis(object, i, "max_jerk", "s3", figures->jerk_mm_s3[i]);
    add_of_axis(object, i, "limit_velocity", "s", axis->max_velocity_mm_s);
    add_of_axis(object, i, "limit_acceleration", "s2", axis->max_acceleration_mm_s2);
    add_of_axis(object, i, "limit_jerk", "s3", axis->max_jerk_mm_s3);
    add_of_axis(object, i, "max_following_error", "", figures->following_error_mm[i]);
    cJSON_AddItemToArray(axes, object);
}

static void add_head(cJSON *root, const struct summary *summary)
{
    cJSON_AddStringToObject(root, "version", TAKT_VERSION);
    add_text(root, "program", summary->program);
    add_text(root, "machine", summary->machine->name);
    cJSON_AddStringToObject(root, "outcome", summary_outcome_name(summary->outcome));
    if (summary->outcome == OUTCOME_FAULTED)
        cJSON_AddStringToObject(root, "fault", summary->fault);
    else
        cJSON_AddNullToObject(root, "fault");
    cJSON_AddNumberToObject(root, "exit_status", summary_status(summary));
    cJSON_AddNumberToObject(root, "blocks", summary->figures.blocks);
    cJSON_AddNumberToObject(root, "cycles", (double)summary->figures.cycles);
    cJSON_AddNumberToObject(root, "cycle_time_s", summary->cycle_s);
    cJSON_AddNumberToObject(root, "program_time_s", summary_program_time_s(summary));
    cJSON_AddNumberToObject(root, "wall_time_s", summary->wall_time_s);
    cJSON_AddNumberToObject(root, "realtime_ratio", summary_realtime_ratio(summary));
    cJSON_AddNumberToObject(root, "path_length_mm", summary->figures.path_length_mm);
}

static void add_axes(cJSON *root, const struct summary *summary)
{
    cJSON *axes = cJSON_AddArrayToObject(root, "axes");

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (summary->machine->axis[i].present)
            add_axis(axes, summary, i);
    }
}

static void add_path(cJSON *root, const struct summary *summary)
{
    const struct verifier_figures *figures = &summary->figures;

    cJSON_AddNumberToObject(root, "chord_error_max_mm", figures->chord_error_mm);
    cJSON_AddNumberToObject(root, "path_error_max_mm", figures->path_error_mm);
    cJSON_AddNumberToObject(root, "landing_error_max_mm", figures->landing_error_mm);
    cJSON_AddNumberToObject(root, "joint_feed_step_max_mm_s", figures->junction_feed_step_mm_s);
    cJSON_AddNumberToObject(root, "correction_max_mm", figures->correction_mm);
}

/* observed_us: null on an outside bus, where nobody sees when a frame was given. */
static void add_responses(cJSON *object_of_bus, const struct summary *summary,
                          const struct summary_bus *bus)
{
    const struct bus_plan *plan = &bus->plan;
    cJSON *responses = cJSON_AddArrayToObject(object_of_bus, "responses");

    for (unsigned i = 0; i < plan->count; i++) {
        cJSON *object = cJSON_CreateObject();

        cJSON_AddStringToObject(object, "name", plan->name[i]);
        cJSON_AddNumberToObject(object, "id", plan->message[i].id);
        cJSON_AddNumberToObject(object, "bytes", plan->message[i].length);
        if (plan->worst_ns[i] != UINT64_MAX)
            cJSON_AddNumberToObject(object, "predicted_us", 1e-3 * (double)plan->worst_ns[i]);
        else
            cJSON_AddNullToObject(object, "predicted_us"); /* there is no bound */
        if (summary->responses_observed)
            cJSON_AddNumberToObject(object, "observed_us", 1e-3 * (double)bus->response_ns[i]);
        else
            cJSON_AddNullToObject(object, "observed_us");
        cJSON_AddItemToArray(responses, object);
    }
}

/* The first is bus, what comes behind it can1 and so on. */
static void add_buses(cJSON *root, const struct summary *summary)
{
    for (unsigned i = 0; i < summary->buses; i++) {
        const struct summary_bus *bus = &summary->bus[i];
        char name[8] = "bus";

        if (i > 0)
            (void)snprintf(name, sizeof name, "can%u", i % 10);
        cJSON *object = cJSON_AddObjectToObject(root, name);

        cJSON_AddNumberToObject(object, "frames", (double)bus->frames);
        cJSON_AddNumberToObject(object, "load_percent", bus->load_percent);
        cJSON_AddNumberToObject(object, "predicted_load_percent", bus->predicted_percent);
        add_responses(object, summary, bus);
    }
}

static void add_pace(cJSON *root, const struct summary *summary)
{
    const struct pace_figures *figures = &summary->pace;
    cJSON *pace;

    if (!summary->is_paced) {
        cJSON_AddNullToObject(root, "realtime");
        return;
    }
    pace = cJSON_AddObjectToObject(root, "realtime");
    cJSON_AddBoolToObject(pace, "fifo_priority", summary->permission.has_priority);
    cJSON_AddBoolToObject(pace, "memory_locked", summary->permission.has_memory);
    cJSON_AddNumberToObject(pace, "overruns", (double)figures->overruns);
    cJSON_AddNumberToObject(pace, "lateness_mean_ns", figures->lateness_mean_ns);
    cJSON_AddNumberToObject(pace, "lateness_p99_ns", figures->lateness_p99_ns);
    cJSON_AddNumberToObject(pace, "lateness_max_ns", (double)figures->lateness_max_ns);
}

static void add_cost(cJSON *root, const struct summary *summary)
{
    cJSON *cost;

    if (!summary->cost_measured) {
        cJSON_AddNullToObject(root, "cycle_ns");
        return;
    }
    cost = cJSON_AddObjectToObject(root, "cycle_ns");
    cJSON_AddNumberToObject(cost, "min", summary->cost_min_ns);
    cJSON_AddNumberToObject(cost, "mean", summary->cost_mean_ns);
    cJSON_AddNumberToObject(cost, "p99", summary->cost_p99_ns);
    cJSON_AddNumberToObject(cost, "max", summary->cost_max_ns);
}

static void add_target(cJSON *root, const struct summary *summary)
{
    const struct target *target = summary->target;
    cJSON *object;

    if (target == NULL) {
        cJSON_AddNullToObject(root, "target");
        return;
    }
    object = cJSON_AddObjectToObject(root, "target");
    cJSON_AddStringToObject(object, "name", target->name);
    cJSON_AddNumberToObject(object, "cycles_differing", (double)target->differences);
    cJSON_AddNumberToObject(object, "cycles_counted", (double)target->cost.cycles);
    cJSON_AddNumberToObject(object, "cycle_instructions", (double)target->cost.sum);
    cJSON_AddNumberToObject(object, "cycle_instructions_max", (double)target->cost.max);
    cJSON_AddNumberToObject(object, "background_instructions", (double)target->cost.background_sum);
    cJSON_AddNumberToObject(object, "blocks_planned", target->cost.blocks);
}

static void add_drive_images(cJSON *root, const struct summary *summary)
{
    const struct drive_images *images = summary->drive_images;
    cJSON *object;

    if (images == NULL) {
        cJSON_AddNullToObject(root, "drive_images");
        return;
    }
    object = cJSON_AddObjectToObject(root, "drive_images");
    cJSON_AddStringToObject(object, "name", images->name);
    cJSON_AddNumberToObject(object, "count", images->count);
    cJSON_AddNumberToObject(object, "differences", (double)drive_images_differences(images));
}

static void add_checks(cJSON *root, const struct summary *summary)
{
    cJSON *checks = cJSON_AddArrayToObject(root, "checks");

    for (unsigned i = 0; i < summary->checks; i++) {
        const struct summary_check *check = &summary->check[i];
        cJSON *object = cJSON_CreateObject();

        cJSON_AddStringToObject(object, "name", check->name);
        cJSON_AddBoolToObject(object, "held", check->held);
        cJSON_AddNumberToObject(object, "value", check->value);
        cJSON_AddNumberToObject(object, "limit", check->limit);
        cJSON_AddItemToArray(checks, object);
    }
}

char *summary_json(const struct summary *summary)
{
    cJSON *root = cJSON_CreateObject();
    char digest[17];
    char *text;

    add_head(root, summary);
    add_axes(root, summary);
    add_path(root, summary);
    summary_correction_add_json(root, summary);
    summary_steps_add_json(root, summary);
    add_buses(root, summary);
    drives_table_add_json(root, &summary->drives, summary->machine);
    add_pace(root, summary);
    add_cost(root, summary);
    add_target(root, summary);
    add_drive_images(root, summary);
    add_checks(root, summary);
    (void)snprintf(digest, sizeof digest, "%016" PRIx64, summary->figures.digest);
    cJSON_AddStringToObject(root, "setpoint_digest", digest);
    text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}
