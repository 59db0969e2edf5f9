#include "hunt_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An arc's piece is off it by this part of the tolerance at most. */
#define CUT_PART 0.002

void fail(const char *what)
{
    (void)fprintf(stderr, "hunt_judge: %s\n", what);
    exit(2);
}

void note(double *worst, unsigned *line, double value, unsigned where)
{
    if (value > *worst) {
        *worst = value;
        *line = where;
    }
}

void *make(size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);

    if (memory == NULL)
        fail("no memory");
    return memory;
}

static double number(FILE *file)
{
    double value;

    if (fscanf(file, "%lf", &value) != 1)
        fail("a number is missing in the case");
    return value;
}

double length_of(const double *v, unsigned from, unsigned to)
{
    double square = 0;

    for (unsigned i = from; i < to; i++)
        square += v[i] * v[i];
    return sqrt(square);
}

/* Point of a motion at a part of it: angle, radius and all other axes go evenly. */
void place(const struct verifier *j, const struct motion *m, double part, double *p)
{
    const double angle = m->angle_rad + part * m->sweep_rad;
    const double radius = m->radius_mm[0] + part * (m->radius_mm[1] - m->radius_mm[0]);

    for (unsigned i = 0; i < j->axes; i++)
        p[i] = m->start[i] + part * (m->end[i] - m->start[i]);
    if (!m->is_arc)
        return;
    p[m->first] = m->centre[0] + radius * cos(angle);
    p[m->second] = m->centre[1] + radius * sin(angle);
}

static void read_arc(FILE *file, struct motion *m)
{
    m->first = (unsigned)number(file);
    m->second = (unsigned)number(file);
    m->centre[0] = number(file);
    m->centre[1] = number(file);
    m->sweep_rad = number(file);
}

static void measure_arc(struct motion *m)
{
    const double x = m->start[m->first] - m->centre[0];
    const double y = m->start[m->second] - m->centre[1];

    m->angle_rad = atan2(y, x);
    m->radius_mm[0] = hypot(x, y);
    m->radius_mm[1] = hypot(m->end[m->first] - m->centre[0], m->end[m->second] - m->centre[1]);
}

void measure_motion(const struct verifier *j, struct motion *m)
{
    double way[AXES_MAX] = {0};

    if (m->is_arc)
        measure_arc(m);
    for (unsigned i = 0; i < j->axes; i++)
        way[i] = m->end[i] - m->start[i];
    if (m->is_arc) {
        way[m->first] = m->sweep_rad * (m->radius_mm[0] + m->radius_mm[1]) / 2;
        way[m->second] = 0;
    }
    m->linear_mm = length_of(way, 0, j->linear_axes);
    m->turning_rad = length_of(way, j->linear_axes, j->axes);
}

struct motion *add_motion(struct verifier *j)
{
    struct motion *m;

    if (j->motions == j->motion_room) {
        j->motion_room = j->motion_room > 0 ? 2 * j->motion_room : 256;
        j->motion = realloc(j->motion, j->motion_room * sizeof *j->motion);
        if (j->motion == NULL)
            fail("no memory");
    }
    m = &j->motion[j->motions++];
    memset(m, 0, sizeof *m);
    memcpy(m->start, j->motions > 1 ? m[-1].end : j->start, sizeof m->start);
    return m;
}

/* KIND LINE TOLERANCE TIME RAPID STOPS END..., arcs: FIRST SECOND CENTRE CENTRE SWEEP */
static bool read_motion(struct verifier *j, FILE *file)
{
    char kind[2];
    struct motion *m;

    if (fscanf(file, "%1s", kind) != 1)
        return false;
    m = add_motion(j);
    m->is_arc = kind[0] == 'A';
    m->line = (unsigned)number(file);
    m->tolerance_mm = number(file);
    m->time_s = number(file);
    m->is_rapid = number(file) > 0;
    m->stops = number(file) > 0;
    for (unsigned i = 0; i < j->axes; i++)
        m->end[i] = number(file) * j->scale[i];
    if (m->is_arc)
        read_arc(file, m);
    measure_motion(j, m);
    return true;
}

/* AXES LINEAR CYCLE FEED_FACTOR COMPLETED, of each axis SCALE V A J START, then motions. */
void read_case(struct verifier *j, FILE *file)
{
    unsigned end;

    j->axes = (unsigned)number(file);
    if (j->axes > AXES_MAX)
        fail("too many axes");
    j->linear_axes = (unsigned)number(file);
    j->cycle_s = number(file);
    j->feed_factor = number(file);
    end = (unsigned)number(file);
    j->stands = end > 0;
    j->completed = end > 1;
    for (unsigned i = 0; i < j->axes; i++) {
        j->scale[i] = number(file);
        for (unsigned k = 0; k < 3; k++)
            j->limit[i][k] = number(file);
        j->start[i] = number(file) * j->scale[i];
    }
    while (read_motion(j, file)) {
    }
}

static void add_piece(struct verifier *j, size_t motion, double from, double to, double cut_mm)
{
    const struct motion *m = &j->motion[motion];
    double end[AXES_MAX];
    struct piece *p;

    if (j->pieces == j->piece_room) {
        j->piece_room = j->piece_room > 0 ? 2 * j->piece_room : 1024;
        j->piece = realloc(j->piece, j->piece_room * sizeof *j->piece);
        if (j->piece == NULL)
            fail("no memory");
    }
    p = &j->piece[j->pieces++];
    memset(p, 0, sizeof *p);
    p->motion = motion;
    p->from = from;
    p->to = to;
    p->ends = to >= 1;
    p->tolerance_mm = (m->tolerance_mm > 0 ? m->tolerance_mm : ORDER_MM) + cut_mm;
    place(j, m, from, p->start);
    place(j, m, to, end);
    for (unsigned i = 0; i < j->axes; i++) {
        if (p->ends)
            end[i] = m->end[i];
        if (from <= 0)
            p->start[i] = m->start[i];
        p->way[i] = end[i] - p->start[i];
    }
    p->length_mm = length_of(p->way, 0, j->axes);
    p->square_mm2 = p->length_mm * p->length_mm;
}

/* A chord of angle w is off its arc by r w^2 / 8. */
void cut(struct verifier *j)
{
    for (size_t k = 0; k < j->motions; k++) {
        const struct motion *m = &j->motion[k];
        const double tolerance_mm = m->tolerance_mm > 0 ? CUT_PART * m->tolerance_mm : ORDER_MM / 4;
        size_t count = 1;

        if (m->is_arc) {
            const double widest = sqrt(8 * tolerance_mm / fmax(m->radius_mm[0], m->radius_mm[1]));

            count = (size_t)ceil(fabs(m->sweep_rad) / fmin(widest, 0.5));
        }
        for (size_t i = 0; i < count; i++)
            add_piece(j, k, (double)i / (double)count, (double)(i + 1) / (double)count,
                      m->is_arc ? tolerance_mm : 0);
    }
}

/* Which columns of the trace are setpoints; returns how many. */
static unsigned find_columns(char *head, bool *wanted, unsigned room)
{
    unsigned found = 0, column = 0;

    for (char *word = strtok(head, ",\n"); word != NULL && column < room; column++) {
        wanted[column] = strncmp(word, "set_", 4) == 0;
        found += wanted[column] ? 1 : 0;
        word = strtok(NULL, ",\n");
    }
    return found;
}

static void read_row(struct verifier *j, char *line, const bool *wanted, double *row)
{
    unsigned axis = 0, column = 0;

    for (char *at = line; at != NULL && axis < j->axes; column++) {
        if (wanted[column]) {
            row[axis] = strtod(at, NULL) * j->scale[axis];
            axis++;
        }
        at = strchr(at, ',');
        at = at != NULL ? at + 1 : NULL;
    }
    if (axis < j->axes)
        fail("a row of the trace is too short");
}

double *add_row(struct verifier *j)
{
    if (j->axes == 0)
        fail("the case has no axis");
    if (j->rows == j->row_room) {
        j->row_room = j->row_room > 0 ? 2 * j->row_room : 4096;
        j->setpoint = realloc(j->setpoint, j->row_room * j->axes * sizeof *j->setpoint);
        if (j->setpoint == NULL)
            fail("no memory");
    }
    j->rows++;
    return &j->setpoint[(j->rows - 1) * j->axes];
}

void read_trace(struct verifier *j, FILE *file)
{
    static char line[4096];
    bool wanted[64] = {false};

    if (fgets(line, sizeof line, file) == NULL || find_columns(line, wanted, 64) != j->axes)
        fail("the trace has other axes than the case");
    memcpy(add_row(j), j->start, j->axes * sizeof *j->setpoint);
    while (fgets(line, sizeof line, file) != NULL)
        read_row(j, line, wanted, add_row(j));
}

const double *row_of(const struct verifier *j, size_t k)
{
    return &j->setpoint[(k < j->rows ? k : j->rows - 1) * j->axes];
}

/* From row k - 1 to row k. */
void step_of(const struct verifier *j, size_t k, double *step)
{
    for (unsigned i = 0; i < j->axes; i++)
        step[i] = row_of(j, k)[i] - row_of(j, k > 0 ? k - 1 : 0)[i];
}

/* |x(k+1) - 2 x(k) + x(k-1)|, standing still before and after. */
void measure_bends(struct verifier *j)
{
    j->bend = make(j->rows, sizeof *j->bend);
    for (size_t k = 0; k < j->rows; k++) {
        const double *a = row_of(j, k > 0 ? k - 1 : 0), *b = row_of(j, k), *c = row_of(j, k + 1);
        double d[AXES_MAX];

        for (unsigned i = 0; i < j->axes; i++)
            d[i] = a[i] - 2 * b[i] + c[i];
        j->bend[k] = length_of(d, 0, j->axes);
    }
}

void free_case(struct verifier *j)
{
    free(j->motion);
    free(j->piece);
    free(j->setpoint);
    free(j->bend);
}
