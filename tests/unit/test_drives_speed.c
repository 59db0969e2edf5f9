/*
 * Modes of velocity and torque, limits of profiles, and polarity. 1000 increments/mm, 10 mm a turn,
 * a cycle of 1 ms.
 */
#include "lone_drive.h"

#include <math.h>

#define PP  1
#define PV  3
#define PT  4
#define CSP 8
#define CSV 9
#define CST 10

#define ENABLE 0x000F
#define NEW    0x0010
#define HALT   0x0100

#define REACHED 0x0400
#define LIMITED 0x0800
#define BIT_12  0x1000

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone.config.plant.viscous_friction_nm_s_per_rad = 0;
    lone_start(&lone);
}

void tearDown(void)
{
}

static void set(uint16_t index, unsigned bytes, int32_t value)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, index, 0, bytes, (uint32_t)value));
}

static int32_t get(uint16_t index)
{
    return (int32_t)lone_read(&lone, index, 0);
}

static double velocity_mm_s(void)
{
    return lone.drive.plant.velocity_mm_s;
}

static double acceleration_mm_s2(void)
{
    double before = velocity_mm_s();
    lone_step(&lone, 1);
    return (velocity_mm_s() - before) / 1e-3;
}

/* ---- Velocity ---- */

/* 500 mm/s2 up, 1000 mm/s2 down: 80 mm/s after 0.16 s, the other way 0.08 + 0.16 s later. */
static void test_profile_velocity_goes_to_60FF_by_its_ramps(void)
{
    set(0x6084, 4, 1000000);
    lone_enable(&lone, PV);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & BIT_12); /* it stands */
    set(0x60FF, 4, 80000);
    lone_step(&lone, 80);
    TEST_ASSERT_INT_WITHIN(100, 40000, get(0x606B));
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 40) < 1.5);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & (REACHED | BIT_12));
    lone_step(&lone, 180);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 80) < 0.1);
    TEST_ASSERT_INT_WITHIN(200, 80000, get(0x606C));
    TEST_ASSERT_TRUE(lone_statusword(&lone) & REACHED);
    set(0x60FF, 4, -80000);
    lone_step(&lone, 80);
    TEST_ASSERT_INT_WITHIN(100, 0, get(0x606B));
    lone_step(&lone, 160);
    TEST_ASSERT_INT_WITHIN(100, -80000, get(0x606B));
}

static void test_halt_brings_profile_velocity_to_rest_and_lets_it_go_on(void)
{
    lone_enable(&lone, PV);
    set(0x60FF, 4, 50000);
    lone_step(&lone, 300);
    lone_control(&lone, ENABLE | HALT, PV);
    lone_step(&lone, 300);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s()) < 0.01);
    TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, lone_statusword(&lone) & (REACHED | BIT_12));
    lone_control(&lone, ENABLE, PV);
    lone_step(&lone, 300);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 50) < 0.1);
}

static void test_velocities_are_limited_by_607F_and_6080_and_that_is_told(void)
{
    set(0x607F, 4, 30000);
    lone_enable(&lone, PV);
    set(0x60FF, 4, 90000);
    lone_step(&lone, 500);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 30) < 0.1);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & LIMITED);
    set(0x6080, 4, 120); /* 20 mm/s */
    lone_step(&lone, 500);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 20) < 0.1);
    lone_control(&lone, ENABLE, CSV);
    lone_step(&lone, 500);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 20) < 0.1);
}

static void test_cyclic_velocity_is_that_of_60FF_and_60B1_at_once(void)
{
    lone_enable(&lone, CSV);
    set(0x60FF, 4, 2000);
    set(0x60B1, 4, 500);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_INT(2000, get(0x606B));
    lone_step(&lone, 99);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() - 2.5) < 0.05);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & BIT_12); /* it follows */
    TEST_ASSERT_EQUAL_INT(0, get(0x60F4));
}

/* What a jammed axis did not go it does not make up for. */
static void test_a_velocity_loop_remembers_no_way(void)
{
    lone_enable(&lone, CSV);
    set(0x60FF, 4, 20000);
    lone.drive.plant.damage.is_jammed = true;
    lone_step(&lone, 500);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    lone.drive.plant.damage.is_jammed = false;
    double before_mm = lone.drive.plant.position_mm;
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(fabs(lone.drive.plant.position_mm - before_mm - 20) < 0.5);
}

/* ---- Torque ---- */

/* a = h M / J: 10/2pi mm of 1.27 Nm on 3e-4 kg m2 are 6737.5 mm/s2; 10 % of that. */
static void test_cyclic_torque_accelerates_by_6071_and_60B2(void)
{
    lone_enable(&lone, CST);
    set(0x6071, 2, 80);
    set(0x60B2, 2, 20);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(fabs(acceleration_mm_s2() - 673.75) < 0.01);
    TEST_ASSERT_EQUAL_INT(100, (int16_t)get(0x6074));
    TEST_ASSERT_EQUAL_INT(100, (int16_t)get(0x6077));
    set(0x6071, 2, -80);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(fabs(acceleration_mm_s2() + 404.25) < 0.01);
}

static void test_profile_torque_rises_by_6087_and_halt_takes_it_away(void)
{
    set(0x6087, 4, 1000); /* 100 % a second */
    lone_enable(&lone, PT);
    set(0x6071, 2, 50);
    lone_step(&lone, 25);
    TEST_ASSERT_EQUAL_INT(25, (int16_t)get(0x6074));
    TEST_ASSERT_FALSE(lone_statusword(&lone) & REACHED);
    lone_step(&lone, 30);
    TEST_ASSERT_EQUAL_INT(50, (int16_t)get(0x6074));
    TEST_ASSERT_TRUE(lone_statusword(&lone) & REACHED);
    lone_control(&lone, ENABLE | HALT, PT);
    lone_step(&lone, 60);
    TEST_ASSERT_EQUAL_INT(0, (int16_t)get(0x6074));
    TEST_ASSERT_TRUE(fabs(acceleration_mm_s2()) < 0.01);
}

static void test_6072_limits_the_torque_in_every_mode(void)
{
    TEST_ASSERT_EQUAL_INT(2992, (uint16_t)get(0x6072)); /* 3.8 of 1.27 Nm */
    set(0x6072, 2, 50);
    lone_enable(&lone, CST);
    set(0x6071, 2, 500);
    lone_step(&lone, 1);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 336.875, acceleration_mm_s2());
    TEST_ASSERT_TRUE(lone_statusword(&lone) & LIMITED);
    lone_control(&lone, ENABLE, CSP);
    lone_step(&lone, 1);
    set(0x607A, 4, get(0x6064) + 1500);
    for (unsigned k = 0; k < 20; k++)
        TEST_ASSERT_TRUE(fabs(acceleration_mm_s2()) < 337);
}

static void test_torque_makes_no_motor_faster_than_6080(void)
{
    set(0x6080, 4, 60); /* 10 mm/s */
    lone_enable(&lone, CST);
    set(0x6071, 2, 100);
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s()) < 10.8);
    TEST_ASSERT_TRUE(velocity_mm_s() > 9.9);
}

/* ---- Profiles ---- */

static void go(int32_t target_inc)
{
    set(0x607A, 4, target_inc);
    lone_control(&lone, ENABLE | NEW, PP);
    lone_control(&lone, ENABLE, PP);
}

static void test_60C5_and_60C6_limit_ramps_and_quick_stop(void)
{
    double up = 0, down = 0, v = 0;
    set(0x60C5, 4, 200000);
    set(0x60C6, 4, 300000);
    lone_enable(&lone, PP);
    go(20000);
    for (unsigned k = 0; k < 900; k++) {
        lone_step(&lone, 1);
        double a = (lone.drive.servo.velocity_mm_s - v) / 1e-3;
        v = lone.drive.servo.velocity_mm_s;
        up = fmax(up, a);
        down = fmin(down, a);
    }
    TEST_ASSERT_TRUE(fabs(up - 200) < 1e-6);
    TEST_ASSERT_TRUE(down < -299 && down > -601); /* the last cycle may brake by two */
    TEST_ASSERT_TRUE(lone.drive.servo.loop.command_mm == 20);
    TEST_ASSERT_TRUE(lone.drive.servo.quick_stop_mm_s2 == 300);
}

/* 10 mm/s at 10 mm, and on to 20 mm; the end velocity of a last target does not count. */
static void test_6082_is_the_velocity_at_a_target_that_has_another_behind_it(void)
{
    double at_mm_s = 1e9, farthest_mm = 0;
    set(0x6082, 4, 10000);
    lone_enable(&lone, PP);
    go(10000);
    go(20000);
    for (unsigned k = 0; k < 2000; k++) {
        double before_mm = lone.drive.servo.loop.command_mm;
        lone_step(&lone, 1);
        if (before_mm < 10 && lone.drive.servo.loop.command_mm >= 10)
            at_mm_s = lone.drive.servo.velocity_mm_s;
        farthest_mm = fmax(farthest_mm, lone.drive.servo.loop.command_mm);
    }
    TEST_ASSERT_TRUE(fabs(at_mm_s - 10) < 1.1); /* two cycles of 500 mm/s2 */
    TEST_ASSERT_TRUE(lone.drive.servo.loop.command_mm == 20 && farthest_mm == 20);
}

/* ---- Polarity ---- */

static void test_polarity_turns_position_velocity_and_torque_each(void)
{
    set(0x607E, 1, 0xE0);
    lone_enable(&lone, CSV);
    set(0x60FF, 4, 5000);
    lone_step(&lone, 200);
    TEST_ASSERT_TRUE(fabs(velocity_mm_s() + 5) < 0.1);
    TEST_ASSERT_INT_WITHIN(100, 5000, get(0x606C));
    TEST_ASSERT_INT_WITHIN(2, (int)(-1000 * lone.drive.plant.position_mm), get(0x6064));
    TEST_ASSERT_TRUE(get(0x6064) > 900);
    lone_control(&lone, ENABLE, CST);
    set(0x6071, 2, 100);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(fabs(acceleration_mm_s2() + 673.75) < 0.01);
    TEST_ASSERT_EQUAL_INT(100, (int16_t)get(0x6077));
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_write(&lone, 0x607E, 0, 1, 0));
}

static void test_polarity_of_velocity_alone_leaves_positions_as_they_are(void)
{
    set(0x607E, 1, 0x40);
    lone_enable(&lone, CSV);
    set(0x60FF, 4, 5000);
    lone_step(&lone, 200);
    TEST_ASSERT_TRUE(velocity_mm_s() < -4.9);
    TEST_ASSERT_TRUE(get(0x6064) < -900);
}

/* As it was at power-on the machine has reckoned with it. */
static void test_polarity_of_a_data_sheet_is_part_of_the_scale(void)
{
    lone.drive.servo.initial.settings.polarity = 0xE0;
    set(0x607E, 1, 0xE0);
    lone_enable(&lone, CSV);
    set(0x60FF, 4, 5000);
    lone_step(&lone, 200);
    TEST_ASSERT_TRUE(velocity_mm_s() > 4.9);
    TEST_ASSERT_TRUE(get(0x6064) > 900);
}

/* The object does what a machine file says of a motor that turns the other way. */
static void test_a_turned_position_is_followed(void)
{
    set(0x607E, 1, 0x80);
    lone_enable(&lone, CSP);
    set(0x607A, 4, 40);
    lone_step(&lone, 300);
    TEST_ASSERT_INT_WITHIN(1, 40, get(0x6064));
    TEST_ASSERT_TRUE(fabs(lone.drive.plant.position_mm + 0.04) < 1e-3);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_profile_velocity_goes_to_60FF_by_its_ramps);
    RUN_TEST(test_halt_brings_profile_velocity_to_rest_and_lets_it_go_on);
    RUN_TEST(test_velocities_are_limited_by_607F_and_6080_and_that_is_told);
    RUN_TEST(test_cyclic_velocity_is_that_of_60FF_and_60B1_at_once);
    RUN_TEST(test_a_velocity_loop_remembers_no_way);
    RUN_TEST(test_cyclic_torque_accelerates_by_6071_and_60B2);
    RUN_TEST(test_profile_torque_rises_by_6087_and_halt_takes_it_away);
    RUN_TEST(test_6072_limits_the_torque_in_every_mode);
    RUN_TEST(test_torque_makes_no_motor_faster_than_6080);
    RUN_TEST(test_60C5_and_60C6_limit_ramps_and_quick_stop);
    RUN_TEST(test_6082_is_the_velocity_at_a_target_that_has_another_behind_it);
    RUN_TEST(test_polarity_turns_position_velocity_and_torque_each);
    RUN_TEST(test_polarity_of_velocity_alone_leaves_positions_as_they_are);
    RUN_TEST(test_polarity_of_a_data_sheet_is_part_of_the_scale);
    RUN_TEST(test_a_turned_position_is_followed);
    return UNITY_END();
}
