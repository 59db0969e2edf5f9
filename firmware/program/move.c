#include "program/move.h"

bool takt_move_curve(const struct move *m, const struct point *start, struct curve *c)
{
    if (move_is_arc(m)) {
        return takt_curve_set_arc(c, start, &m->end, m->plane, m->centre_mm, m->kind == MOVE_ARC_CW,
                                  m->turns);
    }
    if (move_is_involute(m)) {
        return takt_curve_set_involute(c, start, &m->end, m->plane, m->centre_mm, m->base_radius_mm,
                                       m->kind == MOVE_INVOLUTE_CW);
    }
    if (m->kind == MOVE_SPLINE) {
        return takt_curve_set_quintic(c, start, &m->end, m->plane,
                                      &(struct curve_course){
                                          {m->heading_rad[0], m->heading_rad[1]},
                                          {m->curvature_1_mm[0], m->curvature_1_mm[1]},
                                          m->spline_mm,
                                      });
    }
    return takt_curve_set_line(c, start, &m->end);
}
