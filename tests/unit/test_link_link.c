/*
 * Outside buses between two processes: one end answers every frame with one of the next identifier,
 * the other end compares. Those that need nothing of the system but pseudo-terminals and TCP on
 * this machine; SocketCAN has tests of its own in tests/system.
 */
#define _DEFAULT_SOURCE

#include "link/link.h"
#include "random_frame.h"
#include "unity.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define FRAMES  2000
#define LAST_ID 0x7FEu
#define WAIT_NS 20000000000ull /* only a broken link waits as long */
#define LOOK_NS 1000000u

static const struct link_config config = {.bitrate = 1000000, .fd = true};

void setUp(void)
{
}

void tearDown(void)
{
}

/* Any frame whose next identifier is one, too, and which is not the last of all. */
static struct wire_frame next_frame(uint64_t *state)
{
    struct wire_frame frame = random_frame(state);

    if (frame.id >= LAST_ID && !(frame.flags & WIRE_EXTENDED))
        frame.id -= 2;
    if (frame.id == RANDOM_FRAME_EXTENDED_IDS - 1)
        frame.id--;
    return frame;
}

static bool is_last(const struct wire_frame *frame)
{
    return frame->flags == 0 && frame->id == LAST_ID;
}

/*
 * The other process: tells where it is, answers until the last frame, and stays until we go, unless
 * that has data.
 */
static void answer(const char *spec, int tell)
{
    struct link_error error;
    struct wire_frame frame = {0};
    struct link *link = link_open(spec, &config, &error);
    if (link == NULL) {
        (void)fprintf(stderr, "%s\n", error.text);
        _exit(1);
    }
    const char *address = link_get_address(link);
    if (write(tell, address, strlen(address) + 1) < 0)
        _exit(2);
    while (!is_last(&frame) && link_wait(link, link_clock_ns() + WAIT_NS) == LINK_READY)
        while (!is_last(&frame) && link_receive(link, &frame)) {
            frame.id++;
            if (!link_send(link, &frame))
                _exit(3);
            frame.id--;
        }
    while (frame.length == 0 && link_has_peer(link)) /* a pseudo-terminal dies with what is in it */
        (void)link_wait(link, link_clock_ns() + LOOK_NS);
    link_close(link);
    _exit(is_last(&frame) ? 0 : 4);
}

static pid_t start_answering(const char *spec, char *address, size_t size)
{
    int tell[2];
    TEST_ASSERT_EQUAL_INT(0, pipe(tell));
    pid_t other = fork();
    if (other == 0)
        answer(spec, tell[1]);
    (void)close(tell[1]);
    TEST_ASSERT_GREATER_THAN_INT(0, (int)read(tell[0], address, size));
    (void)close(tell[0]);
    return other;
}

static void expect_answer(struct link *link, const struct wire_frame *sent)
{
    struct wire_frame got;
    TEST_ASSERT_EQUAL_INT_MESSAGE(LINK_READY, link_wait(link, link_clock_ns() + WAIT_NS),
                                  link_get_problem(link));
    TEST_ASSERT_TRUE(link_receive(link, &got));
    TEST_ASSERT_EQUAL_HEX32(sent->id + 1, got.id);
    TEST_ASSERT_EQUAL_HEX8(sent->flags, got.flags);
    TEST_ASSERT_EQUAL_UINT8(sent->length, got.length);
    if (!(sent->flags & WIRE_REMOTE) && sent->length > 0)
        TEST_ASSERT_EQUAL_UINT8_ARRAY(sent->data, got.data, sent->length);
}

static void exchange(struct link *link)
{
    uint64_t random = 1;
    struct wire_frame last = {.id = LAST_ID};
    for (unsigned i = 0; i < FRAMES; i++) {
        struct wire_frame frame = next_frame(&random);
        TEST_ASSERT_TRUE(link_send(link, &frame));
        expect_answer(link, &frame);
    }
    TEST_ASSERT_TRUE(link_send(link, &last));
    expect_answer(link, &last);
    TEST_ASSERT_EQUAL_UINT64(FRAMES + 1, link_get_counts(link)->sent);
    TEST_ASSERT_EQUAL_UINT64(FRAMES + 1, link_get_counts(link)->received);
    TEST_ASSERT_EQUAL_UINT64(0, link_get_counts(link)->garbled);
}

/* listener: spec of the side that waits; prefix: of the side that comes to its address. */
static void check_pair(const char *listener, const char *prefix)
{
    char address[256], spec[300];
    struct link_error error;
    int status;
    pid_t other = start_answering(listener, address, sizeof address);
    (void)snprintf(spec, sizeof spec, "%s%s", prefix, address);
    struct link *link = link_open(spec, &config, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(link, error.text);
    exchange(link);
    link_close(link);
    TEST_ASSERT_EQUAL_INT(other, waitpid(other, &status, 0));
    TEST_ASSERT_EQUAL_INT(0, status);
}

static void test_slcan_carries_frames_over_a_pseudo_terminal(void)
{
    check_pair("slcan:pty", "slcan:");
}

static void test_slcan_carries_frames_over_tcp(void)
{
    check_pair("slcan:listen:0", "slcan:");
}

static void test_socketcand_carries_frames_between_client_and_server(void)
{
    check_pair("socketcand:listen:0", "socketcand:");
}

static void expect_refused(const char *spec, const char *part, bool is_environment)
{
    struct link_error error = {0};
    TEST_ASSERT_NULL_MESSAGE(link_open(spec, &config, &error), spec);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, spec), error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, part), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(is_environment, error.is_environment, error.text);
}

static void test_a_text_that_names_no_bus_is_refused(void)
{
    expect_refused("", "unknown kind", false);
    expect_refused("canbus:0", "unknown kind", false);
    expect_refused("socketcan:", "expected socketcan:INTERFACE", false);
    expect_refused("socketcan:a_name_much_too_long", "expected socketcan:INTERFACE", false);
    expect_refused("slcan:", "expected slcan:PATH", false);
    expect_refused("slcan:localhost", "expected slcan:PATH", false);
    expect_refused("slcan:localhost:0", "expected slcan:PATH", false);
    expect_refused("slcan:localhost:123:4", "expected slcan:PATH", false);
    expect_refused("slcan:/dev/null@17", "common baud rate", false);
    expect_refused("socketcand:localhost", "expected socketcand:HOST:PORT", false);
    expect_refused("socketcand:localhost:99999", "expected socketcand:HOST:PORT", false);
    expect_refused("embedded", "inside one process", false);
}

static void test_a_bus_that_is_not_there_is_refused(void)
{
    expect_refused("slcan:/no/such/device", "No such file", true);
    expect_refused("slcan:/dev/null", "cannot be used", true);
    expect_refused("slcan:127.0.0.1:1", "no connection", true);
    expect_refused("socketcand:127.0.0.1:1", "no connection", true);
    expect_refused("slcan:pty:/no/such/folder/can", "cannot be made", true);
}

static void test_a_bit_rate_that_adapters_do_not_know_is_refused(void)
{
    struct link_config odd = {.bitrate = 123456};
    struct link_error other, error = {0};
    struct link *adapter = link_open("slcan:pty", &config, &other);
    char spec[300];
    (void)snprintf(spec, sizeof spec, "slcan:%s", link_get_address(adapter));
    TEST_ASSERT_NULL(link_open(spec, &odd, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "123456"), error.text);
    TEST_ASSERT_FALSE(error.is_environment);
    odd = (struct link_config){.bitrate = 500000, .fd = true, .data_bitrate = 2500000};
    TEST_ASSERT_NULL(link_open(spec, &odd, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "no data rate 2500000"), error.text);
    link_close(adapter);
}

/*
 * Python's client says C, S8, an empty command and O twice; a reply of one byte, a carriage return,
 * comes to each.
 */
static void test_an_slcan_adapter_is_generous_with_repeated_commands(void)
{
    static const char hello[] = "C\rS8\r\rO\rO\rt12320102\r";
    struct link_error error;
    struct wire_frame frame;
    char replies[64] = "";
    struct link *adapter = link_open("slcan:pty", &config, &error);
    TEST_ASSERT_NOT_NULL(adapter);
    FILE *computer = fopen(link_get_address(adapter), "r+");
    TEST_ASSERT_NOT_NULL(computer);
    TEST_ASSERT_FALSE(link_has_peer(adapter));
    TEST_ASSERT_EQUAL_UINT64(sizeof hello - 1, fwrite(hello, 1, sizeof hello - 1, computer));
    TEST_ASSERT_EQUAL_INT(0, fflush(computer));
    TEST_ASSERT_EQUAL_INT(LINK_READY, link_wait(adapter, link_clock_ns() + WAIT_NS));
    TEST_ASSERT_TRUE(link_has_peer(adapter));
    TEST_ASSERT_TRUE(link_receive(adapter, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x123, frame.id);
    TEST_ASSERT_EQUAL_UINT8(2, frame.length);
    TEST_ASSERT_EQUAL_UINT64(7, fread(replies, 1, 7, computer));
    TEST_ASSERT_EQUAL_STRING("\r\r\r\r\rz\r", replies);
    (void)fclose(computer);
    link_close(adapter);
}

static void open_channel_and_vanish(struct link *adapter, uint64_t departures)
{
    static const char hello[] = "O\rt12320102\r";
    struct wire_frame frame;
    int computer = open(link_get_address(adapter), O_RDWR | O_NOCTTY);
    TEST_ASSERT_EQUAL_INT(sizeof hello - 1, write(computer, hello, sizeof hello - 1));
    TEST_ASSERT_EQUAL_INT(LINK_READY, link_wait(adapter, link_clock_ns() + WAIT_NS));
    TEST_ASSERT_TRUE(link_receive(adapter, &frame));
    TEST_ASSERT_TRUE(link_has_peer(adapter));
    TEST_ASSERT_EQUAL_UINT64(departures, link_get_counts(adapter)->departures);
    (void)close(computer);
    TEST_ASSERT_FALSE(link_receive(adapter, &frame));
}

static void test_a_pseudo_terminal_hears_that_a_program_has_ended_without_a_word(void)
{
    struct link_error error;
    struct link *adapter = link_open("slcan:pty", &config, &error);
    TEST_ASSERT_NOT_NULL(adapter);
    TEST_ASSERT_TRUE(link_hears_departures(adapter));
    for (uint64_t departures = 0; departures < 3; departures++) {
        open_channel_and_vanish(adapter, departures);
        TEST_ASSERT_FALSE(link_has_peer(adapter));
        TEST_ASSERT_EQUAL_UINT64(departures + 1, link_get_counts(adapter)->departures);
        TEST_ASSERT_EQUAL_INT(LINK_TIMEOUT, link_wait(adapter, link_clock_ns()));
    }
    link_close(adapter);
}

/* The observer sees both directions, in order. */
static unsigned observed;

static void count_frame(void *context, const struct wire_frame *frame, uint64_t time_ns)
{
    (void)context;
    TEST_ASSERT_EQUAL_HEX32(0x100 + observed++, frame->id);
    TEST_ASSERT_GREATER_THAN_UINT64(0, time_ns);
}

static void test_an_observer_sees_what_is_sent_and_what_comes(void)
{
    char address[256], spec[300];
    struct link_error error;
    struct wire_frame frame = {.id = 0x100, .length = 1};
    int status;
    pid_t other = start_answering("slcan:pty", address, sizeof address);
    (void)snprintf(spec, sizeof spec, "slcan:%s", address);
    struct link *link = link_open(spec, &config, &error);
    TEST_ASSERT_NOT_NULL(link);
    observed = 0;
    link_observe(link, &(struct wire_listener){count_frame, NULL});
    for (unsigned i = 0; i < 10; i++, frame.id += 2) {
        TEST_ASSERT_TRUE(link_send(link, &frame));
        expect_answer(link, &frame);
    }
    TEST_ASSERT_EQUAL_UINT(20, observed);
    link_observe(link, NULL);
    frame = (struct wire_frame){.id = LAST_ID};
    TEST_ASSERT_TRUE(link_send(link, &frame));
    expect_answer(link, &frame);
    link_close(link);
    TEST_ASSERT_EQUAL_INT(other, waitpid(other, &status, 0));
}

static void test_a_bus_whose_other_side_has_gone_is_broken(void)
{
    char address[256], spec[300];
    struct link_error error;
    struct wire_frame last = {.id = LAST_ID, .length = 1};
    int status;
    pid_t other = start_answering("socketcand:listen:0", address, sizeof address);
    (void)snprintf(spec, sizeof spec, "socketcand:%s", address);
    struct link *link = link_open(spec, &config, &error);
    TEST_ASSERT_NOT_NULL(link);
    TEST_ASSERT_TRUE(link_send(link, &last));
    expect_answer(link, &last);
    TEST_ASSERT_EQUAL_INT(other, waitpid(other, &status, 0));
    TEST_ASSERT_EQUAL_INT(LINK_BROKEN, link_wait(link, link_clock_ns() + WAIT_NS));
    TEST_ASSERT_FALSE(link_send(link, &last));
    TEST_ASSERT_NOT_NULL(strstr(link_get_problem(link), "closed the connection"));
    link_close(link);
}

/* Nobody has looked since the other side has gone: sending meets it first. */
static void test_a_frame_for_a_bus_that_has_gone_is_lost_and_the_loss_is_told_by_waiting(void)
{
    char address[256], spec[300];
    struct link_error error;
    const struct can_frame frame = {.id = LAST_ID, .length = 1};
    int status;
    pid_t other = start_answering("slcan:listen:0", address, sizeof address);
    (void)snprintf(spec, sizeof spec, "slcan:%s", address);
    struct link *link = link_open(spec, &config, &error);
    TEST_ASSERT_NOT_NULL(link);
    const struct can_port port = link_get_port(link);
    TEST_ASSERT_TRUE(port.send(port.context, &frame));
    TEST_ASSERT_EQUAL_INT(other, waitpid(other, &status, 0));
    for (int i = 0; i < 10; i++)
        TEST_ASSERT_TRUE(port.send(port.context, &frame));
    while (link_wait(link, link_clock_ns() + WAIT_NS) == LINK_READY) {
        struct wire_frame answer;
        (void)link_receive(link, &answer);
    }
    TEST_ASSERT_EQUAL_INT(LINK_BROKEN, link_wait(link, link_clock_ns() + WAIT_NS));
    link_close(link);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_frame_for_a_bus_that_has_gone_is_lost_and_the_loss_is_told_by_waiting);
    RUN_TEST(test_slcan_carries_frames_over_a_pseudo_terminal);
    RUN_TEST(test_slcan_carries_frames_over_tcp);
    RUN_TEST(test_socketcand_carries_frames_between_client_and_server);
    RUN_TEST(test_a_text_that_names_no_bus_is_refused);
    RUN_TEST(test_a_bus_that_is_not_there_is_refused);
    RUN_TEST(test_a_bit_rate_that_adapters_do_not_know_is_refused);
    RUN_TEST(test_an_slcan_adapter_is_generous_with_repeated_commands);
    RUN_TEST(test_a_pseudo_terminal_hears_that_a_program_has_ended_without_a_word);
    RUN_TEST(test_an_observer_sees_what_is_sent_and_what_comes);
    RUN_TEST(test_a_bus_whose_other_side_has_gone_is_broken);
    return UNITY_END();
}
