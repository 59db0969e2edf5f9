#include "simulation/tool_point.h"

#include "base/maths.h"
#include "config/shaper.h"

/* A table that the chain names is there; one that only the controller believes in is not. */
static void set_chain(const struct machine_setup *setup, struct deviation_config *geometry)
{
    struct unit_chain *chain = &geometry->chain;

    (void)machine_setup_chain(setup, chain); /* a setup that has passed its check */
    if (chain->axis[chain->units - 1] < AXIS_LINEAR_COUNT)
        return;
    if (setup->chain[0] != '\0')
        geometry->table_axis = chain->axis[chain->units - 1];
    else if (geometry->table_axis == AXIS_COUNT)
        chain->units--;
}

/* Has the screw an error that the encoder of its motor does not see? */
static bool has_error(const struct drive_plant_config *plant)
{
    return plant->backlash_mm > 0 || plant->pitch_error_mm > 0;
}

static bool drives_have_errors(const struct machine_setup *setup)
{
    bool any = false;

    for (unsigned i = 0; i < MACHINE_SETUP_DRIVES_MAX; i++)
        any = any || has_error(&setup->drive[i].plant);
    return any;
}

void tool_point_init(struct tool_point *t, const struct machine_setup *setup)
{
    double min_mm[AXIS_COUNT], max_mm[AXIS_COUNT];
    struct deviation_config geometry = setup->geometry;

    set_chain(setup, &geometry);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        min_mm[i] = setup->machine.axis[i].travel_min_mm;
        max_mm[i] = setup->machine.axis[i].travel_max_mm;
    }
    *t = (struct tool_point){
        .cycle_s = machine_cycle_s(&setup->machine),
        .is_shaped = setup->shaper != SHAPER_NONE,
    };
    deviation_init(&t->real, &geometry, min_mm, max_mm);
    t->nominal = t->real;
    vibration_init(&t->vibration, &setup->vibration, t->cycle_s);
    t->is_watched = t->real.any || t->vibration.any || drives_have_errors(setup);
}

static double distance(const struct point *a, const struct point *b)
{
    double square = 0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        square += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return maths_sqrt(square);
}

static void add_error(struct tool_point_error *error, double mm)
{
    error->count++;
    error->sum_mm += mm;
    error->max_mm = maths_max(error->max_mm, mm);
}

static bool is_cutting(const struct block *block)
{
    return move_is_motion(&block->move) && block->move.kind != MOVE_RAPID &&
           block->move.kind != MOVE_PROBE;
}

static void wear(struct tool_point *t, const struct cycle_record *record, const struct block *block)
{
    const double way_mm = t->has_cmd ? distance(&record->cmd, &t->cmd) : 0;

    if (!is_cutting(block) || !(way_mm > 0))
        return;
    t->cut_mm += way_mm;
    t->cut_s += t->cycle_s;
    deviation_set_wear(&t->real, t->cut_mm, t->cut_s);
    deviation_set_wear(&t->nominal, t->cut_mm, t->cut_s);
}

void tool_point_write_rests(struct tool_point *t, FILE *stream)
{
    t->rests = stream;
    (void)fprintf(stream,
                  "line,cmd_X_mm,cmd_Y_mm,cmd_Z_mm,tool_X_mm,tool_Y_mm,tool_Z_mm,error_mm\n");
}

static void write_rest(const struct tool_point *t)
{
    (void)fprintf(t->rests, "%u,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", (unsigned)t->still_line,
                  t->cmd.at[AXIS_X], t->cmd.at[AXIS_Y], t->cmd.at[AXIS_Z], t->still_at.at[AXIS_X],
                  t->still_at.at[AXIS_Y], t->still_at.at[AXIS_Z], t->still_mm);
}

static void end_standstill(struct tool_point *t)
{
    if ((double)t->still * t->cycle_s >= TOOL_POINT_REST_S) {
        add_error(&t->at_rest, t->still_mm);
        if (t->rests != NULL)
            write_rest(t);
    }
    t->still = 0;
}

/* Where the table is wanted. */
static double turn_of(const struct tool_point *t, const struct point *cmd)
{
    const uint32_t axis = t->real.config.table_axis;

    return axis < AXIS_COUNT ? cmd->at[axis] : 0;
}

static void follow_way(struct tool_point *t, const struct point *cmd)
{
    tool_way_add(&t->way, cmd);
    tool_way_measure(&t->way, &t->tool);
}

static void measure_setpoint(struct tool_point *t, const struct cycle_record *record, double time_s)
{
    struct point tool;

    deviation_follow(&t->nominal, &record->set, time_s);
    deviation_tool_point(&t->nominal, &record->set, turn_of(t, &record->cmd), &tool);
    add_error(&t->of_setpoints, distance(&tool, &record->cmd));
}

static void measure(struct tool_point *t, const struct cycle_record *record, double time_s)
{
    tool_point_get(t, &record->cmd, &t->tool);
    if (t->vibration.any)
        follow_way(t, &record->cmd);
    if (t->has_cmd && point_is_same(&record->cmd, &t->cmd)) {
        t->still_mm = distance(&t->tool, &record->cmd);
        t->still_at = t->tool;
        t->still_line = record->line;
        t->still++;
    } else {
        end_standstill(t);
    }
    if (!t->is_shaped)
        measure_setpoint(t, record, time_s);
}

void tool_point_follow(struct tool_point *t, const struct point *drives, double time_s,
                       const struct cycle_record *record, const struct block *block)
{
    struct point at = *drives;

    if (!t->is_watched)
        return;
    vibration_follow(&t->vibration, &at);
    deviation_follow(&t->real, &at, time_s);
    t->real_at = at;
    if (record == NULL)
        return;
    wear(t, record, block);
    measure(t, record, time_s);
    t->cmd = record->cmd;
    t->has_cmd = true;
}

void tool_point_finish(struct tool_point *t)
{
    end_standstill(t);
}

void tool_point_get(const struct tool_point *t, const struct point *cmd, struct point *tool)
{
    deviation_tool_point(&t->real, &t->real_at, turn_of(t, cmd), tool);
}

double tool_point_mean(const struct tool_point_error *error)
{
    return error->count > 0 ? error->sum_mm / (double)error->count : 0;
}
