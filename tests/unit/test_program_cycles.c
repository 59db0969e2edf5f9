/* Drilling cycles and G76: their moves one by one, and what they leave behind. */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_feed(double x, double y, double z)
{
    (void)reader_expect(&reader, MOVE_FEED, x, y, z);
}

static void test_a_hole_is_reached_above_drilled_and_left_to_r(void)
{
    reader_open(&reader, "G0 Z10 F60\nG81 X5 Y6 Z-4 R2\nX7");
    reader_expect_rapid(&reader, 0.0, 0.0, 10.0);
    reader_expect_rapid(&reader, 5.0, 6.0, 10.0);
    reader_expect_rapid(&reader, 5.0, 6.0, 2.0);
    expect_feed(5.0, 6.0, -4.0);
    reader_expect_rapid(&reader, 5.0, 6.0, 2.0);
    reader_expect_rapid(&reader, 7.0, 6.0, 2.0);
    expect_feed(7.0, 6.0, -4.0);
    reader_expect_rapid(&reader, 7.0, 6.0, 2.0);
    reader_expect_end(&reader);
}

static void test_pecks_go_back_to_r_and_come_to_where_they_cut(void)
{
    reader_open(&reader, "G0 Z2 F60\nG83 X0 Z-4 R2 Q2.5");
    reader_expect_rapid(&reader, 0.0, 0.0, 2.0);
    expect_feed(0.0, 0.0, -0.5);
    reader_expect_rapid(&reader, 0.0, 0.0, 2.0);
    reader_expect_rapid(&reader, 0.0, 0.0, -0.246);
    expect_feed(0.0, 0.0, -3.0);
    reader_expect_rapid(&reader, 0.0, 0.0, 2.0);
    reader_expect_rapid(&reader, 0.0, 0.0, -2.746);
    expect_feed(0.0, 0.0, -4.0);
    reader_expect_rapid(&reader, 0.0, 0.0, 2.0);
    reader_expect_end(&reader);
}

static void test_no_number_of_pecks_needs_room(void)
{
    struct move move;
    unsigned cuts = 0;

    reader_open(&reader, "G0 Z0 F60\nG73 X0 Z-400 R0 Q0.05 M2");
    for (;;) {
        TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE,
                              takt_program_next(&reader.program, &move, &reader.diagnostic));
        if (move.kind == MOVE_END) {
            break;
        }
        cuts += move.kind == MOVE_FEED ? 1 : 0;
    }
    TEST_ASSERT_UINT_WITHIN(1, 8000, cuts);
}

static void test_too_many_pecks_are_a_mistake(void)
{
    reader_open(&reader, "F60\nG83 X0 Z-400 R0 Q0.0001\nG0 X1");
    reader_expect_error(&reader, TAKT_ERROR_CYCLE_TOO_LONG);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
}

static void test_too_many_cuts_are_a_mistake(void)
{
    reader_open(&reader, "M3 S100\nG76 P1 Z-5 I-1 J0.0001 K5 R9");
    (void)reader_next(&reader, MOVE_SPINDLE);
    reader_expect_error(&reader, TAKT_ERROR_CYCLE_TOO_LONG);
}

/* The first cut is at X 499.7, the last one at 500.5, beyond the end of travel. */
static void test_the_last_cut_of_a_thread_is_looked_at_before_the_first(void)
{
    reader_open(&reader, "M3 S100\nG0 X498\nG76 P1 Z-5 I1.5 J0.2 K1\nG0 X1");
    (void)reader_next(&reader, MOVE_SPINDLE);
    reader_expect_rapid(&reader, 498.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    TEST_ASSERT_EQUAL_DOUBLE(500.5, reader.diagnostic.value);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
}

/* Travel ends at 500; the sixth of the holes would be at 510. Nothing of the line moves. */
static void test_the_last_hole_is_looked_at_before_the_first(void)
{
    reader_open(&reader, "F60 G91\nG81 X85 Z-1 R0 L6\nG90 G0 X1");
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    TEST_ASSERT_EQUAL_DOUBLE(510.0, reader.diagnostic.value);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
}

static void test_a_line_with_an_error_leaves_the_cycle_as_it_was(void)
{
    reader_open(&reader, "F60\nG81 X1 Z-1 R0\nX2 Z5\nX3");
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
    expect_feed(1.0, 0.0, -1.0);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_CYCLE_UPSIDE_DOWN);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, reader.diagnostic.value);
    reader_expect_rapid(&reader, 3.0, 0.0, 0.0);
    expect_feed(3.0, 0.0, -1.0);
}

static void test_the_end_of_the_line_waits_for_the_cycle(void)
{
    reader_open(&reader, "F60\nM8 G81 X1 Z-1 R0 M0");
    (void)reader_next(&reader, MOVE_COOLANT);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
    expect_feed(1.0, 0.0, -1.0);
    reader_expect_rapid(&reader, 1.0, 0.0, 0.0);
    (void)reader_next(&reader, MOVE_STOP);
    reader_expect_end(&reader);
}

static void test_tapping_turns_the_spindle_back_and_takes_no_override(void)
{
    struct move move;

    reader_open(&reader, "M3 S100 F60\nG84 X0 Z-1 R0 P0.5");
    (void)reader_next(&reader, MOVE_SPINDLE);
    move = reader_next(&reader, MOVE_FEED);
    TEST_ASSERT_EQUAL_UINT(OVERRIDE_HOLD, move.overrides);
    TEST_ASSERT_EQUAL_INT(SPINDLE_OFF, reader_next(&reader, MOVE_SPINDLE).direction);
    move = reader_next(&reader, MOVE_SPINDLE);
    TEST_ASSERT_EQUAL_INT(SPINDLE_CCW, move.direction);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, move.speed_rpm);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, reader_next(&reader, MOVE_DWELL).dwell_s);
    expect_feed(0.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(SPINDLE_OFF, reader_next(&reader, MOVE_SPINDLE).direction);
    TEST_ASSERT_EQUAL_INT(SPINDLE_CW, reader_next(&reader, MOVE_SPINDLE).direction);
    reader_expect_end(&reader);
}

static void test_a_cycle_keeps_to_the_path_whatever_g64_says(void)
{
    reader_open(&reader, "F60 G64 P0.1\nG81 X1 Z-1 R0\nG0 X2");
    TEST_ASSERT_EQUAL_INT(PATH_EXACT, reader_next(&reader, MOVE_RAPID).path);
    TEST_ASSERT_EQUAL_INT(PATH_EXACT, reader_next(&reader, MOVE_FEED).path);
    TEST_ASSERT_EQUAL_INT(PATH_EXACT, reader_next(&reader, MOVE_RAPID).path);
    TEST_ASSERT_EQUAL_INT(PATH_BLEND, reader_next(&reader, MOVE_RAPID).path);
}

/*
 * With R2 the cuts are 0.3 sqrt(n) deep below the crest at 4 mm from the drive line; n = 12 would
 * pass 1.0.
 */
static void test_a_thread_is_cut_to_equal_areas(void)
{
    reader_open(&reader, "M3 S60\nG0 X20\nG76 P1.5 Z-10 I-4 J0.3 K1 R2");
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_RAPID);
    for (unsigned n = 1; n <= 12; n++) {
        const double depth = 4.0 + maths_min(0.3 * maths_sqrt(n), 1.0);

        if (n < 12) {
            reader_expect_rapid(&reader, 20.0 + 5.0 - depth, 0.0, 0.0);
        }
        reader_expect_rapid(&reader, 20.0 - depth, 0.0, 0.0);
        const struct move cut = reader_expect(&reader, MOVE_THREAD, 20.0 - depth, 0.0, -10.0);

        TEST_ASSERT_EQUAL_DOUBLE(1.5, cut.feed_rev_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.5, cut.feed_mm_s);
        reader_expect_rapid(&reader, 20.0 + 5.0 - depth, 0.0, -10.0);
        if (n == 11) {
            reader_expect_rapid(&reader, 20.0, 0.0, 0.0);
        }
    }
    reader_expect_end(&reader);
}

static void test_a_spindle_that_stands_cannot_tap(void)
{
    reader_open(&reader, "F60 S100\nG84 X1 Z-1 R0\nM4\nG84 X1 Z-1 R0");
    reader_expect_error(&reader, TAKT_ERROR_SPINDLE_STANDS);
    (void)reader_next(&reader, MOVE_SPINDLE);
    reader_expect_error(&reader, TAKT_ERROR_SPINDLE_WRONG_WAY);
    TEST_ASSERT_EQUAL_STRING("G84", reader.diagnostic.word);
}

/* A feed per revolution needs its speed alone. */
static void test_a_spindle_without_an_encoder_cuts_no_thread(void)
{
    static const char *const threads[] = {"M3 S100\nG33 Z-5 K1", "M3 S100\nG33.1 Z-5 K1",
                                          "M3 S100\nG76 P1 Z-5 I-1 J0.1 K0.5"};

    for (unsigned i = 0; i < 3; i++) {
        reader_prepare(&reader);
        reader.config.spindle_encoder = false;
        reader_text(&reader, threads[i]);
        (void)reader_next(&reader, MOVE_SPINDLE);
        reader_expect_error(&reader, TAKT_ERROR_SPINDLE_NO_ENCODER);
    }
    reader_prepare(&reader);
    reader.config.spindle_encoder = false;
    reader_text(&reader, "M3 S100\nG95 F0.1 G1 X1");
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_FEED);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hole_is_reached_above_drilled_and_left_to_r);
    RUN_TEST(test_pecks_go_back_to_r_and_come_to_where_they_cut);
    RUN_TEST(test_no_number_of_pecks_needs_room);
    RUN_TEST(test_too_many_pecks_are_a_mistake);
    RUN_TEST(test_too_many_cuts_are_a_mistake);
    RUN_TEST(test_the_last_cut_of_a_thread_is_looked_at_before_the_first);
    RUN_TEST(test_the_last_hole_is_looked_at_before_the_first);
    RUN_TEST(test_a_line_with_an_error_leaves_the_cycle_as_it_was);
    RUN_TEST(test_the_end_of_the_line_waits_for_the_cycle);
    RUN_TEST(test_tapping_turns_the_spindle_back_and_takes_no_override);
    RUN_TEST(test_a_cycle_keeps_to_the_path_whatever_g64_says);
    RUN_TEST(test_a_thread_is_cut_to_equal_areas);
    RUN_TEST(test_a_spindle_that_stands_cannot_tap);
    RUN_TEST(test_a_spindle_without_an_encoder_cuts_no_thread);
    return UNITY_END();
}
