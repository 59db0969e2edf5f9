/*
 * Lines per second of the interpreter on a program of a million plain G1 X Y Z lines, beside
 * LinuxCNC's `rs274 -g` on the same file; and the memory each takes for a thousand lines and for a
 * million. Not a test: a figure depends on the machine.
 *
 * Ours makes canonical moves and throws them away; rs274 also writes its canonical calls as text,
 * to nowhere.
 */
#define _DEFAULT_SOURCE

#include "program/program.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define LINES_FEW  1000UL
#define LINES_MANY 1000000UL
#define ROUNDS     3
/* Exit status of a child that could not be started. */
#define STATUS_NO_PROGRAM 127

/* What a process of its own has taken. */
struct cost {
    double seconds; /* of processor time */
    long rss_kib;   /* most memory */
    int status;
};

static struct program program;
static struct parameters parameters;

/* A path that goes to and fro in a box of 200 mm, four decimals, as CAM systems write it. */
static void write_program(const char *path, unsigned long lines)
{
    FILE *file = fopen(path, "w");

    if (file == NULL) {
        perror(path);
        exit(1);
    }
    (void)fprintf(file, "G21 G90 F1000\n");
    for (unsigned long i = 2; i < lines; i++) {
        (void)fprintf(file, "G1 X%.4f Y%.4f Z%.4f\n", (double)(i * 7919 % 2000000) * 1e-4,
                      (double)(i * 104729 % 2000000) * 1e-4, (double)(i % 500000) * -1e-4);
    }
    (void)fprintf(file, "M2\n");
    (void)fclose(file);
}

static long read_file(void *context, char *buffer, size_t size)
{
    const size_t count = fread(buffer, 1, size, context);

    if (count == 0) {
        return ferror(context) == 0 ? SOURCE_END : SOURCE_ERROR;
    }
    return (long)count;
}

/* Moves made of the file. */
static unsigned long interpret(const char *path)
{
    struct program_config config = {.axes = 7U, .parameters = &parameters};
    struct diagnostic error;
    struct move move;
    unsigned long moves = 0;
    FILE *file = fopen(path, "r");
    const struct source source = {read_file, NULL, file};

    if (file == NULL) {
        return 0;
    }
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        config.travel_min[axis] = -500.0;
        config.travel_max[axis] = 500.0;
    }
    takt_parameters_clear(&parameters);
    takt_program_open(&program, &config, &source);
    while (takt_program_next(&program, &move, &error) == PROGRAM_MOVE) {
        moves++;
    }
    (void)fclose(file);
    return moves;
}

/* LinuxCNC's interpreter, its output thrown away. */
static void become_rs274(const char *path)
{
    const int nowhere = open("/dev/null", O_RDWR);

    (void)dup2(nowhere, STDIN_FILENO);
    (void)dup2(nowhere, STDOUT_FILENO);
    (void)dup2(nowhere, STDERR_FILENO);
    (void)execlp("rs274", "rs274", "-g", path, (char *)NULL);
    _exit(STATUS_NO_PROGRAM);
}

static struct cost measure_once(const char *path, unsigned long lines, bool ours)
{
    struct cost cost = {0};
    struct rusage usage;
    const pid_t child = fork();

    if (child == 0) {
        if (!ours) {
            become_rs274(path);
        }
        /* Every line but the first is a move. */
        _exit(interpret(path) == lines - 1 ? 0 : 1);
    }
    if (child < 0 || wait4(child, &cost.status, 0, &usage) < 0) {
        perror("a process cannot be started");
        exit(1);
    }
    cost.seconds = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                   (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1e-6;
    cost.rss_kib = usage.ru_maxrss;
    return cost;
}

/* The fastest of some rounds. */
static struct cost measure(const char *path, unsigned long lines, bool ours)
{
    struct cost best = measure_once(path, lines, ours);

    for (int round = 1; round < ROUNDS && best.status == 0; round++) {
        const struct cost next = measure_once(path, lines, ours);

        if (next.seconds < best.seconds) {
            best = next;
        }
    }
    return best;
}

static double print_cost(const char *name, const char *few, const char *many, bool ours)
{
    const struct cost small = measure(few, LINES_FEW, ours);
    const struct cost large = measure(many, LINES_MANY, ours);

    if (!WIFEXITED(large.status) || WEXITSTATUS(large.status) == STATUS_NO_PROGRAM) {
        (void)printf("%-10s not installed (Debian: linuxcnc-uspace)\n", name);
        return 0.0;
    }
    (void)printf("%-10s %9.0f lines/s   %6ld KiB for %lu lines, %6ld KiB for %lu%s\n", name,
                 (double)LINES_MANY / large.seconds, small.rss_kib, LINES_FEW, large.rss_kib,
                 LINES_MANY, large.status == 0 ? "" : "   FAILED");
    return (double)LINES_MANY / large.seconds;
}

int main(void)
{
    static const char few[] = "bench_program_few.ngc";
    static const char many[] = "bench_program_many.ngc";

    write_program(few, LINES_FEW);
    write_program(many, LINES_MANY);
    (void)printf("%lu lines of G1 X Y Z, processor time of the best of %d rounds\n", LINES_MANY,
                 ROUNDS);
    const double ours = print_cost("takt", few, many, true);
    const double theirs = print_cost("rs274 -g", few, many, false);

    if (theirs > 0.0) {
        (void)printf("takt reads %.1f times as fast\n", ours / theirs);
    }
    (void)remove(few);
    (void)remove(many);
    return 0;
}
