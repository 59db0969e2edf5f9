#include "bus/bus.h"
#include "unity.h"

#include <string.h>

#define BIT_NS   UINT64_C(1000)
#define PORTS    3
#define SEEN_MAX 512

static struct bus bus;
static struct can_port port[PORTS];

struct record {
    unsigned count;
    uint16_t id[SEEN_MAX];
    uint64_t time_ns[SEEN_MAX];
};

/* What each node has received, and what has passed on the wire. */
static struct record heard[PORTS], wire;

static void record_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct record *record = context;
    TEST_ASSERT_LESS_THAN_UINT(SEEN_MAX, record->count);
    record->id[record->count] = frame->id;
    record->time_ns[record->count++] = time_ns;
}

void setUp(void)
{
    TEST_ASSERT_TRUE(bus_init(&bus, 1000000));
    memset(heard, 0, sizeof heard);
    memset(&wire, 0, sizeof wire);
    for (unsigned i = 0; i < PORTS; i++)
        port[i] = bus_attach(&bus, &(struct bus_listener){record_frame, &heard[i]});
    bus_observe(&bus, &(struct bus_listener){record_frame, &wire});
}

void tearDown(void)
{
}

static void add_fault(struct bus_fault fault)
{
    TEST_ASSERT_TRUE(bus_add_fault(&bus, &fault));
}

static bool give(unsigned from, unsigned id)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = 1};
    return port[from].send(port[from].context, &frame);
}

static void send_at(uint64_t time_ns, unsigned from, unsigned id)
{
    bus_run_until(&bus, time_ns);
    TEST_ASSERT_TRUE(give(from, id));
}

static uint64_t length_ns(unsigned id)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = 1};
    return frame_bits_count(&bus.tables, &frame) * BIT_NS;
}

static void run_to(uint64_t time_ns)
{
    bus_run_until(&bus, time_ns);
}

static void test_a_dropped_frame_holds_the_bus_and_reaches_nobody(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_DROP, .id = 0x100, .id_mask = 0x7FF});
    send_at(0, 0, 0x100);
    send_at(0, 0, 0x101);
    run_to(1000000);
    TEST_ASSERT_EQUAL_UINT(2, wire.count);
    TEST_ASSERT_EQUAL_UINT(1, heard[1].count);
    TEST_ASSERT_EQUAL_HEX16(0x101, heard[1].id[0]);
    TEST_ASSERT_EQUAL_UINT64(length_ns(0x100) + 3 * BIT_NS + length_ns(0x101), heard[1].time_ns[0]);
    TEST_ASSERT_EQUAL_UINT64(1, bus.counts.dropped);
}

static void test_so_many_frames_are_struck_after_so_many_have_passed(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_DROP, .skip = 2, .count = 3});
    for (unsigned i = 0; i < 8; i++)
        send_at(i * UINT64_C(1000000), 0, 0x100 + i);
    run_to(9000000);
    TEST_ASSERT_EQUAL_UINT(5, heard[1].count);
    TEST_ASSERT_EQUAL_HEX16(0x101, heard[1].id[1]);
    TEST_ASSERT_EQUAL_HEX16(0x105, heard[1].id[2]);
}

static void test_a_fault_strikes_only_in_its_time_and_only_its_senders(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_DROP,
                                 .ports = 1u << 1,
                                 .from_ns = 2000000,
                                 .until_ns = 4000000,
                                 .count = BUS_FAULT_ALWAYS});
    for (unsigned i = 0; i < 6; i++) {
        send_at(i * UINT64_C(1000000), 1, 0x100 + i);
        TEST_ASSERT_TRUE(give(2, 0x200 + i));
    }
    run_to(7000000);
    TEST_ASSERT_EQUAL_UINT(10, heard[0].count);
    TEST_ASSERT_EQUAL_UINT64(2, bus.counts.dropped);
}

static void test_faults_that_are_ended_strike_no_more(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_DROP, .count = BUS_FAULT_ALWAYS});
    add_fault((struct bus_fault){.kind = BUS_FAULT_BUS_OFF, .ports = 1u << 2});
    for (unsigned i = 0; i < 3; i++)
        send_at(i * UINT64_C(1000000), 0, 0x100 + i);
    run_to(3000000);
    TEST_ASSERT_EQUAL_UINT64(3, bus.counts.dropped);
    TEST_ASSERT_EQUAL(BUS_OFF, bus_get_confinement(&bus, 2));
    bus_end_faults(&bus);
    send_at(4000000, 0, 0x103);
    run_to(5000000);
    TEST_ASSERT_EQUAL_UINT64(3, bus.counts.dropped);
    TEST_ASSERT_EQUAL(BUS_ACTIVE, bus_get_confinement(&bus, 2));
    TEST_ASSERT_EQUAL_UINT(1, heard[1].count);
}

static void test_a_share_of_the_frames_is_drawn_from_the_seed_and_no_other(void)
{
    uint64_t dropped[2];
    for (unsigned run = 0; run < 2; run++) {
        setUp();
        add_fault((struct bus_fault){
            .kind = BUS_FAULT_DROP, .count = BUS_FAULT_ALWAYS, .probability = 0.25, .seed = 7});
        for (unsigned i = 0; i < 400; i++)
            send_at(i * UINT64_C(1000000), 0, i);
        run_to(401000000);
        dropped[run] = bus.counts.dropped;
    }
    TEST_ASSERT_EQUAL_UINT64(dropped[0], dropped[1]);
    TEST_ASSERT_UINT64_WITHIN(35, 100, dropped[0]);
}

static void test_a_corrupted_frame_is_broken_off_and_sent_again(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_CORRUPT, .seed = 3});
    send_at(0, 0, 0x100);
    run_to(1000000);
    TEST_ASSERT_EQUAL_UINT(1, wire.count);
    TEST_ASSERT_EQUAL_UINT(1, heard[1].count);
    TEST_ASSERT_EQUAL_UINT64(1, bus.counts.error_frames);
    /*
     * arbitration, one bit, flags of 6 bits and a delimiter of 8 at least; the whole frame and 12 +
     * 8 at most
     */
    uint64_t lost_ns = heard[1].time_ns[0] - length_ns(0x100) - 3 * BIT_NS;
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64((13 + 1 + 6 + 8) * BIT_NS, lost_ns);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(length_ns(0x100) + (12 + 8) * BIT_NS, lost_ns);
}

/* 8 for each error, 1 less for the success at the end; receivers 1 and 1. */
static void test_error_counters_rise_and_fall_as_the_standard_says(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_CORRUPT, .count = 3});
    send_at(0, 0, 0x100);
    run_to(1000000);
    TEST_ASSERT_EQUAL_UINT(3 * 8 - 1, bus.port[0].transmit_errors);
    TEST_ASSERT_EQUAL_UINT(3 - 1, bus.port[1].receive_errors);
    for (unsigned i = 0; i < 23; i++)
        send_at((2 + i) * UINT64_C(1000000), 0, 0x100);
    run_to(30000000);
    TEST_ASSERT_EQUAL_UINT(0, bus.port[0].transmit_errors);
    TEST_ASSERT_EQUAL_UINT(0, bus.port[1].receive_errors);
}

static void test_a_sender_that_never_succeeds_is_passive_after_16_errors_and_off_after_32(void)
{
    add_fault((struct bus_fault){
        .kind = BUS_FAULT_CORRUPT, .ports = 1, .count = BUS_FAULT_ALWAYS, .until_ns = 9000000});
    send_at(0, 0, 0x100);
    for (uint64_t now_ns = 0; bus_get_confinement(&bus, 0) == BUS_ACTIVE; now_ns += BIT_NS)
        run_to(now_ns);
    TEST_ASSERT_EQUAL_UINT64(16, bus.counts.error_frames);
    TEST_ASSERT_EQUAL_INT(BUS_PASSIVE, bus_get_confinement(&bus, 0));
    while (bus_get_confinement(&bus, 0) == BUS_PASSIVE)
        run_to(bus_now_ns(&bus) + BIT_NS);
    TEST_ASSERT_EQUAL_UINT64(32, bus.counts.error_frames);
    TEST_ASSERT_EQUAL_INT(BUS_OFF, bus_get_confinement(&bus, 0));
    TEST_ASSERT_FALSE(give(0, 0x101));
    TEST_ASSERT_EQUAL_UINT64(1, bus.counts.off_lost);
    uint64_t off_ns = bus_now_ns(&bus);
    while (bus_get_confinement(&bus, 0) == BUS_OFF)
        run_to(bus_now_ns(&bus) + BIT_NS);
    TEST_ASSERT_UINT64_WITHIN(5 * BIT_NS, BIT_NS * 128 * 11, bus_now_ns(&bus) - off_ns);
}

/* After a frame of its own a passive node waits 8 bits more, so that others may go first. */
static void test_an_error_passive_node_lets_others_go_first(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_ERROR_PASSIVE, .ports = 1});
    run_to(1);
    TEST_ASSERT_EQUAL_INT(BUS_PASSIVE, bus_get_confinement(&bus, 0));
    send_at(1000000, 0, 0x100);
    TEST_ASSERT_TRUE(give(0, 0x101));
    run_to(1100000);
    TEST_ASSERT_TRUE(give(1, 0x300));
    run_to(2000000);
    TEST_ASSERT_EQUAL_UINT(3, wire.count);
    TEST_ASSERT_EQUAL_HEX16(0x101, wire.id[1]);
    TEST_ASSERT_EQUAL_UINT64(1000000 + length_ns(0x100) + (3 + 8) * BIT_NS + length_ns(0x101),
                             wire.time_ns[1]);
}

static void test_a_duplicated_frame_is_received_twice_at_the_cost_of_an_error_frame(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_DUPLICATE, .count = BUS_FAULT_ALWAYS});
    send_at(0, 0, 0x100);
    run_to(1000000);
    TEST_ASSERT_EQUAL_UINT(2, heard[1].count);
    TEST_ASSERT_EQUAL_UINT(2, heard[2].count);
    TEST_ASSERT_EQUAL_UINT64(length_ns(0x100) + (3 + 6 + 8) * BIT_NS,
                             heard[1].time_ns[1] - heard[1].time_ns[0]);
    TEST_ASSERT_EQUAL_UINT64(1, bus.counts.duplicated);
}

static void test_a_late_frame_comes_behind_those_of_lower_rank(void)
{
    add_fault((struct bus_fault){
        .kind = BUS_FAULT_DELAY, .id = 0x80, .id_mask = 0x7FF, .delay_ns = 500000});
    send_at(0, 0, 0x80);
    TEST_ASSERT_TRUE(give(1, 0x300));
    run_to(499999);
    TEST_ASSERT_EQUAL_UINT(1, wire.count);
    TEST_ASSERT_EQUAL_HEX16(0x300, wire.id[0]);
    run_to(1000000);
    TEST_ASSERT_EQUAL_UINT(2, wire.count);
    TEST_ASSERT_EQUAL_UINT64(500000 + length_ns(0x80), wire.time_ns[1]);
}

static void test_a_node_off_the_bus_neither_hears_nor_is_heard_and_forgets(void)
{
    add_fault((struct bus_fault){
        .kind = BUS_FAULT_BUS_OFF, .ports = 1u << 1, .from_ns = 1000000, .until_ns = 5000000});
    send_at(0, 1, 0x100);
    send_at(999999, 1, 0x101); /* on the wire when it goes off: destroyed */
    run_to(1000001);
    TEST_ASSERT_FALSE(give(1, 0x102));
    send_at(2000000, 0, 0x200);
    run_to(4999999);
    TEST_ASSERT_EQUAL_INT(BUS_OFF, bus_get_confinement(&bus, 1));
    TEST_ASSERT_EQUAL_UINT(1, heard[0].count);
    TEST_ASSERT_EQUAL_UINT(0, heard[1].count);
    TEST_ASSERT_EQUAL_UINT(2, heard[2].count);
    send_at(5000000, 1, 0x103);
    run_to(6000000);
    TEST_ASSERT_EQUAL_UINT(2, heard[0].count);
    TEST_ASSERT_EQUAL_HEX16(0x103, heard[0].id[1]);
}

static void test_what_waits_behind_a_cut_cable_comes_when_it_is_mended(void)
{
    add_fault((struct bus_fault){
        .kind = BUS_FAULT_CUT, .ports = 1, .from_ns = 1000000, .until_ns = 5000000});
    send_at(2000000, 0, 0x100);
    TEST_ASSERT_TRUE(give(1, 0x200));
    run_to(4999999);
    TEST_ASSERT_EQUAL_UINT(0, heard[0].count);
    TEST_ASSERT_EQUAL_UINT(0, heard[1].count);
    TEST_ASSERT_EQUAL_UINT(1, heard[2].count);
    run_to(6000000);
    TEST_ASSERT_EQUAL_UINT(1, heard[1].count);
    TEST_ASSERT_EQUAL_UINT64(5000000 + length_ns(0x100), heard[1].time_ns[0]);
}

/* Nobody acknowledges: it goes on trying, becomes passive, and stays so. */
static void test_a_node_that_is_alone_tries_for_ever_and_never_goes_off(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_CUT, .ports = 6, .until_ns = 100000000});
    send_at(0, 0, 0x100);
    run_to(99999999);
    TEST_ASSERT_EQUAL_INT(BUS_PASSIVE, bus_get_confinement(&bus, 0));
    TEST_ASSERT_EQUAL_UINT(0, wire.count);
    TEST_ASSERT_TRUE(bus_load_percent(&bus) > 80);
    run_to(101000000);
    TEST_ASSERT_EQUAL_UINT(1, heard[1].count);
}

/* The bus goes back to its fast path, with nothing left over. */
static void test_a_bus_is_as_new_when_all_faults_are_over(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_CORRUPT});
    add_fault((struct bus_fault){.kind = BUS_FAULT_CUT, .ports = 2, .until_ns = 2000000});
    for (unsigned i = 0; i < 20; i++)
        send_at(i * UINT64_C(1000000), 0, 0x100);
    run_to(20000000);
    TEST_ASSERT_FALSE(bus.is_unwell);
    TEST_ASSERT_TRUE(bus.fault_from_ns == UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT(20, wire.count);
}

static void test_there_is_an_end_to_the_list_of_faults(void)
{
    for (unsigned i = 0; i < BUS_FAULTS_MAX; i++)
        add_fault((struct bus_fault){.kind = BUS_FAULT_DROP});
    TEST_ASSERT_FALSE(bus_add_fault(&bus, &(struct bus_fault){.kind = BUS_FAULT_DROP}));
}

/* It takes the place that was made when it went onto the wire, and that another has taken since. */
static void test_a_full_port_takes_no_more_when_a_frame_comes_back(void)
{
    add_fault((struct bus_fault){.kind = BUS_FAULT_CORRUPT, .count = BUS_FAULT_ALWAYS});
    while (give(0, 0x100))
        continue;
    for (unsigned k = 1; k <= 1000; k++) {
        run_to(k * UINT64_C(20000));
        (void)give(0, 0x200);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(BUS_TRANSMIT_MAX + 1, bus.port[0].waiting);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_dropped_frame_holds_the_bus_and_reaches_nobody);
    RUN_TEST(test_so_many_frames_are_struck_after_so_many_have_passed);
    RUN_TEST(test_a_fault_strikes_only_in_its_time_and_only_its_senders);
    RUN_TEST(test_faults_that_are_ended_strike_no_more);
    RUN_TEST(test_a_share_of_the_frames_is_drawn_from_the_seed_and_no_other);
    RUN_TEST(test_a_corrupted_frame_is_broken_off_and_sent_again);
    RUN_TEST(test_error_counters_rise_and_fall_as_the_standard_says);
    RUN_TEST(test_a_sender_that_never_succeeds_is_passive_after_16_errors_and_off_after_32);
    RUN_TEST(test_an_error_passive_node_lets_others_go_first);
    RUN_TEST(test_a_duplicated_frame_is_received_twice_at_the_cost_of_an_error_frame);
    RUN_TEST(test_a_late_frame_comes_behind_those_of_lower_rank);
    RUN_TEST(test_a_node_off_the_bus_neither_hears_nor_is_heard_and_forgets);
    RUN_TEST(test_what_waits_behind_a_cut_cable_comes_when_it_is_mended);
    RUN_TEST(test_a_node_that_is_alone_tries_for_ever_and_never_goes_off);
    RUN_TEST(test_a_bus_is_as_new_when_all_faults_are_over);
    RUN_TEST(test_there_is_an_end_to_the_list_of_faults);
    RUN_TEST(test_a_full_port_takes_no_more_when_a_frame_comes_back);
    return UNITY_END();
}
