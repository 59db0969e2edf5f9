#include "simulation/error_map.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

/* Points of the pictures, and levels of Z. */
#define MAP_X 21
#define MAP_Y 15
#define MAP_Z 3

static const unsigned points[AXIS_LINEAR_COUNT] = {MAP_X, MAP_Y, MAP_Z};

struct error_map {
    const struct correction *correction;
    struct deviation deviation;
    double from_mm[AXIS_LINEAR_COUNT], to_mm[AXIS_LINEAR_COUNT];
};

static void set_range(struct error_map *m, const struct session *session)
{
    const struct grid *grid = session->correction != NULL ? &session->correction->volume : NULL;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        m->from_mm[i] = session->setup.machine.axis[i].travel_min_mm;
        m->to_mm[i] = session->setup.machine.axis[i].travel_max_mm;
    }
    for (unsigned i = 0; grid != NULL && i < grid->inputs; i++) {
        const struct grid_input *input = &grid->input[i];

        if (input->axis < AXIS_LINEAR_COUNT) {
            m->from_mm[input->axis] = input->first_mm;
            m->to_mm[input->axis] = input->first_mm + input->last / input->per_mm;
        }
    }
}

/* The middles of equal parts, so that they are hardly ever points of a table. */
static double position(const struct error_map *m, unsigned axis, unsigned k)
{
    return m->from_mm[axis] +
           (m->to_mm[axis] - m->from_mm[axis]) * (k + 0.5) / (double)points[axis];
}

static void add_positions(cJSON *root, const struct error_map *m)
{
    static const char *const names[] = {"x", "y", "z"};

    for (unsigned axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
        cJSON *list = cJSON_AddArrayToObject(root, names[axis]);

        for (unsigned k = 0; k < points[axis]; k++)
            cJSON_AddItemToArray(
                list, cJSON_CreateNumber((double)(long)(100 * position(m, axis, k)) / 100));
    }
}

static void add_error(cJSON *list, const struct error_map *m, const struct point *at,
                      bool corrected)
{
    const struct move move = {.kind = MOVE_FEED};
    struct point set = *at, tool, k;
    double um[AXIS_LINEAR_COUNT];

    if (corrected) {
        takt_correction_evaluate(m->correction, at, &move, &k);
        for (unsigned i = 0; i < AXIS_COUNT; i++)
            set.at[i] += k.at[i];
    }
    deviation_tool_point(&m->deviation, &set, 0, &tool);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        um[i] = 1e-3 * (double)(long)(1e6 * (tool.at[i] - at->at[i]));
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(um, AXIS_LINEAR_COUNT));
}

static void add_errors(cJSON *root, const char *name, const struct error_map *m, bool corrected)
{
    cJSON *list = cJSON_AddArrayToObject(root, name);

    for (unsigned row = 0; row < MAP_X * MAP_Y * MAP_Z; row++) {
        const struct point at = {{position(m, AXIS_X, row % MAP_X),
                                  position(m, AXIS_Y, row / MAP_X % MAP_Y),
                                  position(m, AXIS_Z, row / (MAP_X * MAP_Y))}};

        add_error(list, m, &at, corrected);
    }
}

char *error_map_json(const struct session *session, const struct simulation *simulation)
{
    struct error_map m = {.correction = &simulation->controller.correction,
                          .deviation = simulation->tool_point.real};
    cJSON *root;
    char *text;

    if (!simulation->tool_point.is_watched)
        return NULL;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        m.deviation.lost_mm[i] = 0;
    set_range(&m, session);
    root = cJSON_CreateObject();
    add_positions(root, &m);
    add_errors(root, "before", &m, false);
    add_errors(root, "after", &m, true);
    text = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    return text;
}
