#include "program/changes.h"

#include "base/assert.h"
#include "program/coordinates.h"

#include <string.h>

/* Behind all parameters: the tools that the program has changed. */
#define TOOL (PARAMETER_NUMBER_MAX + 1U)

void takt_changes_open(struct program *p)
{
    memset(&p->changes, 0, sizeof(p->changes));
}

static struct program_change *change_at(struct program *p, unsigned i)
{
    TAKT_ASSERT(i < p->changes.count);
    return &p->changes.change[(p->changes.first + i) % PROGRAM_CHANGES_MAX];
}

static const struct program_change *change_read(const struct program *p, unsigned i)
{
    TAKT_ASSERT(i < p->changes.count);
    return &p->changes.change[(p->changes.first + i) % PROGRAM_CHANGES_MAX];
}

/* Those that an answer sets are set when everything before has been done. */
static bool lasts(unsigned parameter)
{
    return parameter >= PARAMETER_REFERENCE_1 && parameter < PARAMETER_INPUT;
}

static double value_of(const struct program *p, unsigned parameter)
{
    TAKT_ASSERT(parameter <= PARAMETER_NUMBER_MAX);
    return takt_parameters_get(p->config.parameters, parameter);
}

/* Since the last move: what it was before the first of these changes counts. */
static bool is_noted(const struct program *p, unsigned parameter)
{
    for (unsigned i = p->changes.count; i > 0; i--) {
        const struct program_change *change = change_read(p, i - 1);

        if (!p->changes.open || change->number != p->changes.number) {
            return false;
        }
        if (change->parameter == parameter) {
            return true;
        }
    }
    return false;
}

/* The oldest is most likely done. */
static struct program_change *add(struct program *p)
{
    struct program_changes *changes = &p->changes;

    if (changes->count == PROGRAM_CHANGES_MAX) {
        changes->first = (changes->first + 1) % PROGRAM_CHANGES_MAX;
        changes->count--;
        changes->full = true;
    }
    return change_at(p, changes->count++);
}

static void note(struct program *p, unsigned parameter, double before)
{
    struct program_changes *changes = &p->changes;

    if (!changes->behind_move || is_noted(p, parameter)) {
        return;
    }
    if (!changes->open) {
        changes->open = true;
        changes->number++;
    }
    *add(p) = (struct program_change){
        .before = before, .parameter = (uint16_t)parameter, .number = changes->number};
}

void takt_changes_note(struct program *p, unsigned parameter, double before)
{
    if (lasts(parameter) && value_of(p, parameter) != before) {
        note(p, parameter, before);
    }
}

void takt_changes_note_tool(struct program *p, unsigned index)
{
    TAKT_ASSERT(index < p->tools.count);
    note(p, TOOL + index, 0.0);
}

void takt_changes_stamp(struct program *p, struct move *move)
{
    TAKT_ASSERT(p->changes.count <= PROGRAM_CHANGES_MAX);
    move->changes = p->changes.number;
    p->changes.open = false;
    p->changes.behind_move = true;
}

void takt_changes_place(struct program *p, uint8_t number, uint32_t place)
{
    for (unsigned i = p->changes.count; i > 0; i--) {
        struct program_change *change = change_at(p, i - 1);

        if (change->placed) {
            return;
        }
        if ((int8_t)(uint8_t)(number - change->number) >= 0) {
            change->placed = true;
            change->place = place;
        }
    }
}

static bool is_reached(const struct program_change *change, uint32_t reached)
{
    return reached == CHANGES_ALL || (change->placed && change->place <= reached);
}

double takt_changes_value(const struct program *p, unsigned parameter, uint32_t reached)
{
    for (unsigned i = 0; i < p->changes.count; i++) {
        const struct program_change *change = change_read(p, i);

        if (change->parameter == parameter && !is_reached(change, reached)) {
            return change->before;
        }
    }
    return value_of(p, parameter);
}

static bool is_unreached(const struct program *p, unsigned i, uint32_t reached)
{
    return i > 0 && !is_reached(change_read(p, i - 1), reached);
}

bool takt_changes_leave_out(const struct program *p, uint32_t reached,
                            struct parameters *parameters)
{
    bool good = true;

    for (unsigned i = p->changes.count; is_unreached(p, i, reached); i--) {
        const struct program_change *change = change_read(p, i - 1);

        if (change->parameter < TOOL) {
            good = takt_parameters_set(parameters, change->parameter, change->before) && good;
        }
    }
    return good;
}

/* The tool is as in the table, whatever the program has made of it before. */
static void take_back_tool(struct program *p, unsigned index)
{
    struct tool *tool = &p->tools.tool[index];
    const struct tool *known = takt_tool_table_find(p->config.tools, tool->number);

    TAKT_ASSERT(index < p->tools.count && known != NULL);
    *tool = *known;
}

bool takt_changes_take_back(struct program *p, uint32_t reached)
{
    const struct program_changes *changes = &p->changes;
    unsigned left = changes->count;

    const bool has_room = takt_changes_leave_out(p, reached, p->config.parameters);

    for (; is_unreached(p, left, reached); left--) {
        const struct program_change *change = change_read(p, left - 1);

        if (change->parameter >= TOOL) {
            take_back_tool(p, change->parameter - TOOL);
        }
    }
    const bool good = has_room && (left > 0 || changes->count == 0 || !changes->full);

    if (left < changes->count) {
        takt_coordinates_reload(p);
    }
    takt_changes_open(p);
    return good;
}
