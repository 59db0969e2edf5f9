/*
 * The drive's own table of its screw's error of pitch, and its backlash: objects 2010 and 2011.
 * 1000 increments/mm, a cycle of 1 ms.
 */
#define _POSIX_C_SOURCE 200809L

#include "drives/drive_store.h"
#include "lone_drive.h"
#include "servo/compensation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define CSP 8
#define HM  6

#define SAVE 0x65766173u
#define LOAD 0x64616F6Cu

#define PITCH_IN_FORCE 0x10u

#define POINTS      61
#define FIRST_MM    (-90)
#define DISTANCE_MM 3

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
}

void tearDown(void)
{
}

/* A screw that is wrong by 10 um. */
static void set_pitch_error(void)
{
    lone.config.plant.pitch_error_mm = 0.010;
    lone.config.plant.pitch_error_period_mm = 60;
}

static double error_of_screw_mm(double motor_mm)
{
    return 0.010 * sin(2 * 3.14159265358979 * motor_mm / 60);
}

static void write(unsigned index, unsigned sub, unsigned bytes, int32_t value)
{
    TEST_ASSERT_EQUAL_HEX32(
        0, lone_write(&lone, (uint16_t)index, (uint8_t)sub, bytes, (uint32_t)value));
}

/* As it would be measured; sign: of the drive's positions to the motor's. */
static void write_table(double sign)
{
    write(0x2010, 1, 1, 0);
    write(0x2010, 2, 4, FIRST_MM * 1000);
    write(0x2010, 3, 4, DISTANCE_MM * 1000);
    for (int i = 0; i < POINTS; i++) {
        double motor_mm = sign * (FIRST_MM + DISTANCE_MM * i);
        write(0x2011, (unsigned)i + 1, 4,
              (int32_t)lround(sign * 1e6 * error_of_screw_mm(motor_mm)));
    }
    write(0x2010, 1, 1, POINTS);
}

static void go(double target_mm, unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        lone_take(&lone, 0x300 + LONE_NODE, 4, (uint32_t)lround(target_mm * 1000), 0);
        lone_sync(&lone);
        lone_step(&lone, 1);
    }
}

/* At 50 mm/s, then it stands. */
static void travel(double from_mm, double to_mm)
{
    unsigned cycles = (unsigned)(fabs(to_mm - from_mm) / 0.05);
    for (unsigned i = 1; i <= cycles; i++)
        go(from_mm + (to_mm - from_mm) * i / cycles, 1);
    go(to_mm, 300);
}

/* How far the axis is off at most, where it stands; sign: of what the drive says. */
static double worst_um(double sign)
{
    double worst_mm = 0, at_mm = 0;
    lone_enable(&lone, CSP);
    for (unsigned i = 0; i < 20; i++) {
        double next_mm = fmod(i * 37.0, 141) - 70 + 0.7 * i / 20;
        next_mm = round(next_mm * 1000) / 1000;
        travel(at_mm, next_mm);
        at_mm = next_mm;
        worst_mm = fmax(worst_mm, fabs(virtual_drive_get_position_mm(&lone.drive) - sign * at_mm));
        TEST_ASSERT_INT_WITHIN(1, lround(at_mm * 1000), lone_actual(&lone));
    }
    return 1000 * worst_mm;
}

static void test_its_own_table_removes_the_error_of_its_screw(void)
{
    set_pitch_error();
    lone_start(&lone);
    double before_um = worst_um(1);
    lone_start(&lone);
    write_table(1);
    double after_um = worst_um(1);
    (void)printf("error of pitch: %.3f um, with the drive's own table %.3f um\n", before_um,
                 after_um);
    TEST_ASSERT_TRUE(before_um > 9);
    TEST_ASSERT_TRUE(after_um < 0.05);
}

static void test_the_same_where_the_motor_turns_the_other_way(void)
{
    set_pitch_error();
    lone.config.increments_per_mm = -1000;
    lone_start(&lone);
    write_table(-1);
    TEST_ASSERT_TRUE(worst_um(-1) < 0.05);
}

static void test_it_counts_once_the_axis_is_homed_and_home_is_where_it_is_said_to_be(void)
{
    set_pitch_error();
    lone.config.plant.absolute_encoder = 0;
    lone.config.plant.start_mm = 7;
    lone.config.plant.home_switch_mm = 12;
    lone_start(&lone);
    write_table(1);
    write(0x6098, 0, 1, 19);
    write(0x607C, 0, 4, -12 * 1000);
    TEST_ASSERT_EQUAL_HEX32(0, lone_read(&lone, 0x1002, 0) & PITCH_IN_FORCE);
    lone_enable(&lone, HM);
    lone_control(&lone, 0x1F, HM);
    lone_step(&lone, 20000);
    TEST_ASSERT_EQUAL_HEX32(PITCH_IN_FORCE, lone_read(&lone, 0x1002, 0) & PITCH_IN_FORCE);
    lone_control(&lone, 0xF, CSP);
    for (int i = -5; i <= 5; i++) {
        double at_mm = 12 * i;
        travel(lone_actual(&lone) / 1000.0, at_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, at_mm, virtual_drive_get_position_mm(&lone.drive));
    }
}

static void test_it_is_written_in_pre_operational_while_the_number_of_points_is_0(void)
{
    lone_start(&lone);
    write(0x2010, 1, 1, 0);
    write(0x2011, 1, 4, 1000);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_VALUE, lone_write(&lone, 0x2010, 1, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_HIGH, lone_write(&lone, 0x2010, 1, 1, 65));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_LOW, lone_write(&lone, 0x2010, 3, 4, 0));
    /* 1 um in 1 um */
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_VALUE, lone_write(&lone, 0x2010, 1, 1, 2));
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x2010, 1));
    write(0x2010, 3, 4, 1000);
    write(0x2010, 1, 1, 2);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, lone_write(&lone, 0x2010, 2, 4, 5));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, lone_write(&lone, 0x2010, 3, 4, 5));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, lone_write(&lone, 0x2011, 64, 4, 5));
    write(0x2010, 4, 4, 20000);
    lone_nmt(&lone, NMT_START);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, lone_write(&lone, 0x2010, 1, 1, 0));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, lone_write(&lone, 0x2010, 4, 4, 0));
    lone_nmt(&lone, NMT_ENTER_PREOPERATIONAL);
    write(0x2010, 1, 1, 0);
    TEST_ASSERT_EQUAL_INT(0, lone_actual(&lone));
}

/* ---- What is stored ---- */

static void reset_node(void)
{
    lone_nmt(&lone, NMT_RESET_NODE);
    lone_step(&lone, 5);
}

static void assert_corrected(bool is)
{
    TEST_ASSERT_EQUAL_UINT32(is ? POINTS : 0, lone_read(&lone, 0x2010, 1));
    TEST_ASSERT_EQUAL_INT(is ? 10000 : 0, (int32_t)lone_read(&lone, 0x2011, 36));
    TEST_ASSERT_EQUAL_HEX32(is ? PITCH_IN_FORCE : 0, lone_read(&lone, 0x1002, 0) & PITCH_IN_FORCE);
    TEST_ASSERT_EQUAL_INT(is ? 15010 : 15000, lone_actual(&lone));
}

static void start_at_15_mm(void)
{
    set_pitch_error();
    lone.config.plant.start_mm = 15;
    lone_start(&lone);
}

static void test_it_is_kept_by_1010_and_gone_after_1011(void)
{
    start_at_15_mm();
    write_table(1);
    assert_corrected(true);
    reset_node();
    assert_corrected(false);
    write_table(1);
    write(0x1010, 1, 4, (int32_t)SAVE);
    write(0x2010, 1, 1, 0);
    reset_node();
    assert_corrected(true);
    write(0x1011, 1, 4, LOAD);
    assert_corrected(true);
    reset_node();
    assert_corrected(false);
}

static void store_and_start_with(const char *more)
{
    struct drive_store_problem wrong;
    char *text, all[8192];
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    TEST_ASSERT_NOT_NULL(stream);
    drive_store_write(stream, &lone.drive.servo);
    TEST_ASSERT_EQUAL_INT(0, fclose(stream));
    int size = snprintf(all, sizeof all, "%s%s", text, more);
    free(text);
    lone_start(&lone);
    TEST_ASSERT_TRUE(drive_store_read(&lone.drive.servo, all, (size_t)size, &wrong));
}

static void test_it_is_there_at_the_next_power_on(void)
{
    start_at_15_mm();
    write_table(1);
    write(0x1010, 1, 4, (int32_t)SAVE);
    store_and_start_with("");
    assert_corrected(true);
}

static void test_values_of_another_hand_that_are_too_steep_are_none(void)
{
    start_at_15_mm();
    write_table(1);
    write(0x1010, 1, 4, (int32_t)SAVE);
    store_and_start_with("2011:05 00ffffff\n");
    TEST_ASSERT_EQUAL_HEX32(0, lone_read(&lone, 0x1002, 0) & PITCH_IN_FORCE);
    TEST_ASSERT_EQUAL_INT(15000, lone_actual(&lone));
}

/* ---- Backlash ---- */

/*
 * Where the axis stands after moves to and fro, on which drives do not overshoot: what they
 * overshoot by, the play keeps.
 */
static double worst_reversal_um(int32_t backlash_nm)
{
    double worst_mm = 0, at_mm = 0;
    lone.config.plant.backlash_mm = 0.020;
    lone.config.plant.velocity_feed_forward_ratio = 0;
    lone.config.plant.velocity_integral_time_s = 0;
    lone.config.plant.viscous_friction_nm_s_per_rad = 0;
    lone_start(&lone);
    write(0x2010, 4, 4, backlash_nm);
    lone_enable(&lone, CSP);
    for (int i = 0; i < 12; i++) {
        double next_mm = i % 2 ? -0.5 * i : 3 + i;
        travel(at_mm, next_mm);
        at_mm = next_mm;
        worst_mm = fmax(worst_mm, fabs(virtual_drive_get_position_mm(&lone.drive) - at_mm));
        TEST_ASSERT_INT_WITHIN(1, lround(at_mm * 1000), lone_actual(&lone));
    }
    return 1000 * worst_mm;
}

static void test_backlash_is_taken_back_at_reversals(void)
{
    double before_um = worst_reversal_um(0);
    double after_um = worst_reversal_um(20000);
    (void)printf("backlash: %.3f um, taken back %.3f um\n", before_um, after_um);
    TEST_ASSERT_TRUE(before_um > 9.9);
    TEST_ASSERT_TRUE(after_um < 0.05);
}

/* Told a torque the axis is where its motor goes: a play that fades is no way back. */
static void test_a_torque_turns_it_back_once(void)
{
    unsigned turns = 0;
    lone.config.plant.coulomb_friction_nm = 0.1;
    lone_start(&lone);
    write(0x2010, 4, 4, 50000);
    lone_enable(&lone, 10);
    for (unsigned i = 0; i < 400; i++) {
        const struct compensation *c = &lone.drive.servo.compensation;
        double before = c->direction;
        lone_take(&lone, 0x600 + LONE_NODE, 8, 0x0060712B, i < 100 ? 150 : 0xFFFF & -150);
        lone_step(&lone, 1);
        turns += c->direction != before;
    }
    TEST_ASSERT_EQUAL_UINT(2, turns);
    TEST_ASSERT_TRUE(lone.drive.servo.compensation.direction == -1);
}

static double stands(void *context, double torque_mm_s2, double step_s)
{
    (void)torque_mm_s2;
    (void)step_s;
    return *(const double *)context;
}

static void look(void *context, uint32_t cycle_ns, struct motor_sense *sense)
{
    (void)cycle_ns;
    memset(sense, 0, sizeof *sense);
    sense->encoder_mm = *(const double *)context;
}

#define STEP_S       0.00025
#define ACCELERATION 500.0

/*
 * Reversals at any time: the motor, which follows, has no step of velocity, and no more
 * acceleration than it may.
 */
static void test_a_reversal_is_without_a_step_of_velocity_or_acceleration(void)
{
    struct compensation c;
    double encoder_mm = 1, x[4] = {1, 1, 1, 1}, most_mm_s2 = 0, most_change_mm_s2 = 0;
    const struct motor_port motor = {.turn = stands, .sense = look, .context = &encoder_mm};
    const struct compensation_way told = {0.01, 0.001, ACCELERATION, STEP_S};
    uint32_t seed = 1;
    takt_compensation_init(&c, &motor);
    takt_compensation_set_backlash(&c, 0.03);
    struct motor_port port = takt_compensation_get_port(&c);
    for (unsigned i = 0; i < 400000; i++) {
        struct compensation_way way = told;
        seed = seed * 1664525 + 1013904223;
        way.way_mm *= seed >> 24 < 2 ? -1 : seed >> 24 < 4 ? 1 : 0;
        if (i % 4 == 0)
            takt_compensation_follow(&c, &way);
        memmove(x, x + 1, sizeof x - sizeof x[0]);
        x[3] = port.turn(port.context, 0, STEP_S);
        TEST_ASSERT_TRUE(fabs(x[3] - 1) <= 0.015 * 1.0001);
        double bend = (x[3] - 2 * x[2] + x[1]) / (STEP_S * STEP_S);
        double before = (x[2] - 2 * x[1] + x[0]) / (STEP_S * STEP_S);
        most_mm_s2 = fmax(most_mm_s2, fabs(bend));
        most_change_mm_s2 = fmax(most_change_mm_s2, fabs(bend - before));
    }
    (void)printf("%.1f mm/s2 of %.0f, changes in a step by %.1f\n", most_mm_s2, ACCELERATION,
                 most_change_mm_s2);
    TEST_ASSERT_TRUE(most_mm_s2 <= ACCELERATION && most_mm_s2 > ACCELERATION / 2);
    TEST_ASSERT_TRUE(most_change_mm_s2 <= takt_fade_jerk_per_s3(&c.pace) * 0.03 * STEP_S);
}

static void test_without_a_table_or_backlash_the_motor_is_the_axis_to_the_last_bit(void)
{
    struct compensation c;
    struct motor_sense sense;
    double encoder_mm = 0;
    const struct motor_port motor = {.turn = stands, .sense = look, .context = &encoder_mm};
    takt_compensation_init(&c, &motor);
    c.is_homed = true;
    c.origin_mm = 0.1;
    struct motor_port port = takt_compensation_get_port(&c);
    for (int i = -1000; i < 1000; i++) {
        const struct compensation_way way = {i, 0.001, ACCELERATION, STEP_S};
        encoder_mm = i / 3.0;
        takt_compensation_follow(&c, &way);
        TEST_ASSERT_TRUE(port.turn(port.context, 0, STEP_S) == encoder_mm);
        port.sense(port.context, 0, &sense);
        TEST_ASSERT_TRUE(sense.encoder_mm == encoder_mm);
    }
}

/*
 * Less than an increment is no reversal: what a target's last digit does is not what the axis does.
 */
static void test_a_way_back_of_less_than_the_resolution_is_none(void)
{
    struct compensation c;
    takt_compensation_init(&c, NULL);
    takt_compensation_set_backlash(&c, 0.02);
    for (int i = 0; i < 100; i++) {
        const struct compensation_way way = {i % 2 ? -0.0009 : 0.001, 0.001, ACCELERATION, STEP_S};
        takt_compensation_follow(&c, &way);
        TEST_ASSERT_TRUE(i < 20 || c.direction == 1);
    }
    const struct compensation_way back = {-0.0011, 0.001, ACCELERATION, STEP_S};
    takt_compensation_follow(&c, &back);
    TEST_ASSERT_TRUE(c.direction == -1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_its_own_table_removes_the_error_of_its_screw);
    RUN_TEST(test_the_same_where_the_motor_turns_the_other_way);
    RUN_TEST(test_it_counts_once_the_axis_is_homed_and_home_is_where_it_is_said_to_be);
    RUN_TEST(test_it_is_written_in_pre_operational_while_the_number_of_points_is_0);
    RUN_TEST(test_it_is_kept_by_1010_and_gone_after_1011);
    RUN_TEST(test_it_is_there_at_the_next_power_on);
    RUN_TEST(test_values_of_another_hand_that_are_too_steep_are_none);
    RUN_TEST(test_backlash_is_taken_back_at_reversals);
    RUN_TEST(test_a_torque_turns_it_back_once);
    RUN_TEST(test_a_reversal_is_without_a_step_of_velocity_or_acceleration);
    RUN_TEST(test_without_a_table_or_backlash_the_motor_is_the_axis_to_the_last_bit);
    RUN_TEST(test_a_way_back_of_less_than_the_resolution_is_none);
    return UNITY_END();
}
