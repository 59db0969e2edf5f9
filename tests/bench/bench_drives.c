/*
 * What a cycle of three drives costs: the whole loop, and its parts each by itself. Prints
 * nanoseconds per cycle, the best of several rounds. Not a test: a figure depends on the machine.
 */
#include "bus/bus.h"
#include "bus/candump.h"
#include "canopen/little_endian.h"
#include "drive/drives.h"
#include "drives/virtual_drives.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define DRIVES   3
#define ROUNDS   7
#define CYCLE_NS 1000000u
#define AHEAD    4096         /* setpoints are prepared: they are not what is measured */
#define CYCLES   (49 * AHEAD) /* whole circles, so that rounds join */

static struct bus bus;
static struct virtual_drives set;
static struct drives master;
static struct can_port port;
static struct candump dump;
static struct point setpoint[AHEAD];
static volatile unsigned sink;

static double now_ns(void)
{
    struct timespec time;
    (void)timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

/* A circle of 10 mm in 4.096 s, ending where it begins. */
static void prepare_setpoints(void)
{
    for (unsigned k = 0; k < AHEAD; k++) {
        double angle = 6.283185307179586 * k / AHEAD;
        setpoint[k].at[AXIS_X] = 10 * (cos(angle) - 1);
        setpoint[k].at[AXIS_Y] = 10 * sin(angle);
        setpoint[k].at[AXIS_Z] = 5 * sin(angle);
    }
}

/* heartbeat_ms: 0 for drives that have none. */
static void init_master(uint16_t heartbeat_ms)
{
    struct drives_config config = {
        .count = DRIVES,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .heartbeat_ms = heartbeat_ms,
        .boot_timeout_cycles = 500,
        .start_timeout_cycles = 1000,
        .answer_timeout_cycles = 3,
        .sdo_timeout_cycles = 100,
        .brake_timeout_cycles = 1000,
    };
    for (unsigned i = 0; i < DRIVES; i++)
        config.axis[i] = (struct drives_config_axis){.axis = (enum axis)(AXIS_X + (int)i),
                                                     .node = (uint8_t)(i + 1),
                                                     .increments_per_mm = 1e5,
                                                     .following_error_max_mm = 1.0};
    takt_drives_init(&master, &config);
}

static void loop_cycle(const struct point *point)
{
    takt_drives_receive(&master, &port);
    takt_drives_sync(&master, &port);
    takt_drives_send(&master, &port, point);
    bus_run_until(&bus, bus_now_ns(&bus) + CYCLE_NS);
    virtual_drives_step(&set, CYCLE_NS);
}

static void init_loop(uint16_t heartbeat_ms)
{
    struct virtual_drives_config config;
    virtual_drives_set_default(&config, DRIVES);
    (void)bus_init(&bus, 1000000);
    port = bus_attach(&bus, NULL);
    virtual_drives_init(&set, &bus, &config);
    init_master(heartbeat_ms);
    while (drives_get_state(&master) == DRIVES_STARTING)
        loop_cycle(&setpoint[0]);
}

static void run_loop(void)
{
    for (unsigned k = 0; k < CYCLES; k++)
        loop_cycle(&setpoint[k % AHEAD]);
}

/* Without a controller: neither SYNC (object 1006) nor its heartbeat (1016) is missed. */
static void keep_enabled(void)
{
    for (unsigned i = 0; i < DRIVES; i++) {
        (void)virtual_drive_write_object(&set.drive[i], PDO_MAPPED(0x1006, 0, 32), 0);
        (void)virtual_drive_write_object(&set.drive[i], PDO_MAPPED(0x1016, 1, 32), 0);
    }
}

static void run_steps(void)
{
    keep_enabled();
    for (unsigned k = 0; k < CYCLES; k++) {
        for (unsigned i = 0; i < DRIVES; i++)
            set.drive[i].servo.objects.process.target_position =
                (int32_t)(1e5 * setpoint[k % AHEAD].at[i]);
        virtual_drives_step(&set, CYCLE_NS);
    }
}

static void run_frame_bits(void)
{
    struct can_frame frame = {.id = 0x301, .length = 8};
    for (unsigned k = 0; k < CYCLES; k++) {
        frame.data[k & 7] = (uint8_t)k;
        sink += frame_bits_count(&bus.tables, &frame);
    }
}

/*
 * A port without a bus: takes everything, and answers each cycle with three TPDO1 of drives that
 * are exactly there.
 */
static unsigned answers;

static bool null_send(void *context, const struct can_frame *frame)
{
    (void)context;
    sink += frame->id;
    return true;
}

static bool null_receive(void *context, struct can_frame *frame)
{
    const struct point *reached = context;
    if (answers == DRIVES) {
        answers = 0;
        return false;
    }
    frame->id = (uint16_t)(0x181 + answers);
    frame->length = 6;
    little_endian_write16(frame->data, 0x1237);
    little_endian_write32(frame->data + 2, (uint32_t)(int32_t)(1e5 * reached->at[answers++]));
    return true;
}

/* Started with the virtual drives, then left alone with the port. */
static void run_master(void)
{
    struct can_port null = {.send = null_send, .receive = null_receive};
    init_loop(0);
    answers = 0;
    for (unsigned k = 0; k < CYCLES; k++) {
        null.context = &setpoint[(k + AHEAD - DRIVES_LATENCY_CYCLES) % AHEAD];
        takt_drives_receive(&master, &null);
        takt_drives_sync(&master, &null);
        takt_drives_send(&master, &null, &setpoint[k % AHEAD]);
    }
}

static double best_ns(void (*run)(void))
{
    double best = 1e300;
    for (unsigned round = 0; round < ROUNDS; round++) {
        double start = now_ns();
        run();
        best = fmin(best, (now_ns() - start) / CYCLES);
    }
    return best;
}

int main(void)
{
    prepare_setpoints();
    init_loop(100);
    FILE *log = tmpfile();
    double loop = best_ns(run_loop);
    if (log) {
        candump_init(&dump, log, "can0");
        bus_observe(&bus, &(struct bus_listener){candump_frame, &dump});
        printf("loop with bus log   %7.1f ns/cycle\n", best_ns(run_loop));
        (void)candump_flush(&dump);
        (void)fclose(log);
        bus_observe(&bus, NULL);
    }
    printf("loop, %d drives      %7.1f ns/cycle = %.0f x real time at 1 kHz\n", DRIVES, loop,
           CYCLE_NS / loop);
    printf("  bus load %.2f %%, state %d\n", bus_load_percent(&bus),
           (int)drives_get_state(&master));
    printf("drives alone        %7.1f ns/drive\n", best_ns(run_steps) / DRIVES);
    printf("length of a frame   %7.1f ns/frame\n", best_ns(run_frame_bits));
    double alone = best_ns(run_master);
    printf("master alone        %7.1f ns/cycle, state %d\n", alone, (int)drives_get_state(&master));
    return drives_get_state(&master) == DRIVES_ENABLED ? 0 : 1;
}
