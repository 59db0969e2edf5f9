/*
 * What the panel lets anybody read, and how it slows down who guesses its password.
 */
#include "panel_bench.h"

#define PASSWORD 4711

/* Panels that merge what they read do not know of gaps. */
static void test_gaps_between_registers_read_as_0(void)
{
    const struct modbus_map map = takt_panel_client_map(&one);

    start_with(PASSWORD);
    shown.value[REGISTER_HOMED] = 7;
    shown.value[REGISTER_POSITION_X] = 12345;
    memset(data, 0xFF, sizeof data);
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, map.read(map.context, MODBUS_INPUTS, 58, 4, data));
    TEST_ASSERT_EQUAL_UINT16(7, modbus_read16(data));
    TEST_ASSERT_EQUAL_UINT16(0, modbus_read16(data + 2));
    TEST_ASSERT_EQUAL_UINT16(12345, modbus_read16(data + 6));
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, map.read(map.context, MODBUS_COILS, 13, 3, data));
    TEST_ASSERT_EQUAL_UINT8(0, data[0]);
}

/* The cycle in which the next password is looked at, from the last one on. */
static unsigned cycles_of_silence(void)
{
    const uint32_t first = shown.value[REGISTER_CYCLES];

    while (write_row(&other, REGISTER_PASSWORD, 1) == MODBUS_BUSY)
        shown.value[REGISTER_CYCLES] += 10;
    return shown.value[REGISTER_CYCLES] - first;
}

static void test_wrong_passwords_make_all_clients_wait_longer_and_longer(void)
{
    start_with(PASSWORD);
    shown.value[REGISTER_CYCLES] = UINT32_MAX - 500; /* wraps on the way */
    TEST_ASSERT_EQUAL_UINT(0, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(1000, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(2000, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(4000, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(8000, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(16000, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(16000, cycles_of_silence());
    TEST_ASSERT_EQUAL_INT(MODBUS_BUSY, write_row(&one, REGISTER_PASSWORD, PASSWORD));
    shown.value[REGISTER_CYCLES] += 16000;
    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, write_row(&one, REGISTER_PASSWORD, PASSWORD));
    TEST_ASSERT_EQUAL_UINT(0, cycles_of_silence());
    TEST_ASSERT_EQUAL_UINT(1000, cycles_of_silence());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_gaps_between_registers_read_as_0);
    RUN_TEST(test_wrong_passwords_make_all_clients_wait_longer_and_longer);
    return UNITY_END();
}
