/*
 * Two links on one SocketCAN interface: frames of every kind from each to the other, filters in the
 * kernel, and what happens when the interface goes down. The argument is an interface that this
 * program may switch off.
 */
#include "link/link.h"
#include "random_frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES  3000
#define WAIT_NS 20000000000u /* only a broken link waits as long */

static int failures;

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            (void)printf("FAILED: line %d: %s\n", __LINE__, #condition);                           \
            failures++;                                                                            \
        }                                                                                          \
    } while (0)

static uint64_t state = 1;

static struct link *open_link(const char *interface, const struct link_config *config)
{
    char spec[64];
    struct link_error error;
    (void)snprintf(spec, sizeof spec, "socketcan:%s", interface);
    struct link *link = link_open(spec, config, &error);
    if (link == NULL) {
        (void)printf("FAILED: %s\n", error.text);
        exit(1);
    }
    return link;
}

static bool receive(struct link *link, struct wire_frame *frame)
{
    return link_wait(link, link_clock_ns() + WAIT_NS) == LINK_READY && link_receive(link, frame);
}

static void carries_every_kind_of_frame(const char *interface)
{
    const struct link_config config = {.bitrate = 1000000, .fd = true};
    struct link *a = open_link(interface, &config), *b = open_link(interface, &config);
    for (unsigned i = 0; i < FRAMES; i++) {
        struct wire_frame sent = random_frame(&state), got = {0};
        struct link *from = random_below(&state, 2) ? a : b, *to = from == a ? b : a;
        CHECK(link_send(from, &sent));
        CHECK(receive(to, &got));
        CHECK(random_frame_is_same(&sent, &got));
        CHECK(!link_receive(from, &got)); /* one's own frames do not come back */
    }
    link_close(a);
    link_close(b);
}

/* Without CAN FD asked for, none is received: the firmware cannot be surprised by one. */
static void brings_no_fd_frame_unasked(const char *interface)
{
    struct link *fd = open_link(interface, &(struct link_config){.fd = true});
    struct link *classical = open_link(interface, &(struct link_config){.fd = false});
    struct wire_frame long_frame = {.id = 1, .flags = WIRE_FD, .length = 64};
    struct wire_frame short_frame = {.id = 2, .length = 1}, got = {0};
    CHECK(link_send(fd, &long_frame));
    CHECK(link_send(fd, &short_frame));
    CHECK(receive(classical, &got));
    CHECK(got.id == 2);
    link_close(fd);
    link_close(classical);
}

static void leaves_filtering_to_the_kernel(const char *interface)
{
    static const struct link_filter wanted[] = {{0x180, 0x780}, {0x700, 0x780}};
    struct link_config config = {.filters = wanted, .filter_count = 2};
    struct link *all = open_link(interface, &(struct link_config){0});
    struct link *some = open_link(interface, &config);
    unsigned expected = 0;
    struct wire_frame got = {0};
    for (unsigned id = 0; id < 0x800; id++) {
        struct wire_frame frame = {.id = id};
        CHECK(link_send(all, &frame));
        bool is_wanted = (id & 0x780) == 0x180 || (id & 0x780) == 0x700;
        expected += is_wanted;
        CHECK(!is_wanted || (receive(some, &got) && got.id == id));
    }
    CHECK(link_get_counts(some)->received == expected);
    link_close(all);
    link_close(some);
}

/* The firmware's port passes over what the firmware does not know. */
static void gives_the_firmware_its_own_kind_of_frame(const char *interface)
{
    const struct link_config config = {.fd = true};
    struct link *a = open_link(interface, &config), *b = open_link(interface, &config);
    struct can_port port = link_get_port(b);
    struct can_frame frame[2] = {0};
    struct wire_frame others[] = {{.id = 1, .flags = WIRE_EXTENDED},
                                  {.id = 2, .flags = WIRE_REMOTE, .length = 1},
                                  {.id = 3, .flags = WIRE_FD, .length = 12},
                                  {.id = 4, .length = 8}};
    for (unsigned i = 0; i < 4; i++)
        CHECK(link_send(a, &others[i]));
    for (unsigned i = 0; i < 2; i++)
        while (!port.receive(port.context, &frame[i]) &&
               link_wait(b, link_clock_ns() + WAIT_NS) == LINK_READY)
            continue;
    CHECK(frame[0].id == (CAN_REMOTE | 2) && frame[0].length == 1);
    CHECK(frame[1].id == 4 && frame[1].length == 8);
    CHECK(link_get_counts(b)->received == 4);
    link_close(a);
    link_close(b);
}

static void tells_that_the_interface_has_gone_down(const char *interface)
{
    char command[64];
    struct link_error error;
    struct link *link = open_link(interface, &(struct link_config){0});
    (void)snprintf(command, sizeof command, "ip link set %s down", interface);
    CHECK(system(command) == 0);
    CHECK(link_wait(link, link_clock_ns() + WAIT_NS) == LINK_BROKEN);
    CHECK(strstr(link_get_problem(link), "gone down") != NULL);
    CHECK(!link_send(link, &(struct wire_frame){.id = 1}));
    link_close(link);
    (void)snprintf(command, sizeof command, "socketcan:%s", interface);
    CHECK(link_open(command, &(struct link_config){0}, &error) == NULL);
    CHECK(error.is_environment && strstr(error.text, "is down") != NULL);
    CHECK(link_open("socketcan:nosuch0", &(struct link_config){0}, &error) == NULL);
    CHECK(error.is_environment && strstr(error.text, "no such interface") != NULL);
    (void)snprintf(command, sizeof command, "ip link set %s up", interface);
    CHECK(system(command) == 0);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    carries_every_kind_of_frame(argv[1]);
    brings_no_fd_frame_unasked(argv[1]);
    leaves_filtering_to_the_kernel(argv[1]);
    gives_the_firmware_its_own_kind_of_frame(argv[1]);
    tells_that_the_interface_has_gone_down(argv[1]);
    (void)printf("%d failures\n", failures);
    return failures > 0;
}
