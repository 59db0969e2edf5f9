/*
 * What a console asks for besides the registers.
 */
#include "base/maths.h"
#include "program/changes.h"
#include "service/service_private.h"

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define MM_MIN_PER_MM_S 60.0

/* Parameters hold mm and degrees. What has been read ahead is not in force yet. */
static void tell_parameters(const struct service *s, unsigned first, double value[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value[i] =
            takt_changes_value(&s->controller.reader->program, first + i, s->controller.reached);
}

static void tell_point(const struct point *at, double value[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value[i] = i >= AXIS_LINEAR_COUNT ? at->at[i] * DEGREES_PER_RAD : at->at[i];
}

/* The digit of M3, M4, M5. */
static double turning(double speed_rpm)
{
    if (speed_rpm == 0.0)
        return 5.0;
    return speed_rpm > 0.0 ? 3.0 : 4.0;
}

static void tell_words(const struct service *s, double value[AXIS_COUNT])
{
    const struct program_modes *m = takt_program_get_modes(&s->controller.reader->program);
    const struct outputs *outputs = takt_controller_get_outputs(&s->controller);
    struct program_answer last;

    (void)takt_controller_get_answers(&s->controller, &last);
    value[0] = last.contact ? 1.0 : 0.0;
    value[1] = m->feed_mm_s * MM_MIN_PER_MM_S;
    value[2] = m->speed_rpm;
    value[3] = turning(outputs->spindle_speed_rpm);
    value[4] = (double)outputs->tool;
    value[5] = 0.0;
}

static void tell_probe(const struct service *s, double value[AXIS_COUNT])
{
    struct program_answer last;

    (void)takt_controller_get_answers(&s->controller, &last);
    tell_point(&last.contact_at, value);
}

void takt_service_tell(const struct service *s, enum console_fact fact, double value[AXIS_COUNT])
{
    switch (fact) {
    case CONSOLE_FACT_REFERENCE_1:
        tell_parameters(s, PARAMETER_REFERENCE_1, value);
        break;
    case CONSOLE_FACT_REFERENCE_2:
        tell_parameters(s, PARAMETER_REFERENCE_2, value);
        break;
    case CONSOLE_FACT_AXIS_OFFSET:
        tell_parameters(s, PARAMETER_AXIS_OFFSET, value);
        break;
    case CONSOLE_FACT_TOOL_OFFSET:
        tell_point(&takt_program_get_modes(&s->controller.reader->program)->tool_offset, value);
        break;
    case CONSOLE_FACT_PROBE:
        tell_probe(s, value);
        break;
    case CONSOLE_FACT_WORDS:
        tell_words(s, value);
        break;
    case CONSOLE_FACT_SYSTEM:
    default:
        tell_parameters(s, PARAMETER_SYSTEM_OFFSET + (unsigned)fact * PARAMETER_SYSTEM_STRIDE,
                        value);
        break;
    }
}
