/*
 * The console: Grbl 1.1's interface, for the senders people have. Bytes of a sender in, answers
 * out; it does nothing itself and knows no controller.
 *
 *     byte -> real-time order, at once
 *          -> line -> text of a program -> lines.h -> the program that runs; "ok" when it asks for the next line
 *                  -> $ command -> an order of the panel, or a report
 *
 * Its orders are those of a client of the panel, by the panel's rules. No input or output. One
 * thread calls it, beside the one that reads the lines.
 */
#ifndef TAKT_CONSOLE_CONSOLE_H
#define TAKT_CONSOLE_CONSOLE_H

#include "console/lines.h"
#include "console/reply.h"
#include "machine/machine.h"
#include "panel/snapshot.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * What a console asks the controller for besides its registers: six numbers, of X Y Z A B C, in mm
 * and degrees.
 */
enum console_fact {
    CONSOLE_FACT_SYSTEM, /* offset of G54; the next ones are G55 ... G59.3 */
    CONSOLE_FACT_REFERENCE_1 = 9,
    CONSOLE_FACT_REFERENCE_2,
    CONSOLE_FACT_AXIS_OFFSET, /* G92 */
    CONSOLE_FACT_TOOL_OFFSET,
    CONSOLE_FACT_PROBE, /* where it answered last, machine coordinates */
    /* not of axes: 1 if that probing ended by contact, F in mm/min, S, the digit of M3 M4 M5, T */
    CONSOLE_FACT_WORDS,
};

/* What stands behind a console. None of these may keep the control cycle waiting. */
struct console_port {
    void (*look)(void *context, struct panel_snapshot *snapshot);
    /* As a client of the panel. */
    enum panel_refusal (*order)(void *context, const struct panel_order *order);
    enum panel_refusal (*unlock)(void *context, uint32_t password);
    /* False: it cannot be told now. */
    bool (*tell)(void *context, enum console_fact fact, double value[AXIS_COUNT]);
    /*
     * Reads a line of a program and does nothing; begins: the first one. NULL: there is no check
     * mode.
     */
    enum takt_error (*check)(void *context, const char *line, bool begins);
    void (*write)(void *context, const char *text, size_t length);
    void *context; /* owned by whoever made the port */
};

struct console_config {
    struct console_port port;
    const struct machine *machine; /* must stay */
    struct lines *lines;           /* its alone, but for the program that reads them */
    const char *version;           /* of the firmware; must stay */
};

/* Private, but the caller owns it. */
struct console {
    struct console_config config;
    struct reply reply;
    uint32_t pending; /* lines of a program whose answer is to come */
    uint32_t turned;  /* register CYCLES from which on it is known whether the spindle turns */
    uint32_t settled; /* register CYCLES from which on snapshots know that the program has ended */
    bool is_settling; /* until then */
    bool was_active;  /* the program of the lines ran */
    bool was_alarm;
    bool is_locked;   /* until $X */
    bool is_asleep;   /* until ^X */
    bool is_checking; /* $C */
    bool has_checked; /* a line, since */
    bool is_door;     /* held by 0x84 */
    bool resets;      /* ^X has been ordered: all comes to rest, and what was to come is dropped */
    bool resumes;     /* when the spindle turns again */
    bool jogs;        /* $J has been ordered */
    bool homes;       /* $H has been ordered */
    bool has_return;  /* the last byte was a CR */
    uint8_t mask;     /* $10 */
    bool in_inches;   /* $13 */
};

void takt_console_init(struct console *c, const struct console_config *config);

/* A sender has come: what the last one left is dropped, and it is welcomed. */
void takt_console_enter(struct console *c);

/* The sender has gone: what it jogs stops at once. */
void takt_console_leave(struct console *c);

/* Another byte of text finds room; real-time bytes always do. */
bool takt_console_has_room(const struct console *c);
void takt_console_take(struct console *c, uint8_t byte);

/* What can be done is done: answers, lines, alarms. As often as there is time. */
void takt_console_step(struct console *c);

/* It waits for something: step is wanted again soon. */
bool takt_console_is_waiting(const struct console *c);

#endif
