#include "outside/spindle_service.h"

#include "cli/message.h"
#include "cli/stopwatch.h"
#include "serving/serving_options.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define STEP_NS 1000000u

/* What happened longer ago, while nobody looked, no longer shows. */
#define PAST_NS (60 * UINT64_C(1000000000))

/* It turns when somebody looks: up to now, in equal steps. */
static void turn(struct spindle_service *s)
{
    const uint64_t now_ns = stopwatch_now_ns();

    if (now_ns - s->time_ns > PAST_NS)
        s->time_ns = now_ns - PAST_NS;
    for (; now_ns - s->time_ns >= STEP_NS; s->time_ns += STEP_NS)
        vfd_registers_step(&s->registers, 1e-9 * STEP_NS);
}

static enum modbus_exception read_map(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    struct spindle_service *s = context;

    turn(s);
    return s->map.read(s->map.context, table, address, count, data);
}

static enum modbus_exception write_map(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    struct spindle_service *s = context;

    turn(s);
    return s->map.write(s->map.context, table, address, count, data);
}

static struct modbus_map enter(void *context, unsigned place)
{
    (void)place;
    return (struct modbus_map){.read = read_map, .write = write_map, .context = context};
}

static void leave(void *context, unsigned place)
{
    (void)context;
    (void)place;
}

static bool keeps(void *context, unsigned place)
{
    (void)context;
    (void)place;
    return false;
}

static bool open_serial(struct spindle_service *s, const char *where, struct server_config *config)
{
    if (!serial_settings_read(&s->serial, where)) {
        message_command_error(
            "--spindle %s: PATH, PATH,BAUD or PATH,BAUD,even|odd|none is expected", where);
        return false;
    }
    config->serial = serial_line_open(&s->serial);
    config->serial_gap_us = takt_modbus_rtu_gap_us(s->serial.bauds, SERIAL_BITS);
    if (config->serial < 0)
        message_command_error("%s: %s", s->serial.path, strerror(errno));
    return config->serial >= 0;
}

static bool open_place(struct spindle_service *s, const char *where, struct server_config *config)
{
    if (strchr(where, '/') != NULL)
        return open_serial(s, where, config);
    (void)snprintf(s->address, sizeof s->address, "%s", where);
    if (serving_options_split(s->address, &config->address, &config->port))
        return true;
    message_command_error(
        "--spindle %s: HOST:PORT, PORT at most 65535, or the path of a serial line, is expected",
        where);
    return false;
}

static void say_where(const struct spindle_service *s)
{
    const struct server_config *config = &s->server.config;

    if (config->address != NULL)
        (void)printf("spindle on %s:%u\n", config->address, (unsigned)server_get_port(&s->server));
    else
        (void)printf("spindle on %s, unit %u\n", s->serial.path, (unsigned)config->unit);
    (void)fflush(stdout);
}

enum command_status spindle_service_start(struct spindle_service *s,
                                          const struct machine_setup *setup, const char *where,
                                          uint8_t unit, bool quiet)
{
    const struct virtual_spindle_config spindle = machine_setup_get_spindle(setup);
    struct server_config config = {
        .host = {.enter = enter, .leave = leave, .keeps = keeps, .context = s},
        .serial = -1,
        .unit = unit,
    };
    const char *problem = NULL;

    memset(s, 0, sizeof *s);
    vfd_registers_init(&s->registers, &spindle);
    s->map = vfd_registers_get_map(&s->registers);
    s->time_ns = stopwatch_now_ns();
    if (!open_place(s, where, &config))
        return strchr(where, '/') != NULL ? STATUS_ENVIRONMENT : STATUS_INPUT;
    if (!server_open(&s->server, &config, &problem) || !server_start(&s->server)) {
        message_command_error("--spindle %s: %s", where,
                              problem != NULL ? problem : "no thread for it");
        server_close(&s->server);
        return STATUS_ENVIRONMENT;
    }
    if (!quiet)
        say_where(s);
    return STATUS_DONE;
}

void spindle_service_stop(struct spindle_service *service)
{
    server_close(&service->server);
}
