/*
 * host/serve: who may connect, where programs are kept, and what passes between the two threads.
 */
#define _POSIX_C_SOURCE 200809L

#include "serve/allow_list.h"
#include "serve/exchange.h"
#include "serve/program_store.h"
#include "serve/serial_line.h"
#include "unity.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static bool may(const struct allow_list *list, const char *text)
{
    struct sockaddr_storage address = {.ss_family = AF_INET};
    struct sockaddr_in *four = (struct sockaddr_in *)&address;
    struct sockaddr_in6 *six = (struct sockaddr_in6 *)&address;

    if (inet_pton(AF_INET, text, &four->sin_addr) == 1)
        return allow_list_has(list, &address);
    address.ss_family = AF_INET6;
    TEST_ASSERT_EQUAL_INT(1, inet_pton(AF_INET6, text, &six->sin6_addr));
    return allow_list_has(list, &address);
}

static void test_an_empty_list_lets_everybody_in(void)
{
    const struct allow_list list = {0};

    TEST_ASSERT_TRUE(may(&list, "8.8.8.8"));
    TEST_ASSERT_TRUE(may(&list, "2001:db8::1"));
}

static void test_a_list_lets_in_whom_it_names(void)
{
    struct allow_list list = {0};

    TEST_ASSERT_TRUE(allow_list_add(&list, "192.168.1.0/25"));
    TEST_ASSERT_TRUE(allow_list_add(&list, "10.0.0.7"));
    TEST_ASSERT_TRUE(allow_list_add(&list, "2001:db8::/33"));
    TEST_ASSERT_TRUE(may(&list, "192.168.1.127"));
    TEST_ASSERT_FALSE(may(&list, "192.168.1.128"));
    TEST_ASSERT_TRUE(may(&list, "10.0.0.7"));
    TEST_ASSERT_FALSE(may(&list, "10.0.0.6"));
    TEST_ASSERT_TRUE(may(&list, "2001:db8:7fff::1"));
    TEST_ASSERT_FALSE(may(&list, "2001:db8:8000::1"));
}

/* As a listener on :: sees clients of IPv4. */
static void test_ipv4_within_ipv6_is_the_same_address(void)
{
    struct allow_list list = {0};

    TEST_ASSERT_TRUE(allow_list_add(&list, "192.168.1.0/24"));
    TEST_ASSERT_TRUE(may(&list, "::ffff:192.168.1.9"));
    TEST_ASSERT_FALSE(may(&list, "::ffff:192.168.2.9"));
}

static void test_what_is_no_address_is_refused(void)
{
    static const char *const wrong[] = {"",          "somewhere",         "1.2.3",   "1.2.3.4/33",
                                        "1.2.3.4/",  "1.2.3.4/-1",        "::1/129", "1.2.3.4/8x",
                                        "1.2.3.4.5", "1.2.3.4/4294967304"};
    struct allow_list list = {0};

    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        TEST_ASSERT_FALSE_MESSAGE(allow_list_add(&list, wrong[i]), wrong[i]);
    TEST_ASSERT_EQUAL_UINT(0, list.count);
}

static void test_a_serial_line_is_a_path_a_rate_and_a_parity(void)
{
    struct serial_settings settings;

    TEST_ASSERT_TRUE(serial_settings_read(&settings, "/dev/ttyUSB0"));
    TEST_ASSERT_EQUAL_UINT32(19200, settings.bauds);
    TEST_ASSERT_EQUAL_INT(SERIAL_EVEN, settings.parity);
    TEST_ASSERT_TRUE(serial_settings_read(&settings, "/dev/ttyUSB0,9600,none"));
    TEST_ASSERT_EQUAL_STRING("/dev/ttyUSB0", settings.path);
    TEST_ASSERT_EQUAL_UINT32(9600, settings.bauds);
    TEST_ASSERT_EQUAL_INT(SERIAL_NONE, settings.parity);
    TEST_ASSERT_FALSE(serial_settings_read(&settings, "/dev/ttyUSB0,9601"));
    TEST_ASSERT_FALSE(serial_settings_read(&settings, "/dev/ttyUSB0,9600,mark"));
    TEST_ASSERT_FALSE(serial_settings_read(&settings, ""));
}

static size_t read_file(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "rb");
    size_t length;

    if (file == NULL)
        return 0;
    length = fread(text, 1, size, file);
    (void)fclose(file);
    return length;
}

static void bring(struct program_store *store, const char *text)
{
    const struct panel_store staging = program_store_get_staging(store);

    TEST_ASSERT_TRUE(staging.begin(staging.context, (uint32_t)strlen(text)));
    TEST_ASSERT_TRUE(staging.write(staging.context, 0, (const uint8_t *)text, strlen(text)));
    TEST_ASSERT_TRUE(staging.prepare(staging.context));
}

static void test_a_program_is_in_its_file_when_it_is_placed_and_not_before(void)
{
    static struct program_store store;
    const struct panel_store staging = program_store_get_staging(&store);
    char text[32];
    struct source source;

    (void)unlink("stored.ngc");
    TEST_ASSERT_TRUE(program_store_open(&store, "stored.ngc"));
    TEST_ASSERT_FALSE(program_store_read(&store, &source));
    bring(&store, "G0 X1\n");
    TEST_ASSERT_EQUAL_UINT(0, read_file("stored.ngc", text, sizeof text));
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(staging.place(staging.context));
    TEST_ASSERT_EQUAL_UINT(6, read_file("stored.ngc", text, sizeof text));
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    TEST_ASSERT_EQUAL_INT(6, source.read(source.context, text, sizeof text));
    TEST_ASSERT_EQUAL_MEMORY("G0 X1\n", text, 6);
    bring(&store, "G0 X222\n");
    program_store_close(&store);
    TEST_ASSERT_EQUAL_UINT(6, read_file("stored.ngc", text, sizeof text));
    (void)unlink("stored.ngc");
}

static void test_a_folder_that_is_not_there_stores_nothing(void)
{
    static struct program_store store;
    const struct panel_store staging = program_store_get_staging(&store);

    TEST_ASSERT_TRUE(program_store_open(&store, "no/such/folder/p.ngc"));
    TEST_ASSERT_TRUE(staging.begin(staging.context, 3));
    TEST_ASSERT_FALSE(staging.write(staging.context, 2, (const uint8_t *)"ab", 2));
    TEST_ASSERT_FALSE(staging.prepare(staging.context));
    program_store_close(&store);
}

#define ORDERS 2000

static struct exchange exchange;
static atomic_bool is_done;
static atomic_uint wrong_orders;

/* The panel's side: each order must be seen in the snapshot that follows, whole. */
static void *give_orders(void *context)
{
    const struct panel_port port = exchange_get_port(&exchange);
    struct panel_snapshot snapshot;
    unsigned wrong = 0;

    (void)context;
    for (int64_t i = 1; i <= ORDERS; i++) {
        const struct panel_order order = {.count = 1, .item = {{REGISTER_JOG_FEED, i}}};

        wrong += port.order(port.context, &order) != PANEL_DONE;
        port.look(port.context, &snapshot);
        for (unsigned id = 0; id < REGISTER_COUNT; id++)
            wrong += snapshot.value[id] != i;
    }
    atomic_store(&is_done, true);
    atomic_store(&wrong_orders, wrong);
    return NULL;
}

static void show(int64_t value)
{
    struct panel_snapshot *snapshot = exchange_next_snapshot(&exchange);

    for (unsigned id = 0; id < REGISTER_COUNT; id++)
        snapshot->value[id] = (uint32_t)value;
    exchange_publish(&exchange);
}

static void test_an_order_is_answered_when_a_snapshot_shows_it(void)
{
    pthread_t panel;
    int64_t value = 0;

    TEST_ASSERT_TRUE(exchange_open(&exchange));
    atomic_store(&is_done, false);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&panel, NULL, give_orders, NULL));
    while (!atomic_load(&is_done)) {
        const struct panel_order *order = exchange_take_order(&exchange);

        if (order != NULL)
            value = order->item[0].value;
        show(value);
        if (order != NULL)
            exchange_answer(&exchange, PANEL_DONE);
    }
    TEST_ASSERT_EQUAL_INT(0, pthread_join(panel, NULL));
    TEST_ASSERT_EQUAL_UINT(0, atomic_load(&wrong_orders));
    exchange_close(&exchange);
}

static void test_an_order_that_nobody_takes_is_given_up(void)
{
    const struct panel_order order = {.count = 0};
    struct panel_port port;

    TEST_ASSERT_TRUE(exchange_open(&exchange));
    port = exchange_get_port(&exchange);
    TEST_ASSERT_EQUAL_INT(PANEL_TRY_AGAIN, port.order(port.context, &order));
    TEST_ASSERT_NULL(exchange_take_order(&exchange));
    TEST_ASSERT_FALSE(exchange_take_alive(&exchange));
    port.alive(port.context);
    TEST_ASSERT_TRUE(exchange_take_alive(&exchange));
    TEST_ASSERT_FALSE(exchange_take_alive(&exchange));
    exchange_close(&exchange);
}

static void test_a_program_that_is_streamed_is_read_as_far_as_it_has_come(void)
{
    static struct program_store store;
    const struct panel_store staging = program_store_get_staging(&store);
    static const char text[] = "G0 X1\nG0 X2\nM2";
    const uint8_t *bytes = (const uint8_t *)text;
    char buffer[64];
    struct source source;

    TEST_ASSERT_TRUE(program_store_open(&store, "streamed.ngc"));
    TEST_ASSERT_TRUE(staging.begin_stream(staging.context, sizeof text - 1));
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    TEST_ASSERT_EQUAL_INT(SOURCE_LATER, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(staging.write(staging.context, 0, bytes, 8));
    TEST_ASSERT_EQUAL_INT(6, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_EQUAL_INT(SOURCE_LATER, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(staging.write(staging.context, 8, bytes + 8, sizeof text - 9));
    TEST_ASSERT_EQUAL_INT(6, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_EQUAL_INT(SOURCE_LATER, source.read(source.context, buffer, sizeof buffer));
    staging.end_stream(staging.context, true);
    TEST_ASSERT_EQUAL_INT(2, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_EQUAL_INT(SOURCE_END, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(source.seek(source.context, 6));
    TEST_ASSERT_EQUAL_INT(8, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(staging.begin(staging.context, 4));
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    program_store_close(&store);
    TEST_ASSERT_EQUAL_INT(0, remove("streamed.ngc"));
}

static void test_a_stream_that_is_given_up_cannot_be_read(void)
{
    static struct program_store store;
    const struct panel_store staging = program_store_get_staging(&store);
    char buffer[64];
    struct source source;

    TEST_ASSERT_TRUE(program_store_open(&store, NULL));
    TEST_ASSERT_TRUE(staging.begin_stream(staging.context, 10));
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    staging.end_stream(staging.context, false);
    TEST_ASSERT_EQUAL_INT(SOURCE_ERROR, source.read(source.context, buffer, sizeof buffer));
    program_store_close(&store);
}

static void test_a_stream_that_is_begun_leaves_the_program_that_is_read(void)
{
    static struct program_store store;
    const struct panel_store staging = program_store_get_staging(&store);
    char buffer[64];
    struct source source;

    TEST_ASSERT_TRUE(program_store_open(&store, NULL));
    TEST_ASSERT_TRUE(staging.begin_stream(staging.context, 20));
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    TEST_ASSERT_TRUE(staging.write(staging.context, 0, (const uint8_t *)"G0 X1\nG0 X2\n", 12));
    TEST_ASSERT_EQUAL_INT(12, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(staging.begin_stream(staging.context, 4));
    TEST_ASSERT_EQUAL_INT(SOURCE_ERROR, source.read(source.context, buffer, sizeof buffer));
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    TEST_ASSERT_EQUAL_INT(SOURCE_ERROR, source.read(source.context, buffer, sizeof buffer));
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(program_store_read(&store, &source));
    TEST_ASSERT_TRUE(staging.write(staging.context, 0, (const uint8_t *)"M2\n", 3));
    TEST_ASSERT_EQUAL_INT(3, source.read(source.context, buffer, sizeof buffer));
    program_store_close(&store);
}

static void test_a_program_that_is_adopted_twice_is_the_one_before(void)
{
    static struct program_store store;
    const char *text;
    size_t size;

    TEST_ASSERT_TRUE(program_store_open(&store, NULL));
    TEST_ASSERT_TRUE(program_store_set(&store, "M2\n", 3));
    bring(&store, "G0 X222\n");
    program_store_adopt(&store);
    program_store_adopt(&store);
    TEST_ASSERT_TRUE(program_store_get(&store, &text, &size));
    TEST_ASSERT_EQUAL_UINT(3, size);
    TEST_ASSERT_EQUAL_MEMORY("M2\n", text, 3);
    program_store_close(&store);
}

static void test_what_a_power_cut_has_left_beside_the_program_is_removed_at_start(void)
{
    static struct program_store store, next;
    char text[32];

    TEST_ASSERT_TRUE(program_store_open(&store, "cut.ngc"));
    bring(&store, "G0 X1\n");
    TEST_ASSERT_EQUAL_UINT(6, read_file(store.aside, text, sizeof text));
    TEST_ASSERT_TRUE(program_store_open(&next, "cut.ngc"));
    TEST_ASSERT_EQUAL_UINT(0, read_file(store.aside, text, sizeof text));
    program_store_close(&next);
    program_store_close(&store);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_list_lets_everybody_in);
    RUN_TEST(test_a_list_lets_in_whom_it_names);
    RUN_TEST(test_ipv4_within_ipv6_is_the_same_address);
    RUN_TEST(test_what_is_no_address_is_refused);
    RUN_TEST(test_a_serial_line_is_a_path_a_rate_and_a_parity);
    RUN_TEST(test_a_program_is_in_its_file_when_it_is_placed_and_not_before);
    RUN_TEST(test_a_folder_that_is_not_there_stores_nothing);
    RUN_TEST(test_an_order_is_answered_when_a_snapshot_shows_it);
    RUN_TEST(test_an_order_that_nobody_takes_is_given_up);
    RUN_TEST(test_a_program_that_is_streamed_is_read_as_far_as_it_has_come);
    RUN_TEST(test_a_stream_that_is_given_up_cannot_be_read);
    RUN_TEST(test_a_stream_that_is_begun_leaves_the_program_that_is_read);
    RUN_TEST(test_a_program_that_is_adopted_twice_is_the_one_before);
    RUN_TEST(test_what_a_power_cut_has_left_beside_the_program_is_removed_at_start);
    return UNITY_END();
}
