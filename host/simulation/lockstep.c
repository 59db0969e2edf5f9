#include "simulation/lockstep.h"

#include "canopen/nmt.h"
#include "canopen/node.h"
#include "canopen/pdo.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static_assert((LOCKSTEP_FRAMES_MAX & (LOCKSTEP_FRAMES_MAX - 1)) == 0, "frame indices are masked");

void lockstep_init(struct lockstep *lockstep, struct link *link, unsigned bus, uint64_t cycle_ns,
                   const uint8_t nodes[], unsigned count)
{
    assert(count <= AXIS_COUNT);
    memset(lockstep, 0, sizeof *lockstep);
    lockstep->link = link;
    lockstep->bus = bus;
    lockstep->link_port = link_get_port(link);
    lockstep->cycle_ns = cycle_ns;
    lockstep->cycle_start_ns = link_clock_ns();
    lockstep->count = count;
    for (unsigned i = 0; i < count; i++)
        lockstep->drive[i].node = nodes[i];
}

void lockstep_set_link(struct lockstep *lockstep, struct link *link)
{
    lockstep->link = link;
    lockstep->link_port = link_get_port(link);
    lockstep->read = lockstep->written;
    for (unsigned i = 0; i < lockstep->count; i++)
        lockstep->drive[i].is_in_step = false;
}

static bool port_send(void *context, const struct can_frame *frame)
{
    struct lockstep *lockstep = context;

    return lockstep->link_port.send(lockstep->link_port.context, frame);
}

static bool port_receive(void *context, struct can_frame *frame)
{
    struct lockstep *lockstep = context;

    if (lockstep->read == lockstep->written)
        return false;
    *frame = lockstep->frame[lockstep->read++ & (LOCKSTEP_FRAMES_MAX - 1)];
    return true;
}

struct can_port lockstep_get_port(struct lockstep *lockstep)
{
    return (struct can_port){.send = port_send, .receive = port_receive, .context = lockstep};
}

static struct lockstep_drive *find_drive(struct lockstep *lockstep, uint8_t node)
{
    for (unsigned i = 0; i < lockstep->count; i++) {
        if (lockstep->drive[i].node == node)
            return &lockstep->drive[i];
    }
    return NULL;
}

static void keep_frame(struct lockstep *lockstep, const struct can_frame *frame)
{
    if (lockstep->written - lockstep->read == LOCKSTEP_FRAMES_MAX)
        lockstep->read++;
    lockstep->frame[lockstep->written++ & (LOCKSTEP_FRAMES_MAX - 1)] = *frame;
}

static unsigned report_of(const struct lockstep *lockstep, uint16_t id)
{
    if (lockstep->drives != NULL)
        return takt_drives_get_report(lockstep->drives, lockstep->bus, id);
    return node_function(id) == PDO_TPDO1_FUNCTION ? DRIVES_REPORTS_ALL : 0;
}

/* True: the answer of a drive to SYNC is complete with it. */
static bool take_frame(struct lockstep *lockstep, const struct can_frame *frame)
{
    struct lockstep_drive *drive = find_drive(lockstep, node_id(frame->id));
    enum nmt_state state;
    uint8_t node;

    keep_frame(lockstep, frame);
    if (drive == NULL)
        return false;
    if (takt_nmt_read_heartbeat(frame, &node, &state) && state != NMT_OPERATIONAL)
        drive->is_in_step = drive->has_answered = false; /* not before it is started again */
    drive->reported |= (uint8_t)report_of(lockstep, frame->id);
    if (drive->reported != DRIVES_REPORTS_ALL)
        return false;
    drive->reported = 0;
    drive->has_answered = true;
    return true;
}

/* Everything that is there; returns the number of answers among it. */
static unsigned take_frames(struct lockstep *lockstep)
{
    struct can_frame frame;
    unsigned answers = 0;

    while (lockstep->link_port.receive(lockstep->link_port.context, &frame))
        answers += take_frame(lockstep, &frame) ? 1 : 0;
    return answers;
}

static bool all_in_step(const struct lockstep *lockstep)
{
    for (unsigned i = 0; i < lockstep->count; i++) {
        if (!lockstep->drive[i].is_in_step)
            return false;
    }
    return true;
}

/* Every drive that is in step has answered. */
static bool is_answered(const struct lockstep *lockstep)
{
    for (unsigned i = 0; i < lockstep->count; i++) {
        if (lockstep->drive[i].is_in_step && !lockstep->drive[i].has_answered)
            return false;
    }
    return true;
}

static bool all_heard(const struct lockstep *lockstep)
{
    for (unsigned i = 0; i < lockstep->count; i++) {
        if (!lockstep->drive[i].is_in_step && !lockstep->drive[i].has_answered)
            return false;
    }
    return true;
}

static void give_up(struct lockstep *lockstep)
{
    for (unsigned i = 0; i < lockstep->count; i++) {
        struct lockstep_drive *drive = &lockstep->drive[i];

        if (!drive->is_in_step || drive->has_answered)
            continue;
        drive->is_in_step = false;
        (void)snprintf(lockstep->warning, sizeof lockstep->warning,
                       "the drive of node %u has not answered SYNC for %g s and is not waited for "
                       "any more",
                       (unsigned)drive->node, 1e-9 * (double)LOCKSTEP_ANSWER_NS);
    }
}

static bool wait_for_answers(struct lockstep *lockstep)
{
    uint64_t until_ns = link_clock_ns() + LOCKSTEP_ANSWER_NS;

    (void)take_frames(lockstep);
    while (!is_answered(lockstep)) {
        enum link_wait_result result = link_wait(lockstep->link, until_ns);

        if (result == LINK_BROKEN)
            return false;
        (void)take_frames(lockstep);
        if (result == LINK_TIMEOUT && link_clock_ns() >= until_ns)
            give_up(lockstep);
    }
    return true;
}

/* Waits until no answer has come for a while: all that were under way are here. */
static bool wait_for_quiet(struct lockstep *lockstep)
{
    uint64_t until_ns = link_clock_ns() + LOCKSTEP_QUIET_NS;

    for (;;) {
        enum link_wait_result result = link_wait(lockstep->link, until_ns);

        if (result == LINK_BROKEN)
            return false;
        if (result == LINK_TIMEOUT && link_clock_ns() >= until_ns)
            return true;
        if (take_frames(lockstep) > 0)
            until_ns = link_clock_ns() + LOCKSTEP_QUIET_NS;
    }
}

static bool wait_until(struct lockstep *lockstep, uint64_t time_ns)
{
    enum link_wait_result result;

    (void)take_frames(lockstep);
    do {
        result = link_wait(lockstep->link, time_ns);
        (void)take_frames(lockstep);
    } while (result == LINK_READY || (result == LINK_TIMEOUT && link_clock_ns() < time_ns));
    return result == LINK_TIMEOUT;
}

static bool end_while_starting(struct lockstep *lockstep)
{
    if (!wait_until(lockstep, lockstep->cycle_start_ns + lockstep->cycle_ns))
        return false;
    if (!all_heard(lockstep))
        return true;
    if (!wait_for_quiet(lockstep))
        return false;
    for (unsigned i = 0; i < lockstep->count; i++)
        lockstep->drive[i].is_in_step = true;
    return true;
}

static void begin_cycle(struct lockstep *lockstep)
{
    lockstep->cycle_start_ns = link_clock_ns();
    for (unsigned i = 0; i < lockstep->count; i++)
        lockstep->drive[i].has_answered = false;
}

bool lockstep_end_cycle(struct lockstep *lockstep)
{
    bool good = wait_for_answers(lockstep);

    if (good && !all_in_step(lockstep))
        good = end_while_starting(lockstep);
    begin_cycle(lockstep);
    return good;
}

bool lockstep_end_cycle_at(struct lockstep *lockstep, uint64_t time_ns)
{
    bool good = wait_until(lockstep, time_ns);

    begin_cycle(lockstep);
    return good;
}

bool lockstep_take_warning(struct lockstep *lockstep, char text[LOCKSTEP_TEXT_MAX + 1])
{
    if (lockstep->warning[0] == '\0')
        return false;
    memcpy(text, lockstep->warning, sizeof lockstep->warning);
    lockstep->warning[0] = '\0';
    return true;
}
