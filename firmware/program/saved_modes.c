#include "program/saved_modes.h"

#include "base/assert.h"
#include "program/coordinates.h"
#include "program/events.h"
#include "program/report.h"
#include "program/words.h"

#include <string.h>

/*
 * All that later words depend on, but not where the machine is, the work offsets themselves, and
 * which motion goes on without its code.
 */
static void save(const struct program_modes *m, struct program_saved *s)
{
    *s = (struct program_saved){
        .tool_offset = m->tool_offset,
        .unit_mm = m->unit_mm,
        .feed_mm_s = m->feed_mm_s,
        .feed_rad_s = m->feed_rad_s,
        .feed_rev_mm = m->feed_rev_mm,
        .feed_rev_rad = m->feed_rev_rad,
        .tolerance_mm = m->tolerance_mm,
        .merge_mm = m->merge_mm,
        .speed_rpm = m->speed_rpm,
        .surface_mm_s = m->surface_mm_s,
        .surface_max_rpm = m->surface_max_rpm,
        .surface_speed = m->surface_speed,
        .overrides = m->overrides,
        .plane = m->plane,
        .path = m->path,
        .direction = m->direction,
        .incremental = m->incremental,
        .centre_absolute = m->centre_absolute,
        .inverse_time = m->inverse_time,
        .per_revolution = m->per_revolution,
        .diameter = m->diameter,
        .retract_to_r = m->retract_to_r,
        .mist = m->mist,
        .flood = m->flood,
        .system = m->system,
    };
}

static void restore_values(struct program_modes *m, const struct program_saved *s)
{
    m->tool_offset = s->tool_offset;
    m->unit_mm = s->unit_mm;
    m->feed_mm_s = s->feed_mm_s;
    m->feed_rad_s = s->feed_rad_s;
    m->feed_rev_mm = s->feed_rev_mm;
    m->feed_rev_rad = s->feed_rev_rad;
    m->tolerance_mm = s->tolerance_mm;
    m->merge_mm = s->merge_mm;
    m->speed_rpm = s->speed_rpm;
    m->surface_mm_s = s->surface_mm_s;
    m->surface_max_rpm = s->surface_max_rpm;
    m->surface_speed = s->surface_speed;
    m->overrides = s->overrides;
    m->plane = s->plane;
    m->path = s->path;
    m->incremental = s->incremental;
    m->centre_absolute = s->centre_absolute;
    m->inverse_time = s->inverse_time;
    m->per_revolution = s->per_revolution;
    m->diameter = s->diameter;
    m->retract_to_r = s->retract_to_r;
}

/* Compensation itself is not saved. While it is on, what it stands on must stay. */
static bool keeps_contour(const struct program_modes *m, const struct program_saved *s)
{
    return m->cutter_side == CUTTER_OFF || (m->plane == s->plane && m->system == s->system &&
                                            point_is_same(&m->tool_offset, &s->tool_offset));
}

static void restore_spindle(struct program *p, const struct program_saved *s, bool speed_changes)
{
    struct program_modes *m = &p->modes;
    const bool turns = m->direction != SPINDLE_OFF || s->direction != SPINDLE_OFF;

    if (turns && (speed_changes || m->direction != s->direction)) {
        m->direction = s->direction;
        takt_events_tell_spindle(p);
    }
}

static bool bring_back(struct program *p, const struct program_saved *saved)
{
    struct program_modes *m = &p->modes;
    const bool speed_changes = m->speed_rpm != saved->speed_rpm ||
                               m->surface_mm_s != saved->surface_mm_s ||
                               m->surface_speed != saved->surface_speed;

    if (!keeps_contour(m, saved)) {
        return false;
    }
    restore_values(m, saved);
    if (m->system != saved->system) {
        takt_coordinates_load_system(p, saved->system);
    }
    restore_spindle(p, saved, speed_changes);
    if (m->mist != saved->mist || m->flood != saved->flood) {
        m->mist = saved->mist;
        m->flood = saved->flood;
        takt_events_tell_coolant(p);
    }
    return true;
}

/* Behind the caller's parameters. */
static unsigned place_of(const struct program_frame *frame)
{
    TAKT_ASSERT((unsigned)frame->kept + frame->locals <= PROGRAM_KEPT_MAX);
    return (unsigned)frame->kept + frame->locals;
}

unsigned takt_saved_modes_end(const struct program_frame *frame)
{
    return place_of(frame) + (frame->is_saved ? PROGRAM_SAVED_NUMBERS : 0);
}

bool takt_saved_modes_restore(struct program *p, const struct program_frame *frame)
{
    struct program_saved saved;

    TAKT_ASSERT(frame->is_saved && takt_saved_modes_end(frame) <= PROGRAM_KEPT_MAX);
    memcpy(&saved, &p->flow.kept[place_of(frame)], sizeof(saved));
    return bring_back(p, &saved);
}

static bool restore(struct program *p, const struct program_code *code)
{
    const struct program_frame *frame = &p->flow.frame[p->flow.calls];

    if (!frame->is_saved) {
        return takt_report_error_code(p, TAKT_ERROR_MODES_NOT_SAVED, code->step, 0.0);
    }
    if (!takt_saved_modes_restore(p, frame)) {
        return takt_report_error_code(p, TAKT_ERROR_CUTTER_ON, code->step, 0.0);
    }
    return takt_words_store(p, code->step, PARAMETER_SYSTEM, p->modes.system);
}

bool takt_saved_modes_run_code(struct program *p, const struct program_code *code)
{
    struct program_frame *frame = &p->flow.frame[p->flow.calls];
    struct program_saved saved;

    if (code->argument == 2) {
        return restore(p, code);
    }
    frame->is_saved = code->argument != 1;
    frame->restores = code->argument == 3 && p->flow.calls > 0;
    if (takt_saved_modes_end(frame) > PROGRAM_KEPT_MAX) {
        frame->is_saved = false;
        frame->restores = false;
        return takt_report_error_code(p, TAKT_ERROR_PROGRAM_FULL, code->step, 0.0);
    }
    if (frame->is_saved) {
        save(&p->modes, &saved);
        memcpy(&p->flow.kept[place_of(frame)], &saved, sizeof(saved));
    }
    return true;
}
