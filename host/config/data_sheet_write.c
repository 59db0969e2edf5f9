/* Data sheets of virtual drives, as they are at power-on. */
#define _POSIX_C_SOURCE 200809L

#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/text.h"
#include "config/data_sheet.h"
#include "drives/eds.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool send_nowhere(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return true;
}

static bool receive_nothing(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

/* The drive as it is at power-on. */
static enum command_status write_eds(const struct virtual_drive_config *config, const char *path)
{
    static _Thread_local struct virtual_drive drive;
    static const struct can_port nowhere = {.send = send_nowhere, .receive = receive_nothing};
    static _Thread_local struct output_file file;
    const char *slash = strrchr(path, '/');

    if (!output_file_replace(&file, path, path))
        return STATUS_ENVIRONMENT;
    virtual_drive_init(&drive, config, NULL, &nowhere);
    eds_write(file.stream, &drive.servo, slash != NULL ? slash + 1 : path);
    if (!output_file_finish(&file) || !output_file_place(&file))
        return STATUS_ENVIRONMENT;
    return STATUS_DONE;
}

static bool is_folder(const char *path)
{
    struct stat status;

    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* A data sheet of somebody else is not written over. False after a message. */
static bool may_write(const char *path)
{
    struct text text;
    bool is_own;

    if (strcmp(path, "-") == 0 || access(path, F_OK) != 0 || !text_read(&text, path))
        return true;
    is_own = strstr(text.bytes, "CreatedBy=takt") != NULL;
    text_free(&text);
    if (!is_own)
        message_command_error(
            "--eds %s: it is not takt's own, and would be written over; with --bus "
            "the drives are those of this file",
            path);
    return is_own;
}

enum command_status data_sheet_write(const struct virtual_drives_config *drives, const char *path)
{
    enum command_status status = STATUS_DONE;
    char name[OUTPUT_PATH_MAX];

    if (!is_folder(path) && !may_write(path))
        return STATUS_INPUT;
    if (!is_folder(path))
        return write_eds(&drives->drive[0], path);
    for (unsigned i = 0; i < drives->count && status == STATUS_DONE; i++) {
        const struct virtual_drive_config *drive = &drives->drive[i];

        (void)snprintf(name, sizeof name, "%s/takt-drive-%u.eds", path, (unsigned)drive->node);
        status = write_eds(drive, name);
    }
    return status;
}
