/*
 * Scripted faults of a drive: each does what its word says, from its time to its end.
 */
#include "lone_drive.h"

#include "canopen/emcy.h"
#include "drives/drive_event.h"

#include <math.h>
#include <stdio.h>

static struct lone_drive lone;
static struct inject script;
static struct inject_clock script_clock;

static void start_with(const char *text)
{
    struct inject_error error;
    lone_set_default(&lone);
    lone_start(&lone);
    TEST_ASSERT_TRUE_MESSAGE(inject_read(&script, text, strlen(text), &error), error.text);
    script_clock = (struct inject_clock){.enabled_ns = INJECT_ALWAYS};
    virtual_drive_inject(&lone.drive, &script, &script_clock);
}

void setUp(void)
{
    start_with("");
}

void tearDown(void)
{
}

/* What is sent adds up. */
static void run(unsigned cycles)
{
    lone.sent_count = 0;
    for (unsigned i = 0; i < cycles; i++) {
        virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
        script_clock.now_ns += LONE_CYCLE_NS;
    }
}

static void assert_emcy(uint16_t code, uint8_t error_register)
{
    struct emcy emcy;
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x085));
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(code, emcy.code);
    TEST_ASSERT_EQUAL_HEX8(error_register, emcy.error_register);
}

static void test_a_fault_begins_at_its_time_and_only_for_its_node(void)
{
    start_with("power+10ms drive 5 emcy code=3210\npower+1ms drive 6 emcy code=4310");
    lone_enable(&lone, 8);
    run(10);
    TEST_ASSERT_NULL(lone_find(&lone, 0x085));
    run(1);
    assert_emcy(0x3210, 0x05);
    run(100);
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, virtual_drive_get_state(&lone.drive));
    TEST_ASSERT_EQUAL_HEX32(0x3210, lone_read(&lone, 0x603F, 0));
}

static void test_an_error_code_has_the_register_bit_of_its_class(void)
{
    static const struct {
        const char *text;
        uint16_t code;
        uint8_t error_register;
    } rows[] = {{"power drive 5 emcy code=2310", 0x2310, 0x03},
                {"power drive 5 emcy code=4310", 0x4310, 0x09},
                {"power drive 5 emcy code=7305", 0x7305, 0x01},
                {"power drive 5 emcy code=8611", 0x8611, 0x21},
                {"power drive 5 emcy code=8130", 0x8130, 0x11},
                {"power drive 5 emcy code=7305 register=81", 0x7305, 0x81}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        start_with(rows[i].text);
        run(1);
        assert_emcy(rows[i].code, rows[i].error_register);
    }
}

static void test_a_warning_lets_the_drive_go_on(void)
{
    start_with("power drive 5 warn code=4210");
    lone_enable(&lone, 8);
    run(5);
    assert_emcy(0x4210, 0x09);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
}

static void test_a_mute_drive_keeps_back_what_is_named_as_long_as_it_lasts(void)
{
    start_with("power drive 5 mute what=heartbeat for=10ms\npower+20ms drive 5 mute");
    (void)lone_write(&lone, 0x1017, 0, 2, 1);
    lone_nmt(&lone, NMT_START);
    run(10);
    TEST_ASSERT_NULL(lone_find(&lone, 0x705));
    lone_sync(&lone);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x185));
    run(5);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x705));
    run(6);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x605, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
}

static void test_kinds_of_frames_are_held_back_one_by_one(void)
{
    start_with("power drive 5 mute what=tpdo\npower drive 5 mute what=emcy");
    lone_nmt(&lone, NMT_START);
    run(1);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x305, 1, 0, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0x8210, lone_read(&lone, 0x1003, 1));
    start_with("power drive 5 mute what=sdo");
    lone_nmt(&lone, NMT_START);
    run(1);
    lone_take(&lone, 0x605, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(1, lone.sent_count);
}

static void test_a_hung_node_is_deaf_too_and_stops_for_want_of_sync(void)
{
    start_with("power+5ms drive 5 hang");
    (void)lone_write(&lone, 0x1006, 0, 4, 1000);
    lone_enable(&lone, 8);
    for (unsigned i = 0; i < 20; i++) {
        lone_sync(&lone);
        run(1);
    }
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&lone.drive));
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&lone.drive));
}

static void test_a_reboot_is_that_of_a_node(void)
{
    start_with("power+3ms drive 5 reboot");
    lone_enable(&lone, 8);
    run(3);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    run(1);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x705));
    TEST_ASSERT_EQUAL_HEX8(0, lone_find(&lone, 0x705)->data[0]);
    TEST_ASSERT_EQUAL_INT(NMT_PREOPERATIONAL, virtual_drive_get_nmt_state(&lone.drive));
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&lone.drive));
}

static uint16_t status_in_tpdo(void)
{
    lone_sync(&lone);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x185));
    return little_endian_read16(lone_find(&lone, 0x185)->data);
}

static void test_a_frozen_statusword_shows_what_was(void)
{
    start_with("power+2ms drive 5 freeze object=6041 for=10ms");
    lone_enable(&lone, 8);
    run(3);
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    TEST_ASSERT_EQUAL_HEX16(0x1237, status_in_tpdo());
    TEST_ASSERT_EQUAL_HEX16(0x1237, lone_statusword(&lone));
    TEST_ASSERT_EQUAL_INT(CIA402_READY, virtual_drive_get_state(&lone.drive));
    run(10);
    TEST_ASSERT_EQUAL_HEX16(0x0231, status_in_tpdo());
}

static void test_an_object_reports_what_it_is_told_to(void)
{
    start_with("power drive 5 report object=1018:02 value=DEADBEEF\n"
               "power drive 5 report object=6041 value=0008");
    lone_nmt(&lone, NMT_START);
    run(1);
    TEST_ASSERT_EQUAL_HEX32(0xDEADBEEF, lone_read(&lone, 0x1018, 2));
    TEST_ASSERT_EQUAL_HEX32(0x10000, lone_read(&lone, 0x1018, 3));
    TEST_ASSERT_EQUAL_HEX16(0x0008, status_in_tpdo());
}

static void test_requests_for_an_object_are_aborted(void)
{
    bool aborted;
    start_with("power+1ms drive 5 sdo_abort object=6098 code=08000022 for=5ms");
    run(1);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6098, 0, 1, 37));
    run(1);
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_write(&lone, 0x6098, 0, 1, 37));
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_try_read(&lone, 0x6098, 0, &aborted));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6099, 1, 4, 37));
    run(10);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6098, 0, 1, 37));
}

/* 10 mm/s in cyclic mode. */
static void move(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        uint32_t target_inc = lone_read(&lone, 0x607A, 0) + 10;
        lone_take(&lone, 0x305, 4, target_inc, 0);
        lone_sync(&lone);
        run(1);
    }
}

static void test_a_jammed_axis_stands_until_the_following_error_trips(void)
{
    start_with("power+100ms drive 5 jam");
    lone_enable(&lone, 8);
    move(101);
    double stuck_mm = virtual_drive_get_position_mm(&lone.drive);
    move(100);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    TEST_ASSERT_TRUE(virtual_drive_get_position_mm(&lone.drive) == stuck_mm);
    move(110);
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, virtual_drive_get_state(&lone.drive));
    TEST_ASSERT_EQUAL_HEX32(0x8611, lone_read(&lone, 0x603F, 0));
    TEST_ASSERT_TRUE(virtual_drive_get_position_mm(&lone.drive) == stuck_mm);
}

static void test_a_weak_motor_cannot_accelerate(void)
{
    start_with("power drive 5 weak ratio=0.001");
    lone_enable(&lone, 8);
    move(200);
    /*
     * h M / J = (0.01 / 2 pi) 3.8 / 3e-4 = 20 m/s2; a thousandth of it, half t^2 = 0.02 s2: 0.4 mm
     */
    double moved_mm = virtual_drive_get_position_mm(&lone.drive);
    TEST_ASSERT_TRUE(moved_mm > 0.2 && moved_mm < 0.45);
    TEST_ASSERT_TRUE(lone_statusword(&lone) & 0x0800);
}

static void test_an_encoder_that_jumps_shows_another_position_at_once(void)
{
    start_with("power+10ms drive 5 encoder_jump by_mm=0.5");
    lone_enable(&lone, 8);
    run(10);
    TEST_ASSERT_INT_WITHIN(1, 0, lone_actual(&lone));
    run(1);
    TEST_ASSERT_TRUE(lone_actual(&lone) > 400);
    run(2000);
    TEST_ASSERT_INT_WITHIN(1, 0, lone_actual(&lone));
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&lone.drive) + 0.5) < 0.001);
}

/* Constant torque against a jam: the temperature rises to 25 + 60 * 3^2 and trips on its way. */
static void test_a_motor_that_is_overloaded_gets_too_hot(void)
{
    setUp();
    lone.config.plant.temperature_time_s = 1;
    lone.config.plant.following_error_window_mm = 0;
    lone_start(&lone);
    lone_enable(&lone, 8);
    lone.drive.plant.damage.is_jammed = true;
    lone_take(&lone, 0x305, 4, 500, 0);
    lone_sync(&lone);
    unsigned ms = 0;
    bool warned = false;
    while (virtual_drive_get_state(&lone.drive) == CIA402_ENABLED && ms < 5000) {
        lone_step(&lone, 1);
        warned = warned || lone_statusword(&lone) & 0x0080;
        ms++;
    }
    /* T = 25 + 60 (3.8 / 1.27)^2 (1 - exp(-t)) = 120: t = 0.194 s */
    TEST_ASSERT_UINT_WITHIN(3, 194, ms);
    TEST_ASSERT_TRUE(warned);
    TEST_ASSERT_EQUAL_HEX32(0x4310, lone_read(&lone, 0x603F, 0));
}

/* ---- Log ---- */

static struct drive_event events[16];
static unsigned event_count;

static void on_event(void *context, const struct drive_event *event)
{
    (void)context;
    if (event_count < 16)
        events[event_count++] = *event;
}

static void assert_line(unsigned i, const char *expected)
{
    char line[128] = "";
    FILE *file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    drive_event_write(file, &events[i]);
    rewind(file);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, file));
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
    TEST_ASSERT_EQUAL_STRING(expected, line);
}

static void test_every_event_is_a_line_of_the_log(void)
{
    start_with("power+1ms drive 5 jam for=1ms");
    event_count = 0;
    virtual_drive_observe(&lone.drive, &(struct drive_observer){on_event, NULL});
    virtual_drive_boot(&lone.drive);
    run(3);
    lone_enable(&lone, 8);
    TEST_ASSERT_EQUAL_UINT(8, event_count);
    assert_line(0, "0.000000 node 5: boot-up\n");
    assert_line(1, "0.001000 node 5: scripted fault jam of line 1\n");
    assert_line(2, "0.002000 node 5: end of scripted fault jam of line 1\n");
    assert_line(3, "0.003000 node 5: NMT operational\n");
    assert_line(4, "0.003000 node 5: mode cyclic synchronous position\n");
    assert_line(5, "0.003000 node 5: switch on disabled -> ready to switch on\n");
    assert_line(7, "0.003000 node 5: switched on -> operation enabled\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_fault_begins_at_its_time_and_only_for_its_node);
    RUN_TEST(test_an_error_code_has_the_register_bit_of_its_class);
    RUN_TEST(test_a_warning_lets_the_drive_go_on);
    RUN_TEST(test_a_mute_drive_keeps_back_what_is_named_as_long_as_it_lasts);
    RUN_TEST(test_kinds_of_frames_are_held_back_one_by_one);
    RUN_TEST(test_a_hung_node_is_deaf_too_and_stops_for_want_of_sync);
    RUN_TEST(test_a_reboot_is_that_of_a_node);
    RUN_TEST(test_a_frozen_statusword_shows_what_was);
    RUN_TEST(test_an_object_reports_what_it_is_told_to);
    RUN_TEST(test_requests_for_an_object_are_aborted);
    RUN_TEST(test_a_jammed_axis_stands_until_the_following_error_trips);
    RUN_TEST(test_a_weak_motor_cannot_accelerate);
    RUN_TEST(test_an_encoder_that_jumps_shows_another_position_at_once);
    RUN_TEST(test_a_motor_that_is_overloaded_gets_too_hot);
    RUN_TEST(test_every_event_is_a_line_of_the_log);
    return UNITY_END();
}
