/*
 * firmware/controller/controller.h: what the cycle does when the background does not keep up, on
 * three virtual drives.
 */
#include "bus/bus.h"
#include "controller/controller.h"
#include "controller/restart.h"
#include "drives/virtual_drives.h"

#include "unity.h"

#include <string.h>

#define DRIVES 3U
/* Fewer than the moves of the program below, with room to spare. */
#define LOOK_AHEAD 8U
#define CYCLE_US   1000U
#define CYCLE_NS   1000000U
#define CYCLES_MAX 20000U

static struct controller controller;
static struct controller_reader reader;
static struct bus bus;
static struct virtual_drives drives;
static struct parameters parameters;
static struct source_text text;
static uint64_t now_ns;

static void start_from(const struct source *source)
{
    struct virtual_drives_config virtual;
    struct machine machine;
    struct controller_config config = {
        .machine = &machine, .reader = &reader, .parameters = &parameters};

    virtual_drives_set_default(&virtual, DRIVES);
    takt_machine_set_default(&machine);
    machine.look_ahead_blocks = LOOK_AHEAD;
    TEST_ASSERT_TRUE(bus_init(&bus, machine.can_bitrate));
    config.can = can_single(bus_attach(&bus, NULL));
    virtual_drives_init(&drives, &bus, &virtual);
    takt_parameters_clear(&parameters);
    config.source = *source;
    takt_controller_init(&controller, &config);
    now_ns = 0;
}

static void start(const char *program)
{
    struct source source;

    takt_source_open_text(&source, &text, program, strlen(program));
    start_from(&source);
}

static void cycle(void)
{
    const struct inputs inputs = inputs_idle();

    takt_controller_cycle(&controller, &inputs);
    now_ns += CYCLE_NS;
    bus_run_until(&bus, now_ns);
    virtual_drives_step(&drives, CYCLE_NS);
}

/* The state in the end; with background called only until the program runs, or always. */
static enum controller_state run(bool background_goes_on)
{
    enum controller_state state = CONTROLLER_STARTING;

    for (unsigned i = 0; i < CYCLES_MAX && state < CONTROLLER_COMPLETED; i++) {
        if (background_goes_on || state == CONTROLLER_STARTING) {
            takt_controller_background(&controller);
        }
        cycle();
        state = takt_controller_get_state(&controller);
    }
    return state;
}

void setUp(void)
{
}

void tearDown(void)
{
}

static const char many_moves[] =
    "G21 F3000 G1 X1\nX2\nX3\nX4\nX5\nX6\nX7\nX8\nX9\nX10\nX11\nX12\nX13\nX14\nX15\nX16\nX17\nX18\n"
    "X19\nX20\nX21\nX22\nX23\nX24\nX25\nX26\nX27\nX28\nX29\nX30\nX31\nX32\nX33\nX34\nX35\nX36\nX37"
    "\n"
    "X38\nX39\nX40\nX41\nX42\nX43\nX44\nX45\nX46\nX47\nX48\nX49\nX50\nX51\nX52\nX53\nX54\nX55\nM2"
    "\n";

static void test_a_program_runs_to_its_end_while_the_background_keeps_up(void)
{
    start(many_moves);
    TEST_ASSERT_EQUAL_INT(CONTROLLER_COMPLETED, run(true));
}

/* The path ends at rest where it is known to; the exchanges that were missed are counted. */
static void test_a_background_that_stops_is_waited_for_at_rest_and_counted(void)
{
    start(many_moves);
    TEST_ASSERT_EQUAL_INT(CONTROLLER_RUNNING, run(false));
    TEST_ASSERT_TRUE(takt_controller_get_late(&controller) > 0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_controller_get_record(&controller)->feed_mm_s);
    TEST_ASSERT_TRUE(controller.record.set.at[AXIS_X] < 55.0);
    TEST_ASSERT_EQUAL_INT(CONTROLLER_COMPLETED, run(true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 55.0, controller.record.set.at[AXIS_X]);
}

/*
 * The trapezoidal reference is made to wait at the first stop in every cycle: nothing that the
 * controller knows of explains it.
 */
static void test_a_path_that_is_not_gone_on_along_is_a_fault_with_its_line(void)
{
    start("G21 F3000\nG1 X1\nM2\n");
    for (unsigned i = 0;
         i < CYCLES_MAX && takt_controller_get_state(&controller) < CONTROLLER_COMPLETED; i++) {
        controller.motion.reference.since_minus = -1;
        takt_controller_background(&controller);
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(CONTROLLER_FAULTED, takt_controller_get_state(&controller));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_STALLED, takt_controller_get_fault(&controller)->code);
    TEST_ASSERT_EQUAL_UINT32(2, takt_controller_get_fault(&controller)->line);
}

static void test_an_error_of_the_program_is_the_fault_when_its_moves_are_done(void)
{
    start("G21 F3000 G1 X1\nX2\nX3 ?\nX4\n");
    TEST_ASSERT_EQUAL_INT(CONTROLLER_FAULTED, run(true));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_CHARACTER_UNKNOWN,
                          takt_controller_get_fault(&controller)->code);
    TEST_ASSERT_EQUAL_UINT32(3, takt_controller_get_fault(&controller)->line);
}

static void expect_fault(const char *program, enum takt_error code, uint32_t line)
{
    start(program);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CONTROLLER_FAULTED, run(true), program);
    TEST_ASSERT_EQUAL_INT_MESSAGE(code, takt_controller_get_fault(&controller)->code, program);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(line, takt_controller_get_fault(&controller)->line, program);
}

static void test_probing_that_must_make_contact_fails_when_nothing_answers(void)
{
    expect_fault("F600 G0 X1\nG38.2 Z-2\nG0 X5\n", TAKT_ERROR_PROBE_NO_CONTACT, 2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2.0, controller.record.set.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, controller.record.set.at[AXIS_X]);
    expect_fault("F600\nG38.4 Z-2\n", TAKT_ERROR_PROBE_CLEAR, 2);
}

static void test_probing_that_may_fail_goes_on(void)
{
    start("F600\nG38.3 Z-2\nG0 X#5070 Y3\nM2\n");
    TEST_ASSERT_EQUAL_INT(CONTROLLER_COMPLETED, run(true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2.0, controller.record.set.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0, controller.record.set.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, controller.record.set.at[AXIS_X]);
}

/* There is no contact to lose: G38.5 has found what it looks for in its first cycle, and brakes. */
static void test_probing_away_from_nothing_ends_where_it_begins(void)
{
    start("F600\nG38.5 Z-2\nG0 X#5070\nM2\n");
    TEST_ASSERT_EQUAL_INT(CONTROLLER_COMPLETED, run(true));
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.0, controller.record.set.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, controller.record.set.at[AXIS_X]);
}

static void test_an_involute_is_run_to_its_end(void)
{
    start("F600 G0 X4\nG3.2 X6.283185307 Y4 I-4 R4\nG2.2 X4 Y0 I-6.283185307 J-4 R4 Z1\nM2\n");
    TEST_ASSERT_EQUAL_INT(CONTROLLER_COMPLETED, run(true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, controller.record.set.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, controller.record.set.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, controller.record.set.at[AXIS_Z]);
}

/* Without a spindle nothing ever answers. */
static void test_a_spindle_that_does_not_reach_its_speed_is_a_fault(void)
{
    start("M3 S1000\nG0 X1\nM2\n");
    controller.spindle.at_speed_s = 0.1;
    TEST_ASSERT_EQUAL_INT(CONTROLLER_FAULTED, run(true));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SPINDLE_SLOW, takt_controller_get_fault(&controller)->code);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, controller.record.set.at[AXIS_X]);
}

/* A text that comes while it is read: so much of it has come. */
static const char comes[] = "G21 F600\nG1 X20\nG10 L2 P1 X5\n";
static size_t come, taken;

static long read_what_has_come(void *context, char *buffer, size_t size)
{
    const size_t count = come - taken < size ? come - taken : size;

    (void)context;
    memcpy(buffer, comes + taken, count);
    taken += count;
    return count > 0 ? (long)count : SOURCE_LATER;
}

static void test_nothing_of_a_program_that_was_stopped_at_once_is_read_any_more(void)
{
    const struct source source = {.read = read_what_has_come};

    come = sizeof "G21 F600\nG1 X20\n" - 1;
    taken = 0;
    start_from(&source);
    for (unsigned i = 0; i < CYCLES_MAX && controller.record.set.at[AXIS_X] < 1.0; i++) {
        takt_controller_background(&controller);
        cycle();
    }
    takt_controller_stop_at_once(&controller, TAKT_ERROR_EMERGENCY_STOP);
    come = sizeof comes - 1;
    for (unsigned i = 0; i < 100; i++) {
        takt_controller_background(&controller);
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(CONTROLLER_FAULTED, takt_controller_get_state(&controller));
    TEST_ASSERT_EQUAL_UINT(sizeof "G21 F600\nG1 X20\n" - 1, taken);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_program_runs_to_its_end_while_the_background_keeps_up);
    RUN_TEST(test_a_background_that_stops_is_waited_for_at_rest_and_counted);
    RUN_TEST(test_a_path_that_is_not_gone_on_along_is_a_fault_with_its_line);
    RUN_TEST(test_an_error_of_the_program_is_the_fault_when_its_moves_are_done);
    RUN_TEST(test_probing_that_must_make_contact_fails_when_nothing_answers);
    RUN_TEST(test_probing_that_may_fail_goes_on);
    RUN_TEST(test_probing_away_from_nothing_ends_where_it_begins);
    RUN_TEST(test_an_involute_is_run_to_its_end);
    RUN_TEST(test_a_spindle_that_does_not_reach_its_speed_is_a_fault);
    RUN_TEST(test_nothing_of_a_program_that_was_stopped_at_once_is_read_any_more);
    return UNITY_END();
}
