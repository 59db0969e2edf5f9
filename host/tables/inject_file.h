/*
 * Files of scripted faults.
 */
#ifndef TAKT_HOST_INJECT_FILE_H
#define TAKT_HOST_INJECT_FILE_H

#include "inject/inject.h"

#include <stdbool.h>

/*
 * Reads a script, "-" from standard input. False after a message: it cannot be read, or is wrong.
 */
bool inject_file_load(struct inject *script, const char *path);

/*
 * Every fault of a drive names a node that is there. nodes: INJECT_ADDRESS of all drives. False
 * after a message.
 */
bool inject_file_check_nodes(const struct inject *script, const char *path, const uint16_t nodes[],
                             unsigned count);

#endif
