#define _POSIX_C_SOURCE 200809L

#include "simulation/bus_log.h"

#include "cli/message.h"
#include "cli/output_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FLUSH_NS 1000000000u

bool bus_log_open(struct bus_log *log, const char *path)
{
    log->file = NULL;
    log->path = path;
    if (path == NULL)
        return true;
    if (!output_file_may_write(path))
        return false;
    log->file = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
    if (log->file == NULL) {
        message_command_error("--bus-log %s: it cannot be written: %s", path, strerror(errno));
        return false;
    }
    candump_init(&log->dump, log->file, "can0");
    log->frames.count = 0;
    log->flushed_ns = link_clock_ns();
    return true;
}

void bus_log_observe_link(struct bus_log *log, struct link *link)
{
    if (log->file != NULL)
        link_observe(link, &(struct wire_listener){candump_wire, &log->dump});
}

void bus_log_observe_network(struct bus_log *log, struct drive_network *network)
{
    if (log->file != NULL)
        drive_network_log(network, &log->frames, &log->dump);
}

void bus_log_keep(struct bus_log *log)
{
    uint64_t now_ns;

    if (log->file == NULL)
        return;
    frame_buffer_write(&log->frames);
    now_ns = link_clock_ns();
    if (now_ns - log->flushed_ns < FLUSH_NS)
        return;
    (void)candump_flush(&log->dump);
    log->flushed_ns = now_ns;
}

bool bus_log_has_failed(const struct bus_log *log)
{
    return log->file != NULL && log->dump.failed;
}

/* Longer than any line. */
#define TAIL_MAX 512

/* Cuts what stands behind the last line end. */
static void cut_torn_line(const char *path)
{
    char tail[TAIL_MAX];
    struct stat status;
    FILE *file = stat(path, &status) == 0 && S_ISREG(status.st_mode) ? fopen(path, "r+") : NULL;
    const long size = file != NULL ? (long)status.st_size : 0;
    const long from = size > TAIL_MAX ? size - TAIL_MAX : 0;
    size_t length = 0;

    if (file == NULL)
        return;
    if (fseek(file, from, SEEK_SET) == 0)
        length = fread(tail, 1, sizeof tail, file);
    while (length > 0 && tail[length - 1] != '\n')
        length--;
    (void)!ftruncate(fileno(file), (off_t)from + (off_t)length);
    (void)fclose(file);
}

bool bus_log_close(struct bus_log *log)
{
    bool good;

    if (log->file == NULL)
        return true;
    frame_buffer_write(&log->frames);
    good = candump_flush(&log->dump);
    if (log->file != stdout) {
        good = fclose(log->file) == 0 && good;
        if (!good)
            cut_torn_line(log->path);
    }
    log->file = NULL;
    if (!good)
        message_command_error("--bus-log %s: not everything could be written", log->path);
    return good;
}
