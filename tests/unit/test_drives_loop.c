/*
 * The whole loop: master, embedded bus, three virtual drives.
 */
#include "base/fnv.h"
#include "bus/bus.h"
#include "canopen/nmt.h"
#include "drive/drives.h"
#include "drives/virtual_drives.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define DRIVES         3
#define CYCLE_NS       1000000u
#define CYCLE_S        1e-3
#define CYCLES         2000
#define LATENCY_TRIALS 6

static struct bus bus;
static struct virtual_drives set;
static struct drives master;
static struct can_port port;
static bool always_quiet; /* since the start every frame has ended within its cycle */

static uint32_t master_stop_timeout_cycles;

static void init_loop(unsigned count, uint32_t bitrate, double start_mm)
{
    struct virtual_drives_config virtual;
    struct drives_config config = {
        .count = count,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .heartbeat_ms = 100,
        .boot_timeout_cycles = 500,
        .start_timeout_cycles = 1000,
        .answer_timeout_cycles = 2,
        .sdo_timeout_cycles = 20,
        .stop_timeout_cycles = master_stop_timeout_cycles,
        .brake_timeout_cycles = 1000,
    };
    virtual_drives_set_default(&virtual, count);
    for (unsigned i = 0; i < count; i++) {
        virtual.drive[i].plant.start_mm = start_mm;
        config.axis[i] = (struct drives_config_axis){.axis = (enum axis)(AXIS_X + (int)i),
                                                     .node = virtual.drive[i].node,
                                                     .increments_per_mm = 1e5,
                                                     .following_error_max_mm = 1.0};
    }
    TEST_ASSERT_TRUE(bus_init(&bus, bitrate));
    port = bus_attach(&bus, NULL);
    virtual_drives_init(&set, &bus, &virtual);
    takt_drives_init(&master, &config);
}

void setUp(void)
{
    init_loop(DRIVES, 1000000, 0);
}

void tearDown(void)
{
}

/* The first half of a cycle: after it the master knows whether it is running. */
static enum drives_state begin_cycle(void)
{
    takt_drives_receive(&master, &port);
    return drives_get_state(&master);
}

static void end_cycle(const struct point *setpoint)
{
    takt_drives_sync(&master, &port);
    takt_drives_send(&master, &port, setpoint);
    bus_run_until(&bus, bus_now_ns(&bus) + CYCLE_NS);
    always_quiet = always_quiet && bus_is_quiet(&bus);
    virtual_drives_step(&set, CYCLE_NS);
}

static void cycle(const struct point *setpoint)
{
    (void)begin_cycle();
    end_cycle(setpoint);
}

static void start(const struct point *setpoint)
{
    while (begin_cycle() == DRIVES_STARTING)
        end_cycle(setpoint);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&master));
    end_cycle(setpoint);
    always_quiet = true;
}

/*
 * Out by 32 mm and to rest, by the law of the machine: 50,000 mm/s3, 1000 mm/s2, 100 mm/s. Jerk
 * phases of 20 ms, acceleration 80 ms, constant velocity 200 ms.
 */
static double jerk_at(unsigned k)
{
    if (k < 20 || (k >= 420 && k < 440))
        return 50000;
    if ((k >= 100 && k < 120) || (k >= 320 && k < 340))
        return -50000;
    return 0;
}

static void make_ramp(double ramp_mm[CYCLES])
{
    double x = 0, v = 0, a = 0, t = CYCLE_S;
    for (unsigned k = 0; k < CYCLES; k++) {
        double j = jerk_at(k);
        ramp_mm[k] = x;
        x += v * t + a * t * t / 2 + j * t * t * t / 6;
        v += a * t + j * t * t / 2;
        a += j * t;
    }
}

static double set_mm[CYCLES], actual_mm[CYCLES];

/* Runs set_mm on all axes; actual_mm[k]: what X's drive has reported by cycle k. */
static void run_program(void)
{
    struct point setpoint = {{0}}, actual;
    start(&setpoint);
    for (unsigned k = 0; k < CYCLES; k++) {
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, begin_cycle());
        drives_get_actual(&master, &actual);
        actual_mm[k] = actual.at[AXIS_X];
        for (unsigned axis = 0; axis < DRIVES; axis++)
            setpoint.at[axis] = set_mm[k];
        end_cycle(&setpoint);
    }
}

/* Largest |set[k - latency] - actual[k]| for k from first to last. */
static double following_mm(unsigned latency, unsigned first, unsigned last)
{
    double largest_mm = 0;
    for (unsigned k = first; k < last; k++)
        largest_mm = fmax(largest_mm, fabs(set_mm[k - latency] - actual_mm[k]));
    return largest_mm;
}

static void test_drives_are_enabled_within_200_cycles_and_do_not_move(void)
{
    static const struct point nowhere = {{1, 1, 1, 1, 1, 1}};
    struct point here = {{0}}, actual;
    init_loop(DRIVES, 1000000, -7.5);
    unsigned cycles = 0;
    while (begin_cycle() == DRIVES_STARTING && cycles++ < 1000)
        end_cycle(&nowhere);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&master));
    TEST_ASSERT_TRUE(cycles < 200);
    drives_get_actual(&master, &here);
    for (unsigned i = 0; i < 100; i++) {
        end_cycle(&here);
        (void)begin_cycle();
    }
    drives_get_actual(&master, &actual);
    for (unsigned axis = 0; axis < DRIVES; axis++)
        TEST_ASSERT_TRUE(fabs(actual.at[axis] + 7.5) < 2e-5);
}

/* At 100 mm/s a wrong latency shows as 0.1 mm a cycle. */
static void test_the_latency_is_the_one_at_which_report_and_setpoint_agree(void)
{
    make_ramp(set_mm);
    run_program();
    for (unsigned latency = 0; latency < LATENCY_TRIALS; latency++) {
        double error_mm = following_mm(latency, 200, 320);
        double expected_mm = 0.1 * fabs((double)latency - DRIVES_LATENCY_CYCLES);
        TEST_ASSERT_TRUE(fabs(error_mm - expected_mm) < 0.005);
    }
}

static void test_following_error_stays_below_50_micrometres_in_ramps_at_the_machine_limits(void)
{
    make_ramp(set_mm);
    run_program();
    TEST_ASSERT_TRUE(following_mm(DRIVES_LATENCY_CYCLES, 10, CYCLES) < 0.05);
    TEST_ASSERT_TRUE(following_mm(DRIVES_LATENCY_CYCLES, 250, 320) < 0.005);
    TEST_ASSERT_TRUE(following_mm(DRIVES_LATENCY_CYCLES, 1500, CYCLES) < 0.0001);
    TEST_ASSERT_TRUE(fabs(actual_mm[CYCLES - 1] - 32) < 0.0001);
}

static void make_sine(void)
{
    for (unsigned k = 0; k < CYCLES; k++)
        set_mm[k] = 10 * (1 - cos(6.283185307179586 * k / 1000));
}

static void test_a_sine_is_followed(void)
{
    make_sine();
    run_program();
    TEST_ASSERT_TRUE(following_mm(DRIVES_LATENCY_CYCLES, 10, CYCLES) < 0.05);
}

static uint64_t digest_of_run(void)
{
    uint64_t digest = FNV_START;
    make_sine();
    run_program();
    for (unsigned k = 0; k < CYCLES; k++)
        digest = takt_fnv_add_double(digest, actual_mm[k]);
    return digest;
}

static void test_two_runs_report_the_same_positions_bit_for_bit(void)
{
    uint64_t first = digest_of_run();
    setUp();
    uint64_t second = digest_of_run();
    TEST_ASSERT_TRUE(first == second);
    TEST_ASSERT_TRUE(first != FNV_START);
}

static void assert_fits(unsigned count)
{
    struct point setpoint = {{0}};
    struct drives_load predicted;
    TEST_ASSERT_TRUE(
        takt_drives_predict_load(count, &(struct drives_rates){1000000, 0}, 1000, &predicted));
    init_loop(count, 1000000, 0);
    start(&setpoint);
    for (unsigned k = 0; k < CYCLES; k++) {
        for (unsigned axis = 0; axis < count; axis++)
            setpoint.at[axis] = sin(0.001 * k);
        uint64_t before_ns = bus.counts.busy_ns;
        cycle(&setpoint);
        double observed = 100.0 * (double)(bus.counts.busy_ns - before_ns) / CYCLE_NS;
        TEST_ASSERT_TRUE(observed <= predicted.percent);
    }
    TEST_ASSERT_TRUE(always_quiet);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&master));
    TEST_ASSERT_TRUE(bus.counts.refused == 0);
    TEST_ASSERT_TRUE(bus.counts.receive_lost == 0);
}

static void test_one_to_four_axes_fit_into_every_cycle_and_never_load_more_than_predicted(void)
{
    for (unsigned count = 1; count <= 4; count++)
        assert_fits(count);
}

static void test_a_drive_that_trips_stops_the_others_and_names_its_axis(void)
{
    struct point setpoint = {{0}};
    start(&setpoint);
    setpoint.at[AXIS_Y] = 10;
    for (unsigned i = 0; i < 200; i++)
        cycle(&setpoint);
    const struct diagnostic *fault = takt_drives_get_fault(&master);
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&master));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_FAULT, fault->code);
    TEST_ASSERT_EQUAL_INT('Y', fault->word[0]);
    TEST_ASSERT_TRUE(fault->value == 0x8611);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&set.drive[0]));
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, virtual_drive_get_state(&set.drive[1]));
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&set.drive[2]));
}

static void test_a_moving_machine_stops_when_one_node_is_stopped(void)
{
    struct point setpoint = {{0}};
    struct can_frame stop;
    struct can_port stranger = bus_attach(&bus, NULL);
    make_ramp(set_mm);
    start(&setpoint);
    for (unsigned k = 0; k < 250; k++) {
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Z] = set_mm[k];
        cycle(&setpoint);
    }
    takt_nmt_write_command(&stop, NMT_STOP, 2);
    TEST_ASSERT_TRUE(stranger.send(stranger.context, &stop));
    for (unsigned k = 250; k < 450; k++) {
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Z] = set_mm[k];
        cycle(&setpoint);
    }
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_SILENT, takt_drives_get_fault(&master)->code);
    TEST_ASSERT_EQUAL_INT('Y', takt_drives_get_fault(&master)->word[0]);
    for (unsigned i = 0; i < DRIVES; i++)
        TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&set.drive[i]));
    TEST_ASSERT_TRUE(virtual_drive_get_position_mm(&set.drive[0]) < set_mm[250] + 4);
}

/*
 * X and Y move along y = x / 2 at 100 and 50 mm/s when the node of Z is stopped. Setpoints are
 * brought to rest on that line within 0.2 s, as a feed hold does it: slower by 1/200 in every
 * cycle.
 */
static double stop_beside_a_stopped_node(uint32_t stop_timeout_cycles)
{
    struct point setpoint = {{0}};
    struct can_frame stop;
    double off_mm = 0;
    master_stop_timeout_cycles = stop_timeout_cycles;
    init_loop(DRIVES, 1000000, 0);
    struct can_port stranger = bus_attach(&bus, NULL);
    start(&setpoint);
    takt_nmt_write_command(&stop, NMT_STOP, 3);
    for (unsigned k = 0, slow = 0; k < 2000; k++) {
        if (k == 300) {
            TEST_ASSERT_TRUE(stranger.send(stranger.context, &stop));
        }
        if (slow < 200 && drives_get_state(&master) > DRIVES_ENABLED)
            slow++;
        double step_mm = 0.1 * fmin(k / 200.0, 1) * (1 - slow / 200.0);
        setpoint.at[AXIS_X] += step_mm;
        setpoint.at[AXIS_Y] += step_mm / 2;
        cycle(&setpoint);
        double x_mm = virtual_drive_get_position_mm(&set.drive[0]);
        double y_mm = virtual_drive_get_position_mm(&set.drive[1]);
        off_mm = fmax(off_mm, fabs(y_mm - x_mm / 2));
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&master));
    TEST_ASSERT_EQUAL_INT('Z', takt_drives_get_fault(&master)->word[0]);
    for (unsigned i = 0; i < DRIVES; i++)
        TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&set.drive[i]));
    return off_mm;
}

static void test_axes_stay_on_the_path_when_setpoints_are_brought_to_rest_after_a_fault(void)
{
    TEST_ASSERT_TRUE(stop_beside_a_stopped_node(1000) < 0.01);
    TEST_ASSERT_TRUE(stop_beside_a_stopped_node(0) > 0.1); /* each brakes for itself */
    master_stop_timeout_cycles = 0;
}

static void test_a_bus_too_slow_for_the_cycle_does_not_go_unnoticed(void)
{
    static const struct point nowhere = {{0}};
    init_loop(DRIVES, 125000, 0);
    for (unsigned i = 0; i < 3000; i++)
        cycle(&nowhere);
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&master));
}

/* A power of two: setpoints are increments but for an exponent. */
static void test_targets_are_the_nearest_increments_and_halves_go_away_from_zero(void)
{
    static const struct {
        double increments;
        int32_t target;
    } rows[] = {{0.5, 1},
                {0.5 - 0x1p-54, 0},
                {0.5 + 0x1p-53, 1},
                {1.5 - 0x1p-52, 1},
                {1.5, 2},
                {2.5, 3},
                {1e5 + 0.5, 100001},
                {1e5 + 0.4999, 100000},
                {0x1p30 + 0.5, (1 << 30) + 1},
                {0.0, 0},
                {INT32_MAX + 0.49, INT32_MAX}};
    struct point here = {{0}};
    start(&here);
    for (unsigned i = 0; i < DRIVES; i++)
        master.axis[i].config.increments_per_mm = 0x1p17;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        here.at[AXIS_X] = rows[i].increments / 0x1p17;
        here.at[AXIS_Y] = -here.at[AXIS_X];
        takt_drives_send(&master, &port, &here);
        TEST_ASSERT_EQUAL_INT32(rows[i].target, master.axis[0].target_inc);
        TEST_ASSERT_EQUAL_INT32(-rows[i].target, master.axis[1].target_inc);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_drives_are_enabled_within_200_cycles_and_do_not_move);
    RUN_TEST(test_the_latency_is_the_one_at_which_report_and_setpoint_agree);
    RUN_TEST(test_following_error_stays_below_50_micrometres_in_ramps_at_the_machine_limits);
    RUN_TEST(test_a_sine_is_followed);
    RUN_TEST(test_two_runs_report_the_same_positions_bit_for_bit);
    RUN_TEST(test_one_to_four_axes_fit_into_every_cycle_and_never_load_more_than_predicted);
    RUN_TEST(test_a_drive_that_trips_stops_the_others_and_names_its_axis);
    RUN_TEST(test_a_moving_machine_stops_when_one_node_is_stopped);
    RUN_TEST(test_axes_stay_on_the_path_when_setpoints_are_brought_to_rest_after_a_fault);
    RUN_TEST(test_a_bus_too_slow_for_the_cycle_does_not_go_unnoticed);
    RUN_TEST(test_targets_are_the_nearest_increments_and_halves_go_away_from_zero);
    return UNITY_END();
}
