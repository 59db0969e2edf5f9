#include "tuning/picture.h"

#include "base/maths.h"

#include <math.h>

#define WIDTH  760
#define HEIGHT 300
#define LEFT   80
#define RIGHT  20
#define TOP    40
#define BOTTOM 40

/* Points drawn of a curve, the least and the greatest of a piece each: more would not be seen. */
#define PIECES 700

struct frame {
    double end_s, low, high;
};

static double value_of(const struct picture_curve *c, size_t k)
{
    const struct tuning_record *r = c->record;
    const double of[] = {r->input[k], r->position[k], r->input[k] - r->position[k]};

    return (of[c->of] - c->from) * c->times;
}

static struct frame frame_of(const struct picture_curve *curve, unsigned curves)
{
    struct frame f = {0, MATHS_INFINITY, -MATHS_INFINITY};

    for (unsigned i = 0; i < curves; i++) {
        const struct tuning_record *r = curve[i].record;

        f.end_s = fmax(f.end_s, (double)r->count * r->cycle_s);
        for (size_t k = 0; k < r->count; k++) {
            f.low = fmin(f.low, value_of(&curve[i], k));
            f.high = fmax(f.high, value_of(&curve[i], k));
        }
    }
    if (!(f.high > f.low)) {
        f.low -= 1;
        f.high += 1;
    }
    return f;
}

static double x_of(const struct frame *f, double t)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * t / f->end_s;
}

static double y_of(const struct frame *f, double value)
{
    return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (value - f->low) / (f->high - f->low);
}

static void draw(FILE *file, const struct frame *f, const struct picture_curve *c)
{
    const struct tuning_record *r = c->record;
    const size_t piece = r->count / PIECES + 1;

    (void)fprintf(file, "<polyline fill=\"none\" stroke=\"%s\" points=\"", c->colour);
    for (size_t from = 0; from < r->count; from += piece) {
        double low = MATHS_INFINITY, high = -MATHS_INFINITY;

        for (size_t k = from; k < from + piece && k < r->count; k++) {
            low = fmin(low, value_of(c, k));
            high = fmax(high, value_of(c, k));
        }
        const double x = x_of(f, (double)from * r->cycle_s);

        (void)fprintf(file, "%.1f,%.1f ", x, y_of(f, low));
        if (high > low)
            (void)fprintf(file, "%.1f,%.1f ", x, y_of(f, high));
    }
    (void)fputs("\"/>\n", file);
}

static void text(FILE *file, double x, double y, const char *anchor, const char *colour,
                 const char *words)
{
    (void)fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">%s</text>\n", x,
                  y, anchor, colour, words);
}

/* The frame, its least and greatest value, and where 0 is. */
static void draw_frame(FILE *file, const struct frame *f)
{
    char words[32];

    (void)fprintf(
        file,
        "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#999\"/>\n",
        LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    if (f->low < 0 && f->high > 0)
        (void)fprintf(file, "<path stroke=\"#ccc\" d=\"M%d %.1f H%d\"/>\n", LEFT, y_of(f, 0),
                      WIDTH - RIGHT);
    (void)snprintf(words, sizeof words, "%.4g", f->high);
    text(file, LEFT - 6, TOP + 10, "end", "#333", words);
    (void)snprintf(words, sizeof words, "%.4g", f->low);
    text(file, LEFT - 6, HEIGHT - BOTTOM, "end", "#333", words);
    (void)snprintf(words, sizeof words, "%.3g s", f->end_s);
    text(file, WIDTH - RIGHT, HEIGHT - BOTTOM + 18, "end", "#333", words);
}

void picture_write(FILE *file, const char *title, const char *y_label,
                   const struct picture_curve *curve, unsigned curves)
{
    const struct frame f = frame_of(curve, curves);

    (void)fprintf(file,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                  "font-family=\"sans-serif\" font-size=\"12\">\n",
                  WIDTH, HEIGHT);
    text(file, LEFT, 16, "start", "#000", title);
    text(file, LEFT, HEIGHT - BOTTOM + 18, "start", "#333", y_label);
    draw_frame(file, &f);
    for (unsigned i = 0; i < curves; i++) {
        draw(file, &f, &curve[i]);
        text(file, WIDTH - RIGHT - 120.0 * (curves - 1 - i), 16, "end", curve[i].colour,
             curve[i].label);
    }
    (void)fputs("</svg>\n", file);
}
