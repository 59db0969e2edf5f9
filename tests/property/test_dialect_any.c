/*
 * host/dialect: any bytes become a text, in every dialect: each of their lines gives at least one,
 * numbers of lines stay, and what is read as LinuxCNC's without codes of the machine file is not
 * changed.
 */
#include "dialect/dialect.h"

#include "property_arguments.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXTS_BY_DEFAULT 3000
#define BYTES_MAX        4000

static uint64_t state;

void setUp(void)
{
}

void tearDown(void)
{
}

static unsigned draw(unsigned count)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (unsigned)((state >> 20) % count);
}

/* Pieces of lines of every dialect. */
static const char *const pieces[] = {"IF[#1EQ1]",
                                     "GOTO ",
                                     "THEN ",
                                     "WHILE[#1LT2]DO1",
                                     "END1",
                                     "G65P1 ",
                                     "G28",
                                     "X",
                                     "Y1.",
                                     "#3000=1(a)",
                                     "(",
                                     ")",
                                     "*57",
                                     "e-3",
                                     "G50S9",
                                     "G50.1X0",
                                     "#5041",
                                     "#5221=1",
                                     "#[2000+#1]",
                                     "#[5221+20*#1]",
                                     "G92.1X0",
                                     "D=R1",
                                     "FIX[#1]",
                                     "FUP[",
                                     "G10L2P1X1R1",
                                     "G10L20P1",
                                     "T1D2M6",
                                     "DEF INT A=1",
                                     "PROC A(VAR REAL B)",
                                     "LIMS=9",
                                     "T0101",
                                     "%",
                                     "O",
                                     "N1",
                                     "$",
                                     "//",
                                     "\n",
                                     "\n",
                                     "\n",
                                     "M98P21",
                                     "G54.1P2",
                                     "/2",
                                     "[",
                                     "]",
                                     "M117 x",
                                     "E1",
                                     " ",
                                     "-",
                                     "G2",
                                     "K0",
                                     "I1",
                                     "G4P500",
                                     "M31",
                                     "\r\n",
                                     "\xef\xbb\xbf",
                                     "M99",
                                     "G0",
                                     "<",
                                     ">",
                                     ";",
                                     "@1",
                                     "^2",
                                     "L3",
                                     "G91",
                                     "#<_ini[a]b>",
                                     "#1=",
                                     "M104",
                                     "G103",
                                     "\x01",
                                     "1e+9",
                                     "G90",
                                     "R1=",
                                     "R2+3",
                                     "X=",
                                     "CR=5",
                                     "MSG(\"a\")",
                                     "L100 P2",
                                     "IF R1>5",
                                     "GOTOF A",
                                     "A:",
                                     "ENDIF",
                                     "ELSE",
                                     "FOR R1=1 TO 3",
                                     "ENDFOR",
                                     "WHILE R1<2",
                                     "LOOP",
                                     "ENDLOOP",
                                     "REPEAT",
                                     "UNTIL R1>1",
                                     "TRANS ",
                                     "MCALL ",
                                     "CYCLE83(1,0,2,-3,,1,2)",
                                     "=IC(",
                                     "=AC(",
                                     "SIN(",
                                     "%_N_A_SPF",
                                     "PROC A",
                                     "M17",
                                     "G66P8",
                                     "G67",
                                     "G13I1K9Q2",
                                     "#0",
                                     "G76P010060Q1"};

static size_t make_text(char *text)
{
    size_t length = 0;

    for (unsigned i = draw(200); i > 0; i--) {
        const char *piece = pieces[draw(sizeof pieces / sizeof pieces[0])];

        while (*piece != '\0')
            text[length++] = *piece++;
        if (draw(40) == 0)
            text[length++] = (char)draw(256);
    }
    return length;
}

static unsigned count_lines(const char *bytes, size_t length)
{
    unsigned lines = 0;

    for (size_t i = 0; i < length; i++) {
        const bool begins = i == 0 || bytes[i - 1] == '\n';

        lines += begins && bytes[i] != DIALECT_GOES_ON ? 1U : 0U;
    }
    return lines;
}

static void check(unsigned seed)
{
    static const struct dialect_codes codes = {
        .count = 1,
        .code = {{.letter = 'm', .number_x10 = 310, .use = DIALECT_SUBROUTINE, .subroutine = "x"}}};
    static struct dialect_result result;
    static char text[BYTES_MAX];
    char label[32];
    const size_t length = make_text(text);
    const bool own = memchr(text, DIALECT_GOES_ON, length) != NULL;

    (void)snprintf(label, sizeof label, "seed %u", seed);
    for (unsigned i = 0; i < DIALECT_COUNT; i++) {
        const size_t mark = length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;

        TEST_ASSERT_TRUE_MESSAGE(
            dialect_translate((enum dialect)i, &codes, NULL, text, length, &result), label);
        if (!own)
            TEST_ASSERT_EQUAL_UINT_MESSAGE(count_lines(text + mark, length - mark),
                                           count_lines(result.text.bytes, result.text.length),
                                           label);
        dialect_text_free(&result.text);
    }
}

static unsigned number = TEXTS_BY_DEFAULT;
static unsigned first = 1;

static void test_any_bytes_keep_their_lines(void)
{
    for (unsigned i = 0; i < number; i++) {
        state = 0x9e3779b97f4a7c15U * (first + i + 1U);
        check(first + i);
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &number, &first);
    UNITY_BEGIN();
    RUN_TEST(test_any_bytes_keep_their_lines);
    return UNITY_END();
}
