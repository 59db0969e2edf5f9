/*
 * Text to setpoints, without drives: prints the digest of every setpoint of a program, and how many
 * there were. Small enough to be built for another processor in seconds. Reads the program from the
 * file it is given.
 */
#include "base/fnv.h"
#include "cutter_compensation/cutter_compensation.h"
#include "motion/motion.h"
#include "plan/path.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_MAX   65536
#define CYCLES_MAX 1000000

static const struct plan_limits limits = {
    7,    {100, 60, 20}, {1000, 400, 2000}, {50000, 8000, 200000},
    1e-3, 1e-3,          RAMP_PROFILE_JERK, LANDING_SPAN};

struct bench {
    struct program program;
    struct cutter_compensation offset;
    struct parameters parameters;
    struct source_text text;
    struct path path;
    struct motion motion;
    bool ended;
    char bytes[TEXT_MAX];
};

static bool load(struct bench *b, const char *path)
{
    FILE *file = fopen(path, "rb");

    if (file == NULL)
        return false;
    b->text.text = b->bytes;
    b->text.length = fread(b->bytes, 1, sizeof b->bytes, file);
    return fclose(file) == 0 && b->text.length < sizeof b->bytes;
}

static void begin(struct bench *b)
{
    struct program_config config = {.axes = limits.axes, .parameters = &b->parameters};
    struct source source;

    takt_parameters_clear(&b->parameters);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        config.travel_min[i] = -500;
        config.travel_max[i] = 500;
    }
    takt_source_open_text(&source, &b->text, b->bytes, b->text.length);
    takt_program_open(&b->program, &config, &source);
    takt_cutter_compensation_open(&b->offset, &config);
    takt_path_init(&b->path, &limits, &config.start);
    takt_motion_init(&b->motion, &b->path, &config.start, false);
}

static void read_move(struct bench *b)
{
    struct diagnostic diagnostic;
    struct move move;

    if (takt_cutter_compensation_next(&b->offset, &b->program, &move, &diagnostic) ==
        PROGRAM_MOVE) {
        takt_path_push(&b->path, &move);
        return;
    }
    b->ended = true;
    takt_path_finish(&b->path);
}

static void plan(struct bench *b)
{
    if (takt_motion_wanted(&b->motion) == NULL)
        return;
    takt_path_go_on(&b->path);
    while (!b->ended && takt_path_has_room(&b->path))
        read_move(b);
    takt_motion_build(&b->motion);
}

static bool run(struct bench *b, uint64_t *digest)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    struct cycle_record record = {0};
    enum motion_result result = MOTION_CYCLE;

    while ((result == MOTION_CYCLE || result == MOTION_NOT_YET) && b->motion.cycles < CYCLES_MAX) {
        plan(b);
        result = takt_motion_cycle(&b->motion, &as_programmed, &record);
        for (unsigned i = 0; i < AXIS_LINEAR_COUNT && result == MOTION_CYCLE; i++)
            *digest = takt_fnv_add_double(*digest, record.cmd.at[i]);
    }
    return result == MOTION_DONE;
}

int main(int argc, char **argv)
{
    static struct bench bench;
    uint64_t digest = FNV_START;

    if (argc != 2 || !load(&bench, argv[1]))
        return 2;
    begin(&bench);
    if (!run(&bench, &digest))
        return 1;
    printf("%016" PRIx64 " %" PRIu64 "\n", digest, bench.motion.cycles);
    return 0;
}
