/*
 * Touch probes of the drives (CiA 402-2, 60B8 ... 60BD). A drive latches its own position when its
 * probe input changes, so what a probing move finds is as exact as the encoder, not as the cycle.
 *
 *     takt_drives_arm_probe     each drive   60B8 = 0, which forgets what was before; 60B8 = the edge that is looked for
 *     takt_drives_read_probe    each drive   60B9: has it come? then 60BA or 60BB: where
 *
 * Both take some cycles of SDO, in which the axes are to rest. A drive that refuses has no touch
 * probe and is not asked again; one whose edge has not come is not wired to the probe.
 */
#include "canopen/cia402.h"
#include "drive/drives_private.h"

/* Bits of struct drives.probing. */
#define PROBE_ARMS  DRIVES_PROBE_ARMS
#define PROBE_READS DRIVES_PROBE_READS
#define PROBE_FALLS 4 /* the other edge is looked for */
#define PROBE_USED  8

/* Requests to each drive. */
#define STEPS 2

static bool has_probe(const struct drives *d, unsigned index)
{
    return !drives_is_second(d, index) &&
           !drives_has_given_up(&d->axis[index], DRIVES_NO_TOUCH_PROBE);
}

bool takt_drives_have_probe(const struct drives *d)
{
    bool any = false;
    for (unsigned i = 0; i < d->count; i++)
        any = any || has_probe(d, i);
    return any;
}

bool takt_drives_have_probed(const struct drives *d)
{
    return d->probing & PROBE_USED;
}

static void begin(struct drives *d, unsigned what)
{
    d->probing = (uint8_t)what;
    d->at_axis = d->at_step = d->repeats = 0;
    d->sdo.result = SDO_IDLE;
}

void takt_drives_arm_probe(struct drives *d, bool falls)
{
    for (unsigned i = 0; i < d->count; i++)
        d->axis[i].is_latched = false;
    begin(d, PROBE_USED | PROBE_ARMS | (falls ? PROBE_FALLS : 0u));
}

void takt_drives_read_probe(struct drives *d)
{
    begin(d, PROBE_READS | (d->probing & (PROBE_USED | PROBE_FALLS)));
}

void takt_drives_get_latched(const struct drives *d, struct point *at)
{
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_config_axis *config = &d->axis[i].config;
        if (d->axis[i].is_latched)
            at->at[config->axis] = (int32_t)d->read[i] / config->increments_per_mm;
    }
}

static struct drives_step step_to(uint16_t index, uint8_t length, uint32_t value)
{
    return (struct drives_step){SDO_OBJECT(index, 0), length, value};
}

static struct drives_step step_of(const struct drives *d)
{
    const bool falls = d->probing & PROBE_FALLS;
    const uint32_t edge = falls ? CIA402_PROBE_AT_FALL : CIA402_PROBE_AT_RISE;
    const bool is_first = d->at_step == 0;
    if (d->probing & PROBE_ARMS)
        return step_to(CIA402_PROBE_FUNCTION, 2, is_first ? 0 : CIA402_PROBE_ENABLE | edge);
    if (is_first)
        return step_to(CIA402_PROBE_STATUS, 0, 0);
    return step_to(falls ? CIA402_PROBE_FALLEN : CIA402_PROBE_RISEN, 0, 0);
}

static void take_latched(struct drives *d, uint32_t value)
{
    const uint32_t seen =
        d->probing & PROBE_FALLS ? CIA402_PROBE_HAS_FALLEN : CIA402_PROBE_HAS_RISEN;
    if (d->at_step == 0 && !(value & seen)) {
        d->at_step = STEPS;
        return;
    }
    d->axis[d->at_axis].is_latched = d->at_step == 1;
    d->read[d->at_axis] = value;
    d->at_step++;
}

/*
 * With a refusal, or without an answer though it was asked for again, the position is that of the
 * cycle, which is told.
 */
static void take(struct drives *d)
{
    const bool is_lost = d->sdo.result == SDO_UNANSWERED;
    if (is_lost && d->repeats++ < DRIVES_SDO_REPEATS)
        return;
    d->repeats = 0;
    if (is_lost || (d->sdo.result == SDO_ABORTED && d->probing & PROBE_ARMS))
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_TOUCH_PROBE);
    if (d->sdo.result != SDO_DONE)
        d->at_step = STEPS;
    else if (d->probing & PROBE_READS)
        take_latched(d, takt_sdo_client_number(&d->sdo));
    else
        d->at_step++;
}

void takt_drives_probe_next(struct drives *d)
{
    takt_sdo_client_tick(&d->sdo);
    if (sdo_client_is_busy(&d->sdo))
        return;
    if (d->sdo.result != SDO_IDLE)
        take(d);
    while (d->at_axis < d->count && (d->at_step == STEPS || !has_probe(d, d->at_axis))) {
        d->at_axis++;
        d->at_step = 0;
    }
    if (d->at_axis == d->count) {
        d->probing &= PROBE_USED | PROBE_FALLS;
        d->sdo.result = SDO_IDLE;
        return;
    }
    const struct drives_step step = step_of(d);
    takt_drives_ask(d, drives_bus_of(d, d->at_axis), d->node[d->at_axis], &step);
}
