/*
 * Blocks per second of the smoother alone (G64 P), and the time it takes for one piece of curve: of
 * the program given as an argument, which must ask for G64 P, or of one made here. The program is
 * read before, and the best of some rounds counts. Not a test: a figure depends on the machine.
 *
 *     bench_smooth [PROGRAM]
 */
#define _DEFAULT_SOURCE

#include "cutter_compensation/cutter_compensation.h"
#include "program/program.h"
#include "smooth/smooth.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ROUNDS     5
#define MADE_LINES 5000

#define TRAVEL_MM          5000.0
#define VELOCITY_MM_S      100.0
#define ACCELERATION_MM_S2 1000.0
#define JERK_MM_S3         50000.0
#define CYCLE_S            0.001

/* What one round has brought. */
struct yield {
    unsigned long pieces;
    unsigned long motions; /* of the path itself */
    double nominal_s;      /* at the rates the pieces allow */
};

static struct program program;
static struct parameters parameters;
static struct cutter_compensation offset;
static struct smooth smooth;
static union smooth_scratch scratch;

static struct move *moves;
static size_t move_count;
static size_t move_room;

static long read_file(void *context, char *buffer, size_t size)
{
    const size_t count = fread(buffer, 1, size, context);

    return count == 0 ? SOURCE_END : (long)count;
}

/*
 * A line that goes to and fro over a surface of waves, in steps of some tenths, as CAM systems
 * write it.
 */
static FILE *made_program(void)
{
    FILE *file = tmpfile();

    if (file == NULL) {
        perror("tmpfile");
        exit(1);
    }
    (void)fprintf(file, "G21 G90 G17 G64 P0.01\nG1 X0 Y0 Z0 F6000\n");
    for (int i = 1; i <= MADE_LINES; i++) {
        const double turn = (double)i * 0.02;
        const double x_mm = 40.0 * sin(turn);
        const double y_mm = 0.005 * (double)i;

        (void)fprintf(file, "G1 X%.4f Y%.4f Z%.4f\n", x_mm, y_mm,
                      2.0 * sin(0.3 * x_mm) * cos(0.2 * y_mm));
    }
    (void)fprintf(file, "M2\n");
    rewind(file);
    return file;
}

static void keep_move(const struct move *move)
{
    if (move_count == move_room) {
        move_room = move_room == 0 ? 1024 : 2 * move_room;
        moves = realloc(moves, move_room * sizeof *moves);
        if (moves == NULL) {
            perror("realloc");
            exit(1);
        }
    }
    moves[move_count] = *move;
    move_count++;
}

static void read_moves(FILE *file)
{
    struct program_config config = {.axes = 7U, .parameters = &parameters};
    struct source source = {read_file, NULL, file};
    struct diagnostic error;
    struct move move;
    enum program_result result;

    for (int i = 0; i < AXIS_COUNT; i++) {
        config.travel_min[i] = -TRAVEL_MM;
        config.travel_max[i] = TRAVEL_MM;
    }
    takt_parameters_clear(&parameters);
    takt_program_open(&program, &config, &source);
    takt_cutter_compensation_open(&offset, &config);
    while ((result = takt_cutter_compensation_next(&offset, &program, &move, &error)) ==
           PROGRAM_MOVE) {
        keep_move(&move);
    }
    if (result == PROGRAM_ERROR) {
        (void)fprintf(stderr, "the program has an error: see takt check\n");
        exit(1);
    }
}

static void take_all(struct yield *yield)
{
    struct smooth_piece piece;
    struct curve curve;
    enum smooth_taken taken;

    while ((taken = takt_smooth_take(&smooth, &scratch, &piece, &curve)) != SMOOTH_NONE) {
        if (taken == SMOOTH_MOTION) {
            yield->motions++;
            continue;
        }
        yield->pieces++;
        yield->nominal_s += piece.interval_s / fmin(piece.rate.most, piece.rate.programmed);
    }
}

static void finish(struct yield *yield)
{
    takt_smooth_finish(&smooth);
    take_all(yield);
}

static void push(const struct move *move, uint32_t number, const struct curve *curve,
                 struct yield *yield)
{
    if (!takt_smooth_takes(move, curve)) {
        finish(yield);
        return;
    }
    if (!takt_smooth_joins(&smooth, move, curve)) {
        finish(yield);
    }
    while (!takt_smooth_has_room(&smooth)) {
        take_all(yield);
    }
    takt_smooth_push(&smooth, move, number, curve);
    take_all(yield);
}

static void smooth_program(struct yield *yield)
{
    struct point end = {{0.0}};
    struct curve curve;
    uint32_t number = 0;

    for (size_t i = 0; i < move_count; i++) {
        if (!move_is_motion(&moves[i])) {
            finish(yield);
            continue;
        }
        number++;
        if (takt_move_curve(&moves[i], &end, &curve)) {
            push(&moves[i], number, &curve, yield);
        }
        end = moves[i].end;
    }
    finish(yield);
}

static void set_limits(struct smooth_limits *limits)
{
    memset(limits, 0, sizeof(*limits));
    limits->axes = 7U;
    limits->cycle_s = CYCLE_S;
    limits->windows = 1.0;
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->velocity_mm_s[i] = VELOCITY_MM_S;
        limits->acceleration_mm_s2[i] = ACCELERATION_MM_S2;
        limits->jerk_mm_s3[i] = JERK_MM_S3;
    }
}

static double now_s(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Seconds of processor time. */
static double one_round(struct yield *yield)
{
    struct smooth_limits limits;
    const struct yield nothing = {0, 0, 0.0};

    set_limits(&limits);
    *yield = nothing;
    takt_smooth_init(&smooth, &limits);
    const double began_s = now_s();

    smooth_program(yield);
    return now_s() - began_s;
}

static FILE *opened(const char *path)
{
    FILE *file = fopen(path, "r");

    if (file == NULL) {
        (void)fprintf(stderr, "%s: %s\n", path, strerror(errno));
        exit(1);
    }
    return file;
}

int main(int argc, char **argv)
{
    FILE *file = argc > 1 ? opened(argv[1]) : made_program();
    struct yield yield = {0, 0, 0.0};
    double best_s = HUGE_VAL;

    read_moves(file);
    (void)fclose(file);
    for (unsigned i = 0; i < ROUNDS; i++) {
        best_s = fmin(best_s, one_round(&yield));
    }
    free(moves);
    if (yield.pieces == 0) {
        (void)fprintf(stderr, "nothing to smooth: the program must ask for G64 P\n");
        return 1;
    }
    printf("%zu blocks, %lu pieces, %lu motions as programmed, %.3f s nominal: %.0f blocks/s, %.2f "
           "us a piece\n",
           move_count, yield.pieces, yield.motions, yield.nominal_s, (double)move_count / best_s,
           best_s * 1e6 / (double)yield.pieces);
    return 0;
}
