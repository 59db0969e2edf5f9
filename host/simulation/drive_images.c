#include "simulation/drive_images.h"

#include "cli/message.h"

#include <stdio.h>
#include <string.h>

static bool start_one(struct drive_images *images, const char *path,
                      struct virtual_drive_config *drive)
{
    struct drive_image *image = &images->image[images->count];

    images->node[images->count++] = drive->node;
    if (!drive_image_open(image, images->name, path)) {
        message_command_error("drive %u: %s", (unsigned)drive->node, image->problem);
        return false;
    }
    drive->twin = &image->twin;
    return true;
}

bool drive_images_open(struct drive_images *images, const char *name, const char *path,
                       struct virtual_drives_config *drives)
{
    images->name = name;
    images->count = 0;
    if (drives->is_fd) {
        message_command_error(
            "bus.data_bitrate: images of drives speak classical CAN alone, so it must be 0");
        return false;
    }
    for (unsigned i = 0; i < drives->count; i++) {
        struct virtual_drive_config *drive = &drives->drive[i];

        if (drive->is_io)
            continue;
        if (drive->dictionary != NULL && drive->dictionary->memory != NULL) {
            message_command_error(
                "drive %u has the data sheet of another maker: an image has its own "
                "objects alone",
                (unsigned)drive->node);
            return false;
        }
        if (!start_one(images, path, drive))
            return false;
    }
    return true;
}

void drive_images_close(struct drive_images *images)
{
    for (unsigned i = 0; i < images->count; i++)
        drive_image_close(&images->image[i]);
    images->count = 0;
}

const char *drive_images_problem(struct drive_images *images)
{
    for (unsigned i = 0; i < images->count; i++) {
        if (images->image[i].problem[0] == '\0')
            continue;
        (void)snprintf(images->problem, sizeof images->problem, "drive %u on %s: %s",
                       (unsigned)images->node[i], images->name, images->image[i].problem);
        return images->problem;
    }
    return NULL;
}

uint64_t drive_images_differences(const struct drive_images *images)
{
    uint64_t differences = 0;

    for (unsigned i = 0; i < images->count; i++)
        differences += images->image[i].differences;
    return differences;
}

void drive_images_write_first(const struct drive_images *images, char text[DRIVE_IMAGES_FIRST_MAX])
{
    unsigned first = images->count;

    for (unsigned i = 0; i < images->count; i++) {
        const struct drive_image *image = &images->image[i];

        if (image->differences > 0 &&
            (first == images->count ||
             image->first_difference_ns < images->image[first].first_difference_ns))
            first = i;
    }
    (void)snprintf(text, DRIVE_IMAGES_FIRST_MAX, "drive %u at %.6f s",
                   (unsigned)images->node[first],
                   (double)images->image[first].first_difference_ns * 1e-9);
}
