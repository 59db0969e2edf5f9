/*
 * The main part of every image, on three virtual drives in virtual time: requests of Modbus RTU in,
 * replies out.
 */
#ifndef TAKT_TESTS_EMBEDDED_BENCH_H
#define TAKT_TESTS_EMBEDDED_BENCH_H

#include "base/crc32.h"
#include "bus/bus.h"
#include "drives/virtual_drives.h"
#include "modbus/crc.h"
#include "port/embedded.h"
#include "unity.h"

#include <string.h>

#define UNIT         1
#define CYCLE_NS     1000000U
#define CYCLES_MAX   60000U
#define CHUNK_WORDS  (4 + PANEL_CHUNK_MAX / 2)
#define LOG_MAX      4096
#define TAU          1e-3
#define LIMITS_RATIO 1.001
#define LOOK_AHEAD   32

static struct embedded embedded;
static struct embedded_core embedded_core;
static struct bus bus;
static struct virtual_drives drives;
static struct machine machine;
static struct tool tools[1];
static uint64_t now_ns;
static uint8_t replied[MODBUS_RTU_MAX];
static size_t replied_length;
static char log_text[LOG_MAX];
static bool is_locked;
static struct can_port bus_port;
static unsigned frames_sent; /* by the controller */
static struct point last, velocity, acceleration;

/* Largest, of all axes. */
static double most_velocity, most_acceleration, most_jerk;

/* ---- the port ---- */

static inline void lock(void *context)
{
    (void)context;
    TEST_ASSERT_FALSE(is_locked);
    is_locked = true;
}

static inline void unlock(void *context)
{
    (void)context;
    is_locked = false;
}

static inline uint32_t clock_us(void *context)
{
    (void)context;
    return (uint32_t)(now_ns / 1000);
}

static inline uint32_t clock_ns(void *context)
{
    (void)context;
    return (uint32_t)now_ns;
}

static inline void take_reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    memcpy(replied, bytes, length);
    replied_length = length;
}

static inline void take_log(void *context, const char *text)
{
    (void)context;
    strncat(log_text, text, LOG_MAX - strlen(log_text) - 1);
    strncat(log_text, "\n", LOG_MAX - strlen(log_text) - 1);
}

/* ---- the world ---- */

static inline double magnitude(double value)
{
    return value < 0 ? -value : value;
}

static inline void note(double value, double *most)
{
    if (magnitude(value) > *most)
        *most = magnitude(value);
}

static inline void watch_axis(unsigned i)
{
    const double at = embedded.service.controller.record.set.at[i];
    const double v = (at - last.at[i]) / TAU;
    const double a = (v - velocity.at[i]) / TAU;

    note(v, &most_velocity);
    note(a, &most_acceleration);
    note((a - acceleration.at[i]) / TAU, &most_jerk);
    last.at[i] = at;
    velocity.at[i] = v;
    acceleration.at[i] = a;
}

static inline void check_limits(void)
{
    TEST_ASSERT_TRUE(most_velocity <= machine.axis[0].max_velocity_mm_s * LIMITS_RATIO);
    TEST_ASSERT_TRUE(most_acceleration <= machine.axis[0].max_acceleration_mm_s2 * LIMITS_RATIO);
    TEST_ASSERT_TRUE(most_jerk <= machine.axis[0].max_jerk_mm_s3 * LIMITS_RATIO);
}

static inline void cycle(void)
{
    const struct inputs inputs = inputs_idle();

    takt_embedded_background(&embedded);
    takt_embedded_cycle(&embedded, &inputs, false);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        watch_axis(i);
    now_ns += CYCLE_NS;
    bus_run_until(&bus, now_ns);
    virtual_drives_step(&drives, CYCLE_NS);
}

static inline void wait_for(enum panel_state state)
{
    for (unsigned i = 0; i < CYCLES_MAX && takt_service_get_state(&embedded.service) != state; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(state, takt_service_get_state(&embedded.service));
}

static inline bool send(void *context, const struct can_frame *frame)
{
    (void)context;
    frames_sent++;
    return bus_port.send(bus_port.context, frame);
}

static inline bool receive(void *context, struct can_frame *frame)
{
    (void)context;
    return bus_port.receive(bus_port.context, frame);
}

/* lines: of a console; NULL: there is none. */
static inline void power_on_with(const struct service_lines *lines)
{
    const struct embedded_config config = {
        .machine = &machine,
        .core = &embedded_core,
        .can = {.port = {{.send = send, .receive = receive}}},
        .tools = tools,
        .tools_count = 1,
        .port = {.lock = lock,
                 .unlock = unlock,
                 .now_us = clock_us,
                 .now_ns = clock_ns,
                 .reply = take_reply,
                 .log = take_log},
        .unit = UNIT,
        .gap_us = 10000,
        .name = "takt in a test",
        .lines = lines,
    };

    takt_embedded_init(&embedded, &config);
}

static inline void power_on(void)
{
    power_on_with(NULL);
}

static inline void bench_set_up_with(const struct service_lines *lines)
{
    struct virtual_drives_config virtual;

    virtual_drives_set_default(&virtual, AXIS_LINEAR_COUNT);
    takt_machine_set_default(&machine);
    machine.look_ahead_blocks = LOOK_AHEAD;
    TEST_ASSERT_TRUE(bus_init(&bus, machine.can_bitrate));
    bus_port = bus_attach(&bus, NULL);
    frames_sent = 0;
    virtual_drives_init(&drives, &bus, &virtual);
    now_ns = 0;
    log_text[0] = '\0';
    is_locked = false;
    last = velocity = acceleration = (struct point){{0}};
    most_velocity = most_acceleration = most_jerk = 0;
    power_on_with(lines);
}

static inline void bench_set_up(void)
{
    bench_set_up_with(NULL);
}

/* ---- the panel ---- */

/* One request; the exception it is refused with, 0: none. */
static inline unsigned ask(const uint8_t *pdu, size_t length)
{
    uint8_t frame[MODBUS_RTU_MAX] = {UNIT};
    uint16_t crc;

    memcpy(frame + 1, pdu, length);
    crc = takt_crc16(frame, length + 1);
    frame[length + 1] = (uint8_t)crc;
    frame[length + 2] = (uint8_t)(crc >> 8);
    replied_length = 0;
    for (size_t i = 0; i < length + 3; i++)
        takt_embedded_take_byte(&embedded, frame[i], (uint32_t)(now_ns / 1000));
    takt_embedded_background(&embedded);
    TEST_ASSERT_GREATER_THAN(0, (int)replied_length);
    return (replied[1] & 0x80U) != 0 ? replied[2] : 0;
}

static inline unsigned write_words(uint16_t address, const uint16_t *word, unsigned count)
{
    uint8_t pdu[MODBUS_PDU_MAX] = {16};

    modbus_write16(pdu + 1, address);
    modbus_write16(pdu + 3, (uint16_t)count);
    pdu[5] = (uint8_t)(2 * count);
    for (unsigned i = 0; i < count; i++)
        modbus_write16(pdu + 6 + (size_t)2 * i, word[i]);
    return ask(pdu, 6 + (size_t)2 * count);
}

static inline unsigned set(enum panel_id id, uint32_t value)
{
    const uint16_t words[2] = {(uint16_t)(value >> 16), (uint16_t)value};
    const bool is_wide = takt_panel_registers[id].words == 2;
    uint8_t coil[5] = {5};

    if (takt_panel_registers[id].table != MODBUS_COILS)
        return write_words(takt_panel_registers[id].address, is_wide ? words : words + 1,
                           is_wide ? 2 : 1);
    modbus_write16(coil + 1, takt_panel_registers[id].address);
    modbus_write16(coil + 3, value != 0 ? 0xFF00 : 0);
    return ask(coil, sizeof coil);
}

static inline uint32_t get(enum panel_id id)
{
    uint8_t pdu[5] = {4};

    modbus_write16(pdu + 1, takt_panel_registers[id].address);
    modbus_write16(pdu + 3, takt_panel_registers[id].words);
    TEST_ASSERT_EQUAL_UINT(0, ask(pdu, sizeof pdu));
    return takt_panel_registers[id].words == 1
               ? modbus_read16(replied + 3)
               : (uint32_t)modbus_read16(replied + 3) << 16 | modbus_read16(replied + 5);
}

static inline unsigned begin(const char *text, size_t size, uint32_t command)
{
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_SIZE, (uint32_t)size));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_CRC, takt_crc32_add(CRC32_START, text, size)));
    return set(REGISTER_UPLOAD_COMMAND, command);
}

/* The next chunk of a text, if there is room for it. The exception it is refused with. */
static inline unsigned bring(const char *text, size_t size)
{
    const uint32_t at = get(REGISTER_UPLOAD_RECEIVED);
    const size_t length = size - at < PANEL_CHUNK_MAX ? size - at : PANEL_CHUNK_MAX;
    uint16_t word[CHUNK_WORDS] = {(uint16_t)(at >> 16), (uint16_t)at, (uint16_t)length,
                                  takt_crc16((const uint8_t *)text + at, length)};

    for (size_t i = 0; i < length; i++)
        word[4 + i / 2] |= (uint16_t)((uint8_t)text[at + i] << (i % 2 == 0 ? 8 : 0));
    return write_words(takt_panel_registers[REGISTER_UPLOAD_OFFSET].address, word, CHUNK_WORDS);
}

#endif
