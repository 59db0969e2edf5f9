/*
 * I/O nodes beside the drives: what they are told, what their bits are, what they stop.
 */
#include "starting_master.h"

#include "canopen/emcy.h"
#include "canopen/objects.h"

#define IO_NODE 20

static struct io_wiring wiring;
static uint8_t levels;        /* its inputs, sent after every SYNC while it is started */
static unsigned frames_of_io; /* with outputs */
static uint8_t shown_outputs;
static struct outputs outputs;
static struct can_frame analogues; /* the last one with analogue outputs */
static unsigned frames_of_analogues;

static bool io_send(void *context, const struct can_frame *frame)
{
    if (frame->id == PDO_RPDO2_FUNCTION + IO_NODE) {
        frames_of_analogues++;
        analogues = *frame;
        return true;
    }
    if (frame->id == PDO_RPDO1_FUNCTION + IO_NODE) {
        frames_of_io++;
        shown_outputs = frame->data[0];
        TEST_ASSERT_EQUAL_UINT8(1, frame->length);
        return true;
    }
    return port.send(context, frame);
}

static const struct can_port io_port = {.send = io_send, .receive = port_receive};

static void put_inputs(void)
{
    if (nodes.starts[IO_NODE] == 0)
        return;
    *fake_nodes_add(&nodes) =
        (struct can_frame){.id = PDO_TPDO1_FUNCTION + IO_NODE, .length = 1, .data = {levels}};
    if (cycles_run % 100 == 0)
        takt_nmt_write_heartbeat(fake_nodes_add(&nodes), IO_NODE, NMT_OPERATIONAL);
}

static void run(unsigned cycles)
{
    static const struct point nowhere;
    for (unsigned k = 0; k < cycles; k++) {
        put_statuses();
        put_inputs();
        takt_drives_receive(&drives, &io_port);
        takt_drives_sync(&drives, &io_port);
        takt_drives_send(&drives, &io_port, &nowhere);
        takt_drives_send_outputs(&drives, &io_port, &outputs);
        cycles_run++;
    }
}

/* Enabled, with this wiring. */
static void enable(const struct io_wiring *wired)
{
    set_rule(
        (struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1000, 0), .value = 0x30191});
    set_rule((struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1600, 0), .value = 1});
    set_rule(
        (struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1600, 1), .value = 0x62000108});
    set_rule((struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1A00, 0), .value = 1});
    set_rule(
        (struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1A00, 1), .value = 0x60000108});
    wiring = *wired;
    wiring.node = IO_NODE;
    config.io_count = 1;
    config.wiring = &wiring;
    frames_of_io = 0;
    outputs = (struct outputs){0};
    takt_drives_init(&drives, &config);
    while (drives_get_state(&drives) == DRIVES_STARTING && cycles_run < 2 * START_CYCLES)
        run(1);
}

static void test_a_node_is_told_of_heartbeats_and_to_send_in_every_sync(void)
{
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_PROGRAM}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    assert_told(IO_NODE, SDO_OBJECT(0x1017, 0), 100);
    assert_told(IO_NODE, SDO_OBJECT(0x1016, 1), 0x7F012C);
    assert_told(IO_NODE, SDO_OBJECT(0x1800, 2), 1);
    TEST_ASSERT_EQUAL_UINT(1, nodes.resets[IO_NODE]);
}

static void test_drives_get_no_torque_before_the_inputs_are_known(void)
{
    levels = 0;
    enable(&(const struct io_wiring){.input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_STOP, takt_drives_get_fault(&drives)->code);
    assert_text("the stop input, bit 0 of I/O node 20, is open");
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_NOT_EQUAL(CIA402_ENABLE_OPERATION, control[node]);
}

static void test_outputs_are_sent_when_they_change_and_every_100_ms(void)
{
    enable(
        &(const struct io_wiring){.output = {IO_FLOOD, IO_MIST, IO_SPINDLE, IO_SPINDLE_CCW,
                                             IO_PROGRAM + 5, IO_FREE, IO_PROGRAM | IO_INVERTED}});
    TEST_ASSERT_EQUAL_HEX8(0x40, shown_outputs);
    run(100);
    frames_of_io = 0;
    run(1000);
    TEST_ASSERT_EQUAL_UINT(10, frames_of_io);
    outputs = (struct outputs){.flood = true, .spindle_speed_rpm = 100, .digital = 0x20};
    run(1);
    TEST_ASSERT_EQUAL_HEX8(0x55, shown_outputs);
    outputs = (struct outputs){.mist = true, .spindle_speed_rpm = -100, .digital = 1};
    run(1);
    TEST_ASSERT_EQUAL_HEX8(0x0E, shown_outputs);
    outputs = (struct outputs){.spindle_orient = true, .digital = 1};
    run(1);
    TEST_ASSERT_EQUAL_HEX8(0x04, shown_outputs);
}

static void test_inputs_are_the_lines_they_are_wired_to_and_others_stay(void)
{
    struct inputs inputs = inputs_idle();
    levels = 0x01;
    enable(&(const struct io_wiring){
        .input = {IO_PROGRAM + 31, IO_FREE, IO_PROGRAM + 2, IO_INVERTED | (IO_PROGRAM + 1)}});
    inputs.digital = 0x0F;
    run(1);
    takt_drives_add_inputs(&drives, &inputs);
    TEST_ASSERT_EQUAL_HEX32(0x8000000B, inputs.digital);
    levels = 0x0C;
    run(1);
    takt_drives_add_inputs(&drives, &inputs);
    TEST_ASSERT_EQUAL_HEX32(0x0000000D, inputs.digital);
}

/* Cycles from the one in which the level has been reported to the drives' being told to stop. */
static void check_stop(uint8_t bit, uint8_t high, uint8_t low, enum takt_error error)
{
    setUp();
    levels = high;
    enable(&(const struct io_wiring){.input = {IO_FREE, bit}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    run(50);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    levels = low;
    run(1);
    TEST_ASSERT_EQUAL_INT(error, takt_drives_get_fault(&drives)->code);
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_EQUAL_HEX16(CIA402_QUICK_STOP_NOW, control[node]);
}

static void test_stop_and_limit_inputs_brake_all_drives_in_the_cycle_that_hears_of_them(void)
{
    check_stop(IO_STOP, 2, 0, TAKT_ERROR_IO_STOP);
    check_stop(IO_STOP | IO_INVERTED, 0, 2, TAKT_ERROR_IO_STOP);
    check_stop(IO_LIMIT, 2, 0, TAKT_ERROR_IO_LIMIT);
}

static void test_an_axis_can_be_driven_off_a_limit_switch(void)
{
    levels = 0;
    enable(&(const struct io_wiring){.input = {IO_LIMIT}});
    run(50);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    levels = 1;
    run(5);
    levels = 0;
    run(1);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_LIMIT, takt_drives_get_fault(&drives)->code);
}

static void test_a_node_alone_is_started_too(void)
{
    levels = 1;
    config.count = 0;
    enable(&(const struct io_wiring){.input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    levels = 0;
    run(2);
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
}

static void test_more_bits_than_the_node_has_are_refused(void)
{
    enable(&(const struct io_wiring){.output = {0, 0, 0, 0, 0, 0, 0, 0, IO_FLOOD}});
    assert_text(
        "I/O node 20, object 1600:00, is 0001: what is wired is not in the first PDOs of the node");
}

/* What the node answers to one request leads to. */
static void check_answer(struct fake_rule rule, enum takt_error error, const char *text)
{
    setUp();
    levels = 1;
    rule.node = IO_NODE;
    set_rule(rule);
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(error, takt_drives_get_fault(&drives)->code);
    assert_text(text);
}

static void test_a_node_of_no_use_is_refused_with_the_reason(void)
{
    check_answer((struct fake_rule){.object = SDO_OBJECT(0x1000, 0), .value = 0x20192},
                 TAKT_ERROR_IO_TYPE,
                 "I/O node 20 is no CiA 401 node: the device type, object 1000, is 00020192");
    check_answer((struct fake_rule){.object = SDO_OBJECT(0x1600, 1), .silent = 3},
                 TAKT_ERROR_IO_UNANSWERED,
                 "I/O node 20, object 1600:01, does not answer within 10 ms");
    check_answer((struct fake_rule){.object = SDO_OBJECT(0x1A00, 0), .value = 9},
                 TAKT_ERROR_IO_UNMAPPED,
                 "I/O node 20, object 1A00:00, is 0009: what is wired is not in the first PDOs of "
                 "the node");
}

static void test_a_node_without_heartbeat_and_guarding_is_refused(void)
{
    set_rule((struct fake_rule){
        .node = IO_NODE, .object = SDO_OBJECT(0x1017, 0), .abort_code = SDO_ABORT_NO_OBJECT});
    set_rule((struct fake_rule){
        .node = IO_NODE, .object = SDO_OBJECT(0x100C, 0), .abort_code = SDO_ABORT_READ_ONLY});
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_REFUSES, takt_drives_get_fault(&drives)->code);
    assert_text(
        "I/O node 20, object 100C:00, refuses with abort code 06010002: object can only be read");
}

static void enable_guarded(unsigned toggles)
{
    setUp();
    levels = 1;
    nodes.toggles = toggles;
    set_rule((struct fake_rule){
        .node = IO_NODE, .object = SDO_OBJECT(0x1017, 0), .abort_code = SDO_ABORT_READ_ONLY});
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    run(500);
}

static void test_a_node_without_a_heartbeat_is_guarded(void)
{
    enable_guarded(NMT_TOGGLE);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_GREATER_THAN_UINT(4, nodes.guards[IO_NODE]);
    TEST_ASSERT_EQUAL_UINT(0, nodes.guards[1]);
    assert_told(IO_NODE, SDO_OBJECT(0x100C, 0), 100);
    assert_told(IO_NODE, SDO_OBJECT(0x100D, 0), 3);
}

static void test_an_answer_whose_toggle_bit_stays_is_none(void)
{
    enable_guarded(0);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_HEARTBEAT, takt_drives_get_fault(&drives)->code);
}

static void test_a_node_that_is_not_there_is_named(void)
{
    nodes.mute = IO_NODE;
    enable(&(const struct io_wiring){.input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_ABSENT, takt_drives_get_fault(&drives)->code);
    assert_text("I/O node 20 has not booted within 1 s");
}

static void test_what_a_node_may_refuse_costs_nothing_but_that(void)
{
    levels = 1;
    set_rule((struct fake_rule){
        .node = IO_NODE, .object = SDO_OBJECT(0x1016, 1), .abort_code = SDO_ABORT_NO_OBJECT});
    set_rule((struct fake_rule){
        .node = IO_NODE, .object = SDO_OBJECT(0x1800, 2), .abort_code = SDO_ABORT_READ_ONLY});
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void enable_with_stop(void)
{
    setUp();
    levels = 1;
    enable(&(const struct io_wiring){.output = {IO_FLOOD}, .input = {IO_STOP}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_node_that_fails_in_operation_is_a_fault(void)
{
    const struct emcy emcy = {.node = IO_NODE, .code = 0x2320};
    enable_with_stop();
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    run(1);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_FAULT, takt_drives_get_fault(&drives)->code);
    enable_with_stop();
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), IO_NODE, NMT_STOPPED);
    run(1);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_LEFT, takt_drives_get_fault(&drives)->code);
    assert_text("I/O node 20 is not operational any more, but stopped");
    enable_with_stop();
    nodes.starts[IO_NODE] = 0; /* neither inputs nor heartbeats come any more */
    run(22);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_SILENT, takt_drives_get_fault(&drives)->code);
    assert_text("I/O node 20 has sent no inputs for 21 ms");
}

/* Outputs alone: nothing but its heartbeat is heard of it. */
static void test_a_node_without_inputs_is_watched_by_its_heartbeat(void)
{
    enable(&(const struct io_wiring){.output = {IO_FLOOD}});
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    nodes.starts[IO_NODE] = 0;
    run(401);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_IO_HEARTBEAT, takt_drives_get_fault(&drives)->code);
}

static void enable_analogues(uint32_t count, uint32_t first)
{
    set_rule((struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1601, 0), .value = count});
    set_rule((struct fake_rule){.node = IO_NODE, .object = SDO_OBJECT(0x1601, 1), .value = first});
    frames_of_analogues = 0;
    /* the first is E2, the second free, the third E0 */
    enable(&(const struct io_wiring){.input = {IO_PROGRAM}, .analogue = {0x03, 0x01}});
}

static int analogue(unsigned channel)
{
    return (int16_t)little_endian_read16(analogues.data + (size_t)2 * channel);
}

/* Per cent of the range, which ends at 32767 on both sides; what is not wired is 0. */
static void test_analogue_outputs_are_sent_in_every_cycle(void)
{
    enable_analogues(4, 0x64110110);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    outputs.analogue[0] = 50;
    outputs.analogue[1] = 77;
    outputs.analogue[2] = -100;
    frames_of_analogues = 0;
    run(10);
    TEST_ASSERT_EQUAL_UINT(10, frames_of_analogues);
    TEST_ASSERT_EQUAL_UINT8(8, analogues.length);
    TEST_ASSERT_EQUAL_INT(-32767, analogue(0));
    TEST_ASSERT_EQUAL_INT(0, analogue(1));
    TEST_ASSERT_EQUAL_INT(16384, analogue(2));
    TEST_ASSERT_EQUAL_INT(0, analogue(3));
    outputs.analogue[0] = 1e9;
    run(1);
    TEST_ASSERT_EQUAL_INT(32767, analogue(2));
}

static void test_analogue_outputs_must_be_in_the_second_rpdo(void)
{
    enable_analogues(2, 0x64110110);
    assert_text(
        "I/O node 20, object 1601:00, is 0002: what is wired is not in the first PDOs of the node");
    setUp();
    enable_analogues(4, 0x62000108);
    assert_text("I/O node 20, object 1601:01, is 62000108: what is wired is not in the first PDOs "
                "of the node");
}

static void test_analogue_outputs_load_every_cycle(void)
{
    struct drives_load with, without;
    const struct io_wiring plain = {.node = IO_NODE, .input = {IO_PROGRAM}};
    struct io_wiring wired = plain;
    wired.analogue[0] = 0x21;
    struct drives_traffic traffic = {
        .count = 3, .wiring = &plain, .io_count = 1, .rates = {1000000, 0}};
    (void)takt_drives_predict_whole_load(&traffic, 1000, &without);
    traffic.wiring = &wired;
    (void)takt_drives_predict_whole_load(&traffic, 1000, &with);
    TEST_ASSERT_EQUAL_UINT32(without.bits + 55 + 10 * 4, with.bits);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_node_is_told_of_heartbeats_and_to_send_in_every_sync);
    RUN_TEST(test_drives_get_no_torque_before_the_inputs_are_known);
    RUN_TEST(test_outputs_are_sent_when_they_change_and_every_100_ms);
    RUN_TEST(test_inputs_are_the_lines_they_are_wired_to_and_others_stay);
    RUN_TEST(test_stop_and_limit_inputs_brake_all_drives_in_the_cycle_that_hears_of_them);
    RUN_TEST(test_an_axis_can_be_driven_off_a_limit_switch);
    RUN_TEST(test_a_node_alone_is_started_too);
    RUN_TEST(test_a_node_of_no_use_is_refused_with_the_reason);
    RUN_TEST(test_a_node_without_heartbeat_and_guarding_is_refused);
    RUN_TEST(test_a_node_without_a_heartbeat_is_guarded);
    RUN_TEST(test_an_answer_whose_toggle_bit_stays_is_none);
    RUN_TEST(test_a_node_that_is_not_there_is_named);
    RUN_TEST(test_what_a_node_may_refuse_costs_nothing_but_that);
    RUN_TEST(test_a_node_that_fails_in_operation_is_a_fault);
    RUN_TEST(test_a_node_without_inputs_is_watched_by_its_heartbeat);
    RUN_TEST(test_more_bits_than_the_node_has_are_refused);
    RUN_TEST(test_analogue_outputs_are_sent_in_every_cycle);
    RUN_TEST(test_analogue_outputs_must_be_in_the_second_rpdo);
    RUN_TEST(test_analogue_outputs_load_every_cycle);
    return UNITY_END();
}
