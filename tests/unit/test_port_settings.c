/* Settings through the panel's mailbox into flash, as a client on Modbus brings them. */
#include "base/crc32.h"
#include "modbus/crc.h"
#include "panel/panel.h"
#include "port/settings_upload.h"
#include "unity.h"

#include <string.h>

#define SECTOR_BYTES 16384U

static uint64_t memory[FLASH_SECTORS][SECTOR_BYTES / 8];
static bool refuses;
static struct store store;
static struct settings_upload upload;
static struct panel panel;
static struct panel_client client;
static struct modbus_map map;
static bool drives_are_off;
static char logged[256];
static uint8_t settings[8192];
static uint32_t size;

static bool erase(void *context, unsigned sector)
{
    (void)context;
    if (!refuses)
        memset(memory[sector], 0xFF, SECTOR_BYTES);
    return !refuses;
}

static bool program_words(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                          uint32_t words)
{
    uint8_t *to = (uint8_t *)memory[sector] + offset;

    (void)context;
    for (uint32_t i = 0; i < words * FLASH_WORD_BYTES; i++)
        to[i] &= bytes[i];
    return memcmp(to, bytes, (size_t)words * FLASH_WORD_BYTES) == 0;
}

static bool may_load(void *context)
{
    (void)context;
    return drives_are_off;
}

static struct correction_tables *lend_tables(void *context)
{
    static struct correction_tables tables;

    (void)context;
    return &tables;
}

static void write_log(void *context, const char *text)
{
    (void)context;
    (void)strncpy(logged, text, sizeof logged - 1);
}

static void look(void *context, struct panel_snapshot *snapshot)
{
    (void)context;
    memset(snapshot, 0, sizeof *snapshot);
    snapshot->value[REGISTER_STATE] = PANEL_EMERGENCY;
}

static enum panel_verdict order(void *context, const struct panel_order *given)
{
    (void)context;
    (void)given;
    return PANEL_WRONG_STATE;
}

static void alive(void *context)
{
    (void)context;
}

/* A store of programs that takes nothing. */
static bool no_room(void *context, uint32_t bytes)
{
    (void)context;
    (void)bytes;
    return false;
}

static void start(void)
{
    const struct flash_port flash = {
        .sector_bytes = SECTOR_BYTES,
        .sector = {(const uint8_t *)memory[0], (const uint8_t *)memory[1]},
        .erase = erase,
        .program = program_words};
    const struct settings_upload_port port = {
        .may_load = may_load, .borrow = lend_tables, .log = write_log};
    struct panel_config config = {.port = {look, order, alive, NULL}, .store = {.begin = no_room}};

    takt_store_open(&store, &flash);
    config.settings = takt_settings_upload_open(&upload, &store, &port);
    takt_panel_init(&panel, &config);
    takt_panel_client_enter(&client, &panel);
    map = takt_panel_client_map(&client);
}

static void pack(uint32_t cycle_us)
{
    struct machine machine;

    takt_machine_set_default(&machine);
    machine.cycle_us = cycle_us;
    size = (uint32_t)takt_settings_pack(&machine, NULL, NULL, settings, sizeof settings);
}

void setUp(void)
{
    memset(memory, 0xFF, sizeof memory);
    refuses = false;
    drives_are_off = true;
    logged[0] = '\0';
    start();
    pack(1000);
}

void tearDown(void)
{
}

static enum modbus_exception set(enum panel_id id, uint32_t value)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const uint8_t words[] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                             (uint8_t)value};

    return map.write(map.context, row->table, row->address, row->words,
                     words + (row->words == 2 ? 0 : 2));
}

static enum modbus_exception send_chunk(uint32_t offset)
{
    const uint32_t left = size - offset;
    const uint16_t length = (uint16_t)(left < PANEL_CHUNK_MAX ? left : PANEL_CHUNK_MAX);
    uint8_t words[8 + PANEL_CHUNK_MAX] = {0};

    modbus_write16(words, (uint16_t)(offset >> 16));
    modbus_write16(words + 2, (uint16_t)offset);
    modbus_write16(words + 4, length);
    modbus_write16(words + 6, takt_crc16(settings + offset, length));
    memcpy(words + 8, settings + offset, length);
    return map.write(map.context, MODBUS_HOLDINGS,
                     takt_panel_registers[REGISTER_UPLOAD_OFFSET].address, sizeof words / 2, words);
}

static enum modbus_exception begin(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_SETTINGS));
    TEST_ASSERT_EQUAL(MODBUS_GOOD, set(REGISTER_UPLOAD_SIZE, size));
    TEST_ASSERT_EQUAL(MODBUS_GOOD,
                      set(REGISTER_UPLOAD_CRC, takt_crc32_add(CRC32_START, settings, size)));
    return set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_BEGIN);
}

static void send_all(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, begin());
    for (uint32_t offset = 0; offset < size; offset += PANEL_CHUNK_MAX)
        TEST_ASSERT_EQUAL(MODBUS_GOOD, send_chunk(offset));
}

static enum modbus_exception bring(void)
{
    send_all();
    return set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT);
}

static void expect_reason(const char *reason)
{
    char text[PANEL_ALARM_TEXT_MAX + 1] = "";
    const struct panel_register *row = &takt_panel_registers[REGISTER_UPLOAD_TEXT];

    TEST_ASSERT_EQUAL(MODBUS_GOOD,
                      map.read(map.context, row->table, row->address, row->words, (uint8_t *)text));
    TEST_ASSERT_EQUAL_STRING(reason, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(logged, reason), logged);
}

/* After the next start. */
static void expect_cycle(uint32_t cycle_us)
{
    static struct correction_tables tables;
    struct diagnostic wrong;
    struct machine machine;
    const uint8_t *bytes;
    uint32_t length;

    start();
    TEST_ASSERT_TRUE(takt_store_get(&store, &bytes, &length));
    TEST_ASSERT_TRUE(takt_settings_read(bytes, length, &machine, &tables, NULL, &wrong));
    TEST_ASSERT_EQUAL(cycle_us, machine.cycle_us);
}

static void test_settings_that_are_brought_count_from_the_next_start_on(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    expect_reason("");
    TEST_ASSERT_EQUAL_STRING("settings stored: they count from the next start on", logged);
    expect_cycle(1000);
    pack(2000);
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    expect_cycle(2000);
}

static void test_damaged_settings_are_refused_with_the_reason_and_the_old_ones_stay(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    settings[100] ^= 1; /* the mailbox's own CRCs are right */
    TEST_ASSERT_EQUAL(MODBUS_VALUE, bring());
    expect_reason("the settings are damaged: their checksum is wrong");
    expect_cycle(1000);
}

static void test_settings_out_of_range_are_refused_with_the_reason(void)
{
    pack(50);
    TEST_ASSERT_EQUAL(MODBUS_VALUE, bring());
    expect_reason("setting cycle_us is out of range: 50");
    pack(1000);
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    expect_reason("");
}

static void test_nothing_is_written_while_drives_are_on(void)
{
    drives_are_off = false;
    TEST_ASSERT_EQUAL(MODBUS_STATE, begin());
    expect_reason("settings are taken while the drives are off: press emergency stop first");
    drives_are_off = true;
    TEST_ASSERT_EQUAL(MODBUS_GOOD, begin());
    TEST_ASSERT_EQUAL(MODBUS_GOOD, send_chunk(0));
    drives_are_off = false;
    TEST_ASSERT_EQUAL(MODBUS_VALUE, send_chunk(PANEL_CHUNK_MAX));
}

static void test_settings_that_have_come_do_not_count_while_drives_are_on(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    pack(2000);
    send_all();
    drives_are_off = false;
    TEST_ASSERT_EQUAL(MODBUS_VALUE, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
    expect_reason("settings are taken while the drives are off: press emergency stop first");
    expect_cycle(1000);
}

static void test_settings_that_do_not_fit_are_refused(void)
{
    size = SECTOR_BYTES;
    TEST_ASSERT_EQUAL(MODBUS_GOOD, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_SETTINGS));
    TEST_ASSERT_EQUAL(MODBUS_GOOD, set(REGISTER_UPLOAD_SIZE, size));
    TEST_ASSERT_EQUAL(MODBUS_STATE, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_BEGIN));
    expect_reason("these settings are larger than the memory for them");
}

static void test_a_flash_that_refuses_is_told(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    TEST_ASSERT_EQUAL(MODBUS_GOOD, bring());
    refuses = true;
    TEST_ASSERT_EQUAL(MODBUS_STATE, begin());
    expect_reason("the memory for settings cannot be erased");
    expect_cycle(1000);
}

static void test_an_upload_goes_on_after_its_client_was_lost_and_not_as_one_of_another_kind(void)
{
    TEST_ASSERT_EQUAL(MODBUS_GOOD, begin());
    TEST_ASSERT_EQUAL(MODBUS_GOOD, send_chunk(0));
    TEST_ASSERT_EQUAL(MODBUS_GOOD, begin());
    TEST_ASSERT_EQUAL(PANEL_CHUNK_MAX, panel.upload.received);
    TEST_ASSERT_EQUAL(MODBUS_GOOD, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PROGRAM));
    TEST_ASSERT_EQUAL(MODBUS_VALUE, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL(MODBUS_GOOD, begin());
    TEST_ASSERT_EQUAL(0, panel.upload.received);
}

static void test_a_panel_without_a_place_for_settings_refuses_them(void)
{
    panel.config.settings = (struct panel_store){0};
    TEST_ASSERT_EQUAL(MODBUS_VALUE, begin());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_settings_that_are_brought_count_from_the_next_start_on);
    RUN_TEST(test_damaged_settings_are_refused_with_the_reason_and_the_old_ones_stay);
    RUN_TEST(test_settings_out_of_range_are_refused_with_the_reason);
    RUN_TEST(test_nothing_is_written_while_drives_are_on);
    RUN_TEST(test_settings_that_have_come_do_not_count_while_drives_are_on);
    RUN_TEST(test_settings_that_do_not_fit_are_refused);
    RUN_TEST(test_a_flash_that_refuses_is_told);
    RUN_TEST(test_an_upload_goes_on_after_its_client_was_lost_and_not_as_one_of_another_kind);
    RUN_TEST(test_a_panel_without_a_place_for_settings_refuses_them);
    return UNITY_END();
}
