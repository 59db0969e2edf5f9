/* A correction table as the text that table_read.c reads. */
#include "correction/table_text.h"

#include "base/crc32.h"
#include "base/decimal.h"
#include "base/maths.h"

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define POSITION_PLACES 6
#define VALUE_PLACES    6

/* Text on its way out, and its checksum. */
struct writer {
    const struct table_sink *sink;
    uint32_t crc;
};

static void write(struct writer *w, const char *text, size_t length)
{
    w->crc = takt_crc32_add(w->crc, text, length);
    w->sink->write(w->sink->context, text, length);
}

static void write_word(struct writer *w, const char *word)
{
    size_t length = 0;

    while (word[length] != '\0') {
        length++;
    }
    write(w, word, length);
}

static void write_number(struct writer *w, double value, unsigned places)
{
    char digits[DECIMAL_TEXT_MAX];
    size_t length = takt_decimal_write(digits, value, places);

    while (digits[length - 1] == '0') {
        length--;
    }
    if (digits[length - 1] == '.') {
        length--;
    }
    write(w, digits, length);
}

static void write_header(struct writer *w, const struct table *table)
{
    static const char *const direction[] = {"", "_up", "_down"};

    for (unsigned i = 0; i < table->inputs; i++) {
        write(w, &AXIS_LETTERS[table->input[i]], 1);
        write_word(w, table->input[i] < AXIS_LINEAR_COUNT ? "_mm" : "_deg");
        write_word(w, ",");
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        write_word(w, i > 0 ? "," : "");
        write_word(w, table->errors ? "E" : "K");
        write(w, &AXIS_LETTERS[table->output[i].axis], 1);
        write_word(w, direction[table->output[i].direction]);
        write_word(w, table->output[i].axis < AXIS_LINEAR_COUNT ? "_um" : "_urad");
    }
    write_word(w, "\n");
}

static void write_row(struct writer *w, const struct table *table, uint32_t row)
{
    uint32_t rest = row;

    for (unsigned i = 0; i < table->inputs; i++) {
        const double at = table->knot_mm[i][rest % table->knots[i]];

        rest /= table->knots[i];
        write_number(w, table->input[i] < AXIS_LINEAR_COUNT ? at : at * DEGREES_PER_RAD,
                     POSITION_PLACES);
        write_word(w, ",");
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        write_word(w, i > 0 ? "," : "");
        write_number(w,
                     1e3 * (double)table->value_mm[row * table->outputs + i] *
                         (table->output[i].axis < AXIS_LINEAR_COUNT ? 1.0 : 1e3),
                     VALUE_PLACES);
    }
    write_word(w, "\n");
}

static void write_checksum(struct writer *w)
{
    static const char digit[] = "0123456789abcdef";
    const uint32_t crc = w->crc;
    char text[8];

    for (unsigned i = 0; i < sizeof(text); i++) {
        text[i] = digit[crc >> (28U - 4U * i) & 15U];
    }
    write_word(w, "checksum,");
    write(w, text, sizeof(text));
    write_word(w, "\n");
}

void takt_table_write_text(const struct table *table, const char *comment,
                           const struct table_sink *sink)
{
    struct writer w = {sink, CRC32_START};
    const uint32_t rows = takt_table_rows(table);

    if (comment != NULL) {
        write_word(&w, "# ");
        write_word(&w, comment);
        write_word(&w, "\n");
    }
    write_header(&w, table);
    for (uint32_t row = 0; row < rows; row++) {
        write_row(&w, table, row);
    }
    write_checksum(&w);
}
