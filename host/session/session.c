#include "session/session.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "config/correction_file.h"
#include "config/machine_file.h"
#include "program/comment_text.h"
#include "session/program_front.h"
#include "tables/tool_guess.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Moves between two looks at Ctrl-C. */
#define SESSION_INTERRUPT_MOVES 4096

/* Warnings that are printed; others are counted. */
#define SESSION_WARNINGS_MAX 20

static bool open_tables(struct session *s)
{
    const char *tools = s->options->tools;
    const char *parameters = s->options->parameters;

    if (tools == NULL && s->setup.tool_table[0] != '\0')
        tools = s->setup.tool_table;
    if (parameters == NULL && s->setup.parameter_file[0] != '\0')
        parameters = s->setup.parameter_file;
    s->parameter_path = parameters;
    s->guesses_tools = tools != NULL && strcmp(tools, "auto") == 0;
    if (tools != NULL && !s->guesses_tools && !tool_file_read(&s->tools, tools))
        return false;
    return parameters == NULL || parameter_file_read(&s->parameters, parameters);
}

enum command_status session_open_machine(struct session *s, const struct options *options)
{
    *s = (struct session){.options = options};
    takt_parameters_clear(&s->parameters.values);
    return machine_file_load(&s->setup, options) &&
                   configuration_files_load(&s->configurations, &s->setup) && open_tables(s) &&
                   correction_file_load(&s->correction, &s->setup)
               ? STATUS_DONE
               : STATUS_INPUT;
}

/* Translated, and with its subroutines. */
static bool prepare_program(struct session *s)
{
    struct program_front front = {.codes = &s->setup.codes, .quiet = s->options->quiet};
    const char *dialect = s->options->dialect != NULL ? s->options->dialect : "auto";
    const unsigned found = dialect_find(dialect);

    if (found > DIALECT_AUTO) {
        message_command_error(
            "--dialect %s: known are auto, linuxcnc, grbl, fanuc, haas, mach3, marlin and siemens",
            dialect);
        return false;
    }
    front.dialect = (enum dialect)found;
    for (unsigned i = 0; i < s->options->subroutines.count; i++)
        front.folder[front.folders++] = s->options->subroutines.item[i];
    return program_front_prepare(&front, &s->program) &&
           (!s->guesses_tools || tool_guess(&s->tools, &s->program));
}

enum command_status session_open(struct session *s, const struct options *options)
{
    if (session_open_machine(s, options) != STATUS_DONE)
        return STATUS_INPUT;
    return program_text_open(&s->program, options->operand[0]) && prepare_program(s) ? STATUS_DONE
                                                                                     : STATUS_INPUT;
}

enum command_status session_open_text(struct session *s, const struct options *options,
                                      const char *name, const char *bytes, size_t length)
{
    if (session_open_machine(s, options) != STATUS_DONE)
        return STATUS_INPUT;
    return program_text_hold(&s->program, name, bytes, length) && prepare_program(s) ? STATUS_DONE
                                                                                     : STATUS_INPUT;
}

void session_close(struct session *s)
{
    program_text_close(&s->program);
    tool_file_close(&s->tools);
    configuration_files_free(&s->configurations);
    free(s->correction);
    s->correction = NULL;
}

void session_begin_reading(const struct session *s, struct session_reading *reading,
                           struct program_config *config, struct source *source)
{
    struct controller_config controller = {
        .machine = &s->setup.machine,
        .tools = &s->tools.table,
        .parameters = &reading->parameters,
        .exact_path = s->options->exact_path,
        .block_delete = s->options->block_delete,
        .from_line = s->options->from_line,
    };

    reading->parameters = s->parameters.values;
    takt_controller_program_config(&controller, config);
    config->waits = config->waits && s->runs;
    config->repeats_max = s->options->lines_max > 0 ? s->options->lines_max : OPTIONS_LINES_MAX;
    program_text_read(&s->program, &reading->text, source);
}

static void print_warnings(const struct session *s, struct session_reading *reading,
                           struct session_totals *totals)
{
    struct diagnostic warning;

    while (takt_program_warning(&reading->program, &warning) ||
           takt_cutter_compensation_warning(&reading->offset, &warning)) {
        if (totals->warnings++ < SESSION_WARNINGS_MAX)
            message_program_warning(&s->program, &warning);
    }
}

static void count_move(struct session_totals *totals, const struct move *move, struct point *at)
{
    struct curve curve;

    totals->moves++;
    totals->sets_up = totals->sets_up || move->kind == MOVE_SETUP;
    if (!move_is_motion(move))
        return;
    totals->motions++;
    if (move->path == PATH_BLEND && move->tolerance_mm > 0 &&
        (totals->tolerance_mm == 0 || move->tolerance_mm < totals->tolerance_mm))
        totals->tolerance_mm = move->tolerance_mm;
    if (takt_move_curve(move, at, &curve)) {
        totals->last = totals->motions;
        totals->curves++;
        totals->length_mm += takt_curve_is_rotary(&curve) ? 0 : curve.length_mm;
    }
    *at = move->end;
}

/* False: no more is to be read. */
static bool check_move(const struct session *s, struct session_reading *reading,
                       unsigned errors_max, struct session_totals *totals, struct point *at)
{
    struct diagnostic error;
    struct move move;
    enum program_result result =
        takt_cutter_compensation_next(&reading->offset, &reading->program, &move, &error);

    print_warnings(s, reading, totals);
    if (result == PROGRAM_MOVE)
        count_move(totals, &move, at);
    if (result == PROGRAM_WAIT && reading->program.question == QUESTION_SETUP) {
        takt_cutter_compensation_answer(&reading->offset, &reading->program,
                                        &(const struct program_answer){0});
        return true;
    }
    totals->is_open = totals->is_open || result == PROGRAM_WAIT;
    if (result != PROGRAM_ERROR)
        return result == PROGRAM_MOVE;
    message_program_error(&s->program, &error);
    totals->errors++;
    return totals->errors < errors_max;
}

/* What a program ends itself with, if that is more than its error has room for. */
static void say_abort(void *listener, const struct program *p)
{
    const struct program_text *program = *(const struct program_text **)listener;
    char text[COMMENT_TEXT_MAX];
    const bool abort = p->lexer.comment_length > 0 && takt_comment_read(p, text) == COMMENT_ABORT;

    if (abort && (strlen(text) >= DIAGNOSTIC_WORD_MAX || strchr(text, '.') != NULL))
        message_from_program(program, p->lexer.line, text);
}

enum command_status session_check(const struct session *s, unsigned errors_max,
                                  struct session_totals *totals)
{
    struct session_reading reading;
    struct program_config config;
    struct source source;
    struct point at;
    const struct program_text *program = &s->program;
    unsigned moves = 0;

    session_begin_reading(s, &reading, &config, &source);
    config.say = say_abort;
    config.listener = &program;
    takt_program_open(&reading.program, &config, &source);
    takt_cutter_compensation_open(&reading.offset, &config);
    at = config.start;
    *totals = (struct session_totals){0};
    while (check_move(s, &reading, errors_max, totals, &at)) {
        if (++moves % SESSION_INTERRUPT_MOVES == 0 && interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    if (totals->warnings > SESSION_WARNINGS_MAX)
        message_warning(s->program.name, 0, 0, "%u more warnings",
                        totals->warnings - SESSION_WARNINGS_MAX);
    return totals->errors == 0 ? STATUS_DONE : STATUS_INPUT;
}
