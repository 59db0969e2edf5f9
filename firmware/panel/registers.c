#include "panel/registers.h"

/* clang-format off */
#define PANEL_ROW(id, table, address, form, words, unit, decimals, least, most, states, meaning) \
    [REGISTER_##id] = {least, most, address, words, states, table, form, decimals},
#define PANEL_TEXTS(id, table, address, form, words, unit, decimals, least, most, states, meaning) \
    [REGISTER_##id] = {#id, unit, meaning},
/* clang-format on */

const struct panel_register panel_registers[REGISTER_COUNT] = {PANEL_REGISTERS(PANEL_ROW)};
const struct panel_text panel_texts[REGISTER_COUNT] = {PANEL_REGISTERS(PANEL_TEXTS)};

/* Table and address as one rising number. */
static uint32_t place_of(enum modbus_table table, uint16_t address)
{
    return (uint32_t)table << 16 | address;
}

/* The first row of the upper half may be the one: it begins at or before the place. */
enum panel_id panel_find(enum modbus_table table, uint16_t address)
{
    const uint32_t place = place_of(table, address);
    unsigned low = 0, high = REGISTER_COUNT;

    while (high - low > 1) {
        const unsigned middle = (low + high) / 2;
        const struct panel_register *row = &panel_registers[middle];

        if (place_of(row->table, row->address) <= place)
            low = middle;
        else
            high = middle;
    }
    const struct panel_register *row = &panel_registers[low];

    if (row->table != table || address < row->address || address - row->address >= row->words)
        return REGISTER_COUNT;
    return (enum panel_id)low;
}

/* Bit 5 is all that parts the cases of a letter. */
#define CASE_BIT 0x20U

static bool same_character(char name, char given)
{
    const unsigned a = (unsigned char)name, b = (unsigned char)given;

    return a == b || (given >= 'a' && given <= 'z' && a == (b & ~CASE_BIT));
}

static bool same_name(const char *name, const char *given)
{
    while (*name != '\0' && same_character(*name, *given)) {
        name++;
        given++;
    }
    return *name == '\0' && *given == '\0';
}

enum panel_id panel_find_name(const char *name)
{
    unsigned id = 0;

    while (id < REGISTER_COUNT && !same_name(panel_texts[id].name, name))
        id++;
    return (enum panel_id)id;
}

double panel_counts_per_unit(enum panel_id id)
{
    double counts = 1.0;

    for (unsigned i = 0; i < panel_registers[id].decimals; i++)
        counts *= 10.0;
    return counts;
}

bool panel_may_write(enum panel_id id, enum panel_state state)
{
    return (panel_registers[id].states & PANEL_IN(state)) != 0;
}
