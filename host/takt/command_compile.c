/* takt compile: plan a program's motion ahead of the run, inside the tolerance of G64. */
#include "cli/message.h"
#include "cli/output_file.h"
#include "compiled/compiled.h"
#include "session/session.h"
#include "takt/command.h"

#include <string.h>

/* False after a message: it has to be a file that can be written at its beginning again. */
static bool check_output(const struct options *options)
{
    if (options->output != NULL && strcmp(options->output, "-") != 0)
        return true;
    message_command_error("-o FILE says where the compiled program goes; it cannot go to "
                          "standard output");
    return false;
}

static void print_figures(const struct session *s, const struct compiled_figures *f)
{
    (void)printf("%s: %.3f s in %u blocks, compiled in %.1f s, %.2f kB a second of motion\n",
                 s->program.name, f->time_s, (unsigned)f->blocks, f->compile_s,
                 f->time_s > 0 ? 1e-3 * (double)f->bytes / f->time_s : 0);
    (void)printf("  part of the time at an axis's limit  velocity %.0f %%, acceleration %.0f %%, "
                 "jerk %.0f %%\n",
                 100 * f->at_velocity, 100 * f->at_acceleration, 100 * f->at_jerk);
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (s->setup.machine.axis[i].present)
            (void)printf("  %c: peak velocity %.4f, acceleration %.4f, jerk %.4f of the limit\n",
                         AXIS_LETTERS[i], f->velocity[i], f->acceleration[i], f->jerk[i]);
    }
    (void)printf("  %s at most %.6f mm off the path, its corners %.6f mm off the %s\n",
                 f->of_tool ? "tool" : "setpoints", f->tube.deviation_mm, f->tube.corner_mm,
                 f->of_tool ? "tool" : "setpoints");
    if (f->of_strays)
        (void)printf("  tool at most %.6f mm off it where modes are as much lower as they may be, "
                     "%.6f mm where higher\n",
                     f->stray[0].deviation_mm, f->stray[1].deviation_mm);
}

static enum command_status compile_into(const struct session *s,
                                        const struct session_totals *totals, uint32_t ceiling,
                                        struct output_file *file)
{
    struct compiled_figures figures;
    enum command_status status = compiled_make(s, totals, ceiling, file->stream, &figures);

    if (status != STATUS_DONE)
        return status;
    if (!(output_file_finish(file) && output_file_place(file)))
        return STATUS_ENVIRONMENT;
    if (!s->options->quiet)
        print_figures(s, &figures);
    return STATUS_DONE;
}

static enum command_status command_compile_execute(const struct options *options)
{
    static struct output_file file;
    static struct session session;
    struct session_totals totals;
    uint32_t ceiling = 0;
    enum command_status status;

    if (!compiled_read_ceiling(options, &ceiling) || !check_output(options))
        return STATUS_INPUT;
    status = session_open(&session, options);
    session.runs = true;
    if (status == STATUS_DONE && !compiled_check_machine(&session))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE && !output_file_open(&file, options->output))
        status = STATUS_ENVIRONMENT;
    if (status == STATUS_DONE)
        status = compile_into(&session, &totals, ceiling, &file);
    output_file_discard(&file);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "the compiled program (also -o)"},
    {"ceiling", OPTION_POSITIVE, offsetof(struct options, ceiling), "PERCENT",
     "highest feed override for its runs, 100 (default) to 120"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no figures, no progress bar"},
    OPTIONS_END,
};

const struct command command_compile = {
    .name = "compile",
    .usage = "PROGRAM -o FILE [options]",
    .summary = "plan a program's motion ahead of the run, inside the tolerance of G64",
    .help = "The whole program is optimised before anything moves: the path within the tolerance "
            "of G64 P, and the time\n"
            "it takes, under every axis's velocity, acceleration and jerk. The result is replayed "
            "and judged, setpoint by\n"
            "setpoint. If it breaks a limit or the tolerance, it is not written. The file belongs "
            "to this program on this\n"
            "machine, and takt run refuses it for any other.\n"
            "\n"
            "With --ceiling 120 the feed override may go up to 120 %; at 100 % the program then "
            "runs at 1/1.2 of the\n"
            "compiled speed.\n"
            "\n"
            "Examples:\n"
            "  takt compile part.ngc -o part.plan\n"
            "  takt run part.ngc --plan part.plan\n"
            "  takt run part.ngc --plan ahead\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_compile_execute,
};
