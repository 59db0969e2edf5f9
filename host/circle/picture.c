#include "circle/picture.h"

#include "base/maths.h"

#include <math.h>

#define WIDTH     640
#define CENTRE_Y  370
#define HEIGHT    760
#define RADIUS_PX 200.0 /* of the programmed circle */
#define STEP_PX   25.0  /* of a division, */
#define STEPS     4     /* of which this many are drawn to either side */

/* Places drawn of a turn: more would not be seen. */
#define PLACES 7200

struct plot {
    FILE *file;
    double px_per_mm; /* of deviations */
};

static const char *const colours[CIRCLE_WAYS] = {"#1f6fb4", "#c2581b"};
static const char *const names[CIRCLE_WAYS] = {"G3", "G2"};

static void text(FILE *file, double x, double y, const char *anchor, const char *words)
{
    (void)fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor,
                  words);
}

/* 1, 2 or 5 of a power of ten, so that no deviation is beyond the last division. */
static double division_mm(const struct circle_picture *p)
{
    const struct circle_figures *both = &p->figures[CIRCLE_WAYS];
    const double most = maths_max(maths_abs(both->most_mm), maths_abs(both->least_mm)) / STEPS;
    const double decade = pow(10, floor(log10(maths_max(most, 1e-9))));

    return decade * (most <= decade ? 1 : most <= 2 * decade ? 2 : most <= 5 * decade ? 5 : 10);
}

static void draw_grid(const struct plot *plot, double division)
{
    char words[48];

    for (int i = -STEPS; i <= STEPS; i++)
        (void)fprintf(plot->file, "<circle class=\"%s\" cx=\"%d\" cy=\"%d\" r=\"%.1f\"/>\n",
                      i == 0 ? "nominal" : "grid", WIDTH / 2, CENTRE_Y, RADIUS_PX + STEP_PX * i);
    (void)snprintf(words, sizeof words, "%g um a division", 1000 * division);
    text(plot->file, WIDTH / 2.0, CENTRE_Y + 8, "middle", words);
}

static void draw_axes(const struct plot *plot, const struct circle_picture *p)
{
    const double end = RADIUS_PX + STEP_PX * (STEPS + 0.4);
    const char first[] = {'+', p->axis[0], '\0'}, second[] = {'+', p->axis[1], '\0'};

    (void)fprintf(plot->file, "<path class=\"grid\" d=\"M%.1f %d H%.1f M%d %.1f V%.1f\"/>\n",
                  WIDTH / 2.0 - end, CENTRE_Y, WIDTH / 2.0 + end, WIDTH / 2, CENTRE_Y - end,
                  CENTRE_Y + end);
    text(plot->file, WIDTH / 2.0 + end - 4, CENTRE_Y - 6, "end", first);
    text(plot->file, WIDTH / 2.0 + 6, CENTRE_Y - end + 10, "start", second);
}

static void draw_turn(const struct plot *plot, const struct circle_turn *turn, const char *colour)
{
    const size_t every = turn->count / PLACES + 1;

    (void)fprintf(plot->file, "<polyline stroke=\"%s\" points=\"", colour);
    for (size_t k = 0; k < turn->count; k += every) {
        const double r = RADIUS_PX + plot->px_per_mm * turn->place[k].out_mm;
        double sine, cosine;

        takt_maths_sincos(turn->place[k].angle_rad, &sine, &cosine);
        (void)fprintf(plot->file, "%.2f,%.2f ", WIDTH / 2.0 + r * cosine, CENTRE_Y - r * sine);
    }
    (void)fputs("\"/>\n", plot->file);
}

/* In um, without a minus before 0.00. */
static double shown_um(double mm)
{
    return takt_maths_round(1e5 * mm) / 100 + 0.0;
}

static void write_figures(FILE *file, const char *name, const struct circle_figures *f, double y)
{
    char words[160];

    (void)snprintf(words, sizeof words,
                   "%s: G %.2f um, F max %.2f, F min %.2f; centre %.2f, %.2f um off", name,
                   shown_um(f->deviation_mm), shown_um(f->most_mm), shown_um(f->least_mm),
                   shown_um(f->centre_mm[0]), shown_um(f->centre_mm[1]));
    text(file, 40, y, "start", words);
}

static void write_legend(FILE *file, const struct circle_picture *p)
{
    for (unsigned way = 0; way < CIRCLE_WAYS; way++) {
        const double y = HEIGHT - 60 + 18.0 * way;

        (void)fprintf(file, "<line x1=\"16\" x2=\"34\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
                      y - 4, y - 4, colours[way]);
        write_figures(file, names[way], &p->figures[way], y);
    }
    write_figures(file, "both", &p->figures[CIRCLE_WAYS], HEIGHT - 24);
}

void circle_picture_write(FILE *file, const struct circle_picture *p)
{
    const double division = division_mm(p);
    const struct plot plot = {file, STEP_PX / division};
    char words[160];

    (void)fprintf(file,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                  "viewBox=\"0 0 %d %d\">\n"
                  "<style>text { font: 13px sans-serif } .grid, .nominal, polyline { fill: none; "
                  "stroke-width: 1 } .grid { stroke: #ddd } .nominal { stroke: #888 }</style>\n"
                  "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                  WIDTH, HEIGHT, WIDTH, HEIGHT);
    (void)snprintf(words, sizeof words, "circle %c%c, R %g mm, F%g", p->axis[0], p->axis[1],
                   p->radius_mm, p->feed_mm_min);
    text(file, WIDTH / 2.0, 28, "middle", words);
    draw_grid(&plot, division);
    draw_axes(&plot, p);
    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        draw_turn(&plot, &p->turn[way], colours[way]);
    write_legend(file, p);
    (void)fputs("</svg>\n", file);
}
