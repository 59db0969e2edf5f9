#include "bore/write.h"

#include "base/maths.h"

#include <string.h>

/* Decimals of coordinates: 1e-9 mm, where the controller's own figures end. */
#define DECIMALS 9

static const char modes[] = "G21 G17 G40 G90 G91.1 G94\n";

/* As short as it can be: no zeros at the end, no -0. */
static void word(FILE *file, const char *name, double value)
{
    char text[64];
    size_t length;

    (void)snprintf(text, sizeof text, "%.*f", DECIMALS, value);
    length = strlen(text);
    while (text[length - 1] == '0')
        length--;
    if (text[length - 1] == '.')
        length--;
    text[length] = '\0';
    (void)fprintf(file, "%s%s", name, strcmp(text, "-0") == 0 ? "0" : text);
}

static void point(FILE *file, const double at_mm[2])
{
    word(file, " X", at_mm[0]);
    word(file, " Y", at_mm[1]);
}

/* z_mm: its height at the end. */
static void write_piece(FILE *file, const double from_mm[2], const struct bore_piece *piece,
                        double z_mm)
{
    static const char *const codes[] = {"G1", "G3", "G3.2"};
    double base[2] = {piece->centre_mm[0] - from_mm[0], piece->centre_mm[1] - from_mm[1]};

    (void)fputs(codes[piece->kind], file);
    point(file, piece->to_mm);
    if (piece->down_mm != 0)
        word(file, " Z", z_mm);
    if (piece->kind != BORE_LINE) {
        word(file, " I", base[0]);
        word(file, " J", base[1]);
    }
    if (piece->kind == BORE_INVOLUTE)
        word(file, " R", piece->base_mm);
    (void)fputc('\n', file);
}

static void write_pieces(FILE *file, const struct bore_path *p)
{
    double z_mm = 0;

    for (size_t i = 0; i < p->count; i++) {
        z_mm -= p->piece[i].down_mm;
        write_piece(file, bore_path_start(p, i), &p->piece[i], z_mm);
    }
}

static void go(FILE *file, const char *code, const double to_mm[2])
{
    (void)fputs(code, file);
    point(file, to_mm);
    (void)fputc('\n', file);
}

/* Down to a depth, then the feed of the work. */
static void plunge(FILE *file, const struct bore_job *job, double depth_mm)
{
    word(file, "G1 Z", -depth_mm);
    word(file, " F", job->plunge_mm_min);
    word(file, "\nF", job->feed_mm_min);
    (void)fputc('\n', file);
}

static void retract(FILE *file, const struct bore_job *job)
{
    if (job->depth_mm > 0) {
        word(file, "G0 Z", job->height_mm);
        (void)fputc('\n', file);
    }
}

/* What the spiral is, for the reader of the program. */
static void describe(FILE *file, const struct bore_job *job, enum bore_pass pass)
{
    struct bore_spiral s;
    struct bore_form form;

    bore_set_spiral(job, pass, &s);
    bore_spiral_form(&s, &form);
    (void)fprintf(file, "(%s: R %.9g, n %g, H %.9g, r %.9g, phi0 %.9g, psi %.9g)\n",
                  pass == BORE_ROUGHING ? "roughing" : "finishing", s.radius_mm, s.turns,
                  s.radius_mm / s.turns, s.base_mm, s.start_rad, s.turned_rad);
    (void)fprintf(file, "(involute %.9g mm, radius of curvature %.9g to %.9g mm; circle %.9g mm)\n",
                  form.length_mm, form.radius_start_mm, form.radius_end_mm,
                  MATHS_TWO_PI * s.radius_mm);
}

static void describe_helix(FILE *file, const struct bore_job *job, const struct bore_path *p)
{
    (void)fprintf(file, "(roughing: a helix, R %.9g, %u turns of %.9g mm, and the circle)\n",
                  -p->from_mm[1], bore_depth_steps(job), p->piece[0].down_mm);
}

static bool write_pass(FILE *file, const struct bore_job *job, enum bore_pass pass)
{
    bool helix = pass == BORE_ROUGHING && job->as == BORE_AS_HELIX;
    unsigned steps = helix ? 1 : bore_depth_steps(job);
    struct bore_path p;
    bool good;

    bore_make_path(job, pass, &p);
    good = !p.failed;
    if (helix && good)
        describe_helix(file, job, &p);
    else
        describe(file, job, pass);
    go(file, "G0", p.from_mm);
    for (unsigned i = 1; i <= steps && good; i++) {
        plunge(file, job, helix ? 0 : job->depth_mm * i / steps);
        write_pieces(file, &p);
        if (i < steps)
            go(file, "G1", p.from_mm);
    }
    if (pass == BORE_ROUGHING) {
        double centre[2] = {0, 0};

        go(file, "G1", centre); /* off the wall before anything else */
    }
    retract(file, job);
    bore_path_free(&p);
    return good;
}

static void write_head(FILE *file, const struct bore_job *job)
{
    static const char *const forms[] = {"involutes", "arcs", "lines", "a helix"};

    word(file, "(hole ", job->hole_mm);
    word(file, ", cutter ", job->cutter_mm);
    word(file, ", allowance ", job->allowance_mm);
    (void)fprintf(file, " mm; as %s", forms[job->as]);
    if (job->as == BORE_AS_ARCS || job->as == BORE_AS_LINES)
        word(file, " within ", job->tolerance_mm);
    (void)fprintf(file, ")\n%s", modes);
    if (job->spindle_rpm > 0) {
        word(file, "M3 S", job->spindle_rpm);
        (void)fputc('\n', file);
    }
    retract(file, job);
}

bool bore_write_job(FILE *file, const struct bore_job *job)
{
    bool good = true;

    write_head(file, job);
    if (job->pass != BORE_FINISHING)
        good = write_pass(file, job, BORE_ROUGHING);
    if (job->pass != BORE_ROUGHING && good)
        good = write_pass(file, job, BORE_FINISHING);
    (void)fputs(job->spindle_rpm > 0 ? "M5\nM2\n" : "M2\n", file);
    return good;
}

void bore_write_path(FILE *file, const char *name, const struct bore_path *p, double feed_mm_min)
{
    (void)fprintf(file, "(%s)\n%s", name, modes);
    go(file, "G0", p->from_mm);
    word(file, "F", feed_mm_min);
    (void)fputc('\n', file);
    write_pieces(file, p);
    (void)fputs("M2\n", file);
}
