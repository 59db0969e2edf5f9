/*
 * Probing moves and inputs, from the program to what it is told. Motion is a fake here: it goes
 * along X at 1 mm a cycle, and when it is to stop it goes on for BRAKING_MM.
 */
#include "controller/controller_probe.h"

#include "cutter_compensation/cutter_compensation.h"

#include "program_reader.h"

#define CYCLE_S    0.001
#define BRAKING_MM 2.0
/* The axes are behind their setpoint. */
#define LAG_MM 0.25

static struct reader reader;
static struct cutter_compensation offset;
static struct controller_probe probe;
static struct inputs inputs;
static struct drives drives; /* none: there is no touch probe */
static struct move executed;
static struct point setpoint;
static struct diagnostic error;
/* The probe touches between these places of X. */
static double touches_from_mm, touches_to_mm;

void setUp(void)
{
    memset(&probe, 0, sizeof(probe));
    memset(&setpoint, 0, sizeof(setpoint));
    inputs = inputs_idle();
    touches_from_mm = MATHS_INFINITY;
    touches_to_mm = MATHS_INFINITY;
}

void tearDown(void)
{
}

static void open_text(const char *text)
{
    reader_prepare(&reader);
    reader.config.waits = true;
    reader_text(&reader, text);
    takt_cutter_compensation_open(&offset, &reader.config);
}

/* Reads on to the next move that asks for something. */
static void read_question(void)
{
    enum program_result result;

    while ((result = takt_cutter_compensation_next(&offset, &reader.program, &executed,
                                                   &reader.diagnostic)) == PROGRAM_MOVE) {
        (void)takt_controller_probe_ask(&probe, &executed, CYCLE_S, false);
        if (probe.state == PROBE_ASKED) {
            break;
        }
    }
    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, result);
}

/* Where the axes are, and what the probe says there. */
static struct controller_place look(void)
{
    struct point actual = setpoint;

    actual.at[AXIS_X] -= LAG_MM;
    inputs.probe_contact =
        actual.at[AXIS_X] >= touches_from_mm && actual.at[AXIS_X] < touches_to_mm;
    return (struct controller_place){.reported = actual, .actual = actual};
}

/* The fake motion: the probing move until it ends, or until it has braked. */
static void run_probing(void)
{
    double end_mm = executed.end.at[AXIS_X];

    while (setpoint.at[AXIS_X] < end_mm) {
        setpoint.at[AXIS_X] += 1.0;
        const struct controller_place at = look();

        if (takt_controller_probe_watch(&probe, &executed, &inputs, &at)) {
            end_mm = maths_min(end_mm, setpoint.at[AXIS_X] + BRAKING_MM);
        }
    }
}

/* One cycle at rest. */
static bool rest(void)
{
    const struct controller_place at = look();

    return takt_controller_probe_rest(&probe, &inputs, &drives, &setpoint, &at);
}

static void answer_program(void)
{
    struct program_answer answer;

    TEST_ASSERT_TRUE(takt_controller_probe_take(&probe, &answer, &error));
    TEST_ASSERT_FALSE(takt_controller_probe_take(&probe, &answer, &error));
    takt_cutter_compensation_answer(&offset, &reader.program, &answer);
}

static void probe_and_answer(void)
{
    read_question();
    run_probing();
    TEST_ASSERT_TRUE(rest());
    answer_program();
}

static void expect_rapid_to(double x)
{
    struct move m;

    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, takt_cutter_compensation_next(&offset, &reader.program, &m,
                                                                      &reader.diagnostic));
    TEST_ASSERT_EQUAL_INT(MOVE_RAPID, m.kind);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, x, m.end.at[AXIS_X]);
}

/* Contact in the cycle whose setpoint is 11: the axes are at 10.75 then, and rest at 13. */
static void test_a_probing_move_brakes_at_contact_and_goes_on_from_rest(void)
{
    touches_from_mm = 10.2;
    open_text("F60 G38.2 X30\nG91 G0 X5\nG90 X[#5061] Y[#5070]\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    expect_rapid_to(18.0);
    expect_rapid_to(10.75);
}

static void test_a_move_away_brakes_when_contact_is_lost(void)
{
    touches_from_mm = -1.0;
    touches_to_mm = 4.5;
    open_text("F60 G38.4 X30\nG0 X[#5061]\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    TEST_ASSERT_TRUE(setpoint.at[AXIS_X] == 7.0);
    expect_rapid_to(4.75);
}

/* A probe that bounces while the axes brake is not asked again. */
static void test_the_first_contact_counts(void)
{
    touches_from_mm = 10.2;
    touches_to_mm = 11.0;
    open_text("F60 G38.2 X30\nG0 X[#5061]\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    expect_rapid_to(10.75);
}

static void test_a_move_that_must_find_contact_fails_without(void)
{
    open_text("G0 X0\nF60 G38.2 X30\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROBE_NO_CONTACT, error.code);
    TEST_ASSERT_EQUAL_UINT32(2, error.line);
}

static void test_a_move_away_that_must_lose_contact_fails_with_it(void)
{
    touches_from_mm = -1.0;
    open_text("F60 G38.4 X30\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROBE_NO_RELEASE, error.code);
}

static void test_an_optional_move_goes_to_its_end_without_contact(void)
{
    open_text("F60 G38.3 X30\nG0 X[#5061+#5070+1]\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    TEST_ASSERT_TRUE(setpoint.at[AXIS_X] == 30.0);
    expect_rapid_to(31.0);
}

static void test_contact_at_the_start_is_an_error_and_stops_the_move(void)
{
    touches_from_mm = -1.0;
    open_text("F60 G38.2 X30\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROBE_TOUCHES, error.code);
    TEST_ASSERT_TRUE(setpoint.at[AXIS_X] == 1.0 + BRAKING_MM);
}

static void test_no_contact_at_the_start_of_a_move_away_is_an_error(void)
{
    open_text("F60 G38.4 X30\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROBE_CLEAR, error.code);
}

static void test_an_optional_move_may_begin_in_contact_and_ends_at_once(void)
{
    touches_from_mm = -1.0;
    open_text("F60 G38.3 X30\nG0 X[#5061] Y[#5070]\n");
    probe_and_answer();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    expect_rapid_to(0.75);
}

/* The axes reach 29.75 with the last setpoint, and 30 when they have caught up. */
static void test_contact_while_the_axes_catch_up_at_the_end_still_counts(void)
{
    touches_from_mm = 29.9;
    open_text("F60 G38.2 X30\nG0 X[#5061]\n");
    read_question();
    run_probing();
    inputs.probe_contact = true;
    TEST_ASSERT_TRUE(takt_controller_probe_rest(
        &probe, &inputs, &drives, &setpoint,
        &(struct controller_place){.reported = setpoint, .actual = setpoint}));
    answer_program();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    expect_rapid_to(30.0);
}

static void test_an_optional_move_without_way_still_tells_what_the_probe_says(void)
{
    touches_from_mm = -1.0;
    open_text("F60 G38.3 X0\nG0 X[#5070+2]\n");
    read_question();
    TEST_ASSERT_TRUE(rest());
    answer_program();
    expect_rapid_to(3.0);
}

static void test_other_motions_do_not_ask_the_probe(void)
{
    touches_from_mm = -1.0;
    open_text("F60 G38.2 X30\n");
    read_question();
    executed.kind = MOVE_FEED;
    const struct controller_place at = look();

    TEST_ASSERT_FALSE(takt_controller_probe_watch(&probe, &executed, &inputs, &at));
}

static void expect_value(double value)
{
    answer_program();
    TEST_ASSERT_EQUAL_INT(TAKT_OK, error.code);
    TEST_ASSERT_TRUE(takt_parameters_get(&reader.parameters, PARAMETER_INPUT) == value);
}

static void test_inputs_are_read_at_once(void)
{
    inputs.digital = 1U << 31;
    inputs.analogue[3] = -2.5;
    open_text("M66 P31 L0\nM66 P30\nM66 E3\n");
    read_question();
    TEST_ASSERT_TRUE(rest());
    expect_value(1.0);
    read_question();
    TEST_ASSERT_TRUE(rest());
    expect_value(0.0);
    read_question();
    TEST_ASSERT_TRUE(rest());
    expect_value(-2.5);
}

/*
 * Sets the level of input 2 cycle by cycle, from a text of 0 and 1; returns after how many the
 * answer came, 0: never.
 */
static unsigned cycles_until_answered(const char *program, const char *levels)
{
    memset(&probe, 0, sizeof(probe));
    open_text(program);
    read_question();
    for (unsigned i = 0; levels[i] != '\0'; i++) {
        inputs.digital = levels[i] == '1' ? 4U : 0U;
        if (rest()) {
            return i + 1;
        }
    }
    return 0;
}

static void test_waiting_ends_with_the_level_or_the_change_that_is_waited_for(void)
{
    TEST_ASSERT_EQUAL_UINT(5, cycles_until_answered("M66 P2 L1 Q1\n", "110010"));
    expect_value(1.0);
    TEST_ASSERT_EQUAL_UINT(5, cycles_until_answered("M66 P2 L2 Q1\n", "00110"));
    expect_value(0.0);
    TEST_ASSERT_EQUAL_UINT(3, cycles_until_answered("M66 P2 L3 Q1\n", "001"));
    expect_value(1.0);
    TEST_ASSERT_EQUAL_UINT(1, cycles_until_answered("M66 P2 L3 Q1\n", "100"));
    expect_value(1.0);
    TEST_ASSERT_EQUAL_UINT(2, cycles_until_answered("M66 P2 L4 Q1\n", "101"));
    expect_value(0.0);
    TEST_ASSERT_EQUAL_UINT(0, cycles_until_answered("M66 P2 L1 Q1\n", "111111"));
}

/* 3 ms are three cycles after the first look. */
static void test_waiting_ends_when_its_time_is_over(void)
{
    TEST_ASSERT_EQUAL_UINT(4, cycles_until_answered("M66 P2 L3 Q0.003\n", "0000000"));
    expect_value(-1.0);
    TEST_ASSERT_EQUAL_UINT(4, cycles_until_answered("M66 P2 L3 Q0.003\n", "0001"));
    expect_value(1.0);
}

static void test_any_time_can_be_waited_for(void)
{
    TEST_ASSERT_EQUAL_UINT(0, cycles_until_answered("M66 P2 L3 Q[10**300]\n", "0000"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_probing_move_brakes_at_contact_and_goes_on_from_rest);
    RUN_TEST(test_a_move_away_brakes_when_contact_is_lost);
    RUN_TEST(test_the_first_contact_counts);
    RUN_TEST(test_a_move_that_must_find_contact_fails_without);
    RUN_TEST(test_a_move_away_that_must_lose_contact_fails_with_it);
    RUN_TEST(test_an_optional_move_goes_to_its_end_without_contact);
    RUN_TEST(test_contact_at_the_start_is_an_error_and_stops_the_move);
    RUN_TEST(test_no_contact_at_the_start_of_a_move_away_is_an_error);
    RUN_TEST(test_an_optional_move_may_begin_in_contact_and_ends_at_once);
    RUN_TEST(test_contact_while_the_axes_catch_up_at_the_end_still_counts);
    RUN_TEST(test_an_optional_move_without_way_still_tells_what_the_probe_says);
    RUN_TEST(test_other_motions_do_not_ask_the_probe);
    RUN_TEST(test_inputs_are_read_at_once);
    RUN_TEST(test_waiting_ends_with_the_level_or_the_change_that_is_waited_for);
    RUN_TEST(test_waiting_ends_when_its_time_is_over);
    RUN_TEST(test_any_time_can_be_waited_for);
    return UNITY_END();
}
