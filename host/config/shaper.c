#include "config/shaper.h"

#include "classic/shapers.h"
#include "controller/controller.h"

#include <stddef.h>
#include <string.h>

static struct shape_mode mode_of(const double number[VIBRATION_NUMBERS])
{
    return (struct shape_mode){number[VIBRATION_HZ], number[VIBRATION_DAMPING],
                               number[VIBRATION_PART]};
}

static struct shape_config config_of(const struct machine_setup *setup)
{
    static void (*const trains[])(const struct shape_mode *, double,
                                  struct train *) = {[SHAPER_NEUTRAL] = takt_zv_train,
                                                     [SHAPER_ZV] = takt_zv_train,
                                                     [SHAPER_MZV] = takt_shapers_mzv,
                                                     [SHAPER_EI] = takt_shapers_ei};
    struct shape_config config = {.train = trains[setup->shaper],
                                  .keeps_way = setup->shaper == SHAPER_NEUTRAL,
                                  .cycle_s = machine_cycle_s(&setup->machine)};

    _Static_assert(SHAPE_MODES == VIBRATION_MODES, "the modes of an axis");
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < SHAPE_MODES; n++)
            config.mode[i][n] = mode_of(&setup->vibration.mode[i][(size_t)n * VIBRATION_NUMBERS]);
    }
    return config;
}

static bool has_mode(const struct shape_config *config)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < SHAPE_MODES; n++) {
            if (config->mode[i][n].hz > 0)
                return true;
        }
    }
    return false;
}

const char *shaper_check(const struct machine_setup *setup)
{
    static _Thread_local struct shape tried;

    if (setup->shaper == SHAPER_NONE)
        return NULL;
    const struct shape_config config = config_of(setup);

    if (!has_mode(&config))
        return "no axis has a mode (geometry.mode_x)";
    return takt_shape_init(&tried, &config);
}

struct shape *shaper_prepare(const struct machine_setup *setup, struct shape *s)
{
    if (setup->shaper == SHAPER_NONE)
        return NULL;
    const struct shape_config config = config_of(setup);

    return takt_shape_init(s, &config) == NULL ? s : NULL;
}

void shaper_planned_modes(const struct machine_setup *setup, struct vibration_config *modes)
{
    memset(modes, 0, sizeof *modes);
    if (setup->shaper != SHAPER_NONE)
        return;
    memcpy(modes->mode, setup->vibration.mode, sizeof modes->mode);
    memcpy(modes->uncertain_percent, setup->vibration.uncertain_percent,
           sizeof modes->uncertain_percent);
}

void shaper_plan_limits(const struct machine_setup *setup, struct plan_limits *limits)
{
    static _Thread_local struct shape memory;
    const struct shape *s = shaper_prepare(setup, &memory);

    takt_controller_plan_limits(&setup->machine, limits);
    if (s != NULL)
        takt_shape_leave(s, limits);
}
