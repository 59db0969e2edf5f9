/* takt serve: the controller as a service, with the operator's panel on Modbus. */
#include "cli/message.h"
#include "serving/serving.h"
#include "takt/command.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

/* Upper ends of the classes of lateness that are printed, us. */
static const unsigned late_us[] = {10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

#define LATE_CLASSES (sizeof late_us / sizeof late_us[0])

static void print_page(const struct serving *s)
{
    if (s->page.server != NULL)
        serving_page_print(s->options.http, s->page.server);
    else if (s->page.problem != NULL)
        (void)printf("no page: %s\n", s->page.problem);
}

static void print_ready(const struct serving *s)
{
    const struct server_config *config = &s->server.config;

    if (config->address != NULL)
        (void)printf("panel on %s:%u\n", config->address, (unsigned)server_get_port(&s->server));
    if (config->serial >= 0)
        (void)printf("panel on %s, unit %u\n", s->options.serial.path, (unsigned)config->unit);
    print_page(s);
    serving_console_print(s);
    (void)fflush(stdout);
}

static void print_lateness(const struct pace *pace)
{
    unsigned step = 0;

    (void)printf("  cycles begun late by\n");
    for (size_t i = 0; i < LATE_CLASSES; i++) {
        uint64_t count = 0;

        for (; step < late_us[i] * (1000 / PACE_STEP_NS); step++)
            count += pace->steps[step];
        (void)printf("    < %5u us  %10" PRIu64 "\n", late_us[i], count);
    }
}

static void print_figures(const struct serving *s)
{
    const struct server *server = &s->server;
    struct pace_figures pace;

    pace_get_figures(&s->network.pace, &pace);
    (void)printf("served %" PRIu64 " cycles, %" PRIu64 " of them over their time\n", s->cycles,
                 pace.overruns);
    (void)printf("  late        mean %.1f us, 99 %%: %.1f, max: %.1f\n",
                 1e-3 * pace.lateness_mean_ns, 1e-3 * pace.lateness_p99_ns,
                 1e-3 * (double)pace.lateness_max_ns);
    print_lateness(&s->network.pace);
    (void)printf("  panel       %llu requests, %llu connections, %llu refused, %llu dropped\n",
                 (unsigned long long)server->answered, (unsigned long long)server->accepted,
                 (unsigned long long)server->refused, (unsigned long long)server->dropped);
}

static enum command_status command_serve_execute(const struct options *options)
{
    struct serving *serving = calloc(1, sizeof *serving);
    enum command_status status;

    if (serving == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = serving_open(serving, options);
    if (status == STATUS_DONE) {
        if (!options->quiet)
            print_ready(serving);
        status = serving_run(serving);
        if (!options->quiet)
            print_figures(serving);
    }
    serving_close(serving);
    free(serving);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_DRIVEN,
    {"listen", OPTION_TEXT, offsetof(struct options, panel.listen), "HOST:PORT",
     "Modbus TCP of the panel (default 127.0.0.1:1502; port 0: any)"},
    {"http", OPTION_TEXT, offsetof(struct options, panel.http), "HOST:PORT|off",
     "page in the browser (default 127.0.0.1:8080; port 0: any)"},
    {"grbl", OPTION_TEXT, offsetof(struct options, panel.grbl), "tcp:HOST:PORT|pty:LINK",
     "Grbl 1.1's interface for one sender: on a socket, or a pseudo terminal that LINK names"},
    {"serial", OPTION_TEXT, offsetof(struct options, panel.serial), "PATH[,BAUD[,PARITY]]",
     "Modbus RTU of the panel too (default 19200, even)"},
    {"unit", OPTION_POSITIVE, offsetof(struct options, panel.unit), "N",
     "unit on the serial line (default 1)"},
    {"program", OPTION_INPUT, offsetof(struct options, panel.program), "FILE",
     "load this program; CYCLE_START starts it"},
    {"store", OPTION_TEXT, offsetof(struct options, panel.store), "FILE",
     "keep uploaded programs there, and load the last one at start"},
    {"state", OPTION_TEXT, offsetof(struct options, panel.state), "DIR|none",
     "keep offsets, parameters, tools and wear, program and line there (default: see below)"},
    {"from-line", OPTION_LINE, offsetof(struct options, from_line), "N",
     "the first CYCLE_START starts the program in the middle, as takt run does"},
    {"insecure", OPTION_FLAG, offsetof(struct options, panel.insecure), NULL,
     "listen beyond this computer though neither panel.allow nor panel.password is set"},
    {"spindle", OPTION_TEXT, offsetof(struct options, panel.spindle), "WHERE",
     "spindle drive on Modbus: HOST:PORT, or PATH[,BAUD[,PARITY]] (default: virtual, inside)"},
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "embedded (default), socketcan:IF, slcan:PATH, socketcand:HOST:PORT; of two buses both, with "
     "a comma"},
    {"drives", OPTION_TEXT, offsetof(struct options, drives), "WHERE",
     "internal on the embedded bus, external on any other; m4f, m7: each an image in QEMU"},
    {"drive-image", OPTION_INPUT, offsetof(struct options, drive_image), "FILE",
     "its image, takt-drive.elf; host/run --drives builds it"},
    {"bus-log", OPTION_TEXT, offsetof(struct options, bus_log), "FILE",
     "every CAN frame, as candump -L writes it; takt replay reads it"},
    OPTIONS_MACHINE,
    {"tools", OPTION_INPUT, offsetof(struct options, tools), "FILE", "tool table, LinuxCNC's .tbl"},
    {"parameters", OPTION_INPUT, offsetof(struct options, parameters), "FILE",
     "parameters, LinuxCNC's .var"},
    {"exact-path", OPTION_FLAG, offsetof(struct options, exact_path), NULL,
     "treat every G64 as G61"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "print errors alone"},
    OPTIONS_END,
};

const struct command command_serve = {
    .name = "serve",
    .usage = "[options]",
    .summary = "the controller as a service, with the operator's panel on Modbus",
    .help =
        "Runs in real time until SIGTERM or Ctrl-C. Without options: the built-in machine with "
        "virtual drives and\n"
        "spindle, and the panel on 127.0.0.1:1502 for any number of clients. `takt panel list` "
        "lists its registers.\n"
        "A browser shows and drives the machine at http://127.0.0.1:8080/.\n"
        "--grbl: senders made for Grbl 1.1 (CNCjs, UGS, bCNC) drive it as well, by the same rules; "
        "text they stream runs\n"
        "with the setpoints of the same text in a file (host/docs/grbl.md).\n"
        "The section [panel] of the machine file says who may connect to both, and sets a "
        "password.\n"
        "\n"
        "Its state is kept in $XDG_STATE_HOME/takt/MACHINE, by default "
        "~/.local/state/takt/MACHINE: never older than a\n"
        "second, and whole after a power cut. Tools and parameters of a file count again when "
        "the file has changed.\n"
        "\n"
        "SIGTERM, SIGHUP and Ctrl-C end it in order: the axes come to rest on their path, the "
        "drives brake and go off\n"
        "(drives_stay_on of [bus]: stay switched on), spindle and coolant stop. That is status "
        "0. A second one brakes at\n"
        "once: status 130 (Ctrl-C), 143 (SIGTERM), 129 (SIGHUP). A bus log that cannot be "
        "written ends it, too: status 3.\n"
        "A bus that is lost is an alarm; it is looked for, and RESET enables the drives "
        "again.\n"
        "\n"
        "At its end it prints how late control cycles began.\n"
        "\n"
        "Examples:\n"
        "  takt serve\n"
        "  takt serve --program part.ngc --machine mill.ini\n"
        "  takt serve --grbl tcp:127.0.0.1:2300\n"
        "  takt serve --grbl pty:/tmp/ttyGRBL          (a serial port for senders that know no "
        "other)\n"
        "  takt serve --spindle 127.0.0.1:1503        (takt drives --spindle 127.0.0.1:1503)\n"
        "  takt serve --listen 0.0.0.0:1502 --set panel.allow=192.168.1.0/24 --store "
        "program.ngc\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_serve_execute,
};
