/*
 * What comes over lines and buses: texts of adapters and logs, and frames for drives and for their
 * master.
 */
#include "readers.h"

#include "bus/candump_read.h"
#include "drive/drives.h"
#include "drives/virtual_drives.h"
#include "link/slcan.h"
#include "link/socketcand.h"

#include <string.h>

#define DRIVES   3
#define CYCLE_NS 1000000U

/* What was read as a frame is written, and read as the same. */
static void check_slcan(const struct wire_frame *frame)
{
    char line[SLCAN_LINE_MAX];
    struct wire_frame again;
    const size_t length = slcan_write(line, frame);

    require(length > 0 && length <= sizeof line);
    require(slcan_read(line, length - 1, &again));
    require(again.id == frame->id && again.flags == frame->flags && again.length == frame->length);
}

void read_slcan(const uint8_t *data, size_t size)
{
    struct wire_frame frame;

    if (slcan_read((const char *)data, size, &frame))
        check_slcan(&frame);
}

void read_socketcand(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data;
    struct wire_frame frame;
    size_t begin;
    size_t length;

    for (size_t at = 0; (length = socketcand_find(text + at, size - at, &begin)) > 0;
         at += begin + length) {
        require(begin + length <= size - at);
        (void)socketcand_read_send(text + at + begin, length, &frame);
        (void)socketcand_read_frame(text + at + begin, length, &frame);
        (void)socketcand_is(text + at + begin, length, "< open vcan0 >");
    }
}

void read_candump(const uint8_t *data, size_t size)
{
    struct candump_line line;
    unsigned column = 0;

    if (candump_read_line((const char *)data, size, &line, &column) != NULL)
        require(column <= size + 1);
}

/*
 * The input as frames: identifier (2 bytes, with the cycles before it in the upper bits), length
 * (the highest bit: a remote frame), data.
 */
struct frames {
    const uint8_t *data;
    size_t size;
    unsigned cycles; /* before the next frame */
};

static bool next_frame(struct frames *f, struct can_frame *frame)
{
    if (f->size < 3)
        return false;
    *frame = (struct can_frame){.id = (uint16_t)(f->data[0] | (f->data[1] & 7U) << 8),
                                .length = (uint8_t)(f->data[2] % (CAN_DATA_MAX + 1U))};
    if (f->data[2] & 0x80U)
        frame->id |= CAN_REMOTE;
    f->cycles = f->data[1] >> 3;
    f->data += 3;
    f->size -= 3;
    for (unsigned i = 0; i < frame->length && f->size > 0; i++) {
        frame->data[i] = *f->data++;
        f->size--;
    }
    return true;
}

static bool send_nowhere(void *context, const struct can_frame *frame)
{
    (void)context;
    require(frame->length <= CAN_DATA_MAX && (frame->id & ~CAN_REMOTE) <= CAN_ID_MASK);
    return true;
}

static bool receive_nothing(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

/* NMT, SYNC, SDO and PDO of any master, for three virtual drives. */
void read_frames_of_master(const uint8_t *data, size_t size)
{
    static struct virtual_drives set;
    static const struct can_port port = {.send = send_nowhere, .receive = receive_nothing};
    struct frames frames = {.data = data, .size = size};
    struct virtual_drives_config config;
    struct can_frame frame;

    virtual_drives_set_default(&config, DRIVES);
    virtual_drives_open(&set, &port, &config);
    virtual_drives_boot(&set);
    while (next_frame(&frames, &frame)) {
        for (unsigned i = 0; i < frames.cycles; i++)
            virtual_drives_step(&set, CYCLE_NS);
        virtual_drives_take(&set, &frame);
    }
}

static void open_master(struct drives *drives)
{
    struct drives_config config = {
        .count = DRIVES,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .heartbeat_ms = 100,
        .boot_timeout_cycles = 100,
        .start_timeout_cycles = 400,
        .answer_timeout_cycles = 20,
        .sdo_timeout_cycles = 10,
        .stop_timeout_cycles = 20,
        .brake_timeout_cycles = 50,
    };

    for (unsigned i = 0; i < DRIVES; i++)
        config.axis[i] = (struct drives_config_axis){
            .axis = (enum axis)i, .node = (uint8_t)(i + 1), .increments_per_mm = 1e5};
    takt_drives_init(drives, &config);
}

/* The first of the frames of a cycle is the one that says how many cycles come before it. */
static bool receive_next(void *context, struct can_frame *frame)
{
    struct frames *frames = context;

    if (frames->cycles > 0 || !next_frame(frames, frame))
        return false;
    return true;
}

/*
 * Anything from the drives, for the master: it goes from start over operation to a fault, and never
 * back.
 */
void read_frames_of_drives(const uint8_t *data, size_t size)
{
    static struct drives drives;
    static const struct point setpoint;
    struct frames frames = {.data = data, .size = size};
    const struct can_port port = {
        .send = send_nowhere, .receive = receive_next, .context = &frames};
    enum drives_state before;

    open_master(&drives);
    while (frames.size >= 3) {
        before = drives_get_state(&drives);
        takt_drives_receive(&drives, &port);
        takt_drives_sync(&drives, &port);
        takt_drives_send(&drives, &port, &setpoint);
        require(drives_get_state(&drives) >= before);
        frames.cycles -= frames.cycles > 0;
    }
}
