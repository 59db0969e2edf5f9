/*
 * Built where no processes can be started: in a page. No target is known, so none is ever opened.
 */
#include "target/drive_image.h"

#include <stdio.h>
#include <string.h>

bool drive_image_is_known(const char *name)
{
    (void)name;
    return false;
}

bool drive_image_open(struct drive_image *image, const char *name, const char *path)
{
    (void)name;
    (void)path;
    memset(image, 0, sizeof *image);
    (void)snprintf(image->problem, sizeof image->problem, "this build of takt has no targets");
    return false;
}

void drive_image_close(struct drive_image *image)
{
    (void)image;
}
