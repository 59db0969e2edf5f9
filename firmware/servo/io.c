/*
 * An I/O node (CiA 401) instead of a drive: the same node on the bus, with outputs and inputs in
 * place of a motor. Every input is looped back from the output of its number, or is high for good:
 * a closed circuit.
 */
#include "canopen/objects.h"
#include "servo/servo_private.h"

#include <string.h>

/* In object_table.c: objects 6200 and 6000. */
#define OUTPUTS (drive->objects.extra)
#define INPUTS  (drive->objects.extra + DICTIONARY_IO_BYTES)
/* Object 6411. */
#define ANALOGUES (INPUTS + DICTIONARY_IO_BYTES)

/* A TPDO that is sent when an input changes is also sent when the node becomes operational. */
static void note_change(struct servo *drive)
{
    uint32_t seen = (uint32_t)drive->nmt << 16;
    for (unsigned i = 0; i < DICTIONARY_IO_BYTES; i++) {
        uint32_t byte = 0;
        (void)takt_servo_read_object(drive, PDO_MAPPED(OBJECT_IO_INPUTS, i + 1, 8), &byte);
        seen |= byte << 8 * i;
    }
    if (seen == drive->seen_io)
        return;
    drive->seen_io = seen;
    drive->tpdo[0].is_due = true;
    takt_servo_look_soon(drive);
}

/*
 * Without a controller all outputs are low, and 0: CiA 401, objects 6206, 6207, 6443 and 6444 by
 * default.
 */
void takt_servo_run_io(struct servo *drive)
{
    bool is_controlled = drive->nmt == NMT_OPERATIONAL && drive->communication_error == EMCY_NONE;
    for (unsigned i = 0; i < DICTIONARY_IO_BYTES; i++) {
        if (!is_controlled)
            OUTPUTS[i] = 0;
        INPUTS[i] = (uint8_t)(OUTPUTS[i] | drive->config.closed >> 8 * i);
    }
    if (!is_controlled)
        memset(ANALOGUES, 0, (size_t)2 * DICTIONARY_IO_ANALOGUES);
    note_change(drive);
}
