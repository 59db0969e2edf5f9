#include "mps2/console_line.h"

#include "mps2/uart.h"
#include "port/cortex_m.h"
#include "port/embedded_console.h"

#define CONSOLE_UART 3

static struct {
    struct embedded_console console;
    struct uart uart;
    struct service_lines lines;
    bool is_unread;
} line;

/*
 * After this many interrupts without a byte sent nobody reads: each control cycle has one or more,
 * so 0.2 s at 1 ms.
 */
#define STILL_MAX 200

/*
 * The line's interrupt makes room. While nobody reads what does not fit is dropped, since the panel
 * would have to wait; the first piece that fits shows that somebody does again.
 */
static void write(void *context, const char *text, size_t length)
{
    uint32_t sent = line.uart.sent;
    unsigned still = 0;

    (void)context;
    while (!takt_uart_send(&line.uart, text, length)) {
        if (line.is_unread)
            return;
        cortex_sleep();
        still = line.uart.sent == sent ? still + 1 : 0;
        sent = line.uart.sent;
        line.is_unread = still == STILL_MAX;
    }
    line.is_unread = false;
}

static void take(void *context, uint8_t byte)
{
    (void)context;
    takt_embedded_console_take_byte(&line.console, byte);
}

const struct service_lines *takt_console_line_get_lines(void)
{
    line.lines = takt_embedded_console_get_lines(&line.console);
    return &line.lines;
}

void takt_console_line_open(struct embedded *embedded)
{
    const struct embedded_console_config config = {
        .embedded = embedded,
        .version = TAKT_VERSION,
        .write = write,
    };

    takt_uart_open(&line.uart, CONSOLE_UART, take, NULL);
    takt_embedded_console_init(&line.console, &config);
}

void takt_console_line_serve(void)
{
    takt_embedded_console_background(&line.console);
}
