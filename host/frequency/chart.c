#include "frequency/chart.h"

#include <math.h>

#define WIDTH  760
#define HEIGHT 480
#define LEFT   80
#define RIGHT  110
#define TOP    50
#define BOTTOM 60

/* Points of a curve: more would not be seen. */
#define POINTS 400

struct point_px {
    double x, y;
};

double chart_between(struct chart_range range, double part)
{
    return range.low * pow(range.high / range.low, part);
}

static double part_of(struct chart_range range, double value)
{
    return log(value / range.low) / log(range.high / range.low);
}

static double x_px(const struct chart *chart, double x)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * part_of(chart->x, x);
}

static double y_px(const struct chart *chart, double y)
{
    return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * part_of(chart->y, y);
}

static void write_text(FILE *file, double x, double y, const char *anchor, const char *words)
{
    (void)fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor,
                  words);
}

static void draw_grid_line(FILE *file, const struct chart *chart, double value, bool is_vertical)
{
    double x = x_px(chart, value), y = y_px(chart, value);

    if (is_vertical)
        (void)fprintf(file, "<line class=\"grid\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>\n",
                      x, x, TOP, HEIGHT - BOTTOM);
    else
        (void)fprintf(file, "<line class=\"grid\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\"/>\n",
                      LEFT, WIDTH - RIGHT, y, y);
}

static void write_grid_number(FILE *file, const struct chart *chart, double value, bool is_vertical)
{
    char words[32];

    (void)snprintf(words, sizeof words, "%g", value);
    if (is_vertical)
        write_text(file, x_px(chart, value), HEIGHT - BOTTOM + 18, "middle", words);
    else
        write_text(file, LEFT - 8, y_px(chart, value) + 4, "end", words);
}

/*
 * Lines at 1, 2, 5 of each decade; numbers beside those at 1, and at 2 and 5 where there is room.
 */
static void draw_grid(FILE *file, const struct chart *chart, struct chart_range range,
                      bool is_vertical)
{
    static const double steps[] = {1, 2, 5};
    int first = (int)floor(log10(range.low)), last = (int)ceil(log10(range.high));

    for (int i = 0; i <= 3 * (last - first); i++) {
        int decade = i / 3;
        double value = steps[i % 3] * pow(10, first + decade);

        if (value < range.low * 0.999 || value > range.high * 1.001)
            continue;
        draw_grid_line(file, chart, value, is_vertical);
        if (i % 3 == 0 || last - first < 5)
            write_grid_number(file, chart, value, is_vertical);
    }
}

void chart_begin(FILE *file, const struct chart *chart)
{
    (void)fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
        "height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<style>.grid{stroke:#ddd}.frame{fill:none;stroke:#444}.curve{fill:none}</style>\n"
        "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n"
        "<clipPath id=\"plot\"><rect x=\"%d\" y=\"%d\" width=\"%d\" "
        "height=\"%d\"/></clipPath>\n",
        WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT, LEFT, TOP, WIDTH - LEFT - RIGHT,
        HEIGHT - TOP - BOTTOM);
    (void)fprintf(file, "<text x=\"%d\" y=\"26\" font-size=\"16\">%s</text>\n", LEFT, chart->title);
    draw_grid(file, chart, chart->x, true);
    draw_grid(file, chart, chart->y, false);
    (void)fprintf(file, "<rect class=\"frame\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>\n",
                  LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    write_text(file, 0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 18, "middle", chart->x_label);
    (void)fprintf(file,
                  "<text transform=\"translate(20 %d) rotate(-90)\" text-anchor=\"middle\">%s"
                  "</text>\n",
                  (TOP + HEIGHT - BOTTOM) / 2, chart->y_label);
}

static bool is_inside(const struct chart *chart, double x, double y)
{
    return x >= chart->x.low * 0.9999 && x <= chart->x.high * 1.0001 &&
           y >= chart->y.low * 0.9999 && y <= chart->y.high * 1.0001;
}

/* Where a curve is inside the frame for the first time and for the last. */
struct chart_ends {
    struct point_px first, last;
    unsigned inside;
};

static struct chart_ends draw_points(FILE *file, const struct chart *chart,
                                     const struct chart_curve *curve)
{
    struct chart_ends ends = {.inside = 0};

    for (unsigned i = 0; i <= POINTS; i++) {
        double x = 0, y = 0;

        curve->at(curve->context, (double)i / POINTS, &x, &y);
        if (!(x > 0) || !(y > 0) || !isfinite(x) || !isfinite(y))
            continue;
        (void)fprintf(file, "%.2f,%.2f ", x_px(chart, x), y_px(chart, y));
        if (is_inside(chart, x, y)) {
            ends.last = (struct point_px){x_px(chart, x), y_px(chart, y)};
            if (ends.inside++ == 0)
                ends.first = ends.last;
        }
    }
    return ends;
}

/* Beside the end of a curve, or above its beginning. */
static void write_label(FILE *file, const struct chart_curve *curve, const struct chart_ends *ends)
{
    struct point_px at = curve->is_first ? ends->first : ends->last;

    if (curve->is_first || at.y <= TOP + 1)
        at.y -= 4;
    else
        at.y += 4;
    (void)fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", at.x + 4, at.y,
                  curve->colour, curve->label);
}

void chart_draw(FILE *file, const struct chart *chart, const struct chart_curve *curve)
{
    static const char *const styles[] = {"stroke-width=\"1.2\"", "stroke-width=\"3\"",
                                         "stroke-width=\"1.2\" stroke-dasharray=\"6 4\""};
    struct chart_ends ends;

    (void)fprintf(file,
                  "<polyline class=\"curve\" clip-path=\"url(#plot)\" stroke=\"%s\" %s points=\"",
                  curve->colour, styles[curve->line]);
    ends = draw_points(file, chart, curve);
    (void)fputs("\"/>\n", file);
    if (ends.inside > 0 && curve->label != NULL)
        write_label(file, curve, &ends);
}

void chart_end(FILE *file)
{
    (void)fputs("</svg>\n", file);
}
