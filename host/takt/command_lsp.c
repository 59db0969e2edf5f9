/* takt lsp: tell an editor what is wrong in a program, what a word means, where a subroutine is. */
#define _POSIX_C_SOURCE 200809L

#include "cli/interrupt.h"
#include "cli/message.h"
#include "editor/lint.h"
#include "editor/lsp.h"
#include "editor/lsp_frames.h"
#include "takt/command.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/*
 * Lines that loops may repeat in all while a text is being written, unless --lines-max says
 * otherwise: a moment.
 */
#define LINES_MAX 300000

static void write_message(void *context, const char *json)
{
    (void)context;
    (void)printf("Content-Length: %zu\r\n\r\n%s", strlen(json), json);
    (void)fflush(stdout);
}

/* Has the editor nothing to say at this moment? */
static bool is_quiet(void)
{
    struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};

    return poll(&in, 1, 0) == 0;
}

/* False: what has come is not the protocol. */
static bool hear_all(struct lsp *server, struct lsp_frames *frames)
{
    enum lsp_frame frame = LSP_FRAME_WHOLE;
    const char *json;
    size_t length;

    while (!server->ended && (frame = lsp_frames_next(frames, &json, &length)) == LSP_FRAME_WHOLE)
        lsp_hear(server, json, length);
    return frame != LSP_FRAME_BROKEN;
}

/* The end of the input before exit is one without order. */
static enum command_status serve(struct lsp *server, struct lsp_frames *frames)
{
    static char bytes[65536];

    while (!server->ended) {
        const ssize_t got = read(STDIN_FILENO, bytes, sizeof bytes);

        if (interrupt_asked())
            return STATUS_INTERRUPTED;
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return STATUS_FAILED;
        if (!lsp_frames_add(frames, bytes, (size_t)got)) {
            message_command_error("out of memory");
            return STATUS_ENVIRONMENT;
        }
        if (!hear_all(server, frames)) {
            message_command_error("standard input: this is not the language server protocol");
            return STATUS_INPUT;
        }
        if (is_quiet())
            lsp_rest(server);
    }
    return server->shut_down ? STATUS_DONE : STATUS_FAILED;
}

static enum command_status command_lsp_execute(const struct options *options)
{
    struct options own = *options;
    struct lsp server = {.options = &own, .write = write_message};
    struct lsp_frames frames = {0};
    enum command_status status = STATUS_INPUT;

    if (own.lines_max == 0)
        own.lines_max = LINES_MAX;
    if (lint_read_top(options->stock_top, &server.stock_top_mm))
        status = serve(&server, &frames);
    lsp_close(&server);
    lsp_frames_close(&frames);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"stock-top", OPTION_TEXT, offsetof(struct options, stock_top), "Z",
     "top of the stock in work coordinates, mm (default 0)"},
    OPTIONS_END,
};

const struct command command_lsp = {
    .name = "lsp",
    .usage = "[options]",
    .summary =
        "tell an editor what is wrong in a program, what a word means, where a subroutine is",
    .help = "A server of the language server protocol on standard input and output; editors start "
            "it. It tells what takt "
            "check and takt\n"
            "lint find, as the text is written; what the word under the pointer means, and which "
            "modes are in effect "
            "before its line;\n"
            "and where the subroutine is that a line calls, also in another file. Loops repeat "
            "300000 lines in all, "
            "unless --lines-max\n"
            "says otherwise.\n"
            "\n"
            "Examples:\n"
            "  takt lsp --machine mill.ini --tools tools.tbl\n"
            "  vim.lsp.start({name = 'takt', cmd = {'takt', 'lsp'}})          in Neovim, for a "
            "buffer\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_lsp_execute,
};
