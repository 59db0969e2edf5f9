#include "canopen/sync.h"

void takt_sync_write(struct can_frame *frame)
{
    frame->id = SYNC_COB_ID;
    frame->length = 0;
}

bool takt_sync_is(const struct can_frame *frame)
{
    return frame->id == SYNC_COB_ID && frame->length <= 1;
}
