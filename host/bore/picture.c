#include "bore/picture.h"

#include "base/maths.h"

#define COLUMN_WIDTH 300
#define PLOT_WIDTH   256
#define PLOT_HEIGHT  110
#define ROW_HEIGHT   150
#define MARGIN       60
#define HEAD         70

/* Setpoints drawn of a path: more would not be seen. */
#define PATH_POINTS 12000

/* One curve over time. */
struct row {
    const char *title, *colour;
    size_t field; /* in struct bore_motion */
};

static const struct row rows[] = {
    {"feed [mm/s]", "#1f6fb4", offsetof(struct bore_motion, feed_mm_s)},
    {"acceleration [mm/s²], X or Y", "#c2581b", offsetof(struct bore_motion, acceleration_mm_s2)},
    {"jerk [mm/s³], X or Y", "#7a3e9d", offsetof(struct bore_motion, jerk_mm_s3)},
};

#define ROWS (sizeof rows / sizeof rows[0])

static double field_of(const struct bore_motion *m, size_t field)
{
    return *(const double *)(const void *)((const char *)m + field);
}

static void text(FILE *file, double x, double y, const char *style, const char *words)
{
    (void)fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">%s</text>\n", x, y, style, words);
}

static void draw_path(FILE *file, const struct bore_picture *p, const struct bore_track *t,
                      double left, double top)
{
    double scale = PLOT_WIDTH / (2.1 * p->radius_mm);
    size_t every = t->count / PATH_POINTS + 1;

    (void)fputs("<polyline class=\"path\" points=\"", file);
    for (size_t i = 0; i < t->count; i += every)
        (void)fprintf(file, "%.2f,%.2f ", left + PLOT_WIDTH / 2.0 + scale * t->at_mm[i][0],
                      top + PLOT_WIDTH / 2.0 - scale * t->at_mm[i][1]);
    (void)fputs("\"/>\n", file);
}

/* The largest value of every pixel's cycles: no peak is lost. */
static void draw_curve(FILE *file, const struct row *row, const struct bore_track *t, double left,
                       double bottom, double time_s, double top_value)
{
    double cycles = time_s / t->cycle_s / PLOT_WIDTH;

    (void)fprintf(file, "<polyline fill=\"none\" stroke=\"%s\" points=\"%.2f,%.2f ", row->colour,
                  left, bottom);
    for (unsigned x = 0; x < PLOT_WIDTH && x * cycles < (double)t->count; x++) {
        size_t first = (size_t)(x * cycles);
        struct bore_motion most =
            bore_track_peaks(t, first, (size_t)maths_max((x + 1) * cycles, (double)first + 1));

        (void)fprintf(file, "%.2f,%.2f ", left + x,
                      bottom - PLOT_HEIGHT * field_of(&most, row->field) / top_value);
    }
    (void)fputs("\"/>\n", file);
}

static void draw_row(FILE *file, const struct bore_picture *p, const struct row *row, double top,
                     double time_s)
{
    double limit = field_of(&p->limit, row->field);
    double top_value = limit;
    char words[64];

    for (unsigned i = 0; i < p->tracks; i++) {
        struct bore_motion most = bore_track_peaks(&p->track[i], 0, p->track[i].count);

        top_value = maths_max(top_value, field_of(&most, row->field));
    }
    top_value *= 1.05;
    for (unsigned i = 0; i < p->tracks; i++) {
        double left = MARGIN + COLUMN_WIDTH * (double)i;
        double bottom = top + PLOT_HEIGHT;
        double at = bottom - PLOT_HEIGHT * limit / top_value;

        (void)fprintf(file,
                      "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" class=\"frame\"/>\n"
                      "<line x1=\"%.1f\" y1=\"%.2f\" x2=\"%.1f\" y2=\"%.2f\" class=\"limit\"/>\n",
                      left, top, PLOT_WIDTH, PLOT_HEIGHT, left, at, left + PLOT_WIDTH, at);
        draw_curve(file, row, &p->track[i], left, bottom, time_s, top_value);
        text(file, left, top - 6, "label", row->title);
        (void)snprintf(words, sizeof words, "%.6g", limit);
        text(file, left - 6, at + 4, "scale", words);
        (void)snprintf(words, sizeof words, "%.4g s", time_s);
        text(file, left + PLOT_WIDTH, bottom + 14, "scale", words);
    }
}

static double width_of(const struct bore_removal *r, double turns)
{
    double most = 0;

    for (size_t i = 0; i < r->count; i++)
        if (r->window[i].turn >= 1 && r->window[i].turn <= turns)
            most = maths_max(most, bore_window_width(&r->window[i]));
    return most;
}

/* Chip area by depth and way, over the turns of the spiral and its circle. */
static void draw_removal(FILE *file, const struct bore_picture *p, double top)
{
    double top_mm = 0;
    double end = p->turns + 1.5;
    char words[64];

    for (unsigned i = 0; i < p->tracks; i++)
        top_mm = maths_max(top_mm, 1.05 * width_of(&p->removal[i], end));
    for (unsigned i = 0; i < p->tracks; i++) {
        const struct bore_removal *r = &p->removal[i];
        double left = MARGIN + COLUMN_WIDTH * (double)i;

        (void)fprintf(file,
                      "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" class=\"frame\"/>\n",
                      left, top, PLOT_WIDTH, PLOT_HEIGHT);
        (void)fputs("<polyline fill=\"none\" stroke=\"#2a7d46\" points=\"", file);
        for (size_t k = 0; k < r->count && r->window[k].turn <= end; k++)
            (void)fprintf(file, "%.2f,%.2f ", left + PLOT_WIDTH * r->window[k].turn / end,
                          top + PLOT_HEIGHT *
                                    (1 - maths_min(1, bore_window_width(&r->window[k]) / top_mm)));
        (void)fputs("\"/>\n", file);
        text(file, left, top - 6, "label", "chip area / depth [mm]");
        (void)snprintf(words, sizeof words, "%.4g", top_mm);
        text(file, left - 6, top + 8, "scale", words);
        (void)snprintf(words, sizeof words, "%.4g turns", end);
        text(file, left + PLOT_WIDTH, top + PLOT_HEIGHT + 14, "scale", words);
    }
}

static void draw_head(FILE *file, const struct bore_picture *p, double height)
{
    (void)fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%.0f\">\n"
        "<style>text{font-family:sans-serif;fill:#222}.title{font-size:16px;font-weight:bold}"
        ".label{font-size:12px}.scale{font-size:10px;text-anchor:end}"
        ".frame{fill:none;stroke:#ccc}.limit{stroke:#b00;stroke-dasharray:4 3}"
        ".path{fill:none;stroke:#1f6fb4;stroke-width:0.7}</style>\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
        MARGIN + COLUMN_WIDTH * (int)p->tracks, height);
}

void bore_picture_write(FILE *file, const struct bore_picture *picture)
{
    double top = HEAD + PLOT_WIDTH + 40;
    size_t curves = (ROWS + 1) * ROW_HEIGHT;
    double time_s = 0;

    for (unsigned i = 0; i < picture->tracks; i++)
        time_s = maths_max(time_s, bore_track_time(&picture->track[i]));
    draw_head(file, picture, top + (double)curves);
    for (unsigned i = 0; i < picture->tracks; i++) {
        const struct bore_track *t = &picture->track[i];
        double left = MARGIN + COLUMN_WIDTH * (double)i;
        char words[64];

        text(file, left, 28, "title", t->name);
        (void)snprintf(words, sizeof words, "%.3f s", bore_track_time(t));
        text(file, left, 48, "label", words);
        draw_path(file, picture, t, left, HEAD);
    }
    for (size_t row = 0; row < ROWS; row++)
        draw_row(file, picture, &rows[row], top + ROW_HEIGHT * (double)row, time_s);
    draw_removal(file, picture, top + (double)(curves - ROW_HEIGHT));
    (void)fputs("</svg>\n", file);
}
