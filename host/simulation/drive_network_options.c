/* Whether options of buses and drives go together. */
#include "cli/message.h"
#include "simulation/drive_network.h"

#include <stdio.h>
#include <string.h>

bool drive_network_next_address(const char **list, char address[DRIVE_NETWORK_ADDRESS_MAX + 1])
{
    const char *at = *list;

    if (at == NULL)
        return false;
    const char *comma = strchr(at, ',');
    const size_t length = comma != NULL ? (size_t)(comma - at) : strlen(at);

    (void)snprintf(address, DRIVE_NETWORK_ADDRESS_MAX + 1, "%.*s", (int)length, at);
    *list = comma != NULL ? comma + 1 : NULL;
    return true;
}

bool drive_network_is_outside(const struct drive_network_options *options)
{
    char address[DRIVE_NETWORK_ADDRESS_MAX + 1];
    enum link_kind kind = LINK_EMBEDDED;
    struct link_error error;
    const char *list = options->bus;

    return drive_network_next_address(&list, address) && link_check(address, &kind, &error) &&
           kind != LINK_EMBEDDED;
}

static bool check_bus(const char *list)
{
    char address[DRIVE_NETWORK_ADDRESS_MAX + 1];
    const bool is_single = list == NULL || strchr(list, ',') == NULL;
    enum link_kind kind;
    struct link_error error;

    while (drive_network_next_address(&list, address)) {
        if (!link_check(address, &kind, &error)) {
            message_command_error("--bus: %s", error.text);
            return false;
        }
        if (kind == LINK_EMBEDDED && !is_single) {
            message_command_error("--bus: embedded are all buses, or none: it stands alone");
            return false;
        }
    }
    return true;
}

/* Where the drives are images, and nowhere else, their file is given. */
static bool check_images(const struct drive_network_options *options)
{
    const char *drives = options->drives;
    const bool has_images = drives != NULL && drive_image_is_known(drives);

    if (drives != NULL && !has_images && strcmp(drives, "internal") != 0 &&
        strcmp(drives, "external") != 0) {
        message_command_error("--drives %s: internal, external, or m4f or m7 is expected", drives);
        return false;
    }
    if (has_images == (options->drive_image != NULL))
        return true;
    message_command_error("--drives m4f or m7 and --drive-image belong together; host/run --drives "
                          "NAME builds the image and gives both");
    return false;
}

bool drive_network_check_options(const struct drive_network_options *options)
{
    const char *drives = options->drives;

    if (!check_bus(options->bus))
        return false;
    if (options->has_script && drive_network_is_outside(options)) {
        message_command_error("--inject: what goes wrong on an outside bus is not up to this "
                              "process; give drives their faults by takt drives --inject");
        return false;
    }
    if (!check_images(options))
        return false;
    if (drives == NULL)
        return true;
    if (strcmp(drives, "external") == 0 && !drive_network_is_outside(options)) {
        message_command_error("--drives external needs a bus that other processes can reach: "
                              "--bus socketcan:can0, slcan:PATH or socketcand:HOST:PORT");
        return false;
    }
    if (strcmp(drives, "external") != 0 && drive_network_is_outside(options)) {
        message_command_error("--drives %s are on the embedded bus; with --bus %s they are "
                              "external, a process of `takt drives` or real ones",
                              drives, options->bus);
        return false;
    }
    return true;
}
