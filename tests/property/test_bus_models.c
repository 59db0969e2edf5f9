/*
 * The embedded bus three times over the same random traffic: its fast path; its full model with
 * faults, none of which ever strikes; and a bus of this file, bit by bit, in which every node reads
 * back what it sends.
 */
#include "bus/bus.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

#define PORTS     5
#define ROUNDS    400
#define SENDS_MAX 60
#define SEEN_MAX  (SENDS_MAX)
#define BIT_NS    1000u

struct seen {
    struct can_frame frame;
    uint64_t end_ns;
};

struct record {
    unsigned count;
    struct seen seen[SEEN_MAX];
};

struct sending {
    uint64_t time_bits;
    unsigned port;
    struct can_frame frame;
};

static struct bus fast, full;
static struct sending sending[SENDS_MAX];
static unsigned sendings;
static uint64_t state;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t draw(uint32_t range)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % range;
}

/*
 * Nodes never share an identifier: the last digit of theirs is their own. Few identifiers and bytes
 * of equal bits, so that arbitration and stuffing have much to do.
 */
static struct can_frame random_frame(unsigned port)
{
    static const uint8_t bytes[] = {0x00, 0xFF, 0x0F, 0x83, 0x7C, 0xE0};
    struct can_frame frame = {.id = (uint16_t)(draw(3) == 0 ? draw(128) << 4 | port : port),
                              .length = (uint8_t)draw(9)};
    for (unsigned i = 0; i < frame.length; i++)
        frame.data[i] = draw(2) ? bytes[draw(6)] : (uint8_t)draw(256);
    return frame;
}

static void make_traffic(void)
{
    uint64_t time_bits = 0;
    uint32_t gap = draw(4) == 0 ? 400 : 60;
    sendings = 1 + draw(SENDS_MAX);
    for (unsigned i = 0; i < sendings; i++) {
        unsigned port = draw(PORTS);
        time_bits += draw(2) ? draw(gap) : 0;
        sending[i] = (struct sending){time_bits, port, random_frame(port)};
    }
}

static void record_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct record *record = context;
    TEST_ASSERT_LESS_THAN_UINT(SEEN_MAX, record->count);
    record->seen[record->count++] = (struct seen){*frame, time_ns};
}

static void run_bus(struct bus *bus, bool is_full, uint32_t data_bitrate, struct record *record)
{
    struct can_port port[PORTS];
    TEST_ASSERT_TRUE(bus_init_rates(bus, &(struct frame_rates){1000000, data_bitrate}));
    memset(record, 0, sizeof *record);
    for (unsigned i = 0; i < PORTS; i++)
        port[i] = bus_attach(bus, NULL);
    bus_observe(bus, &(struct bus_listener){record_frame, record});
    if (is_full) { /* a frame that nobody sends, and a node that there is not */
        struct bus_fault frame = {.kind = BUS_FAULT_CORRUPT, .id = 0x7FF, .id_mask = 0x7FF};
        struct bus_fault node = {.kind = BUS_FAULT_CUT, .ports = 1u << PORTS};
        TEST_ASSERT_TRUE(bus_add_fault(bus, &frame) && bus_add_fault(bus, &node));
    }
    for (unsigned i = 0; i < sendings; i++) {
        if (i == 0 || sending[i].time_bits > sending[i - 1].time_bits)
            bus_run_until(bus, sending[i].time_bits * BIT_NS);
        TEST_ASSERT_TRUE(
            port[sending[i].port].send(port[sending[i].port].context, &sending[i].frame));
    }
    bus_run_until(bus, 60000000);
    TEST_ASSERT_TRUE(bus_is_quiet(bus));
}

/* The bits of a frame one by one: what a node has still to send. */
struct transmitter {
    unsigned count, at;
    uint8_t bit[160];
    bool is_sending;
};

static unsigned naive_checksum(const uint8_t *bit, unsigned count)
{
    unsigned crc = 0;
    for (unsigned i = 0; i < count; i++) {
        unsigned next = bit[i] ^ (crc >> 14 & 1);
        crc = crc << 1 & 0x7FFF;
        if (next)
            crc ^= 0x4599;
    }
    return crc;
}

static unsigned put(uint8_t *bit, unsigned at, unsigned value, unsigned count)
{
    for (unsigned i = count; i-- > 0;)
        bit[at++] = value >> i & 1;
    return at;
}

static void load(struct transmitter *t, const struct can_frame *frame)
{
    uint8_t plain[128];
    unsigned count = put(plain, 0, 0, 1), run = 0;
    count = put(plain, count, frame->id, 11);
    count = put(plain, count, 0, 3);
    count = put(plain, count, frame->length, 4);
    for (unsigned i = 0; i < frame->length && i < CAN_CLASSIC_MAX; i++)
        count = put(plain, count, frame->data[i], 8);
    count = put(plain, count, naive_checksum(plain, count), 15);
    memset(t, 0, sizeof *t);
    for (unsigned i = 0; i < count; i++) {
        run = i > 0 && t->bit[t->count - 1] == plain[i] ? run + 1 : 1;
        t->bit[t->count++] = plain[i];
        if (run == 5) {
            t->bit[t->count++] = !plain[i];
            run = 1;
        }
    }
    t->count = put(t->bit, t->count, 0x3FF, 10); /* the acknowledge as the sender sends it */
    t->is_sending = true;
}

/*
 * The frame a node would send next: of those it was given before this time the lowest identifier,
 * then the oldest.
 */
static int choose(unsigned port, uint64_t before, const bool *done)
{
    int best = -1;
    for (unsigned i = 0; i < sendings; i++)
        if (!done[i] && sending[i].port == port && sending[i].time_bits < before &&
            (best < 0 || sending[i].frame.id < sending[best].frame.id))
            best = (int)i;
    return best;
}

/* One bit time of all that send: zero wins, who sent a one and reads a zero withdraws. */
static void send_bit(struct transmitter *t)
{
    uint8_t level = 1;
    for (unsigned i = 0; i < PORTS; i++)
        if (t[i].is_sending)
            level &= t[i].bit[t[i].at];
    for (unsigned i = 0; i < PORTS; i++)
        if (t[i].is_sending && t[i].bit[t[i].at++] != level)
            t[i].is_sending = false;
}

/* From the first bit of one frame to its last; returns the node whose frame went through. */
static unsigned send_frame(struct transmitter *t, uint64_t *now)
{
    for (;;) {
        send_bit(t);
        ++*now;
        for (unsigned i = 0; i < PORTS; i++)
            if (t[i].is_sending && t[i].at == t[i].count)
                return i;
    }
}

/* Loads what the nodes would send. False: nothing. */
static bool load_all(struct transmitter *t, int *chosen, uint64_t before, const bool *done)
{
    bool is_busy = false;
    memset(t, 0, PORTS * sizeof *t);
    for (unsigned i = 0; i < PORTS; i++) {
        chosen[i] = choose(i, before, done);
        if (chosen[i] >= 0)
            load(&t[i], &sending[chosen[i]].frame);
        is_busy = is_busy || chosen[i] >= 0;
    }
    return is_busy;
}

/* A frame that is given at the very bit at which another starts is too late for it. */
static void run_bits(struct record *record)
{
    bool done[SENDS_MAX] = {false};
    uint64_t now = 0;
    memset(record, 0, sizeof *record);
    while (record->count < sendings) {
        struct transmitter t[PORTS];
        int chosen[PORTS];
        if (!load_all(t, chosen, now, done) && !load_all(t, chosen, now + 1, done)) {
            now++;
            continue;
        }
        unsigned winner = send_frame(t, &now);
        done[chosen[winner]] = true;
        record->seen[record->count++] = (struct seen){sending[chosen[winner]].frame, now * BIT_NS};
        now += 3; /* intermission */
    }
}

static void expect_same(const struct record *expected, const struct record *actual)
{
    TEST_ASSERT_EQUAL_UINT(expected->count, actual->count);
    for (unsigned i = 0; i < expected->count; i++) {
        const struct seen *e = &expected->seen[i], *a = &actual->seen[i];
        TEST_ASSERT_EQUAL_UINT64(e->end_ns, a->end_ns);
        TEST_ASSERT_EQUAL_HEX16(e->frame.id, a->frame.id);
        TEST_ASSERT_EQUAL_UINT8(e->frame.length, a->frame.length);
        if (e->frame.length > 0)
            TEST_ASSERT_EQUAL_UINT8_ARRAY(e->frame.data, a->frame.data, e->frame.length);
    }
}

static void expect_same_received(unsigned port)
{
    TEST_ASSERT_EQUAL_UINT(fast.port[port].written, full.port[port].written);
    for (unsigned i = 0; i < fast.port[port].written; i++)
        TEST_ASSERT_EQUAL_HEX16(fast.port[port].received[i].id, full.port[port].received[i].id);
}

static void expect_same_buses(const struct record *by_fast, const struct record *by_full)
{
    expect_same(by_fast, by_full);
    TEST_ASSERT_EQUAL_MEMORY(&fast.counts, &full.counts, sizeof fast.counts);
    TEST_ASSERT_EQUAL_MEMORY(fast.response_max_ns, full.response_max_ns,
                             sizeof fast.response_max_ns);
    for (unsigned i = 0; i < PORTS; i++)
        expect_same_received(i);
}

static void test_fast_path_full_model_and_single_bits_agree_to_the_nanosecond(void)
{
    static struct record by_fast, by_full, by_bits;
    for (unsigned round = 0; round < ROUNDS; round++) {
        state = round;
        make_traffic();
        run_bus(&fast, false, 0, &by_fast);
        run_bus(&full, true, 0, &by_full);
        run_bits(&by_bits);
        expect_same(&by_bits, &by_fast);
        expect_same_buses(&by_fast, &by_full);
    }
}

static void test_with_can_fd_fast_path_and_full_model_agree_to_the_nanosecond(void)
{
    static const uint32_t rates[] = {1000000, 2000000, 5000000, 8000000};
    static struct record by_fast, by_full;
    for (unsigned round = 0; round < ROUNDS; round++) {
        state = round;
        make_traffic();
        run_bus(&fast, false, rates[round % 4], &by_fast);
        run_bus(&full, true, rates[round % 4], &by_full);
        TEST_ASSERT_EQUAL_UINT(sendings, by_fast.count);
        expect_same_buses(&by_fast, &by_full);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_with_can_fd_fast_path_and_full_model_agree_to_the_nanosecond);
    RUN_TEST(test_fast_path_full_model_and_single_bits_agree_to_the_nanosecond);
    return UNITY_END();
}
