/*
 * The drives of a machine together: behind a port they do what they do on the embedded bus, they
 * hear each other, and after homing the controller knows where the axes are.
 */
#include "bus/bus.h"
#include "canopen/sdo.h"
#include "drive/drives.h"
#include "drives/virtual_drives.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define DRIVES     3
#define CYCLE_NS   1000000u
#define CYCLES     600
#define FRAMES_MAX 20000

static struct bus bus;
static struct virtual_drives embedded, outside;
static struct drives master;
static struct can_port port;
static struct virtual_drives_config drives_config;
static struct drives_config master_config;

/* Frames on the embedded bus: the controller's, and the TPDOs of the drives. */
static struct can_frame told[FRAMES_MAX], answered[FRAMES_MAX], heard[FRAMES_MAX];
static unsigned told_count, answered_count, heard_count;

static bool is_tpdo(const struct can_frame *frame)
{
    unsigned function = frame->id & 0x780;
    return function == 0x180 || function == 0x280;
}

static bool is_of_controller(const struct can_frame *frame)
{
    unsigned function = frame->id & 0x780;
    return frame->id == 0 || frame->id == 0x080 || frame->id == 0x77F || function == 0x200 ||
           function == 0x300 || function == 0x600;
}

static void on_bus_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    (void)context;
    (void)time_ns;
    TEST_ASSERT_TRUE(told_count < FRAMES_MAX && answered_count < FRAMES_MAX);
    if (is_of_controller(frame))
        told[told_count++] = *frame;
    if (is_tpdo(frame))
        answered[answered_count++] = *frame;
}

void setUp(void)
{
    virtual_drives_set_default(&drives_config, DRIVES);
    master_config = (struct drives_config){.count = DRIVES,
                                           .cycle_us = 1000,
                                           .rates = {1000000, 0},
                                           .controller_node = 127,
                                           .heartbeat_ms = 100,
                                           .boot_timeout_cycles = 500,
                                           .start_timeout_cycles = 1000,
                                           .answer_timeout_cycles = 20,
                                           .sdo_timeout_cycles = 20,
                                           .brake_timeout_cycles = 1000};
    for (unsigned i = 0; i < DRIVES; i++)
        master_config.axis[i] = (struct drives_config_axis){.axis = (enum axis)(AXIS_X + (int)i),
                                                            .node = (uint8_t)(i + 1),
                                                            .increments_per_mm = 1e5,
                                                            .following_error_max_mm = 1.0};
    told_count = answered_count = heard_count = 0;
}

void tearDown(void)
{
}

static void start_embedded(void)
{
    TEST_ASSERT_TRUE(bus_init(&bus, 1000000));
    bus_observe(&bus, &(struct bus_listener){on_bus_frame, NULL});
    port = bus_attach(&bus, NULL);
    virtual_drives_init(&embedded, &bus, &drives_config);
    takt_drives_init(&master, &master_config);
}

static void cycle(const struct point *setpoint)
{
    takt_drives_receive(&master, &port);
    takt_drives_sync(&master, &port);
    takt_drives_send(&master, &port, setpoint);
    bus_run_until(&bus, bus_now_ns(&bus) + CYCLE_NS);
    virtual_drives_step(&embedded, CYCLE_NS);
}

static void start_master(void)
{
    struct point here = {{0}};
    for (unsigned k = 0; k < 20000 && drives_get_state(&master) == DRIVES_STARTING; k++)
        cycle(&here);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&master));
}

static bool hear(void *context, const struct can_frame *frame)
{
    (void)context;
    TEST_ASSERT_TRUE(heard_count < FRAMES_MAX);
    if (is_tpdo(frame))
        heard[heard_count++] = *frame;
    return true;
}

static bool receive_nothing(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static void start_outside(void)
{
    const struct can_port outside_port = {.send = hear, .receive = receive_nothing};
    virtual_drives_open(&outside, &outside_port, &drives_config);
    virtual_drives_boot(&outside);
}

/* The frames of one identifier, in their order. */
static unsigned pick(const struct can_frame *frames, unsigned count, unsigned id,
                     struct can_frame picked[])
{
    unsigned n = 0;
    for (unsigned i = 0; i < count; i++)
        if (frames[i].id == id)
            picked[n++] = frames[i];
    return n;
}

static void assert_same_frames(unsigned id)
{
    static struct can_frame first[FRAMES_MAX], second[FRAMES_MAX];
    unsigned first_count = pick(answered, answered_count, id, first);
    unsigned second_count = pick(heard, heard_count, id, second);
    TEST_ASSERT_TRUE(first_count > 5);
    TEST_ASSERT_EQUAL_UINT(first_count, second_count);
    for (unsigned i = 0; i < first_count; i++) {
        TEST_ASSERT_EQUAL_UINT8(first[i].length, second[i].length);
        TEST_ASSERT_EQUAL_MEMORY(first[i].data, second[i].data, first[i].length);
    }
}

static void test_drives_behind_a_port_answer_every_sync_as_on_the_embedded_bus(void)
{
    struct point setpoint = {{0}};
    start_embedded();
    start_master();
    for (unsigned k = 0; k < CYCLES; k++) {
        setpoint.at[AXIS_X] = 5 * (1 - cos(0.01 * k));
        setpoint.at[AXIS_Y] = 3 * sin(0.007 * k) - 0.021 * k;
        cycle(&setpoint);
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&master));
    start_outside();
    for (unsigned i = 0; i < told_count; i++)
        (void)virtual_drives_take_by_sync(&outside, &told[i]);
    virtual_drives_step(&outside, CYCLE_NS); /* the cycle that no SYNC has ended */
    for (unsigned i = 0; i < DRIVES; i++) {
        assert_same_frames(0x181 + i);
        double inside_mm = virtual_drive_get_position_mm(&embedded.drive[i]);
        TEST_ASSERT_TRUE(inside_mm == virtual_drive_get_position_mm(&outside.drive[i]));
    }
}

static void write_object(unsigned node, uint32_t object, unsigned bytes, uint32_t value)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, (uint16_t)(SDO_REQUEST_FUNCTION + node),
                            (uint8_t)(0x23 | (4 - bytes) << 2), object, value);
    (void)virtual_drives_take_by_sync(&outside, &frame);
}

static bool take(unsigned id, unsigned length, uint8_t first, uint8_t second)
{
    const struct can_frame frame = {
        .id = (uint16_t)id, .length = (uint8_t)length, .data = {first, second}};
    return virtual_drives_take_by_sync(&outside, &frame);
}

static void test_sync_is_the_clock_when_all_drives_have_been_told_its_period(void)
{
    start_outside();
    TEST_ASSERT_FALSE(take(0x080, 0, 0, 0));
    write_object(1, SDO_OBJECT(0x1006, 0), 4, 2000);
    write_object(2, SDO_OBJECT(0x1006, 0), 4, 2000);
    TEST_ASSERT_FALSE(virtual_drives_follow_sync(&outside));
    write_object(3, SDO_OBJECT(0x1006, 0), 4, 2000);
    TEST_ASSERT_TRUE(virtual_drives_follow_sync(&outside));
    TEST_ASSERT_TRUE(take(0x080, 0, 0, 0));
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == 0);
    TEST_ASSERT_TRUE(take(0x080, 0, 0, 0));
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == 2000000);
    TEST_ASSERT_TRUE(take(0x123, 0, 0, 0));
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == 2000000);
    (void)take(0x000, 2, NMT_RESET_NODE, 2);
    TEST_ASSERT_FALSE(virtual_drives_follow_sync(&outside));
}

/* Drive 1 takes the position that drive 2 reports: its TPDO1 skips a word, then 60C1:01. */
static void test_drives_of_one_process_hear_each_other(void)
{
    uint32_t value;
    drives_config.drive[1].plant.start_mm = 1.25;
    start_outside();
    write_object(1, SDO_OBJECT(0x1602, 0), 1, 0);
    write_object(1, SDO_OBJECT(0x1602, 1), 4, 0x00060010);
    write_object(1, SDO_OBJECT(0x1602, 2), 4, 0x60C10120);
    write_object(1, SDO_OBJECT(0x1602, 0), 1, 2);
    write_object(1, SDO_OBJECT(0x1402, 1), 4, 0x182);
    (void)take(0x000, 2, NMT_START, 0);
    (void)take(0x080, 0, 0, 0);
    TEST_ASSERT_TRUE(
        virtual_drive_read_object(&outside.drive[0], PDO_MAPPED(0x60C1, 1, 32), &value));
    TEST_ASSERT_EQUAL_UINT32(125000, value);
}

static void test_the_clock_knows_when_all_drives_are_enabled_first(void)
{
    start_embedded();
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&embedded)->enabled_ns == INJECT_ALWAYS);
    start_master();
    uint64_t enabled_ns = virtual_drives_get_clock(&embedded)->enabled_ns;
    TEST_ASSERT_TRUE(enabled_ns > 0);
    TEST_ASSERT_TRUE(enabled_ns <= virtual_drives_get_clock(&embedded)->now_ns);
    struct point here = {{0}};
    for (unsigned k = 0; k < 100; k++)
        cycle(&here);
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&embedded)->enabled_ns == enabled_ns);
}

/* Whatever the encoders thought at power-on: after homing, positions are those on the axes. */
static void test_after_homing_the_controller_knows_where_the_axes_are(void)
{
    static const struct {
        double start_mm, home_mm;
        int8_t method;
    } axes[DRIVES] = {{4.7, -12, 17}, {-3.3, 9, 18}, {1.1, 2.5, 20}};
    struct point actual;
    for (unsigned i = 0; i < DRIVES; i++) {
        struct drive_plant_config *plant = &drives_config.drive[i].plant;
        plant->start_mm = axes[i].start_mm;
        plant->absolute_encoder = 0;
        plant->limit_switch_min_mm = -12;
        plant->limit_switch_max_mm = 9;
        plant->home_switch_mm = 2.5;
        master_config.axis[i].homing = (struct drives_homing){.order = (uint8_t)(i + 1),
                                                              .method = axes[i].method,
                                                              .velocity_mm_s = 20,
                                                              .zero_mm_s = 2,
                                                              .acceleration_mm_s2 = 500,
                                                              .offset_mm = axes[i].home_mm,
                                                              .timeout_cycles = 20000};
    }
    start_embedded();
    start_master();
    drives_get_actual(&master, &actual);
    for (unsigned i = 0; i < DRIVES; i++) {
        double true_mm = virtual_drive_get_position_mm(&embedded.drive[i]);
        TEST_ASSERT_TRUE(fabs(true_mm - actual.at[i]) < 0.01);
        TEST_ASSERT_TRUE(fabs(true_mm - axes[i].start_mm) > 0.5);
    }
}

/* Drives outside that take SYNC for their clock, driven to 100 mm/s on X, and then left alone. */
static void leave_alone_in_motion(void)
{
    struct point setpoint = {{0}};
    start_embedded();
    start_master();
    for (unsigned k = 0; k < CYCLES; k++) {
        const double t_s = 0.001 * k;
        setpoint.at[AXIS_X] = t_s < 0.2 ? 250 * t_s * t_s : 10 + 100 * (t_s - 0.2);
        cycle(&setpoint);
    }
    start_outside();
    for (unsigned i = 0; i < told_count; i++)
        (void)virtual_drives_take_by_sync(&outside, &told[i]);
}

#define HEARTBEAT_MS 100
#define PATIENCE_NS  UINT64_C(5000000000)

static void wait_ms(unsigned count)
{
    for (unsigned ms = 0; ms < count; ms++)
        virtual_drives_wait(&outside, CYCLE_NS, PATIENCE_NS);
}

static void expect_time_stands_for(unsigned ms)
{
    const uint64_t before_ns = virtual_drives_get_clock(&outside)->now_ns;
    wait_ms(ms - 1);
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == before_ns);
    (void)take(0x080, 0, 0, 0);
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == before_ns + CYCLE_NS);
}

static void test_time_of_drives_waits_for_a_slow_controller(void)
{
    leave_alone_in_motion();
    expect_time_stands_for(5000);
    expect_time_stands_for(5000);
    virtual_drives_leave(&outside); /* somebody else, it turns out */
    expect_time_stands_for(2 * HEARTBEAT_MS);
    expect_time_stands_for(5000);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&outside.drive[0]));
}

/* Whatever takes SYNC for its clock: the clock goes on when there is nobody any more. */
static void test_axes_of_a_dead_controller_rest_within_three_heartbeats(void)
{
    double before_mm, after_mm;
    leave_alone_in_motion();
    virtual_drives_leave(&outside);
    wait_ms(3 * HEARTBEAT_MS);
    before_mm = virtual_drive_get_position_mm(&outside.drive[0]);
    for (unsigned i = 0; i < DRIVES; i++)
        TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED,
                              virtual_drive_get_state(&outside.drive[i]));
    wait_ms(HEARTBEAT_MS);
    after_mm = virtual_drive_get_position_mm(&outside.drive[0]);
    TEST_ASSERT_TRUE(before_mm > 45);
    TEST_ASSERT_TRUE(fabs(after_mm - before_mm) < 0.01); /* below 0.1 mm/s */
}

static void test_axes_of_a_controller_that_hangs_rest_after_its_patience(void)
{
    leave_alone_in_motion();
    wait_ms(5000 + HEARTBEAT_MS);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&outside.drive[0]));
}

/* Nobody enabled, nothing to stop: a controller that boots drives may take its time. */
static void test_time_of_drives_without_torque_waits_as_long_as_it_takes(void)
{
    start_outside();
    for (unsigned node = 1; node <= DRIVES; node++)
        write_object(node, SDO_OBJECT(0x1006, 0), 4, 1000);
    (void)take(0x080, 0, 0, 0);
    virtual_drives_leave(&outside);
    wait_ms(10 * HEARTBEAT_MS);
    TEST_ASSERT_TRUE(virtual_drives_get_clock(&outside)->now_ns == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_drives_behind_a_port_answer_every_sync_as_on_the_embedded_bus);
    RUN_TEST(test_sync_is_the_clock_when_all_drives_have_been_told_its_period);
    RUN_TEST(test_time_of_drives_waits_for_a_slow_controller);
    RUN_TEST(test_axes_of_a_dead_controller_rest_within_three_heartbeats);
    RUN_TEST(test_axes_of_a_controller_that_hangs_rest_after_its_patience);
    RUN_TEST(test_time_of_drives_without_torque_waits_as_long_as_it_takes);
    RUN_TEST(test_drives_of_one_process_hear_each_other);
    RUN_TEST(test_the_clock_knows_when_all_drives_are_enabled_first);
    RUN_TEST(test_after_homing_the_controller_knows_where_the_axes_are);
    return UNITY_END();
}
