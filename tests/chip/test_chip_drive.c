/*
 * A drive's motor at the timers of the chip: pulses, encoder, index and switches, and the drive's
 * firmware on them.
 */
#include "chip_model.h"
#include "servo/servo.h"
#include "stm32/pwm.h"
#include "stm32/quadrature.h"
#include "stm32/servo_motor.h"
#include "stm32/timers.h"
#include "timer_model.h"
#include "unity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TIMER_HZ 168000000U
#define BUS_HZ   84000000U
#define COUNTS   8400

/* 10 mm a turn of 10000 counts. */
#define STEP_MM     0.001
#define WHOLE_MM_S2 20000.0
#define PERIOD_US   250U
#define PERIOD_S    250e-6

static struct quadrature encoder;
static struct servo_motor motor;
static struct motor_port port;

void setUp(void)
{
    chip_model_reset();
}

void tearDown(void)
{
    TEST_ASSERT_NULL(chip_model_broken());
}

/* ---- pulses ---- */

static void test_widths_are_the_torque_in_its_direction(void)
{
    TEST_ASSERT_EQUAL_UINT32(COUNTS, takt_pwm_open(TIMER_HZ, 20000));
    takt_pwm_set(1000);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
    takt_pwm_arm(true);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 1000.0 / COUNTS);
    takt_pwm_set(-2000);
    TEST_ASSERT_TRUE(timer_model_get_torque() == -2000.0 / COUNTS);
    takt_pwm_set(COUNTS);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 1);
    takt_pwm_set(-COUNTS);
    TEST_ASSERT_TRUE(timer_model_get_torque() == -1);
    takt_pwm_set(0);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
    takt_pwm_set(5);
    takt_pwm_arm(false);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
}

static void test_a_power_stage_that_fails_ends_the_torque_until_it_is_armed_again(void)
{
    (void)takt_pwm_open(TIMER_HZ, 20000);
    takt_pwm_set(1000);
    takt_pwm_arm(true);
    TEST_ASSERT_FALSE(takt_pwm_is_broken());
    timer_model_hold_break(true);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
    TEST_ASSERT_TRUE(takt_pwm_is_broken());
    timer_model_hold_break(false);
    takt_pwm_set(1200);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0 && takt_pwm_is_broken());
    takt_pwm_arm(true);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 1200.0 / COUNTS);
    TEST_ASSERT_FALSE(takt_pwm_is_broken());
    timer_model_hold_break(true);
    takt_pwm_arm(true);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0 && takt_pwm_is_broken());
}

/* ---- encoder ---- */

static void test_it_counts_beyond_the_timers_16_bits_in_both_directions(void)
{
    int64_t expected = 0;

    srand(2);
    takt_quadrature_open(&encoder);
    for (unsigned i = 0; i < 100000; i++) {
        const int32_t way = rand() % 65535 - 32767 + (i < 50000 ? 1000 : -2000);
        const int32_t half = way > 32767 ? 32767 : way < -32767 ? -32767 : way;

        timer_model_turn(half);
        expected += half;
        TEST_ASSERT_TRUE(takt_quadrature_read(&encoder) == expected);
    }
    TEST_ASSERT_TRUE(expected < -1000000);
}

static void test_edges_are_told_once_with_the_count_at_which_they_were(void)
{
    int64_t counts = 7;

    takt_quadrature_open(&encoder);
    TEST_ASSERT_FALSE(takt_quadrature_take_edge(&encoder, QUADRATURE_INDEX, &counts));
    for (int64_t turn = 1; turn < 100; turn++) {
        timer_model_turn(9000);
        timer_model_pulse_index();
        timer_model_turn(300);
        timer_model_switch(turn % 2 != 0);
        timer_model_turn(700);
        TEST_ASSERT_TRUE(takt_quadrature_read(&encoder) == turn * 10000);
        TEST_ASSERT_TRUE(takt_quadrature_take_edge(&encoder, QUADRATURE_INDEX, &counts));
        TEST_ASSERT_TRUE(counts == turn * 10000 - 1000);
        TEST_ASSERT_TRUE(takt_quadrature_take_edge(&encoder, QUADRATURE_SWITCH, &counts));
        TEST_ASSERT_TRUE(counts == turn * 10000 - 700);
        TEST_ASSERT_FALSE(takt_quadrature_take_edge(&encoder, QUADRATURE_INDEX, &counts));
        TEST_ASSERT_FALSE(takt_quadrature_take_edge(&encoder, QUADRATURE_SWITCH, &counts));
    }
}

/* ---- hal/motor.h ---- */

static void open_motor(void)
{
    const struct servo_motor_config config = {
        .timer_hz = TIMER_HZ,
        .pulses_hz = 20000,
        .whole_mm_s2 = WHOLE_MM_S2,
        .encoder_step_mm = STEP_MM,
        .switches = {{GPIO_C, 0}, {GPIO_C, 1}, {GPIO_B, 1}},
    };

    takt_servo_motor_open(&motor, &config);
    port = takt_servo_motor_get_port(&motor);
    takt_timers_start_cycle(BUS_HZ, PERIOD_US);
}

static void test_a_torque_is_its_part_of_the_whole_one(void)
{
    open_motor();
    takt_servo_motor_arm(&motor, true);
    (void)port.turn(port.context, 5000, PERIOD_S);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0.25);
    (void)port.turn(port.context, -1e6, PERIOD_S);
    TEST_ASSERT_TRUE(timer_model_get_torque() == -1);
    takt_servo_motor_arm(&motor, false);
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
}

static void turn_while_it_waits(void *context)
{
    timer_model_turn(*(const int32_t *)context);
}

static void test_a_step_ends_with_the_timer_and_says_where_the_encoder_is_then(void)
{
    int32_t way = -250;
    struct motor_sense sense;

    open_motor();
    timer_model_set_tick(turn_while_it_waits, &way);
    TEST_ASSERT_TRUE(port.turn(port.context, 0, PERIOD_S) == -0.25);
    TEST_ASSERT_TRUE(port.turn(port.context, 0, PERIOD_S) == -0.5);
    port.sense(port.context, 0, &sense);
    TEST_ASSERT_TRUE(sense.encoder_mm == -0.5 && sense.torque_ratio == 1 && sense.inputs == 0);
    TEST_ASSERT_FALSE(takt_servo_motor_take_late(&motor));
    timer_model_hurry();
    (void)port.turn(port.context, 0, PERIOD_S);
    TEST_ASSERT_TRUE(takt_servo_motor_take_late(&motor));
    TEST_ASSERT_FALSE(takt_servo_motor_take_late(&motor));
}

/* Down over the home switch and the index pulse, and onto the lower limit. */
static void pass_switches(void *context)
{
    (void)context;
    timer_model_turn(-100);
    timer_model_set_pin('B', 1, true);
    timer_model_switch(true);
    timer_model_turn(-50);
    timer_model_pulse_index();
    timer_model_turn(-70);
    timer_model_set_pin('C', 0, true);
}

static void test_switches_and_index_have_latched_the_encoder(void)
{
    struct motor_sense sense;

    open_motor();
    timer_model_set_tick(pass_switches, NULL);
    (void)port.turn(port.context, 0, PERIOD_S);
    port.sense(port.context, 0, &sense);
    TEST_ASSERT_EQUAL_HEX32(MOTOR_HOME | MOTOR_NEGATIVE_LIMIT, sense.inputs);
    TEST_ASSERT_TRUE(sense.edge[2].encoder_mm == -100 * STEP_MM && sense.edge[2].direction == -1);
    TEST_ASSERT_TRUE(sense.edge[0].encoder_mm == -220 * STEP_MM && sense.edge[0].direction == -1);
    TEST_ASSERT_EQUAL_UINT32(1, sense.pulses);
    TEST_ASSERT_TRUE(sense.pulse.encoder_mm == -150 * STEP_MM && sense.pulse.direction == -1);
}

/* ---- the drive on it ---- */

/*
 * A motor without friction behind the pulses, with an index pulse a turn, and a switch above 3.2
 * mm.
 */
static struct mechanics {
    double at_mm, velocity_mm_s;
    int64_t counts;
} mechanics;

static bool is_above(int64_t counts)
{
    return counts >= 3200;
}

static void move_to(int64_t counts)
{
    while (mechanics.counts != counts) {
        const int32_t way = counts > mechanics.counts ? 1 : -1;

        mechanics.counts += way;
        timer_model_turn(way);
        if (mechanics.counts % 10000 == 0)
            timer_model_pulse_index();
        timer_model_switch(is_above(mechanics.counts));
        timer_model_set_pin('B', 1, is_above(mechanics.counts));
    }
}

static void move(void *context)
{
    (void)context;
    mechanics.velocity_mm_s += timer_model_get_torque() * WHOLE_MM_S2 * PERIOD_S;
    mechanics.at_mm += mechanics.velocity_mm_s * PERIOD_S;
    move_to(llround(mechanics.at_mm / STEP_MM));
}

static bool send(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return true;
}

static bool receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static struct servo servo;

static void start_drive(void)
{
    const struct can_port bus = {.send = send, .receive = receive};
    const struct servo_config config = {
        .node = 1,
        .increments_per_mm = 1000,
        .following_error_window_mm = 2,
        .quick_stop_deceleration_mm_s2 = 2000,
        .loop = {.travel_per_revolution_mm = 10,
                 .inertia_kg_m2 = 3e-4,
                 .torque_max_nm = WHOLE_MM_S2 * 3e-4 / (10 / 6.283185307179586),
                 .torque_rated_nm = 1.27,
                 .encoder_counts_per_revolution = 10000,
                 .loop_period_us = PERIOD_US,
                 .position_gain_per_s = 100,
                 .velocity_feed_forward_ratio = 1,
                 .velocity_bandwidth_hz = 100,
                 .velocity_integral_time_s = 0.02}};

    memset(&mechanics, 0, sizeof mechanics);
    open_motor();
    timer_model_set_tick(move, NULL);
    takt_servo_init(&servo, &config, NULL, &bus, &port);
    takt_servo_boot(&servo);
}

static void take(uint16_t id, uint8_t length, uint32_t low)
{
    struct can_frame frame = {.id = id, .length = length};

    for (unsigned i = 0; i < 4; i++)
        frame.data[i] = (uint8_t)(low >> 8 * i);
    takt_servo_on_frame(&servo, &frame);
}

static void control(uint16_t word, int8_t mode)
{
    take(0x201, 3, word | (uint32_t)(uint8_t)mode << 16);
}

static void enable(int8_t mode)
{
    take(0, 2, 0x0101);
    control(6, mode);
    control(7, mode);
    control(15, mode);
    TEST_ASSERT_EQUAL(CIA402_ENABLED, takt_servo_get_state(&servo));
    takt_servo_motor_arm(&motor, true);
}

static void step(unsigned steps)
{
    for (unsigned i = 0; i < steps; i++) {
        takt_servo_step(&servo, PERIOD_US * 1000U);
        TEST_ASSERT_FALSE(takt_servo_motor_take_late(&motor));
    }
}

/* A SYNC every four steps. */
static void go_to(double from_mm, double to_mm, unsigned cycles)
{
    for (unsigned i = 1; i <= cycles; i++) {
        take(0x301, 4, (uint32_t)lround((from_mm + (to_mm - from_mm) * i / cycles) * 1000));
        take(0x80, 0, 0);
        step(4);
    }
}

static void test_a_drive_follows_its_targets(void)
{
    double worst_mm = 0;

    start_drive();
    enable(8);
    for (unsigned i = 0; i < 400; i++) {
        const double target_mm = 8 * (1 - cos(i * 0.02));

        go_to(target_mm, target_mm, 1);
        if (i > 10)
            worst_mm = fmax(worst_mm, fabs(mechanics.at_mm - target_mm));
    }
    TEST_ASSERT_TRUE(worst_mm < 0.25);
    go_to(mechanics.at_mm, 12.345, 300);
    go_to(12.345, 12.345, 300);
    TEST_ASSERT_TRUE(fabs(mechanics.at_mm - 12.345) <= 2 * STEP_MM);
    TEST_ASSERT_EQUAL(CIA402_ENABLED, takt_servo_get_state(&servo));
}

/* Methods 34, at the index pulse above, and 19, at the edge of the home switch. */
static void home(int8_t method, double home_mm)
{
    uint32_t actual = 0, status = 0;

    start_drive();
    move_to(130);
    mechanics.at_mm = 0.13;
    (void)port.turn(port.context, 0, PERIOD_S);
    takt_servo_loop_look(&servo.loop);
    TEST_ASSERT_TRUE(takt_servo_write_object(&servo, 0x60980008, (uint8_t)method));
    enable(6);
    control(31, 6);
    for (unsigned i = 0; i < 40000 && (status & 0x3400) != 0x1400; i++) {
        step(1);
        (void)takt_servo_read_object(&servo, 0x60410010, &status);
    }
    step(2000);
    TEST_ASSERT_TRUE(takt_servo_read_object(&servo, 0x60640020, &actual));
    TEST_ASSERT_DOUBLE_WITHIN(1.5 * STEP_MM, (double)mechanics.counts * STEP_MM - home_mm,
                              (int32_t)actual / 1000.0);
}

static void test_home_is_where_the_index_pulse_or_the_switch_is_to_a_count(void)
{
    home(34, 10);
    home(19, 3.2);
}

static void test_a_break_is_told_and_ends_the_torque(void)
{
    start_drive();
    enable(8);
    step(100);
    TEST_ASSERT_FALSE(takt_servo_motor_has_failed(&motor));
    timer_model_hold_break(true);
    TEST_ASSERT_TRUE(takt_servo_motor_has_failed(&motor));
    takt_servo_motor_arm(&motor, false);
    TEST_ASSERT_FALSE(takt_servo_motor_has_failed(&motor));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_widths_are_the_torque_in_its_direction);
    RUN_TEST(test_a_power_stage_that_fails_ends_the_torque_until_it_is_armed_again);
    RUN_TEST(test_it_counts_beyond_the_timers_16_bits_in_both_directions);
    RUN_TEST(test_edges_are_told_once_with_the_count_at_which_they_were);
    RUN_TEST(test_a_torque_is_its_part_of_the_whole_one);
    RUN_TEST(test_a_step_ends_with_the_timer_and_says_where_the_encoder_is_then);
    RUN_TEST(test_switches_and_index_have_latched_the_encoder);
    RUN_TEST(test_a_drive_follows_its_targets);
    RUN_TEST(test_home_is_where_the_index_pulse_or_the_switch_is_to_a_count);
    RUN_TEST(test_a_break_is_told_and_ends_the_torque);
    return UNITY_END();
}
