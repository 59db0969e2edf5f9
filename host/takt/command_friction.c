/* takt friction: measure the friction of axes, for the drives to feed it forward. */
#include "base/maths.h"
#include "cli/axis_letters.h"
#include "cli/output_file.h"
#include "studies/friction_test.h"
#include "takt/command.h"

static void write_numbers(FILE *file, const double *number, unsigned count, double unit)
{
    for (unsigned i = 0; i < count; i++)
        (void)fprintf(file, " %.6g", unit * number[i]);
    (void)fputc('\n', file);
}

/* A section of the machine file. */
static void write_axis(FILE *file, const struct friction_axis *f, unsigned axis)
{
    const bool is_rotary = axis >= AXIS_LINEAR_COUNT;
    const double unit = is_rotary ? 180 / MATHS_PI : 1;

    (void)fprintf(file, "# axis %c; mean of both ways, Nm:", AXIS_LETTERS[axis]);
    write_numbers(file, f->offset_nm, FRICTION_VELOCITIES, 1);
    if (f->bus > 0)
        (void)fprintf(file, "[drive %u:%u]\n", f->bus, f->node);
    else
        (void)fprintf(file, "[drive %u]\n", f->node);
    (void)fputs("friction_forward_nm =", file);
    write_numbers(file, f->torque_nm, FRICTION_POINTS, 1);
    (void)fprintf(file, "friction_forward_step_%s_s = %.6g\n", is_rotary ? "deg" : "mm",
                  unit * f->step_mm_s);
}

static enum command_status write(const struct friction_test *test, const char *path)
{
    static struct output_file file;
    enum command_status status = STATUS_ENVIRONMENT;

    if (!output_file_open(&file, path))
        return status;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (test->axis[i].is_measured)
            write_axis(file.stream, &test->axis[i], i);
    }
    if (output_file_finish(&file) && output_file_place(&file))
        status = STATUS_DONE;
    output_file_discard(&file);
    return status;
}

static enum command_status command_friction_execute(const struct options *options)
{
    struct friction_test test = {0};
    enum command_status status = STATUS_INPUT;
    unsigned axes;

    if (axis_letters_read(options->axes, &axes))
        status = friction_test_run(&test, axes, options);
    return status == STATUS_DONE ? write(&test, options->output != NULL ? options->output : "-")
                                 : status;
}

static const struct option_row rows[] = {
    {"axes", OPTION_TEXT, offsetof(struct options, axes), "LETTERS",
     "XY, say (default: all on CAN)"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: the sections (default: standard output)"},
    OPTIONS_MACHINE,
    OPTIONS_END,
};

const struct command command_friction = {
    .name = "friction",
    .usage = "[options]",
    .summary = "measure the friction of axes on the virtual machine",
    .help =
        "Moves one axis after the other at seven velocities either way, and reads its drive's "
        "torque "
        "(6077). Half of\n"
        "what differs between both ways is friction; at rest it is what the two lowest velocities "
        "tend to. Prints sections\n"
        "of the machine file, by which the drives feed it forward: then they need not wait for "
        "their loops to turn the\n"
        "torque round where an axis does (takt circle shows what is left).\n"
        "\n"
        "Exit status: 0 done; 1 a drive faulted, or a velocity is never reached; 2 wrong input; 3 "
        "a "
        "file cannot be written.\n"
        "\n"
        "Examples:\n"
        "  takt friction --machine mill3.ini -o friction.ini\n"
        "  takt machine mill3.ini --with friction.ini > measured.ini\n"
        "  takt friction --axes X --set drive.1.coulomb_friction_nm=0.3\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_friction_execute,
};
