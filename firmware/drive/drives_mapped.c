/*
 * What the mapping of a drive has come to: whether it suffices, what goes by SDO, and what that
 * costs.
 */
#include "canopen/cia402.h"
#include "canopen/objects.h"
#include "drive/drives_layout.h"

#include <stddef.h>

/* None of a group shares a frame any more; the first of them is told so from its beginning. */
static void part_group(struct drives *d)
{
    const unsigned at = d->at_axis;
    unsigned first = at;
    for (unsigned i = d->count; i-- > 0;) {
        if (!drives_are_grouped(d, i, at))
            continue;
        d->axis[i].is_paired = false;
        takt_drives_give_up(d, i, DRIVES_NO_PAIR);
        first = i;
    }
    takt_drives_begin_axis(d, first);
}

static bool raise_unmapped(struct drives *d, uint32_t object)
{
    takt_drives_raise_object(d, d->at_axis, object, TAKT_ERROR_DRIVE_UNMAPPED, d->read[0],
                             takt_sdo_abort_text(d->read[0]));
    return false;
}

/*
 * The target of another mode may have found a place. True: it is told everything anew, for that
 * mode.
 */
static bool try_next_mode(struct drives *d)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    const uint8_t next = takt_drives_mode_after(axis, axis->follow_mode);
    if (next == CIA402_MODE_NONE)
        return false;
    axis->follow_mode = next;
    takt_drives_forget_pdos(axis);
    d->mapping.pass = d->mapping.step = 0;
    d->at_part = DRIVES_SET;
    d->at_step = 0;
    return true;
}

/* With a target that is a velocity a drive that watches nobody would go on for ever. */
static void check_watch(struct drives *d)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    if (d->heartbeat_ms > 0 && !drives_has_given_up(axis, DRIVES_NO_WATCH))
        return;
    takt_drives_raise_object(d, d->at_axis, SDO_OBJECT(OBJECT_CONSUMER_HEARTBEAT, 1),
                             TAKT_ERROR_DRIVE_UNWATCHED, 0, NULL);
}

/* A mode that costs something. */
static void take_mode(struct drives *d)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    if (axis->follow_mode == CIA402_MODE_INTERPOLATED_POSITION)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_CSP);
    if (!drives_is_by_velocity(axis))
        return;
    takt_drives_give_up(d, d->at_axis, DRIVES_NO_POSITION);
    d->steers = true;
    check_watch(d);
}

/* Its target is where a group has it: parts of one frame (target_pdo.h). */
static bool shares_frame(const struct drives *d)
{
    const struct drives_frame *frame = &d->axis[d->at_axis].target_frame;
    struct pdo pdo;
    takt_drives_set_target_pdo(d, &pdo);
    return frame->cob_id == pdo.cob_id && frame->length == pdo.mapping.length &&
           frame->target == takt_drives_byte_of(&pdo, CIA402_TARGET_POSITION);
}

/* The plain form, see drives_receive.c; without a heartbeat more is to be done. */
static void set_report(struct drives_axis *axis)
{
    axis->beats_by_status = drives_has_given_up(axis, DRIVES_NO_HEARTBEAT);
    if (axis->status_id == axis->position_id && axis->status_end == 2 &&
        axis->position_end == DRIVES_STATUS_LENGTH && !axis->beats_by_status)
        axis->report_id = axis->status_id;
}

bool takt_drives_finish_map(struct drives *d)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    axis->mode = axis->follow_mode;
    if (axis->is_paired && !shares_frame(d)) {
        part_group(d);
        return false;
    }
    if (axis->target_frame.length == 0)
        return try_next_mode(d) || raise_unmapped(d, takt_drives_target_of(axis));
    if (axis->status_id == NO_TPDO)
        return raise_unmapped(d, CIA402_STATUSWORD);
    if (axis->position_id == NO_TPDO)
        return raise_unmapped(d, CIA402_POSITION_ACTUAL);
    if (axis->status_id != axis->position_id)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_ONE_REPORT);
    take_mode(d);
    if (axis->control_frame.length == 0)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_CONTROL_PDO);
    if (axis->control_frame.mode == DRIVES_NOWHERE && axis->target_frame.mode == DRIVES_NOWHERE)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_MODE_PDO);
    if (axis->error_id == NO_TPDO)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_ERROR_PDO);
    axis->sends = axis->target_frame.is_mixed ? DRIVES_SENDS_MIXED : DRIVES_SENDS;
    if (axis->is_paired && !drives_ends_group(d, d->at_axis))
        axis->sends = DRIVES_WAITS;
    else
        takt_drives_count_bits(d, axis->target_frame.length);
    set_report(axis);
    return false;
}
