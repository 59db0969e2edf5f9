#include "studies/measurement.h"

#include "base/maths.h"
#include "cli/axis_unit.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "simulation/simulation.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Lines of the program before the first visit, and of each visit; the last of them is the dwell. */
#define HEAD_LINES  1
#define VISIT_LINES 3

#define LINE_BYTES_MAX 160

/* How long the drives settle, beside what fades. */
#define SETTLE_S 0.2

/* The instrument's standard deviation is the same number of um and of urad. */
#define RAD_PER_MM 1e-3

/* Times the fades, until all is settled to a billionth. */
#define FADES 3.5

/* ---- the program ---- */

struct writer {
    char *text;
    size_t length, room;
};

__attribute__((format(printf, 2, 3))) static void write_line(struct writer *w, const char *format,
                                                             ...)
{
    va_list arguments;

    va_start(arguments, format);
    w->length += (size_t)vsnprintf(w->text + w->length, w->room - w->length, format, arguments);
    va_end(arguments);
}

static void write_rapid(struct writer *w, const struct machine *machine, const struct point *at)
{
    write_line(w, "G53 G0");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            write_line(w, " %c%.6f", AXIS_LETTERS[i], at->at[i] * axis_unit_ratio(i));
    }
    write_line(w, "\n");
}

/* A little before the point, on the side it is to be approached from, within the travel. */
static void set_back(const struct machine *machine, const struct measurement_visit *visit,
                     struct point *at)
{
    *at = visit->at;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        at->at[i] = maths_clamp(at->at[i] - visit->direction * MEASUREMENT_APPROACH_MM,
                                machine->axis[i].travel_min_mm, machine->axis[i].travel_max_mm);
}

static void write_program(struct writer *w, const struct session *session,
                          const struct measurement_visit *visits, uint32_t count)
{
    const struct machine *machine = &session->setup.machine;
    const double rest_s = SETTLE_S + FADES * machine->correction.reversal_fade_s;

    write_line(w, "G21 G90 G4 P%.3f\n", FADES * machine->correction.fade_s);
    for (uint32_t i = 0; i < count; i++) {
        struct point back;

        set_back(machine, &visits[i], &back);
        write_rapid(w, machine, &back);
        write_rapid(w, machine, &visits[i].at);
        write_line(w, "G4 P%.3f\n", rest_s);
    }
}

static bool set_program(struct session *session, const struct measurement_visit *visits,
                        uint32_t count)
{
    struct writer w = {.room = LINE_BYTES_MAX * ((size_t)count * VISIT_LINES + HEAD_LINES) + 1};

    w.text = malloc(w.room);
    if (w.text == NULL) {
        message_command_error("out of memory");
        return false;
    }
    write_program(&w, session, visits, count);
    session->program = (struct program_text){.name = "<measurement>"};
    session->program.whole = (struct text){"<measurement>", w.text, w.length};
    return true;
}

/* ---- the measurement ---- */

/* xorshift64*: S. Vigna, 2016. */
static double random_uniform(struct measurement_instrument *instrument)
{
    instrument->state ^= instrument->state >> 12;
    instrument->state ^= instrument->state << 25;
    instrument->state ^= instrument->state >> 27;
    return (double)((instrument->state * UINT64_C(0x2545F4914F6CDD1D)) >> 11) * 0x1p-53;
}

/* The sum of twelve uniform numbers has the variance 1, and is near enough to Gauss. */
static double random_normal(struct measurement_instrument *instrument)
{
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += random_uniform(instrument);
    return sum;
}

/* Shifts in mm, turns in rad: each with its noise. */
static void read_unit(const struct tool_point *t, struct measurement_instrument *instrument,
                      struct measurement_visit *visit)
{
    const unsigned axis = instrument->unit;
    double *errors = visit->deviation.at;

    deviation_unit(&t->real, axis, &t->real_at, visit->at.at[axis], errors);
    for (unsigned i = 0; i < DEVIATION_OF_AXIS; i++)
        errors[i] += (i < AXIS_LINEAR_COUNT ? 1.0 : RAD_PER_MM) * instrument->sigma *
                     random_normal(instrument);
}

static void read_tool(const struct tool_point *t, struct measurement_instrument *instrument,
                      struct measurement_visit *visit)
{
    const unsigned turn = t->real.config.table_axis;
    struct point wanted = visit->at;
    struct point tool;

    if (instrument->on_table)
        wanted.at[turn] = deviation_table_angle(&t->real, &t->real_at);
    tool_point_get(t, &wanted, &tool);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        visit->deviation.at[i] =
            tool.at[i] - visit->at.at[i] + instrument->sigma * random_normal(instrument);
    if (turn < AXIS_COUNT)
        visit->deviation.at[turn] = deviation_table_angle(&t->real, &t->real_at) -
                                    visit->at.at[turn] +
                                    RAD_PER_MM * instrument->sigma * random_normal(instrument);
}

static void read_instrument(const struct simulation *s, struct measurement_instrument *instrument,
                            struct measurement_visit *visit)
{
    if (instrument->unit < AXIS_COUNT)
        read_unit(&s->tool_point, instrument, visit);
    else
        read_tool(&s->tool_point, instrument, visit);
}

/* The visit whose dwell is going on, or count. */
static uint32_t visit_at(const struct simulation *s, uint32_t count)
{
    const struct block *block = takt_controller_get_block(&s->controller);

    if (block == NULL || block->move.kind != MOVE_DWELL || block->move.line <= HEAD_LINES)
        return count;
    return (block->move.line - HEAD_LINES - 1) / VISIT_LINES;
}

static enum command_status run(struct simulation *s, struct measurement_visit *visits,
                               uint32_t count, struct measurement_instrument *instrument)
{
    uint32_t standing = count;
    char fault[DIAGNOSTIC_TEXT_MAX];

    while (takt_controller_get_state(&s->controller) < CONTROLLER_COMPLETED) {
        struct tool_point before = s->tool_point;
        uint32_t visit;

        if (interrupt_asked() || !simulation_step(s))
            return STATUS_INTERRUPTED;
        visit = visit_at(s, count);
        if (visit != standing && standing < count) {
            const struct tool_point now = s->tool_point;

            s->tool_point = before; /* the end of the dwell */
            read_instrument(s, instrument, &visits[standing]);
            s->tool_point = now;
        }
        standing = visit;
    }
    if (takt_controller_get_state(&s->controller) == CONTROLLER_COMPLETED)
        return STATUS_DONE;
    (void)takt_diagnostic_text(takt_controller_get_fault(&s->controller), fault);
    message_command_error("the machine stopped while it was measured: %s", fault);
    return STATUS_FAILED;
}

enum command_status measurement_run(struct session *session, struct measurement_visit *visits,
                                    uint32_t count, struct measurement_instrument *instrument)
{
    struct session_totals totals;
    struct simulation *simulation;
    enum command_status status;

    if (!set_program(session, visits, count))
        return STATUS_ENVIRONMENT;
    status = session_check(session, 1, &totals);
    if (status != STATUS_DONE)
        return status;
    status = simulation_open(session, &simulation);
    if (status != STATUS_DONE)
        return status;
    simulation->tool_point.is_watched = true; /* also where it has no errors, which are read then */
    status = run(simulation, visits, count, instrument);
    simulation_close(simulation);
    return status;
}
