/*
 * takt in a program of your own, with your own hardware behind it: here three step motors that only
 * count. It runs a part program and says where the motors have come to stand.
 *
 *     text -> controller -> pulses of each cycle -> count_pulse
 */
#include "controller/controller.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS_PER_MM 400
#define CYCLES_MAX   1000000

static const char part[] = "G21 G90 G64 P0.01 F1200\n"
                           "G1 X10 Y5\n"
                           "G2 X20 Y5 I5 J0\n"
                           "G1 Z-2\n"
                           "G0 X0 Y0 Z0\n"
                           "G1 X12.5 Y-3\n"
                           "M2\n";

/* The hardware: what hal/step.h asks for. */
struct motors {
    long steps[AXIS_COUNT];
    unsigned long pulses;
};

static bool count_pulse(void *context, const struct step_pulse *pulse)
{
    struct motors *motors = context;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((pulse->axes >> i & 1U) != 0)
            motors->steps[i] += (pulse->direction >> i & 1U) != 0 ? -1 : 1;
    }
    motors->pulses++;
    return true;
}

/* No drive of this machine is on a bus. */
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

static void make_machine(struct machine *machine)
{
    takt_machine_set_default(machine);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        machine->axis[i].drive_type = MACHINE_DRIVE_STEP;
        machine->axis[i].steps_per_mm = STEPS_PER_MM;
        machine->axis[i].step_rate_max_hz = 100000;
    }
}

/* All memory is yours: any number of controllers fit into a process. */
struct desk {
    struct controller controller;
    struct controller_reader reader;
    struct parameters parameters;
    struct machine machine;
    struct source_text text;
    struct motors motors;
};

static void open_desk(struct desk *desk)
{
    struct controller_config config = {
        .machine = &desk->machine,
        .reader = &desk->reader,
        .can = {.port = {{bus_send, bus_receive, NULL}}},
        .step = {.pulse = count_pulse, .context = &desk->motors},
        .parameters = &desk->parameters,
    };

    make_machine(&desk->machine);
    takt_parameters_clear(&desk->parameters);
    takt_source_open_text(&config.source, &desk->text, part, strlen(part));
    takt_controller_init(&desk->controller, &config);
}

static enum controller_state run(struct controller *controller)
{
    const struct inputs inputs = inputs_idle();

    for (unsigned long i = 0; i < CYCLES_MAX; i++) {
        if (takt_controller_get_state(controller) >= CONTROLLER_COMPLETED)
            break;
        takt_controller_background(controller);     /* reads and plans ahead */
        takt_controller_cycle(controller, &inputs); /* pulses of one cycle */
    }
    return takt_controller_get_state(controller);
}

/* Where the part ends. */
static bool stands_right(const struct motors *motors)
{
    printf("%lu pulses; the motors stand at X %ld Y %ld Z %ld steps\n", motors->pulses,
           motors->steps[AXIS_X], motors->steps[AXIS_Y], motors->steps[AXIS_Z]);
    return motors->steps[AXIS_X] == 5000 && motors->steps[AXIS_Y] == -1200 &&
           motors->steps[AXIS_Z] == 0;
}

int main(void)
{
    struct desk *desk = calloc(1, sizeof *desk);
    char fault[DIAGNOSTIC_TEXT_MAX];
    bool good = false;

    if (desk == NULL)
        return 1;
    open_desk(desk);
    if (run(&desk->controller) == CONTROLLER_COMPLETED) {
        good = stands_right(&desk->motors);
    } else {
        (void)takt_diagnostic_text(takt_controller_get_fault(&desk->controller), fault);
        puts(fault);
    }
    free(desk);
    return good ? 0 : 1;
}
