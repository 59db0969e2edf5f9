#include "canopen/cia402.h"
#include "canopen/target_pdo.h"
#include "drive/drives_private.h"

#include <assert.h>
#include <string.h>

static_assert((DRIVES_HISTORY & (DRIVES_HISTORY - 1)) == 0, "the history is indexed by a mask");
static_assert(DRIVES_HISTORY > DRIVES_LATENCY_CYCLES, "the history is as long as the latency");

static void init_axis(struct drives *d, unsigned index, const uint8_t node[])
{
    struct drives_axis *axis = &d->axis[index];
    struct pdo target;
    target_pdo_set(&target, node, d->count, index);
    axis->target_cob_id = target.cob_id;
    axis->target_offset = (uint8_t)pdo_offset(&target.mapping, CIA402_TARGET_POSITION);
    d->axis_of_node[node[index]] = (uint8_t)index;
}

void drives_init(struct drives *d, const struct drives_config *config)
{
    uint8_t node[AXIS_COUNT];
    assert(config->count >= 1 && config->count <= AXIS_COUNT);
    memset(d, 0, sizeof *d);
    memset(d->axis_of_node, AXIS_COUNT, sizeof d->axis_of_node);
    d->count = config->count;
    d->start_timeout_cycles = config->start_timeout_cycles;
    d->answer_timeout_cycles = config->answer_timeout_cycles;
    d->nmt_start_pending = true;
    for (unsigned i = 0; i < d->count; i++) {
        assert(config->axis[i].node >= NODE_MIN && config->axis[i].node <= NODE_MAX);
        d->axis[i].config = config->axis[i];
        node[i] = config->axis[i].node;
    }
    for (unsigned i = 0; i < d->count; i++)
        init_axis(d, i, node);
}

void drives_raise(struct drives *d, unsigned index, enum takt_error error, double value)
{
    if (d->state == DRIVES_FAULTED)
        return;
    d->state = DRIVES_FAULTED;
    d->fault_axis = index;
    diagnostic_set(&d->fault, error, 0, 0, &AXIS_LETTERS[d->axis[index].config.axis], 1, value);
}

double drives_axis_actual_mm(const struct drives_axis *axis)
{
    return axis->actual_inc / axis->config.increments_per_mm;
}

bool drives_axis_is_enabled(const struct drives_axis *axis)
{
    return axis->heard && cia402_state(axis->statusword) == CIA402_ENABLED;
}

enum drives_state drives_get_state(const struct drives *d)
{
    return d->state;
}

void drives_get_actual(const struct drives *d, struct point *actual)
{
    memset(actual, 0, sizeof *actual);
    for (unsigned i = 0; i < d->count; i++)
        actual->at[d->axis[i].config.axis] = drives_axis_actual_mm(&d->axis[i]);
}

unsigned drives_cycle_frames(unsigned count, uint8_t length[DRIVES_CYCLE_FRAMES_MAX])
{
    unsigned frames = 0;
    if (count > AXIS_COUNT)
        count = AXIS_COUNT;
    length[frames++] = 0;
    for (unsigned i = 0; i < count; i += 2)
        length[frames++] = i + 1 < count ? 8 : 4;
    for (unsigned i = 0; i < count; i++)
        length[frames++] = DRIVES_STATUS_LENGTH;
    length[frames++] = DRIVES_STATUS_LENGTH;
    return frames;
}

const struct diagnostic *drives_get_fault(const struct drives *d)
{
    return &d->fault;
}
