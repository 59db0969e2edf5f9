/*
 * What is stored: compiled programs, settings, flash, the state of a service. Where a checksum
 * keeps damage out, it is made right here, so that what comes behind it is reached: by the lowest
 * bit of the first byte.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "readers.h"

#include "base/crc32.h"
#include "canopen/concise_dcf.h"
#include "canopen/sdo_client.h"
#include "drives/drive_store.h"
#include "drives/virtual_drive.h"
#include "motion/handover.h"
#include "replay/replay.h"
#include "serve/state.h"
#include "storage/settings.h"
#include "storage/store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BYTES_MAX    65536U
#define CYCLES       200
#define SECTOR_BYTES 1024U
#define FLASH_BYTES  ((size_t)FLASH_SECTORS * SECTOR_BYTES)
#define TOOLS_MAX    16

/* At a multiple of 8. */
static uint64_t memory[BYTES_MAX / 8];

static uint8_t *bytes(void)
{
    return (uint8_t *)memory;
}

static size_t take_bytes(const uint8_t *data, size_t size)
{
    const size_t taken = size < BYTES_MAX ? size : BYTES_MAX;

    memcpy(bytes(), data, taken);
    return taken;
}

struct stream {
    size_t length, given;
};

static size_t read_stream(void *context, uint8_t *to, size_t size)
{
    struct stream *s = context;
    const size_t left = s->length - s->given;
    const size_t count = left < size ? left : size;

    memcpy(to, bytes() + s->given, count);
    s->given += count;
    return count;
}

/* Header and records with right checksums, as far as there are whole ones. */
static void seal_plan(size_t length)
{
    struct replay_header header;
    uint32_t crc = CRC32_START;
    size_t at = REPLAY_HEADER_BYTES;

    if (length < REPLAY_HEADER_BYTES)
        return;
    header = (struct replay_header){.cycle_us = 1000,
                                    .step_cycles = 1U + bytes()[0] % 4U,
                                    .quantum_bits = bytes()[1] % 41U,
                                    .ceiling_percent = 100U + bytes()[2] % 21U,
                                    .blocks = bytes()[3],
                                    .sections = bytes()[4],
                                    .intervals = bytes()[5],
                                    .kept = 0.99};
    takt_replay_header_write(&header, bytes());
    while (at + REPLAY_RECORD_HEAD + REPLAY_RECORD_TAIL <= length) {
        const size_t whole = REPLAY_RECORD_HEAD + (size_t)takt_replay_get(bytes() + at + 1, 2);

        if (at + whole + REPLAY_RECORD_TAIL > length)
            return;
        crc = takt_crc32_add(crc, bytes() + at, whole);
        takt_replay_put(bytes() + at + whole, crc, REPLAY_RECORD_TAIL);
        at += whole + REPLAY_RECORD_TAIL;
    }
}

static struct path path;
static struct motion motion;
static struct plan_limits limits;

static void open_path(void)
{
    const struct point start = {{0}};
    const struct move line = {
        .kind = MOVE_FEED, .end = {{1.0}}, .feed_mm_s = 10, .turns = 1, .line = 1};

    limits = (struct plan_limits){.axes = 7, .cycle_s = 1e-3, .chord_error_max_mm = 1e-3};
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = 100;
        limits.acceleration_mm_s2[i] = 1000;
        limits.jerk_mm_s3[i] = 50000;
    }
    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    takt_handover_allow(&motion, MOTION_HANDS_OVER_ALL);
    takt_path_push(&path, &line);
    takt_path_finish(&path);
    takt_path_go_on(&path);
    takt_motion_build(&motion);
}

/* A compiled program, replayed beside a path of one line. */
void read_plan(const uint8_t *data, size_t size)
{
    static struct replay replay;
    struct stream stream = {0};
    const struct replay_source source = {.context = &stream, .read = read_stream};
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record;

    if (size == 0)
        return;
    stream.length = take_bytes(data + 1, size - 1);
    if (data[0] & 1U)
        seal_plan(stream.length);
    open_path();
    takt_replay_init(&replay, takt_path_lend(&path, sizeof(struct intake)), &source);
    for (unsigned i = 0; i < CYCLES; i++) {
        takt_replay_read(&replay, &limits);
        if (takt_motion_cycle(&motion, &as_programmed, &record) == MOTION_HANDED_OVER &&
            takt_replay_cycle(&replay, &motion, &as_programmed, &record) == REPLAY_FAILED)
            return;
    }
}

static void seal_settings(size_t length)
{
    const uint32_t words[] = {(uint32_t)length,
                              takt_crc32_add(CRC32_START, bytes() + 12, length - 12)};

    memcpy(bytes(), "TKM1", 4);
    memcpy(bytes() + 4, words, sizeof words);
}

/* The machine of an image. */
void read_settings(const uint8_t *data, size_t size)
{
    static struct machine machine;
    static struct correction_tables tables;
    static struct concise_dcf dcf[MACHINE_NODES_MAX];
    static struct correction scratch;
    struct diagnostic wrong;
    size_t length;

    if (size == 0)
        return;
    length = take_bytes(data + 1, size - 1);
    if ((data[0] & 1U) && length >= 16)
        seal_settings(length);
    if (takt_settings_read(bytes(), length, &machine, &tables, dcf, &wrong))
        (void)takt_settings_check_share(&machine, &tables, &scratch, &wrong);
}

static bool send_nowhere(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return true;
}

/*
 * A concise configuration that is good lies within its bytes, and has as many entries as it says.
 */
void read_configuration(const uint8_t *data, size_t size)
{
    const struct concise_dcf dcf = {.bytes = data, .length = (uint32_t)size};
    uint32_t at = CONCISE_DCF_FIRST, object, count = 0;
    struct concise_dcf_entry entry;

    if (!takt_concise_dcf_is_well(&dcf, &object))
        return;
    while (takt_concise_dcf_next(&dcf, &at, &entry)) {
        require(entry.size > 0 && entry.size <= SDO_CLIENT_VALUE_MAX &&
                entry.value + entry.size <= data + size);
        (void)takt_concise_dcf_has(&dcf, at, entry.object);
        count++;
    }
    require(at == size &&
            count == (size_t)(data[0] | data[1] << 8 | data[2] << 16) + ((size_t)data[3] << 24));
}

/*
 * What a virtual drive has on its disk. One that takes it boots, and what it stores is taken again.
 */
void read_drive_store(const uint8_t *data, size_t size)
{
    static struct virtual_drive drive, again;
    static const struct can_port port = {.send = send_nowhere};
    struct virtual_drive_config config = {.node = 5, .increments_per_mm = 1000, .cycle_us = 1000};
    struct drive_store_problem wrong;
    char *text = NULL;
    size_t length = 0;
    FILE *stream;

    drive_plant_set_default(&config.plant);
    virtual_drive_init(&drive, &config, NULL, &port);
    if (!drive_store_read(&drive.servo, (const char *)data, size, &wrong))
        return;
    virtual_drive_boot(&drive);
    virtual_drive_step(&drive, 1000000);
    stream = open_memstream(&text, &length);
    require(stream != NULL);
    drive_store_write(stream, &drive.servo);
    require(fclose(stream) == 0);
    virtual_drive_init(&again, &config, NULL, &port);
    require(drive_store_read(&again.servo, text, length, &wrong));
    free(text);
}

static bool erase(void *context, unsigned sector)
{
    (void)context;
    memset(bytes() + (size_t)SECTOR_BYTES * sector, 0xFF, SECTOR_BYTES);
    return true;
}

static bool program(void *context, unsigned sector, uint32_t offset, const uint8_t *from,
                    uint32_t words)
{
    const size_t size = (size_t)words * FLASH_WORD_BYTES;

    (void)context;
    require(offset + size <= SECTOR_BYTES);
    memcpy(bytes() + (size_t)SECTOR_BYTES * sector + offset, from, size);
    return true;
}

/* Two sectors of anything: what counts is within its sector, and a new set can be stored. */
void read_flash(const uint8_t *data, size_t size)
{
    static const uint8_t set[] = "a new set";
    const struct flash_port port = {.sector_bytes = SECTOR_BYTES,
                                    .sector = {bytes(), bytes() + SECTOR_BYTES},
                                    .erase = erase,
                                    .program = program};
    struct store store;
    const uint8_t *found;
    uint32_t length;

    memset(memory, 0xFF, FLASH_BYTES);
    (void)take_bytes(data, size < FLASH_BYTES ? size : FLASH_BYTES);
    takt_store_open(&store, &port);
    if (takt_store_get(&store, &found, &length))
        require(length <= takt_store_room(&store) && found >= bytes() &&
                found + length <= bytes() + FLASH_BYTES);
    require(takt_store_begin(&store, sizeof set) && takt_store_write(&store, set, sizeof set) &&
            takt_store_commit(&store));
    takt_store_open(&store, &port);
    require(takt_store_get(&store, &found, &length) && length == sizeof set &&
            memcmp(found, set, length) == 0);
}

/* What is read of a state is written, and read as the same. */
void read_state(const uint8_t *data, size_t size)
{
    static struct tool tools[TOOLS_MAX];
    static struct state state;
    char problem[STATE_PROBLEM_MAX + 1];
    size_t length;
    char *text;

    memset(&state, 0, sizeof state);
    state.tools = tools;
    state.tools_max = TOOLS_MAX;
    if (!state_read(&state, (const char *)data, size, problem))
        return;
    text = state_write(&state, &length);
    require(text != NULL && state_read(&state, text, length, problem));
    free(text);
}
