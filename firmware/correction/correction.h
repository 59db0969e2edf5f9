/*
 * Position-error correction: commanded coordinates in, corrected ones out, every control cycle.
 *
 *     set = cmd + K,   K = w_1 K_1(cmd) + w_2 K_2(cmd) + ...   summed in the order of layers.h
 *
 * Each layer has a weight w that fades between 0 and 1 as it is switched; with every weight 0 set
 * is cmd, to the last bit. The position shown to users is cmd.
 */
#ifndef TAKT_CORRECTION_CORRECTION_H
#define TAKT_CORRECTION_CORRECTION_H

#include "base/error.h"
#include "base/point.h"
#include "correction/fade.h"
#include "correction/layers.h"
#include "correction/need.h"
#include "correction/settings.h"
#include "correction/table.h"
#include "correction/tables.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

#include "correction/correction_state.h"

/*
 * tables: NULL for none; must outlive c or be replaced by takt_correction_load. start: where the
 * machine stands.
 */
void takt_correction_init(struct correction *c, const struct correction_settings *settings,
                          unsigned axes, double cycle_s, const struct correction_tables *tables,
                          const struct point *start);

/*
 * The next motion begins at a setpoint that is taken for a commanded position: nothing is corrected
 * there, and all layers fade in anew. What tools have worn stays.
 */
void takt_correction_restart(struct correction *c, const struct point *start);

/* One control cycle. move: the one being executed; what the program switches travels with it. */
void takt_correction_cycle(struct correction *c, const struct point *cmd, const struct move *move,
                           struct point *set);

/*
 * The same while no program moves the axes: they stand at cmd, and what fades goes on. What the
 * program has switched last stays so.
 */
void takt_correction_stand(struct correction *c, const struct point *cmd, struct point *set);

/*
 * The correction at a point, without any history: layers that are on have full weight, directions
 * of approach their mean, tools no wear. For planning and offline use; *c stays as it is.
 */
void takt_correction_evaluate(const struct correction *c, const struct point *at,
                              const struct move *move, struct point *k);

/*
 * The operator switches a layer: it fades in or out. A layer is on if machine file or operator, and
 * the program, let it.
 */
void takt_correction_switch(struct correction *c, enum correction_layer_number layer, bool on);

/* A sensor says how much warmer than at calibration an axis is. */
void takt_correction_set_rise(struct correction *c, enum axis axis, double rise_k);

/* How long and how far a tool has cut; for the caller to keep between programs. */
void takt_correction_set_wear(struct correction *c, uint32_t tool, double length_mm, double time_s);
void takt_correction_get_wear(const struct correction *c, uint32_t tool, double *length_mm,
                              double *time_s);

/*
 * Exchanges the tables while axes may be moving: the table layers fade out, then in with the new
 * tables. False: the new ones would take more of the axes than has been reserved, *wrong says
 * where; the old ones stay. Old and new must stay where they are until takt_correction_is_loading
 * is false.
 */
bool takt_correction_load(struct correction *c, const struct correction_tables *tables,
                          struct diagnostic *wrong);
bool takt_correction_is_loading(const struct correction *c);

/*
 * The set-up of the part. The background tells its numbers one by one, of those
 * CORRECTION_SETUP_VALUES, and has them taken together: they are weighed and made ready there,
 * once, while the control cycle may interrupt. The layer fades out, the cycle changes over, and the
 * layer fades in.
 */
void takt_correction_tell_setup(struct correction *c, unsigned which, double value);
/*
 * False: it would take more of the axes than has been reserved, and what is in force stays. Not
 * while one is exchanged.
 */
bool takt_correction_take_setup(struct correction *c);
/* What has been told and not taken is forgotten. */
void takt_correction_forget_setup(struct correction *c);
/* What has been told is in force, or about to be. */
bool takt_correction_is_set_up(const struct correction *c);
/* What has been taken is not wholly in force yet. */
bool takt_correction_is_setting_up(const struct correction *c);
/* Takes it into force at once: offline, where nothing fades. */
void takt_correction_settle_setup(struct correction *c);
/* The numbers that are in force, or about to be. */
void takt_correction_get_setup(const struct correction *c, double number[CORRECTION_SETUP_VALUES]);

/* The rules tables have to keep on this machine. */
void takt_correction_table_rules(const struct correction_settings *settings, unsigned axes,
                                 struct table_rules *rules);

/*
 * What all layers together take of the axes at most, fading included, while commanded motion does
 * at most *most.
 */
void takt_correction_get_need(const struct correction *c, const struct motion_bound *most,
                              struct need *need);

/*
 * What the planner has to leave: the need of what is loaded, or the reserve if that is more, in
 * *need. Later loads are held against it.
 */
void takt_correction_reserve(struct correction *c, const struct motion_bound *most,
                             struct need *need);

/* More than this part of an axis is not left to correction: a machine that needs it is refused. */
#define CORRECTION_SHARE_MAX 0.5

/*
 * The greatest part of its velocity, acceleration or jerk that an axis gives up, 0 ...; *axis says
 * which one does.
 */
double takt_correction_largest_share(const struct need *need, const struct motion_bound *most,
                                     enum axis *axis);

/* Bit i set: layer i corrects something now, or is fading. */
unsigned takt_correction_get_running(const struct correction *c);
/* Bit i set: layer i has something to correct. */
unsigned takt_correction_get_present(const struct correction *c);
const char *takt_correction_layer_name(enum correction_layer_number layer);

/*
 * Bit i set: axis i has been beyond the end of a table, where the edge value holds; since the last
 * call.
 */
unsigned takt_correction_take_outside(struct correction *c);

#endif
