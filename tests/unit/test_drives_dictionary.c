/*
 * Data sheets of other makers, read into a virtual drive: every way in which the tools write them,
 * and any bytes.
 */
#include "drives/dictionary_read.h"
#include "lone_drive.h"

#include <stdlib.h>

static struct lone_drive lone;
static struct dictionary sheet;
static struct dictionary_problem wrong;

#define DRIVE                                                                                      \
    "[1000]\nDataType=7\nAccessType=ro\n[6040]\nDataType=0x0006\nAccessType=rww\nPDOMapping=1\n"

void setUp(void)
{
    memset(&sheet, 0, sizeof sheet);
}

void tearDown(void)
{
    dictionary_free(&sheet);
}

static void read_sheet(const char *text)
{
    TEST_ASSERT_TRUE_MESSAGE(dictionary_read(&sheet, text, strlen(text), &wrong), wrong.text);
}

static const struct object_row *row_of(uint16_t index, uint8_t sub)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(&sheet, index, sub, &has_index);
    TEST_ASSERT_NOT_NULL(row);
    return row;
}

static void test_keys_and_words_may_be_written_in_any_way(void)
{
    read_sheet(
        "; a comment\r\n[ 6041 ]\r\n datatype = 6 \r\nACCESSTYPE=RO\r\nPdoMapping=0x1\r\n" DRIVE);
    TEST_ASSERT_EQUAL_UINT(OBJECT_UNSIGNED16, row_of(0x6041, 0)->type);
    TEST_ASSERT_EQUAL_UINT(OBJECT_RO, row_of(0x6041, 0)->access);
    TEST_ASSERT_TRUE(row_of(0x6041, 0)->flags & OBJECT_TO_TPDO);
    TEST_ASSERT_FALSE(row_of(0x6041, 0)->flags & OBJECT_TO_RPDO);
}

static void test_a_semicolon_behind_a_space_begins_a_comment(void)
{
    read_sheet(DRIVE "[6502] ; modes\nDataType=7\t; of 32 bits\nDefaultValue=0x80 ; cyclic\n"
                     "[2000]\nDataType=9\nDefaultValue=a;b\n");
    TEST_ASSERT_EQUAL_UINT(OBJECT_UNSIGNED32, row_of(0x6502, 0)->type);
    TEST_ASSERT_EQUAL_HEX32(0x80, row_of(0x6502, 0)->initial);
    TEST_ASSERT_EQUAL_STRING("a;b", row_of(0x2000, 0)->title);
}

static void test_a_text_of_two_bytes_a_character_is_read(void)
{
    static const char text[] = DRIVE "[6502]\r\nDataType=7\r\nDefaultValue=0x80\r\n";
    for (unsigned low = 0; low < 2; low++) {
        char wide[2 * sizeof text] = {(char)(low == 0 ? 0xFF : 0xFE),
                                      (char)(low == 0 ? 0xFE : 0xFF)};
        for (size_t i = 0; i + 1 < sizeof text; i++)
            wide[2 + 2 * i + low] = text[i];
        TEST_ASSERT_TRUE_MESSAGE(dictionary_read(&sheet, wide, sizeof wide, &wrong), wrong.text);
        TEST_ASSERT_EQUAL_HEX32(0x80, row_of(0x6502, 0)->initial);
        dictionary_free(&sheet);
    }
}

static void test_lines_may_end_with_a_carriage_return_alone(void)
{
    read_sheet("[1000]\rDataType=7\r[6040]\rDataType=6\r[6502]\rDataType=7\rDefaultValue=2\r");
    TEST_ASSERT_EQUAL_HEX32(2, row_of(0x6502, 0)->initial);
}

static void test_identifiers_count_from_the_node_id_on_either_side(void)
{
    static const char *const forms[] = {"$NODEID+0x200", "$NodeID + 0x200", "0x200+$NODEID",
                                        "512 + $nodeid"};
    for (unsigned i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        char text[400];
        (void)snprintf(text, sizeof text,
                       DRIVE "[1400]\nObjectType=9\n[1400sub1]\nDataType=7\nDefaultValue=%s\n",
                       forms[i]);
        read_sheet(text);
        TEST_ASSERT_TRUE(row_of(0x1400, 1)->flags & OBJECT_NODE_ID);
        TEST_ASSERT_EQUAL_HEX32(0x200, row_of(0x1400, 1)->initial);
        dictionary_free(&sheet);
    }
}

static void test_a_compact_array_has_all_its_entries(void)
{
    read_sheet(DRIVE "[2100]\nParameterName=Gains\nObjectType=8\nDataType=6\nAccessType=rw\n"
                     "DefaultValue=7\nCompactSubObj=3\n[2100Value]\nNrOfEntries=1\n2=0x10\n");
    TEST_ASSERT_EQUAL_UINT(3, row_of(0x2100, 0)->initial);
    TEST_ASSERT_EQUAL_UINT(7, row_of(0x2100, 1)->initial);
    TEST_ASSERT_EQUAL_UINT(16, row_of(0x2100, 2)->initial);
    TEST_ASSERT_EQUAL_UINT(7, row_of(0x2100, 3)->initial);
    TEST_ASSERT_EQUAL_UINT(OBJECT_RW, row_of(0x2100, 3)->access);
}

static void test_a_default_counts_before_the_value_of_a_configuration(void)
{
    read_sheet(DRIVE "[6065]\nDataType=7\nDefaultValue=5\nParameterValue=6\n"
                     "[2200]\nDataType=3\nDefaultValue=\nParameterValue=-6\n");
    TEST_ASSERT_EQUAL_INT(-6, row_of(0x2200, 0)->initial);
}

static void test_what_a_configuration_has_set_counts_before_a_default(void)
{
    read_sheet(DRIVE "[DeviceComissioning]\nNodeID=3\n"
                     "[2200]\nDataType=3\nDefaultValue=5\nParameterValue=-6\n"
                     "[2201]\nDataType=3\nDefaultValue=5\nParameterValue=\n");
    TEST_ASSERT_EQUAL_INT(-6, row_of(0x2200, 0)->initial);
    TEST_ASSERT_EQUAL_INT(5, row_of(0x2201, 0)->initial);
}

static void test_limits_of_one_side_and_hexadecimal_ones_of_signed_objects(void)
{
    read_sheet(DRIVE "[2200]\nDataType=4\nLowLimit=0x80000000\nHighLimit=0x7FFFFFFF\n"
                     "[2201]\nDataType=5\nHighLimit=9\n");
    TEST_ASSERT_TRUE(row_of(0x2200, 0)->min == INT32_MIN && row_of(0x2200, 0)->max == INT32_MAX);
    TEST_ASSERT_TRUE(row_of(0x2201, 0)->min == 0 && row_of(0x2201, 0)->max == 9);
}

static void test_dummies_are_those_of_the_sheet(void)
{
    read_sheet(DRIVE "[DummyUsage]\nDummy0002=0\nDummy0007=1\n");
    TEST_ASSERT_EQUAL_HEX8(0x80, sheet.dummies);
}

static void test_a_mapping_has_no_more_entries_than_the_sheet_and_a_frame(void)
{
    read_sheet(
        DRIVE
        "[1600sub0]\nDataType=5\nHighLimit=12\n[1600sub1]\nDataType=7\n[1600sub2]\nDataType=7\n");
    TEST_ASSERT_TRUE(row_of(0x1600, 0)->max == 2);
}

static void test_what_is_no_data_sheet_is_told_so(void)
{
    static const char *const texts[] = {"", "nonsense", "[6040]\nDataType=6\n",
                                        "[1000]\nDataType=7\n"};
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        TEST_ASSERT_FALSE(dictionary_read(&sheet, texts[i], strlen(texts[i]), &wrong));
        TEST_ASSERT_NOT_NULL(strstr(wrong.text, i < 3 ? "[1000]" : "[6040]"));
    }
    static const char xml[] = "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<ISO15745ProfileContainer>";
    TEST_ASSERT_FALSE(dictionary_read(&sheet, xml, sizeof xml - 1, &wrong));
    TEST_ASSERT_NOT_NULL(strstr(wrong.text, "XDD"));
}

static void test_a_drive_of_a_sheet_has_its_objects_and_no_others(void)
{
    read_sheet(
        DRIVE
        "[2200]\nDataType=4\nAccessType=rw\nDefaultValue=-3\n[605E]\nDataType=3\nAccessType=ro\n"
        "DefaultValue=1\n");
    lone_set_default(&lone);
    lone.config.dictionary = &sheet;
    lone_start(&lone);
    uint32_t value = 0;
    TEST_ASSERT_TRUE(virtual_drive_read_object(&lone.drive, 0x22000020, &value));
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFD, value);
    TEST_ASSERT_TRUE(virtual_drive_write_object(&lone.drive, 0x22000020, 77));
    TEST_ASSERT_TRUE(virtual_drive_read_object(&lone.drive, 0x22000020, &value));
    TEST_ASSERT_EQUAL_UINT32(77, value);
    TEST_ASSERT_FALSE(virtual_drive_write_object(&lone.drive, 0x605E0010, 2));
    TEST_ASSERT_FALSE(virtual_drive_read_object(&lone.drive, 0x60600008, &value));
    TEST_ASSERT_TRUE(virtual_drive_write_object(&lone.drive, 0x60400010, 6));
    TEST_ASSERT_EQUAL_INT(CIA402_READY, virtual_drive_get_state(&lone.drive));
}

/* A sheet may be wrong in any way; what does not fit into a frame any more is left out. */
static void test_a_mapping_of_a_sheet_that_is_longer_than_a_frame_ends_with_the_frame(void)
{
    read_sheet(DRIVE "[6041]\nDataType=6\nAccessType=ro\nPDOMapping=1\n"
                     "[6064]\nDataType=4\nAccessType=ro\nPDOMapping=1\n"
                     "[60F4]\nDataType=4\nAccessType=ro\nPDOMapping=1\n"
                     "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"
                     "[1800sub2]\nDataType=5\nDefaultValue=1\n"
                     "[1A00sub0]\nDataType=5\nDefaultValue=3\n"
                     "[1A00sub1]\nDataType=7\nDefaultValue=0x60640020\n"
                     "[1A00sub2]\nDataType=7\nDefaultValue=0x60F40020\n"
                     "[1A00sub3]\nDataType=7\nDefaultValue=0x60410010\n");
    lone_set_default(&lone);
    lone.config.dictionary = &sheet;
    lone_start(&lone);
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(8, lone_find(&lone, 0x180 + LONE_NODE)->length);
}

/* A sheet may map by default what never changes and has no place in memory. */
static void test_a_constant_that_a_sheet_maps_is_sent(void)
{
    read_sheet("[1000]\nDataType=7\nAccessType=const\n[6040]\nDataType=6\nAccessType=rww\n"
               "[6502]\nDataType=7\nAccessType=ro\nDefaultValue=0x80\n"
               "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"
               "[1800sub2]\nDataType=5\nDefaultValue=1\n"
               "[1A00sub0]\nDataType=5\nDefaultValue=1\n"
               "[1A00sub1]\nDataType=7\nDefaultValue=0x65020020\n");
    lone_set_default(&lone);
    lone.config.dictionary = &sheet;
    lone_start(&lone);
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_HEX8(0x80, lone_find(&lone, 0x180 + LONE_NODE)->data[0]);
}

/* Bit 30 of 1005 says that a node sends SYNC; the identifier is below it. */
static void test_bits_above_the_identifier_of_sync_do_not_count(void)
{
    read_sheet(DRIVE "[6041]\nDataType=6\nAccessType=ro\nPDOMapping=1\n"
                     "[1005]\nDataType=7\nDefaultValue=0x40000081\n"
                     "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"
                     "[1800sub2]\nDataType=5\nDefaultValue=1\n"
                     "[1A00sub0]\nDataType=5\nDefaultValue=1\n"
                     "[1A00sub1]\nDataType=7\nDefaultValue=0x60410010\n");
    lone_set_default(&lone);
    lone.config.dictionary = &sheet;
    lone_start(&lone);
    lone_nmt(&lone, NMT_START);
    lone_take(&lone, 0x081, 0, 0, 0);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x180 + LONE_NODE));
}

/*
 * A drive that takes its time hears nothing before it has booted, and answers as late as it says.
 */
static void test_booting_and_answering_take_their_time(void)
{
    const struct can_frame reset = {.id = 0, .length = 2, .data = {0x82, LONE_NODE}};
    const struct can_frame ask = {.id = 0x600 + LONE_NODE, .length = 8, .data = {0x40, 0x00, 0x10}};
    lone_set_default(&lone);
    lone.config.boot_us = 5000;
    lone.config.sdo_us = 3000;
    lone_start(&lone);
    virtual_drive_on_frame(&lone.drive, &reset);
    lone.sent_count = 0;
    for (unsigned i = 0; i < 4; i++)
        virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
    virtual_drive_on_frame(&lone.drive, &ask);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
    TEST_ASSERT_EQUAL_UINT(1, lone.sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x700 + LONE_NODE, lone.sent[0].id);
    virtual_drive_on_frame(&lone.drive, &ask);
    for (unsigned i = 0; i < 2; i++)
        virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
    TEST_ASSERT_EQUAL_UINT(1, lone.sent_count);
    virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
    TEST_ASSERT_EQUAL_UINT(2, lone.sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x580 + LONE_NODE, lone.sent[1].id);
}

static uint32_t state = 1;

static uint32_t draw(uint32_t below)
{
    state = state * 1664525 + 1013904223;
    return (state >> 8) % below;
}

static const char *const pieces[] = {"[1000]\n",
                                     "[6040]\n",
                                     "[1600sub0]\n",
                                     "[1600sub1]\n",
                                     "[1A00sub9]\n",
                                     "[1016sub7]\n",
                                     "[2000]\n",
                                     "[1400sub1]\n",
                                     "[1003sub9]\n",
                                     "[6060]\n",
                                     "[6502]\n",
                                     "[2100Value]\n",
                                     "[DummyUsage]\n",
                                     "[",
                                     "DataType=7\n",
                                     "DataType=5\n",
                                     "DataType=0x1B\n",
                                     "DataType=9\n",
                                     "AccessType=rw\n",
                                     "DefaultValue=$NODEID+0x99999999999999999999\n",
                                     "DefaultValue=-1\n",
                                     "CompactSubObj=254\n",
                                     "ObjectType=8\n",
                                     "LowLimit=5\n",
                                     "HighLimit=-5\n",
                                     "PDOMapping=1\n",
                                     "3=4\n",
                                     "Dummy0007=1\n",
                                     "=\n"};

/* Pieces of sheets in any order, with bytes changed; its length. */
static size_t draw_sheet(char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (unsigned i = draw(40); i > 0; i--) {
        const char *piece = pieces[draw(sizeof pieces / sizeof pieces[0])];
        length += (size_t)snprintf(text + length, size - length, "%s", piece);
    }
    if (length > 0 && draw(2))
        text[draw((uint32_t)length)] = (char)draw(256);
    return length;
}

/* Each object of the sheet is written, whatever it is. */
static void ask_for_anything(void)
{
    lone_set_default(&lone);
    lone.config.dictionary = &sheet;
    lone_start(&lone);
    for (unsigned i = 0; i < sheet.count; i++) {
        const struct object_row *row = &sheet.row[i];
        uint32_t object = (uint32_t)row->index << 16 | (uint32_t)row->sub << 8 |
                          8 * takt_object_type_bytes((enum object_type)row->type);
        (void)virtual_drive_write_object(&lone.drive, object, draw(300));
    }
    virtual_drive_step(&lone.drive, LONE_CYCLE_NS);
}

static void test_any_bytes_are_read_or_refused_and_the_drive_of_it_can_be_asked_for_anything(void)
{
    for (unsigned n = 0; n < 2000; n++) {
        char text[2000];
        size_t length = draw_sheet(text, sizeof text);
        if (!dictionary_read(&sheet, text, length, &wrong))
            continue;
        ask_for_anything();
        dictionary_free(&sheet);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_keys_and_words_may_be_written_in_any_way);
    RUN_TEST(test_a_semicolon_behind_a_space_begins_a_comment);
    RUN_TEST(test_a_text_of_two_bytes_a_character_is_read);
    RUN_TEST(test_lines_may_end_with_a_carriage_return_alone);
    RUN_TEST(test_identifiers_count_from_the_node_id_on_either_side);
    RUN_TEST(test_a_compact_array_has_all_its_entries);
    RUN_TEST(test_a_default_counts_before_the_value_of_a_configuration);
    RUN_TEST(test_what_a_configuration_has_set_counts_before_a_default);
    RUN_TEST(test_limits_of_one_side_and_hexadecimal_ones_of_signed_objects);
    RUN_TEST(test_dummies_are_those_of_the_sheet);
    RUN_TEST(test_a_mapping_has_no_more_entries_than_the_sheet_and_a_frame);
    RUN_TEST(test_what_is_no_data_sheet_is_told_so);
    RUN_TEST(test_a_drive_of_a_sheet_has_its_objects_and_no_others);
    RUN_TEST(test_a_mapping_of_a_sheet_that_is_longer_than_a_frame_ends_with_the_frame);
    RUN_TEST(test_a_constant_that_a_sheet_maps_is_sent);
    RUN_TEST(test_bits_above_the_identifier_of_sync_do_not_count);
    RUN_TEST(test_booting_and_answering_take_their_time);
    RUN_TEST(test_any_bytes_are_read_or_refused_and_the_drive_of_it_can_be_asked_for_anything);
    return UNITY_END();
}
