/* takt replay: send the frames of a bus log onto a bus. */
#include "cli/message.h"
#include "outside/bus_replay.h"
#include "takt/command.h"

static enum command_status command_replay_execute(const struct options *options)
{
    if (options->bus == NULL) {
        message_command_error("--bus is missing: where the frames are to go");
        return STATUS_INPUT;
    }
    return bus_replay_run(options);
}

static const struct option_row rows[] = {
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "socketcan:IF, slcan:PATH, slcan:pty, socketcand:HOST:PORT, socketcand:listen:PORT"},
    {"ids", OPTION_TEXT, offsetof(struct options, ids), "LIST",
     "only these identifiers: 80,181-183 (default: all)"},
    {"interface", OPTION_TEXT, offsetof(struct options, interface), "NAME",
     "only frames of this interface of the log, such as can1 (default: all)"},
    {"fast", OPTION_FLAG, offsetof(struct options, fast), NULL,
     "as fast as the bus allows, not at the times of the log"},
    {"fd", OPTION_FLAG, offsetof(struct options, fd), NULL, "the bus is to carry CAN FD frames"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no count of frames"},
    OPTIONS_END,
};

const struct command command_replay = {
    .name = "replay",
    .usage = "LOG --bus BUS [options]",
    .summary = "send the frames of a bus log onto a bus",
    .help =
        "LOG is what takt run --bus-log or candump -L has written; - is standard input. All of it "
        "is read\n"
        "before the first frame is sent. Error messages of interfaces are left out.\n"
        "\n"
        "What a controller said to the drives, said to them again:\n"
        "  takt run part.ngc --bus-log part.log\n"
        "  takt replay part.log --bus socketcan:vcan0 --ids 0-80,200-27f,300-37f,600-67f\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_replay_execute,
};
