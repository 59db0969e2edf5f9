/*
 * Between the files of the console.
 */
#ifndef TAKT_CONSOLE_CONSOLE_PRIVATE_H
#define TAKT_CONSOLE_CONSOLE_PRIVATE_H

#include "console/console.h"
#include "console/numbers.h"

/* $10 */
#define CONSOLE_MASK_MACHINE 1U /* positions of the machine, not of the work */
#define CONSOLE_MASK_BUFFER  2U

/* What became of a $ command. */
enum console_result {
    CONSOLE_ANSWERED,
    CONSOLE_WAITS /* it is tried again */
};

/* ---- reply ---- */
void takt_console_line_end(struct console *c);
/* "ok" or "error:N" for the line being answered. */
void takt_console_answer(struct console *c, enum console_error error);
void takt_console_message(struct console *c, const char *text);
void takt_console_welcome(struct console *c);
/* Lengths in the units of $13. */
void takt_console_axes(struct console *c, const double value[AXIS_COUNT]);

/* ---- orders ---- */
enum panel_refusal takt_console_order(struct console *c, enum panel_id id, int64_t value);
enum panel_refusal takt_console_order_two(struct console *c, enum panel_id id, int64_t value,
                                          enum panel_id second, int64_t second_value);
/* The order has been refused, and the line with it, unless it may be tried again. */
enum console_result takt_console_refuse(struct console *c, enum panel_refusal refusal);

/* A real-time byte. False: it is text. */
bool takt_console_take_realtime(struct console *c, uint8_t byte);
/* A line that begins with '$', without it. */
enum console_result takt_console_command(struct console *c, const char *text,
                                         const struct panel_snapshot *now);
enum console_result takt_console_jog(struct console *c, const char *text,
                                     const struct panel_snapshot *now);

/* ---- reports ---- */
void takt_console_report_status(struct console *c);
void takt_console_report_modes(struct console *c, const struct panel_snapshot *now);
void takt_console_report_offsets(struct console *c);
void takt_console_report_probe(struct console *c);
void takt_console_report_build(struct console *c, bool extended);
void takt_console_report_settings(struct console *c);
/* "$10=2", without the '$'. */
enum console_error takt_console_set(struct console *c, const char *text);

static inline enum panel_state console_state(const struct panel_snapshot *now)
{
    return (enum panel_state)now->value[REGISTER_STATE];
}

#endif
