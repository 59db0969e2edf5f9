/*
 * Drives that are images in QEMU, one process a drive, beside those of this process
 * (drives/virtual_drive_twin.h).
 *
 * Both get the same orders. What the image does goes to bus and motor, and is compared with what
 * the drive here does at the same moment, bit for bit: every frame, every torque. Where they do
 * another thing at all, or QEMU ends, the talk is over: `problem` says so, and the drive here goes
 * on alone.
 */
#ifndef TAKT_TARGET_DRIVE_IMAGE_H
#define TAKT_TARGET_DRIVE_IMAGE_H

#include "drives/virtual_drives.h"
#include "target/process.h"
#include "twin/twin.h"

#include <stdbool.h>
#include <stdint.h>

#define DRIVE_IMAGE_PROBLEM_MAX 255

/* Private, but for differences, first_difference_ns and problem. */
struct drive_image {
    struct virtual_drive_twin twin;
    struct process process;
    const struct servo *here;
    struct can_port bus;
    struct motor_port motor;
    struct servo_meddler meddler;
    bool is_talking;
    bool is_in_order; /* one is being carried out */
    uint64_t differences;
    uint64_t first_difference_ns;              /* since power-on */
    char problem[DRIVE_IMAGE_PROBLEM_MAX + 1]; /* "": none */
};

/* Is there a target of that name that drives are built for? */
bool drive_image_is_known(const char *name);

/*
 * Starts QEMU; the drive is switched on with virtual_drive_init of a config whose twin is
 * image->twin. It must not be moved. False: image->problem; drive_image_close is due in either
 * case.
 */
bool drive_image_open(struct drive_image *image, const char *name, const char *path);
void drive_image_close(struct drive_image *image);

#endif
