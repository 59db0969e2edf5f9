/*
 * The main part of every image, on three virtual drives in virtual time: requests of Modbus RTU in, replies out.
 */
#include "base/crc32.h"
#include "bus/bus.h"
#include "drives/virtual_drives.h"
#include "modbus/crc.h"
#include "port/embedded.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

#define UNIT           1
#define CYCLE_NS       1000000U
#define CYCLES_MAX     60000U
#define PROGRAM_MAX    ((size_t)3 * TEXT_QUEUE_MAX)
#define CHUNK_WORDS    (4 + PANEL_CHUNK_MAX / 2)
#define LOG_MAX        4096
#define TAU            1e-3
#define LIMITS_RATIO   1.001
#define CYCLES_STARVED 500
#define LOOK_AHEAD     32

static struct embedded embedded;
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

static void lock(void *context)
{
    (void)context;
    TEST_ASSERT_FALSE(is_locked);
    is_locked = true;
}

static void unlock(void *context)
{
    (void)context;
    is_locked = false;
}

static uint32_t clock_us(void *context)
{
    (void)context;
    return (uint32_t)(now_ns / 1000);
}

static uint32_t clock_ns(void *context)
{
    (void)context;
    return (uint32_t)now_ns;
}

static void take_reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    memcpy(replied, bytes, length);
    replied_length = length;
}

static void take_log(void *context, const char *text)
{
    (void)context;
    strncat(log_text, text, LOG_MAX - strlen(log_text) - 1);
    strncat(log_text, "\n", LOG_MAX - strlen(log_text) - 1);
}

/* ---- the world ---- */

static double magnitude(double value)
{
    return value < 0 ? -value : value;
}

static void note(double value, double *most)
{
    if (magnitude(value) > *most)
        *most = magnitude(value);
}

static void watch_axis(unsigned i)
{
    const double at = embedded.service.controller.setpoint.at[i];
    const double v = (at - last.at[i]) / TAU;
    const double a = (v - velocity.at[i]) / TAU;

    note(v, &most_velocity);
    note(a, &most_acceleration);
    note((a - acceleration.at[i]) / TAU, &most_jerk);
    last.at[i] = at;
    velocity.at[i] = v;
    acceleration.at[i] = a;
}

static void cycle(void)
{
    const struct inputs inputs = inputs_idle();

    embedded_background(&embedded);
    embedded_cycle(&embedded, &inputs, false);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        watch_axis(i);
    now_ns += CYCLE_NS;
    bus_run_until(&bus, now_ns);
    virtual_drives_step(&drives, CYCLE_NS);
}

static void wait_for(enum panel_state state)
{
    for (unsigned i = 0; i < CYCLES_MAX && service_get_state(&embedded.service) != state; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(state, service_get_state(&embedded.service));
}

static bool send(void *context, const struct can_frame *frame)
{
    (void)context;
    frames_sent++;
    return bus_port.send(bus_port.context, frame);
}

static bool receive(void *context, struct can_frame *frame)
{
    (void)context;
    return bus_port.receive(bus_port.context, frame);
}

static void power_on(void)
{
    const struct embedded_config config = {
        .machine = &machine,
        .can = {.send = send, .receive = receive},
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
    };

    embedded_init(&embedded, &config);
}

void setUp(void)
{
    struct virtual_drives_config virtual;

    virtual_drives_set_default(&virtual, AXIS_LINEAR_COUNT);
    machine_set_default(&machine);
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
    power_on();
}

void tearDown(void)
{
}

/* ---- the panel ---- */

/* One request; the exception it is refused with, 0: none. */
static unsigned ask(const uint8_t *pdu, size_t length)
{
    uint8_t frame[MODBUS_RTU_MAX] = {UNIT};
    uint16_t crc;

    memcpy(frame + 1, pdu, length);
    crc = crc16(frame, length + 1);
    frame[length + 1] = (uint8_t)crc;
    frame[length + 2] = (uint8_t)(crc >> 8);
    replied_length = 0;
    for (size_t i = 0; i < length + 3; i++)
        embedded_take_byte(&embedded, frame[i], (uint32_t)(now_ns / 1000));
    embedded_background(&embedded);
    TEST_ASSERT_GREATER_THAN(0, (int)replied_length);
    return (replied[1] & 0x80U) != 0 ? replied[2] : 0;
}

static unsigned write_words(uint16_t address, const uint16_t *word, unsigned count)
{
    uint8_t pdu[MODBUS_PDU_MAX] = {16};

    modbus_write16(pdu + 1, address);
    modbus_write16(pdu + 3, (uint16_t)count);
    pdu[5] = (uint8_t)(2 * count);
    for (unsigned i = 0; i < count; i++)
        modbus_write16(pdu + 6 + (size_t)2 * i, word[i]);
    return ask(pdu, 6 + (size_t)2 * count);
}

static unsigned set(enum panel_id id, uint32_t value)
{
    const uint16_t words[2] = {(uint16_t)(value >> 16), (uint16_t)value};
    const bool is_wide = panel_registers[id].words == 2;
    uint8_t coil[5] = {5};

    if (panel_registers[id].table != MODBUS_COILS)
        return write_words(panel_registers[id].address, is_wide ? words : words + 1,
                           is_wide ? 2 : 1);
    modbus_write16(coil + 1, panel_registers[id].address);
    modbus_write16(coil + 3, value != 0 ? 0xFF00 : 0);
    return ask(coil, sizeof coil);
}

static uint32_t get(enum panel_id id)
{
    uint8_t pdu[5] = {4};

    modbus_write16(pdu + 1, panel_registers[id].address);
    modbus_write16(pdu + 3, panel_registers[id].words);
    TEST_ASSERT_EQUAL_UINT(0, ask(pdu, sizeof pdu));
    return panel_registers[id].words == 1
               ? modbus_read16(replied + 3)
               : (uint32_t)modbus_read16(replied + 3) << 16 | modbus_read16(replied + 5);
}

static unsigned begin(const char *text, size_t size, uint32_t command)
{
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_SIZE, (uint32_t)size));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_CRC, crc32_add(CRC32_START, text, size)));
    return set(REGISTER_UPLOAD_COMMAND, command);
}

/* The next chunk of a text, if there is room for it. The exception it is refused with. */
static unsigned bring(const char *text, size_t size)
{
    const uint32_t at = get(REGISTER_UPLOAD_RECEIVED);
    const size_t length = size - at < PANEL_CHUNK_MAX ? size - at : PANEL_CHUNK_MAX;
    uint16_t word[CHUNK_WORDS] = {(uint16_t)(at >> 16), (uint16_t)at, (uint16_t)length,
                                  crc16((const uint8_t *)text + at, length)};

    for (size_t i = 0; i < length; i++)
        word[4 + i / 2] |= (uint16_t)((uint8_t)text[at + i] << (i % 2 == 0 ? 8 : 0));
    return write_words(panel_registers[REGISTER_UPLOAD_OFFSET].address, word, CHUNK_WORDS);
}

/* A square, again and again, until the text is so long. */
static size_t long_program(char *text, size_t length)
{
    static const char talk[] =
        "(so that there is more text than there is motion, as in real programs)";
    size_t at = (size_t)sprintf(text, "G21 G90 G61 F6000\n");

    while (at + 400 < length)
        at += (size_t)sprintf(text + at, "G1 X4 Y0 %s\nG1 X4 Y3 %s\nG1 X0 Y3 %s\nG1 X0 Y0 %s\n",
                              talk, talk, talk, talk);
    return at + (size_t)sprintf(text + at, "M2\n");
}

static char program[PROGRAM_MAX];

/* Cycles until the program has ended, bringing what there is room for. */
static void run_stream(size_t size)
{
    for (unsigned i = 0; i < CYCLES_MAX && get(REGISTER_OUTCOME) == PANEL_OUTCOME_NONE; i++) {
        if (get(REGISTER_UPLOAD_RECEIVED) < size)
            (void)bring(program, size);
        cycle();
    }
}

/* What the same text gives that is there from the beginning: the digest of the setpoints. */
static uint64_t digest_of_whole(size_t size)
{
    static struct source_text whole;
    struct controller_config config = {
        .machine = &machine,
        .can = {.send = send, .receive = receive},
        .parameters = &embedded.parameters,
    };
    const struct point start = {{0}};

    wait_for(PANEL_IDLE);
    source_open_text(&config.source, &whole, program, size);
    controller_start_program(&embedded.service.controller, &config, &start);
    embedded.service.job = SERVICE_PROGRAM;
    wait_for(PANEL_IDLE);
    return embedded.service.digest;
}

/* ---- claims ---- */

static void test_a_program_that_fits_is_kept_and_runs_as_often_as_wanted(void)
{
    const char *text = "G1 X2 F3000\nG1 X0\nM2\n";

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(text, strlen(text), PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL_UINT(0, bring(text, strlen(text)));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
    for (unsigned runs = 1; runs <= 2; runs++) {
        TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
        wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
        TEST_ASSERT_EQUAL_UINT32(runs, get(REGISTER_RUNS));
    }
    TEST_ASSERT_NOT_NULL(strstr(log_text, "state: running\ncompleted, setpoints "));
}

static void test_a_program_longer_than_the_memory_is_no_upload(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(MODBUS_VALUE, begin(program, size, PANEL_UPLOAD_BEGIN));
}

static void test_a_stream_that_keeps_up_gives_the_setpoints_of_the_whole_text(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    const uint64_t whole = digest_of_whole(size);

    setUp();
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_NONE, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_HEX64(whole, embedded.service.digest);
}

static void test_a_chunk_without_room_is_refused_and_can_come_again(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    unsigned exception = 0;

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    while (exception == 0)
        exception = bring(program, size);
    TEST_ASSERT_EQUAL_UINT(MODBUS_BUSY, exception);
    TEST_ASSERT_LESS_THAN_UINT32(PANEL_CHUNK_MAX, get(REGISTER_UPLOAD_ROOM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
}

static void test_a_starved_stream_brakes_within_limits_raises_an_alarm_and_goes_on(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    struct point at;

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    while (get(REGISTER_UPLOAD_RECEIVED) < size / 2) {
        (void)bring(program, size);
        cycle();
    }
    for (unsigned i = 0; i < CYCLES_MAX && embedded.service.alarm == PANEL_ALARM_NONE; i++)
        cycle();
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_STARVED, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROGRAM_STARVED, embedded.service.alarm_text.code);
    TEST_ASSERT_EQUAL_UINT32(PANEL_RUNNING, get(REGISTER_STATE));
    at = embedded.service.at;
    for (unsigned i = 0; i < CYCLES_STARVED; i++)
        cycle();
    TEST_ASSERT_TRUE(point_is_same(&at, &embedded.service.at));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    TEST_ASSERT_TRUE(most_velocity <= machine.axis[0].max_velocity_mm_s * LIMITS_RATIO);
    TEST_ASSERT_TRUE(most_acceleration <= machine.axis[0].max_acceleration_mm_s2 * LIMITS_RATIO);
    TEST_ASSERT_TRUE(most_jerk <= machine.axis[0].max_jerk_mm_s3 * LIMITS_RATIO);
}

static void test_a_stream_that_is_given_up_or_wrong_ends_the_program_in_an_error(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);

    for (unsigned wrong = 0; wrong < 2; wrong++) {
        setUp();
        wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
        TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
        for (unsigned i = 0; i < 20; i++)
            (void)bring(program, size);
        if (wrong != 0)
            embedded.panel.upload.crc++;
        else
            TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_ABANDON));
        for (unsigned i = 0; i < CYCLES_MAX && embedded.service.alarm == PANEL_ALARM_NONE; i++) {
            if (wrong != 0 && get(REGISTER_UPLOAD_RECEIVED) < size)
                (void)bring(program, size);
            cycle();
        }
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_PROGRAM, get(REGISTER_ALARM));
        TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_FAILED, get(REGISTER_OUTCOME));
    }
}

static void test_a_running_program_is_not_overwritten(void)
{
    const char *text = "G1 X20 F600\nM2\n";

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(text, strlen(text), PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL_UINT(0, bring(text, strlen(text)));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    cycle();
    TEST_ASSERT_NOT_EQUAL(0, begin("M2\n", 3, PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_NOT_EQUAL(0, begin("M2\n", 3, PANEL_UPLOAD_STREAM));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
}

static void test_a_machine_that_must_not_run_says_why_and_sends_nothing(void)
{
    const enum takt_error reasons[] = {TAKT_ERROR_IMAGE_DAMAGED, TAKT_ERROR_CAN_ABSENT};

    for (unsigned i = 0; i < sizeof reasons / sizeof reasons[0]; i++) {
        const struct diagnostic why = {.code = reasons[i], .value = 0x1234};
        char text[DIAGNOSTIC_TEXT_MAX];

        setUp();
        embedded_refuse(&embedded, &why);
        for (unsigned k = 0; k < CYCLES_STARVED; k++)
            cycle();
        (void)diagnostic_text(&why, text);
        TEST_ASSERT_NOT_NULL(strstr(log_text, text));
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM, get(REGISTER_STATE));
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_INTERNAL, get(REGISTER_ALARM));
        TEST_ASSERT_EQUAL_UINT(MODBUS_STATE, set(REGISTER_RESET, 1));
        TEST_ASSERT_EQUAL_UINT32(0, embedded.cycles);
        TEST_ASSERT_EQUAL_UINT(0, frames_sent);
    }
}

/* As a clock read in several interrupts does: no request is lost by it. */
static void test_a_clock_that_steps_back_breaks_no_request(void)
{
    uint8_t frame[8] = {UNIT, 4, 0, 1, 0, 1};
    const uint16_t crc = crc16(frame, 6);

    frame[6] = (uint8_t)crc;
    frame[7] = (uint8_t)(crc >> 8);
    now_ns = 50 * (uint64_t)CYCLE_NS;
    replied_length = 0;
    for (unsigned i = 0; i < sizeof frame; i++) {
        embedded_take_byte(&embedded, frame[i], (uint32_t)(now_ns / 1000) + (i % 2) * 900);
        embedded_background(&embedded);
    }
    TEST_ASSERT_EQUAL_UINT(7, replied_length);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_program_that_fits_is_kept_and_runs_as_often_as_wanted);
    RUN_TEST(test_a_program_longer_than_the_memory_is_no_upload);
    RUN_TEST(test_a_stream_that_keeps_up_gives_the_setpoints_of_the_whole_text);
    RUN_TEST(test_a_chunk_without_room_is_refused_and_can_come_again);
    RUN_TEST(test_a_starved_stream_brakes_within_limits_raises_an_alarm_and_goes_on);
    RUN_TEST(test_a_stream_that_is_given_up_or_wrong_ends_the_program_in_an_error);
    RUN_TEST(test_a_running_program_is_not_overwritten);
    RUN_TEST(test_a_machine_that_must_not_run_says_why_and_sends_nothing);
    RUN_TEST(test_a_clock_that_steps_back_breaks_no_request);
    return UNITY_END();
}
