#include "mps2/console_line.h"

#include "mps2/uart.h"
#include "port/cortex_m.h"
#include "port/embedded_console.h"

#define CONSOLE_UART 3

static struct {
    struct embedded_console console;
    struct uart uart;
    struct service_lines lines;
} line;

/* The line's interrupt makes room. */
static void write(void *context, const char *text, size_t length)
{
    (void)context;
    while (!uart_send(&line.uart, text, length))
        cortex_sleep();
}

static void take(void *context, uint8_t byte)
{
    (void)context;
    embedded_console_take_byte(&line.console, byte);
}

const struct service_lines *console_line_get_lines(void)
{
    line.lines = embedded_console_get_lines(&line.console);
    return &line.lines;
}

void console_line_open(struct embedded *embedded)
{
    const struct embedded_console_config config = {
        .embedded = embedded,
        .version = TAKT_VERSION,
        .write = write,
    };

    uart_open(&line.uart, CONSOLE_UART, take, NULL);
    embedded_console_init(&line.console, &config);
}

void console_line_serve(void)
{
    embedded_console_background(&line.console);
}
