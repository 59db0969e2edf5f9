#include "config/machine_io.h"

#include "hal/outputs.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The bits of an I/O node that are no lines of the program, by enum io_bit. */
static const struct {
    const char *name;
    uint8_t bit;
} io_names[] = {{"-", IO_FREE},
                {"flood", IO_FLOOD},
                {"mist", IO_MIST},
                {"spindle", IO_SPINDLE},
                {"ccw", IO_SPINDLE_CCW},
                {"stop", IO_STOP},
                {"limit", IO_LIMIT},
                {"tool_change", IO_TOOL_CHANGE},
                {"tool_changed", IO_TOOL_CHANGED}};

/* Bits that have numbers: P0 ... P31, T0 ... T7. */
static const struct {
    char letter;
    uint8_t first, count;
} io_rows[] = {{'P', IO_PROGRAM, IO_FLOOD - IO_PROGRAM}, {'T', IO_TOOL, IO_BIT_COUNT - IO_TOOL}};

#define IO_WORD_MAX 15

/* False: there is no such bit. */
static bool read_io_bit(const char *word, uint8_t *bit)
{
    const bool is_inverted = word[0] == '!';
    const char *name = word + is_inverted;

    for (size_t i = 0; i < sizeof io_rows / sizeof io_rows[0]; i++) {
        char *end = NULL;
        unsigned long number = isdigit((unsigned char)name[name[0] != '\0'])
                                   ? strtoul(name + 1, &end, 10)
                                   : IO_BIT_COUNT;

        if (name[0] == io_rows[i].letter && number < io_rows[i].count && end != NULL &&
            *end == '\0') {
            *bit = (uint8_t)(io_rows[i].first + number + (is_inverted ? IO_INVERTED : 0));
            return true;
        }
    }
    for (size_t i = 0; i < sizeof io_names / sizeof io_names[0]; i++) {
        if (strcmp(name, io_names[i].name) == 0) {
            *bit = (uint8_t)(io_names[i].bit + (is_inverted ? IO_INVERTED : 0));
            return true;
        }
    }
    return false;
}

bool machine_io_read(uint8_t field[IO_BITS_MAX], const char *value, bool is_output,
                     const char *name, struct machine_problem *wrong)
{
    uint8_t bits[IO_BITS_MAX] = {IO_FREE};
    size_t count = 0;

    while (*(value += strspn(value, " \t,")) != '\0') {
        const size_t length = strcspn(value, " \t,");
        char word[IO_WORD_MAX + 1];
        uint8_t bit;

        (void)snprintf(word, sizeof word, "%.*s",
                       (int)(length < IO_WORD_MAX ? length : IO_WORD_MAX), value);
        if (!read_io_bit(word, &bit) || !(is_output ? io_is_output(bit) : io_is_input(bit))) {
            (void)snprintf(
                wrong->text, sizeof wrong->text, "%s: '%s' is none of %s", name, word,
                is_output ? "P0 ... P31, flood, mist, spindle, ccw, tool_change, T0 ... T7 and -"
                          : "P0 ... P31, stop, limit, tool_changed and -");
            return false;
        }
        if (count == IO_BITS_MAX) {
            (void)snprintf(wrong->text, sizeof wrong->text, "%s: more than %d bits", name,
                           IO_BITS_MAX);
            return false;
        }
        bits[count++] = bit;
        value += length;
    }
    memcpy(field, bits, sizeof bits);
    return true;
}

/* "P31", "flood". */
static const char *io_name(unsigned kind)
{
    static _Thread_local char text[4];

    for (size_t i = 0; i < sizeof io_rows / sizeof io_rows[0]; i++) {
        const unsigned number = kind - io_rows[i].first;

        if (kind >= io_rows[i].first && number < io_rows[i].count) {
            (void)snprintf(text, sizeof text, "%c%u", io_rows[i].letter, number % 100);
            return text;
        }
    }
    for (size_t i = 0; i < sizeof io_names / sizeof io_names[0]; i++) {
        if (io_names[i].bit == kind)
            return io_names[i].name;
    }
    return "-";
}

void machine_io_write(const uint8_t bits[IO_BITS_MAX], char *text, size_t size)
{
    const unsigned count = io_wired_bits(bits);
    size_t used = 0;

    text[0] = '\0';
    for (unsigned i = 0; i < count && used < size; i++) {
        const unsigned kind = io_kind(bits[i]);
        const char *mark = bits[i] & IO_INVERTED ? "!" : "";
        const char *space = i > 0 ? " " : "";

        used += (size_t)snprintf(text + used, size - used, "%s%s%s", space, mark, io_name(kind));
    }
}

/* 0: free; n + 1: En. False: neither. */
static bool read_analogue(const char *word, size_t length, unsigned *wired)
{
    *wired = 0;
    if (length == 1 && word[0] == '-')
        return true;
    if (length != 2 || word[0] != 'E' || word[1] < '0' || word[1] >= '0' + OUTPUTS_ANALOGUE_MAX)
        return false;
    *wired = (unsigned)(word[1] - '0') + 1;
    return true;
}

bool machine_io_read_analogues(uint8_t field[IO_ANALOGUE_MAX / 2], const char *value,
                               const char *name, struct machine_problem *wrong)
{
    uint8_t read[IO_ANALOGUE_MAX / 2] = {0};

    for (unsigned count = 0; *(value += strspn(value, " \t,")) != '\0'; count++) {
        const size_t length = strcspn(value, " \t,");
        unsigned wired;

        if (!read_analogue(value, length, &wired)) {
            (void)snprintf(wrong->text, sizeof wrong->text, "%s: '%.*s' is none of E0 ... E3 and -",
                           name, (int)(length < IO_WORD_MAX ? length : IO_WORD_MAX), value);
            return false;
        }
        if (count == IO_ANALOGUE_MAX) {
            (void)snprintf(wrong->text, sizeof wrong->text, "%s: more than %d outputs", name,
                           IO_ANALOGUE_MAX);
            return false;
        }
        read[count / 2] = (uint8_t)(read[count / 2] | wired << 4 * (count % 2));
        value += length;
    }
    memcpy(field, read, sizeof read);
    return true;
}

void machine_io_write_analogues(const uint8_t field[IO_ANALOGUE_MAX / 2], char *text, size_t size)
{
    struct io_wiring wiring = {0};
    size_t used = 0;

    memcpy(wiring.analogue, field, sizeof wiring.analogue);
    text[0] = '\0';
    for (unsigned i = 0; i < io_wired_analogues(&wiring) && used < size; i++) {
        const unsigned wired = io_get_analogue(&wiring, i);
        const char *space = i > 0 ? " " : "";

        if (wired == 0)
            used += (size_t)snprintf(text + used, size - used, "%s-", space);
        else
            used += (size_t)snprintf(text + used, size - used, "%sE%u", space, wired - 1);
    }
}
