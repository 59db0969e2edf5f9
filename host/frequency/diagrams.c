#include "frequency/diagrams.h"

#include "base/maths.h"
#include "frequency/chart.h"
#include "frequency/machines.h"

#include <math.h>

/* The families of curves that the paper draws. */
static const double radii_mm[] = {0.25, 0.5, 1, 2, 5};
static const double gravities[] = {0.01, 0.1, 1, 10};
static const double jerks_m_s3[] = {5, 50, 500, 5000};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

#define RADIUS_COLOUR       "#1f6fb4"
#define ACCELERATION_COLOUR "#c2581b"
#define JERK_COLOUR         "#7a3e9d"
#define MACHINE_COLOUR      "#222"
#define LIMIT_COLOUR        "#b00020"

/* Feed of the chord-error diagram for a machine without a feed limit: the paper's example. */
#define EXAMPLE_FEED_MM_S (5000.0 / 60)

/*
 * What a curve needs to know: the question, the diagram's range of x, and the member of its family.
 */
struct curve_context {
    const struct frequency_question *question;
    struct chart_range x;
    double member;
};

static double feed_of(const struct frequency_question *q)
{
    return maths_is_finite(q->limits.feed_mm_s) ? q->limits.feed_mm_s : EXAMPLE_FEED_MM_S;
}

/* Draws one curve of a family; its label is made of the member and a unit. */
static void draw_member(FILE *file, const struct chart *chart,
                        const struct frequency_question *question, double member,
                        const struct chart_curve *like, const char *before, const char *unit)
{
    struct curve_context context = {question, chart->x, member};
    struct chart_curve curve = *like;
    char label[64];

    (void)snprintf(label, sizeof label, "%s%g%s", before, member, unit);
    curve.label = label;
    curve.context = &context;
    chart_draw(file, chart, &curve);
}

static void draw_machine(FILE *file, const struct chart *chart,
                         const struct frequency_question *question, const struct chart_curve *like)
{
    struct curve_context context = {question, chart->x, 0};
    struct chart_curve curve = *like;

    curve.label = "machine";
    curve.context = &context;
    chart_draw(file, chart, &curve);
}

static void draw_family(FILE *file, const struct chart *chart,
                        const struct frequency_question *question, const double members[],
                        size_t count, const struct chart_curve *like, const char *before,
                        const char *unit)
{
    for (size_t i = 0; i < count; i++)
        draw_member(file, chart, question, members[i], like, before, unit);
}

/* Chord error over frequency */

static void error_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = takt_cycle_chord_error_mm(c->member, takt_cycle_step_mm(feed_of(c->question), *x)) *
         c->question->resolution_per_mm;
}

static void tolerance_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = c->question->tolerance_mm * c->question->resolution_per_mm;
}

static void vertical_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = c->question->frequency_hz;
    *y = pow(10, -6 + 12 * part);
}

static void write_chord_error(FILE *file, const struct frequency_question *question)
{
    char title[128];
    const struct chart chart = {
        title, "control frequency [Hz]", "chord error [increments]", {100, 10000}, {0.005, 200}};
    static const struct chart_curve radius = {NULL,       false,    RADIUS_COLOUR,
                                              CHART_THIN, error_at, NULL};
    static const struct chart_curve limit = {NULL,         false,        LIMIT_COLOUR,
                                             CHART_DASHED, tolerance_at, NULL};
    static const struct chart_curve own = {NULL,         false,       MACHINE_COLOUR,
                                           CHART_DASHED, vertical_at, NULL};

    (void)snprintf(title, sizeof title, "Chord error on circles at %.6g mm/min",
                   feed_of(question) * 60);
    chart_begin(file, &chart);
    draw_family(file, &chart, question, radii_mm, COUNT(radii_mm), &radius, "R ", " mm");
    draw_member(file, &chart, question, question->tolerance_mm, &limit, "", " mm");
    if (question->frequency_hz > 0)
        draw_member(file, &chart, question, question->frequency_hz, &own, "", " Hz");
    chart_end(file);
}

/* Allowed feed over radius */

static void acceleration_feed_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = 60 * takt_cycle_feed_acceleration_mm_s(*x, c->member * STANDARD_GRAVITY_MM_S2);
}

static void jerk_feed_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = 60 * takt_cycle_feed_jerk_mm_s(*x, c->member * 1000);
}

static void chord_feed_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = 60 * takt_cycle_feed_chord_mm_s(*x, c->member, c->question->tolerance_mm);
}

static void allowed_feed_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = 60 * takt_cycle_feed_allowed_mm_s(&c->question->limits, *x, NULL);
}

static void write_allowed_feed(FILE *file, const struct frequency_question *question)
{
    static const struct chart chart = {"Feed that a circle allows (J in m/s³)",
                                       "radius [mm]",
                                       "feed [mm/min]",
                                       {0.01, 1000},
                                       {10, 200000}};
    static const struct chart_curve acceleration = {
        NULL, true, ACCELERATION_COLOUR, CHART_THIN, acceleration_feed_at, NULL};
    static const struct chart_curve jerk = {NULL,       false,        JERK_COLOUR,
                                            CHART_THIN, jerk_feed_at, NULL};
    static const struct chart_curve chord = {NULL,         false,         LIMIT_COLOUR,
                                             CHART_DASHED, chord_feed_at, NULL};
    static const struct chart_curve own = {NULL,       false,           MACHINE_COLOUR,
                                           CHART_BOLD, allowed_feed_at, NULL};

    chart_begin(file, &chart);
    draw_family(file, &chart, question, gravities, COUNT(gravities), &acceleration, "", " g");
    draw_family(file, &chart, question, jerks_m_s3, COUNT(jerks_m_s3), &jerk, "J ", "");
    if (question->frequency_hz > 0)
        draw_member(file, &chart, question, question->frequency_hz, &chord, "chord at ", " Hz");
    draw_machine(file, &chart, question, &own);
    chart_end(file);
}

/* Needed frequency over feed: on a circle, or where a feed uses up an acceleration or a jerk */

static double needed(const struct curve_context *c, double radius_mm, double feed_mm_s)
{
    return takt_cycle_frequency_hz(radius_mm, feed_mm_s, c->question->tolerance_mm);
}

static void radius_need_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = needed(c, c->member, *x / 60);
}

/* R = F^2 / a */
static void acceleration_need_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;

    *x = chart_between(c->x, part);
    *y = needed(c, *x / 60 * *x / 60 / (c->member * STANDARD_GRAVITY_MM_S2), *x / 60);
}

/* R = sqrt(F^3 / J) */
static void jerk_need_at(const void *context, double part, double *x, double *y)
{
    const struct curve_context *c = context;
    double feed;

    *x = chart_between(c->x, part);
    feed = *x / 60;
    *y = needed(c, sqrt(feed * feed * feed / (c->member * 1000)), feed);
}

/* The machine's own curve goes by the radius: feed and frequency there. */
static void own_need_at(const void *context, double part, double *x, double *y)
{
    static const struct chart_range radii = {1e-3, 1e5};
    const struct curve_context *c = context;
    double radius = chart_between(radii, part);
    double feed = takt_cycle_feed_allowed_mm_s(&c->question->limits, radius, NULL);

    *x = 60 * feed;
    *y = needed(c, radius, feed);
}

static void write_needed(FILE *file, const struct frequency_question *question)
{
    static const struct chart chart = {
        "Control frequency that keeps the tolerance (R in mm, J in m/s³)",
        "feed [mm/min]",
        "frequency [Hz]",
        {100, 100000},
        {20, 10000}};
    static const struct chart_curve radius = {NULL,       true,           RADIUS_COLOUR,
                                              CHART_THIN, radius_need_at, NULL};
    static const struct chart_curve acceleration = {
        NULL, true, ACCELERATION_COLOUR, CHART_THIN, acceleration_need_at, NULL};
    static const struct chart_curve jerk = {NULL,       false,        JERK_COLOUR,
                                            CHART_THIN, jerk_need_at, NULL};
    static const struct chart_curve own = {NULL,       false,       MACHINE_COLOUR,
                                           CHART_BOLD, own_need_at, NULL};

    chart_begin(file, &chart);
    draw_family(file, &chart, question, radii_mm, COUNT(radii_mm), &radius, "R ", "");
    draw_family(file, &chart, question, gravities, COUNT(gravities), &acceleration, "", " g");
    draw_family(file, &chart, question, jerks_m_s3, COUNT(jerks_m_s3), &jerk, "J ", "");
    draw_machine(file, &chart, question, &own);
    chart_end(file);
}

const char *frequency_diagram_name(enum frequency_diagram which)
{
    static const char *const names[] = {"chord-error", "allowed-feed", "needed-frequency"};

    return names[which];
}

void frequency_diagram_write(FILE *file, const struct frequency_question *question,
                             enum frequency_diagram which)
{
    static void (*const writers[])(FILE *, const struct frequency_question *) = {
        write_chord_error, write_allowed_feed, write_needed};

    writers[which](file, question);
}

static void write_escaped(FILE *file, const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '<' || *text == '&' || *text == '>')
            (void)fprintf(file, "&#%d;", *text);
        else
            (void)fputc(*text, file);
    }
}

void frequency_page_write(FILE *file, const struct frequency_question *question,
                          const struct cycle_need *need)
{
    (void)fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                "<title>Control frequency</title></head>\n"
                "<body style=\"font-family:sans-serif;max-width:60em;margin:auto\">\n"
                "<h1>Control frequency of ",
                file);
    write_escaped(file, question->machine);
    (void)fprintf(file,
                  "</h1>\n<p>A chord error of at most %g mm needs <b>%.1f Hz</b>, for a circle of "
                  "%.4g mm radius at %.6g mm/min.</p>\n",
                  question->tolerance_mm, need->frequency_hz, need->radius_mm,
                  need->feed_mm_s * 60);
    for (unsigned i = 0; i < FREQUENCY_DIAGRAMS; i++)
        frequency_diagram_write(file, question, (enum frequency_diagram)i);
    (void)fputs("</body></html>\n", file);
}
