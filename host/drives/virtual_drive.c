/*
 * CiA 301: what the drive does with frames and with time.
 */
#include "canopen/emcy.h"
#include "canopen/node.h"
#include "canopen/sync.h"
#include "drives/virtual_drive_private.h"

#include <string.h>

#define MILLISECOND_NS 1000000u
#define EVENT_NS       ((uint64_t)VIRTUAL_DRIVE_EVENT_MS * MILLISECOND_NS)

/* A refused frame is lost, as in a node whose transmit buffers are full; the bus counts it. */
static void send_frame(const struct virtual_drive *drive, const struct can_frame *frame)
{
    (void)drive->port.send(drive->port.context, frame);
}

void virtual_drive_send_emergency(const struct virtual_drive *drive, uint16_t code,
                                  uint8_t error_register)
{
    struct emcy emcy = {.node = drive->config.node, .code = code, .error_register = error_register};
    struct can_frame frame;
    if (drive->nmt != NMT_OPERATIONAL && drive->nmt != NMT_PREOPERATIONAL)
        return;
    emcy_write(&frame, &emcy);
    send_frame(drive, &frame);
}

static void set_pdo(struct pdo *pdo, unsigned cob_id, uint8_t transmission, uint32_t first,
                    uint32_t second)
{
    uint32_t objects[2] = {first, second};
    pdo->cob_id = (uint16_t)cob_id;
    pdo->transmission = transmission;
    (void)pdo_map(&pdo->mapping, objects, 2);
}

void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port)
{
    unsigned node = config->node;
    memset(drive, 0, sizeof *drive);
    drive->config = *config;
    drive->port = *port;
    drive->nmt = NMT_BOOTED;
    set_pdo(&drive->rpdo[0], PDO_RPDO1_FUNCTION + node, PDO_EVENT, CIA402_CONTROLWORD, CIA402_MODE);
    drive->rpdo[1] = *target;
    set_pdo(&drive->tpdo[0], PDO_TPDO1_FUNCTION + node, PDO_EVERY_SYNC, CIA402_STATUSWORD,
            CIA402_POSITION_ACTUAL);
    set_pdo(&drive->tpdo[1], PDO_TPDO2_FUNCTION + node, PDO_EVENT, CIA402_ERROR_CODE,
            CIA402_FOLLOWING_ERROR);
    drive_plant_init(&drive->plant, &config->plant, config->start_mm);
    virtual_drive_reset_profile(drive);
}

void virtual_drive_boot(struct virtual_drive *drive)
{
    struct can_frame frame;
    nmt_write_heartbeat(&frame, drive->config.node, NMT_BOOTED);
    send_frame(drive, &frame);
    drive->nmt = NMT_PREOPERATIONAL;
}

/*
 * The nodes' event timers are shifted by a millisecond each, so that their frames do not come all
 * at once.
 */
static void enter_operational(struct virtual_drive *drive)
{
    drive->nmt = NMT_OPERATIONAL;
    drive->event_ns = (uint64_t)drive->config.node * MILLISECOND_NS % EVENT_NS;
    memset(drive->is_held, 0, sizeof drive->is_held);
}

static void take_nmt_command(struct virtual_drive *drive, const struct can_frame *frame)
{
    enum nmt_command command;
    uint8_t node;
    if (!nmt_read_command(frame, &command, &node))
        return;
    if (node != NMT_ALL_NODES && node != drive->config.node)
        return;
    enum nmt_state next = nmt_next_state(command);
    if (next == NMT_OPERATIONAL && drive->nmt != NMT_OPERATIONAL)
        enter_operational(drive);
    if (next != NMT_OPERATIONAL)
        virtual_drive_lose_connection(drive);
    if (command == NMT_RESET_NODE)
        virtual_drive_reset_profile(drive);
    drive->nmt = next;
    if (next == NMT_BOOTED)
        virtual_drive_boot(drive);
}

static void apply_rpdo(struct virtual_drive *drive, const struct pdo_mapping *mapping,
                       const struct can_frame *frame)
{
    uint32_t value[PDO_MAPPED_MAX];
    pdo_unpack(mapping, frame->data, value);
    for (unsigned i = 0; i < mapping->count; i++)
        (void)virtual_drive_write_object(drive, mapping->object[i], value[i]);
}

static void take_rpdo(struct virtual_drive *drive, unsigned index, const struct can_frame *frame)
{
    const struct pdo *pdo = &drive->rpdo[index];
    if (!pdo_fits(&pdo->mapping, frame)) {
        virtual_drive_send_emergency(drive, EMCY_PDO_LENGTH,
                                     EMCY_REGISTER_GENERIC | EMCY_REGISTER_COMMUNICATION);
    } else if (pdo->transmission == PDO_EVERY_SYNC) {
        drive->held[index] = *frame;
        drive->is_held[index] = true;
    } else {
        apply_rpdo(drive, &pdo->mapping, frame);
    }
}

static void send_tpdo(const struct virtual_drive *drive, const struct pdo *pdo)
{
    uint32_t value[PDO_MAPPED_MAX] = {0};
    struct can_frame frame;
    for (unsigned i = 0; i < pdo->mapping.count; i++)
        (void)virtual_drive_read_object(drive, pdo->mapping.object[i], &value[i]);
    pdo_pack(pdo, value, &frame);
    send_frame(drive, &frame);
}

static void send_tpdos(const struct virtual_drive *drive, uint8_t transmission)
{
    for (unsigned i = 0; i < VIRTUAL_DRIVE_PDO_COUNT; i++)
        if (drive->tpdo[i].transmission == transmission)
            send_tpdo(drive, &drive->tpdo[i]);
}

/*
 * SYNC: what was received before it takes effect, and the synchronous TPDOs are sampled and sent.
 */
static void take_sync(struct virtual_drive *drive)
{
    for (unsigned i = 0; i < VIRTUAL_DRIVE_PDO_COUNT; i++) {
        if (drive->is_held[i])
            apply_rpdo(drive, &drive->rpdo[i].mapping, &drive->held[i]);
        drive->is_held[i] = false;
    }
    send_tpdos(drive, PDO_EVERY_SYNC);
}

void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame)
{
    if (frame->id == NMT_COMMAND_COB_ID)
        take_nmt_command(drive, frame);
    if (drive->nmt != NMT_OPERATIONAL)
        return;
    if (sync_is(frame))
        take_sync(drive);
    for (unsigned i = 0; i < VIRTUAL_DRIVE_PDO_COUNT; i++)
        if (frame->id == drive->rpdo[i].cob_id)
            take_rpdo(drive, i, frame);
}

void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns)
{
    virtual_drive_move(drive, cycle_ns);
    drive->event_ns += cycle_ns;
    if (drive->nmt != NMT_OPERATIONAL || drive->event_ns < EVENT_NS)
        return;
    drive->event_ns -= EVENT_NS;
    send_tpdos(drive, PDO_EVENT);
}

enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive)
{
    return drive->nmt;
}
