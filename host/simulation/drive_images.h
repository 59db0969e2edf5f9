/*
 * The drives of a machine as images in QEMU, one a drive: --drives m4f of takt run and takt serve,
 * --target m4f of takt drives (target/drive_image.h).
 */
#ifndef TAKT_HOST_DRIVE_IMAGES_H
#define TAKT_HOST_DRIVE_IMAGES_H

#include "drives/virtual_drives.h"
#include "target/drive_image.h"

#include <stdbool.h>
#include <stdint.h>

#define DRIVE_IMAGES_PROBLEM_MAX (DRIVE_IMAGE_PROBLEM_MAX + 64)
#define DRIVE_IMAGES_FIRST_MAX   48

/* It must not be moved once opened. count 0: the drives are none. */
struct drive_images {
    const char *name;
    unsigned count;
    uint8_t node[VIRTUAL_DRIVES_MAX];
    struct drive_image image[VIRTUAL_DRIVES_MAX];
    char problem[DRIVE_IMAGES_PROBLEM_MAX];
};

/*
 * Starts QEMU for every drive of the configuration with a motor, and has it run beside the one
 * here. False after a message: it cannot be; drive_images_close is due in either case.
 */
bool drive_images_open(struct drive_images *images, const char *name, const char *path,
                       struct virtual_drives_config *drives);
void drive_images_close(struct drive_images *images);

/*
 * An image has ended, or does another thing than the drive here: what, until the next call. NULL:
 * none.
 */
const char *drive_images_problem(struct drive_images *images);

/* Frames and torques that were not those of the drives here, to the bit. */
uint64_t drive_images_differences(const struct drive_images *images);
/* "drive 2 at 0.001 s": the earliest of them. There is at least one. */
void drive_images_write_first(const struct drive_images *images, char text[DRIVE_IMAGES_FIRST_MAX]);

#endif
