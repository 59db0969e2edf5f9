/*
 * Between the files of the service.
 */
#ifndef TAKT_SERVICE_SERVICE_PRIVATE_H
#define TAKT_SERVICE_SERVICE_PRIVATE_H

#include "service/service.h"

/* Layers of correction that have a coil: the first ones. */
#define SERVICE_LAYER_COILS (REGISTER_CORRECTION_WEAR - REGISTER_CORRECTION_MATRIX + 1)

/*
 * service_jobs.c: starting and ending what runs. False: there is no program, or it would leave the
 * travel.
 */
bool takt_service_start_program(struct service *s);
void takt_service_start_mdi(struct service *s, const char *line);
/* The line as a jog: it is given up by a hold. */
void takt_service_start_jog_line(struct service *s, const char *line);
/* An MDI line or more, of a source; config: of takt_service_controller_config, with it. */
void takt_service_start_text_of(struct service *s, const struct controller_config *config);
/* lines.c: the lines of a console, as they come. False: there is no console. */
bool takt_service_start_lines(struct service *s);
/* They have ended with the job. */
void takt_service_end_lines(struct service *s, enum panel_outcome outcome);
/* What the panel has written of the set-up of the part is taken: G10 L13. */
void takt_service_start_setup(struct service *s);
bool takt_service_jog_is_possible(const struct service *s, bool negative);
void takt_service_start_jog(struct service *s, bool negative);
/* Homing: first the drives, then the way to machine zero. */
void takt_service_start_home(struct service *s);
void takt_service_go_to_zero(struct service *s);
/* What ran has ended by itself, or has been given up. */
void takt_service_end_job(struct service *s, enum panel_outcome outcome);
/* Of what did not come to its end: what its lines behind that place have set counts no more. */
void takt_service_take_back(struct service *s);
/* The plan that has come, if any; and what comes of it is dropped. */
enum service_plan takt_service_open_plan(const struct service *s, struct replay_source *source);
void takt_service_forget_plan(struct service *s);
/* In the table; NULL: it is not there. */
struct tool *takt_service_find_tool(const struct service *s, uint32_t number);
/* What runs comes to rest and is dropped. */
void takt_service_give_up(struct service *s);

/* service.c */
struct controller_config takt_service_controller_config(const struct service *s);
/* Enables the drives again, and homes them again if told so. */
void takt_service_recover(struct service *s, bool home);
void takt_service_raise(struct service *s, enum panel_alarm alarm, const struct diagnostic *text);
void takt_service_hold(struct service *s, enum panel_hold reason);
/* The spindle has neither stood nor been lost in this hold, or is back at speed. */
bool takt_service_spindle_is_back(const struct service *s);

#endif
