/*
 * What a controller that outlives its programs needs beyond controller.h: one program after another
 * from where the axes stand, giving one up, stopping at once, and enabling the drives again. Called
 * between two cycles.
 */
#ifndef TAKT_CONTROLLER_RESTART_H
#define TAKT_CONTROLLER_RESTART_H

#include "controller/controller.h"

/*
 * Reads another program, from start on: the last setpoint, without correction, which goes on as it
 * is. The axes are at rest there, and the last program has been completed or dropped. machine,
 * reader and can of the configuration are those of takt_controller_init. The drives, the outputs
 * and the parameters stay as they are.
 */
void takt_controller_start_program(struct controller *c, const struct controller_config *config,
                                   const struct point *start);

/*
 * Gives the program up where it is: no more setpoints come from it. The axes are at rest.
 * CONTROLLER_COMPLETED.
 */
void takt_controller_drop_program(struct controller *c);

/*
 * Background, after the program has been given up or has failed: what its lines have made of
 * offsets and other parameters that last is taken back, if nothing behind them has been begun.
 * False: there were so many such lines that some of it could not be.
 */
bool takt_controller_take_back(struct controller *c);

/*
 * All drives brake by themselves, outputs that move or turn something go off. CONTROLLER_FAULTED,
 * for this reason or fault.
 */
void takt_controller_stop_at_once(struct controller *c, enum takt_error reason);
void takt_controller_stop_for(struct controller *c, const struct diagnostic *fault);

/*
 * The end of everything: the axes come to rest on their path, then every drive brakes and is off;
 * or, at once, without the path. Cycles go on until takt_controller_has_ended. The second one of
 * these may follow the first.
 */
void takt_controller_end(struct controller *c, bool at_once);
bool takt_controller_has_ended(const struct controller *c);

/*
 * After CONTROLLER_FAULTED, or at rest between programs: resets and enables the drives again where
 * they stand; until a drive reports, that is where it was. CONTROLLER_STARTING, then
 * CONTROLLER_COMPLETED after an empty program: config->source is empty. home: axes that are homed
 * at start are homed again, else only if they have not been. Correction fades in anew.
 */
void takt_controller_recover(struct controller *c, const struct controller_config *config,
                             bool home);

/* The last cycle has passed M0 or M1 that its inputs wanted, and nothing behind it. */
bool takt_controller_passed_stop(const struct controller *c);

/*
 * What the axes do ends with the setpoint: what is sent has come to it, and no tap still turns the
 * spindle.
 */
bool takt_controller_is_settled(const struct controller *c);

/* Spindle and coolant off. */
void takt_controller_quieten(struct controller *c);

/*
 * While CONTROLLER_STARTING, before each cycle: the setpoint is where the drives stand, so that
 * none of them moves when it is enabled. Returns it in *at.
 */
void takt_controller_follow_drives(struct controller *c, struct point *at);

#endif
