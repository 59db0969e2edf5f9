#include "outside/bus_replay.h"

#include "bus/candump_read.h"
#include "bus/hex.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/text.h"
#include "link/link.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define BITRATE        1000000
#define MILLISECOND_NS 1000000u
#define FLUSH_NS       10000000000u

/* Identifiers that are wanted, 11 bits; frames of 29 bits only when all are. */
#define IDS_MAX 0x800

struct bus_replay {
    const struct options *options;
    struct text log;
    struct link *link;
    bool has_ids;
    bool wanted[IDS_MAX];
    uint64_t log_start_ns, start_ns;
    uint64_t sent, left_out;
};

/* "80,181-183": one entry; *at then stands behind it. */
static bool take_ids(struct bus_replay *replay, const char **at)
{
    uint32_t id[2];

    for (unsigned i = 0; i < 2; i++) {
        unsigned digits = (unsigned)strspn(*at, "0123456789abcdefABCDEF");

        if (digits == 0 || digits > 3 || !hex_get(*at, digits, &id[i]) || id[i] >= IDS_MAX)
            return false;
        *at += digits;
        if (i == 0 && **at != '-') {
            id[1] = id[0];
            break;
        }
        *at += i == 0 ? 1 : 0;
    }
    for (uint32_t k = id[0]; k <= id[1]; k++)
        replay->wanted[k] = true;
    return id[0] <= id[1];
}

static bool read_ids(struct bus_replay *replay)
{
    const char *at = replay->options->ids;

    replay->has_ids = at != NULL;
    while (at != NULL && *at != '\0') {
        if (!take_ids(replay, &at) || (*at != '\0' && *at != ',')) {
            message_command_error("--ids %s: identifiers of up to 3 hexadecimal digits are "
                                  "expected: 80,181-183",
                                  replay->options->ids);
            return false;
        }
        at += *at == ',' ? 1 : 0;
    }
    return true;
}

/* Error messages are the interface's own: nobody can send them. */
static bool is_wanted(const struct bus_replay *replay, const struct candump_line *line)
{
    const struct wire_frame *frame = &line->frame;
    const char *interface = replay->options->interface;

    if (frame->flags & WIRE_ERROR)
        return false;
    if (interface != NULL && (strlen(interface) != line->interface_length ||
                              strncmp(interface, line->interface, line->interface_length) != 0))
        return false;
    return !replay->has_ids || (!(frame->flags & WIRE_EXTENDED) && replay->wanted[frame->id]);
}

/*
 * What the bus answers is of no interest here, but must not fill up. False: interrupted, or the bus
 * is gone.
 */
static bool wait_until(struct bus_replay *replay, uint64_t time_ns)
{
    struct wire_frame frame;

    for (;;) {
        enum link_wait_result result = link_wait(replay->link, time_ns);

        if (interrupt_asked() || result == LINK_BROKEN)
            return false;
        if (result == LINK_TIMEOUT && link_clock_ns() >= time_ns)
            return true;
        while (link_receive(replay->link, &frame))
            continue;
    }
}

static bool send_frame(struct bus_replay *replay, const struct candump_line *line)
{
    if (!replay->options->fast &&
        !wait_until(replay, replay->start_ns + (line->time_ns - replay->log_start_ns)))
        return false;
    while (!link_send(replay->link, &line->frame)) {
        if (!wait_until(replay, link_clock_ns() + MILLISECOND_NS))
            return false;
    }
    replay->sent++;
    return true;
}

/* The next line that is a frame. False: there is none, or after a message it is wrong (*good). */
static bool next_frame(const struct bus_replay *replay, size_t *position, uint32_t *number,
                       struct candump_line *line, bool *good)
{
    const char *text, *wrong;
    size_t length;
    unsigned column;

    *good = true;
    do {
        if (!text_next_line(&replay->log, position, &text, &length))
            return false;
        ++*number;
    } while (length == 0);
    wrong = candump_read_line(text, length, line, &column);
    if (wrong == NULL)
        return true;
    message_error(replay->log.name, *number, column, "%s", wrong);
    *good = false;
    return false;
}

/* The whole log is read before its first frame is sent, so that a wrong one sends nothing. */
static bool check_log(const struct bus_replay *replay)
{
    struct candump_line line;
    size_t position = 0;
    uint32_t number = 0;
    bool good;

    while (next_frame(replay, &position, &number, &line, &good))
        continue;
    return good;
}

static bool send_log(struct bus_replay *replay)
{
    struct candump_line line;
    size_t position = 0;
    uint32_t number = 0;
    bool good, is_first = true;

    while (next_frame(replay, &position, &number, &line, &good)) {
        if (is_first)
            replay->log_start_ns = line.time_ns;
        is_first = false;
        if (line.time_ns < replay->log_start_ns) /* the clock was set back: go on from here */
            line.time_ns = replay->log_start_ns;
        if (!is_wanted(replay, &line))
            replay->left_out++;
        else if (!send_frame(replay, &line))
            return false;
    }
    return true;
}

/* A server or an adapter begins when somebody is there to hear it. */
static bool wait_for_peer(struct bus_replay *replay)
{
    if (link_has_peer(replay->link))
        return true;
    if (!replay->options->quiet)
        (void)fprintf(stderr, "takt replay: waiting for somebody on %s\n",
                      link_get_address(replay->link));
    while (!link_has_peer(replay->link)) {
        if (!wait_until(replay, link_clock_ns() + MILLISECOND_NS))
            return false;
    }
    return true;
}

static enum command_status report(const struct bus_replay *replay, bool good)
{
    if (interrupt_asked())
        return STATUS_INTERRUPTED;
    if (!good) {
        const char *problem = link_get_problem(replay->link);

        message_command_error("%s", problem[0] != '\0' ? problem : "nobody reads the frames");
        return STATUS_ENVIRONMENT;
    }
    if (!replay->options->quiet)
        (void)printf("%" PRIu64 " frames sent, %" PRIu64 " left out\n", replay->sent,
                     replay->left_out);
    return STATUS_DONE;
}

static enum command_status send_to_bus(struct bus_replay *replay)
{
    struct link_config config = {.bitrate = BITRATE, .fd = replay->options->fd};
    struct link_error error;
    enum command_status status;
    bool good;

    replay->link = link_open(replay->options->bus, &config, &error);
    if (replay->link == NULL) {
        message_command_error("--bus: %s", error.text);
        return error.is_environment ? STATUS_ENVIRONMENT : STATUS_INPUT;
    }
    good = wait_for_peer(replay);
    replay->start_ns = link_clock_ns();
    good = good && send_log(replay) && link_flush(replay->link, link_clock_ns() + FLUSH_NS);
    status = report(replay, good);
    link_close(replay->link);
    return status;
}

enum command_status bus_replay_run(const struct options *options)
{
    struct bus_replay replay = {.options = options};
    enum command_status status = STATUS_INPUT;

    if (!read_ids(&replay) || !text_read(&replay.log, options->operand[0]))
        return STATUS_INPUT;
    if (check_log(&replay))
        status = send_to_bus(&replay);
    text_free(&replay.log);
    return status;
}
