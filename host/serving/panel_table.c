#include "serving/panel_table.h"

#include "panel/registers.h"

#include <inttypes.h>
#include <string.h>

static const char *const table_names[] = {
    [MODBUS_COILS] = "coil", [MODBUS_INPUTS] = "input", [MODBUS_HOLDINGS] = "holding"};

static const char *const form_names[] = {[PANEL_BIT] = "bit",     [PANEL_U16] = "16 bits",
                                         [PANEL_U32] = "32 bits", [PANEL_S32] = "32 bits, signed",
                                         [PANEL_TEXT] = "text",   [PANEL_BYTES] = "bytes"};

static const char *const state_names[PANEL_STATES] = {
    [PANEL_STARTING] = "starting", [PANEL_IDLE] = "idle",
    [PANEL_RUNNING] = "running",   [PANEL_MDI] = "MDI",
    [PANEL_JOGGING] = "jogging",   [PANEL_HOMING] = "homing",
    [PANEL_HELD] = "held",         [PANEL_STOPPING] = "stopping",
    [PANEL_ALARM] = "alarm",       [PANEL_EMERGENCY] = "emergency stop"};

static void write_states(FILE *stream, unsigned states, const char *between)
{
    const char *before = "";

    if (states == PANEL_ANY) {
        (void)fputs("always", stream);
        return;
    }
    if (states == PANEL_NEVER)
        (void)fputs("never", stream);
    for (unsigned i = 0; i < PANEL_STATES; i++) {
        if ((states & PANEL_IN(i)) == 0)
            continue;
        (void)fprintf(stream, "%s%s", before, state_names[i]);
        before = between;
    }
}

static bool is_number(const struct panel_register *row)
{
    return row->form != PANEL_TEXT && row->form != PANEL_BYTES;
}

static double in_units(const struct panel_register *row, int64_t counts)
{
    return (double)counts / takt_panel_counts_per_unit((enum panel_id)(row - takt_panel_registers));
}

/* Empty for texts and whatever has the range of its form. */
static void write_range(FILE *stream, const struct panel_register *row)
{
    if (is_number(row) && row->states != PANEL_NEVER && row->form != PANEL_BIT)
        (void)fprintf(stream, "%.*f ... %.*f", (int)row->decimals,
                      in_units(row, takt_panel_least(row)), (int)row->decimals,
                      in_units(row, panel_most(row)));
}

static void write_address(FILE *stream, const struct panel_register *row)
{
    (void)fprintf(stream, "%u", (unsigned)row->address);
    if (row->words > 1)
        (void)fprintf(stream, "-%u", (unsigned)(row->address + row->words - 1));
}

static void write_markdown_row(FILE *stream, const struct panel_register *row)
{
    (void)fputs("| ", stream);
    write_address(stream, row);
    (void)fprintf(stream, " | %s | %s | ", panel_text(row)->name, form_names[row->form]);
    if (row->decimals > 0)
        (void)fprintf(stream, "%.*f ", (int)row->decimals, in_units(row, 1));
    (void)fprintf(stream, "%s | ", panel_text(row)->unit);
    write_range(stream, row);
    (void)fputs(" | ", stream);
    write_states(stream, row->states, ", ");
    (void)fprintf(stream, " | %s |\n", panel_text(row)->meaning);
}

static void write_markdown_table(FILE *stream, enum modbus_table table, const char *title)
{
    (void)fprintf(stream,
                  "\n## %s\n\n"
                  "| address | name | form | one count is | range | may be written | meaning |\n"
                  "|---|---|---|---|---|---|---|\n",
                  title);
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        if (takt_panel_registers[i].table == table)
            write_markdown_row(stream, &takt_panel_registers[i]);
    }
}

void panel_table_write_markdown(FILE *stream)
{
    (void)fprintf(
        stream,
        "# Registers of the panel\n\n"
        "Version %d of the table. Written by `takt panel table markdown` from registers.h;"
        " a test compares.\n\n"
        "Addresses are those on the wire, from 0. Numbers of 32 bits take two registers, "
        "the high word first, and are\n"
        "written whole. Texts have two characters a register, the first in its high byte. "
        "For rotary axes read deg for mm.\n"
        "The states are those of STATE.\n",
        PANEL_TABLE_VERSION);
    write_markdown_table(stream, MODBUS_COILS, "Coils (functions 01, 05, 15)");
    write_markdown_table(stream, MODBUS_INPUTS, "Input registers (function 04)");
    write_markdown_table(stream, MODBUS_HOLDINGS, "Holding registers (functions 03, 06, 16, 23)");
}

/* A field with quotes around it, doubled inside. */
static void write_quoted(FILE *stream, const char *text)
{
    (void)fputc('"', stream);
    for (; *text != '\0'; text++) {
        if (*text == '"')
            (void)fputc('"', stream);
        (void)fputc(*text, stream);
    }
    (void)fputc('"', stream);
}

static void write_csv_row(FILE *stream, const struct panel_register *row)
{
    (void)fprintf(stream, "%s,%u,%u,%s,%s,%s,%.*g,%" PRId64 ",%" PRId64 ",",
                  table_names[row->table], (unsigned)row->address, (unsigned)row->words,
                  panel_text(row)->name,
                  row->form == PANEL_S32 ? "32 bits signed" : form_names[row->form],
                  panel_text(row)->unit, 6, in_units(row, 1), (int64_t)takt_panel_least(row),
                  is_number(row) ? (int64_t)panel_most(row) : 0);
    write_states(stream, row->states, ";");
    (void)fputc(',', stream);
    write_quoted(stream, panel_text(row)->meaning);
    (void)fputc('\n', stream);
}

void panel_table_write_csv(FILE *stream)
{
    (void)fputs("table,address,registers,name,form,unit,scale,least_counts,most_counts,written_in,"
                "meaning\n",
                stream);
    for (unsigned i = 0; i < REGISTER_COUNT; i++)
        write_csv_row(stream, &takt_panel_registers[i]);
}
