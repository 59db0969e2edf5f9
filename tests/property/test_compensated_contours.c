/*
 * Compensated paths verified by geometry. Random contours of lines and arcs run over hills and into
 * valleys of every width, short steps in inner corners among them; every point of the tool's path
 * must be at the tool's radius from the programmed path, nowhere nearer, and on its side. The
 * verifier here shares no code with the room offset.
 *
 * A contour never turns back in its general direction, so there is a right answer for every tool:
 * the path of a ball rolling over it. What the tool cannot reach within the look-ahead may be
 * refused, but not often.
 */
#include "cutter_compensation/cutter_compensation.h"

#include "base/maths.h"

#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CONTOURS   1500
#define PIECES_MAX 60
#define TEXT_MAX   16384
#define EXACT_MM   1e-9
/* A blunt outer corner, which has one point instead of an arc, stands off by so much more. */
#define BLUNT_MM (COMPENSATION_BLUNT_MM + EXACT_MM)
/* Sharp corners have right angles at most: their tips stand off by so much of the radius. */
#define SHARP_MAX_RATIO 0.41422
/* Points looked at on each move of the tool. */
#define SAMPLES 40

struct piece {
    bool arc, clockwise;
    double from[2], to[2], centre[2];
};

static struct piece wanted[PIECES_MAX];
static unsigned wanted_count;
static char text[TEXT_MAX];
static uint64_t seed;

static struct program program;
static struct parameters parameters;
static struct cutter_compensation offset;
static struct source_text source_text;

void setUp(void)
{
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

/* How a contour is laid into the plane. */
struct layout {
    unsigned plane; /* 0: G17 ... */
    double mirror[2];
    double turn_rad;
    double radius;
    bool sharp;
};

static const char letters[3][3] = {"XY", "ZX", "YZ"};
static const char centre_letters[3][3] = {"IJ", "KI", "JK"};

static size_t add(size_t at, const char *format, ...) __attribute__((format(printf, 2, 3)));

#include <stdarg.h>

static size_t add(size_t at, const char *format, ...)
{
    va_list arguments;
    int length;

    va_start(arguments, format);
    length = vsnprintf(text + at, sizeof text - at, format, arguments);
    va_end(arguments);
    TEST_ASSERT_TRUE(length > 0 && at + (size_t)length < sizeof text);
    return at + (size_t)length;
}

static void lay(const struct layout *l, const double p[2], double q[2])
{
    double x = p[0] * l->mirror[0];
    double y = p[1] * l->mirror[1];

    q[0] = x * cos(l->turn_rad) - y * sin(l->turn_rad);
    q[1] = x * sin(l->turn_rad) + y * cos(l->turn_rad);
}

static size_t add_line(size_t at, const struct layout *l, const double to[2])
{
    double q[2];

    lay(l, to, q);
    return add(at, "G1 %c%.13f %c%.13f\n", letters[l->plane][0], q[0], letters[l->plane][1], q[1]);
}

/* An arc from one point to another, bulging to the tool's side (bulge > 0) or away from it. */
static size_t add_arc(size_t at, const struct layout *l, const double from[2], const double to[2],
                      double radius, bool hill)
{
    const double dx = to[0] - from[0];
    const double dy = to[1] - from[1];
    const double half = 0.5 * hypot(dx, dy);
    const double rise = sqrt(radius * radius - half * half) / (2.0 * half) * (hill ? 1.0 : -1.0);
    const double centre[2] = {0.5 * (from[0] + to[0]) + rise * dy,
                              0.5 * (from[1] + to[1]) - rise * dx};
    const bool clockwise = hill == (l->mirror[0] * l->mirror[1] > 0.0);
    double q[2];
    double c[2];
    double s[2];

    lay(l, to, q);
    lay(l, centre, c);
    lay(l, from, s);
    return add(at, "G%d %c%.13f %c%.13f %c%.13f %c%.13f\n", clockwise ? 2 : 3, letters[l->plane][0],
               q[0], letters[l->plane][1], q[1], centre_letters[l->plane][0], c[0] - s[0],
               centre_letters[l->plane][1], c[1] - s[1]);
}

/* One step of the contour; dx > 0. Arcs stay so flat that they do not turn back. */
static size_t add_step(size_t at, const struct layout *l, double p[2])
{
    const double kind = random_between(0.0, 1.0);
    const double dx = kind < 0.4 ? random_between(0.05, 1.0) : random_between(2.0, 12.0);
    const double slope = random_between(-1.3, 1.3);
    const double to[2] = {p[0] + dx, p[1] + dx * tan(slope)};
    const double half = 0.5 * hypot(to[0] - p[0], to[1] - p[1]);
    const double steepest = 1.5 - fabs(slope);
    const double arc = random_between(0.0, 1.0);
    double radius = half / sin(random_between(0.02, steepest));
    const bool hill = arc < 0.25;

    if (arc < 0.5 && (hill || radius > 1.05 * l->radius)) {
        at = add_arc(at, l, p, to, radius, hill);
    } else {
        at = add_line(at, l, to);
    }
    p[0] = to[0];
    p[1] = to[1];
    return at;
}

static void write_contour(const struct layout *l)
{
    const bool left = l->mirror[0] * l->mirror[1] > 0.0;
    const int steps = 2 + (int)random_between(0.0, 20.0);
    double p[2] = {0.0, 0.0};
    double q[2];
    size_t at = add(0, "G21 G%u F1000\n", 17 + l->plane);

    p[0] = -3.0 * l->radius - 10.0;
    lay(l, p, q);
    at = add(at, "G0 %c%.13f %c%.13f\n", letters[l->plane][0], q[0], letters[l->plane][1], q[1]);
    at = add(at, "G4%d.1 D%.13f\n", left ? 1 : 2, 2.0 * l->radius);
    p[0] = 0.0;
    at = add_line(at, l, p);
    p[0] = 4.0 * l->radius;
    at = add_line(at, l, p);
    for (int i = 0; i < steps; i++) {
        at = add_step(at, l, p);
    }
    p[0] += 60.0;
    (void)add_line(at, l, p);
}

static void open_program(const struct layout *l)
{
    struct program_config config = {.axes = 7U, .parameters = &parameters};
    struct source source;

    for (unsigned i = 0; i < 3; i++) {
        config.travel_min[i] = -1e6;
        config.travel_max[i] = 1e6;
    }
    config.sharp_corners = l->sharp;
    takt_parameters_clear(&parameters);
    takt_source_open_text(&source, &source_text, text, strlen(text));
    takt_program_open(&program, &config, &source);
    takt_cutter_compensation_open(&offset, &config);
}

static struct piece piece_of(const struct move *m, const struct point *start, unsigned plane)
{
    const unsigned first[3] = {0, 2, 1};
    const unsigned second[3] = {1, 0, 2};

    return (struct piece){
        .arc = m->kind == MOVE_ARC_CW || m->kind == MOVE_ARC_CCW,
        .clockwise = m->kind == MOVE_ARC_CW,
        .from = {start->at[first[plane]], start->at[second[plane]]},
        .to = {m->end.at[first[plane]], m->end.at[second[plane]]},
        .centre = {m->centre_mm[0], m->centre_mm[1]},
    };
}

/* What the program says, without the entry move, whose path is not followed. */
static void read_wanted(const struct layout *l)
{
    struct diagnostic diagnostic;
    struct point at = {{0}};
    struct move m;

    wanted_count = 0;
    open_program(l);
    while (takt_program_next(&program, &m, &diagnostic) == PROGRAM_MOVE) {
        if (!move_is_motion(&m)) {
            continue;
        }
        if (m.cutter_side != CUTTER_OFF && !m.cutter_entry) {
            TEST_ASSERT_TRUE(wanted_count < PIECES_MAX);
            wanted[wanted_count++] = piece_of(&m, &at, l->plane);
        }
        at = m.end;
    }
}

/* 0 ... 1 along a piece. */
static void point_on(const struct piece *p, double f, double q[2])
{
    if (!p->arc) {
        q[0] = p->from[0] + (p->to[0] - p->from[0]) * f;
        q[1] = p->from[1] + (p->to[1] - p->from[1]) * f;
        return;
    }
    const double radius = hypot(p->from[0] - p->centre[0], p->from[1] - p->centre[1]);
    const double start = atan2(p->from[1] - p->centre[1], p->from[0] - p->centre[0]);
    double sweep = atan2(p->to[1] - p->centre[1], p->to[0] - p->centre[0]) - start;

    if (p->clockwise && sweep >= 0.0) {
        sweep -= 2.0 * MATHS_PI;
    } else if (!p->clockwise && sweep <= 0.0) {
        sweep += 2.0 * MATHS_PI;
    }
    q[0] = p->centre[0] + radius * cos(start + sweep * f);
    q[1] = p->centre[1] + radius * sin(start + sweep * f);
}

/* Nearest point of a piece, and whether it lies inside it. */
static bool foot_of(const struct piece *p, const double q[2], double foot[2], double side[1])
{
    const double dx = p->to[0] - p->from[0];
    const double dy = p->to[1] - p->from[1];
    bool inside;

    if (!p->arc) {
        const double f =
            ((q[0] - p->from[0]) * dx + (q[1] - p->from[1]) * dy) / (dx * dx + dy * dy);

        inside = f > 0.0 && f < 1.0;
        foot[0] = p->from[0] + f * dx;
        foot[1] = p->from[1] + f * dy;
        side[0] = dx * (q[1] - p->from[1]) - dy * (q[0] - p->from[0]);
    } else {
        const double radius = hypot(p->from[0] - p->centre[0], p->from[1] - p->centre[1]);
        const double distance = hypot(q[0] - p->centre[0], q[1] - p->centre[1]);
        double across;

        foot[0] = p->centre[0] + (q[0] - p->centre[0]) * radius / distance;
        foot[1] = p->centre[1] + (q[1] - p->centre[1]) * radius / distance;
        /* The arcs here turn by less than half a turn: they lie on one side of their chord. */
        across = dx * (foot[1] - p->from[1]) - dy * (foot[0] - p->from[0]);
        inside = p->clockwise ? across > 0.0 : across < 0.0;
        side[0] = (distance - radius) * (p->clockwise ? 1.0 : -1.0);
    }
    return inside;
}

/*
 * Distance from everything programmed; *left: on which side of the nearest piece, if that is not a
 * corner.
 */
static double distance_from_wanted(const double q[2], double *left)
{
    double smallest = 1e9;

    for (unsigned i = 0; i < wanted_count; i++) {
        const double ends = fmin(hypot(q[0] - wanted[i].from[0], q[1] - wanted[i].from[1]),
                                 hypot(q[0] - wanted[i].to[0], q[1] - wanted[i].to[1]));
        double foot[2];
        double side;

        if (ends < smallest) {
            smallest = ends;
            *left = 0.0;
        }
        if (foot_of(&wanted[i], q, foot, &side)) {
            const double distance = hypot(q[0] - foot[0], q[1] - foot[1]);

            if (distance < smallest) {
                smallest = distance;
                *left = side;
            }
        }
    }
    return smallest;
}

struct verdict {
    double nearest, farthest; /* beside the radius, mm */
    double blunt;             /* the same as farthest, at blunt corners */
    bool wrong_side;
};

/* Direction of a piece at its start or its end. */
static void direction_of(const struct piece *p, bool at_end, double d[2])
{
    const double *q = at_end ? p->to : p->from;
    const double turn = p->clockwise ? -1.0 : 1.0;

    d[0] = p->arc ? -turn * (q[1] - p->centre[1]) : p->to[0] - p->from[0];
    d[1] = p->arc ? turn * (q[0] - p->centre[0]) : p->to[1] - p->from[1];
}

/* Beside a corner so blunt that its tip stands off by less than BLUNT_MM: radius angle^2 / 8. */
static bool is_at_blunt_corner(const double q[2], double radius)
{
    for (unsigned i = 0; i + 1 < wanted_count; i++) {
        double a[2];
        double b[2];

        direction_of(&wanted[i], true, a);
        direction_of(&wanted[i + 1], false, b);
        const double angle = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        const double off = hypot(q[0] - wanted[i].to[0], q[1] - wanted[i].to[1]) - radius;

        if (radius * angle * angle / 8.0 < BLUNT_MM && off < BLUNT_MM) {
            return true;
        }
    }
    return false;
}

static void verify_move(const struct layout *l, const struct move *m, const struct point *start,
                        struct verdict *v)
{
    const struct piece p = piece_of(m, start, l->plane);
    const double sign = l->mirror[0] * l->mirror[1];

    if (!p.arc && hypot(p.to[0] - p.from[0], p.to[1] - p.from[1]) == 0.0) {
        return;
    }
    for (int i = 0; i <= SAMPLES; i++) {
        double q[2];
        double left = 0.0;

        point_on(&p, (double)i / SAMPLES, q);
        const double off = distance_from_wanted(q, &left) - l->radius;

        v->nearest = fmin(v->nearest, off);
        if (off > EXACT_MM && off < BLUNT_MM && is_at_blunt_corner(q, l->radius)) {
            v->blunt = fmax(v->blunt, off);
        } else {
            v->farthest = fmax(v->farthest, off);
        }
        v->wrong_side = v->wrong_side || left * sign < 0.0;
    }
}

/* The tool's path, from the end of the entry move on. False: the contour is refused. */
static bool verify_contour(const struct layout *l, struct verdict *v)
{
    struct diagnostic diagnostic;
    struct point at = {{0}};
    struct move m;
    unsigned motions = 0;
    enum program_result result;

    *v = (struct verdict){0};
    open_program(l);
    while ((result = takt_cutter_compensation_next(&offset, &program, &m, &diagnostic)) ==
           PROGRAM_MOVE) {
        if (move_is_motion(&m)) {
            motions++;
            if (motions > 2) {
                verify_move(l, &m, &at, v);
            }
            at = m.end;
        }
    }
    if (result == PROGRAM_ERROR) {
        TEST_ASSERT_EQUAL_INT(TAKT_ERROR_OFFSET_GOUGE, diagnostic.code);
        TEST_ASSERT_TRUE(diagnostic.value > 0.0);
    }
    return result == PROGRAM_END;
}

static struct layout random_layout(bool sharp)
{
    return (struct layout){
        .plane = (unsigned)random_between(0.0, 3.0),
        .mirror = {random_between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0,
                   random_between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0},
        .turn_rad = random_between(-3.0, 3.0),
        .radius =
            random_between(0.0, 1.0) < 0.5 ? random_between(0.5, 3.0) : random_between(3.0, 8.0),
        .sharp = sharp,
    };
}

static void verify_all(bool sharp)
{
    unsigned refused = 0;
    double nearest = 0.0;
    double farthest = 0.0;
    double blunt = 0.0;

    for (unsigned i = 0; i < CONTOURS; i++) {
        struct verdict v;

        seed = i + 1;
        const struct layout l = random_layout(sharp);

        write_contour(&l);
        read_wanted(&l);
        if (!verify_contour(&l, &v)) {
            refused++;
            continue;
        }
        nearest = fmin(nearest, v.nearest);
        farthest = fmax(farthest, v.farthest);
        blunt = fmax(blunt, v.blunt);
        if (v.nearest < -EXACT_MM || v.farthest > (sharp ? SHARP_MAX_RATIO * l.radius : EXACT_MM) ||
            v.wrong_side) {
            printf("seed %u, radius %.13f: %g mm too near, %g mm too far%s\n%s\n", i + 1, l.radius,
                   -v.nearest, v.farthest, v.wrong_side ? ", on the wrong side" : "", text);
            TEST_FAIL();
        }
    }
    printf("%u contours, %u refused; at most %g mm too near, %g mm too far, %g at blunt corners\n",
           CONTOURS, refused, -nearest, farthest, blunt);
    TEST_ASSERT_TRUE(refused * 100 < CONTOURS);
}

static void test_the_tool_keeps_exactly_its_radius(void)
{
    verify_all(false);
}

static void test_with_sharp_corners_it_never_comes_nearer(void)
{
    verify_all(true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_tool_keeps_exactly_its_radius);
    RUN_TEST(test_with_sharp_corners_it_never_comes_nearer);
    return UNITY_END();
}
