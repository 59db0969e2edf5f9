/*
 * `takt serve` at work: the controller as a service, paced by the wall clock, on its bus, with
 * spindle and panel.
 *
 *     panel's thread  --- orders --->  exchange  --->  takt_service_order      control thread
 *                     <-- snapshots -            <---  takt_service_cycle  ->  field (bus, drives)
 *                                                                     ->  spindle
 */
#ifndef TAKT_HOST_SERVING_H
#define TAKT_HOST_SERVING_H

#include "cli/status.h"
#include "port/plan_queue.h"
#include "serve/exchange.h"
#include "serve/panel_host.h"
#include "serve/program_store.h"
#include "serve/server.h"
#include "service/service.h"
#include "serving/serving_console.h"
#include "serving/serving_options.h"
#include "serving/serving_page.h"
#include "serving/serving_spindle.h"
#include "serving/serving_state.h"
#include "session/session.h"
#include "simulation/bus_log.h"
#include "simulation/cycle_cost.h"
#include "simulation/drive_network.h"
#include "simulation/ending.h"

#include <stdbool.h>
#include <stdint.h>

/* It must not be moved once opened. Private. */
struct serving {
    struct session session;
    struct serving_options options;
    struct drive_network network;
    struct service service;
    struct controller_reader reader; /* of the service */
    struct shape shape;              /* likewise, if the machine has a shaper */
    struct serving_spindle spindle;
    struct inputs inputs; /* of the next cycle */
    struct program_store store;
    struct plan_queue plan;
    struct exchange exchange;
    struct panel_host panel;
    struct server server;
    struct serving_page page;
    struct serving_console console;
    struct cycle_cost cost;
    struct bus_log bus_log;
    struct ending ending;
    struct serving_state state;
    uint64_t cycles;
    bool has_told_drives;                                  /* what they do without */
    bool has_field, has_service, has_exchange, has_server; /* are open */
};

/*
 * Opens everything the options name, starts nothing. STATUS_DONE, else after messages;
 * serving_close is due.
 */
enum command_status serving_open(struct serving *serving, const struct options *options);
void serving_close(struct serving *serving);

/*
 * Serves until a signal comes, or the bus log cannot be written, and comes to rest in order.
 * STATUS_DONE; STATUS_INTERRUPTED: a second signal has cut that short; else after a message.
 */
enum command_status serving_run(struct serving *serving);

#endif
