/*
 * A board of your own: a timer for the control cycle, a serial line for the log, pulses for step
 * drives. What your board does otherwise stands in the functions of `the board`; port/embedded.h
 * says what each of them is to do.
 *
 *     SysTick -> takt_embedded_cycle -> pulse          main -> takt_embedded_background -> write_log
 */
#include "port/cortex_m.h"
#include "port/startup.h"
#include "takt.h"

#include <string.h>

#define CLOCK_HZ  25000000U
#define TOOLS_MAX 16

/* A serial line of the MPS2 (CMSDK APB UART). */
#define UART_DATA    *(volatile uint32_t *)0x40004000U
#define UART_STATE   *(volatile uint32_t *)0x40004004U
#define UART_CONTROL *(volatile uint32_t *)0x40004008U
#define UART_DIVIDER *(volatile uint32_t *)0x40004010U

static struct board {
    struct embedded embedded;
    struct embedded_core core;
    struct tool tools[TOOLS_MAX];
    struct machine machine;
    volatile uint32_t cycles;
    uint32_t pulses;
} board;

/* ---- the board ---- */

static uint32_t now_us(void *context)
{
    (void)context;
    return board.cycles * board.machine.cycle_us;
}

static uint32_t now_ns(void *context)
{
    return now_us(context) * 1000U;
}

static void write_line(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        while ((UART_STATE & 1U) != 0) {
        }
        UART_DATA = (uint8_t)text[i];
    }
}

static void write_log(void *context, const char *text)
{
    (void)context;
    write_line(text, strlen(text));
    write_line("\r\n", 2);
}

/* Queue the bytes on the panel's line; this board has none. */
static void reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    (void)bytes;
    (void)length;
}

/* Hand the pulse to a timer. */
static bool pulse(void *context, const struct step_pulse *next)
{
    (void)context;
    (void)next;
    board.pulses++;
    return true;
}

static bool bus_send(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static bool bus_receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

/* The control cycle. */
void takt_port_systick(void)
{
    const struct inputs inputs = inputs_idle();

    board.cycles++;
    takt_embedded_cycle(&board.embedded, &inputs, false);
}

/* ---- start ---- */

static void make_machine(struct machine *machine)
{
    takt_machine_set_default(machine);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        machine->axis[i].drive_type = MACHINE_DRIVE_STEP;
        machine->axis[i].steps_per_mm = 400;
        machine->axis[i].step_rate_max_hz = 100000;
    }
}

static void open_embedded(void)
{
    const struct embedded_config config = {
        .machine = &board.machine,
        .core = &board.core,
        .can = {.port = {{bus_send, bus_receive, NULL}}},
        .step = {.pulse = pulse},
        .tools = board.tools,
        .tools_count = TOOLS_MAX,
        .port = {.lock = cortex_lock,
                 .unlock = cortex_unlock,
                 .now_us = now_us,
                 .now_ns = now_ns,
                 .reply = reply,
                 .log = write_log},
        .unit = 1,
        .gap_us = 1750,
        .name = "takt on a board of mine",
    };

    make_machine(&board.machine);
    takt_embedded_init(&board.embedded, &config);
}

int main(void)
{
    UART_DIVIDER = 16;
    UART_CONTROL = 1;
    open_embedded();
    cortex_set_systick_priority(CORTEX_PRIORITY_CYCLE);
    CORTEX_SYSTICK_RELOAD = CLOCK_HZ / 1000000U * board.machine.cycle_us - 1U;
    CORTEX_SYSTICK_VALUE = 0;
    CORTEX_SYSTICK_CONTROL = CORTEX_SYSTICK_ON | CORTEX_SYSTICK_INTERRUPT | CORTEX_SYSTICK_CORE;
    for (;;) {
        takt_embedded_background(&board.embedded);
        cortex_sleep();
    }
}
