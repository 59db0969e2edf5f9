/*
 * The object table, and the data sheet that is written from it: every entry of the sheet is an
 * entry of the drive, with its type, its access, its limits and its value at power-on.
 */
#define _POSIX_C_SOURCE 200809L

#include "drives/eds.h"
#include "lone_drive.h"
#include "servo/object_table.h"

#include <stdio.h>
#include <stdlib.h>

static struct lone_drive lone;
static char *sheet;
static size_t sheet_length;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
    FILE *stream = open_memstream(&sheet, &sheet_length);
    TEST_ASSERT_NOT_NULL(stream);
    eds_write(stream, &lone.drive.servo, "test.eds");
    TEST_ASSERT_EQUAL_INT(0, fclose(stream));
}

void tearDown(void)
{
    free(sheet);
}

/* The text of a section, up to the next; NULL: there is none. */
static const char *find_section(const char *name, size_t *length)
{
    char head[64];
    (void)snprintf(head, sizeof head, "[%s]\r\n", name);
    const char *at = strstr(sheet, head);
    if (!at)
        return NULL;
    at += strlen(head);
    const char *end = strstr(at, "\r\n[");
    *length = end ? (size_t)(end - at) : strlen(at);
    return at;
}

/* The value of a key in a section, or "" where it is not there. */
static const char *find_value(const char *section, const char *key)
{
    static char value[256];
    size_t length = 0, key_length = strlen(key);
    const char *at = find_section(section, &length);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, section);
    const char *end = at + length;
    while (at < end) {
        size_t line = strcspn(at, "\r");
        if (strncmp(at, key, key_length) == 0 && at[key_length] == '=') {
            (void)snprintf(value, sizeof value, "%.*s", (int)(line - key_length - 1),
                           at + key_length + 1);
            return value;
        }
        at += line + 2;
    }
    return "";
}

static void name_section(const struct object_row *row, char name[32])
{
    const struct object_row *head = row;
    while (head->kind == OBJECT_SAME)
        head--;
    if (head->kind == OBJECT_VAR)
        (void)snprintf(name, 32, "%04X", row->index);
    else
        (void)snprintf(name, 32, "%04Xsub%X", row->index, row->sub);
}

static const struct object_row *row_at(unsigned i)
{
    return &takt_object_table[i];
}

static void test_the_table_is_in_order_and_every_index_begins_with_its_kind(void)
{
    for (unsigned i = 1; i < takt_object_table_count; i++) {
        const struct object_row *before = row_at(i - 1), *row = row_at(i);
        bool same = row->index == before->index;
        TEST_ASSERT_TRUE(row->index > before->index || (same && row->sub > before->sub));
        TEST_ASSERT_TRUE(same == (row->kind == OBJECT_SAME));
        TEST_ASSERT_TRUE(same || row->sub == 0);
    }
}

static void test_every_entry_is_found_and_nothing_else(void)
{
    bool has_index;
    unsigned found = 0;
    for (unsigned index = 0; index <= 0xFFFF; index++)
        for (unsigned sub = 0; sub < 128; sub++)
            found += takt_object_table_find((uint16_t)index, (uint8_t)sub, &has_index) != NULL;
    TEST_ASSERT_EQUAL_UINT(takt_object_table_count, found);
    TEST_ASSERT_NULL(takt_object_table_find(0x6099, 3, &has_index));
    TEST_ASSERT_TRUE(has_index);
    TEST_ASSERT_NULL(takt_object_table_find(0x6100, 0, &has_index));
    TEST_ASSERT_FALSE(has_index);
    TEST_ASSERT_NULL(takt_object_table_find(0xFFFF, 0xFF, &has_index));
    TEST_ASSERT_FALSE(has_index);
}

static void test_the_objects_of_the_profile_are_there(void)
{
    static const uint16_t indices[] = {
        0x1000, 0x1001, 0x1002, 0x1003, 0x1005, 0x1006, 0x1007, 0x1008, 0x1009, 0x100A, 0x1010,
        0x1011, 0x1012, 0x1013, 0x1014, 0x1015, 0x1016, 0x1017, 0x1018, 0x1019, 0x1029, 0x1200,
        0x1400, 0x1401, 0x1402, 0x1403, 0x1600, 0x1601, 0x1602, 0x1603, 0x1800, 0x1801, 0x1802,
        0x1803, 0x1A00, 0x1A01, 0x1A02, 0x1A03, 0x6007, 0x603F, 0x6040, 0x6041, 0x605A, 0x605B,
        0x605C, 0x605D, 0x605E, 0x6060, 0x6061, 0x6062, 0x6063, 0x6064, 0x6065, 0x6066, 0x6067,
        0x6068, 0x606C, 0x6077, 0x607A, 0x607C, 0x607D, 0x607F, 0x6080, 0x6081, 0x6083, 0x6084,
        0x6085, 0x6086, 0x608F, 0x6091, 0x6092, 0x6098, 0x6099, 0x609A, 0x60B0, 0x60B1, 0x60B2,
        0x60C0, 0x60C1, 0x60C2, 0x60C4, 0x60F4, 0x60FD, 0x60FE, 0x6502};
    bool has_index;
    for (unsigned i = 0; i < sizeof indices / sizeof indices[0]; i++) {
        TEST_ASSERT_NOT_NULL(takt_object_table_find(indices[i], 0, &has_index));
    }
    TEST_ASSERT_EQUAL_HEX32(0x00020192, lone_read(&lone, 0x1000, 0));
    TEST_ASSERT_EQUAL_HEX32(0x3ED, lone_read(&lone, 0x6502, 0));
}

/* Two entries in one place of memory would change each other. */
static void test_no_two_numbers_share_memory(void)
{
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        const struct object_row *a = row_at(i);
        unsigned a_bytes = takt_object_type_bytes((enum object_type)a->type);
        for (unsigned k = 0; k < i; k++) {
            const struct object_row *b = row_at(k);
            unsigned b_bytes = takt_object_type_bytes((enum object_type)b->type);
            bool apart = a->field + a_bytes <= b->field || b->field + b_bytes <= a->field;
            TEST_ASSERT_TRUE(apart || a->flags & OBJECT_FIXED || b->flags & OBJECT_FIXED);
        }
    }
}

/* Tools find objects by their names. */
static void test_names_are_unique(void)
{
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        const struct object_row *a = row_at(i);
        for (unsigned k = 0; k < i; k++) {
            const struct object_row *b = row_at(k);
            bool is_sub = a->title != NULL || a->kind == OBJECT_SAME;
            bool are_apart = strcmp(a->name, b->name) != 0;
            TEST_ASSERT_TRUE_MESSAGE(are_apart || a->index != b->index || !is_sub, a->name);
            if (a->kind == OBJECT_SAME || b->kind == OBJECT_SAME)
                continue;
            const char *name_a = a->kind == OBJECT_VAR ? a->name : a->title;
            const char *name_b = b->kind == OBJECT_VAR ? b->name : b->title;
            const bool same = name_a != NULL && name_b != NULL && strcmp(name_a, name_b) == 0;
            TEST_ASSERT_FALSE_MESSAGE(same, name_a);
        }
    }
}

static void test_the_sheet_has_exactly_the_entries_of_the_table(void)
{
    unsigned sections = 0;
    char name[32];
    size_t length;
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        name_section(row_at(i), name);
        TEST_ASSERT_NOT_NULL_MESSAGE(find_section(name, &length), name);
        sections += row_at(i)->kind == OBJECT_ARRAY || row_at(i)->kind == OBJECT_RECORD;
    }
    sections += takt_object_table_count + 6;
    for (const char *at = sheet; (at = strstr(at, "[")) != NULL; at++)
        sections -= at == sheet || at[-1] == '\n';
    TEST_ASSERT_EQUAL_UINT(0, sections);
}

static void test_the_lists_of_the_sheet_name_every_index_once(void)
{
    static const char *const lists[] = {"MandatoryObjects", "OptionalObjects",
                                        "ManufacturerObjects"};
    unsigned listed = 0, indices = 0;
    char key[16];
    bool has_index;
    for (unsigned i = 0; i < takt_object_table_count; i++)
        indices += row_at(i)->kind != OBJECT_SAME;
    for (unsigned i = 0; i < 3; i++) {
        unsigned long count = strtoul(find_value(lists[i], "SupportedObjects"), NULL, 10);
        unsigned long before = 0;
        for (unsigned n = 1; n <= count; n++) {
            (void)snprintf(key, sizeof key, "%u", n);
            unsigned long index = strtoul(find_value(lists[i], key), NULL, 16);
            TEST_ASSERT_TRUE(index > before);
            TEST_ASSERT_NOT_NULL(takt_object_table_find((uint16_t)index, 0, &has_index));
            before = index;
        }
        listed += (unsigned)count;
    }
    TEST_ASSERT_EQUAL_UINT(indices, listed);
}

static const char *access_of(const struct object_row *row)
{
    static const char *const names[] = {"ro", "rw", "wo", "const"};
    bool is_received = row->flags & OBJECT_TO_RPDO && !(row->flags & OBJECT_TO_TPDO);
    return row->access == OBJECT_RW && is_received ? "rww" : names[row->access];
}

static void test_type_access_and_mapping_are_those_of_the_table(void)
{
    char name[32], text[16];
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        const struct object_row *row = row_at(i);
        name_section(row, name);
        (void)snprintf(text, sizeof text, "0x%04X", row->type);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(text, find_value(name, "DataType"), name);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(access_of(row), find_value(name, "AccessType"), name);
        bool is_mapped = row->flags & (OBJECT_TO_RPDO | OBJECT_TO_TPDO);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(is_mapped ? "1" : "0", find_value(name, "PDOMapping"),
                                         name);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(row->name, find_value(name, "ParameterName"), name);
    }
}

static long long sheet_number(const char *text)
{
    static const char relative[] = "$NODEID+";
    if (strncmp(text, relative, sizeof relative - 1) == 0)
        return strtoll(text + sizeof relative - 1, NULL, 0) + LONE_NODE;
    return strtoll(text, NULL, 0);
}

static long long signed_value(const struct object_row *row, uint32_t raw)
{
    return takt_object_type_value((enum object_type)row->type, raw);
}

/* What the sheet says a fresh drive holds, the drive answers. */
static void test_default_values_are_what_the_drive_answers_at_power_on(void)
{
    char name[32];
    unsigned compared = 0;
    lone_step(&lone, 100); /* clocks have gone on */
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        const struct object_row *row = row_at(i);
        name_section(row, name);
        const char *text = find_value(name, "DefaultValue");
        if (text[0] == '\0' || takt_object_type_bytes((enum object_type)row->type) == 0)
            continue;
        bool aborted;
        uint32_t raw = lone_try_read(&lone, row->index, row->sub, &aborted);
        if (aborted && row->index == 0x1003)
            continue; /* no error has been */
        TEST_ASSERT_FALSE(aborted);
        TEST_ASSERT_TRUE_MESSAGE(
            sheet_number(find_value(name, "DefaultValue")) == signed_value(row, raw), name);
        compared++;
    }
    TEST_ASSERT_TRUE(compared > 150);
}

static void test_limits_of_the_sheet_are_kept_by_the_drive(void)
{
    char name[32];
    unsigned compared = 0;
    for (unsigned i = 0; i < takt_object_table_count; i++) {
        const struct object_row *row = row_at(i);
        unsigned bytes = takt_object_type_bytes((enum object_type)row->type);
        if (!(row->flags & OBJECT_LIMITED) || row->index < 0x2000)
            continue;
        name_section(row, name);
        long long low = sheet_number(find_value(name, "LowLimit"));
        long long high = sheet_number(find_value(name, "HighLimit"));
        TEST_ASSERT_TRUE(low == row->min && high == row->max);
        uint32_t above = (uint32_t)(high + 1), below = (uint32_t)(low - 1);
        if (signed_value(row, above) == high + 1)
            TEST_ASSERT_EQUAL_HEX32(0x06090031,
                                    lone_write(&lone, row->index, row->sub, bytes, above));
        if (signed_value(row, below) == low - 1)
            TEST_ASSERT_EQUAL_HEX32(0x06090032,
                                    lone_write(&lone, row->index, row->sub, bytes, below));
        compared++;
    }
    TEST_ASSERT_TRUE(compared > 20);
}

static void test_the_sheet_is_the_same_after_the_drive_has_been_set_up(void)
{
    char *again;
    size_t again_length;
    (void)lone_write(&lone, 0x6081, 0, 4, 77);
    (void)lone_write(&lone, 0x1017, 0, 2, 100);
    FILE *stream = open_memstream(&again, &again_length);
    TEST_ASSERT_NOT_NULL(stream);
    eds_write(stream, &lone.drive.servo, "test.eds");
    TEST_ASSERT_EQUAL_INT(0, fclose(stream));
    TEST_ASSERT_EQUAL_STRING(sheet, again);
    free(again);
}

/* Object 1021, uploaded in segments. */
static void test_the_drive_gives_its_sheet_away(void)
{
    char *got = calloc(1, sheet_length + 8);
    size_t length = 0;
    takt_servo_set_eds(&lone.drive.servo, sheet, sheet_length);
    TEST_ASSERT_EQUAL_UINT32(sheet_length, lone_read(&lone, 0x1021, 0));
    for (uint32_t toggle = 0;; toggle ^= 0x10) {
        lone_take(&lone, 0x605, 8, 0x60 | toggle, 0);
        const struct can_frame *frame = &lone.sent[0];
        unsigned bytes = 7 - sdo_unused_segment(frame->data[0]);
        TEST_ASSERT_TRUE(length + bytes <= sheet_length);
        memcpy(got + length, frame->data + 1, bytes);
        length += bytes;
        if (frame->data[0] & SDO_LAST)
            break;
    }
    TEST_ASSERT_EQUAL_UINT(sheet_length, length);
    TEST_ASSERT_EQUAL_MEMORY(sheet, got, sheet_length);
    free(got);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_table_is_in_order_and_every_index_begins_with_its_kind);
    RUN_TEST(test_every_entry_is_found_and_nothing_else);
    RUN_TEST(test_the_objects_of_the_profile_are_there);
    RUN_TEST(test_no_two_numbers_share_memory);
    RUN_TEST(test_names_are_unique);
    RUN_TEST(test_the_sheet_has_exactly_the_entries_of_the_table);
    RUN_TEST(test_the_lists_of_the_sheet_name_every_index_once);
    RUN_TEST(test_type_access_and_mapping_are_those_of_the_table);
    RUN_TEST(test_default_values_are_what_the_drive_answers_at_power_on);
    RUN_TEST(test_limits_of_the_sheet_are_kept_by_the_drive);
    RUN_TEST(test_the_sheet_is_the_same_after_the_drive_has_been_set_up);
    RUN_TEST(test_the_drive_gives_its_sheet_away);
    return UNITY_END();
}
