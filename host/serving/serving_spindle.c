#include "serving/serving_spindle.h"

#include "cli/message.h"
#include "serving/serving_options.h"

#include <stdio.h>
#include <string.h>

/* An answer takes milliseconds; a line that is silent for so long is lost. */
#define ANSWER_MS       300
#define SILENT_AFTER_US 1000000

static const char parity[] = {[SERIAL_EVEN] = 'E', [SERIAL_ODD] = 'O', [SERIAL_NONE] = 'N'};

static bool set_place(struct serving_spindle *s, const char *where, struct client_config *config)
{
    if (strchr(where, '/') == NULL) {
        (void)snprintf(s->address, sizeof s->address, "%s", where);
        return serving_options_split(s->address, &config->host, &config->port);
    }
    if (!serial_settings_read(&s->serial, where))
        return false;
    config->path = s->serial.path;
    config->bauds = s->serial.bauds;
    config->parity = parity[s->serial.parity];
    return true;
}

/* One pole pair: frequency and speed are those of a two-pole motor, as fast spindles have. */
static void open_vfd(struct serving_spindle *s, const struct machine_setup *setup)
{
    const struct virtual_spindle_config spindle = machine_setup_get_spindle(setup);
    const struct vfd_config config = {
        .cycle_us = setup->machine.cycle_us,
        .pole_pairs = 1.0,
        .max_hz = spindle.max_rpm / 60.0,
        .ramp_rpm_s = spindle.ramp_rpm_s,
        .at_speed_percent = spindle.at_speed_percent,
        .silent_after_us = SILENT_AFTER_US,
    };

    takt_vfd_init(&s->vfd, &config);
}

static bool open_outside(struct serving_spindle *s, const struct machine_setup *setup,
                         const char *where, uint8_t unit)
{
    struct client_config config = {.unit = unit, .timeout_ms = ANSWER_MS};

    if (!set_place(s, where, &config)) {
        message_command_error("--spindle %s: HOST:PORT, PORT at most 65535, or the path of a "
                              "serial line, is expected",
                              where);
        return false;
    }
    open_vfd(s, setup);
    if (!registers_client_start(&s->client, &config)) {
        message_command_error("--spindle %s: no thread for it", where);
        return false;
    }
    s->port = registers_client_get_port(&s->client);
    s->is_outside = true;
    return true;
}

bool serving_spindle_open(struct serving_spindle *s, const struct machine_setup *setup,
                          const char *where, uint8_t unit)
{
    const struct virtual_spindle_config config = machine_setup_get_spindle(setup);

    memset(s, 0, sizeof *s);
    s->cycle_s = machine_cycle_s(&setup->machine);
    virtual_spindle_init(&s->inside, &config);
    return where == NULL || open_outside(s, setup, where, unit);
}

void serving_spindle_close(struct serving_spindle *s)
{
    if (s->is_outside)
        registers_client_stop(&s->client);
    s->is_outside = false;
}

struct spindle_feedback serving_spindle_cycle(struct serving_spindle *s, double commanded_rpm,
                                              double cut_mm_s)
{
    if (s->is_outside)
        return takt_vfd_cycle(&s->vfd, &s->port, commanded_rpm);
    return virtual_spindle_step(
        &s->inside, s->cycle_s, commanded_rpm,
        virtual_spindle_cut_nm(&s->inside, cut_mm_s, s->inside.config.cut_depth_mm));
}

bool serving_spindle_stop(struct serving_spindle *s)
{
    if (!s->is_outside)
        return true;
    takt_vfd_stop(&s->vfd);
    return takt_vfd_is_stopped(&s->vfd);
}

void serving_spindle_reset(struct serving_spindle *s)
{
    if (s->is_outside)
        takt_vfd_reset(&s->vfd);
    else
        virtual_spindle_set_trip(&s->inside, VIRTUAL_SPINDLE_GOOD);
}
