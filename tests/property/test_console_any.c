/*
 * Any bytes for the console: nothing breaks, and every line gets exactly one answer. Without
 * resets, which drop lines; with them, the console still answers afterwards.
 */
#include "console_bench.h"
#include "property_arguments.h"

#include <stdio.h>

#define BYTES_OF_A_CASE 400

static unsigned number = 100, first = 1;
static uint64_t state;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t draw(uint32_t below)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(state >> 33) % below;
}

static const char *const pieces[] = {
    "G0",  "G1",   "X1",   "Y-2.5",   "Z.5",   "F600", "F0",   "G91", "G90", "G2",   "I1",
    "M3",  "S500", "M5",   "$",       "$J=",   "$H",   "$X",   "$G",  "$#",  "$10",  "=",
    "$C",  "$I",   "$SLP", "G4P0.01", "M2",    "%",    "(",    ")",   ";",   "#1=2", "[1+",
    "G10", "L2",   "P1",   "G92",     "G38.2", "Z-1",  "T1M6", "o1",  "if",  "G41",  "D1",
    "G40", "X600", "\t",   "\r",      "G53",   "G20",  "G21",  "$$",
};

/* The console hears them as line ends: CR, LF, both. */
static unsigned ends;
static bool has_return;

static void give_byte(uint8_t byte)
{
    if (byte == 0x18)
        return;
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && !takt_console_has_room(&console); i++)
        step();
    takt_console_take(&console, byte);
    ends += byte == '\r' || (byte == '\n' && !has_return);
    if (byte < 0x80 && byte != '?' && byte != '!' && byte != '~')
        has_return = byte == '\r';
}

static void give_piece(void)
{
    const uint32_t kind = draw(20);

    if (kind == 0) {
        give_byte((uint8_t)draw(256));
    } else if (kind < 5) {
        give_byte('\n');
    } else {
        for (const char *c = pieces[draw(sizeof pieces / sizeof pieces[0])]; *c != '\0'; c++)
            give_byte((uint8_t)*c);
    }
}

/*
 * The longest way there is at the lowest feed of the pieces, F2 in inches at 10 %, takes hours;
 * most take a second.
 */
#define PATIENCE_CYCLES 60000U

/* A hold may have been among the bytes: it is ended, as long as anything waits. */
static void await_answers(void)
{
    for (unsigned i = 0; i < PATIENCE_CYCLES && answers() < ends; i++) {
        if (takt_service_get_state(&service) == PANEL_HELD)
            takt_console_take(&console, '~');
        step();
    }
}

static void try_case(unsigned seed)
{
    char told[64];

    state = seed;
    ends = 0;
    has_return = false;
    console_bench_set_up(0);
    forget();
    for (unsigned i = 0; i < BYTES_OF_A_CASE; i++) {
        give_piece();
        if (draw(4) == 0)
            steps(1 + draw(20));
    }
    give_byte('\n');
    await_answers();
    (void)snprintf(told, sizeof told, "seed %u, state %d, waits %d", seed,
                   (int)takt_service_get_state(&service), takt_console_is_waiting(&console));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(ends, answers(), told);
    TEST_ASSERT_TRUE_MESSAGE(most_acceleration <= 1000.0 * 1.0001, told);
    TEST_ASSERT_TRUE_MESSAGE(most_jerk <= 50000.0 * 1.001, told);
}

static void test_every_line_of_any_bytes_gets_one_answer(void)
{
    for (unsigned i = 0; i < number; i++)
        try_case(first + i);
}

static void test_after_a_reset_it_answers_again(void)
{
    for (unsigned i = 0; i < number; i++) {
        state = first + i;
        console_bench_set_up(0);
        for (unsigned k = 0; k < 50; k++) {
            give_piece();
            steps(draw(10));
        }
        takt_console_take(&console, 0x18);
        forget();
        for (unsigned k = 0; k < BENCH_CYCLES_MAX && strstr(said, "Grbl 1.1h") == NULL; k++)
            step();
        expect("Grbl 1.1h");
        forget();
        give("\n$X\n");
        await(2);
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &number, &first);
    UNITY_BEGIN();
    RUN_TEST(test_every_line_of_any_bytes_gets_one_answer);
    RUN_TEST(test_after_a_reset_it_answers_again);
    return UNITY_END();
}
