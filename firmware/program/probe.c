#include "program/probe.h"

#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

static bool check(struct program *p, const struct program_code *code, const struct point *end)
{
    if ((p->words.given & LETTERS_AXES) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    if (p->modes.inverse_time || p->modes.per_revolution) {
        return takt_report_error_code(p, TAKT_ERROR_FEED_MODE_UNFIT, code->step, 0.0);
    }
    if ((code->argument & PROBE_OPTIONAL) == 0 && point_is_same(end, &p->modes.at)) {
        return takt_report_error_code(p, TAKT_ERROR_PROBE_NO_WAY, code->step, 0.0);
    }
    return true;
}

/* The position as the program sees it, and whether there was contact. */
static bool store_result(struct program *p, enum step step, double contact)
{
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (!takt_words_store(p, step, PARAMETER_PROBE + i, takt_coordinates_work(p, i))) {
            return false;
        }
    }
    return takt_words_store(p, step, PARAMETER_PROBE_CONTACT, contact);
}

bool takt_probe_move(struct program *p, const struct program_code *code)
{
    struct point end;
    struct move m;

    takt_coordinates_end(p, &end);
    if (!check(p, code, &end)) {
        return false;
    }
    p->modes.motion = code;
    takt_emit_prepare(p, MOVE_PROBE, &end, &m);
    m.probe_away = (code->argument & PROBE_AWAY) != 0;
    m.probe_optional = (code->argument & PROBE_OPTIONAL) != 0;
    return takt_emit_motion(p, &m) && store_result(p, code->step, 0.0);
}

void takt_probe_take(struct program *p, const struct program_answer *answer)
{
    p->modes.at = answer->contact_at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        (void)takt_parameters_set(p->config.parameters, PARAMETER_PROBE + i,
                                  takt_coordinates_work(p, i));
    }
    (void)takt_parameters_set(p->config.parameters, PARAMETER_PROBE_CONTACT,
                              answer->contact ? 1.0 : 0.0);
    p->modes.at = answer->rest_at;
}
