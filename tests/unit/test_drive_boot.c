/*
 * The start of the drives: what the master asks and tells the nodes before the first setpoint, and
 * what it makes of their answers.
 */
#include "starting_master.h"

static void test_drives_that_answer_are_enabled(void)
{
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_TRUE(cycles_run < 250);
    for (unsigned node = 1; node <= DRIVES; node++) {
        TEST_ASSERT_EQUAL_UINT(1, nodes.resets[node]);
        TEST_ASSERT_EQUAL_UINT(1, nodes.starts[node]);
        TEST_ASSERT_EQUAL_UINT(8, nodes.mode[node]);
    }
}

static void test_nodes_are_started_one_a_cycle_so_that_their_event_timers_are_staggered(void)
{
    takt_drives_init(&drives, &config);
    while (nodes.starts[3] == 0)
        cycle();
    TEST_ASSERT_EQUAL_UINT(0, nodes.starts[2]);
    cycle();
    TEST_ASSERT_EQUAL_UINT(1, nodes.starts[2]);
    TEST_ASSERT_EQUAL_UINT(0, nodes.starts[1]);
    cycle();
    TEST_ASSERT_EQUAL_UINT(1, nodes.starts[1]);
}

static void test_nothing_is_asked_before_all_have_booted(void)
{
    nodes.mute = 3;
    takt_drives_init(&drives, &config);
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_EQUAL_UINT(0, nodes.written_count);
    nodes.mute = 0;
    run_until(DRIVES_ENABLED);
    TEST_ASSERT_EQUAL_UINT(2, nodes.resets[3]);
    TEST_ASSERT_EQUAL_UINT(1, nodes.resets[1]);
}

/* Writes of a node to the objects of one PDO, in order. */
static unsigned find_writes(uint8_t node, uint16_t communication, uint16_t mapping,
                            struct fake_written found[16])
{
    unsigned count = 0;
    for (unsigned i = 0; i < nodes.written_count; i++) {
        uint16_t index = sdo_index(nodes.written[i].object);
        if (nodes.written[i].node == node && (index == communication || index == mapping))
            found[count++ & 15] = nodes.written[i];
    }
    return count;
}

static void assert_writes(uint8_t node, uint16_t communication, uint16_t mapping,
                          const struct fake_written *expected, unsigned count)
{
    struct fake_written found[16] = {{0}};
    TEST_ASSERT_EQUAL_UINT(count, find_writes(node, communication, mapping, found));
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_HEX32(expected[i].object, found[i].object);
        TEST_ASSERT_EQUAL_HEX32(expected[i].value, found[i].value);
        TEST_ASSERT_EQUAL_UINT(expected[i].length, found[i].length);
    }
}

static void test_two_axes_are_paired_in_a_frame_by_dummies(void)
{
    const struct fake_written first[] = {
        {1, SDO_OBJECT(0x1401, 1), 0x80000301, 4}, {1, SDO_OBJECT(0x1401, 2), 1, 1},
        {1, SDO_OBJECT(0x1601, 0), 0, 1},          {1, SDO_OBJECT(0x1601, 1), 0x607A0020, 4},
        {1, SDO_OBJECT(0x1601, 2), 0x00070020, 4}, {1, SDO_OBJECT(0x1601, 0), 2, 1},
        {1, SDO_OBJECT(0x1401, 1), 0x301, 4}};
    const struct fake_written second[] = {
        {2, SDO_OBJECT(0x1401, 1), 0x80000301, 4}, {2, SDO_OBJECT(0x1401, 2), 1, 1},
        {2, SDO_OBJECT(0x1601, 0), 0, 1},          {2, SDO_OBJECT(0x1601, 1), 0x00070020, 4},
        {2, SDO_OBJECT(0x1601, 2), 0x607A0020, 4}, {2, SDO_OBJECT(0x1601, 0), 2, 1},
        {2, SDO_OBJECT(0x1401, 1), 0x301, 4}};
    const struct fake_written alone[] = {
        {3, SDO_OBJECT(0x1401, 1), 0x80000303, 4}, {3, SDO_OBJECT(0x1401, 2), 1, 1},
        {3, SDO_OBJECT(0x1601, 0), 0, 1},          {3, SDO_OBJECT(0x1601, 1), 0x607A0020, 4},
        {3, SDO_OBJECT(0x1601, 0), 1, 1},          {3, SDO_OBJECT(0x1401, 1), 0x303, 4}};
    run_start();
    assert_writes(1, 0x1401, 0x1601, first, 7);
    assert_writes(2, 0x1401, 0x1601, second, 7);
    assert_writes(3, 0x1401, 0x1601, alone, 6);
}

static void test_the_event_timer_of_tpdo2_is_set_while_it_is_not_valid(void)
{
    const struct fake_written tpdo2[] = {
        {2, SDO_OBJECT(0x1801, 1), 0xC0000282, 4}, {2, SDO_OBJECT(0x1801, 2), 255, 1},
        {2, SDO_OBJECT(0x1A01, 0), 0, 1},          {2, SDO_OBJECT(0x1A01, 1), 0x603F0010, 4},
        {2, SDO_OBJECT(0x1A01, 2), 0x60F40020, 4}, {2, SDO_OBJECT(0x1A01, 0), 2, 1},
        {2, SDO_OBJECT(0x1801, 3), 1000, 2},       {2, SDO_OBJECT(0x1801, 5), 100, 2},
        {2, SDO_OBJECT(0x1801, 1), 0x40000282, 4}};
    run_start();
    assert_writes(2, 0x1801, 0x1A01, tpdo2, 9);
}

/* A drive may have one stored that is longer than a cycle, or hear SYNC by another identifier. */
static void test_reports_are_not_held_back_and_sync_is_told(void)
{
    run_start();
    for (uint8_t node = 1; node <= DRIVES; node++) {
        assert_told(node, SDO_OBJECT(0x1800, 3), 0);
        assert_told(node, SDO_OBJECT(0x1005, 0), 0x80);
        assert_told(node, SDO_OBJECT(0x1019, 0), 0);
    }
}

static void test_a_drive_without_the_identifier_of_sync_has_that_of_the_standard(void)
{
    set_rule(
        (struct fake_rule){.object = SDO_OBJECT(0x1005, 0), .abort_code = SDO_ABORT_NO_OBJECT});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    setUp();
    set_rule((struct fake_rule){
        .object = SDO_OBJECT(0x1005, 0), .value = 0x80000080, .write_code = SDO_ABORT_READ_ONLY});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/* What the drive does first when it has booted is its own affair: it may have started itself. */
static void test_a_drive_is_configured_while_it_is_pre_operational(void)
{
    run_start();
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_EQUAL_UINT(1, nodes.holds[node]);
    TEST_ASSERT_EQUAL_UINT(0, nodes.written_before_hold);
}

static void test_setpoints_wait_for_a_brake_and_not_for_a_drive_that_does_not_tell(void)
{
    follows_at_once = false;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    unsigned without = cycles_run;
    TEST_ASSERT_GREATER_THAN_UINT(1000, without);
    setUp();
    follows_at_once = false;
    takt_drives_init(&drives, &config);
    for (unsigned i = 0; i < 600; i++) {
        cycle();
        TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    }
    follows_at_once = true;
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_heartbeats_cycle_and_stops_are_configured(void)
{
    run_start();
    for (uint8_t node = 1; node <= DRIVES; node++) {
        assert_told(node, SDO_OBJECT(0x1017, 0), 100);
        assert_told(node, SDO_OBJECT(0x1016, 1), 127u << 16 | 300);
        assert_told(node, SDO_OBJECT(0x1006, 0), 1000);
        assert_told(node, SDO_OBJECT(0x60C2, 1), 1);
        assert_told(node, SDO_OBJECT(0x60C2, 2), 0xFD);
        assert_told(node, SDO_OBJECT(0x605A, 0), 2);
        assert_told(node, SDO_OBJECT(0x6007, 0), 3);
    }
}

static void test_periods_of_any_length_are_told_as_value_and_power_of_ten(void)
{
    static const uint32_t periods[][3] = {
        {10000, 1, 0xFE}, {2000, 2, 0xFD}, {1500, 15, 0xFC}, {250, 25, 0xFB}, {125, 125, 0xFA}};
    for (unsigned i = 0; i < sizeof periods / sizeof periods[0]; i++) {
        setUp();
        config.cycle_us = periods[i][0];
        config.rates.nominal = 10000000;
        config.count = 1;
        run_start();
        assert_told(1, SDO_OBJECT(0x60C2, 1), periods[i][1]);
        assert_told(1, SDO_OBJECT(0x60C2, 2), periods[i][2]);
    }
}

static void test_pdos_that_are_not_used_are_switched_off(void)
{
    run_start();
    assert_told(2, SDO_OBJECT(0x1402, 1), 0x80000402);
    assert_told(2, SDO_OBJECT(0x1403, 1), 0x80000502);
    assert_told(2, SDO_OBJECT(0x1802, 1), 0xC0000382);
    assert_told(2, SDO_OBJECT(0x1803, 1), 0xC0000482);
}

static void test_what_a_drive_may_lack_is_passed_over(void)
{
    static const uint32_t lacking[] = {SDO_OBJECT(0x1018, 4), SDO_OBJECT(0x1016, 1),
                                       SDO_OBJECT(0x1006, 0), SDO_OBJECT(0x60C2, 1),
                                       SDO_OBJECT(0x605E, 0), SDO_OBJECT(0x1403, 1)};
    for (unsigned i = 0; i < sizeof lacking / sizeof lacking[0]; i++)
        set_rule(
            (struct fake_rule){.object = lacking[i],
                               .abort_code = i % 2 ? SDO_ABORT_NO_OBJECT : SDO_ABORT_NO_SUB_INDEX});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static bool gave_up(enum axis axis, enum drives_given_up what)
{
    return takt_drives_get_given_up(&drives, axis) >> what & 1;
}

static void test_nothing_is_given_up_by_drives_that_take_everything(void)
{
    run_start();
    for (unsigned i = 0; i < DRIVES; i++)
        TEST_ASSERT_EQUAL_HEX32(0, takt_drives_get_given_up(&drives, (enum axis)(AXIS_X + (int)i)));
}

static void test_an_optional_object_that_is_refused_for_any_reason_is_given_up(void)
{
    static const uint32_t codes[] = {SDO_ABORT_VALUE, SDO_ABORT_READ_ONLY, SDO_ABORT_TOO_HIGH,
                                     SDO_ABORT_STATE, 0x12345678};
    for (unsigned i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        setUp();
        set_rule((struct fake_rule){.object = SDO_OBJECT(0x1006, 0), .abort_code = codes[i]});
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        TEST_ASSERT_TRUE(gave_up(AXIS_X, DRIVES_NO_SYNC_PERIOD));
    }
}

static void test_axes_of_drives_without_dummies_have_frames_of_their_own(void)
{
    const struct fake_written alone[] = {
        {2, SDO_OBJECT(0x1401, 1), 0x80000302, 4}, {2, SDO_OBJECT(0x1401, 2), 1, 1},
        {2, SDO_OBJECT(0x1601, 0), 0, 1},          {2, SDO_OBJECT(0x1601, 1), 0x607A0020, 4},
        {2, SDO_OBJECT(0x1601, 0), 1, 1},          {2, SDO_OBJECT(0x1401, 1), 0x302, 4}};
    set_rule((struct fake_rule){
        .node = 1, .object = SDO_OBJECT(0x1601, 2), .write_code = SDO_ABORT_NO_OBJECT});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    assert_writes(2, 0x1401, 0x1601, alone, 6);
    TEST_ASSERT_TRUE(gave_up(AXIS_X, DRIVES_NO_PAIR) && gave_up(AXIS_Y, DRIVES_NO_PAIR));
    TEST_ASSERT_FALSE(gave_up(AXIS_Z, DRIVES_NO_PAIR));
}

static void test_the_load_is_that_of_the_frames_that_were_found(void)
{
    struct drives_load load;
    run_start();
    takt_drives_get_load(&drives, 0, &load);
    TEST_ASSERT_EQUAL_UINT32(55 + 135 + 95 + 345 + 180, load.bits);
    setUp();
    set_rule((struct fake_rule){
        .node = 1, .object = SDO_OBJECT(0x1601, 2), .write_code = SDO_ABORT_NOT_MAPPABLE});
    run_start();
    takt_drives_get_load(&drives, 0, &load);
    TEST_ASSERT_EQUAL_UINT32(55 + 3 * 95 + 345 + 180, load.bits);
}

static void test_reports_that_do_not_come_by_sync_come_by_a_timer_of_the_cycle(void)
{
    config.cycle_us = 1500; /* a timer counts in ms */
    for (uint16_t index = 0x1800; index < 0x1804; index++)
        set_rule((struct fake_rule){.node = 3,
                                    .object = SDO_OBJECT(index, 2),
                                    .write_code = SDO_ABORT_VALUE,
                                    .taken_from = 254});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_HEX32(1U << DRIVES_NO_SYNC_REPORT, takt_drives_get_given_up(&drives, AXIS_Z));
    TEST_ASSERT_EQUAL_UINT32(20, fake_nodes_told(&nodes, 3, SDO_OBJECT(0x1800, 3))->value);
    TEST_ASSERT_EQUAL_UINT32(2, fake_nodes_told(&nodes, 3, SDO_OBJECT(0x1800, 5))->value);
    TEST_ASSERT_EQUAL_HEX32(0x603F0010, fake_nodes_told(&nodes, 3, SDO_OBJECT(0x1A01, 1))->value);
    TEST_ASSERT_EQUAL_UINT32(100, fake_nodes_told(&nodes, 3, SDO_OBJECT(0x1801, 5))->value);
}

static void test_a_drive_that_boots_slowly_is_reset_once(void)
{
    nodes.mute = 3;
    config.boot_timeout_cycles = 1000;
    takt_drives_init(&drives, &config);
    for (unsigned i = 0; i < 900; i++)
        cycle();
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), 3, NMT_BOOTED);
    nodes.mute = 0;
    run_until(DRIVES_ENABLED);
    TEST_ASSERT_EQUAL_UINT(0, nodes.resets[3] - 1);
}

static void test_a_drive_that_boots_without_a_word_is_asked(void)
{
    nodes.wordless = 3;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_UINT(2, nodes.resets[3]);
    TEST_ASSERT_EQUAL_UINT(1, nodes.holds[3]);
}

static void test_a_drive_that_boots_while_it_is_configured_is_configured_again(void)
{
    takt_drives_init(&drives, &config);
    while (nodes.starts[1] == 0)
        cycle();
    unsigned written = nodes.written_count;
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), 2, NMT_BOOTED);
    run_until(DRIVES_ENABLED);
    TEST_ASSERT_EQUAL_UINT(2 * written, nodes.written_count);
    for (unsigned node = 1; node <= 3; node++) {
        TEST_ASSERT_EQUAL_UINT(2, nodes.holds[node]);
        TEST_ASSERT_EQUAL_UINT(2, nodes.starts[node]);
    }
}

static void test_a_bus_that_cannot_carry_the_cycle_is_refused_with_figures_before_any_frame(void)
{
    config.count = 4;
    config.axis[3] = config.axis[2];
    config.axis[3].node = 4;
    config.rates.nominal = 500000;
    takt_drives_init(&drives, &config);
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_BUS_OVERLOAD, takt_drives_get_fault(&drives)->code);
    assert_text("the bus cannot carry a cycle: it takes 965 of 500 bits at worst, 193 percent");
    TEST_ASSERT_EQUAL_UINT(0, frames_sent);
}

static void test_a_start_that_the_bus_refuses_ends_after_its_time(void)
{
    refuses_starts = true;
    run_start();
    TEST_ASSERT_TRUE(drives_get_state(&drives) != DRIVES_STARTING);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_UNREACHABLE, takt_drives_get_fault(&drives)->code);
}

static void test_a_start_that_gets_lost_is_sent_again(void)
{
    for (unsigned count = 1; count <= 2 * DRIVES; count++) {
        setUp();
        lost_starts = count;
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        TEST_ASSERT_EQUAL_UINT(0, lost_starts);
    }
}

static void test_a_lost_question_for_the_mode_is_asked_again(void)
{
    config.sdo_timeout_cycles = 1500; /* longer than a drive may take to show its mode */
    set_rule(
        (struct fake_rule){.node = 2, .object = SDO_OBJECT(0x6061, 0), .value = 8, .silent = 2});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    setUp();
    config.sdo_timeout_cycles = 100;
    set_rule(
        (struct fake_rule){.node = 2, .object = SDO_OBJECT(0x6061, 0), .value = 8, .silent = 3});
    run_start();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_UNANSWERED, takt_drives_get_fault(&drives)->code);
}

static void test_a_drive_that_falls_silent_while_it_is_enabled_is_told_as_silent(void)
{
    shown_bits[2] = 0;
    takt_drives_init(&drives, &config);
    while (nodes.starts[2] == 0 || shown[2] == CIA402_SWITCH_ON_DISABLED)
        cycle();
    nodes.mute = 2;
    run_until(DRIVES_FAULTED);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_SILENT, takt_drives_get_fault(&drives)->code);
}

/* CiA 301: while SYNC has a period its counter can not be changed. */
static void test_the_counter_of_sync_is_told_while_sync_has_no_period(void)
{
    run_start();
    const struct fake_written *told = fake_nodes_told(&nodes, 1, SDO_OBJECT(0x1019, 0));
    TEST_ASSERT_EQUAL_HEX32(SDO_OBJECT(0x1006, 0), told[-1].object);
    TEST_ASSERT_EQUAL_UINT32(0, told[-1].value);
    assert_told(1, SDO_OBJECT(0x1006, 0), 1000);
}

static void test_a_heartbeat_comes_once_a_cycle_at_most_and_everybody_is_told_so(void)
{
    config.cycle_us = 4000;
    config.heartbeat_ms = 3;
    run_start();
    assert_told(1, SDO_OBJECT(0x1017, 0), 4);
    assert_told(1, SDO_OBJECT(0x1016, 1), 127u << 16 | 12);
    TEST_ASSERT_EQUAL_UINT32(1, drives.heartbeat_cycles);
}

/* 7 ms are 1.75 cycles of 4 ms: three periods are 21 ms, not 12. */
static void test_three_heartbeats_are_missed_in_no_less_than_their_time(void)
{
    config.cycle_us = 4000;
    config.heartbeat_ms = 7;
    takt_drives_init(&drives, &config);
    TEST_ASSERT_TRUE(4 * drives.heartbeat_age_max_cycles >= 21);
}

static const struct drives_rates megabit = {1000000, 0};

/*
 * 55 + 10 n bits a frame: SYNC, pairs of targets, a status of each drive, a TPDO2 and a heartbeat.
 */
static void test_the_load_is_that_of_the_worst_stuffed_frames(void)
{
    static const uint32_t bits[] = {55 + 95 + 115 + 180, 55 + 135 + 230 + 180,
                                    55 + 135 + 95 + 345 + 180, 785 + 180};
    struct drives_load load;
    for (unsigned count = 1; count <= 4; count++) {
        TEST_ASSERT_TRUE(takt_drives_predict_load(count, &megabit, 1000, &load));
        TEST_ASSERT_EQUAL_UINT32(bits[count - 1], load.bits);
        TEST_ASSERT_EQUAL_UINT32(1000, load.capacity_bits);
        TEST_ASSERT_TRUE(load.percent == bits[count - 1] / 10.0);
    }
    TEST_ASSERT_FALSE(takt_drives_predict_load(6, &megabit, 1000, &load));
    const struct drives_traffic often = {.count = 3, .rates = megabit, .heartbeat_ms = 2};
    TEST_ASSERT_TRUE(takt_drives_predict_whole_load(&often, 1000, &load));
    TEST_ASSERT_EQUAL_UINT32(bits[2] + 65, load.bits); /* of four nodes in two cycles */
    TEST_ASSERT_TRUE(takt_drives_predict_load(6, &megabit, 2000, &load));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_drives_that_answer_are_enabled);
    RUN_TEST(test_nodes_are_started_one_a_cycle_so_that_their_event_timers_are_staggered);
    RUN_TEST(test_nothing_is_asked_before_all_have_booted);
    RUN_TEST(test_two_axes_are_paired_in_a_frame_by_dummies);
    RUN_TEST(test_the_event_timer_of_tpdo2_is_set_while_it_is_not_valid);
    RUN_TEST(test_reports_are_not_held_back_and_sync_is_told);
    RUN_TEST(test_a_drive_without_the_identifier_of_sync_has_that_of_the_standard);
    RUN_TEST(test_a_drive_is_configured_while_it_is_pre_operational);
    RUN_TEST(test_setpoints_wait_for_a_brake_and_not_for_a_drive_that_does_not_tell);
    RUN_TEST(test_heartbeats_cycle_and_stops_are_configured);
    RUN_TEST(test_periods_of_any_length_are_told_as_value_and_power_of_ten);
    RUN_TEST(test_pdos_that_are_not_used_are_switched_off);
    RUN_TEST(test_what_a_drive_may_lack_is_passed_over);
    RUN_TEST(test_nothing_is_given_up_by_drives_that_take_everything);
    RUN_TEST(test_an_optional_object_that_is_refused_for_any_reason_is_given_up);
    RUN_TEST(test_axes_of_drives_without_dummies_have_frames_of_their_own);
    RUN_TEST(test_a_start_that_the_bus_refuses_ends_after_its_time);
    RUN_TEST(test_a_start_that_gets_lost_is_sent_again);
    RUN_TEST(test_a_lost_question_for_the_mode_is_asked_again);
    RUN_TEST(test_a_drive_that_falls_silent_while_it_is_enabled_is_told_as_silent);
    RUN_TEST(test_the_counter_of_sync_is_told_while_sync_has_no_period);
    RUN_TEST(test_a_heartbeat_comes_once_a_cycle_at_most_and_everybody_is_told_so);
    RUN_TEST(test_three_heartbeats_are_missed_in_no_less_than_their_time);
    RUN_TEST(test_the_load_is_that_of_the_frames_that_were_found);
    RUN_TEST(test_reports_that_do_not_come_by_sync_come_by_a_timer_of_the_cycle);
    RUN_TEST(test_a_drive_that_boots_slowly_is_reset_once);
    RUN_TEST(test_a_drive_that_boots_without_a_word_is_asked);
    RUN_TEST(test_a_drive_that_boots_while_it_is_configured_is_configured_again);
    RUN_TEST(test_a_bus_that_cannot_carry_the_cycle_is_refused_with_figures_before_any_frame);
    RUN_TEST(test_the_load_is_that_of_the_worst_stuffed_frames);
    return UNITY_END();
}
