/*
 * The controller as a service: the states above single programs, what the operator's panel orders,
 * and what is shown to it. Jog, homing and MDI are programs of a line or two, so they run through
 * the same planner, limits and drives.
 *
 *     takt_service_order        what a panel wants: all of it or nothing, at once
 *     takt_service_background   reads and plans ahead, as often as there is time
 *     takt_service_cycle        one control cycle
 *     takt_service_look         everything a panel can read
 *
 * takt_service_cycle may interrupt takt_service_background, as the interrupt of a target does.
 * Otherwise the caller sees to it that none of these runs while another does.
 */
#ifndef TAKT_SERVICE_SERVICE_H
#define TAKT_SERVICE_SERVICE_H

#include "console/console.h"
#include "controller/controller.h"
#include "controller/restart.h"
#include "panel/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Programs as the service sees them; what an upload has brought waits beside until it is adopted.
 */
struct service_programs {
    /* A source at the beginning of the program. False: there is none. */
    bool (*open)(void *context, struct source *source);
    /* What the last upload brought becomes the program. No program runs. */
    void (*adopt)(void *context);
    void *context; /* owned by whoever made it */
};

enum service_plan {
    SERVICE_PLAN_NONE,  /* the program is planned as it runs */
    SERVICE_PLAN_READY, /* it fits */
    SERVICE_PLAN_UNFIT  /* it has been announced, but cannot be started, or not yet */
};

/* A program planned ahead that comes while it runs. All in the control thread. */
struct service_plans {
    /*
     * One for the program that is there is about to come; what was there before is dropped. NULL:
     * none can come.
     */
    void (*announce)(void *context);
    enum service_plan (*open)(void *context, struct replay_source *source);
    void (*forget)(void *context);
    void *context; /* owned by whoever made it */
};

/*
 * Lines of a console: a program whose text comes while it runs, as many lines as there are. read
 * and refuse are called by the background, between two cycles or not; the rest between two cycles.
 */
struct service_lines {
    /*
     * A source of the lines that come; when it is asked for the next one, the last one has been
     * taken. NULL: no console.
     */
    void (*open)(void *context, struct source *source);
    /* The line handed out last is wrong; it has changed nothing, and those after it go on. */
    void (*refuse)(void *context, const struct diagnostic *why);
    /* Nothing reads any more. why: TAKT_OK: all that was read has been done. */
    void (*end)(void *context, enum takt_error why);
    void *context; /* owned by whoever made it */
};

struct service_config {
    const struct machine *machine;    /* copied */
    struct controller_reader *reader; /* its alone; must outlive the service */
    struct step_port step;            /* pulses; not used by a machine without step drives */
    const struct concise_dcf *dcf;    /* as of struct controller_config */
    struct can_buses can;
    struct tool *tools; /* read and written; tools_count of them */
    size_t tools_count;
    struct parameters *parameters;              /* read and written */
    const struct correction_tables *correction; /* NULL: none; must outlive the service */
#ifndef SHAPE_IS_ABSENT
    struct shape *shape; /* as of struct controller_config */
#endif
    struct service_programs programs;
    struct service_plans plans;
    struct service_lines lines;
    bool exact_path; /* every G64 is treated as G61 */
};

/* What only the platform knows, for the panel. */
struct service_health {
    double bus_load_percent;
    uint32_t cycle_min_ns, cycle_mean_ns, cycle_max_ns;
    uint32_t overruns; /* cycles that began later than the next one was due */
};

/* What runs. */
enum service_job { SERVICE_NOTHING, SERVICE_PROGRAM, SERVICE_MDI, SERVICE_JOG, SERVICE_HOME };

#include "service/service_state.h"

void takt_service_init(struct service *s, const struct service_config *config);

/* The program that is there at power-on, for the panel to show. */
void takt_service_set_program(struct service *s, uint32_t size, uint32_t crc);

/* Where the next program starts; 0: at its beginning. */
void takt_service_set_start_line(struct service *s, uint32_t line);
/*
 * The line at which the program that runs is, or the last one was cut short; 0: it has come to its
 * end.
 */
uint32_t takt_service_get_cut_line(const struct service *s);

/* Between two cycles. Nothing has changed unless PANEL_DONE. */
enum panel_verdict takt_service_order(struct service *s, const struct panel_order *order);

/* The panel in control has been heard. */
void takt_service_alive(struct service *s);

void takt_service_background(struct service *s);

/* inputs: the world's; overrides and hold of it are the panel's, and not used. */
void takt_service_cycle(struct service *s, const struct inputs *inputs);

/* What the outputs are to be after the last cycle: the controller's, with the spindle override. */
struct outputs takt_service_get_outputs(const struct service *s);

/* True once after a trip of the spindle has been acknowledged: its drive is to be reset. */
bool takt_service_take_spindle_reset(struct service *s);

/*
 * This bus is gone, and its drives stop by themselves: an alarm, and all stop. Every cycle as long
 * as it is.
 */
void takt_service_lose_bus(struct service *s, unsigned bus);

enum panel_state takt_service_get_state(const struct service *s);

void takt_service_set_health(struct service *s, const struct service_health *health);
/* What a console asks for. */
void takt_service_tell(const struct service *s, enum console_fact fact, double value[AXIS_COUNT]);
void takt_service_look(const struct service *s, struct panel_snapshot *snapshot);

#endif
