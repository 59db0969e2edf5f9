/* takt panel: read and write the panel of a running controller by name. */
#define _POSIX_C_SOURCE 200809L

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/suggest.h"
#include "serving/panel_line.h"
#include "serving/panel_table.h"
#include "serving/panel_upload.h"
#include "simulation/drives_table.h"
#include "takt/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define INTERVAL_S      0.5
#define INTERVAL_MAX_S  3600
#define NS_PER_SECOND   1e9
#define WATCH_NAMES_MAX (OPTION_OPERAND_MAX - 1)

static enum command_status list(void)
{
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        const struct panel_register *row = &takt_panel_registers[i];

        (void)printf("%-22s %-7s %s\n", panel_text(row)->name, panel_text(row)->unit,
                     panel_text(row)->meaning);
    }
    return STATUS_DONE;
}

static enum command_status table(const struct options *options)
{
    const char *form = options->operands > 1 ? options->operand[1] : "";

    if (strcmp(form, "markdown") == 0)
        panel_table_write_markdown(stdout);
    else if (strcmp(form, "csv") == 0)
        panel_table_write_csv(stdout);
    else {
        message_command_error("table: markdown or csv is expected");
        return STATUS_INPUT;
    }
    return STATUS_DONE;
}

/* The registers named from the second operand on. False after a message. */
static bool find_names(const struct options *options, enum panel_id *id)
{
    for (unsigned i = 1; i < options->operands; i++) {
        id[i - 1] = panel_line_find(options->operand[i]);
        if (id[i - 1] == REGISTER_COUNT)
            return false;
    }
    return true;
}

static bool show(struct panel_line *line, enum panel_id id)
{
    const struct panel_register *row = &takt_panel_registers[id];
    char text[PANEL_VALUE_MAX + 1];

    if (!panel_line_read(line, id, text))
        return false;
    (void)printf("%s = %s%s%s\n", panel_text(row)->name, text,
                 panel_text(row)->unit[0] != '\0' ? " " : "", panel_text(row)->unit);
    if (id == REGISTER_DRIVES_GIVEN_UP)
        drives_table_write_bits(stdout, (uint32_t)strtoul(text, NULL, 10));
    return true;
}

static enum command_status read_names(struct panel_line *line, const struct options *options)
{
    enum panel_id id[WATCH_NAMES_MAX];

    if (options->operands < 2) {
        message_command_error("read: the name of a register is missing; takt panel list");
        return STATUS_INPUT;
    }
    if (!find_names(options, id))
        return STATUS_INPUT;
    for (unsigned i = 1; i < options->operands; i++) {
        if (!show(line, id[i - 1]))
            return STATUS_ENVIRONMENT;
    }
    return STATUS_DONE;
}

static enum command_status write_name(struct panel_line *line, const struct options *options)
{
    enum panel_id id;

    if (options->operands != 3) {
        message_command_error("write: the name of a register and a value are expected");
        return STATUS_INPUT;
    }
    id = panel_line_find(options->operand[1]);
    return id != REGISTER_COUNT ? panel_line_write(line, id, options->operand[2]) : STATUS_INPUT;
}

static bool show_line(struct panel_line *line, const enum panel_id *id, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        char text[PANEL_VALUE_MAX + 1];

        if (!panel_line_read(line, id[i], text))
            return false;
        (void)printf("%s%s=%s", i > 0 ? "  " : "", takt_panel_texts[id[i]].name, text);
    }
    (void)putchar('\n');
    return fflush(stdout) == 0;
}

static void wait_for(double time_s)
{
    const struct timespec time = {.tv_sec = (time_t)time_s,
                                  .tv_nsec =
                                      (long)((time_s - (double)(time_t)time_s) * NS_PER_SECOND)};

    (void)nanosleep(&time, NULL);
}

static enum command_status watch(struct panel_line *line, const struct options *options)
{
    static const enum panel_id usual[] = {
        REGISTER_STATE,      REGISTER_ACTIVE_LINE, REGISTER_POSITION_X, REGISTER_POSITION_Y,
        REGISTER_POSITION_Z, REGISTER_FEED,        REGISTER_ALARM,
    };
    const double given_s = options->panel.interval_s;
    const double interval_s = given_s > 0 ? given_s : INTERVAL_S;
    enum panel_id id[WATCH_NAMES_MAX];
    unsigned count = options->operands - 1;

    if (interval_s > INTERVAL_MAX_S) {
        message_command_error("--interval %g: at most %d s", interval_s, INTERVAL_MAX_S);
        return STATUS_INPUT;
    }
    if (!find_names(options, id))
        return STATUS_INPUT;
    if (count == 0) {
        count = sizeof usual / sizeof usual[0];
        memcpy(id, usual, sizeof usual);
    }
    for (uint32_t shown = 0; !interrupt_asked(); wait_for(interval_s)) {
        if (!show_line(line, id, count))
            return STATUS_ENVIRONMENT;
        if (++shown == options->panel.count)
            return STATUS_DONE;
    }
    return STATUS_DONE;
}

static enum command_status upload(struct panel_line *line, const struct options *options)
{
    if (options->operands != 2) {
        message_command_error("upload: the file of a program is expected");
        return STATUS_INPUT;
    }
    return panel_upload_file(line, options->operand[1], options->quiet);
}

static enum command_status settings(struct panel_line *line, const struct options *options)
{
    if (options->operands != 2) {
        message_command_error("settings: the file of settings is expected");
        return STATUS_INPUT;
    }
    return panel_upload_settings(line, options->operand[1], options->quiet);
}

static enum command_status stream(struct panel_line *line, const struct options *options)
{
    if (options->operands != 2) {
        message_command_error("stream: the file of a compiled program is expected");
        return STATUS_INPUT;
    }
    return panel_upload_plan(line, options->operand[1], options->panel.starts, options->quiet);
}

static enum command_status on_line(enum command_status (*act)(struct panel_line *line,
                                                              const struct options *options),
                                   const struct options *options)
{
    static struct panel_line line;
    enum command_status status = panel_line_open(&line, options);

    if (status != STATUS_DONE)
        return status;
    status = act(&line, options);
    panel_line_close(&line);
    return status;
}

static enum command_status command_panel_execute(const struct options *options)
{
    static const char *const names[] = {"read",     "write",  "watch", "upload",
                                        "settings", "stream", "list",  "table"};
    static enum command_status (*const acts[])(struct panel_line * line,
                                               const struct options *options) = {
        read_names, write_name, watch, upload, settings, stream};
    const char *name = options->operand[0];

    for (unsigned i = 0; i < sizeof acts / sizeof acts[0]; i++) {
        if (strcmp(name, names[i]) == 0)
            return on_line(acts[i], options);
    }
    if (strcmp(name, "list") == 0)
        return list();
    if (strcmp(name, "table") == 0)
        return table(options);
    message_command_error(
        "there is no 'panel %s'%s", name,
        message_did_you_mean("", suggest_word(name, names, sizeof names / sizeof names[0])));
    return STATUS_INPUT;
}

static const struct option_row rows[] = {
    {"connect", OPTION_TEXT, offsetof(struct options, panel.connect), "HOST:PORT",
     "Modbus TCP (default 127.0.0.1:1502)"},
    {"serial", OPTION_TEXT, offsetof(struct options, panel.serial), "PATH[,BAUD[,PARITY]]",
     "Modbus RTU instead (default 19200, even)"},
    {"unit", OPTION_POSITIVE, offsetof(struct options, panel.unit), "N", "unit asked (default 1)"},
    {"timeout", OPTION_POSITIVE, offsetof(struct options, panel.timeout_s), "S",
     "for an answer (default 2 s)"},
    {"password", OPTION_NUMBER, offsetof(struct options, panel.password), "N",
     "written before anything else"},
    {"interval", OPTION_POSITIVE, offsetof(struct options, panel.interval_s), "S",
     "of watch (default 0.5 s)"},
    {"count", OPTION_COUNT, offsetof(struct options, panel.count), "N",
     "watch: so many lines (default: until Ctrl-C)"},
    {"start", OPTION_FLAG, offsetof(struct options, panel.starts), NULL,
     "stream: write CYCLE_START when the buffer is full or the file complete"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL,
     "upload, stream: print errors alone"},
    OPTIONS_END,
};

const struct command command_panel = {
    .name = "panel",
    .usage = "read NAME...|write NAME VALUE|watch [NAME...]|upload FILE|settings FILE|stream "
             "FILE|list|table FORM "
             "[options]",
    .summary = "read and write the panel of a running controller by name",
    .help =
        "list names all registers, table markdown and table csv print their documentation. "
        "Values are in the unit\n"
        "of the register: write FEED_OVERRIDE 80 is 80 %.\n"
        "\n"
        "Examples:\n"
        "  takt panel upload part.ngc && takt panel write CYCLE_START 1\n"
        "  takt compile part.ngc -o part.plan && takt panel stream part.plan\n"
        "      (brings it while it runs: CYCLE_START meanwhile, in another window; or --start)\n"
        "  takt panel write EMERGENCY_STOP 1 && takt panel settings mill.settings\n"
        "  takt panel watch STATE ACTIVE_LINE POSITION_X\n"
        "  takt panel write FEED_HOLD 1\n"
        "  takt panel write MODE 1 && takt panel write MDI_TEXT 'G0 X10' && takt panel write "
        "MDI_START 1\n"
        "  takt panel read STATE ALARM ALARM_TEXT --connect mill.local:1502\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = OPTION_OPERAND_MAX,
    .run = command_panel_execute,
};
