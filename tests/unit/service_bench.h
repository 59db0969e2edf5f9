/*
 * What the tests of the service share: a service on three virtual drives, in virtual time.
 */
#ifndef TAKT_TESTS_SERVICE_BENCH_H
#define TAKT_TESTS_SERVICE_BENCH_H

#include "bus/bus.h"
#include "drives/virtual_drives.h"
#include "service/service.h"
#include "unity.h"

#include <string.h>

#define BENCH_DRIVES   3U
#define BENCH_CYCLE_NS 1000000U
/* No test takes longer than this unless it fails. */
#define BENCH_CYCLES_MAX 60000U

static struct service service;
static struct controller_reader service_reader;
static struct bus bus;
static struct virtual_drives drives;
static struct parameters parameters;
static struct tool tools[1];
static struct machine machine;
static const struct correction_tables *correction; /* NULL: none */
static struct service_lines service_lines;         /* of a console; all NULL: none */
static struct step_port step_port;                 /* of a machine with step drives */
static struct inputs world;
static struct source_text program_text;
static const char *program, *staged;
static uint64_t now_ns;

static bool bench_open(void *context, struct source *source)
{
    (void)context;
    if (program == NULL)
        return false;
    takt_source_open_text(source, &program_text, program, strlen(program));
    return true;
}

static void bench_adopt(void *context)
{
    (void)context;
    program = staged;
}

static void cycle(void)
{
    takt_service_background(&service);
    takt_service_cycle(&service, &world);
    now_ns += BENCH_CYCLE_NS;
    bus_run_until(&bus, now_ns);
    virtual_drives_step(&drives, BENCH_CYCLE_NS);
}

static void wait_for(enum panel_state state)
{
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != state; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(state, takt_service_get_state(&service));
}

static void bench_start(void)
{
    const struct service_config config = {
        .machine = &machine,
        .can = can_single(bus_attach(&bus, NULL)),
        .step = step_port,
        .tools = tools,
        .tools_count = 1,
        .reader = &service_reader,
        .parameters = &parameters,
        .correction = correction,
        .programs = {bench_open, bench_adopt, NULL},
        .lines = service_lines,
    };

    takt_service_init(&service, &config);
    wait_for(PANEL_IDLE);
}

/* Everything but the service: the machine may still be changed. */
static void bench_set_up_machine(void)
{
    struct virtual_drives_config virtual;

    virtual_drives_set_default(&virtual, BENCH_DRIVES);
    takt_machine_set_default(&machine);
    TEST_ASSERT_TRUE(bus_init(&bus, machine.can_bitrate));
    virtual_drives_init(&drives, &bus, &virtual);
    takt_parameters_clear(&parameters);
    memset(tools, 0, sizeof tools);
    tools[0].number = 3;
    program = staged = NULL;
    world = inputs_idle();
    world.spindle.at_speed = true;
    now_ns = 0;
    correction = NULL;
}

/* setUp of a test. */
static inline void bench_set_up(void)
{
    bench_set_up_machine();
    bench_start();
}

static inline enum panel_verdict order(enum panel_id id, int64_t value)
{
    const struct panel_order one = {.count = 1, .item = {{id, value}}};

    return takt_service_order(&service, &one);
}

static inline void must(enum panel_id id, int64_t value)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(PANEL_DONE, order(id, value), takt_panel_texts[id].name);
}

static inline int64_t shown(enum panel_id id)
{
    static struct panel_snapshot snapshot;

    takt_service_look(&service, &snapshot);
    return panel_value(&snapshot, id);
}

static inline const char *alarm_text(void)
{
    static struct panel_snapshot snapshot;

    takt_service_look(&service, &snapshot);
    return snapshot.alarm_text;
}

static inline void load(const char *text)
{
    const struct panel_order commit = {
        .count = 3,
        .item = {{REGISTER_UPLOAD_SIZE, (int64_t)strlen(text)},
                 {REGISTER_UPLOAD_CRC, 1},
                 {REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT}},
    };

    staged = text;
    TEST_ASSERT_EQUAL_INT(PANEL_DONE, takt_service_order(&service, &commit));
}

static inline void start_line(const char *line)
{
    struct panel_order start = {.count = 1, .item = {{REGISTER_MDI_START, 1}}};

    memcpy(start.mdi, line, strlen(line) + 1);
    must(REGISTER_MODE, PANEL_MODE_MDI);
    TEST_ASSERT_EQUAL_INT(PANEL_DONE, takt_service_order(&service, &start));
}

#endif
