/*
 * Modes of operation of the drive but for homing: profile position, interpolated and cyclic
 * position, and what the option codes say of stopping. 1000 increments/mm, a cycle of 1 ms.
 */
#include "drive_modes_bench.h"

#define REACHED 0x0400
#define BIT_12  0x1000
#define BIT_13  0x2000
#define LIMITED 0x0800 /* internal limit active */

static void set_target(int32_t target_inc)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x607A, 0, 4, (uint32_t)target_inc));
}

/* A set-point as the profile has it: target, bit 4 up, acknowledged, bit 4 down. */
static void go(int32_t target_inc, uint16_t bits)
{
    set_target(target_inc);
    lone_control(&lone, ENABLE | NEW | bits, PP);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & BIT_12);
    lone_control(&lone, ENABLE | bits, PP);
}

static unsigned cycles_until_reached(void)
{
    for (unsigned k = 1; k < 20000; k++) {
        lone_step(&lone, 1);
        if (lone_statusword(&lone) & REACHED)
            return k;
    }
    TEST_FAIL_MESSAGE("the target is never reached");
    return 0;
}

/* ---- Profile position ---- */

/* 50 mm/s, 500 mm/s2 over 20 mm: v / a + s / v = 0.1 + 0.4 s. */
static void test_a_profile_takes_the_time_of_its_trapezoid(void)
{
    lone_enable(&lone, PP);
    go(20000, 0);
    unsigned cycles = cycles_until_reached();
    TEST_ASSERT_TRUE(cycles >= 500 && cycles < 540);
    TEST_ASSERT_INT_WITHIN(10, 20000, lone_actual(&lone));
    lone_step(&lone, 500);
    TEST_ASSERT_EQUAL_INT(20000, lone_actual(&lone));
}

/* Verified by differences of the command, cycle by cycle. */
static void test_a_profile_keeps_velocity_and_accelerations_and_never_overshoots(void)
{
    double x = 0, v = 0, v_max = 0, up = 0, down = 0;
    (void)lone_write(&lone, 0x6081, 0, 4, 80000);
    (void)lone_write(&lone, 0x6083, 0, 4, 400000);
    (void)lone_write(&lone, 0x6084, 0, 4, 900000);
    lone_enable(&lone, PP);
    go(30000, 0);
    for (unsigned k = 0; k < 900; k++) {
        lone_step(&lone, 1);
        double v_now = (command_mm() - x) / 1e-3;
        double a = (v_now - v) / 1e-3;
        up = fmax(up, a);
        down = fmin(down, a);
        v_max = fmax(v_max, v_now);
        x = command_mm();
        v = v_now;
        TEST_ASSERT_TRUE(x <= 30 + 1e-9);
    }
    TEST_ASSERT_TRUE(x == 30);
    TEST_ASSERT_TRUE(fabs(v_max - 80) < 1e-6);
    TEST_ASSERT_TRUE(fabs(up - 400) < 1);
    TEST_ASSERT_TRUE(down < -890 && down > -1810); /* the last cycle may brake by two */
}

/* ---- with limited jerk (6086: 3, 60A4) ---- */

struct peaks {
    double velocity_mm_s, acceleration_mm_s2, jerk_mm_s3, place_mm;
};

/* Peaks of the command, by differences over this many cycles, from rest at x on. */
static struct peaks follow_command(unsigned cycles)
{
    struct peaks most = {0, 0, 0, 0};
    static double x, v, a;
    if (cycles == 0)
        x = v = a = 0;
    for (unsigned k = 0; k < cycles; k++) {
        lone_step(&lone, 1);
        double v_now = (command_mm() - x) / 1e-3;
        double a_now = (v_now - v) / 1e-3;
        most.jerk_mm_s3 = fmax(most.jerk_mm_s3, fabs(a_now - a) / 1e-3);
        most.acceleration_mm_s2 = fmax(most.acceleration_mm_s2, fabs(a_now));
        most.velocity_mm_s = fmax(most.velocity_mm_s, fabs(v_now));
        most.place_mm = fmax(most.place_mm, command_mm());
        x = command_mm();
        v = v_now;
        a = a_now;
    }
    return most;
}

/*
 * The command's places are whole 1e-9 mm: 4e-9 mm / cycle^3 of jerk are their rounding, by the
 * average of 100 or so less.
 */
#define ROUNDING_MM_S3 1.0

static void limit_jerk(uint32_t jerk_inc_s3)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6081, 0, 4, 80000));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6083, 0, 4, 400000));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6084, 0, 4, 900000));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6086, 0, 2, 3));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x60A4, 1, 4, jerk_inc_s3));
    lone_enable(&lone, PP);
    (void)follow_command(0);
}

/*
 * (400 + 2 900) mm/s2 by 20,000 mm/s3: 110 cycles longer than
 * v / 2a + v / 2d + s / v = 0.1 + 0.0444 + 0.375 s.
 */
static void test_a_profile_of_limited_jerk_lands_exactly_and_later_by_its_average(void)
{
    limit_jerk(20000000);
    go(30000, 0);
    struct peaks most = follow_command(300);
    struct peaks rest = follow_command(250);
    TEST_ASSERT_TRUE(command_mm() < 30);
    struct peaks last = follow_command(110);
    TEST_ASSERT_TRUE(command_mm() == 30);
    TEST_ASSERT_TRUE(fmax(rest.place_mm, last.place_mm) <= 30 + 1e-9);
    TEST_ASSERT_TRUE(fabs(rest.velocity_mm_s - 80) < 1e-4);
    TEST_ASSERT_TRUE(fmax(rest.acceleration_mm_s2, last.acceleration_mm_s2) < 901);
    TEST_ASSERT_TRUE(most.acceleration_mm_s2 < 401);
    double jerk = fmax(most.jerk_mm_s3, fmax(rest.jerk_mm_s3, last.jerk_mm_s3));
    TEST_ASSERT_TRUE(jerk <= 20000 + ROUNDING_MM_S3);
    TEST_ASSERT_TRUE(jerk > 5000);
}

/* Back and forth, at whatever moment. */
static void test_jerk_is_limited_when_targets_change_on_the_way(void)
{
    limit_jerk(20000000);
    uint32_t random = 25;
    double jerk = 0;
    for (int i = 0; i < 40; i++) {
        random = random * 1664525U + 1013904223U;
        go((int32_t)(random >> 16), NOW);
        jerk = fmax(jerk, follow_command(1 + (random >> 8) % 400).jerk_mm_s3);
    }
    jerk = fmax(jerk, follow_command(3000).jerk_mm_s3);
    TEST_ASSERT_TRUE(jerk > 10000 && jerk <= 20000 + ROUNDING_MM_S3);
    TEST_ASSERT_TRUE(command_mm() == (double)(random >> 16) / 1000);
}

static void test_profiles_of_other_laws_are_refused(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x6086, 0, 2, 1));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x6086, 0, 2, 2));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6086, 0, 2, 0));
}

static void test_velocity_is_the_least_of_6081_607F_and_6080(void)
{
    double fastest_mm_s = 0;
    (void)lone_write(&lone, 0x6081, 0, 4, 300000);
    (void)lone_write(&lone, 0x607F, 0, 4, 200000);
    (void)lone_write(&lone, 0x6080, 0, 4, 240); /* 40 mm/s */
    lone_enable(&lone, PP);
    go(20000, 0);
    for (unsigned k = 0; k < 300; k++) {
        lone_step(&lone, 1);
        fastest_mm_s = fmax(fastest_mm_s, lone.drive.servo.loop.command_velocity_mm_s);
    }
    TEST_ASSERT_TRUE(fabs(fastest_mm_s - 40) < 1e-6);
}

static void test_a_second_target_waits_for_the_first(void)
{
    double farthest_mm = 0;
    lone_enable(&lone, PP);
    go(10000, 0);
    lone_step(&lone, 50);
    go(-5000, 0);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & BIT_12); /* no room for a third */
    for (unsigned k = 0; k < 2000; k++) {
        lone_step(&lone, 1);
        farthest_mm = fmax(farthest_mm, command_mm());
    }
    TEST_ASSERT_TRUE(farthest_mm == 10);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & BIT_12);
    TEST_ASSERT_TRUE(command_mm() == -5);
}

static void test_change_immediately_turns_round_on_the_way(void)
{
    double farthest_mm = 0;
    lone_enable(&lone, PP);
    go(50000, 0);
    lone_step(&lone, 200);
    go(0, NOW);
    for (unsigned k = 0; k < 2000; k++) {
        lone_step(&lone, 1);
        farthest_mm = fmax(farthest_mm, command_mm());
    }
    /* 7.5 mm until then and v^2 / 2a = 2.5 mm to turn round */
    TEST_ASSERT_TRUE(farthest_mm > 9.9 && farthest_mm < 10.1);
    TEST_ASSERT_TRUE(command_mm() == 0);
}

static void test_a_relative_target_counts_from_the_one_before(void)
{
    lone_enable(&lone, PP);
    go(3000, 0);
    (void)cycles_until_reached();
    go(2000, REL);
    (void)cycles_until_reached();
    TEST_ASSERT_INT_WITHIN(10, 5000, lone_actual(&lone));
}

static void test_halt_stops_and_lets_go_on(void)
{
    lone_enable(&lone, PP);
    go(20000, 0);
    lone_step(&lone, 200);
    lone_control(&lone, ENABLE | HALT, PP);
    lone_step(&lone, 300);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & REACHED);
    TEST_ASSERT_TRUE(command_mm() > 9.9 && command_mm() < 10.1);
    lone_control(&lone, ENABLE, PP);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & REACHED);
    (void)cycles_until_reached();
    TEST_ASSERT_INT_WITHIN(10, 20000, lone_actual(&lone));
}

static void test_targets_beyond_the_software_limits_end_at_them(void)
{
    (void)lone_write(&lone, 0x607D, 1, 4, (uint32_t)-1000);
    (void)lone_write(&lone, 0x607D, 2, 4, 2000);
    lone_enable(&lone, PP);
    go(5000, 0);
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(command_mm() == 2);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & LIMITED);
    go(-5000, 0);
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(command_mm() == -1);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & LIMITED);
    go(2500, REL); /* from the limit, not from what was wanted */
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(command_mm() == 1.5);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & LIMITED);
}

static void test_without_a_rising_bit_4_nothing_moves(void)
{
    lone_enable(&lone, PP);
    set_target(5000);
    lone_step(&lone, 100);
    TEST_ASSERT_TRUE(command_mm() == 0);
    lone_control(&lone, ENABLE | NEW, PP);
    set_target(9000);
    lone_control(&lone, ENABLE | NEW, PP);
    lone_step(&lone, 1000);
    TEST_ASSERT_TRUE(command_mm() == 5);
}

/*
 * 60C2 says that a target comes every 4 ms: the command is there in four cycles, in a straight
 * line.
 */
static void test_a_target_is_reached_in_the_interpolation_period(void)
{
    (void)lone_write(&lone, 0x60C2, 1, 1, 4);
    lone_enable(&lone, CSP);
    target_by_pdo(40);
    for (unsigned k = 1; k <= 4; k++) {
        lone_step(&lone, 1);
        TEST_ASSERT_TRUE(fabs(command_mm() - 0.01 * k) < 1e-12);
    }
    lone_step(&lone, 3);
    TEST_ASSERT_TRUE(command_mm() == 0.04);
}

static void test_offsets_add_to_target_velocity_and_torque(void)
{
    lone_enable(&lone, CSP);
    (void)lone_write(&lone, 0x60B0, 0, 4, 25);
    (void)lone_write(&lone, 0x60B1, 0, 4, 500);
    (void)lone_write(&lone, 0x60B2, 0, 2, 100);
    target_by_pdo(10);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(command_mm() == 0.035);
    TEST_ASSERT_TRUE(lone.drive.servo.loop.velocity_offset_mm_s == 0.5);
    TEST_ASSERT_TRUE(fabs(lone.drive.servo.loop.torque_offset_mm_s2 -
                          0.1 * lone.drive.servo.loop.mm_s2_per_rated) < 1e-9);
}

static void test_cyclic_targets_are_held_within_the_software_limits(void)
{
    (void)lone_write(&lone, 0x607D, 2, 4, 15);
    lone_enable(&lone, CSP);
    target_by_pdo(20);
    lone_step(&lone, 2);
    TEST_ASSERT_TRUE(command_mm() == 0.015);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & LIMITED);
    TEST_ASSERT_EQUAL_HEX32(2 | 8, lone_read(&lone, 0x1002, 0)); /* by its target; it is homed */
    target_by_pdo(15);
    lone_step(&lone, 2);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & LIMITED);
    TEST_ASSERT_EQUAL_HEX32(8, lone_read(&lone, 0x1002, 0));
    target_by_pdo(20);
    lone_step(&lone, 2);
    lone_control(&lone, CIA402_SHUTDOWN, CSP);
    lone_step(&lone, 1);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & LIMITED);
}

/*
 * Targets of an even acceleration of 1000 mm/s2, a cycle late; between them the motor gets no steps
 * of torque.
 */
static void test_cyclic_targets_are_followed_smoothly_if_60C0_says_so(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x60C0, 0, 2, 0xFFFF));
    TEST_ASSERT_EQUAL_HEX32(0x06090031, lone_write(&lone, 0x60C0, 0, 2, 1));
    TEST_ASSERT_EQUAL_HEX32(0x06090032, lone_write(&lone, 0x60C0, 0, 2, 0xFFFE));
    lone_enable(&lone, CSP);
    for (unsigned k = 1; k <= 100; k++) {
        double before = 5e-4 * (k - 1) * (k - 1);
        target_by_pdo((int32_t)lround(0.5 * k * k));
        lone_step(&lone, 1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, before, command_mm());
    }
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(command_mm() == 5);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(command_mm() == 5);
}

static void test_interpolated_position_follows_60C1_while_bit_4_is_set(void)
{
    lone_enable(&lone, IP);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x60C1, 1, 4, 30));
    lone_step(&lone, 5);
    TEST_ASSERT_TRUE(command_mm() == 0);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & BIT_12);
    lone_control(&lone, ENABLE | NEW, IP);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & BIT_12);
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(command_mm() == 0.03);
    lone_control(&lone, ENABLE, IP);
    (void)lone_write(&lone, 0x60C1, 1, 4, 60);
    lone_step(&lone, 1000);
    TEST_ASSERT_FALSE(lone_statusword(&lone) & BIT_12);
    TEST_ASSERT_TRUE(command_mm() < 0.06 + 1.0); /* it slows down from 30 mm/s and stands */
    TEST_ASSERT_TRUE(lone.drive.servo.loop.command_velocity_mm_s == 0);
}

static void test_a_mode_the_drive_does_not_have_is_not_taken(void)
{
    lone_enable(&lone, CSP);
    lone_control(&lone, ENABLE, 2);
    TEST_ASSERT_EQUAL_UINT32(CSP, lone_read(&lone, 0x6061, 0));
    TEST_ASSERT_EQUAL_UINT32(2, lone_read(&lone, 0x6060, 0));
    lone_control(&lone, ENABLE, PP);
    TEST_ASSERT_EQUAL_UINT32(PP, lone_read(&lone, 0x6061, 0));
}

static void test_every_mode_of_6502_is_taken(void)
{
    static const uint8_t modes[] = {PP, 3, 4, HM, IP, CSP, 9, 10};
    uint32_t supported = lone_read(&lone, 0x6502, 0);
    TEST_ASSERT_EQUAL_HEX32(0x3ED, supported);
    for (unsigned i = 0; i < sizeof modes; i++) {
        TEST_ASSERT_TRUE(supported >> (modes[i] - 1) & 1);
        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6060, 0, 1, modes[i]));
        TEST_ASSERT_EQUAL_UINT32(modes[i], lone_read(&lone, 0x6061, 0));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_profile_takes_the_time_of_its_trapezoid);
    RUN_TEST(test_a_profile_keeps_velocity_and_accelerations_and_never_overshoots);
    RUN_TEST(test_a_profile_of_limited_jerk_lands_exactly_and_later_by_its_average);
    RUN_TEST(test_jerk_is_limited_when_targets_change_on_the_way);
    RUN_TEST(test_profiles_of_other_laws_are_refused);
    RUN_TEST(test_velocity_is_the_least_of_6081_607F_and_6080);
    RUN_TEST(test_a_second_target_waits_for_the_first);
    RUN_TEST(test_change_immediately_turns_round_on_the_way);
    RUN_TEST(test_a_relative_target_counts_from_the_one_before);
    RUN_TEST(test_halt_stops_and_lets_go_on);
    RUN_TEST(test_targets_beyond_the_software_limits_end_at_them);
    RUN_TEST(test_without_a_rising_bit_4_nothing_moves);
    RUN_TEST(test_a_target_is_reached_in_the_interpolation_period);
    RUN_TEST(test_offsets_add_to_target_velocity_and_torque);
    RUN_TEST(test_cyclic_targets_are_held_within_the_software_limits);
    RUN_TEST(test_cyclic_targets_are_followed_smoothly_if_60C0_says_so);
    RUN_TEST(test_interpolated_position_follows_60C1_while_bit_4_is_set);
    RUN_TEST(test_a_mode_the_drive_does_not_have_is_not_taken);
    RUN_TEST(test_every_mode_of_6502_is_taken);
    return UNITY_END();
}
