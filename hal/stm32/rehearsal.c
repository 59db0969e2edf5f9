/*
 * The firmware's motion with nothing that moves: a program that is part of the image, step drives
 * that are only counted, and no interrupts. What it says on the log can be compared with `takt run
 * --drive-type step` of the same program: the setpoints' digest must be the same. It needs no
 * crystal, no CAN and no settings, so it also runs in an emulator.
 *
 *     | G21 G90 ...                   the program, line by line
 *     completed, setpoints 0123456789abcdef, 2345 cycles
 *     steps X 6000 Y -250 Z 0
 */
#include "base/fnv.h"
#include "chip/board.h"
#include "chip/peripherals.h"
#include "chip/usart_registers.h"
#include "controller/controller.h"
#include "port/cortex_m.h"
#include "port/image.h"
#include "port/startup.h"
#include "stm32/chip.h"
#include "stm32/clock.h"
#include "stm32/exceptions.h"
#include "stm32/no_can.h"
#include "stm32/usart.h"

#include <string.h>

static const char program[] = "G21 G90 G61 F3000\n"
                              "G1 X6 Y4\n"
                              "G2 X10 Y0 I0 J-4\n"
                              "G3 X2 Y-2 Z-1.5 R9\n"
                              "G0 X0 Y0 Z1\n"
                              "G1 X-3.21 Y1.07 F1200\n"
                              "M2\n";

#define LINE_MAX 80U

STARTUP_CORE_MEMORY static struct beside {
    struct controller_reader reader;
    struct parameters parameters;
} beside;

static struct rehearsal {
    struct controller controller;
    struct machine machine;
    struct clock clock;
    struct usart log;
    struct source_text text;
    uint64_t digest;
    uint32_t cycles;
    int32_t steps[AXIS_COUNT];
} rehearsal;

/* ---- the log ---- */

struct line {
    char text[LINE_MAX];
    size_t length;
};

static void add_text(struct line *line, const char *text)
{
    while (*text != '\0' && line->length + 3 < LINE_MAX)
        line->text[line->length++] = *text++;
}

static void add_number(struct line *line, uint64_t number, unsigned base, unsigned width)
{
    char digits[24] = "";
    size_t at = sizeof digits - 1;

    do {
        digits[--at] = "0123456789abcdef"[number % base];
        number /= base;
    } while (number > 0 || sizeof digits - 1 - at < width);
    add_text(line, digits + at);
}

static void end_line(struct line *line)
{
    memcpy(line->text + line->length, "\r\n", 3);
    takt_usart_shout(&rehearsal.log, line->text);
    line->length = 0;
}

static void say(const char *text)
{
    struct line line = {.length = 0};

    add_text(&line, text);
    end_line(&line);
}

static void ignore(void *context, uint8_t byte, uint32_t now_us)
{
    (void)context;
    (void)byte;
    (void)now_us;
}

static void open_log(void)
{
    const struct usart_config config = {.base = USART_USART1,
                                        .clock_hz = rehearsal.clock.bus2_hz,
                                        .bauds = BOARD_LOG_BAUDS,
                                        .take = ignore};

    chip_change(RCC_APB2ENR, 0, RCC_APB2ENR_USART1);
    takt_gpio_set_function(board_log_tx, BOARD_USART_FUNCTION);
    (void)takt_usart_open(&rehearsal.log, &config);
}

static void say_program(void)
{
    struct line line = {.length = 0};

    for (const char *c = program; *c != '\0'; c++) {
        const char one[] = {*c, '\0'};

        if (line.length == 0)
            add_text(&line, "| ");
        if (*c == '\n')
            end_line(&line);
        else
            add_text(&line, one);
    }
}

/* ---- the run ---- */

static bool count_pulse(void *context, const struct step_pulse *pulse)
{
    (void)context;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((pulse->axes >> i & 1U) != 0)
            rehearsal.steps[i] += (pulse->direction >> i & 1U) != 0 ? -1 : 1;
    }
    return true;
}

static void open_controller(void)
{
    struct controller_config config = {
        .machine = &rehearsal.machine,
        .can.port[0] = takt_no_can_get_port(),
        .step = {.pulse = count_pulse},
        .reader = &beside.reader,
        .parameters = &beside.parameters,
    };

    takt_machine_set_default(&rehearsal.machine);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        rehearsal.machine.axis[i].drive_type = MACHINE_DRIVE_STEP;
    takt_parameters_clear(&beside.parameters);
    takt_source_open_text(&config.source, &rehearsal.text, program, sizeof program - 1);
    takt_controller_init(&rehearsal.controller, &config);
}

static void take_record(const struct cycle_record *record)
{
    if (record == NULL)
        return;
    rehearsal.cycles++;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        rehearsal.digest = takt_fnv_add_double(rehearsal.digest, record->set.at[i]);
}

static void run(void)
{
    const struct inputs inputs = inputs_idle();

    rehearsal.digest = FNV_START;
    while (takt_controller_get_state(&rehearsal.controller) < CONTROLLER_COMPLETED) {
        takt_controller_background(&rehearsal.controller);
        takt_controller_cycle(&rehearsal.controller, &inputs);
        take_record(takt_controller_get_record(&rehearsal.controller));
    }
}

static void say_outcome(void)
{
    struct line line = {.length = 0};

    if (takt_controller_get_state(&rehearsal.controller) != CONTROLLER_COMPLETED) {
        char text[DIAGNOSTIC_TEXT_MAX];

        (void)takt_diagnostic_text(takt_controller_get_fault(&rehearsal.controller), text);
        say(text);
        return;
    }
    add_text(&line, "completed, setpoints ");
    add_number(&line, rehearsal.digest, 16, 16);
    add_text(&line, ", ");
    add_number(&line, rehearsal.cycles, 10, 1);
    add_text(&line, " cycles");
    end_line(&line);
}

static void say_steps(void)
{
    struct line line = {.length = 0};

    add_text(&line, "steps");
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const char axis[] = {' ', AXIS_LETTERS[i], ' ', '\0'};
        const int32_t steps = rehearsal.steps[i];

        add_text(&line, axis);
        add_text(&line, steps < 0 ? "-" : "");
        add_number(&line, (uint64_t)(steps < 0 ? -(int64_t)steps : steps), 10, 1);
    }
    end_line(&line);
}

/* After a crash the chip starts anew: told once, and then it stays here. */
static void say_crash(const struct crash_record *crash)
{
    struct line line = {.length = 0};

    add_text(&line, "crashed: ");
    add_text(&line, takt_crash_name(crash->cause));
    add_text(&line, " at ");
    add_number(&line, crash->address, 16, 8);
    add_text(&line, ", status ");
    add_number(&line, crash->status, 16, 8);
    end_line(&line);
}

static _Noreturn void stay(void)
{
    for (;;)
        __asm volatile("wfi");
}

int main(void)
{
    static const char *const clocks[] = {"crystal", "internal oscillator and PLL",
                                         "internal oscillator"};
    struct diagnostic damage;
    struct crash_record crash;

    takt_clock_start(&rehearsal.clock, BOARD_CRYSTAL_HZ);
    open_log();
    say("takt rehearsal on " PERIPHERALS_CHIP);
    say(clocks[rehearsal.clock.source]);
    say(takt_image_is_sound(&damage) ? "the image is sound" : "the image is damaged");
    if (takt_exceptions_take_crash(&crash)) {
        say_crash(&crash);
        stay();
    }
    say_program();
    open_controller();
    run();
    say_outcome();
    say_steps();
    stay();
}
