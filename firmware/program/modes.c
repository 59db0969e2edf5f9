#include "program/modes.h"

#include "base/maths.h"
#include "program/report.h"
#include "program/words.h"

#include <string.h>

#define MM_PER_INCH        25.4
#define SECONDS_PER_MINUTE 60.0
#define RAD_PER_DEGREE     (MATHS_PI / 180.0)

/*
 * Offsets are in the parameters, from where they are loaded; compensation ends with the text it was
 * switched on in.
 */
static void go_on(struct program *p)
{
    struct program_modes *m = &p->modes;

    *m = *p->config.modes;
    memset(&m->axis_offset, 0, sizeof(m->axis_offset));
    m->at = p->config.start;
    m->cutter_code = NULL;
    m->cutter_side = CUTTER_OFF;
    m->cutter_moved = false;
    m->cutter_left = false;
    p->config.modes = NULL;
}

void takt_modes_open(struct program *p)
{
    if (p->config.modes != NULL) {
        go_on(p);
        return;
    }
    memset(&p->modes, 0, sizeof(p->modes));
    p->modes.at = p->config.start;
    p->modes.unit_mm = 1.0;
    p->modes.plane = PLANE_XY;
    p->modes.path = PATH_EXACT;
    p->modes.direction = SPINDLE_OFF;
    p->modes.retract_to_r = true;
    p->modes.overrides = OVERRIDE_FEED | OVERRIDE_SPINDLE | OVERRIDE_HOLD;
}

/* An F of the other mode means nothing in this one. */
bool takt_modes_set_feed_mode(struct program *p, const struct program_code *code)
{
    struct program_modes *m = &p->modes;
    const bool inverse_time = code->argument == FEED_INVERSE_TIME;
    const bool per_revolution = code->argument == FEED_PER_REVOLUTION;

    if (inverse_time != m->inverse_time || per_revolution != m->per_revolution) {
        m->inverse_time = inverse_time;
        m->per_revolution = per_revolution;
        m->feed_mm_s = 0.0;
        m->feed_rad_s = 0.0;
        m->feed_rev_mm = 0.0;
        m->feed_rev_rad = 0.0;
    }
    return true;
}

/* With G93 the F of a line is for its motion alone, which reads it itself. */
bool takt_modes_set_feed(struct program *p, const struct program_code *code)
{
    const double feed = words_value(p, 'f');

    (void)code;
    if (feed < 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'f', feed);
    }
    if (p->modes.per_revolution) {
        p->modes.feed_rev_mm = feed * p->modes.unit_mm;
        p->modes.feed_rev_rad = feed * RAD_PER_DEGREE;
    } else if (!p->modes.inverse_time) {
        p->modes.feed_mm_s = feed * p->modes.unit_mm / SECONDS_PER_MINUTE;
        p->modes.feed_rad_s = feed * RAD_PER_DEGREE / SECONDS_PER_MINUTE;
    }
    return true;
}

bool takt_modes_set_plane(struct program *p, const struct program_code *code)
{
    p->modes.plane = (enum plane)code->argument;
    return true;
}

bool takt_modes_set_units(struct program *p, const struct program_code *code)
{
    p->modes.unit_mm = code->argument == 1 ? MM_PER_INCH : 1.0;
    return true;
}

/* Q, or else P: how far short moves may be off the line that replaces them. */
static bool set_merge(struct program *p)
{
    const double merge = words_has(p, 'q') ? words_value(p, 'q') : 0.0;

    p->modes.merge_mm = words_has(p, 'q') ? merge * p->modes.unit_mm : p->modes.tolerance_mm;
    return merge >= 0.0 || takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'q', merge);
}

static bool set_tolerance(struct program *p)
{
    if (!words_has(p, 'p')) {
        p->modes.tolerance_mm = p->config.path_tolerance_mm;
        return true;
    }
    const double tolerance = words_value(p, 'p');

    p->modes.tolerance_mm = tolerance * p->modes.unit_mm;
    return tolerance >= 0.0 ||
           takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'p', tolerance);
}

bool takt_modes_set_path(struct program *p, const struct program_code *code)
{
    p->modes.path = (enum move_path)code->argument;
    if (p->modes.path != PATH_BLEND) {
        return true;
    }
    if (p->config.exact_path) {
        p->modes.path = PATH_EXACT;
    }
    return set_tolerance(p) && set_merge(p);
}

bool takt_modes_set_distance(struct program *p, const struct program_code *code)
{
    p->modes.incremental = code->argument == 1;
    return true;
}

bool takt_modes_set_centre(struct program *p, const struct program_code *code)
{
    p->modes.centre_absolute = code->argument == 1;
    return true;
}

bool takt_modes_set_diameter(struct program *p, const struct program_code *code)
{
    p->modes.diameter = code->argument == 1;
    return true;
}

bool takt_modes_set_retract(struct program *p, const struct program_code *code)
{
    p->modes.retract_to_r = code->argument == 1;
    return true;
}

static void switch_overrides(struct program *p, unsigned which, bool on)
{
    p->modes.overrides = on ? p->modes.overrides | which : p->modes.overrides & ~which;
}

bool takt_modes_set_overrides(struct program *p, const struct program_code *code)
{
    switch_overrides(p, OVERRIDE_FEED | OVERRIDE_SPINDLE, code->argument == 1);
    return true;
}

/* On without P, and with any P but 0. */
bool takt_modes_set_override(struct program *p, const struct program_code *code)
{
    switch_overrides(p, (unsigned)code->argument, !words_has(p, 'p') || words_value(p, 'p') != 0.0);
    return true;
}

/* Layer P of position-error correction, from 1; without P all of them. */
bool takt_modes_set_correction(struct program *p, const struct program_code *code)
{
    const uint32_t layers = p->config.correction_layers;
    uint32_t layer = 0;
    unsigned which = (1U << layers) - 1U;

    if (words_has(p, 'p')) {
        if (!takt_words_whole(p, 'p', 1.0, layers, &layer)) {
            return false;
        }
        which = 1U << (layer - 1U);
    }
    p->modes.correction_off = (uint8_t)(code->argument == 1 ? p->modes.correction_off & ~which
                                                            : p->modes.correction_off | which);
    return true;
}

bool takt_modes_accept(struct program *p, const struct program_code *code)
{
    (void)p;
    (void)code;
    return true;
}
