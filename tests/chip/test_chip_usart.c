/* The panel's serial line with its RS-485 driver, and the log's ring. */
#include "chip/usart_registers.h"
#include "chip_model.h"
#include "stm32/log_ring.h"
#include "stm32/usart.h"
#include "unity.h"
#include "usart_model.h"

#include <string.h>

#define DRIVER   1U
#define GAP_US   1750U
#define CLOCK_HZ 42000000U

static struct usart usart;
static uint8_t heard[512];
static size_t heard_count;
static uint32_t heard_us, now_us;

static void take(void *context, uint8_t byte, uint32_t at_us)
{
    TEST_ASSERT_EQUAL_PTR(&usart, context);
    heard[heard_count++] = byte;
    heard_us = at_us;
}

static struct usart_config config_for(uint32_t bauds, enum usart_parity parity)
{
    return (struct usart_config){.base = USART_USART2,
                                 .clock_hz = CLOCK_HZ,
                                 .bauds = bauds,
                                 .parity = parity,
                                 .has_driver = true,
                                 .driver = {GPIO_A, DRIVER},
                                 .gap_us = GAP_US,
                                 .take = take,
                                 .context = &usart};
}

/* The clock of the ports is in the model of the clocks. */
void setUp(void)
{
    const struct usart_config config = config_for(115200, USART_PARITY_EVEN);

    chip_model_reset();
    heard_count = 0;
    now_us = 0xFFFFFF00U; /* wraps within the test */
    TEST_ASSERT_TRUE(takt_usart_open(&usart, &config));
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
    TEST_ASSERT_EQUAL(0, chip_model_locks());
}

static void interrupt(void)
{
    for (int i = 0; i < 4 && usart_model_asks(); i++)
        takt_usart_interrupt(&usart, now_us);
    TEST_ASSERT_FALSE_MESSAGE(usart_model_asks(), "an interrupt is never served");
}

/* Characters of 95 us. */
static void run(unsigned characters)
{
    for (unsigned i = 0; i < characters; i++) {
        now_us += 95;
        usart_model_shift();
        interrupt();
        takt_usart_poll(&usart, now_us);
        interrupt();
    }
}

static void hear(uint8_t byte, uint32_t errors)
{
    now_us += 95;
    usart_model_hear(byte, errors);
    interrupt();
}

static void test_the_line_listens_until_it_sends(void)
{
    TEST_ASSERT_TRUE(gpio_model_is_output(DRIVER));
    TEST_ASSERT_FALSE(gpio_model_pin(DRIVER));
    for (unsigned i = 0; i < 256; i++)
        hear((uint8_t)i, 0);
    TEST_ASSERT_EQUAL(256, heard_count);
    for (unsigned i = 0; i < 256; i++)
        TEST_ASSERT_EQUAL(i, heard[i]);
    TEST_ASSERT_EQUAL(now_us, heard_us);
}

static void test_rates_are_within_two_percent_or_refused(void)
{
    static const uint32_t rates[] = {9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600};

    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        const struct usart_config config = config_for(rates[i], USART_PARITY_NONE);

        chip_model_reset();
        TEST_ASSERT_TRUE(takt_usart_open(&usart, &config));
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * rates[i], rates[i],
                                  (double)CLOCK_HZ / usart_model_divider());
    }
    TEST_ASSERT_FALSE(takt_usart_open(&usart, &(struct usart_config){.clock_hz = CLOCK_HZ}));
    TEST_ASSERT_FALSE(
        takt_usart_open(&usart, &(struct usart_config){.clock_hz = CLOCK_HZ, .bauds = 4000000}));
}

static void test_parity_makes_nine_bits(void)
{
    const struct usart_config none = config_for(19200, USART_PARITY_NONE),
                              odd = config_for(19200, USART_PARITY_ODD);
    const uint32_t mask = USART_CR1_PARITY | USART_CR1_9_BITS | USART_CR1_ODD;

    TEST_ASSERT_EQUAL_HEX(USART_CR1_PARITY | USART_CR1_9_BITS, usart_model_control() & mask);
    TEST_ASSERT_TRUE(takt_usart_open(&usart, &odd));
    TEST_ASSERT_EQUAL_HEX(mask, usart_model_control() & mask);
    TEST_ASSERT_TRUE(takt_usart_open(&usart, &none));
    TEST_ASSERT_EQUAL_HEX(0, usart_model_control() & mask);
}

static void test_a_reply_comes_after_the_gap_and_the_driver_is_on_for_all_of_its_bits(void)
{
    uint8_t reply[USART_SEND_MAX];

    for (unsigned i = 0; i < sizeof reply; i++)
        reply[i] = (uint8_t)(i * 7);
    hear(1, 0);
    TEST_ASSERT_TRUE(takt_usart_send(&usart, reply, sizeof reply));
    run(GAP_US / 95 - 1);
    TEST_ASSERT_FALSE_MESSAGE(gpio_model_pin(DRIVER), "before the gap is over");
    run(sizeof reply + 20);
    TEST_ASSERT_EQUAL(sizeof reply, usart_model.count);
    TEST_ASSERT_EQUAL_MEMORY(reply, usart_model.sent, sizeof reply);
    for (unsigned i = 0; i < sizeof reply; i++)
        TEST_ASSERT_TRUE_MESSAGE(usart_model.driven[i], "the driver is off at a byte's last bit");
    TEST_ASSERT_FALSE(gpio_model_pin(DRIVER));
    TEST_ASSERT_TRUE_MESSAGE(takt_usart_send(&usart, reply, 1), "ready for the next");
}

static void test_a_byte_between_starts_the_gap_anew(void)
{
    hear(1, 0);
    TEST_ASSERT_TRUE(takt_usart_send(&usart, (const uint8_t *)"x", 1));
    run(10);
    hear(2, 0);
    run(10);
    TEST_ASSERT_FALSE(gpio_model_pin(DRIVER));
    run(10);
    TEST_ASSERT_EQUAL(1, usart_model.count);
}

static void test_it_does_not_hear_itself(void)
{
    TEST_ASSERT_TRUE(takt_usart_send(&usart, (const uint8_t *)"hello", 5));
    run(40);
    heard_count = 0;
    TEST_ASSERT_TRUE(takt_usart_send(&usart, (const uint8_t *)"hello", 5));
    run(2);
    TEST_ASSERT_TRUE(gpio_model_pin(DRIVER));
    hear('h', 0);
    run(20);
    TEST_ASSERT_EQUAL(0, heard_count);
    hear('!', 0);
    TEST_ASSERT_EQUAL(1, heard_count);
}

/* Its first byte and the end of the last one sent are seen in one look at the status. */
static void test_an_answer_that_comes_at_once_is_heard(void)
{
    TEST_ASSERT_TRUE(takt_usart_send(&usart, (const uint8_t *)"xy", 2));
    for (int i = 0; i < 100 && !gpio_model_pin(DRIVER); i++)
        run(1);
    usart_model_shift();
    interrupt();
    usart_model_shift();
    usart_model_hear('A', 0);
    interrupt();
    TEST_ASSERT_EQUAL(2, usart_model.count);
    TEST_ASSERT_EQUAL(1, heard_count);
    TEST_ASSERT_EQUAL('A', heard[0]);
}

static void test_damaged_bytes_are_dropped_and_counted(void)
{
    hear(1, USART_SR_PARITY);
    hear(2, USART_SR_FRAMING);
    hear(3, USART_SR_NOISE);
    hear(4, 0);
    TEST_ASSERT_EQUAL(1, heard_count);
    TEST_ASSERT_EQUAL(4, heard[0]);
    TEST_ASSERT_EQUAL(3, usart.counts.damaged);
}

static void test_an_overrun_is_counted_and_ends(void)
{
    usart_model_hear(1, 0);
    usart_model_hear(2, 0);
    interrupt();
    TEST_ASSERT_EQUAL(1, usart.counts.overruns);
    TEST_ASSERT_EQUAL(1, heard_count);
    hear(3, 0);
    TEST_ASSERT_EQUAL(3, heard[1]);
}

static void test_a_second_reply_is_refused_and_so_is_one_that_is_too_long(void)
{
    static const uint8_t longer[USART_SEND_MAX + 1];

    TEST_ASSERT_FALSE(takt_usart_send(&usart, longer, sizeof longer));
    TEST_ASSERT_FALSE(takt_usart_send(&usart, longer, 0));
    TEST_ASSERT_TRUE(takt_usart_send(&usart, longer, 3));
    TEST_ASSERT_FALSE(takt_usart_send(&usart, longer, 3));
    TEST_ASSERT_EQUAL(3, usart.counts.lost);
}

static void test_a_shout_ends_even_when_the_line_is_stuck(void)
{
    usart_model.is_stuck = true;
    takt_usart_shout(&usart, "help");
    TEST_ASSERT_LESS_THAN(2000000, chip_model_reads());
    TEST_ASSERT_FALSE(gpio_model_pin(DRIVER));
}

/* ---- the log ---- */

static struct log_ring ring;

static void test_lines_of_the_log_come_out_whole_and_in_order(void)
{
    const uint8_t *bytes;

    memset(&ring, 0, sizeof ring);
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, "one"));
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, "two"));
    TEST_ASSERT_EQUAL(7, takt_log_ring_take(&ring, &bytes, 7));
    TEST_ASSERT_EQUAL_MEMORY("one\r\ntw", bytes, 7);
    TEST_ASSERT_EQUAL(3, takt_log_ring_take(&ring, &bytes, 50));
    TEST_ASSERT_EQUAL_MEMORY("o\r\n", bytes, 3);
    TEST_ASSERT_EQUAL(0, takt_log_ring_take(&ring, &bytes, 50));
}

static void test_a_line_without_room_is_left_out_whole(void)
{
    static char line[LOG_RING_MAX];
    const uint8_t *bytes;

    memset(&ring, 0, sizeof ring);
    memset(line, 'x', LOG_RING_MAX - 1);
    TEST_ASSERT_FALSE(takt_log_ring_put(&ring, line));
    line[LOG_RING_MAX - 2] = '\0';
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, line));
    TEST_ASSERT_FALSE(takt_log_ring_put(&ring, ""));
    TEST_ASSERT_EQUAL(2, ring.left_out);
    TEST_ASSERT_EQUAL(1, takt_log_ring_take(&ring, &bytes, 1));
    TEST_ASSERT_EQUAL(1, takt_log_ring_take(&ring, &bytes, 1));
    TEST_ASSERT_FALSE_MESSAGE(takt_log_ring_put(&ring, ""), "one byte may still be on its way");
    TEST_ASSERT_EQUAL(1, takt_log_ring_take(&ring, &bytes, 1));
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, ""));
}

static void test_a_line_over_the_end_of_the_ring_comes_in_two_pieces(void)
{
    static char line[LOG_RING_MAX];
    const uint8_t *bytes;

    memset(&ring, 0, sizeof ring);
    memset(line, 'x', LOG_RING_MAX - 4);
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, line));
    TEST_ASSERT_EQUAL(LOG_RING_MAX - 2, takt_log_ring_take(&ring, &bytes, LOG_RING_MAX));
    TEST_ASSERT_EQUAL(0, takt_log_ring_take(&ring, &bytes, LOG_RING_MAX));
    TEST_ASSERT_TRUE(takt_log_ring_put(&ring, "ab"));
    TEST_ASSERT_EQUAL(2, takt_log_ring_take(&ring, &bytes, 50));
    TEST_ASSERT_EQUAL_MEMORY("ab", bytes, 2);
    TEST_ASSERT_EQUAL(2, takt_log_ring_take(&ring, &bytes, 50));
    TEST_ASSERT_EQUAL_MEMORY("\r\n", bytes, 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_line_listens_until_it_sends);
    RUN_TEST(test_rates_are_within_two_percent_or_refused);
    RUN_TEST(test_parity_makes_nine_bits);
    RUN_TEST(test_a_reply_comes_after_the_gap_and_the_driver_is_on_for_all_of_its_bits);
    RUN_TEST(test_a_byte_between_starts_the_gap_anew);
    RUN_TEST(test_it_does_not_hear_itself);
    RUN_TEST(test_an_answer_that_comes_at_once_is_heard);
    RUN_TEST(test_damaged_bytes_are_dropped_and_counted);
    RUN_TEST(test_an_overrun_is_counted_and_ends);
    RUN_TEST(test_a_second_reply_is_refused_and_so_is_one_that_is_too_long);
    RUN_TEST(test_a_shout_ends_even_when_the_line_is_stuck);
    RUN_TEST(test_lines_of_the_log_come_out_whole_and_in_order);
    RUN_TEST(test_a_line_without_room_is_left_out_whole);
    RUN_TEST(test_a_line_over_the_end_of_the_ring_comes_in_two_pieces);
    return UNITY_END();
}
