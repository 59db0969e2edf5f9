/* takt circle: the circular test of ISO 230-4 on the virtual machine. */
#include "cli/message.h"
#include "cli/output_file.h"
#include "findings/circle_findings.h"
#include "takt/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Less than this part of --feed is told. */
#define FEED_PART 0.999

/* When nothing is said. */
#define RADIUS_MM   50
#define FEED_MM_MIN 3000

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

static bool set_test(struct circle_findings *found, const struct options *options)
{
    static const char *const outputs[] = {"output", "json"};
    const struct option_circle *given = &options->circle;
    struct circle_test *test = &found->test;

    test->radius_mm = given->radius > 0 ? given->radius : RADIUS_MM;
    test->feed_mm_min = given->feed > 0 ? given->feed : FEED_MM_MIN;
    if (!output_file_differ(outputs, (const char *const[]){options->output, options->json}, 2) ||
        !read_plane(given->plane, &test->plane) || !read_centre(given->centre, test))
        return false;
    takt_plane_axes(test->plane, &found->axis[0], &found->axis[1]);
    return true;
}

/* Writes files that are open: all of them or none. */
static bool write_files(const struct circle_findings *found, struct output_file *picture,
                        struct output_file *json)
{
    if (picture->stream != NULL)
        circle_findings_write_picture(picture->stream, found);
    if (json->stream != NULL)
        circle_findings_write_json(json->stream, found);
    return (picture->stream == NULL || output_file_finish(picture)) &&
           (json->stream == NULL || output_file_finish(json));
}

static enum command_status finish(struct circle_findings *found, const struct options *options,
                                  struct output_file *picture, struct output_file *json)
{
    const bool has_picture = picture->stream != NULL, has_json = json->stream != NULL;
    const double deviation_mm = found->figures[CIRCLE_WAYS].deviation_mm;

    if (found->test.reached_mm_min < FEED_PART * found->test.feed_mm_min)
        message_command_warning(
            "F%g is not reached: the limits of axes and path leave F%.6g on this "
            "circle, and the figures are of that",
            found->test.feed_mm_min, found->test.reached_mm_min);
    if (!options->quiet && picture->stream != stdout && json->stream != stdout)
        circle_findings_print(found);
    if (!write_files(found, picture, json) || (has_picture && !output_file_place(picture)) ||
        (has_json && !output_file_place(json)))
        return STATUS_ENVIRONMENT;
    if (options->tolerance > 0 && deviation_mm > options->tolerance) {
        message_command_error("the circular deviation of both ways, %.6f mm, is above --tolerance",
                              deviation_mm);
        return STATUS_FAILED;
    }
    return STATUS_DONE;
}

static enum command_status execute(struct circle_findings *found, const struct options *options)
{
    static struct output_file picture, json;
    enum command_status status = STATUS_INPUT;

    if (set_test(found, options))
        status = (options->output == NULL || output_file_open(&picture, options->output)) &&
                         (options->json == NULL || output_file_open(&json, options->json))
                     ? circle_test_run(&found->test, options)
                     : STATUS_ENVIRONMENT;
    if (status == STATUS_DONE) {
        circle_findings_take(found);
        status = finish(found, options, &picture, &json);
    }
    output_file_discard(&picture);
    output_file_discard(&json);
    return status;
}

static enum command_status command_circle_execute(const struct options *options)
{
    struct circle_findings *found = calloc(1, sizeof *found);
    enum command_status status = STATUS_ENVIRONMENT;

    if (found == NULL) {
        message_command_error("out of memory");
        return status;
    }
    status = execute(found, options);
    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        circle_turn_free(&found->test.turn[way]);
    free(found);
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
        "  takt circle --radius 100 --feed 2000 --set drive.1.backlash_mm=0.005 --tolerance 0.01\n"
        "  takt circle --machine mill3.ini --plane ZX --centre=-50,120 --json -\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_circle_execute,
};
