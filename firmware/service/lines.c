/*
 * Lines of a console: one program while lines come, ended when no more do.
 *
 *     sender    line line line line                       line
 *     program   |    |    |    | quiet, little ahead: end  | the next program, with the modes of the last
 *
 * A sender that waits for an answer before it sends the next line is quiet for as long as its way
 * is. So the end waits, and before the first motion too: then as much is known of the path as of a
 * program in a file, and its setpoints are the same.
 */
#include "service/service_private.h"

#include <stddef.h>

/*
 * Longest way of an answer and the next line: some of a USB adapter's 16 ms. A jog or a line by
 * hand waits as long.
 */
#define QUIET_S 0.1

/* A sender that needs longer than this for the lines of a whole look-ahead is not waited for. */
#define BEGIN_S 1.0

static bool has_passed(const struct service *s, uint32_t since_cycle, double time_s)
{
    return machine_cycle_s(&s->controller.machine) * (double)(s->cycles - since_cycle) >= time_s;
}

/* So many blocks are ahead that the end of what is known is far away. */
static bool is_ahead(struct service *s)
{
    struct motion *motion = &s->controller.motion;

    return motion_has_ceiling(motion) &&
           takt_motion_ahead(motion) > s->controller.machine.look_ahead_blocks / 2;
}

/* Nothing has come. */
static long wait(struct service *s)
{
    if (has_passed(s, s->begun_cycle, BEGIN_S))
        takt_controller_begin(&s->controller);
    if (!has_passed(s, s->asked_cycle, QUIET_S) || is_ahead(s))
        return SOURCE_LATER;
    s->streams_to_end = true;
    return SOURCE_END;
}

static long read_lines(void *context, char *buffer, size_t size)
{
    struct service *s = context;
    const long count = s->lines.read(s->lines.context, buffer, size);

    if (s->has_line)
        s->asked_cycle = s->cycles;
    s->has_line = count > 0;
    if (count == SOURCE_LATER)
        return wait(s);
    s->streams_to_end = count == SOURCE_END;
    return count;
}

/*
 * A line that would leave the travel ends the program: those after it reckon with where it should
 * have led. So does one in a contour that is compensated, which has become another.
 */
static bool refuse_line(void *listener, const struct diagnostic *why)
{
    const struct service *s = listener;
    const struct service_lines *lines = &s->config.lines;

    lines->refuse(lines->context, why);
    return why->code != TAKT_ERROR_TRAVEL_EXCEEDED &&
           takt_program_get_modes(&s->controller.reader->program)->cutter_code == NULL;
}

bool takt_service_start_lines(struct service *s)
{
    struct controller_config config = takt_service_controller_config(s);
    const struct service_lines *lines = &s->config.lines;

    if (lines->open == NULL)
        return false;
    lines->open(lines->context, &s->lines);
    config.source = (struct source){.read = read_lines, .context = s};
    config.refuse = refuse_line;
    config.listener = s;
    takt_service_start_text_of(s, &config);
    s->streams = true;
    s->streams_to_end = s->has_line = false;
    s->asked_cycle = s->begun_cycle = s->cycles;
    return true;
}

/* M2, M30 or % has ended it: the next line begins as a program does. */
static void end_as_program(struct service *s)
{
    takt_controller_quieten(&s->controller);
    s->has_modes = false;
}

static enum takt_error cause_of(const struct service *s, enum panel_outcome outcome)
{
    if (outcome == PANEL_OUTCOME_COMPLETED)
        return TAKT_OK;
    return s->alarm_text.code != TAKT_OK ? s->alarm_text.code : TAKT_ERROR_ENDED;
}

void takt_service_end_lines(struct service *s, enum panel_outcome outcome)
{
    const struct service_lines *lines = &s->config.lines;

    s->streams = false;
    if (outcome == PANEL_OUTCOME_COMPLETED && !s->streams_to_end)
        end_as_program(s);
    lines->end(lines->context, cause_of(s, outcome));
}
