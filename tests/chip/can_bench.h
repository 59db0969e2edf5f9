/*
 * What tests of the CAN drivers share: frames with numbers, sent and seen on the model of the bus.
 */
#ifndef TAKT_TESTS_CAN_BENCH_H
#define TAKT_TESTS_CAN_BENCH_H

#include "can_model.h"
#include "chip_model.h"
#include "stm32/can_controller.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static struct can_controller can;
static struct can_port port;

/* As the processor does: an interrupt comes as long as it is asked for. */
static inline void interrupt(void)
{
    for (int i = 0; i < 10 && (can_model_asks_sent() || can_model_asks_received()); i++) {
        if (can_model_asks_sent())
            takt_can_controller_interrupt_sent(&can);
        if (can_model_asks_received())
            takt_can_controller_interrupt_received(&can);
    }
    TEST_ASSERT_FALSE_MESSAGE(can_model_asks_sent() || can_model_asks_received(),
                              "an interrupt is never served");
}

static inline bool open_for(unsigned nodes, const uint8_t *node)
{
    const struct can_config config = {
        .clock_hz = can_model_clock_hz, .rates = {1000000, 0}, .nodes = nodes, .node = node};
    const bool good = takt_can_controller_open(&can, &config);

    port = takt_can_controller_get_port(&can);
    return good;
}

void setUp(void)
{
    chip_model_reset();
    TEST_ASSERT_TRUE(open_for(0, NULL));
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
    TEST_ASSERT_EQUAL(0, chip_model_locks());
}

static inline struct can_frame numbered(unsigned id, unsigned number)
{
    return (struct can_frame){
        .id = (uint16_t)id,
        .length = 8,
        .data = {(uint8_t)number, (uint8_t)(number >> 8), 0x55, 1, 2, 3, 4, (uint8_t)id}};
}

static inline bool send(unsigned id, unsigned number)
{
    const struct can_frame frame = numbered(id, number);

    return port.send(port.context, &frame);
}

/* The next frame on the bus, and the interrupts after it. */
static inline struct can_frame transfer(void)
{
    struct can_frame frame;

    TEST_ASSERT_TRUE_MESSAGE(can_model_transfer(&frame), "nothing is sent");
    interrupt();
    return frame;
}

static inline void expect(unsigned id, unsigned number)
{
    const struct can_frame frame = transfer(), expected = numbered(id, number);

    TEST_ASSERT_EQUAL_HEX(expected.id, frame.id);
    TEST_ASSERT_EQUAL_MEMORY(expected.data, frame.data, 8);
    TEST_ASSERT_EQUAL(8, frame.length);
}

static inline void expect_silence(void)
{
    struct can_frame frame;

    TEST_ASSERT_FALSE(can_model_begin(&frame));
}

#endif
