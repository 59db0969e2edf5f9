#include "controller/controller_feed.h"

#include "motion/handover.h"

void takt_controller_feed_init(struct controller *c, const struct replay_source *compiled)
{
    struct product_config config = {.limiter = (enum limiter_form)c->machine.limiter,
                                    .cycle_s = machine_cycle_s(&c->machine)};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        config.band_percent[i] = c->machine.axis[i].limiter_band_percent;
    }
    const bool is_product =
        c->machine.landing == LANDING_SCALE || c->machine.limiter != LIMITER_CEILING;

    takt_product_init(&c->product, &config);
    c->replays = compiled != NULL;
    if (c->replays) {
        takt_replay_init(&c->replay, takt_path_lend(&c->path, sizeof(struct intake)), compiled);
    }
    takt_handover_allow(&c->motion, c->replays   ? MOTION_HANDS_OVER_LINEAR
                                    : is_product ? MOTION_HANDS_OVER_ALL
                                                 : MOTION_HANDS_OVER_SYNCHRONIZED);
}

bool takt_controller_feed_is_product(const struct controller *c)
{
    return !move_kind_is_synchronized(takt_path_kind(&c->path, c->path.first));
}
