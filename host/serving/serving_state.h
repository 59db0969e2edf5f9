/*
 * `takt serve --state`: what the service keeps over its end, a crash and a power cut, in a folder
 * of its own: work offsets and other parameters, tools with their wear, the program and the line
 * where it was cut short.
 *
 * What a file says counts again when the file has changed since (its tools, its parameters).
 */
#ifndef TAKT_HOST_SERVING_STATE_H
#define TAKT_HOST_SERVING_STATE_H

#include "cli/status.h"
#include "serve/state_keeper.h"
#include "service/service.h"
#include "session/session.h"

#include <stdbool.h>
#include <stdint.h>

#define SERVING_STATE_PATH_MAX 4096

/* It must not be moved once opened. Private. */
struct serving_state {
    bool is_kept; /* else nothing below is in use */
    bool has_told;
    char folder[SERVING_STATE_PATH_MAX];
    char program[SERVING_STATE_PATH_MAX]; /* of the program that a panel has brought */
    int lock;
    struct state_keeper keeper;
    struct state kept; /* as it was at the start */
    uint32_t tools_base, parameters_base;
    size_t tools_count;
};

/*
 * Opens the folder of --state and takes from it what belongs into the session. STATUS_DONE; else
 * after a message.
 */
enum command_status serving_state_open(struct serving_state *state, struct session *session);
/* Where programs of panels are kept; NULL: nowhere. */
const char *serving_state_get_program(const struct serving_state *state);
/* After takt_service_init: what belongs into the service. */
void serving_state_restore(const struct serving_state *state, struct service *service);
/* The thread that writes. STATUS_DONE, else after a message. */
enum command_status serving_state_start(struct serving_state *state);

/* Every cycle. */
void serving_state_keep(struct serving_state *state, const struct service *service,
                        uint64_t now_ns);
/* Keeps the last; service: NULL: there is none. False after a message. */
bool serving_state_close(struct serving_state *state, const struct service *service);

#endif
