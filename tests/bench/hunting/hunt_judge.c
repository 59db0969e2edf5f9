/*
 * A second verifier of setpoints, for `hunt`: it shares no code with the controller or with takt's
 * own verifier.
 *
 *     hunt_judge CASE TRACE.csv [WORK]        CASE: written by hunt, see read_case; -: standard input
 *
 * The programmed path is cut into straight pieces, the setpoints are the corners of a polyline that
 * begins where the program starts. Is there a way to walk along both, never backwards, with no more
 * than the tolerance between them? Where the polyline's corner k is beside piece j, the places of
 * the piece that can be come to are one interval, and so are those of step k beside the end of
 * piece j (Alt and Godau, Computing the Frechet distance between two polygonal curves, 1995). So
 * one pass over the steps decides, exactly.
 *
 * Tolerance of a place: P of its motion, or ORDER_MM where it must be exact (how exact is measured
 * apart, from the true curve), and what a piece is off its arc. Between two setpoints the axes do
 * not go straight: with second differences d a curve is off its chord by d / 8, a junction passed
 * in an exact path by half a step at most; ends of motions may be off a step by that.
 *
 * What takes more than so much WORK (pieces looked at beside a step) is not verified, and told:
 * unjudged.
 *
 * Lengths are over all axes, in mm, a radian counts as one. Figures are printed, a line each: NAME
 * VALUE [PLACE].
 */
#include "hunt_walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pieces that are looked at beside steps: some half a minute. */
#define WORK_MOST 400000000

/* The tolerance may be exceeded by this for rounding. */
#define TOLERANCE_ROOM 1e-6

/*
 * Largest of v, a, j by differences as parts of the limits, less what rounding of the trace can do.
 */
static void verify_limits(const struct verifier *j)
{
    static const char *const names[] = {"velocity", "acceleration", "jerk"};
    static const double weights[] = {2, 4, 8};

    const size_t rows = j->rows + (j->stands ? 3 : 0);

    for (unsigned k = 0; k < 3; k++) {
        double worst = 0;
        size_t where = 0;

        for (size_t row = 1; row < rows; row++) {
            for (unsigned i = 0; i < j->axes; i++) {
                const double x[] = {row_of(j, row)[i], row_of(j, row - 1)[i],
                                    row_of(j, row > 2 ? row - 2 : 0)[i],
                                    row_of(j, row > 3 ? row - 3 : 0)[i]};
                const double d[] = {x[0] - x[1], x[0] - 2 * x[1] + x[2],
                                    x[0] - 3 * x[1] + 3 * x[2] - x[3]};
                const double units = fabs(d[k]) / j->scale[i] - weights[k] * ROUNDING;
                const double part = units / pow(j->cycle_s, k + 1) / j->limit[i][k];

                if (part > worst) {
                    worst = part;
                    where = row;
                }
            }
        }
        printf("%s %.9g %zu\n", names[k], worst, where - 1);
    }
}

static double segment_distance(unsigned axes, const double *start, const double *way,
                               double square_mm2, const double *p)
{
    double closest = 0, square = 0;

    for (unsigned i = 0; i < axes; i++)
        closest += (p[i] - start[i]) * way[i];
    closest = square_mm2 > 0 ? fmin(fmax(closest / square_mm2, 0), 1) : 0;
    for (unsigned i = 0; i < axes; i++) {
        const double off = p[i] - start[i] - closest * way[i];

        square += off * off;
    }
    return sqrt(square);
}

/*
 * Most that a setpoint is off all of the path, whatever the order, as a part of the tolerance of
 * the nearest piece.
 */
static void verify_tube(struct verifier *j)
{
    double worst = 0;
    size_t where = 0;

    for (size_t k = 0; k < j->rows && j->work <= j->work_most; k++) {
        double least = (double)INFINITY;

        for (size_t n = 0; n < j->pieces && least > worst; n++) {
            const struct piece *p = &j->piece[n];

            j->work++;
            least = fmin(least,
                         segment_distance(j->axes, p->start, p->way, p->square_mm2, row_of(j, k)) /
                             p->tolerance_mm);
        }
        if (least > worst) {
            worst = least;
            where = k;
        }
    }
    printf("tube %.6g %zu\n", worst, where > 0 ? where - 1 : 0);
}

/* Most that an end of a motion is off all steps, likewise. */
static void verify_corners(struct verifier *j)
{
    double worst = 0;
    unsigned line = 0;

    for (size_t m = 0; m < j->motions && j->work <= j->work_most; m++) {
        const struct motion *motion = &j->motion[m];
        const double within_mm = motion->tolerance_mm > 0 ? motion->tolerance_mm : ORDER_MM;
        double least = (double)INFINITY;

        for (size_t k = 1; k < j->rows && least > worst; k++) {
            double way[AXES_MAX], off_mm;

            j->work++;
            step_of(j, k, way);
            off_mm = segment_distance(j->axes, row_of(j, k - 1), way,
                                      pow(length_of(way, 0, j->axes), 2), motion->end);
            least = fmin(least, (off_mm - j->bend[k]) / within_mm);
        }
        note(&worst, &line, least, motion->line);
    }
    printf("corner %.6g %u\n", worst, line);
}

static void verify_travel(const struct verifier *j)
{
    double programmed_mm = 0, travelled_mm = 0, off[AXES_MAX];
    const double *end = j->motions > 0 ? j->motion[j->motions - 1].end : j->start;

    for (size_t n = 0; n < j->pieces; n++)
        programmed_mm += j->piece[n].length_mm;
    for (size_t k = 1; k < j->rows; k++) {
        double step[AXES_MAX];

        step_of(j, k, step);
        travelled_mm += length_of(step, 0, j->axes);
    }
    for (unsigned i = 0; i < j->axes; i++)
        off[i] = row_of(j, j->rows - 1)[i] - end[i];
    printf("programmed_mm %.9g\ntravelled_mm %.9g\n", programmed_mm, travelled_mm);
    printf("end %.6g\n", length_of(off, 0, j->axes));
}

/* How far from one is it, and where? Each of these may be so much work. */
static double verify_disorder(struct verifier *j, const struct walk *w)
{
    double factor;

    j->work = 0;
    factor = least_factor(j);
    printf("order %.6g %zu\n", factor, w->lost_row > 0 ? w->lost_row - 1 : j->rows - 1);
    j->work = 0;
    verify_tube(j);
    verify_corners(j);
    j->work = 0;
    return factor;
}

static void verify_path(struct verifier *j)
{
    double *before = make(j->motions + 1, sizeof *before);
    const double factor = 1 + TOLERANCE_ROOM;
    struct walk w;

    for (size_t m = 0; m < j->motions; m++)
        before[m + 1] = before[m] + j->motion[m].time_s;
    j->reach = make(j->pieces, sizeof *j->reach);
    w = walk_along(j, factor, true, before);
    if (w.tired_row > 0) {
        printf("unjudged %llu %zu\n", (unsigned long long)j->work, w.tired_row - 1);
    } else if (w.arrived) {
        printf("order 1\n");
    } else {
        w = walk_along(j, verify_disorder(j, &w), true, before);
    }
    printf("back %.6g %u\n", w.back_part, w.back_line);
    printf("exact %.6g %u\n", w.off_mm, w.off_line);
    printf("feed %.9g %u\n", w.feed_ratio, w.feed_line);
    printf("stops %u %u\n", w.stops, w.stop_line);
    free(before);
    free(j->reach);
}

static FILE *open_file(const char *name)
{
    FILE *file = strcmp(name, "-") == 0 ? stdin : fopen(name, "r");

    if (file == NULL)
        fail(name);
    return file;
}

int main(int count, char **word)
{
    struct verifier j = {.work_most = WORK_MOST};
    FILE *file;

    if (count != 3 && count != 4)
        fail("usage: hunt_judge CASE TRACE.csv [WORK]");
    if (count == 4)
        j.work_most = strtoull(word[3], NULL, 10);
    file = open_file(word[1]);
    read_case(&j, file);
    (void)fclose(file);
    file = open_file(word[2]);
    read_trace(&j, file);
    (void)fclose(file);
    cut(&j);
    measure_bends(&j);
    verify_limits(&j);
    verify_travel(&j);
    if (j.pieces > 0)
        verify_path(&j);
    free_case(&j);
    return 0;
}
