/*
 * The image of a drive on an STM32: one axis, a node on CAN (drive_node.h).
 *
 * Nothing turns unless everything is as it must be: image, crystal, CAN controller, and no crash
 * before.
 */
#include "base/maths.h"
#include "chip/board.h"
#include "chip/peripherals.h"
#include "port/cortex_m.h"
#include "port/image.h"
#include "port/startup.h"
#include "stm32/chip.h"
#include "stm32/clock.h"
#include "stm32/exceptions.h"
#include "stm32/timers.h"
#include "stm32/watchdog.h"
#include "stm32drive/drive_board.h"
#include "stm32drive/drive_node.h"

static struct drive_node node;

static void on_can_sent(void)
{
    takt_can_controller_interrupt_sent(&node.can);
}

static void on_can_received(void)
{
    takt_can_controller_interrupt_received(&node.can);
}

STARTUP_INTERRUPTS(drive_interrupts, BOARD_INTERRUPTS) = {
    [BOARD_CAN_SENT] = on_can_sent, [BOARD_CAN_RECEIVED] = on_can_received};

static void enable(enum board_interrupt interrupt)
{
    cortex_set_priority(interrupt, BOARD_PRIORITY_CAN);
    cortex_enable_interrupt(interrupt);
}

/* The last run has ended by itself. */
static bool has_crashed(void)
{
    struct crash_record crash;
    const bool was_bitten = (takt_chip_read(RCC_RESETS) & RCC_RESETS_WATCHDOG) != 0;

    chip_change(RCC_RESETS, 0, RCC_RESETS_FORGET);
    return takt_exceptions_take_crash(&crash) || was_bitten;
}

static void set_pins(void)
{
    takt_gpio_set_function(drive_up, DRIVE_PWM_FUNCTION);
    takt_gpio_set_function(drive_down, DRIVE_PWM_FUNCTION);
    takt_gpio_set_function(drive_fails, DRIVE_PWM_FUNCTION);
    takt_gpio_set_function(drive_track_a, DRIVE_ENCODER_FUNCTION);
    takt_gpio_set_function(drive_track_b, DRIVE_ENCODER_FUNCTION);
    takt_gpio_set_function(drive_index, DRIVE_ENCODER_FUNCTION);
    takt_gpio_set_function(drive_home, DRIVE_ENCODER_FUNCTION);
    takt_gpio_set_input(drive_limit_low, true);
    takt_gpio_set_input(drive_limit_high, true);
    takt_gpio_set_function(board_can_rx, BOARD_CAN_FUNCTION);
    takt_gpio_set_function(board_can_tx, BOARD_CAN_FUNCTION);
}

/* With the whole torque M an axis of lead h per radian is accelerated by h M / J. */
static struct drive_node_config make_config(const struct clock *clock)
{
    const struct servo_loop_config *loop = &drive_config.loop;
    const double turn_mm = loop->travel_per_revolution_mm;

    return (struct drive_node_config){
        .servo = drive_config,
        .motor = {.timer_hz = clock->timer2_hz,
                  .pulses_hz = DRIVE_PULSES_HZ,
                  .whole_mm_s2 = turn_mm / MATHS_TWO_PI * loop->torque_max_nm / loop->inertia_kg_m2,
                  .encoder_step_mm = turn_mm / loop->encoder_counts_per_revolution,
                  .switches = {drive_limit_low, drive_limit_high, drive_home}},
        .can = {.clock_hz = clock->can_hz, .rates = {.nominal = DRIVE_BITRATE}},
        .enable = drive_enable,
        .mapped = (const uint8_t *)(uintptr_t)FLASH_SECTOR_ADDRESS,
        .has_crashed = has_crashed(),
    };
}

/* False: there is no drive. */
static bool start(void)
{
    struct diagnostic damage;
    struct clock clock;

    takt_clock_start(&clock, BOARD_CRYSTAL_HZ);
    (void)takt_watchdog_start(FLASH_WATCHDOG_MS);
    set_pins();
    const struct drive_node_config config = make_config(&clock);
    if (!takt_image_is_sound(&damage) || clock.source != CLOCK_CRYSTAL ||
        !takt_drive_node_open(&node, &config))
        return false;
    enable(BOARD_CAN_SENT);
    enable(BOARD_CAN_RECEIVED);
    (void)takt_watchdog_start(BOARD_WATCHDOG_MS);
    takt_timers_start_cycle(clock.timer1_hz, drive_config.loop.loop_period_us);
    return true;
}

/* Not fed, the watchdog lets it try again. */
static _Noreturn void stay(void)
{
    for (;;) {
    }
}

int main(void)
{
    if (!start())
        stay();
    for (;;)
        takt_drive_node_cycle(&node);
}
