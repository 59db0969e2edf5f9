/*
 * Any bytes whatever are read to the end: every line gives moves or an error, every move is finite
 * and inside the travel, and nothing is read out of bounds (which the sanitizers watch).
 *
 * The bytes are real lines with random changes, so that they go deep before they go wrong. Together
 * the lines have every word of the language. Such a program may make moves for ever, or go round in
 * loops for long: it is given up then.
 */
#include "base/maths.h"
#include "program/program.h"

#include "unity.h"

#include <stdio.h>
#include <string.h>

#define PROGRAMS     1500
#define LINES        30
#define TEXT_MAX     8000
#define TRAVEL_MM    500.0
#define TRAVEL_SLACK 1e-5
/* Moves and errors of a program until it is given up, and bytes until its source breaks down. */
#define STEPS_MAX 1000
#define READ_MAX  20000

static const char *const lines[] = {
    "N10 G21 G90 G94 G17 G40 G49 G80",
    "G0 X10 Y-20.5 Z3",
    "G1 X[#1*10.] Y[#2*-56.128] F[#4*100]",
    "G2 X20 Y0 I5 J-5 P2 F300",
    "G3 X1.5 Y2.5 R-12",
    "G18 G2 X0 Z0 K5",
    "G19 G90.1 G3 Y3 Z4 J1 K1",
    "G91.1",
    "G3.2 X6.283185307 Y4 I-4 R4",
    "G2.2 X1 Y1 I3 J4 R5",
    "G5 X1 Y1 I1 J1",
    "G7 G0 X30",
    "G8",
    "#1=10 #2=[#1+1] #<name>=-3.5 #<_global>=2",
    "#[#1 MOD 30 + 1]=##2",
    "X[SIN[30]*2**3] Y[ATAN[1]/[2]] Z[EXISTS[#<name>]]",
    "X[FIX[2.5]+FUP[1.5]-ROUND[1.5]] Y[LN[EXP[1]]] Z[ABS[COS[60]*TAN[45]]]",
    "X[ACOS[0.5]/10] Y[ASIN[1]/10] Z[SQRT[4]]",
    "#3=[[#1 GT 2] AND [#1 LE 9] OR [#2 EQ 3] XOR [#2 NE 4]]",
    "#4=[#5061 + #5399 + #<_x> + #<_vmajor> + #<_current_tool> + #5420]",
    "G28 Z1",
    "G28.1",
    "G30 X2",
    "G30.1",
    "G53 G0 Z-10.0 M5",
    "G54 (a comment) G64 P0.1 Q0.2",
    "G59.3 G61",
    "G61.1",
    "G92 X1 Y2",
    "G92.1 M3 S1000",
    "G92.2",
    "G92.3",
    "G52 X3 Y-1",
    "G10 L1 P1 R2 Z3 I10 J20 Q3",
    "G10 L2 P2 X1 Y2 R30",
    "G10 L10 P1 Z4",
    "G10 L11 P1 X4",
    "G10 L20 P0 X0",
    "T1 M6",
    "T2",
    "M61 Q2",
    "G43 H1 Z100 ; rest",
    "G43.1 Z3",
    "G43.2 H2",
    "G4 P0.5 M8",
    "M7 M9",
    "G93 G1 X1 F2",
    "G94 F100",
    "G95 G1 X2 F0.1",
    "G96 S100 D2000 M4",
    "G97 S500 M3",
    "M19 R90 P1 Q2",
    "G33 Z-5 K1",
    "G33.1 Z-5 K1",
    "G76 P1 Z-10 I-2 J0.5 K2 R1.5 Q29 H1 E1 L1",
    "G38.2 Z-5 F100",
    "G38.3 X1",
    "G38.4 Y1",
    "G38.5 Z9",
    "G41 D1 G1 X20 F100",
    "G42 D2",
    "G41.1 D3 L2",
    "G42.1 D4 G1 Y30",
    "G40 G1 X0",
    "G73 X1 Y1 Z-5 R2 Q1 F100",
    "G74 X1 Z-5 R2 P0.1",
    "G81 X2 Y2 Z-5 R2 L3",
    "G82 X1 Z-3 R1 P1",
    "G83 X3 Z-6 R2 Q0.5",
    "G84 X1 Z-3 R1",
    "G85 Y1 Z-3 R1",
    "G86 X1 Z-3 R1 P1",
    "G87 X1 Z-3 R-5 I1 J0 K-1",
    "G88 X1 Z-3 R1 P1",
    "G89 X1 Z-3 R1 P1",
    "G98 X5",
    "G99 X6",
    "G91 X-1 Y1 A10 B20 C-30",
    "G20 X1",
    "/ G1 X1 Y1",
    "M0",
    "M1",
    "M48",
    "M49",
    "M50 P0",
    "M51 P1",
    "M52 P1",
    "M53 P0",
    "M62 P1",
    "M63 P1",
    "M64 P2",
    "M65 P2",
    "M66 P1 L3 Q5",
    "M66 E1 L0",
    "M67 E1 Q0.5",
    "M68 E2 Q-1",
    "M70",
    "M71",
    "M72",
    "M73",
    "M98 P7 L2",
    "M99",
    "M2",
    "M30",
    "M60",
    "O1 if [#1 GT 2]",
    "O1 elseif [#2]",
    "O1 else",
    "O1 endif",
    "O2 while [#5 LT 3]",
    "#5=[#5+1]",
    "O2 endwhile",
    "O3 do",
    "O3 while [#6 LT 2]",
    "#6=[#6+1]",
    "O4 repeat [3]",
    "O4 endrepeat",
    "O2 break",
    "O4 continue",
    "O<part> sub",
    "O<part> return [#1]",
    "O<part> endsub [#1+1]",
    "O<part> call [1] [2]",
    "O7",
    "#5221=10 G55",
    "%",
};

static struct program program;
static struct parameters parameters;
static uint64_t state;
static char text[TEXT_MAX];

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64 (G. Steele, D. Lea, C. Flood, 2014). */
static unsigned random_below(unsigned limit)
{
    uint64_t z = (state += UINT64_C(0x9e3779b97f4a7c15));

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (unsigned)((z ^ (z >> 31)) % limit);
}

static char random_byte(void)
{
    static const char likely[] = "GMXYZIJKRPFSTHNABC#<>[]()+-*/=.;%0123456789 \n\t";

    if (random_below(8) == 0) {
        return (char)random_below(256);
    }
    return likely[random_below(sizeof(likely) - 1)];
}

/* One change: a byte replaced, left out, doubled, or a piece copied over another. */
static size_t mutate(size_t length)
{
    const size_t at = random_below((unsigned)length);
    const size_t to = random_below((unsigned)length);
    size_t count = random_below(40);

    switch (random_below(4)) {
    case 0:
        text[at] = random_byte();
        return length;
    case 1:
        memmove(text + at, text + at + 1, length - at - 1);
        return length - 1;
    case 2:
        memmove(text + at + 1, text + at, length - at);
        return length + 1;
    default:
        count = at + count > length ? length - at : count;
        count = to + count > length ? length - to : count;
        memmove(text + to, text + at, count);
        return length;
    }
}

/* Changes seldom in half of the programs, so that some run through. */
static size_t write_program(void)
{
    const unsigned changes = random_below(2) == 0 ? random_below(6) : random_below(200);
    size_t length = 0;

    for (unsigned i = 0; i < LINES; i++) {
        const char *line = lines[random_below(sizeof(lines) / sizeof(lines[0]))];

        length += (size_t)snprintf(text + length, sizeof(text) - length, "%s\n", line);
    }
    for (unsigned i = 0; i < changes; i++) {
        length = mutate(length);
    }
    return length;
}

/* The travel of a compensated move is looked at when its way is known. */
static bool is_within_travel(const struct move *move, int axis)
{
    const double limit = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : MATHS_TWO_PI;

    return maths_is_finite(move->end.at[axis]) &&
           (move->cutter_side != CUTTER_OFF ||
            maths_abs(move->end.at[axis]) <= limit + TRAVEL_SLACK);
}

static void check_motion(const struct move *move)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_TRUE_MESSAGE(is_within_travel(move, axis), text);
    }
    TEST_ASSERT_TRUE_MESSAGE(move->kind == MOVE_RAPID || move->feed_mm_s > 0.0, text);
    if (move->kind == MOVE_ARC_CW || move->kind == MOVE_ARC_CCW) {
        TEST_ASSERT_TRUE_MESSAGE(maths_is_finite(move->centre_mm[0]), text);
        TEST_ASSERT_TRUE_MESSAGE(maths_is_finite(move->centre_mm[1]), text);
        TEST_ASSERT_TRUE_MESSAGE(move->turns >= 1, text);
    }
}

static void check_error(const struct diagnostic *d)
{
    char message[DIAGNOSTIC_TEXT_MAX];

    TEST_ASSERT_TRUE_MESSAGE(d->code < 0 && d->column <= PROGRAM_LINE_MAX + 1, text);
    TEST_ASSERT_TRUE_MESSAGE(d->line > 0 || d->code == TAKT_ERROR_FROM_LINE_MISSED, text);
    TEST_ASSERT_TRUE_MESSAGE(takt_diagnostic_text(d, message) > 0, text);
}

/* A text that cannot be read any more once so much of it has been. */
struct worn_text {
    struct source text;
    struct source_text context;
    size_t left;
};

static long worn_read(void *context, char *buffer, size_t size)
{
    struct worn_text *t = context;

    if (t->left < size) {
        return SOURCE_ERROR;
    }
    t->left -= size;
    return t->text.read(t->text.context, buffer, size);
}

static bool worn_seek(void *context, uint64_t offset)
{
    struct worn_text *t = context;

    return t->text.seek(t->text.context, offset);
}

static void open_program(struct worn_text *worn, size_t length)
{
    static const struct tool tools[] = {{.number = 1, .diameter_mm = 4.0},
                                        {.number = 2, .diameter_mm = 2.0, .orientation = 3}};
    static const struct tool_table table = {tools, sizeof(tools) / sizeof(tools[0])};
    struct program_config config = {.axes = 0x3fU, .parameters = &parameters, .tools = &table};
    const struct source source = {worn_read, worn_seek, worn};

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        config.travel_max[axis] = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : MATHS_TWO_PI;
        config.travel_min[axis] = -config.travel_max[axis];
    }
    config.block_delete = random_below(2) == 0;
    config.from_line = random_below(8) == 0 ? 1 + random_below(LINES) : 0;
    takt_parameters_clear(&parameters);
    worn->left = READ_MAX;
    takt_source_open_text(&worn->text, &worn->context, text, length);
    takt_program_open(&program, &config, &source);
}

/* Counts the moves and the errors. */
static void run_program(size_t length, unsigned *moves, unsigned *errors)
{
    struct worn_text worn;
    struct diagnostic diagnostic;
    struct move move;
    enum program_result result;

    open_program(&worn, length);
    for (unsigned steps = 0; steps < STEPS_MAX; steps++) {
        result = takt_program_next(&program, &move, &diagnostic);
        if (result == PROGRAM_END) {
            break;
        }
        if (result == PROGRAM_ERROR) {
            check_error(&diagnostic);
            ++*errors;
        } else {
            ++*moves;
            if (move_is_motion(&move)) {
                check_motion(&move);
            }
        }
    }
    while (takt_program_warning(&program, &diagnostic)) {
        check_error(&diagnostic);
    }
}

static void test_any_text_is_read_to_its_end(void)
{
    unsigned moves = 0;
    unsigned errors = 0;

    for (uint64_t seed = 1; seed <= PROGRAMS; seed++) {
        state = seed;
        run_program(write_program(), &moves, &errors);
    }
    /* Both ways of reading a line have been tried. */
    TEST_ASSERT_TRUE(moves > PROGRAMS && errors > PROGRAMS);
}

static void test_random_bytes_are_read_to_their_end(void)
{
    unsigned moves = 0;
    unsigned errors = 0;

    for (uint64_t seed = 1; seed <= PROGRAMS / 10; seed++) {
        state = seed;
        for (size_t i = 0; i < TEXT_MAX / 4; i++) {
            text[i] = (char)random_below(256);
        }
        run_program(TEXT_MAX / 4, &moves, &errors);
    }
    TEST_ASSERT_TRUE(errors > PROGRAMS / 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_any_text_is_read_to_its_end);
    RUN_TEST(test_random_bytes_are_read_to_their_end);
    return UNITY_END();
}
