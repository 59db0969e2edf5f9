/*
 * What every image of the firmware consists of, whatever processor it is for: the service, its
 * panel on one serial line, the program it is being sent, and a log. A port adds a timer, a CAN
 * controller, two serial lines and a memory for settings, and calls
 *
 *     takt_embedded_cycle        from the interrupt of the control cycle
 *     takt_embedded_take_byte    from the interrupt of the panel's line
 *     takt_embedded_background   from main, for ever
 *
 * takt_embedded_cycle may interrupt the other two, takt_embedded_take_byte may interrupt all.
 * Nothing here waits.
 */
#ifndef TAKT_PORT_EMBEDDED_H
#define TAKT_PORT_EMBEDDED_H

#include "modbus/rtu.h"
#include "panel/panel.h"
#include "port/line_ring.h"
#include "port/plan_queue.h"
#include "port/text_queue.h"
#include "service/service.h"

#include <stdbool.h>
#include <stdint.h>

/* Longest line of the log, with its zero. */
#define EMBEDDED_LOG_MAX 256

/* What a port does for the image. All are called from the background, but for now_ns. */
struct embedded_port {
    /* Keeps the control cycle from beginning until unlock; nothing nests. */
    void (*lock)(void *context);
    void (*unlock)(void *context);
    /*
     * Time that wraps: of bytes on the line, where it may be a millisecond off; of how long a cycle
     * takes.
     */
    uint32_t (*now_us)(void *context);
    uint32_t (*now_ns)(void *context);
    /*
     * Queues the bytes of a reply on the panel's line, after the silence that its rate asks for.
     * Must not wait: the bytes are copied; a reply before the last one has gone is lost.
     */
    void (*reply)(void *context, const uint8_t *bytes, size_t length);
    /* A line of the log, without its end; zero-terminated. What finds no room is lost. */
    void (*log)(void *context, const char *text);
    void *context; /* owned by whoever made the port */
};

/*
 * What programs and their panel take. Only the processor touches it, so it may lie where nothing
 * else reaches (startup.h). Private.
 */
struct embedded_core {
    struct controller_reader reader;
    struct parameters parameters;
    struct text_queue queue;
    struct plan_queue plan;
    struct panel panel;
    struct panel_client client;
    struct modbus_rtu rtu;
};

struct embedded_config {
    const struct machine *machine; /* copied */
    struct embedded_core *core;    /* its alone; must outlive it */
    struct can_buses can;
    struct step_port step;
    struct tool *tools; /* tools_count of them, read and written; the caller's */
    size_t tools_count;
    const struct correction_tables *correction; /* NULL: none */
    const struct concise_dcf *dcf;              /* as of struct controller_config */
    struct embedded_port port;
    const struct service_lines
        *lines;                  /* copied: of a console (port/embedded_console.h); NULL: none */
    struct panel_store settings; /* where settings are brought to; begin is NULL: nowhere */
    uint8_t unit;                /* of the panel's line, 1 ... 247 */
    uint32_t gap_us;             /* that ends a frame on it: takt_modbus_rtu_gap_us, or more */
    uint32_t password;           /* of the panel; 0: none is asked for */
    const char *name;            /* of the image, for the log */
};

/* Private, but the caller owns it. */
struct embedded {
    struct embedded_config config;
    struct service service;
    struct line_ring received; /* on the panel's line */
    uint32_t line_us;          /* of it: the sum of its silences */
    bool refused;
    struct diagnostic refusal;
    volatile uint32_t cycles; /* begun since power-on */
    volatile uint32_t overruns;
    uint32_t cycle_min_ns, cycle_max_ns; /* since power-on */
    uint64_t cycle_sum_ns;
    enum panel_state logged_state;
    enum panel_alarm logged_alarm;
    uint16_t logged_runs;
};

/* Everything is ready and at rest; the first takt_embedded_cycle sends the first frames. */
void takt_embedded_init(struct embedded *e, const struct embedded_config *config);

/*
 * The machine must not run, and why: the image is damaged, its settings are, there is no CAN
 * controller. The panel and the log say so; the control cycle does nothing from then on, so no
 * drive hears anything. Uploads are still taken.
 */
void takt_embedded_refuse(struct embedded *e, const struct diagnostic *why);

/* One control cycle. late: the one before has not ended in time. */
void takt_embedded_cycle(struct embedded *e, const struct inputs *inputs, bool late);

/* What the outputs of the machine are to be after the last cycle. */
struct outputs takt_embedded_get_outputs(const struct embedded *e);

/* A byte has come on the panel's line. */
void takt_embedded_take_byte(struct embedded *e, uint8_t byte, uint32_t now_us);

/*
 * Reads and plans ahead, answers the panel, writes the log. Then the processor may sleep until the
 * next interrupt.
 */
void takt_embedded_background(struct embedded *e);

#endif
