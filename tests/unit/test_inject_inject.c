/*
 * Fault scripts: text to faults, and when they are in force.
 */
#include "inject/inject.h"
#include "unity.h"

#include <string.h>

static struct inject script;
static struct inject_error error;

void setUp(void)
{
    memset(&script, 0xAA, sizeof script);
    memset(&error, 0, sizeof error);
}

void tearDown(void)
{
}

static void read(const char *text)
{
    bool good = inject_read(&script, text, strlen(text), &error);
    TEST_ASSERT_TRUE_MESSAGE(good, error.text);
}

static void assert_refused(const char *text, uint32_t line, uint32_t column, const char *said)
{
    TEST_ASSERT_FALSE_MESSAGE(inject_read(&script, text, strlen(text), &error), text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(line, error.line, text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(column, error.column, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, said), error.text);
}

static void test_a_bus_fault_has_its_time_and_its_frames(void)
{
    read("enabled+0.5s bus drop id=182 frames=10 skip=3 node=2\n");
    const struct inject_fault *fault = &script.fault[0];
    TEST_ASSERT_EQUAL_UINT(1, script.count);
    TEST_ASSERT_EQUAL_INT(INJECT_DROP, fault->kind);
    TEST_ASSERT_EQUAL_INT(INJECT_ENABLED, fault->anchor);
    TEST_ASSERT_TRUE(fault->after_ns == 500000000);
    TEST_ASSERT_EQUAL_HEX16(0x182, fault->id);
    TEST_ASSERT_EQUAL_UINT32(10, fault->frames);
    TEST_ASSERT_EQUAL_UINT32(3, fault->skip);
    TEST_ASSERT_EQUAL_UINT8(2, fault->node);
    TEST_ASSERT_EQUAL_UINT32(1, fault->line);
}

static void test_a_drive_fault_has_its_node_and_its_object(void)
{
    read("power drive 17 report object=0x1018:02 value=ffffffff for=20ms");
    const struct inject_fault *fault = &script.fault[0];
    TEST_ASSERT_EQUAL_INT(INJECT_REPORT, fault->kind);
    TEST_ASSERT_EQUAL_INT(INJECT_POWER, fault->anchor);
    TEST_ASSERT_TRUE(fault->after_ns == 0);
    TEST_ASSERT_TRUE(fault->for_ns == 20000000);
    TEST_ASSERT_EQUAL_UINT8(17, fault->node);
    TEST_ASSERT_EQUAL_HEX16(0x1018, fault->index);
    TEST_ASSERT_EQUAL_HEX8(2, fault->sub);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, fault->value);
}

static void test_comments_empty_lines_and_line_ends_of_dos_are_passed_over(void)
{
    read("# two faults\r\n\r\n\tpower+1s drive 1 jam # stuck\r\n  power+300us bus cut "
         "node=controller");
    TEST_ASSERT_EQUAL_UINT(2, script.count);
    TEST_ASSERT_EQUAL_UINT32(3, script.fault[0].line);
    TEST_ASSERT_EQUAL_UINT32(4, script.fault[1].line);
    TEST_ASSERT_TRUE(script.fault[1].after_ns == 300000);
    TEST_ASSERT_EQUAL_UINT8(INJECT_CONTROLLER, script.fault[1].node);
}

static void test_an_empty_script_has_no_faults(void)
{
    read("");
    TEST_ASSERT_EQUAL_UINT(0, script.count);
}

static void test_one_frame_is_hit_unless_more_is_said(void)
{
    read("power bus drop\npower bus drop ratio=0.5\npower bus drop for=1s\npower bus drop "
         "frames=all\n"
         "power bus drop frames=7 for=1s");
    TEST_ASSERT_EQUAL_UINT32(1, script.fault[0].frames);
    TEST_ASSERT_EQUAL_UINT32(INJECT_ALL, script.fault[1].frames);
    TEST_ASSERT_EQUAL_UINT32(INJECT_ALL, script.fault[2].frames);
    TEST_ASSERT_EQUAL_UINT32(INJECT_ALL, script.fault[3].frames);
    TEST_ASSERT_EQUAL_UINT32(7, script.fault[4].frames);
    TEST_ASSERT_TRUE(script.fault[1].ratio == 0.5);
}

static void test_what_is_not_given_is_anything_and_for_good(void)
{
    read("power bus corrupt\npower drive 1 hang");
    TEST_ASSERT_EQUAL_HEX16(INJECT_ANY_ID, script.fault[0].id);
    TEST_ASSERT_EQUAL_UINT8(INJECT_ANY_NODE, script.fault[0].node);
    TEST_ASSERT_TRUE(script.fault[1].for_ns == INJECT_ALWAYS);
}

static void test_errors_say_where_and_what(void)
{
    assert_refused("soon bus drop", 1, 1, "power+0.5s");
    assert_refused("power+5 bus drop", 1, 1, "'power+5' is no time");
    assert_refused("power\n", 1, 6, "'' cannot fail");
    assert_refused("\npower wheel jam", 2, 7, "'wheel' cannot fail");
    assert_refused("power drive 128 jam", 1, 13, "1 ... 127");
    assert_refused("power drive 1 drop", 1, 15, "emcy, warn, mute");
    assert_refused("power bus emcy code=1", 1, 11, "drop, corrupt");
    assert_refused("power bus drop id", 1, 16, "KEY=VALUE");
    assert_refused("power bus drop id=800", 1, 19, "0 ... 7FF");
    assert_refused("power bus drop code=1", 1, 16, "means nothing for drop");
    assert_refused("power bus drop skip=1 skip=2", 1, 23, "twice");
    assert_refused("power bus delay", 1, 16, "needs by=");
    assert_refused("power drive 1 emcy code=12345", 1, 25, "hexadecimal");
    assert_refused("power drive 1 emcy code=0", 1, 25, "above 0");
    assert_refused("power bus drop ratio=1.5", 1, 22, "0 ... 1");
    assert_refused("power bus drop ratio=nan", 1, 22, "0 ... 1");
    assert_refused("power bus drop frames=0", 1, 23, "from 1");
    assert_refused("power drive 1 hang for=0s", 1, 24, "time");
    assert_refused("power drive 1 mute what=lights", 1, 25, "heartbeat");
    assert_refused("power drive 1 \303\244", 1, 15, "ASCII");
}

static void test_an_abort_code_has_32_bits_an_error_code_16(void)
{
    read("power drive 1 sdo_abort object=6098 code=06040043");
    TEST_ASSERT_EQUAL_HEX32(0x06040043, script.fault[0].code);
    TEST_ASSERT_EQUAL_HEX16(0x6098, script.fault[0].index);
}

static void test_more_faults_than_there_is_room_for_are_refused(void)
{
    static const char line[] = "power bus drop\n";
    const size_t length = sizeof line - 1;
    char text[sizeof line * (INJECT_FAULTS_MAX + 1)] = "";
    for (unsigned i = 0; i <= INJECT_FAULTS_MAX; i++)
        memcpy(text + i * length, line, length);
    assert_refused(text, INJECT_FAULTS_MAX + 1, 1, "more than 64");
    TEST_ASSERT_EQUAL_UINT(INJECT_FAULTS_MAX, script.count);
}

static bool is_in_force(uint64_t now_ns, uint64_t enabled_ns)
{
    const struct inject_clock clock = {.now_ns = now_ns, .enabled_ns = enabled_ns};
    return inject_is_in_force(&script.fault[0], &clock);
}

static void test_a_fault_lasts_from_its_time_as_long_as_it_says(void)
{
    read("power+1ms drive 1 jam for=2ms");
    TEST_ASSERT_FALSE(is_in_force(999999, INJECT_ALWAYS));
    TEST_ASSERT_TRUE(is_in_force(1000000, INJECT_ALWAYS));
    TEST_ASSERT_TRUE(is_in_force(2999999, INJECT_ALWAYS));
    TEST_ASSERT_FALSE(is_in_force(3000000, INJECT_ALWAYS));
}

static void test_a_fault_after_enabling_waits_for_it(void)
{
    read("enabled+1ms drive 1 jam");
    TEST_ASSERT_FALSE(is_in_force(5000000, INJECT_ALWAYS));
    TEST_ASSERT_FALSE(is_in_force(5000000, 4500000));
    TEST_ASSERT_TRUE(is_in_force(5500000, 4500000));
    TEST_ASSERT_TRUE(is_in_force(UINT64_MAX - 1, 4500000));
}

static uint32_t seed;

static uint32_t lcg(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/*
 * Words of the language and rubbish, in any order: an error with a place, or faults within range.
 */
static void test_any_text_is_read_or_refused_with_its_place(void)
{
    static const char *const words[] = {
        "power",  "enabled+1s", "bus",      "drive", "2",      "drop",     "emcy",
        "code=1", "id=7F",      "\n",       "\n",    "#",      "frames=9", "ratio=.5",
        "=",      "mute",       "what=sdo", "\x01",  "for=1s", "delay",    "by=1us"};
    char text[256];
    seed = 11;
    for (unsigned n = 0; n < 20000; n++) {
        size_t used = 0;
        for (unsigned i = 0; i < 12; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s ",
                                     words[lcg() % (sizeof words / sizeof words[0])]);
        bool good = inject_read(&script, text, strlen(text), &error);
        TEST_ASSERT_TRUE(script.count <= INJECT_FAULTS_MAX);
        TEST_ASSERT_TRUE(good || (error.line >= 1 && error.column >= 1 && error.text[0] != '\0'));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_bus_fault_has_its_time_and_its_frames);
    RUN_TEST(test_a_drive_fault_has_its_node_and_its_object);
    RUN_TEST(test_comments_empty_lines_and_line_ends_of_dos_are_passed_over);
    RUN_TEST(test_an_empty_script_has_no_faults);
    RUN_TEST(test_one_frame_is_hit_unless_more_is_said);
    RUN_TEST(test_what_is_not_given_is_anything_and_for_good);
    RUN_TEST(test_errors_say_where_and_what);
    RUN_TEST(test_an_abort_code_has_32_bits_an_error_code_16);
    RUN_TEST(test_more_faults_than_there_is_room_for_are_refused);
    RUN_TEST(test_a_fault_lasts_from_its_time_as_long_as_it_says);
    RUN_TEST(test_a_fault_after_enabling_waits_for_it);
    RUN_TEST(test_any_text_is_read_or_refused_with_its_place);
    return UNITY_END();
}
