#include "page/page_json.h"

#include "base/maths.h"

#include <inttypes.h>

#define DEGREES_PER_RAD (180.0 / MATHS_PI)

#define SYSTEMS 9

static double shown(unsigned axis, double value)
{
    return axis >= AXIS_LINEAR_COUNT ? value * DEGREES_PER_RAD : value;
}

/* A comma before all but the first. */
static void part(struct page_text *text, unsigned index)
{
    page_text_add(text, "%s", index > 0 ? "," : "");
}

static void add_numbers(struct page_text *text, const double *value, unsigned count)
{
    page_text_add(text, "[");
    for (unsigned i = 0; i < count; i++) {
        part(text, i);
        page_text_add_number(text, value[i]);
    }
    page_text_add(text, "]");
}

static void add_registers(struct page_text *text)
{
    page_text_add(text, "\"registers\":[");
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];

        part(text, i);
        page_text_add(text, "[\"%s\",%u,", takt_panel_texts[i].name, row->decimals);
        page_text_add_string(text, takt_panel_texts[i].unit);
        page_text_add(text, ",%" PRId32 ",%" PRIu32 ",%u]", takt_panel_least(row), panel_most(row),
                      row->states);
    }
    page_text_add(text, "]");
}

static void add_axes(struct page_text *text, const struct page_setup *setup)
{
    page_text_add(text, "\"axes\":[");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct page_axis *axis = &setup->axis[i];
        const double value[] = {shown(i, axis->velocity),   shown(i, axis->acceleration),
                                shown(i, axis->jerk),       shown(i, axis->following),
                                shown(i, axis->travel_min), shown(i, axis->travel_max)};

        part(text, i);
        if (axis->is_present)
            add_numbers(text, value, sizeof value / sizeof value[0]);
        else
            page_text_add(text, "null");
    }
    page_text_add(text, "]");
}

static void add_drives(struct page_text *text, const struct page_setup *setup)
{
    page_text_add(text, "\"drives\":[");
    for (unsigned i = 0; i < setup->drives; i++) {
        part(text, i);
        page_text_add(text, "[");
        page_text_add_string(text, setup->drive[i].name);
        page_text_add(text, ",%u]", setup->drive[i].node);
    }
    page_text_add(text, "]");
}

void page_json_hello(struct page_text *text, const struct page_setup *setup)
{
    page_text_add(text, "{\"hello\":{\"machine\":");
    page_text_add_string(text, setup->machine);
    page_text_add(text, ",\"version\":");
    page_text_add_string(text, setup->version);
    page_text_add(text, ",\"cycle_us\":%" PRIu32 ",\"bitrate\":%" PRIu32 ",", setup->cycle_us,
                  setup->bitrate);
    add_axes(text, setup);
    page_text_add(text, ",");
    add_drives(text, setup);
    page_text_add(text, ",");
    add_registers(text);
    page_text_add(text, "}}");
}

static void add_peaks(struct page_text *text, const struct page_peaks *peaks)
{
    page_text_add(text, "\"x\":[");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double value[PAGE_PEAKS];

        for (unsigned k = 0; k < PAGE_PEAKS; k++)
            value[k] = shown(i, peaks->peak[k].at[i]);
        part(text, i);
        add_numbers(text, value, PAGE_PEAKS);
    }
    page_text_add(text, "]");
}

static void add_points(struct page_text *text, const struct page_peaks *peaks)
{
    page_text_add(text, "\"p\":[");
    for (unsigned i = 0; i < peaks->points; i++) {
        for (unsigned k = 0; k < AXIS_LINEAR_COUNT; k++)
            page_text_add(text, "%s%.4f", i + k > 0 ? "," : "", peaks->point[i].at[k]);
    }
    page_text_add(text, "]");
}

void page_json_frame(struct page_text *text, const struct panel_snapshot *snapshot,
                     const struct page_peaks *peaks, uint32_t number, double time_ms)
{
    page_text_add(text, "{\"n\":%" PRIu32 ",\"t\":%.3f,\"v\":[", number, time_ms);
    for (unsigned i = 0; i < REGISTER_COUNT; i++)
        page_text_add(text, "%s%" PRId64, i > 0 ? "," : "",
                      panel_value(snapshot, (enum panel_id)i));
    page_text_add(text, "],");
    add_peaks(text, peaks);
    page_text_add(text, ",");
    add_points(text, peaks);
    page_text_add(text, ",\"a\":");
    page_text_add_string(text, snapshot->alarm_text);
}

static void add_systems(struct page_text *text, const struct parameters *parameters)
{
    page_text_add(text, "\"systems\":[");
    for (unsigned i = 0; i < SYSTEMS; i++) {
        const unsigned first = PARAMETER_SYSTEM_OFFSET + i * PARAMETER_SYSTEM_STRIDE;
        double value[AXIS_COUNT + 1];

        for (unsigned k = 0; k < AXIS_COUNT; k++)
            value[k] = takt_parameters_get(parameters, first + k);
        value[AXIS_COUNT] =
            takt_parameters_get(parameters, PARAMETER_SYSTEM_ROTATE + i * PARAMETER_SYSTEM_STRIDE);
        part(text, i);
        add_numbers(text, value, AXIS_COUNT + 1);
    }
    page_text_add(text, "]");
}

static void add_tool(struct page_text *text, const struct tool *tool)
{
    double value[AXIS_COUNT + 2];

    value[0] = tool->number;
    for (unsigned k = 0; k < AXIS_COUNT; k++)
        value[1 + k] = shown(k, tool->offset.at[k]);
    value[AXIS_COUNT + 1] = tool->diameter_mm;
    add_numbers(text, value, AXIS_COUNT + 2);
}

void page_json_tables(struct page_text *text, const struct page_job *job)
{
    page_text_add(text, "{\"tables\":{");
    add_systems(text, &job->parameters);
    page_text_add(text, ",\"tools\":[");
    for (size_t i = 0; i < job->tools_count; i++) {
        part(text, i > 0);
        add_tool(text, &job->tools[i]);
    }
    page_text_add(text, "]}}");
}

static void add_fault(struct page_text *text, const struct page_fault *fault)
{
    page_text_add(text, "[");
    page_text_add_string(text, inject_name(fault->fault.kind));
    page_text_add(text, ",%u,%s]", fault->fault.node, fault->is_in_force ? "true" : "false");
}

void page_json_bus(struct page_text *text, const struct page_bus *bus)
{
    page_text_add(text,
                  "{\"bus\":{\"load\":%.2f,\"frames\":%" PRIu64 ",\"errors\":%" PRIu64
                  ",\"dropped\":%" PRIu64 ",\"refused\":%" PRIu64 ",\"responses\":[",
                  bus->load_percent, bus->frames, bus->error_frames, bus->dropped, bus->refused);
    for (unsigned i = 0; i < bus->responses; i++)
        page_text_add(text, "%s[%u,%.1f]", i > 0 ? "," : "", bus->response[i].id,
                      1e-3 * (double)bus->response[i].longest_ns);
    page_text_add(text, "],\"faults\":[");
    for (unsigned i = 0; i < bus->faults; i++) {
        part(text, i);
        add_fault(text, &bus->fault[i]);
    }
    page_text_add(text, "]}}");
}

void page_json_objects(struct page_text *text, const struct page_drive *drive, unsigned number)
{
    page_text_add(text, "{\"objects\":%u,\"rows\":[", number);
    for (unsigned i = 0; i < drive->dictionary->count && i < PAGE_OBJECTS_MAX; i++) {
        const struct object_row *row = &drive->dictionary->row[i];

        part(text, i);
        page_text_add(text, "[%u,%u,%u,%u,", row->index, row->sub, row->type, row->access);
        page_text_add_string(text, row->name != NULL ? row->name : "");
        page_text_add(text, "]");
    }
    page_text_add(text, "]}");
}

void page_json_values(struct page_text *text, const struct page_values *values, unsigned number)
{
    page_text_add(text, "{\"values\":%u,\"v\":[", number);
    for (unsigned i = 0; i < values->count; i++) {
        part(text, i);
        if (values->is_there[i])
            page_text_add(text, "%" PRIu32, values->value[i]);
        else
            page_text_add(text, "null");
    }
    page_text_add(text, "]}");
}
