/*
 * The firmware on an STM32: the control cycle in the interrupt of a timer, drives on CAN or on step
 * and direction pins, an operator's panel on RS-485, a log, settings in flash.
 *
 * Nothing moves unless everything is as it must be: image, settings, crystal, CAN controller and
 * bus, and no crash before. What is not is told on log and panel (takt_embedded_refuse).
 */
#include "chip/board.h"
#include "chip/peripherals.h"
#include "chip/usart_registers.h"
#include "port/cortex_m.h"
#include "port/embedded.h"
#include "port/image.h"
#include "port/settings_upload.h"
#include "port/startup.h"
#include "stm32/can_controller.h"
#include "stm32/chip.h"
#include "stm32/clock.h"
#include "stm32/exceptions.h"
#include "stm32/findings.h"
#include "stm32/flash.h"
#include "stm32/log_ring.h"
#include "stm32/no_can.h"
#include "stm32/step_output.h"
#include "stm32/timers.h"
#include "stm32/usart.h"
#include "stm32/watchdog.h"
#include "storage/settings.h"
#include "storage/store.h"

#include <string.h>

_Static_assert(BOARD_PRIORITY_CYCLE == CORTEX_PRIORITY_CYCLE, "lock() holds the cycle back");

#define TOOLS_MAX 32U

#define NS_PER_US 1000U

/* Beside the core: nothing here is sent or received by direct memory access. */
STARTUP_CORE_MEMORY static struct embedded_core board_core;

static struct board {
    struct embedded embedded;
    struct clock clock;
    struct usart panel, log;
    uint8_t reply[MODBUS_RTU_MAX]; /* on its way to the panel */
    struct log_ring lines;
    struct can_controller can;
    struct step_output steps;
    struct flash flash;
    struct store store;
    struct settings_upload upload;
    struct correction_tables tables;
    struct concise_dcf dcf[MACHINE_NODES_MAX];
    struct tool tools[TOOLS_MAX];
    struct findings found;
    volatile uint32_t ticks; /* control cycles since the start, whether anything moves or not */
    uint32_t fed;            /* ticks when the watchdog was fed */
    bool has_steps, has_can;
    bool pressed; /* the emergency stop, as it was last told to the service */
} board;

/* ---- what the image asks of the board ---- */

static uint32_t now_us(void *context)
{
    (void)context;
    return takt_timers_now_us();
}

static uint32_t now_ns(void *context)
{
    return now_us(context) * NS_PER_US;
}

static void reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    if (takt_usart_is_idle(&board.panel))
        memcpy(board.reply, bytes, length);
    (void)takt_usart_send(&board.panel, board.reply, length);
}

static void write_log(void *context, const char *text)
{
    (void)context;
    (void)takt_log_ring_put(&board.lines, text);
}

/* What has been put into the ring, piece by piece. */
static void send_log(void)
{
    const uint8_t *bytes;
    size_t length;

    if (!takt_usart_is_idle(&board.log))
        return;
    length = takt_log_ring_take(&board.lines, &bytes, USART_SEND_MAX);
    if (length > 0)
        (void)takt_usart_send(&board.log, bytes, length);
}

/* ---- interrupts ---- */

static void take_panel_byte(void *context, uint8_t byte, uint32_t at_us)
{
    (void)context;
    takt_embedded_take_byte(&board.embedded, byte, at_us);
}

/* Nobody listens to what comes on the log's line. */
static void take_log_byte(void *context, uint8_t byte, uint32_t at_us)
{
    (void)context;
    (void)byte;
    (void)at_us;
}

static void on_can_sent(void)
{
    takt_can_controller_interrupt_sent(&board.can);
}

static void on_can_received(void)
{
    takt_can_controller_interrupt_received(&board.can);
}

static void on_panel(void)
{
    takt_usart_interrupt(&board.panel, takt_timers_now_us());
}

static void on_log(void)
{
    takt_usart_interrupt(&board.log, takt_timers_now_us());
}

static struct inputs read_inputs(void)
{
    struct inputs inputs = inputs_idle();

    inputs.probe_contact = !takt_gpio_read(board_probe);
    return inputs;
}

static void write_outputs(void)
{
    const struct outputs outputs = takt_embedded_get_outputs(&board.embedded);

    takt_gpio_write(board_spindle, outputs.spindle_speed_rpm != 0.0);
    takt_gpio_write(board_flood, outputs.flood);
    takt_gpio_write(board_mist, outputs.mist);
}

static void on_cycle(void)
{
    const struct inputs inputs = read_inputs();
    static bool late;

    takt_timers_take_cycle();
    board.ticks++;
    if (board.has_steps)
        takt_step_output_begin(&board.steps);
    if (board.has_can)
        takt_can_controller_poll(&board.can);
    takt_embedded_cycle(&board.embedded, &inputs, late);
    write_outputs();
    if (board.has_steps)
        takt_step_output_end(&board.steps);
    late = takt_timers_cycle_is_due();
}

/* No others are enabled; one that came all the same would end in takt_port_fault. */
STARTUP_INTERRUPTS(board_interrupts, BOARD_INTERRUPTS) = {
    [BOARD_CAN_SENT] = on_can_sent, [BOARD_CAN_RECEIVED] = on_can_received,
    [BOARD_CYCLE] = on_cycle,       [BOARD_LOG] = on_log,
    [BOARD_PANEL] = on_panel,
};

static void enable(enum board_interrupt interrupt, uint8_t priority)
{
    cortex_set_priority(interrupt, priority);
    cortex_enable_interrupt(interrupt);
}

/* ---- start: what is found wrong is noted, and everything else is started all the same ---- */

/* Why the chip has started. */
static void look_back(void)
{
    board.found.has_crashed = takt_exceptions_take_crash(&board.found.crash);
    board.found.was_bitten = (takt_chip_read(RCC_RESETS) & RCC_RESETS_WATCHDOG) != 0;
    chip_change(RCC_RESETS, 0, RCC_RESETS_FORGET);
}

static void open_log(void)
{
    const struct usart_config config = {.base = USART_USART1,
                                        .clock_hz = board.clock.bus2_hz,
                                        .bauds = BOARD_LOG_BAUDS,
                                        .take = take_log_byte};

    chip_change(RCC_APB2ENR, 0, RCC_APB2ENR_USART1);
    takt_gpio_set_function(board_log_tx, BOARD_USART_FUNCTION);
    takt_gpio_set_function(board_log_rx, BOARD_USART_FUNCTION);
    (void)takt_usart_open(&board.log, &config);
    enable(BOARD_LOG, BOARD_PRIORITY_LOG);
}

static void open_panel(void)
{
    const struct usart_config config = {
        .base = USART_USART2,
        .clock_hz = board.clock.bus1_hz,
        .bauds = BOARD_PANEL_BAUDS,
        .parity = USART_PARITY_EVEN,
        .has_driver = true,
        .driver = board_panel_driver,
        .gap_us = takt_modbus_rtu_gap_us(BOARD_PANEL_BAUDS, BOARD_PANEL_BITS),
        .take = take_panel_byte};

    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_USART2);
    takt_gpio_set_function(board_panel_tx, BOARD_USART_FUNCTION);
    takt_gpio_set_function(board_panel_rx, BOARD_USART_FUNCTION);
    (void)takt_usart_open(&board.panel, &config);
    enable(BOARD_PANEL, BOARD_PRIORITY_PANEL);
}

static void open_pins(void)
{
    takt_gpio_set_input(board_probe, true);
    takt_gpio_set_input(board_emergency, true);
    takt_gpio_set_output(board_spindle);
    takt_gpio_set_output(board_flood);
    takt_gpio_set_output(board_mist);
}

/* False: there are none that are right, and what is wrong is noted. */
static bool read_settings(struct machine *machine)
{
    struct diagnostic *wrong = &board.found.settings;
    const uint8_t *bytes;
    uint32_t size;

    if (!takt_store_get(&board.store, &bytes, &size)) {
        takt_diagnostic_set(wrong, TAKT_ERROR_SETTINGS_ABSENT, 0, 0, "", 0, 0);
        return false;
    }
    return takt_settings_read(bytes, size, machine, &board.tables, board.dcf, wrong) &&
           takt_settings_check_share(machine, &board.tables,
                                     &board.embedded.service.controller.correction, wrong);
}

/* Without settings the controller shows itself as the built-in machine, and moves nothing. */
static void open_settings(struct machine *machine)
{
    const struct flash_port flash =
        takt_flash_get_port(&board.flash, (const uint8_t *)(uintptr_t)FLASH_SECTOR_ADDRESS);

    takt_store_open(&board.store, &flash);
    if (read_settings(machine))
        return;
    takt_machine_set_default(machine);
    memset(&board.tables, 0, sizeof board.tables);
    memset(board.dcf, 0, sizeof board.dcf);
}

static unsigned list_nodes(const struct machine *machine, uint8_t nodes[AXIS_COUNT])
{
    unsigned count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i]))
            nodes[count++] = machine->axis[i].drive_node;
    }
    return count;
}

static void open_can(const struct machine *machine)
{
    uint8_t nodes[AXIS_COUNT];
    const struct can_config config = {.clock_hz = board.clock.can_hz,
                                      .rates = {machine->can_bitrate, machine->can_data_bitrate},
                                      .nodes = list_nodes(machine, nodes),
                                      .node = nodes};

    board.has_can = config.nodes > 0;
    if (!board.has_can)
        return;
    board.found.needs_can = true;
    board.found.clock = board.clock.source;
    board.found.can_impossible = takt_can_hardware_find_impossible(config.clock_hz, &config.rates);
    takt_gpio_set_function(board_can_rx, BOARD_CAN_FUNCTION);
    takt_gpio_set_function(board_can_tx, BOARD_CAN_FUNCTION);
    (void)takt_can_controller_open(&board.can, &config);
    board.found.can = takt_can_controller_get_state(&board.can);
    enable(BOARD_CAN_SENT, BOARD_PRIORITY_CAN);
    enable(BOARD_CAN_RECEIVED, BOARD_PRIORITY_CAN);
}

static void open_steps(const struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_stepped(&machine->axis[i]))
            board.found.needs_steps = true;
    }
    board.has_steps =
        board.found.needs_steps && takt_step_output_open(&board.steps, BOARD_STEP_PORT,
                                                         board.clock.timer2_hz, machine->cycle_us);
    board.found.has_steps = board.has_steps;
}

/* Settings are loaded while the drives are off: see flash.h. */
static bool drives_are_off(void *context)
{
    (void)context;
    return board.embedded.refused ||
           takt_service_get_state(&board.embedded.service) == PANEL_EMERGENCY;
}

/*
 * Where a plan would wait for its start: new settings count from the next one on, and no plan lasts
 * until then.
 */
static struct correction_tables *borrow_tables(void *context)
{
    _Static_assert(sizeof(struct correction_tables) <= PLAN_QUEUE_MAX, "there is room for them");
    (void)context;
    return takt_plan_queue_lend(&board_core.plan);
}

static void open_embedded(const struct machine *machine)
{
    const struct settings_upload_port settings = {
        .may_load = drives_are_off, .borrow = borrow_tables, .log = write_log};
    const struct embedded_config config = {
        .machine = machine,
        .core = &board_core,
        .can.port[0] =
            board.has_can ? takt_can_controller_get_port(&board.can) : takt_no_can_get_port(),
        .step = takt_step_output_get_port(&board.steps),
        .tools = board.tools,
        .tools_count = TOOLS_MAX,
        .correction = &board.tables,
        .dcf = board.dcf,
        .port = {.lock = cortex_lock,
                 .unlock = cortex_unlock,
                 .now_us = now_us,
                 .now_ns = now_ns,
                 .reply = reply,
                 .log = write_log},
        .settings = takt_settings_upload_open(&board.upload, &board.store, &settings),
        .unit = BOARD_PANEL_UNIT,
        .gap_us = BOARD_PANEL_GAP_US,
        .name = "takt " TAKT_VERSION " on " PERIPHERALS_CHIP,
    };

    for (uint32_t i = 0; i < TOOLS_MAX; i++)
        board.tools[i].number = i + 1;
    takt_embedded_init(&board.embedded, &config);
}

/* All problems are logged; the first is the alarm. */
static void verifier(void)
{
    struct diagnostic problem;
    unsigned at = 0;

    while (takt_findings_next(&board.found, &at, &problem)) {
        char text[DIAGNOSTIC_TEXT_MAX];

        (void)takt_diagnostic_text(&problem, text);
        write_log(NULL, text);
        takt_embedded_refuse(&board.embedded, &problem);
    }
}

static uint32_t timer_hz(void)
{
    return BOARD_TIMER_HZ != 0 ? BOARD_TIMER_HZ : board.clock.timer1_hz;
}

static void start(void)
{
    struct machine machine; /* the controller has a copy */

    look_back();
    takt_clock_start(&board.clock, BOARD_CRYSTAL_HZ);
    takt_timers_start_clock(timer_hz());
    (void)takt_watchdog_start(FLASH_WATCHDOG_MS);
    (void)takt_image_is_sound(&board.found.image);
    open_pins();
    open_log();
    open_settings(&machine);
    open_can(&machine);
    open_steps(&machine);
    open_embedded(&machine);
    verifier();
    open_panel();
    (void)takt_watchdog_start(BOARD_WATCHDOG_MS);
    cortex_set_priority(BOARD_CYCLE, BOARD_PRIORITY_CYCLE);
    takt_timers_start_cycle(timer_hz(), machine.cycle_us);
    cortex_enable_interrupt(BOARD_CYCLE);
}

/* ---- the background ---- */

/* The button holds the emergency stop in; letting it go releases it, and RESET leads on. */
static void follow_button(void)
{
    const bool pressed = takt_gpio_read(board_emergency);
    const struct panel_order order = {.count = 1,
                                      .item = {{REGISTER_EMERGENCY_STOP, pressed ? 1 : 0}}};

    if (pressed == board.pressed || board.embedded.refused)
        return;
    cortex_lock(NULL);
    (void)takt_service_order(&board.embedded.service, &order);
    cortex_unlock(NULL);
    board.pressed = pressed;
}

/* Only while both the control cycle and the background are alive. */
static void feed_watchdog(void)
{
    if (board.ticks == board.fed)
        return;
    board.fed = board.ticks;
    takt_watchdog_feed();
}

int main(void)
{
    start();
    for (;;) {
        follow_button();
        takt_embedded_background(&board.embedded);
        takt_usart_poll(&board.panel, takt_timers_now_us());
        send_log();
        takt_usart_poll(&board.log, takt_timers_now_us());
        feed_watchdog();
    }
}
