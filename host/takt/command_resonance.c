/* takt resonance: measure the modes between drives and tool. */
#include "cli/axis_letters.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "studies/resonance_test.h"
#include "takt/command.h"

#include <math.h>
#include <stdlib.h>

/* Noise of an accelerometer of the kind that is glued to a machine: some 2 mg. */
#define NOISE_MM_S2 20

static const char section[] = "[geometry]\n";

static bool read_noise(const char *text, double *noise_mm_s2)
{
    char *end;

    if (text == NULL)
        return true;
    *noise_mm_s2 = strtod(text, &end);
    if (end != text && *end == '\0' && *noise_mm_s2 >= 0 && isfinite(*noise_mm_s2))
        return true;
    message_command_error("--noise %s: a number, 0 or more, is expected", text);
    return false;
}

/* How sure the numbers are: two standard deviations. */
static void write_mode(FILE *file, char letter, const struct resonance_mode *m)
{
    (void)fprintf(file, "# %c: %.3f +- %.3f Hz, damping %.4f +- %.4f, part %.3f +- %.3f\n", letter,
                  m->hz.value, 2 * m->hz.deviation, m->damping.value, 2 * m->damping.deviation,
                  m->part.value, 2 * m->part.deviation);
}

static void write_axis(FILE *file, const struct resonance_fit *fit, unsigned axis)
{
    const char letter = AXIS_LETTERS[axis];

    if (fit->modes == 0)
        (void)fprintf(file, "# %c: no mode;", letter);
    for (unsigned m = 0; m < fit->modes; m++)
        write_mode(file, letter, &fit->mode[m]);
    (void)fprintf(file, "%s %.1f mm/s2 rms are left\nmode_%c =", fit->modes == 0 ? "" : "#",
                  fit->left_mm_s2, letter - 'A' + 'a');
    for (unsigned m = 0; m < VIBRATION_MODES; m++)
        (void)fprintf(file, " %.6g %.5g %.5g", fit->mode[m].hz.value, fit->mode[m].damping.value,
                      fit->mode[m].part.value);
    (void)fputc('\n', file);
}

/* Two standard deviations of the first mode's frequency; with two modes none is planned for. */
static double uncertain_percent(const struct resonance_fit *fit)
{
    return fit->modes == 1 ? 100 * 2 * fit->mode[0].hz.deviation / fit->mode[0].hz.value : 0;
}

/*
 * To be taken, or raised by what the machine changes by itself: it costs time, so it is a remark.
 */
static void write_uncertain(FILE *file, const struct resonance_test *test)
{
    (void)fputs("# mode_uncertainty_percent =", file);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        (void)fprintf(file, " %.2g", test->is_measured[i] ? uncertain_percent(&test->fit[i]) : 0);
    (void)fputc('\n', file);
}

static enum command_status write(const struct resonance_test *test, const char *path)
{
    static struct output_file file;
    enum command_status status = STATUS_ENVIRONMENT;

    if (!output_file_open(&file, path))
        return status;
    (void)fputs(section, file.stream);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (test->is_measured[i])
            write_axis(file.stream, &test->fit[i], i);
    }
    write_uncertain(file.stream, test);
    if (output_file_finish(&file) && output_file_place(&file))
        status = STATUS_DONE;
    output_file_discard(&file);
    return status;
}

static enum command_status command_resonance_execute(const struct options *options)
{
    static struct resonance_test test;
    enum command_status status = STATUS_INPUT;
    unsigned axes;

    test = (struct resonance_test){.noise_mm_s2 = NOISE_MM_S2, .seed = options->correction.seed};
    if (axis_letters_read(options->axes, &axes) &&
        read_noise(options->correction.noise, &test.noise_mm_s2))
        status = resonance_test_run(&test, axes, options);
    return status == STATUS_DONE ? write(&test, options->output != NULL ? options->output : "-")
                                 : status;
}

static const struct option_row rows[] = {
    {"axes", OPTION_TEXT, offsetof(struct options, axes), "LETTERS",
     "XY, say (default: all linear ones with a drive on CAN)"},
    {"noise", OPTION_TEXT, offsetof(struct options, correction.noise), "MM/S2",
     "of the accelerometer, standard deviation (20)"},
    {"seed", OPTION_WHOLE, offsetof(struct options, correction.seed), "N",
     "of moves and noise (0)"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: the section (default: standard output)"},
    OPTIONS_MACHINE,
    OPTIONS_END,
};

const struct command command_resonance = {
    .name = "resonance",
    .usage = "[options]",
    .summary = "measure the modes between drives and tool on the virtual machine",
    .help =
        "Moves one axis after the other to and fro at random, and reads an accelerometer at the "
        "tool. Of what it says beside\n"
        "the drive's own acceleration, frequency, damping and part of up to two modes are found by "
        "least squares; how many\n"
        "there are is decided by Schwarz's criterion. Prints a section of the machine file, with "
        "two standard deviations\n"
        "of each number in remarks.\n"
        "\n"
        "Exit status: 0 done; 1 a drive faulted; 2 wrong input; 3 a file cannot be written.\n"
        "\n"
        "Examples:\n"
        "  takt resonance --set \"geometry.mode_x=25 0.03 1 0 0 0\"\n"
        "  takt resonance --machine soft.ini --axes X --noise 50 -o modes.ini\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_resonance_execute,
};
