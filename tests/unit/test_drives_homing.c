/*
 * Homing mode of the drive: every method, from every side. 1000 increments/mm, a cycle of 1 ms.
 */
#include "lone_drive.h"

#include <math.h>

#define HM 6

#define ENABLE 0x000F
#define NEW    0x0010

#define REACHED 0x0400
#define BIT_12  0x1000
#define BIT_13  0x2000

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static void set_switches(double start_mm)
{
    lone_set_default(&lone);
    lone.config.plant.start_mm = start_mm;
    lone.config.plant.absolute_encoder = 0;
    lone.config.plant.limit_switch_min_mm = -12.345;
    lone.config.plant.limit_switch_max_mm = 23.456;
    lone.config.plant.home_switch_mm = 3.21;
}

static void begin_homing(int8_t method)
{
    lone_start(&lone);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6098, 0, 1, (uint8_t)method));
    lone_enable(&lone, HM);
    lone_control(&lone, ENABLE | NEW, HM);
}

static void home_with(uint8_t method, double start_mm)
{
    set_switches(start_mm);
    begin_homing((int8_t)method);
}

static uint16_t run_homing(void)
{
    for (unsigned k = 0; k < 30000; k++) {
        uint16_t status = lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13);
        if (status != 0)
            return status;
        lone_step(&lone, 1);
    }
    return 0;
}

/* Where position 0 is on the axis. */
static double zero_mm(void)
{
    return virtual_drive_get_position_mm(&lone.drive) - lone_actual(&lone) / 1000.0;
}

/* Pulses are at multiples of 10 mm. */
static void test_every_method_finds_its_home_from_every_side(void)
{
    static const struct {
        uint8_t method;
        double home_mm;
    } rows[] = {{1, -10},      {2, 20},      {3, 0},     {4, 10},
                {17, -12.345}, {18, 23.456}, {19, 3.21}, {20, 3.21}};
    static const double starts_mm[] = {-12.5, -7.3, 0.4, 3.3, 18.8, 23.6};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (unsigned k = 0; k < sizeof starts_mm / sizeof starts_mm[0]; k++) {
            home_with(rows[i].method, starts_mm[k]);
            TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
            TEST_ASSERT_TRUE(fabs(zero_mm() - rows[i].home_mm) < 0.001);
        }
    }
}

/*
 * A home switch between the ends, longer and shorter than it takes to brake; pulses at multiples of
 * 10 mm. Left and right of its edges as CiA 402-2 has them.
 */
static void test_methods_of_a_home_switch_find_their_edge_from_every_side(void)
{
    static const double starts_mm[] = {-12.5, -7.3, 3.15, 3.3, 5.8, 6.6, 18.8, 23.6};
    static const double lengths_mm[] = {3.3, 0.1};
    for (unsigned l = 0; l < 2; l++) {
        const double left_mm = 3.21, right_mm = left_mm + lengths_mm[l];
        const double edges_mm[] = {left_mm,  left_mm,  right_mm, right_mm,
                                   right_mm, right_mm, left_mm,  left_mm};
        const double pulses_mm[] = {0, 10, 0, 10, 10, 0, 10, 0};
        for (unsigned i = 0; i < 16; i++) {
            for (unsigned k = 0; k < sizeof starts_mm / sizeof starts_mm[0]; k++) {
                set_switches(starts_mm[k]);
                lone.config.plant.home_switch_length_mm = lengths_mm[l];
                begin_homing((int8_t)(i < 8 ? 7 + i : 23 + i - 8));
                TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
                double home_mm = i < 8 ? pulses_mm[i] : edges_mm[i - 8];
                TEST_ASSERT_TRUE(fabs(zero_mm() - home_mm) < 0.001);
            }
        }
    }
}

/*
 * What is left and right of the switch is that of the drive: it begins at 3.21 and ends 3.3 mm
 * below.
 */
static void test_methods_of_a_home_switch_are_those_of_the_motors_own_directions(void)
{
    static const double pulses_mm[] = {10, 0, 0, -10, -10, 0, 0, 10};
    static const double edges_mm[] = {3.21, 3.21, -0.09, -0.09, -0.09, -0.09, 3.21, 3.21};
    for (unsigned i = 0; i < 16; i++) {
        set_switches(i % 3 == 0 ? -12.5 : 5.8);
        lone.config.increments_per_mm = -1000;
        lone.config.plant.home_switch_length_mm = 3.3;
        begin_homing((int8_t)(i < 8 ? 7 + i : 23 + i - 8));
        TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
        double home_mm = virtual_drive_get_position_mm(&lone.drive) + lone_actual(&lone) / 1000.0;
        TEST_ASSERT_TRUE(fabs(home_mm - (i < 8 ? pulses_mm[i] : edges_mm[i - 8])) < 0.001);
    }
}

/* Active from the negative end on. */
static void test_a_negative_home_switch(void)
{
    static const struct {
        int8_t method;
        double home_mm;
    } rows[] = {{5, 10}, {6, 0}, {21, 3.21}, {22, 3.21}};
    static const double starts_mm[] = {-7.3, 3.1, 3.3, 18.8};
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned k = 0; k < 4; k++) {
            set_switches(starts_mm[k]);
            lone.config.plant.home_switch_mm = -1000;
            lone.config.plant.home_switch_length_mm = 1003.21;
            begin_homing(rows[i].method);
            TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
            TEST_ASSERT_TRUE(fabs(zero_mm() - rows[i].home_mm) < 0.001);
        }
    }
}

/*
 * The motor comes no farther; it stands there with the torque of 2003, and leaves it when it is
 * homed.
 */
static void test_a_hard_stop_is_found_by_torque_and_left(void)
{
    static const struct {
        int8_t method;
        double increments_per_mm, home_mm;
    } rows[] = {{-4, 1000, -8.2},  {-3, 1000, 17.6},  {-1, 1000, 0},   {-2, 1000, 10},
                {-4, -1000, 17.6}, {-3, -1000, -8.2}, {-1, -1000, 10}, {-2, -1000, 0}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        set_switches(4);
        lone.config.increments_per_mm = rows[i].increments_per_mm;
        lone.config.plant.hard_stop_min_mm = -8.2;
        lone.config.plant.hard_stop_max_mm = 17.6;
        begin_homing(rows[i].method);
        TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
        lone_step(&lone, 100);
        double zero = virtual_drive_get_position_mm(&lone.drive) -
                      lone_actual(&lone) / rows[i].increments_per_mm;
        TEST_ASSERT_TRUE(fabs(zero - rows[i].home_mm) < 0.001);
        TEST_ASSERT_TRUE(fabs(takt_servo_loop_torque_ratio(&lone.drive.servo.loop)) < 0.05);
        TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    }
}

static void test_60E3_names_every_method_that_is_taken(void)
{
    unsigned taken = 0;
    uint32_t count = lone_read(&lone, 0x60E3, 0);
    for (int method = -128; method < 128; method++)
        taken += lone_write(&lone, 0x6098, 0, 1, (uint8_t)method) == 0;
    TEST_ASSERT_EQUAL_UINT(count, taken);
    for (uint32_t i = 1; i <= count; i++) {
        const uint32_t method = lone_read(&lone, 0x60E3, (uint8_t)i) & 0xFF;

        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6098, 0, 1, method));
    }
}

static void test_index_pulses_are_the_next_in_their_direction(void)
{
    home_with(33, 4);
    TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
    TEST_ASSERT_TRUE(fabs(zero_mm() - 0) < 0.001);
    home_with(34, 4);
    TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
    TEST_ASSERT_TRUE(fabs(zero_mm() - 10) < 0.001);
}

static void test_bit_10_is_set_while_idle_and_falls_with_the_controlword_that_starts(void)
{
    lone.config.plant.absolute_encoder = 0;
    lone_start(&lone);
    (void)lone_write(&lone, 0x6098, 0, 1, 33);
    lone_enable(&lone, HM);
    TEST_ASSERT_EQUAL_HEX16(REACHED, lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13));
    lone_control(&lone, ENABLE | NEW, HM);
    TEST_ASSERT_EQUAL_HEX16(0, lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13));
}

static void test_a_drive_with_an_absolute_encoder_is_homed_at_power_on(void)
{
    lone_enable(&lone, HM);
    TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13));
}

/* CiA 402: the zero position is the home position plus the home offset. */
static void test_home_is_at_minus_the_home_offset(void)
{
    lone.config.plant.start_mm = 2;
    lone_start(&lone);
    (void)lone_write(&lone, 0x607C, 0, 4, 1500);
    (void)lone_write(&lone, 0x6098, 0, 1, 37);
    lone_enable(&lone, HM);
    lone_control(&lone, ENABLE | NEW, HM);
    lone_step(&lone, 2);
    TEST_ASSERT_EQUAL_INT(-1500, lone_actual(&lone));
    TEST_ASSERT_EQUAL_INT(-1500, (int32_t)lone_read(&lone, 0x607A, 0));
    TEST_ASSERT_TRUE(fabs(zero_mm() - 3.5) < 0.001);
}

static void test_homing_that_runs_into_the_other_end_fails_and_may_be_tried_again(void)
{
    home_with(3, 0);
    lone.drive.plant.config.home_switch_mm = 100;
    TEST_ASSERT_EQUAL_HEX16(BIT_13, run_homing() & BIT_13);
    lone_step(&lone, 500);
    TEST_ASSERT_EQUAL_HEX16(BIT_13 | REACHED, lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13));
    lone.drive.plant.config.home_switch_mm = 3.21;
    lone_step(&lone, 1); /* inputs are read once a cycle */
    lone_control(&lone, ENABLE, HM);
    lone_control(&lone, ENABLE | NEW, HM);
    TEST_ASSERT_EQUAL_HEX16(REACHED | BIT_12, run_homing());
}

static void test_homing_is_interrupted_when_bit_4_falls(void)
{
    home_with(17, 0);
    lone_step(&lone, 300);
    lone_control(&lone, ENABLE, HM);
    lone_step(&lone, 300);
    TEST_ASSERT_EQUAL_HEX16(REACHED, lone_statusword(&lone) & (REACHED | BIT_12 | BIT_13));
    TEST_ASSERT_TRUE(lone.drive.servo.loop.command_velocity_mm_s == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_method_finds_its_home_from_every_side);
    RUN_TEST(test_methods_of_a_home_switch_find_their_edge_from_every_side);
    RUN_TEST(test_methods_of_a_home_switch_are_those_of_the_motors_own_directions);
    RUN_TEST(test_a_negative_home_switch);
    RUN_TEST(test_a_hard_stop_is_found_by_torque_and_left);
    RUN_TEST(test_60E3_names_every_method_that_is_taken);
    RUN_TEST(test_index_pulses_are_the_next_in_their_direction);
    RUN_TEST(test_bit_10_is_set_while_idle_and_falls_with_the_controlword_that_starts);
    RUN_TEST(test_a_drive_with_an_absolute_encoder_is_homed_at_power_on);
    RUN_TEST(test_home_is_at_minus_the_home_offset);
    RUN_TEST(test_homing_that_runs_into_the_other_end_fails_and_may_be_tried_again);
    RUN_TEST(test_homing_is_interrupted_when_bit_4_falls);
    return UNITY_END();
}
