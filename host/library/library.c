#define _POSIX_C_SOURCE 200809L

#include "library/library_private.h"

#include "report/asset.h"

#include "cli/message.h"
#include "config/machine_file.h"
#include "session/canon_write.h"
#include "session/convert_write.h"
#include "session/plan_write.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* getopt_long keeps its place in the process. */
static pthread_mutex_t reading_options = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t watching_forks = PTHREAD_ONCE_INIT;

static void lock_options(void)
{
    (void)pthread_mutex_lock(&reading_options);
}

static void unlock_options(void)
{
    (void)pthread_mutex_unlock(&reading_options);
}

/* A child made while another thread reads would wait for that thread, which it does not have. */
static void watch_forks(void)
{
    (void)pthread_atfork(lock_options, unlock_options, unlock_options);
}

const char *takt_library_version(void)
{
    return TAKT_VERSION;
}

/* ---- messages ---- */

static const char *copy_of(const char *text)
{
    return strdup(text != NULL ? text : "");
}

/* free() takes no const: what is freed here was allocated here. */
static void free_const(const char *text)
{
    char *own;

    memcpy(&own, &text, sizeof own);
    free(own);
}

static void free_message(const struct takt_message *m)
{
    free_const(m->file);
    free_const(m->text);
    free_const(m->cure);
}

/* One that there is no memory for is lost; what it is about has its status all the same. */
static void hear(void *listener, const struct message *m)
{
    struct takt_job *job = listener;
    struct takt_message *messages =
        realloc(job->messages, (job->message_count + 1) * sizeof *messages);
    const struct takt_message heard = {.kind = m->kind, /* a word of the program's own */
                                       .file = copy_of(m->file),
                                       .line = m->line,
                                       .column = m->column,
                                       .text = copy_of(m->text),
                                       .cure = copy_of(m->cure)};

    job->messages = messages != NULL ? messages : job->messages;
    if (messages != NULL && heard.file != NULL && heard.text != NULL && heard.cure != NULL)
        messages[job->message_count++] = heard;
    else
        free_message(&heard);
}

void library_enter(struct takt_job *job)
{
    message_set_command(job->argv[0]);
    message_listen(hear, job);
    text_hold(job->texts, job->text_count);
}

void library_leave(struct takt_job *job)
{
    (void)job;
    message_listen(NULL, NULL);
    text_hold(NULL, 0);
}

const struct takt_message *takt_get_messages(const struct takt_job *job, unsigned *count)
{
    *count = job->message_count;
    return job->messages;
}

const char *takt_get_text(const struct takt_job *job, size_t *length)
{
    *length = job->text_length;
    return job->text != NULL ? job->text : "";
}

/* ---- opening ---- */

static bool copy_words(struct takt_job *job, int argc, const char *const *argv)
{
    job->argv = calloc((size_t)argc + 1, sizeof *job->argv);
    for (; job->argv != NULL && job->argc < argc; job->argc++) {
        job->argv[job->argc] = strdup(argv[job->argc]);
        if (job->argv[job->argc] == NULL)
            return false;
    }
    return job->argv != NULL;
}

static bool copy_text(struct text_held *to, const struct takt_text *from)
{
    char *name = strdup(from->name);
    char *bytes = malloc(from->length + 1);

    if (bytes != NULL)
        memcpy(bytes, from->bytes, from->length);
    *to = (struct text_held){name, bytes, from->length};
    return name != NULL && bytes != NULL;
}

static bool copy_texts(struct takt_job *job, const struct takt_text *texts, unsigned count)
{
    job->texts = calloc(count + 1, sizeof *job->texts);
    for (; job->texts != NULL && job->text_count < count; job->text_count++) {
        if (!copy_text(&job->texts[job->text_count], &texts[job->text_count])) {
            job->text_count++;
            return false;
        }
    }
    return job->texts != NULL;
}

struct takt_job *takt_open(int argc, const char *const *argv, const struct takt_text *texts,
                           unsigned count)
{
    struct takt_job *job = argc > 0 ? calloc(1, sizeof *job) : NULL;

    if (job == NULL)
        return NULL;
    if (copy_words(job, argc, argv) && copy_texts(job, texts, count))
        return job;
    takt_close(job);
    return NULL;
}

void takt_close(struct takt_job *job)
{
    if (job == NULL)
        return;
    library_close_run(job);
    for (unsigned i = 0; i < job->message_count; i++)
        free_message(&job->messages[i]);
    for (unsigned i = 0; i < job->text_count; i++) {
        free(job->texts[i].name);
        free(job->texts[i].bytes);
    }
    for (int i = 0; i < job->argc; i++)
        free(job->argv[i]);
    free(job->messages);
    free(job->texts);
    free(job->argv);
    free(job->text);
    free(job);
}

const unsigned char *takt_get_plotting(size_t *length)
{
    *length = asset_plotly.size;
    return asset_plotly.bytes;
}

void takt_free(void *memory)
{
    free(memory);
}

enum command_status library_read_options(struct takt_job *job, const struct command *command)
{
    bool good;

    (void)pthread_once(&watching_forks, watch_forks);
    lock_options();
    good = options_read(&job->options, command->options, command->operands_min,
                        command->operands_max, job->argc, job->argv);
    unlock_options();
    if (good && job->options.help)
        message_command_error("--help: the library prints nothing; `takt help %s` does",
                              command->name);
    return good && !job->options.help ? STATUS_DONE : STATUS_INPUT;
}

/* ---- texts ---- */

FILE *library_open_text(struct takt_job *job)
{
    FILE *stream;

    free(job->text);
    job->text = NULL;
    job->text_length = 0;
    stream = open_memstream(&job->text, &job->text_length);
    if (stream == NULL)
        message_command_error("out of memory");
    return stream;
}

enum command_status library_keep_text(struct takt_job *job, FILE *stream,
                                      enum command_status status)
{
    const bool good = ferror(stream) == 0;

    if (fclose(stream) == 0 && good && job->text != NULL)
        return status;
    message_command_error("out of memory");
    return STATUS_ENVIRONMENT;
}

static enum command_status write_canon(struct takt_job *job, const struct session *session,
                                       const struct session_totals *totals, FILE *stream)
{
    (void)job;
    (void)totals;
    return canon_write(stream, session);
}

static enum command_status write_converted(struct takt_job *job, const struct session *session,
                                           const struct session_totals *totals, FILE *stream)
{
    enum dialect dialect;

    (void)totals;
    return convert_read_dialect(job->options.to_dialect, &dialect)
               ? convert_write(session, stream, dialect)
               : STATUS_INPUT;
}

static enum command_status write_plan(struct takt_job *job, const struct session *session,
                                      const struct session_totals *totals, FILE *stream)
{
    (void)job;
    return plan_write(session, totals, NULL, stream);
}

/* What a file that has been written holds. */
static bool copy_file(FILE *from, FILE *to)
{
    char bytes[4096];
    size_t got;

    rewind(from);
    while ((got = fread(bytes, 1, sizeof bytes, from)) > 0)
        (void)fwrite(bytes, 1, got, to);
    return ferror(from) == 0;
}

/* A compiled program is written at its beginning again: a stream in memory would end there. */
static enum command_status write_compiled(struct takt_job *job, const struct session *session,
                                          const struct session_totals *totals, FILE *stream)
{
    struct compiled_figures figures;
    enum command_status status = STATUS_INPUT;
    uint32_t ceiling;
    FILE *file;

    if (!compiled_read_ceiling(&job->options, &ceiling) || !compiled_check_machine(session))
        return STATUS_INPUT;
    file = tmpfile();
    if (file == NULL) {
        message_command_error("a temporary file cannot be created");
        return STATUS_ENVIRONMENT;
    }
    status = compiled_make(session, totals, ceiling, file, &figures);
    if (status == STATUS_DONE && !copy_file(file, stream))
        status = STATUS_ENVIRONMENT;
    (void)fclose(file);
    return status;
}

static const struct library_writer {
    const struct command *command;
    bool runs; /* a check ends at the first G38 or M66 */
    enum command_status (*write)(struct takt_job *job, const struct session *session,
                                 const struct session_totals *totals, FILE *stream);
} writers[] = {
    {&command_canon, false, write_canon},
    {&command_convert, false, write_converted},
    {&command_plan, false, write_plan},
    {&command_compile, true, write_compiled},
};

/* The whole way of a command that reads a program. */
static enum command_status write_of_program(struct takt_job *job,
                                            const struct library_writer *writer)
{
    struct session *session = &job->run.session;
    struct session_totals totals;
    enum command_status status = library_read_options(job, writer->command);
    FILE *stream;

    if (status != STATUS_DONE)
        return status;
    job->is_open = true;
    status = session_open(session, &job->options);
    session->runs = writer->runs;
    if (status == STATUS_DONE)
        status = session_check(session, 1, &totals);
    if (status != STATUS_DONE)
        return status;
    stream = library_open_text(job);
    if (stream == NULL)
        return STATUS_ENVIRONMENT;
    return library_keep_text(job, stream, writer->write(job, session, &totals, stream));
}

static enum command_status write_machine(struct takt_job *job)
{
    struct machine_setup *setup = &job->run.session.setup;
    enum command_status status = library_read_options(job, &command_machine);
    FILE *stream;

    if (status != STATUS_DONE)
        return status;
    job->options.machine = job->options.operand[0];
    if (!machine_file_load(setup, &job->options))
        return STATUS_INPUT;
    stream = library_open_text(job);
    if (stream == NULL)
        return STATUS_ENVIRONMENT;
    machine_file_write(stream, setup);
    return library_keep_text(job, stream, STATUS_DONE);
}

static enum command_status write_any(struct takt_job *job)
{
    if (strcmp(job->argv[0], command_machine.name) == 0)
        return write_machine(job);
    for (size_t i = 0; i < sizeof writers / sizeof writers[0]; i++) {
        if (strcmp(job->argv[0], writers[i].command->name) == 0)
            return write_of_program(job, &writers[i]);
    }
    message_command_error("the library has no command '%s' that writes a text", job->argv[0]);
    return STATUS_INPUT;
}

int takt_write(struct takt_job *job)
{
    enum command_status status;

    library_enter(job);
    status = write_any(job);
    library_close_run(job);
    library_leave(job);
    return (int)status;
}
