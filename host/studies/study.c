#define _GNU_SOURCE

#include "studies/study.h"

#include "cli/interrupt.h"
#include "cli/message.h"

#include <stdlib.h>

/* Cycles between two looks at Ctrl-C. */
#define LOOK_CYCLES 4096

static enum command_status follow(const struct study *study, const struct session *session,
                                  struct simulation *s)
{
    while (takt_controller_get_state(&s->controller) < CONTROLLER_COMPLETED) {
        const struct cycle_record *record;

        if (!simulation_step(s))
            return STATUS_ENVIRONMENT;
        record = takt_controller_get_record(&s->controller);
        if (record != NULL)
            study->see(study->context, &session->setup, s, record);
        if (s->cycles % LOOK_CYCLES == 0 && interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    if (takt_controller_get_state(&s->controller) == CONTROLLER_COMPLETED)
        return STATUS_DONE;
    message_program_error(&session->program, takt_controller_get_fault(&s->controller));
    return STATUS_FAILED;
}

static enum command_status run_program(const struct study *study, const struct session *session)
{
    struct session_totals totals;
    struct simulation *s = NULL;
    enum command_status status = session_check(session, 1, &totals);

    if (status == STATUS_DONE)
        status = simulation_open(session, &s);
    if (status == STATUS_DONE)
        status = follow(study, session, s);
    simulation_close(s);
    return status;
}

/* NULL: out of memory. */
static char *make_text(const struct study *study, const struct machine_setup *setup, size_t *length)
{
    char *text = NULL;
    FILE *stream = open_memstream(&text, length);

    if (stream == NULL)
        return NULL;
    study->write(study->context, setup, stream);
    return fclose(stream) == 0 ? text : NULL;
}

static enum command_status open_program(const struct study *study, struct session *session,
                                        const struct options *options)
{
    enum command_status status;
    size_t length = 0;
    char *text = make_text(study, &session->setup, &length);

    if (text == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    session_close(session);
    status = session_open_text(session, options, study->program, text, length);
    if (status == STATUS_DONE)
        status = run_program(study, session);
    free(text);
    return status;
}

enum command_status study_run(const struct study *study, const struct options *options)
{
    struct session *session = calloc(1, sizeof *session);
    enum command_status status;

    if (session == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = session_open_machine(session, options);
    if (status == STATUS_DONE)
        status = study->prepare(study->context, &session->setup)
                     ? open_program(study, session, options)
                     : STATUS_INPUT;
    session_close(session);
    free(session);
    return status;
}
