/*
 * Errors as CiA 301 tells them: error register, history, emergencies, and what an error of the
 * communication does to the node.
 */
#include "base/assert.h"
#include "servo/servo_private.h"

#include <string.h>

#define ERROR_BEHAVIOUR_PREOPERATIONAL 0
#define ERROR_BEHAVIOUR_STOPPED        2

/* Object 1003: the newest first. */
static void note(struct drive_process *p, uint16_t code)
{
    memmove(p->history + 1, p->history, sizeof p->history - sizeof p->history[0]);
    p->history[0] = code;
    if (p->history_count < DRIVE_HISTORY_MAX)
        p->history_count++;
}

void takt_servo_clear_history(struct servo *drive)
{
    struct drive_process *p = &drive->objects.process;
    memset(p->history, 0, sizeof p->history);
    p->history_count = 0;
}

/* The identifier is object 1014's, wherever that points. */
static void send_emcy(struct servo *drive, const struct emcy *emcy)
{
    struct can_frame frame;
    uint32_t cob_id = drive->objects.communication.emcy_cob_id;
    uint16_t inhibit_100us = drive->objects.communication.emcy_inhibit_100us;
    if (cob_id >> 31)
        return;
    takt_emcy_write(&frame, emcy);
    frame.id = (uint16_t)cob_id;
    (void)takt_servo_send(drive, SERVO_FRAME_EMCY, &frame);
    drive->emcy_ns = drive->now_ns + inhibit_100us * UINT64_C(100000);
}

void takt_servo_send_waiting_emergencies(struct servo *drive)
{
    TAKT_ASSERT(drive->emcy_count <= SERVO_EMCY_QUEUE);
    while (drive->emcy_count > 0 && drive->now_ns >= drive->emcy_ns) {
        send_emcy(drive, &drive->emcy[0]);
        drive->emcy_count--;
        memmove(drive->emcy, drive->emcy + 1, drive->emcy_count * sizeof drive->emcy[0]);
    }
}

/* Within the inhibit time emergencies wait; what is more than the queue holds is lost. */
static void send_or_wait(struct servo *drive, const struct emcy *emcy)
{
    if (drive->emcy_count == 0 && drive->now_ns >= drive->emcy_ns) {
        send_emcy(drive, emcy);
    } else if (drive->emcy_count < SERVO_EMCY_QUEUE) {
        drive->emcy[drive->emcy_count++] = *emcy;
        takt_servo_look_soon(drive);
    }
}

void takt_servo_send_emergency(struct servo *drive, uint16_t code, uint8_t error_register)
{
    struct drive_process *p = &drive->objects.process;
    const struct emcy emcy = {
        .node = drive->config.node, .code = code, .error_register = error_register};
    if (code != EMCY_NONE)
        note(p, code);
    takt_servo_tell(drive, DRIVE_EVENT_EMCY, code, error_register);
    if (drive->nmt == NMT_OPERATIONAL || drive->nmt == NMT_PREOPERATIONAL)
        send_or_wait(drive, &emcy);
}

/* Object 1029: what the node does when it has lost the controller. */
static void behave(struct servo *drive)
{
    uint8_t behaviour = drive->objects.communication.error_behaviour;
    if (drive->nmt != NMT_OPERATIONAL)
        return;
    if (behaviour == ERROR_BEHAVIOUR_PREOPERATIONAL)
        drive->nmt = NMT_PREOPERATIONAL;
    else if (behaviour == ERROR_BEHAVIOUR_STOPPED)
        drive->nmt = NMT_STOPPED;
    else
        return;
    takt_servo_tell(drive, DRIVE_EVENT_NMT, (uint32_t)drive->nmt, 0);
}

void takt_servo_forget_communication_error(struct servo *drive)
{
    struct drive_process *p = &drive->objects.process;
    drive->communication_error = EMCY_NONE;
    p->error_register &= (uint8_t)~EMCY_REGISTER_COMMUNICATION;
    if (p->error_code == EMCY_NONE)
        p->error_register = 0;
}

void takt_servo_set_communication_error(struct servo *drive, uint16_t code)
{
    uint8_t *error_register = &drive->objects.process.error_register;
    if (code == drive->communication_error)
        return;
    if (code == EMCY_NONE) {
        takt_servo_forget_communication_error(drive);
        takt_servo_send_emergency(drive, EMCY_NONE, *error_register);
        return;
    }
    drive->communication_error = code;
    *error_register |= EMCY_REGISTER_GENERIC | EMCY_REGISTER_COMMUNICATION;
    takt_servo_send_emergency(drive, code, *error_register);
    behave(drive);
    takt_servo_lose_connection(drive);
}
