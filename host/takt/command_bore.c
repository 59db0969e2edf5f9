/* takt bore: make a program that mills a hole by involutes. */
#include "base/maths.h"
#include "bore/write.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "studies/bore_compare.h"
#include "takt/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is milled with when nothing is said. */
#define FEED_MM_MIN   1000
#define PLUNGE_MM_MIN 300
#define HEIGHT_MM     2
#define TOLERANCE_MM  0.01

/* The place of a word in a list; -1 after a message: it is not there. No word: the first. */
static int choose(const char *option, const char *word, const char *const words[], unsigned count)
{
    if (word == NULL)
        return 0;
    for (unsigned i = 0; i < count; i++) {
        if (strcmp(word, words[i]) == 0)
            return (int)i;
    }
    if (count == 3)
        message_command_error("--%s %s: %s, %s or %s is expected", option, word, words[0], words[1],
                              words[2]);
    else
        message_command_error("--%s %s: %s, %s, %s or %s is expected", option, word, words[0],
                              words[1], words[2], words[3]);
    return -1;
}

static double or_default(double given, double otherwise)
{
    return given != 0 ? given : otherwise;
}

static bool read_start(const char *text, double start_mm[2])
{
    char *end;
    const char *second;

    start_mm[0] = strtod(text, &end);
    second = end + 1;
    if (end != text && *end == ',') {
        start_mm[1] = strtod(second, &end);
        if (end != second && *end == '\0' && isfinite(start_mm[0]) && isfinite(start_mm[1]))
            return true;
    }
    message_command_error("--start %s: X,Y from the hole's centre is expected, as in 12.5,-3",
                          text);
    return false;
}

/* One of --start, --start-radius, --start-length. */
static bool set_begin(struct bore_job *job, const struct option_bore *given)
{
    int ways = (given->start != NULL) + (given->start_radius > 0) + (given->start_length > 0);

    if (ways > 1) {
        message_command_error(
            "only one of --start, --start-radius and --start-length can be given");
        return false;
    }
    if (job->pass == BORE_ROUGHING && given->turns > 0) {
        message_command_error("--turns is of the finishing pass; roughing takes --step");
        return false;
    }
    if (job->pass == BORE_ROUGHING && job->as == BORE_AS_HELIX &&
        (ways > 0 || given->direction_deg > 0)) {
        message_command_error("a helix begins on its circle: leave --start and --direction out");
        return false;
    }
    job->start_radius_mm = given->start_radius;
    job->start_length_mm = given->start_length;
    job->begin = given->start_radius > 0   ? BORE_AT_RADIUS
                 : given->start_length > 0 ? BORE_AT_LENGTH
                                           : BORE_AT_POINT;
    return given->start == NULL || read_start(given->start, job->start_mm);
}

static bool set_turns(struct bore_job *job, double turns)
{
    if (turns > BORE_TURNS_MAX || turns != floor(turns)) {
        message_command_error("--turns %g: a whole number up to %d is expected", turns,
                              BORE_TURNS_MAX);
        return false;
    }
    job->turns = turns > 0 ? (unsigned)turns : 1;
    return true;
}

static bool set_job(struct bore_job *job, const struct options *options)
{
    static const char *const passes[] = {"roughing", "finishing", "both"};
    static const char *const forms[] = {"involute", "arcs", "lines", "helix"};
    const struct option_bore *given = &options->bore;
    int pass = choose("pass", given->pass, passes, 3);
    int as = pass < 0 ? -1 : choose("as", given->as, forms, 4);

    if (as < 0)
        return false;
    *job = (struct bore_job){
        .pass = (enum bore_pass)pass,
        .hole_mm = given->hole,
        .cutter_mm = given->cutter,
        .step_mm = given->step,
        .allowance_mm = given->allowance,
        .direction_rad = given->direction_deg * MATHS_PI / 180.0,
        .depth_mm = given->depth,
        .depth_step_mm = given->depth_step,
        .height_mm = or_default(given->height, HEIGHT_MM),
        .feed_mm_min = or_default(given->feed, FEED_MM_MIN),
        .plunge_mm_min = or_default(given->plunge, PLUNGE_MM_MIN),
        .spindle_rpm = given->spindle,
        .as = (enum bore_form_kind)as,
        .tolerance_mm = or_default(options->tolerance, TOLERANCE_MM),
    };
    if (given->depth_step > 0 && !(given->depth > 0)) {
        message_command_error("--depth-step %g needs --depth", given->depth_step);
        return false;
    }
    return set_turns(job, given->turns) && set_begin(job, given);
}

static enum command_status write_program(const struct bore_job *job, const char *path)
{
    static struct output_file file;
    enum command_status status = STATUS_ENVIRONMENT;

    if (!output_file_open(&file, path))
        return STATUS_ENVIRONMENT;
    if (!bore_write_job(file.stream, job))
        message_command_error("out of memory");
    else if (output_file_finish(&file) && output_file_place(&file))
        status = STATUS_DONE;
    output_file_discard(&file);
    return status;
}

static enum command_status command_bore_execute(const struct options *options)
{
    struct bore_job job;
    const char *problem;

    if (!set_job(&job, options))
        return STATUS_INPUT;
    problem = bore_check(&job);
    if (problem != NULL) {
        message_command_error("%s", problem);
        return STATUS_INPUT;
    }
    if (!options->bore.compare)
        return write_program(&job, options->output != NULL ? options->output : "-");
    if (job.pass != BORE_ROUGHING) {
        message_command_error("--compare is about roughing: leave --pass out");
        return STATUS_INPUT;
    }
    if (job.as != BORE_AS_INVOLUTE || options->bore.start != NULL || job.direction_rad != 0 ||
        job.begin != BORE_AT_POINT) {
        message_command_error("--compare begins at the centre, with every form: leave --as, "
                              "--start and --direction out");
        return STATUS_INPUT;
    }
    return bore_compare(&job, options);
}

#define POSITIVE(name, field, unit, help)                                                          \
    {                                                                                              \
        name, OPTION_POSITIVE, offsetof(struct options, field), unit, help                         \
    }

#define NUMBER(name, field, unit, help)                                                            \
    {                                                                                              \
        name, OPTION_NUMBER, offsetof(struct options, field), unit, help                           \
    }

static const struct option_row rows[] = {
    {"pass", OPTION_TEXT, offsetof(struct options, bore.pass), "PASS",
     "roughing (default), finishing or both"},
    NUMBER("hole", bore.hole, "MM", "diameter of the hole"),
    NUMBER("cutter", bore.cutter, "MM", "diameter of the cutter"),
    NUMBER("step", bore.step, "MM", "roughing: farther out by this per turn, at most"),
    NUMBER("allowance", bore.allowance, "MM", "left on the wall for finishing (default 0)"),
    {"start", OPTION_TEXT, offsetof(struct options, bore.start), "X,Y",
     "where it begins, from the centre (default 0,0); of both passes finishing"},
    NUMBER("direction", bore.direction_deg, "DEG",
           "from the centre it begins in this direction (0)"),
    NUMBER("start-radius", bore.start_radius, "MM", "or with which radius of curvature"),
    POSITIVE("start-length", bore.start_length, "MM", "or how long the spiral is"),
    POSITIVE("turns", bore.turns, "N", "finishing: turns of the spiral from centre to wall (1)"),
    POSITIVE("depth", bore.depth, "MM", "below Z 0 (default: at Z 0, no plunge)"),
    POSITIVE("depth-step", bore.depth_step, "MM", "in equal steps of at most this"),
    NUMBER("height", bore.height, "MM", "above Z 0, where plunges begin (2)"),
    POSITIVE("feed", bore.feed, "MM/MIN", "of the cut (1000)"),
    POSITIVE("plunge", bore.plunge, "MM/MIN", "feed down (300)"),
    POSITIVE("spindle", bore.spindle, "RPM", "spindle words M3 S and M5"),
    {"as", OPTION_TEXT, offsetof(struct options, bore.as), "FORM",
     "involute (default: G3.2), arcs, lines, or helix: roughing by turns down"},
    POSITIVE("tolerance", tolerance, "MM", "of arcs and lines (0.01)"),
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: the program (default: standard output); of --compare a picture, SVG"},
    {"compare", OPTION_FLAG, offsetof(struct options, bore.compare), NULL,
     "run the roughing spiral beside joined arcs, Archimedes' spiral, a helix"},
    OPTIONS_MACHINE,
    OPTIONS_END,
};

const struct command command_bore = {
    .name = "bore",
    .usage = "--hole MM --cutter MM --step MM [options]",
    .summary = "make a program that mills a hole by involutes",
    .help =
        "The hole's centre is X 0 Y 0, the work's top Z 0. Roughing spirals from the centre to "
        "the wall, less the\n"
        "allowance, and once around it. Finishing approaches the wall on an involute, goes "
        "around it once and leaves\n"
        "it on the mirror image; after --pass both nothing is left on the wall. The spiral "
        "meets the wall with the\n"
        "same direction and curvature, so it needs no stop there. --as arcs or lines is for "
        "controllers without G3.2. --as helix goes around the wall, a turn for each --depth-step; "
        "the cutter must exceed half\nthe hole.\n"
        "\n"
        "--compare runs that roughing spiral, half circles about two poles, quarter circles "
        "about four, and\n"
        "Archimedes' spiral, each with the circle, on the same virtual machine. It prints "
        "time, and peak acceleration\n"
        "and jerk of the setpoints by differences; and what the cutter removes, from the area that "
        "it sweeps: the layer\nsquare to its way, chip area for each mm of depth and way, and the "
        "engaged angle, least to most behind the\nfirst turn. With --depth a helix is among them, "
        "a "
        "turn for one --depth-step, if the cutter is wide enough. --machine and --set choose the "
        "machine.\n"
        "\n"
        "Examples:\n"
        "  takt bore --hole 200 --cutter 40 --step 4 --allowance 1 -o rough.ngc\n"
        "  takt bore --pass both --hole 60 --cutter 12 --step 3 --allowance 0.3 --depth 20 "
        "--depth-step 5 --feed 1200\n"
        "  takt bore --pass finishing --hole 200 --cutter 40 --start=-40,40 --turns 2\n"
        "  takt bore --hole 200 --cutter 40 --step 4 --allowance 1 --feed 6000 --compare -o "
        "spirals.svg\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_bore_execute,
};
