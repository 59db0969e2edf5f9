#define _DEFAULT_SOURCE

#include "serving/serving_state.h"

#include "cli/message.h"
#include "program/changes.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define FOLDER_MODE 0755
#define FILE_MODE   0644

#define NONE "none"

/* The machine's name as a folder's: what is no letter, digit or one of these becomes '-'. */
static void add_machine(char *path, size_t room, const char *name)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    size_t at = strlen(path);

    for (; *name != '\0' && at + 1 < room; name++)
        path[at++] = (char)(strchr(allowed, *name) != NULL ? *name : '-');
    path[at] = '\0';
}

/*
 * $XDG_STATE_HOME, else ~/.local/state; in it takt/MACHINE. False: nobody says where the user's
 * files are.
 */
static bool find_folder(struct serving_state *st, const char *machine)
{
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");

    if (state != NULL && state[0] == '/')
        (void)snprintf(st->folder, sizeof st->folder, "%s/takt/", state);
    else if (home != NULL && home[0] == '/')
        (void)snprintf(st->folder, sizeof st->folder, "%s/.local/state/takt/", home);
    else
        return false;
    add_machine(st->folder, sizeof st->folder, machine);
    return true;
}

/* With all folders above it. */
static bool make_folder(const char *path)
{
    char part[SERVING_STATE_PATH_MAX];

    (void)snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1; *at != '\0'; at++) {
        if (*at != '/')
            continue;
        *at = '\0';
        if (mkdir(part, FOLDER_MODE) != 0 && errno != EEXIST)
            return false;
        *at = '/';
    }
    return mkdir(part, FOLDER_MODE) == 0 || errno == EEXIST;
}

/* One service a folder. */
static bool lock_folder(struct serving_state *st)
{
    char path[SERVING_STATE_PATH_MAX + 8];

    (void)snprintf(path, sizeof path, "%s/lock", st->folder);
    st->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, FILE_MODE);
    return st->lock >= 0 && flock(st->lock, LOCK_EX | LOCK_NB) == 0;
}

static enum command_status refuse(struct serving_state *st, const char *what)
{
    message_command_error("--state %s: %s; another folder, or --state none", st->folder, what);
    return STATUS_ENVIRONMENT;
}

static enum command_status open_files(struct serving_state *st, size_t tools)
{
    if (!make_folder(st->folder))
        return refuse(st, strerror(errno));
    if (!lock_folder(st))
        return refuse(st, errno == EWOULDBLOCK ? "another takt serve uses it" : strerror(errno));
    if (!state_keeper_open(&st->keeper, st->folder, tools))
        return refuse(st, strerror(errno));
    st->is_kept = true;
    return STATUS_DONE;
}

static void take_tools(struct serving_state *st, struct session *session)
{
    const size_t bytes = st->tools_count * sizeof *session->tools.tools;

    if (st->kept.tools_base == st->tools_base && st->kept.tools_count == st->tools_count &&
        bytes > 0)
        memcpy(session->tools.tools, st->kept.tools, bytes);
    else if (st->kept.tools_base != st->tools_base)
        message_command_warning("--state %s: the tool table is another since; it counts",
                                st->folder);
}

static void take_parameters(struct serving_state *st, struct session *session)
{
    if (st->kept.parameters_base == st->parameters_base)
        session->parameters.values = st->kept.parameters;
    else
        message_command_warning("--state %s: the parameters are others since; they count",
                                st->folder);
}

/* Offsets of 0 in place of those that were kept would drive the tool elsewhere than was set up. */
static enum command_status refuse_damaged(const struct serving_state *st)
{
    message_command_error("--state %s: state-0 and state-1 are damaged: work offsets, tools and "
                          "parameters that were kept are lost; put back copies of these files, or "
                          "remove them to set up the machine anew",
                          st->folder);
    return STATUS_ENVIRONMENT;
}

/*
 * What does not fit this machine is left alone: nothing is overwritten that somebody may want back.
 */
static enum command_status take_state(struct serving_state *st, struct session *session)
{
    char problem[STATE_PROBLEM_MAX + 1];
    size_t length;
    const char *text = state_keeper_get(&st->keeper, &length);

    if (text == NULL)
        return state_keeper_has_lost(&st->keeper) ? refuse_damaged(st) : STATUS_DONE;
    if (!state_read(&st->kept, text, length, problem))
        return refuse(st, problem);
    if (strcmp(st->kept.machine, session->setup.machine.name) != 0)
        return refuse(st, "it is of another machine");
    take_tools(st, session);
    take_parameters(st, session);
    return STATUS_DONE;
}

static bool choose_folder(struct serving_state *st, const struct session *session)
{
    const char *given = session->options->panel.state;

    if (given == NULL)
        return find_folder(st, session->setup.machine.name);
    if (strcmp(given, NONE) == 0)
        return false;
    (void)snprintf(st->folder, sizeof st->folder, "%s", given);
    return true;
}

enum command_status serving_state_open(struct serving_state *st, struct session *session)
{
    enum command_status status;

    memset(st, 0, sizeof *st);
    st->lock = -1;
    if (!choose_folder(st, session))
        return STATUS_DONE;
    st->tools_count = session->tools.table.count;
    st->tools_base = state_sum_tools(session->tools.tools, st->tools_count);
    st->parameters_base = state_sum_parameters(&session->parameters.values);
    status = open_files(st, st->tools_count);
    if (status != STATUS_DONE)
        return status;
    (void)snprintf(st->program, sizeof st->program, "%.*s/program.ngc",
                   (int)(sizeof st->program - sizeof "/program.ngc"), st->folder);
    st->kept.tools_max = st->tools_count;
    st->kept.tools = calloc(st->tools_count > 0 ? st->tools_count : 1, sizeof *st->kept.tools);
    return st->kept.tools != NULL ? take_state(st, session) : refuse(st, "out of memory");
}

const char *serving_state_get_program(const struct serving_state *st)
{
    return st->is_kept ? st->program : NULL;
}

/* A program that was cut short can be gone on with, if it is the one that is there. */
static void offer_line(const struct state *kept, struct service *service)
{
    if (kept->line == 0 || kept->program_crc != service->program_crc ||
        kept->program_size != service->program_size)
        return;
    service->cut_line = kept->line;
    message_command_warning("the program was cut short in line %u: START_LINE, or --from-line %u, "
                            "starts there",
                            (unsigned)kept->line, (unsigned)kept->line);
}

static void settings_setup(const struct correction_settings *settings,
                           double number[CORRECTION_SETUP_VALUES])
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        number[i] = settings->setup_offset_mm[i];
        number[AXIS_LINEAR_COUNT + i] = settings->setup_rotation_rad[i];
    }
    number[CORRECTION_SETUP_VALUES - 1] = settings->setup_turn_rad;
}

/* As the part was set up last, unless the machine file says something else since. */
static void take_setup(const struct serving_state *st, struct correction *correction,
                       const struct correction_settings *settings)
{
    double of_file[CORRECTION_SETUP_VALUES];
    bool same = true;

    settings_setup(settings, of_file);
    for (unsigned i = 0; i < CORRECTION_SETUP_VALUES; i++) {
        same = same && st->kept.setup[CORRECTION_SETUP_VALUES + i] == of_file[i];
        takt_correction_tell_setup(correction, i, st->kept.setup[i]);
    }
    if (same && takt_correction_take_setup(correction))
        takt_correction_settle_setup(correction);
    else
        message_command_warning("--state %s: the machine's set-up of the part is another since; it "
                                "counts",
                                st->folder);
    takt_correction_forget_setup(correction);
}

void serving_state_restore(const struct serving_state *st, struct service *service)
{
    struct correction *correction = takt_controller_get_correction(&service->controller);

    if (!st->is_kept)
        return;
    for (size_t i = 0; i < st->kept.wears; i++)
        takt_correction_set_wear(correction, st->kept.wear[i].tool, st->kept.wear[i].length_mm,
                                 st->kept.wear[i].time_s);
    if (st->kept.has_setup)
        take_setup(st, correction, &service->controller.machine.correction);
    offer_line(&st->kept, service);
}

enum command_status serving_state_start(struct serving_state *st)
{
    return !st->is_kept || state_keeper_start(&st->keeper) ? STATUS_DONE : refuse(st, "no thread");
}

/* Wear of the tools of the table, in the state's order of use. */
static void fill_wear(struct state *state, const struct correction *correction)
{
    state->wears = 0;
    for (unsigned i = 0; i < CORRECTION_TOOLS_MAX && i < STATE_WEARS_MAX; i++) {
        const struct correction_wear *book = &correction->wear[i];

        if (book->used != 0)
            state->wear[state->wears++] =
                (struct state_wear){book->tool, book->length_mm, book->time_s};
    }
}

static void fill(const struct serving_state *st, const struct service *service, struct state *state)
{
    (void)snprintf(state->machine, sizeof state->machine, "%s", service->controller.machine.name);
    state->tools_base = st->tools_base;
    state->parameters_base = st->parameters_base;
    state->program_size = service->program_size;
    state->program_crc = service->program_crc;
    state->line = takt_service_get_cut_line(service);
    state->parameters = *service->config.parameters;
    (void)takt_changes_leave_out(&service->controller.reader->program, service->controller.reached,
                                 &state->parameters);
    state->tools_count = st->tools_count;
    if (st->tools_count > 0)
        memcpy(state->tools, service->config.tools, st->tools_count * sizeof *state->tools);
    fill_wear(state, &service->controller.correction);
    takt_correction_get_setup(&service->controller.correction, state->setup);
    settings_setup(&service->controller.machine.correction, &state->setup[CORRECTION_SETUP_VALUES]);
    state->has_setup = true;
}

void serving_state_keep(struct serving_state *st, const struct service *service, uint64_t now_ns)
{
    struct state *wanted = st->is_kept ? state_keeper_wants(&st->keeper, now_ns) : NULL;

    if (wanted == NULL)
        return;
    fill(st, service, wanted);
    state_keeper_offer(&st->keeper);
    if (state_keeper_has_failed(&st->keeper) && !st->has_told) {
        st->has_told = true;
        message_command_warning("--state %s: it cannot be kept at present", st->folder);
    }
}

bool serving_state_close(struct serving_state *st, const struct service *service)
{
    bool good = true;

    if (st->is_kept) {
        if (service != NULL)
            fill(st, service, &st->kept);
        good = state_keeper_close(&st->keeper, service != NULL ? &st->kept : NULL);
    }
    st->is_kept = false;
    free(st->kept.tools);
    st->kept.tools = NULL;
    if (st->lock >= 0)
        (void)close(st->lock);
    st->lock = -1;
    if (!good)
        message_command_error("--state %s: the last changes could not be kept", st->folder);
    return good;
}
