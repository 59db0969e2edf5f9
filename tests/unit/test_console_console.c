/* The console on a service in virtual time: what a sender says and hears, and the axes do. */
#include "console_bench.h"

void setUp(void)
{
    console_bench_set_up(0);
}

void tearDown(void)
{
}

static double place(unsigned axis)
{
    return service.controller.record.set.at[axis];
}

static void test_a_sender_is_welcomed_and_every_line_is_answered_once(void)
{
    expect("\r\nGrbl 1.1h ['$' for help]\r\n");
    forget();
    give("\n\r\nG21\r\n(a comment)\nG1 X1 F600\n$\n$$\n$#\n$G\n$I\n$N\n");
    await(11);
    steps(300);
    TEST_ASSERT_EQUAL_UINT(11, count_of("ok\r\n"));
}

static const char winding[] =
    "G21 G90 G17 G64 P0.02\nG0 Z1\nF2400\n"
    "G1 X1 Y0.2\nX2 Y0.8\nX3 Y1.1\nX4 Y0.7\nX5 Y-0.3\nX6 Y-0.9\nX7 Y-1\nX8 Y-0.2\nX9 Y0.6\nX10 Y1\n"
    "M3 S1000\nG4 P0.1\nX9 Y2\nX8 Y2.5\nX7 Y2.4\nX6 Y3\nG0 X0 Y0\nG2 X4 Y0 I2 J0\nM30\n";

static uint64_t digest_of_file(void)
{
    load(winding);
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_IDLE);
    return service.digest;
}

/* From the first motion to the last: every setpoint of the program. */
static void test_streamed_text_gives_the_setpoints_of_the_same_text_in_a_file(void)
{
    const uint64_t expected = digest_of_file();

    setUp();
    forget();
    give(winding);
    await(22);
    settle();
    TEST_ASSERT_EQUAL_UINT(22, count_of("ok\r\n"));
    TEST_ASSERT_EQUAL_UINT64(expected, service.digest);
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 0.0);
}

/* One line, and the next when it is answered. */
static void test_simple_streaming_gives_the_same_setpoints_too(void)
{
    const uint64_t expected = digest_of_file();
    unsigned lines_given = 0;

    setUp();
    forget();
    for (const char *line = winding; *line != '\0'; line = strchr(line, '\n') + 1) {
        char text[80] = "";

        memcpy(text, line, (size_t)(strchr(line, '\n') + 1 - line));
        give(text);
        await(++lines_given);
    }
    settle();
    TEST_ASSERT_EQUAL_UINT64(expected, service.digest);
}

static void test_a_sender_that_stalls_finds_the_axes_at_rest_and_they_go_on(void)
{
    give("G64 P0.05 F6000\nG1 X10\nG1 X20 Y1\n");
    steps(1000);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, place(AXIS_X));
    TEST_ASSERT_EQUAL_INT(PANEL_IDLE, takt_service_get_state(&service));
    give("X30 Y2\nX40 Y3\n"); /* the modes are those of before */
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(40.0, place(AXIS_X));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, place(AXIS_Y));
    expect_limits_kept();
}

/* Each line comes when the axes have come to rest, or nearly, and none as late as an end. */
static void test_a_sender_that_is_slow_is_waited_for_between_lines(void)
{
    static const char *const slow[] = {
        "F3000\n", "(text alone)\n", "G1 X0.5\n", "X1\n",       "X1.5\n", "M8\n", "X2\n",
        "X3 Y1\n", "X4\n",           "M9\n",      "G4 P0.02\n", "X5\n",   "X6\n", "X7\n",
        "X8\n",    "X9\n",           "X10\n",     "X11\n",      "M5\n",   "M2\n"};

    forget();
    for (unsigned i = 0; i < sizeof slow / sizeof slow[0]; i++) {
        give(slow[i]);
        steps(90);
    }
    await(20);
    settle();
    TEST_ASSERT_EQUAL_UINT(20, count_of("ok\r\n"));
    TEST_ASSERT_EQUAL_DOUBLE(11.0, place(AXIS_X));
    expect_limits_kept();
}

static void test_a_wrong_line_is_refused_alone(void)
{
    forget();
    give("G1 X1 F600\nG1 X\nG1 X2 Q\nG77\nG1 Y2\n");
    await(5);
    settle();
    TEST_ASSERT_EQUAL_UINT(2, count_of("ok\r\n"));
    expect("ok\r\n[MSG:");
    TEST_ASSERT_EQUAL_DOUBLE(1.0, place(AXIS_X));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, place(AXIS_Y));
}

static void test_a_line_beyond_the_travel_stops_all_until_it_is_unlocked(void)
{
    forget();
    give("G1 X5 F3000\nG1 X600\nG1 Y7\nG0 Z1\n");
    await(4);
    TEST_ASSERT_EQUAL_UINT(1, count_of("error:15\r\n"));
    TEST_ASSERT_EQUAL_UINT(1, count_of("ALARM:2\r\n"));
    TEST_ASSERT_EQUAL_UINT(2, count_of("error:9\r\n"));
    expect_status("<Alarm|");
    ask("$X", "ok");
    ask("G1 Y1 F3000", "ok");
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(5.0, place(AXIS_X));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, place(AXIS_Y));
    expect_limits_kept();
}

static void test_a_hold_stops_on_the_path_and_a_start_goes_on(void)
{
    give("G1 X50 F3000\n");
    steps(500);
    give("!");
    steps(300);
    expect_status("<Hold:0|");
    TEST_ASSERT_TRUE(place(AXIS_X) > 1.0 && place(AXIS_X) < 49.0);
    give("~");
    step();
    expect_status("<Run|");
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(50.0, place(AXIS_X));
    expect_limits_kept();
}

static void test_a_reset_gives_up_what_runs_and_forgets_what_was_to_come(void)
{
    give("G1 X50 F3000\nX60\nX70\n");
    steps(500);
    forget();
    give("\x18");
    settle();
    expect("\r\nGrbl 1.1h ['$' for help]\r\n");
    TEST_ASSERT_TRUE(place(AXIS_X) < 49.0);
    TEST_ASSERT_EQUAL_UINT(0, answers());
    expect_status("<Idle|");
    expect_limits_kept();
}

/* Lines that wait behind a full look-ahead are no errors of the sender's. */
static void test_a_reset_answers_no_line_that_it_drops(void)
{
    char line[32];

    for (unsigned i = 1; i < 1500; i++) {
        (void)snprintf(line, sizeof line, "G1 X%.2f F3000\n", 0.1 * i);
        give(line);
    }
    TEST_ASSERT_TRUE(console.pending > 1);
    forget();
    give("\x18");
    settle();
    TEST_ASSERT_EQUAL_UINT(0, answers());
    expect("\r\nGrbl 1.1h ['$' for help]\r\n");
    ask("G4 P0.1", "ok");
}

static void test_jogs_move_by_words_of_their_own(void)
{
    ask("G21 G90 G0 X10", "ok");
    settle();
    ask("$J=G91 X2.5 F3000", "ok");
    expect_status("<Jog|");
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(12.5, place(AXIS_X));
    ask("$J=G20 G90 Y1 F100", "ok");
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(25.4, place(AXIS_Y));
    ask("$J=X600 F100", "error:15");
    ask("$J=X1", "error:22");
    ask("$J=F100", "error:26");
    ask("$J=G2 X1 F100", "error:16");
    ask("$J=M3 X1 F100", "error:16");
    ask("X5", "ok"); /* as G0 before: a jog leaves no modes */
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(5.0, place(AXIS_X));
}

static void test_a_jog_is_cancelled_at_once_and_when_its_sender_goes(void)
{
    ask("$J=X100 F3000", "ok");
    steps(300);
    give("\x85");
    settle();
    TEST_ASSERT_TRUE(place(AXIS_X) < 30.0);
    ask("$J=X100 F3000", "ok");
    steps(300);
    takt_console_leave(&console);
    settle();
    TEST_ASSERT_TRUE(place(AXIS_X) < 60.0);
    expect_limits_kept();
}

static void test_overrides_are_those_of_the_panel(void)
{
    give("\x91\x91\x94");
    TEST_ASSERT_EQUAL_INT64(1190, shown(REGISTER_FEED_OVERRIDE));
    give("\x91");
    TEST_ASSERT_EQUAL_INT64(1200, shown(REGISTER_FEED_OVERRIDE));
    for (unsigned i = 0; i < 20; i++)
        give("\x92");
    TEST_ASSERT_EQUAL_INT64(100, shown(REGISTER_FEED_OVERRIDE));
    give("\x90\x96\x9a\x9d");
    TEST_ASSERT_EQUAL_INT64(1000, shown(REGISTER_FEED_OVERRIDE));
    TEST_ASSERT_EQUAL_INT64(500, shown(REGISTER_RAPID_OVERRIDE));
    TEST_ASSERT_EQUAL_INT64(1090, shown(REGISTER_SPINDLE_OVERRIDE));
    expect_status("|Ov:100,50,109");
    give("\xa0\xa1");
    expect_status("|A:FM>");
    give("\xa0");
    expect_status("|A:M>");
}

static void test_the_spindle_stands_in_a_hold_and_turns_before_the_axes_go_on(void)
{
    give("M3 S1000\nG1 X50 F3000\n");
    steps(600);
    give("!");
    steps(300);
    give("\x9e");
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 0.0);
    world.spindle.at_speed = false;
    give("~");
    steps(50);
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 1000.0);
    expect_status("<Hold:0|");
    world.spindle.at_speed = true;
    steps(10);
    expect_status("<Run|");
    settle();
}

static void test_settings_are_read_and_only_those_of_reports_are_set(void)
{
    forget();
    give("$$\n");
    await(1);
    expect("$110=6000.000\r\n");
    expect("$120=1000.000\r\n");
    expect("$130=1000.000\r\n");
    ask("$110=6000", "ok");
    ask("$110=5000", "error:3");
    ask("$999=1", "error:3");
    ask("$10=x", "error:2");
    ask("$10=0", "ok");
    expect_status("|WPos:");
    ask("$Q", "error:3");
}

static void test_it_tells_what_it_has_been_built_with_in_the_letters_of_grbl(void)
{
    forget();
    ask("$I", "ok");
    expect("[VER:1.1h.takt-test:");
    expect("[OPT:VM*$IL,127,1023]"); /* not what is free just now */
    ask("$RST=$", "error:3");
    ask("$RST=*", "error:3");
    ask("$I=mill", "error:3");
}

static void test_offsets_are_told_and_set_to_zero(void)
{
    ask("G10 L2 P2 X12.5 Y-3", "ok");
    settle();
    ask("$#", "[G55:12.500,-3.000,0.000]\r\n");
    ask("G55", "ok");
    settle();
    expect_status("|WCO:12.500,-3.000,0.000");
    ask("$G", "[GC:G80 G55 ");
    ask("G59.1", "ok");
    settle();
    ask("$G", "[GC:G80 G59.1 ");
    ask("$RST=#", "ok");
    settle();
    ask("$#", "[G55:0.000,0.000,0.000]\r\n");
}

static void test_reports_in_inches_have_four_decimals(void)
{
    ask("G10 L2 P2 X25.4 Y-1", "ok");
    settle();
    ask("$13=1", "ok");
    ask("$#", "[G55:1.0000,-0.0394,0.0000]\r\n");
    ask("$#", "[TLO:0.0000]\r\n");
    ask("$13=0", "ok");
    ask("$#", "[G55:25.400,-1.000,0.000]\r\n");
}

static void test_modes_are_told_word_by_word(void)
{
    ask("$G", "[GC:G80 G54 G17 G21 G90 G94 G61 M5 M9 T0 F0 S0]\r\n");
    ask("G18 G91 G64 F600 S500", "ok");
    ask("M61 Q3", "ok");
    ask("M3 M7", "ok");
    settle();
    ask("$G", "[GC:G80 G54 G18 G21 G91 G94 G64 M3 M7 T3 F600 S500]\r\n");
    ask("M4 M8 G20 G93", "ok");
    settle();
    ask("$G", "[GC:G80 G54 G18 G20 G91 G93 G64 M4 M7 M8 T3 F0 S500]\r\n");
    ask("S0.5 M3", "ok");
    settle();
    ask("$G", " G64 M3 M7 M8 ");
}

static void test_homing_is_answered_when_the_axes_are_there(void)
{
    ask("G0 X3 Y4", "ok");
    settle();
    ask("$H", "ok");
    TEST_ASSERT_EQUAL_DOUBLE(0.0, place(AXIS_X));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, place(AXIS_Y));
}

/* More text is waited for 0.1 s; none can come before the answer to this line. */
static void test_a_line_that_needs_rest_does_not_wait_for_more_text(void)
{
    forget();
    give("G4 P0.01\n$SLP\n");
    steps(50);
    TEST_ASSERT_EQUAL_UINT(2, count_of("ok\r\n"));
}

static void test_sleep_ends_by_a_reset(void)
{
    ask("$SLP", "ok");
    steps(10);
    expect_status("<Sleep|");
    ask("G0 X1", "error:9");
    give("\x18");
    settle();
    ask("G0 X1", "ok");
}

static void claim_control(void)
{
    const struct panel_order claim = {.count = 1, .item = {{REGISTER_WATCHDOG, 60000}}};

    TEST_ASSERT_EQUAL_INT(PANEL_REFUSAL_NONE, takt_panel_client_order(&other, &claim));
}

static void test_while_another_panel_has_control_the_sender_may_only_hold(void)
{
    give("G1 X50 F3000\n");
    steps(300);
    claim_control();
    give("!");
    steps(300);
    expect_status("<Hold:0|");
    give("~");
    steps(10);
    expect_status("<Hold:0|");
    forget();
    give("\x18");
    steps(10);
    expect("another panel has control");
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
}

static void test_an_emergency_stop_by_anyone_is_an_alarm(void)
{
    const struct panel_order stop = {.count = 1, .item = {{REGISTER_EMERGENCY_STOP, 1}}};

    give("G1 X50 F3000\nX60\n");
    steps(300);
    forget();
    TEST_ASSERT_EQUAL_INT(PANEL_REFUSAL_NONE, takt_panel_client_order(&other, &stop));
    steps(10);
    expect("ALARM:");
    ask("G0 X1", "error:9");
    ask("$X", "error:9");
    expect_status("<Alarm|");
}

static void test_a_program_that_another_gives_up_does_not_go_on_by_itself(void)
{
    const struct panel_order give_up = {.count = 1, .item = {{REGISTER_RESET, 1}}};

    give("G1 X50 F3000\nX60\nX70\n");
    steps(300);
    TEST_ASSERT_EQUAL_INT(PANEL_REFUSAL_NONE, takt_panel_client_order(&other, &give_up));
    steps(500);
    ask("X80", "error:9");
    ask("$X", "ok");
    ask("G1 X0 F3000", "ok");
    settle();
}

static void test_the_password_is_asked_for(void)
{
    console_bench_set_up(4711);
    ask("G0 X1", "error:9");
    ask("$PW=4711", "ok");
    ask("G0 X1", "ok");
    settle();
}

static void test_lines_of_others_while_a_program_of_the_panel_runs_are_refused(void)
{
    load(winding);
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    ask("G0 X1", "error:9");
    expect_status("<Run|");
    ask("$J=X1 F100", "error:8");
    settle();
}

static void test_a_line_that_is_too_long_is_refused_in_its_turn(void)
{
    char line[400];

    memset(line, 'X', sizeof line);
    line[sizeof line - 1] = '\0';
    forget();
    give("G0 X1\n");
    give(line);
    give("\nG0 X2\n");
    await(3);
    expect("ok\r\nerror:11\r\nok\r\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_sender_is_welcomed_and_every_line_is_answered_once);
    RUN_TEST(test_streamed_text_gives_the_setpoints_of_the_same_text_in_a_file);
    RUN_TEST(test_simple_streaming_gives_the_same_setpoints_too);
    RUN_TEST(test_a_sender_that_stalls_finds_the_axes_at_rest_and_they_go_on);
    RUN_TEST(test_a_sender_that_is_slow_is_waited_for_between_lines);
    RUN_TEST(test_a_wrong_line_is_refused_alone);
    RUN_TEST(test_a_line_beyond_the_travel_stops_all_until_it_is_unlocked);
    RUN_TEST(test_a_hold_stops_on_the_path_and_a_start_goes_on);
    RUN_TEST(test_a_reset_gives_up_what_runs_and_forgets_what_was_to_come);
    RUN_TEST(test_a_reset_answers_no_line_that_it_drops);
    RUN_TEST(test_jogs_move_by_words_of_their_own);
    RUN_TEST(test_a_jog_is_cancelled_at_once_and_when_its_sender_goes);
    RUN_TEST(test_overrides_are_those_of_the_panel);
    RUN_TEST(test_the_spindle_stands_in_a_hold_and_turns_before_the_axes_go_on);
    RUN_TEST(test_settings_are_read_and_only_those_of_reports_are_set);
    RUN_TEST(test_it_tells_what_it_has_been_built_with_in_the_letters_of_grbl);
    RUN_TEST(test_offsets_are_told_and_set_to_zero);
    RUN_TEST(test_reports_in_inches_have_four_decimals);
    RUN_TEST(test_modes_are_told_word_by_word);
    RUN_TEST(test_homing_is_answered_when_the_axes_are_there);
    RUN_TEST(test_a_line_that_needs_rest_does_not_wait_for_more_text);
    RUN_TEST(test_sleep_ends_by_a_reset);
    RUN_TEST(test_while_another_panel_has_control_the_sender_may_only_hold);
    RUN_TEST(test_an_emergency_stop_by_anyone_is_an_alarm);
    RUN_TEST(test_a_program_that_another_gives_up_does_not_go_on_by_itself);
    RUN_TEST(test_the_password_is_asked_for);
    RUN_TEST(test_lines_of_others_while_a_program_of_the_panel_runs_are_refused);
    RUN_TEST(test_a_line_that_is_too_long_is_refused_in_its_turn);
    return UNITY_END();
}
