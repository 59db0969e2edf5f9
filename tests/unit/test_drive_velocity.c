/*
 * Drives without a mode of position: what they are told at the start, and the position loop that
 * the master closes.
 */
#include "starting_master.h"

#include "base/maths.h"

#define SCALE 1000.0

static void let_modes_be(uint32_t modes)
{
    target_of_3 = 0;
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6502, 0), .value = modes});
}

static void test_the_best_mode_that_a_drive_has_is_taken(void)
{
    static const struct {
        uint32_t modes;
        uint8_t mode;
    } rows[] = {{0x3FF, 8}, {0x37F, 7}, {0x33F, 9}, {0x23F, 3}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        let_modes_be(rows[i].modes);
        shown_bits[1] = shown_bits[2] = shown_bits[3] = CIA402_INTERPOLATES;
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        TEST_ASSERT_EQUAL_UINT(rows[i].mode, nodes.mode[2]);
    }
}

static void test_the_target_is_a_velocity_in_the_frame_of_its_pair(void)
{
    let_modes_be(0x120);
    run_start();
    assert_told(1, SDO_OBJECT(0x1601, 1), 0x60FF0020);
    assert_told(2, SDO_OBJECT(0x1601, 2), 0x60FF0020);
    TEST_ASSERT_EQUAL_HEX32(1U << DRIVES_NO_POSITION, takt_drives_get_given_up(&drives, AXIS_Y));
}

static void test_ramps_of_profile_velocity_are_twice_those_of_setpoints(void)
{
    let_modes_be(0x24);
    config.axis[1].max_acceleration_mm_s2 = 250;
    config.axis[1].velocity_units_per_mm_s = 6;
    run_start();
    assert_told(2, SDO_OBJECT(0x6083, 0), 3000);
    assert_told(2, SDO_OBJECT(0x6084, 0), 3000);
}

static void test_cyclic_velocity_has_no_ramps(void)
{
    let_modes_be(0x120);
    run_start();
    TEST_ASSERT_NULL(fake_nodes_told(&nodes, 1, SDO_OBJECT(0x6083, 0)));
}

static void test_ramps_that_a_drive_keeps_are_given_up_or_too_slow(void)
{
    static const struct {
        uint32_t ramp;
        bool is_enough;
    } rows[] = {{250000, true}, {249999, false}};
    for (unsigned i = 0; i < 2; i++) {
        setUp();
        let_modes_be(0x24);
        config.axis[0].max_acceleration_mm_s2 = 250;
        set_rule((struct fake_rule){.node = 1,
                                    .object = SDO_OBJECT(0x6084, 0),
                                    .value = rows[i].ramp,
                                    .write_code = SDO_ABORT_READ_ONLY});
        run_start();
        TEST_ASSERT_EQUAL(rows[i].is_enough, drives_get_state(&drives) == DRIVES_ENABLED);
        TEST_ASSERT_EQUAL(rows[i].is_enough,
                          takt_drives_get_fault(&drives)->code != TAKT_ERROR_DRIVE_REFUSES);
        TEST_ASSERT_EQUAL(rows[i].is_enough,
                          takt_drives_get_given_up(&drives, AXIS_X) >> DRIVES_NO_RAMPS & 1);
    }
}

static void test_a_drive_that_would_go_on_without_a_controller_is_refused(void)
{
    let_modes_be(0x120);
    set_rule((struct fake_rule){
        .node = 2, .object = SDO_OBJECT(0x1016, 1), .abort_code = SDO_ABORT_NO_OBJECT});
    run_start();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_UNWATCHED, takt_drives_get_fault(&drives)->code);
    assert_text("the drive of axis Y (node 2), object 1016:01, follows velocities, and would go on "
                "if the controller fell silent");
}

static void test_a_drive_that_stays_is_told_no_velocity(void)
{
    let_modes_be(0x120);
    shown_inc = 5000;
    takt_drives_init(&drives, &config);
    do {
        TEST_ASSERT_EQUAL_INT32(0, target_of_3);
        cycle();
    } while (drives_get_state(&drives) == DRIVES_STARTING);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/* ---- The loop ---- */

static double position_mm, velocity_mm_s,
    coming_mm_s; /* of an ideal drive: the velocity of the last frame from SYNC on */
static struct point setpoint;

static void run_cycle(double scale)
{
    position_mm += velocity_mm_s * 1e-3;
    velocity_mm_s = coming_mm_s;
    shown_inc = (int32_t)takt_maths_round(position_mm * SCALE);
    put_statuses();
    takt_drives_receive(&drives, &port);
    takt_drives_sync(&drives, &port);
    takt_drives_send(&drives, &port, &setpoint);
    coming_mm_s = target_of_3 / scale;
    cycles_run++;
}

static void start_loop(double gain_per_s)
{
    let_modes_be(0x120);
    config.position_gain_per_s = gain_per_s;
    config.axis[0].following_error_max_mm = config.axis[1].following_error_max_mm = 0;
    position_mm = velocity_mm_s = coming_mm_s = 0;
    setpoint = (struct point){{0}};
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/*
 * The setpoints of a smooth move are followed by their velocity alone: nothing lags but what is
 * rounded.
 */
static void test_velocities_of_setpoints_lead_to_the_setpoints(void)
{
    start_loop(100);
    for (unsigned k = 0; k < 400; k++) {
        const double u = k < 300 ? k / 300.0 : 1;
        setpoint.at[AXIS_Z] = 10 * u * u * (3 - 2 * u);
        run_cycle(SCALE);
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 10, position_mm);
}

/* At the gain of controller_drives.c for a drive without a delay of its own, 1 / (4 * 2.5 ms). */
static void test_a_lag_dies_away_without_overshoot(void)
{
    double least_mm = 1;
    start_loop(100);
    position_mm = -0.4;
    for (unsigned k = 0; k < 200; k++) {
        run_cycle(SCALE);
        TEST_ASSERT_TRUE(position_mm < 0.002);
        least_mm = position_mm;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 0, least_mm);
}

static void test_units_and_the_sense_of_the_motor_are_those_of_the_drive(void)
{
    config.axis[2].increments_per_mm = -SCALE;
    config.axis[2].velocity_units_per_mm_s = 60;
    start_loop(0);
    for (unsigned k = 1; k <= 3; k++) {
        setpoint.at[AXIS_Z] = 0.05 * k;
        run_cycle(-60);
    }
    TEST_ASSERT_EQUAL_INT32(-3000, target_of_3);
}

static void test_a_velocity_beyond_32_bits_is_a_fault(void)
{
    config.axis[2].velocity_units_per_mm_s = 1e9;
    start_loop(0);
    setpoint.at[AXIS_Z] = 0.1;
    run_cycle(1e9);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_RANGE, takt_drives_get_fault(&drives)->code);
}

/* ---- A gantry ---- */

/* The ideal drive is the second of the axis Y; the first one stands at 0. */
static void run_gantry_cycle(void)
{
    position_mm += velocity_mm_s * 1e-3;
    velocity_mm_s = coming_mm_s;
    put_statuses();
    if (nodes.starts[3] > 0) { /* its status is the last one */
        struct can_frame *frame = &nodes.pending[(nodes.pending_count - 1) % FAKE_NODES_PENDING];
        const double inc = takt_maths_round(position_mm * SCALE);
        little_endian_write32(frame->data + 2, (uint32_t)(int32_t)inc);
    }
    takt_drives_receive(&drives, &port);
    takt_drives_sync(&drives, &port);
    takt_drives_send(&drives, &port, &setpoint);
    coming_mm_s = target_of_3 / SCALE;
    cycles_run++;
}

static void begin_gantry(double second_mm)
{
    let_modes_be(0x120);
    config.position_gain_per_s = 100;
    config.axis[2].axis = AXIS_Y;
    config.axis[2].homing.zero_mm_s = 2;
    config.axis[2].homing.acceleration_mm_s2 = 500;
    config.gantry_count = 1;
    config.gantry[0] = (struct drives_gantry){1, 2, 0.5};
    position_mm = second_mm;
    velocity_mm_s = coming_mm_s = 0;
    setpoint = (struct point){{0}};
    takt_drives_init(&drives, &config);
}

static void test_the_second_drive_of_a_gantry_has_come_to_the_first_before_they_are_enabled(void)
{
    double fastest_mm_s = 0;
    begin_gantry(-0.4);
    while (drives_get_state(&drives) == DRIVES_STARTING && cycles_run < 2 * START_CYCLES) {
        run_gantry_cycle();
        fastest_mm_s = maths_max(fastest_mm_s, maths_abs(velocity_mm_s));
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0, position_mm);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2, fastest_mm_s); /* that of homing, and what is rounded */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_best_mode_that_a_drive_has_is_taken);
    RUN_TEST(test_the_target_is_a_velocity_in_the_frame_of_its_pair);
    RUN_TEST(test_ramps_of_profile_velocity_are_twice_those_of_setpoints);
    RUN_TEST(test_cyclic_velocity_has_no_ramps);
    RUN_TEST(test_ramps_that_a_drive_keeps_are_given_up_or_too_slow);
    RUN_TEST(test_a_drive_that_would_go_on_without_a_controller_is_refused);
    RUN_TEST(test_a_drive_that_stays_is_told_no_velocity);
    RUN_TEST(test_velocities_of_setpoints_lead_to_the_setpoints);
    RUN_TEST(test_a_lag_dies_away_without_overshoot);
    RUN_TEST(test_units_and_the_sense_of_the_motor_are_those_of_the_drive);
    RUN_TEST(test_a_velocity_beyond_32_bits_is_a_fault);
    RUN_TEST(test_the_second_drive_of_a_gantry_has_come_to_the_first_before_they_are_enabled);
    return UNITY_END();
}
