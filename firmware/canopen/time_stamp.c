#include "canopen/time_stamp.h"

#include "base/assert.h"
#include "canopen/little_endian.h"

/* The upper four bits of the milliseconds are reserved. */
#define MS_MASK 0x0FFFFFFFu

void takt_time_stamp_write(struct can_frame *frame, const struct time_stamp *time)
{
    *frame = (struct can_frame){.id = TIME_COB_ID, .length = TIME_FRAME_LENGTH};
    little_endian_write32(frame->data, time->ms & MS_MASK);
    little_endian_write16(frame->data + 4, time->days);
}

bool takt_time_stamp_read(const struct can_frame *frame, struct time_stamp *time)
{
    if (frame->length != TIME_FRAME_LENGTH)
        return false;
    time->ms = little_endian_read32(frame->data) & MS_MASK;
    time->days = little_endian_read16(frame->data + 4);
    return time->ms < TIME_MS_PER_DAY;
}

struct time_stamp takt_time_stamp_add(struct time_stamp time, uint64_t by_ms)
{
    uint64_t ms = time.ms + by_ms;
    TAKT_ASSERT(time.ms < TIME_MS_PER_DAY);
    return (struct time_stamp){.ms = (uint32_t)(ms % TIME_MS_PER_DAY),
                               .days = (uint16_t)(time.days + ms / TIME_MS_PER_DAY)};
}
