#include "simulation/cutting_feed.h"

double cutting_feed_mm_s(const struct controller *controller)
{
    const struct cycle_record *record = takt_controller_get_record(controller);
    const struct block *block = takt_controller_get_block(controller);

    if (record == NULL || block == NULL || block->move.kind == MOVE_RAPID)
        return 0.0;
    return record->feed_mm_s;
}
