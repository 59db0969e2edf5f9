/*
 * An image that keeps settings in flash, which QEMU keeps in a file, and may be stopped at any
 * moment. Its words:
 *
 *     FLASH FOUND [NEW TICKS]
 *
 * It writes the settings that count to FOUND, nothing if there are none that can be used. Then it
 * stores NEW, as the panel does, and stops for good after TICKS ticks of its clock, 40 instructions
 * each; 0: when it is done. The exit status is 0 when it came to its end, STOPPED when the clock
 * was first, and something else when it failed.
 */
#include "mps2/file_flash.h"
#include "port/cortex_m.h"
#include "port/settings_upload.h"
#include "port/startup.h"
#include "semihosting/semihosting.h"

#include <string.h>

#define COMMAND_LINE_MAX 256
#define SETTINGS_MAX     12288
#define CHUNK            128U

enum status { DONE, FAILED = 2, STOPPED = 3 };

static struct {
    struct file_flash file;
    struct store store;
    struct settings_upload upload;
    struct machine machine;
    struct correction_tables tables;
    uint8_t coming[SETTINGS_MAX];
} board;

void takt_port_systick(void)
{
    takt_semihosting_exit(STOPPED);
}

static char *next_word(char **line)
{
    char *word = *line;
    char *end = strchr(word, ' ');

    *line = end == NULL ? word + strlen(word) : end + 1;
    if (end != NULL)
        *end = '\0';
    return word;
}

static uint32_t number_of(const char *word)
{
    uint32_t number = 0;

    while (*word >= '0' && *word <= '9')
        number = 10U * number + (uint32_t)(*word++ - '0');
    return number;
}

/* What a start finds. */
static bool tell_found(const char *path)
{
    const int file = takt_semihosting_open(path, SEMIHOSTING_WRITE);
    const uint8_t *bytes;
    uint32_t size;
    struct diagnostic wrong;

    if (file < 0)
        return false;
    if (!takt_store_get(&board.store, &bytes, &size) ||
        !takt_settings_read(bytes, size, &board.machine, &board.tables, NULL, &wrong))
        return true;
    return takt_semihosting_write(file, bytes, size);
}

static bool may_load(void *context)
{
    (void)context;
    return true;
}

static struct correction_tables *lend_tables(void *context)
{
    (void)context;
    return &board.tables;
}

static void no_log(void *context, const char *text)
{
    (void)context;
    (void)text;
}

static bool bring(const struct panel_store *to, uint32_t size)
{
    if (!to->begin(to->context, size))
        return false;
    for (uint32_t at = 0; at < size; at += CHUNK) {
        const uint32_t length = size - at < CHUNK ? size - at : CHUNK;

        if (!to->write(to->context, at, board.coming + at, length))
            return false;
    }
    return to->prepare(to->context) && to->place(to->context);
}

static void stop_after(uint32_t ticks)
{
    CORTEX_SYSTICK_RELOAD = ticks > 0 ? ticks : CORTEX_SYSTICK_MAX;
    CORTEX_SYSTICK_VALUE = 0;
    CORTEX_SYSTICK_CONTROL =
        CORTEX_SYSTICK_ON | CORTEX_SYSTICK_CORE | (ticks > 0 ? CORTEX_SYSTICK_INTERRUPT : 0U);
}

static bool store_new(const char *path, uint32_t ticks)
{
    static const struct settings_upload_port port = {
        .may_load = may_load, .borrow = lend_tables, .log = no_log};
    const int file = takt_semihosting_open(path, SEMIHOSTING_READ);
    const struct panel_store to = takt_settings_upload_open(&board.upload, &board.store, &port);
    const size_t size = file < 0 ? 0 : takt_semihosting_read(file, board.coming, SETTINGS_MAX);

    if (size == 0)
        return false;
    stop_after(ticks);
    return bring(&to, (uint32_t)size);
}

int main(void)
{
    char words[COMMAND_LINE_MAX];
    char *line = words;
    struct flash_port flash;

    if (!takt_semihosting_command_line(words, sizeof words))
        takt_semihosting_exit(FAILED);
    (void)next_word(&line); /* the image's own name */
    if (!takt_file_flash_open(&board.file, next_word(&line), &flash))
        takt_semihosting_exit(FAILED);
    takt_store_open(&board.store, &flash);
    if (!tell_found(next_word(&line)))
        takt_semihosting_exit(FAILED);
    if (*line != '\0') {
        const char *path = next_word(&line);

        if (!store_new(path, number_of(line)))
            takt_semihosting_exit(FAILED);
    }
    takt_semihosting_exit(DONE);
}
