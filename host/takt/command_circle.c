/* takt circle: the circular test of ISO 230-4 on the virtual machine. */
#include "circle/picture.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "studies/circle_test.h"
#include "takt/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* When nothing is said. */
#define RADIUS_MM   50
#define FEED_MM_MIN 3000

struct circle_job {
    struct circle_test test;
    struct circle_figures figures[CIRCLE_WAYS + 1]; /* of each way, and of both */
    enum axis axis[2];
};

static bool read_plane(const char *word, enum plane *plane)
{
    static const char *const names[] = {"XY", "ZX", "YZ"};

    *plane = PLANE_XY;
    for (unsigned i = 0; word != NULL && i < 3; i++) {
        if (strcmp(word, names[i]) == 0) {
            *plane = (enum plane)i;
            return true;
        }
    }
    if (word != NULL)
        message_command_error("--plane %s: XY, ZX or YZ is expected", word);
    return word == NULL;
}

static bool read_centre(const char *text, struct circle_test *test)
{
    char *end;
    const char *second;

    test->has_centre = text != NULL;
    if (text == NULL)
        return true;
    test->centre_mm[0] = strtod(text, &end);
    second = end + 1;
    if (end != text && *end == ',') {
        test->centre_mm[1] = strtod(second, &end);
        if (end != second && *end == '\0' && isfinite(test->centre_mm[0]) &&
            isfinite(test->centre_mm[1]))
            return true;
    }
    message_command_error("--centre %s: two coordinates are expected, as in 12.5,-3", text);
    return false;
}

static bool set_test(struct circle_job *job, const struct options *options)
{
    const struct option_circle *given = &options->circle;
    struct circle_test *test = &job->test;

    test->radius_mm = given->radius > 0 ? given->radius : RADIUS_MM;
    test->feed_mm_min = given->feed > 0 ? given->feed : FEED_MM_MIN;
    if (!read_plane(given->plane, &test->plane) || !read_centre(given->centre, test))
        return false;
    takt_plane_axes(test->plane, &job->axis[0], &job->axis[1]);
    return true;
}

static void verifier(struct circle_job *job)
{
    const struct circle_turn *const turn[] = {&job->test.turn[CIRCLE_CCW],
                                              &job->test.turn[CIRCLE_CW]};

    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        circle_figures_of(&turn[way], 1, &job->figures[way]);
    circle_figures_of(turn, CIRCLE_WAYS, &job->figures[CIRCLE_WAYS]);
}

/* In um, without a minus before 0.000. */
static double shown_um(double mm)
{
    return round(1e6 * mm) / 1000 + 0.0;
}

static void print_row(const struct circle_job *job, const char *name, size_t field)
{
    (void)printf("  %-34s", name);
    for (unsigned i = 0; i <= CIRCLE_WAYS; i++)
        (void)printf(" %9.3f",
                     1000 *
                         *(const double *)(const void *)((const char *)&job->figures[i] + field));
    (void)fputc('\n', stdout);
}

/* At the end of an axis' way on which side: + first, + second, - first, - second. */
static void print_reversals(const struct circle_job *job)
{
    for (unsigned quadrant = 0; quadrant < CIRCLE_QUADRANTS; quadrant++) {
        const char axis = AXIS_LETTERS[job->axis[quadrant % 2]];

        (void)printf("  reversal at %c%c, step               ", quadrant < 2 ? '+' : '-', axis);
        for (unsigned way = 0; way < CIRCLE_WAYS; way++)
            (void)printf(" %9.3f", shown_um(job->figures[way].reversal[quadrant].step_mm));
        (void)printf("\n                  spike              ");
        for (unsigned way = 0; way < CIRCLE_WAYS; way++)
            (void)printf(" %9.3f", shown_um(job->figures[way].reversal[quadrant].spike_mm));
        (void)fputc('\n', stdout);
    }
}

static void print(const struct circle_job *job)
{
    const struct circle_test *t = &job->test;

    (void)printf("circle about %c %g %c %g, R %g mm, F%g: um\n\n", AXIS_LETTERS[job->axis[0]],
                 t->centre_mm[0], AXIS_LETTERS[job->axis[1]], t->centre_mm[1], t->radius_mm,
                 t->feed_mm_min);
    (void)printf("  %-34s %9s %9s %9s\n", "", "G3", "G2", "both");
    print_row(job, "circular deviation G", offsetof(struct circle_figures, deviation_mm));
    print_row(job, "radial deviation F max", offsetof(struct circle_figures, most_mm));
    print_row(job, "                 F min", offsetof(struct circle_figures, least_mm));
    print_row(job, "radius, from the programmed one",
              offsetof(struct circle_figures, radius_out_mm));
    print_row(job, "centre, first axis", offsetof(struct circle_figures, centre_mm));
    print_row(job, "        second axis",
              offsetof(struct circle_figures, centre_mm) + sizeof(double));
    print_reversals(job);
}

static char *json_text(const struct circle_job *job)
{
    static const char *const names[] = {"ccw", "cw", "both"};
    const struct circle_test *t = &job->test;
    const char plane[] = {AXIS_LETTERS[job->axis[0]], AXIS_LETTERS[job->axis[1]], '\0'};
    cJSON *root = cJSON_CreateObject();
    char *text;

    cJSON_AddStringToObject(root, "plane", plane);
    cJSON_AddItemToObject(root, "centre_mm", cJSON_CreateDoubleArray(t->centre_mm, 2));
    cJSON_AddNumberToObject(root, "radius_mm", t->radius_mm);
    cJSON_AddNumberToObject(root, "feed_mm_min", t->feed_mm_min);
    for (unsigned i = 0; i <= CIRCLE_WAYS; i++)
        cJSON_AddItemToObject(root, names[i], circle_figures_json(&job->figures[i]));
    text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}

static void write_picture(FILE *file, const struct circle_job *job)
{
    const struct circle_picture picture = {
        .axis = {AXIS_LETTERS[job->axis[0]], AXIS_LETTERS[job->axis[1]]},
        .radius_mm = job->test.radius_mm,
        .feed_mm_min = job->test.feed_mm_min,
        .turn = job->test.turn,
        .figures = job->figures,
    };

    circle_picture_write(file, &picture);
}

static void write_json(FILE *file, const struct circle_job *job)
{
    char *text = json_text(job);

    (void)fprintf(file, "%s\n", text != NULL ? text : "");
    cJSON_free(text);
}

/* Writes files that are open: all of them or none. */
static bool write_files(const struct circle_job *job, struct output_file *picture,
                        struct output_file *json)
{
    if (picture->stream != NULL)
        write_picture(picture->stream, job);
    if (json->stream != NULL)
        write_json(json->stream, job);
    return (picture->stream == NULL || output_file_finish(picture)) &&
           (json->stream == NULL || output_file_finish(json));
}

static enum command_status finish(struct circle_job *job, const struct options *options,
                                  struct output_file *picture, struct output_file *json)
{
    const bool has_picture = picture->stream != NULL, has_json = json->stream != NULL;
    const double deviation_mm = job->figures[CIRCLE_WAYS].deviation_mm;

    if (!options->quiet && picture->stream != stdout && json->stream != stdout)
        print(job);
    if (!write_files(job, picture, json) || (has_picture && !output_file_place(picture)) ||
        (has_json && !output_file_place(json)))
        return STATUS_ENVIRONMENT;
    if (options->tolerance > 0 && deviation_mm > options->tolerance) {
        message_command_error("the circular deviation of both ways, %.6f mm, is above --tolerance",
                              deviation_mm);
        return STATUS_FAILED;
    }
    return STATUS_DONE;
}

static enum command_status execute(struct circle_job *job, const struct options *options)
{
    static struct output_file picture, json;
    enum command_status status = STATUS_INPUT;

    if (set_test(job, options))
        status = (options->output == NULL || output_file_open(&picture, options->output)) &&
                         (options->json == NULL || output_file_open(&json, options->json))
                     ? circle_test_run(&job->test, options)
                     : STATUS_ENVIRONMENT;
    if (status == STATUS_DONE) {
        verifier(job);
        status = finish(job, options, &picture, &json);
    }
    output_file_discard(&picture);
    output_file_discard(&json);
    return status;
}

static enum command_status command_circle_execute(const struct options *options)
{
    struct circle_job *job = calloc(1, sizeof *job);
    enum command_status status = STATUS_ENVIRONMENT;

    if (job == NULL) {
        message_command_error("out of memory");
        return status;
    }
    status = execute(job, options);
    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        circle_turn_free(&job->test.turn[way]);
    free(job);
    return status;
}

static const struct option_row rows[] = {
    {"plane", OPTION_TEXT, offsetof(struct options, circle.plane), "PLANE",
     "XY (default), ZX or YZ"},
    {"radius", OPTION_POSITIVE, offsetof(struct options, circle.radius), "MM",
     "of the circle (50)"},
    {"feed", OPTION_POSITIVE, offsetof(struct options, circle.feed), "MM/MIN", "(3000)"},
    {"centre", OPTION_TEXT, offsetof(struct options, circle.centre), "A,B",
     "on the plane's axes (default: the middle of their travels)"},
    {"tolerance", OPTION_POSITIVE, offsetof(struct options, tolerance), "MM",
     "of the circular deviation of both ways: status 1 where it is larger"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: both ways in one picture, deviations enlarged, SVG"},
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the figures as JSON"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no figures"},
    OPTIONS_MACHINE,
    OPTIONS_END,
};

const struct command command_circle = {
    .name = "circle",
    .usage = "[options]",
    .summary = "run a circular test (ISO 230-4) on the virtual machine",
    .help =
        "Goes around a circle three times by G3 and three times by G2, and measures the second "
        "time where the tool is, or\n"
        "what the drives move if the machine has no errors of its own: friction, backlash, pitch, "
        "the drives' loops,\n"
        "modes and errors of geometry show there ([drive], [axis], [geometry] of the machine "
        "file), "
        "and what correction\nleaves of them.\n"
        "\n"
        "G is the distance of the two circles about the centre of least squares that hold the "
        "tool's way; F max and\n"
        "F min are deviations from the programmed circle. Where an axis turns round: the step of "
        "the deviation from 10\n"
        "to 15 degrees before to as much behind, and the largest deviation in between, from "
        "half-way "
        "between both.\n"
        "\n"
        "Exit status: 0 done; 1 a drive faulted, or G is above --tolerance; 2 wrong input; 3 a "
        "file "
        "cannot be written.\n"
        "\n"
        "Examples:\n"
        "  takt circle -o circle.svg\n"
        "  takt circle --radius 100 --feed 2000 --set axis.X.backlash_mm=0.005 --tolerance 0.01\n"
        "  takt circle --machine mill3.ini --plane ZX --centre=-50,120 --json -\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_circle_execute,
};
