/*
 * Contract of a Modbus client: registers of one other device, one request at a time, non-blocking.
 *
 * A port may be a thread with libmodbus on the host, or an interrupt-driven serial line of a
 * microcontroller.
 */
#ifndef TAKT_HAL_REGISTERS_H
#define TAKT_HAL_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

#define REGISTERS_MAX 16 /* in one request */

enum registers_answer {
    REGISTERS_WAITING, /* the request is under way, or there is none */
    REGISTERS_DONE,    /* it is answered: told once */
    REGISTERS_FAILED   /* no answer in time, or an exception: told once */
};

struct registers_port {
    /*
     * Begins a request (functions 03 and 16); the answer to the one before has been taken. count: 1
     * ... REGISTERS_MAX. Must not wait.
     */
    void (*read)(void *context, uint16_t address, uint16_t count);
    void (*write)(void *context, uint16_t address, uint16_t count, const uint16_t *word);
    /*
     * What has become of it; after a read that is done, word[REGISTERS_MAX] holds its words. Must
     * not wait.
     */
    enum registers_answer (*take)(void *context, uint16_t *word);
    void *context; /* owned by whoever made the port */
};

#endif
