#define _POSIX_C_SOURCE 200809L

#include "serving/panel_upload.h"

#include "base/crc32.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/text.h"
#include "modbus/crc.h"
#include "panel/registers.h"
#include "replay/format.h"
#include "session/program_front.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Looks for room so often while there is none. */
#define ROOM_WAIT_NS 5000000

/* The mailbox in registers: offset, length and check before the bytes. */
#define CHUNK_WORDS (4 + PANEL_CHUNK_MAX / 2)

static bool begin(struct panel_line *line, const struct text *text, enum panel_upload_kind kind,
                  enum panel_upload_command command)
{
    const uint32_t crc = takt_crc32_add(CRC32_START, text->bytes, text->length);

    return panel_line_set(line, REGISTER_UPLOAD_KIND, kind) &&
           panel_line_set(line, REGISTER_UPLOAD_SIZE, (int64_t)text->length) &&
           panel_line_set(line, REGISTER_UPLOAD_CRC, crc) &&
           panel_line_set(line, REGISTER_UPLOAD_COMMAND, command);
}

static void pack_bytes(uint16_t *word, const uint8_t *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++)
        word[i / 2] |= (uint16_t)(bytes[i] << (i % 2 == 0 ? 8 : 0));
}

/* One request: the chunk from offset on. */
static bool send_chunk(struct panel_line *line, const struct text *text, uint32_t offset)
{
    const uint8_t *bytes = (const uint8_t *)text->bytes + offset;
    const size_t left = text->length - offset;
    const size_t length = left < PANEL_CHUNK_MAX ? left : PANEL_CHUNK_MAX;
    uint16_t word[CHUNK_WORDS] = {(uint16_t)(offset >> 16), (uint16_t)offset, (uint16_t)length,
                                  takt_crc16(bytes, length)};

    pack_bytes(word + 4, bytes, length);
    if (client_write(&line->client, CLIENT_HOLDINGS,
                     takt_panel_registers[REGISTER_UPLOAD_OFFSET].address, CHUNK_WORDS, word))
        return true;
    panel_line_report(line, REGISTER_UPLOAD_CHECK, "written");
    return false;
}

static enum command_status bring(struct panel_line *line, const struct text *text,
                                 enum panel_upload_kind kind)
{
    int64_t received;

    if (!begin(line, text, kind, PANEL_UPLOAD_BEGIN))
        return STATUS_INPUT;
    do {
        if (interrupt_asked())
            return STATUS_INTERRUPTED;
        if (!panel_line_get(line, REGISTER_UPLOAD_RECEIVED, &received))
            return STATUS_ENVIRONMENT;
        if (received < (int64_t)text->length && !send_chunk(line, text, (uint32_t)received))
            return STATUS_ENVIRONMENT;
    } while (received < (int64_t)text->length);
    return panel_line_set(line, REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT) ? STATUS_DONE
                                                                              : STATUS_INPUT;
}

enum command_status panel_upload_file(struct panel_line *line, const char *path, bool quiet)
{
    static const struct dialect_codes none;
    const struct program_front front = {.dialect = DIALECT_AUTO, .codes = &none, .quiet = quiet};
    struct text text;
    enum command_status status = STATUS_INPUT;

    if (!program_front_read(&front, path, &text))
        return STATUS_INPUT;
    if (text.length == 0 || text.length > PANEL_PROGRAM_BYTES_MAX)
        message_error(path, 0, 0, "a program of 1 to %d bytes is expected; it has %zu",
                      PANEL_PROGRAM_BYTES_MAX, text.length);
    else
        status = bring(line, &text, PANEL_UPLOAD_PROGRAM);
    if (status == STATUS_DONE && !quiet)
        (void)printf("%s: %zu bytes\n", path, text.length);
    text_free(&text);
    return status;
}

/* Once. */
static bool start(struct panel_line *line, bool *starts)
{
    const bool due = *starts;

    *starts = false;
    return !due || panel_line_set(line, REGISTER_CYCLE_START, 1);
}

/*
 * Waits until there is room for the next chunk; of a program that nobody has started there never
 * would be.
 */
static enum command_status wait_for_room(struct panel_line *line, size_t left, bool *starts)
{
    const int64_t wanted = (int64_t)(left < PANEL_CHUNK_MAX ? left : PANEL_CHUNK_MAX);
    const struct timespec pause = {.tv_nsec = ROOM_WAIT_NS};
    int64_t room;

    while (panel_line_get(line, REGISTER_UPLOAD_ROOM, &room)) {
        if (room >= wanted)
            return STATUS_DONE;
        if (!start(line, starts))
            return STATUS_INPUT;
        if (interrupt_asked())
            return STATUS_INTERRUPTED;
        (void)nanosleep(&pause, NULL);
    }
    return STATUS_ENVIRONMENT;
}

static enum command_status stream(struct panel_line *line, const struct text *text, bool starts)
{
    enum command_status status = STATUS_DONE;

    for (size_t at = 0; at < text->length && status == STATUS_DONE; at += PANEL_CHUNK_MAX) {
        status = wait_for_room(line, text->length - at, &starts);
        if (status == STATUS_DONE && !send_chunk(line, text, (uint32_t)at))
            status = STATUS_INPUT;
    }
    if (status == STATUS_DONE && !start(line, &starts))
        status = STATUS_INPUT;
    return status;
}

/* Why the controller refuses settings or a compiled program stands in a register of its own. */
static void report_reason(struct panel_line *line)
{
    char reason[PANEL_VALUE_MAX + 1];

    if (panel_line_read(line, REGISTER_UPLOAD_TEXT, reason) && reason[0] != '\0')
        message_command_error("the controller says: %s", reason);
}

enum command_status panel_upload_settings(struct panel_line *line, const char *path, bool quiet)
{
    struct text text;
    enum command_status status = STATUS_INPUT;

    if (!text_read(&text, path))
        return STATUS_INPUT;
    if (text.length == 0 || text.length > PANEL_PROGRAM_BYTES_MAX)
        message_error(path, 0, 0, "not a file of settings: takt machine --pack makes them");
    else
        status = bring(line, &text, PANEL_UPLOAD_SETTINGS);
    if (status == STATUS_INPUT)
        report_reason(line);
    if (status == STATUS_DONE && !quiet)
        (void)printf("%s: %zu bytes; they take effect at the controller's next start\n", path,
                     text.length);
    text_free(&text);
    return status;
}

enum command_status panel_upload_plan(struct panel_line *line, const char *path, bool starts,
                                      bool quiet)
{
    struct text text;
    enum command_status status = STATUS_INPUT;

    if (!text_read(&text, path))
        return STATUS_INPUT;
    if (text.length < REPLAY_HEADER_BYTES || text.length > PANEL_PROGRAM_BYTES_MAX)
        message_error(path, 0, 0, "not a compiled program; takt compile makes them");
    else if (begin(line, &text, PANEL_UPLOAD_PLAN, PANEL_UPLOAD_STREAM))
        status = stream(line, &text, starts);
    if (status == STATUS_INPUT)
        report_reason(line);
    if (status == STATUS_DONE && !quiet)
        (void)printf("%s: %zu bytes\n", path, text.length);
    text_free(&text);
    return status;
}
