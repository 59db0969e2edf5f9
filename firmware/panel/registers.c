#include "panel/registers.h"

#define FROM_500 500

/* clang-format off */
#define RANGE_BITS(most) ((most) <= UINT16_MAX ? 0 : (most) % 512 == 0 ? 9 : 6)
#define RANGE(most)      ((most) >= INT32_MAX ? 0 : (uint16_t)((most) >> RANGE_BITS(most)))
#define FROM(least)      ((least) < 0 ? PANEL_FROM_MINUS_MOST : (least) == FROM_500 ? PANEL_FROM_500 : (uint8_t)(least))
#define PANEL_ROW(id, table, address, form, words, unit, decimals, least, most, states, meaning) \
    [REGISTER_##id] = {address, RANGE(most), RANGE_BITS(most), FROM(least), states, words, table, form, decimals},
#define PANEL_TEXTS(id, table, address, form, words, unit, decimals, least, most, states, meaning) \
    [REGISTER_##id] = {#id, unit, meaning},
#define PANEL_CHECK(id, table, address, form, words, unit, decimals, least, most, states, meaning) \
    _Static_assert((int64_t)(least) == -(int64_t)(most) || (least) == FROM_500 || (least) == 0 || (least) == 1, #id); \
    _Static_assert((most) >= INT32_MAX ? (most) == ((form) == PANEL_S32 ? INT32_MAX : UINT32_MAX) \
                                      : RANGE(most) << RANGE_BITS(most) == (most) && RANGE(most) <= UINT16_MAX, #id);
/* clang-format on */

_Static_assert(sizeof(struct panel_register) == 8, "a row of the table is small");

PANEL_REGISTERS(PANEL_CHECK)

const struct panel_register takt_panel_registers[REGISTER_COUNT] = {PANEL_REGISTERS(PANEL_ROW)};
const struct panel_text takt_panel_texts[REGISTER_COUNT] = {PANEL_REGISTERS(PANEL_TEXTS)};

int32_t takt_panel_least(const struct panel_register *row)
{
    if (row->least == PANEL_FROM_MINUS_MOST)
        return -(int32_t)panel_most(row);
    return row->least == PANEL_FROM_500 ? FROM_500 : (int32_t)row->least;
}

/* Table and address as one rising number. */
static uint32_t place_of(unsigned table, uint16_t address)
{
    return (uint32_t)table << 16 | address;
}

/* The last row that begins at or before a place, the first one if none does. */
static unsigned row_before(uint32_t place)
{
    unsigned low = 0, high = REGISTER_COUNT;

    while (high - low > 1) {
        const unsigned middle = (low + high) / 2;
        const struct panel_register *row = &takt_panel_registers[middle];

        if (place_of(row->table, row->address) <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

enum panel_id takt_panel_find(enum modbus_table table, uint16_t address)
{
    const unsigned id = row_before(place_of(table, address));
    const struct panel_register *row = &takt_panel_registers[id];

    if (row->table != (unsigned)table || address < row->address ||
        address - row->address >= row->words)
        return REGISTER_COUNT;
    return (enum panel_id)id;
}

bool takt_panel_is_gap(enum modbus_table table, uint16_t address)
{
    const unsigned next = row_before(place_of(table, address)) + 1;

    return next < REGISTER_COUNT && takt_panel_registers[next].table == (unsigned)table;
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

enum panel_id takt_panel_find_name(const char *name)
{
    unsigned id = 0;

    while (id < REGISTER_COUNT && !same_name(takt_panel_texts[id].name, name))
        id++;
    return (enum panel_id)id;
}

double takt_panel_counts_per_unit(enum panel_id id)
{
    double counts = 1.0;

    for (unsigned i = 0; i < takt_panel_registers[id].decimals; i++)
        counts *= 10.0;
    return counts;
}

bool takt_panel_may_write(enum panel_id id, enum panel_state state)
{
    return (takt_panel_registers[id].states & PANEL_IN(state)) != 0;
}
