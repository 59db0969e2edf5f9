/*
 * The firmware on an MPS2 board in QEMU, with everything it has on a machine: the control cycle in
 * the SysTick's interrupt, drives on CAN, an operator's panel on Modbus RTU, a log.
 *
 *     UART0   panel, Modbus RTU, unit 1
 *     UART1   drives, CAN as SLCAN
 *     UART2   log
 *     UART3   console for senders of Grbl, of takt-mps2-grbl alone
 *
 * A serial line carries some 200 to 550 cycles a second, less than the machine asks for. So a cycle
 * begins at the next millisecond after the drives have answered the last one; setpoints do not
 * depend on it.
 */
#include "mps2/board.h"
#include "mps2/console_line.h"
#include "mps2/slcan_can.h"
#include "mps2/uart.h"
#include "port/embedded.h"
#include "port/image.h"
#include "port/startup.h"

#include <string.h>

#define TOOLS_MAX 32

#define PANEL_UNIT 1

/*
 * QEMU and a busy computer leave long gaps between the bytes of a frame: only a line that has gone
 * silent ends one.
 */
#define PANEL_GAP_US 1000000U

#define TICK_US     1000U
#define TICK_CYCLES (BOARD_CLOCK_HZ / 1000U)

/* Until somebody is heard on the bus. */
#define TICKS_ANNOUNCE 200U

/*
 * Until all drives are in step a cycle takes this many ticks: they boot by the clock of their own
 * side.
 */
#define TICKS_STARTING 5U
/* One that has been in step and does not answer for so long is given up. */
#define TICKS_PATIENCE 5000U

static struct board {
    struct embedded embedded;
    struct embedded_core core;
    struct uart panel, bus, log;
    struct slcan_can can;
    struct tool tools[TOOLS_MAX];
    volatile uint32_t ticks; /* since power-on */
    uint32_t waited;         /* ticks since the last cycle */
} board;

/* -- what the image asks of the board -- */

/*
 * The SysTick counts down. A tick that falls between the readings makes them be taken again; one
 * that waits, since what asks is as urgent as its interrupt, has not been counted yet.
 */
static uint32_t now_us(void *context)
{
    uint32_t ticks, value;

    (void)context;
    do {
        ticks = board.ticks;
        value = CORTEX_SYSTICK_VALUE;
        if ((CORTEX_ICSR & CORTEX_ICSR_SYSTICK_SET) != 0) {
            value = CORTEX_SYSTICK_VALUE;
            ticks++;
        }
    } while (ticks - board.ticks > 1U);
    return ticks * TICK_US + (TICK_CYCLES - 1U - value) / (BOARD_CLOCK_HZ / 1000000U);
}

static uint32_t now_ns(void *context)
{
    return now_us(context) * 1000U;
}

static void reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    (void)takt_uart_send(&board.panel, bytes, length);
}

static void write_log(void *context, const char *text)
{
    (void)context;
    if (takt_uart_send(&board.log, text, strlen(text)))
        (void)takt_uart_send(&board.log, "\r\n", 2);
}

/* -- interrupts -- */

static void take_panel_byte(void *context, uint8_t byte)
{
    takt_embedded_take_byte(&board.embedded, byte, now_us(context));
}

static const struct machine_axis *machine_axis_of(unsigned axis)
{
    return &board.embedded.service.controller.machine.axis[axis];
}

static bool is_drive(const struct machine_axis *axis)
{
    return machine_axis_is_on_can(axis);
}

static void give_up_silent(void)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = machine_axis_of(i);

        if (is_drive(axis) && !takt_slcan_can_has_answered(&board.can, axis->drive_node))
            takt_slcan_can_give_up(&board.can, axis->drive_node);
    }
}

/* Have all drives answered what they have been asked, and are all in step? */
static bool have_answered(bool *all_in_step)
{
    bool answered = true;

    *all_in_step = true;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = machine_axis_of(i);

        if (!is_drive(axis))
            continue;
        if (!takt_slcan_can_is_in_step(&board.can, axis->drive_node))
            *all_in_step = false;
        if (!takt_slcan_can_has_answered(&board.can, axis->drive_node))
            answered = false;
    }
    return answered;
}

static bool is_due(void)
{
    bool all_in_step;

    if (!takt_uart_is_idle(&board.bus))
        return false;
    if (have_answered(&all_in_step))
        return all_in_step || board.waited >= TICKS_STARTING;
    if (board.waited < TICKS_PATIENCE)
        return false;
    give_up_silent();
    return true;
}

/*
 * A cycle is late by the machine's own time, not by that of a slow serial line: none is counted as
 * such.
 */
void takt_port_systick(void)
{
    const struct inputs inputs = inputs_idle();

    if (board.ticks++ % TICKS_ANNOUNCE == 0)
        (void)takt_slcan_can_announce(&board.can);
    board.waited++;
    if (!is_due())
        return;
    board.waited = 0;
    takt_embedded_cycle(&board.embedded, &inputs, false);
}

STARTUP_INTERRUPTS(board_interrupts, 20) = {
    takt_uart_0_receive, takt_uart_0_send, takt_uart_1_receive,        takt_uart_1_send,
    takt_uart_2_receive, takt_uart_2_send, [18] = takt_uart_3_receive, takt_uart_3_send};

/* -- start -- */

static void open_embedded(void)
{
    struct machine machine; /* the controller has a copy */
    const struct embedded_config config = {
        .machine = &machine,
        .core = &board.core,
        .can.port[0] = takt_slcan_can_get_port(&board.can),
        .tools = board.tools,
        .tools_count = TOOLS_MAX,
        .port = {.lock = cortex_lock,
                 .unlock = cortex_unlock,
                 .now_us = now_us,
                 .now_ns = now_ns,
                 .reply = reply,
                 .log = write_log},
        .lines = takt_console_line_get_lines(),
        .unit = PANEL_UNIT,
        .gap_us = PANEL_GAP_US,
        .name = "takt " TAKT_VERSION " on MPS2",
    };

    takt_machine_set_default(&machine);
    for (uint32_t i = 0; i < TOOLS_MAX; i++)
        board.tools[i].number = i + 1;
    takt_embedded_init(&board.embedded, &config);
}

/*
 * Not inlined: on the stack its diagnostic does not lie beside the machine, where the deepest call
 * begins.
 */
static __attribute__((noinline)) void refuse_damaged(void)
{
    struct diagnostic damage;

    if (!takt_image_is_sound(&damage))
        takt_embedded_refuse(&board.embedded, &damage);
}

static void start_ticks(void)
{
    cortex_set_systick_priority(BOARD_PRIORITY_CYCLE);
    CORTEX_SYSTICK_RELOAD = TICK_CYCLES - 1U;
    CORTEX_SYSTICK_VALUE = 0;
    CORTEX_SYSTICK_CONTROL = CORTEX_SYSTICK_ON | CORTEX_SYSTICK_INTERRUPT | CORTEX_SYSTICK_CORE;
}

int main(void)
{
    takt_uart_open(&board.log, 2, NULL, NULL);
    takt_uart_open(&board.bus, 1, takt_slcan_can_take, &board.can);
    takt_slcan_can_open(&board.can, &board.bus);
    open_embedded();
    refuse_damaged();
    takt_uart_open(&board.panel, 0, take_panel_byte, NULL);
    takt_console_line_open(&board.embedded);
    start_ticks();
    for (;;) {
        takt_embedded_background(&board.embedded);
        takt_console_line_serve();
        cortex_sleep();
    }
}
