#define _XOPEN_SOURCE 700 /* mkstemp, mkdtemp */

/* Tables that are read, files that are whole or not there. */
#include "cli/output_file.h"
#include "tables/parameter_file.h"
#include "tables/tool_file.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[32];
static char path[64];

void setUp(void)
{
    (void)snprintf(folder, sizeof folder, "/tmp/takt-files-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    (void)snprintf(path, sizeof path, "%s/file", folder);
}

void tearDown(void)
{
    (void)unlink(path);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, rmdir(folder), "something was left behind");
}

static void put(const char *text)
{
    FILE *file = fopen(path, "wb");

    TEST_ASSERT_NOT_NULL(file);
    (void)fputs(text, file);
    (void)fclose(file);
}

static const char *get(void)
{
    static char text[4096];
    FILE *file = fopen(path, "rb");
    size_t length;

    if (file == NULL)
        return NULL;
    length = fread(text, 1, sizeof text - 1, file);
    text[length] = '\0';
    (void)fclose(file);
    return text;
}

static void test_a_tool_table_is_read_as_linuxcnc_writes_it(void)
{
    struct tool_file file;
    const struct tool *tool;

    put("T1 P1 X+0.0 Z+50.8 A90 D+6.35 I10 J-20.5 Q3 ;1/4 inch end mill\n\n; a comment\r\nt20 p3 "
        "z-1.5\r\n");
    TEST_ASSERT_TRUE(tool_file_read(&file, path));
    TEST_ASSERT_EQUAL_UINT(2, file.table.count);
    tool = takt_tool_table_find(&file.table, 1);
    TEST_ASSERT_NOT_NULL(tool);
    TEST_ASSERT_EQUAL_DOUBLE(50.8, tool->offset.at[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(6.35, tool->diameter_mm);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, tool->front_angle_deg);
    TEST_ASSERT_EQUAL_DOUBLE(-20.5, tool->back_angle_deg);
    TEST_ASSERT_EQUAL_UINT(3, tool->orientation);
    TEST_ASSERT_EQUAL_DOUBLE(3.14159265358979323846 / 2, tool->offset.at[AXIS_A]);
    TEST_ASSERT_EQUAL_DOUBLE(-1.5, takt_tool_table_find(&file.table, 20)->offset.at[AXIS_Z]);
    tool_file_close(&file);
}

static void test_a_tool_table_with_a_mistake_is_refused(void)
{
    static const char *const bad[] = {"T1 Z\n",        "Z5\n",      "T1.5 Z1\n", "T1 Z1\nT1 Z2\n",
                                      "T1 R5\n",       "T-1 Z1\n",  "T1 Znan\n", "5\n",
                                      "T1 Z1 extra\n", "T1 Q10\n",  "T1 Q-1\n",  "T1 Q0.5\n",
                                      "T1 Z10 Z11\n",  "T1 z1 T2\n"};
    struct tool_file file;

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        put(bad[i]);
        TEST_ASSERT_FALSE_MESSAGE(tool_file_read(&file, path), bad[i]);
    }
}

static void test_many_tools_are_kept(void)
{
    struct tool_file file;
    FILE *stream = fopen(path, "wb");

    TEST_ASSERT_NOT_NULL(stream);
    for (int i = 0; i < 1000; i++)
        (void)fprintf(stream, "T%d Z%d\n", i, 2 * i);
    (void)fclose(stream);
    TEST_ASSERT_TRUE(tool_file_read(&file, path));
    TEST_ASSERT_EQUAL_UINT(1000, file.table.count);
    TEST_ASSERT_EQUAL_DOUBLE(1998, takt_tool_table_find(&file.table, 999)->offset.at[AXIS_Z]);
    tool_file_close(&file);
}

static void test_parameters_are_read_and_written_again(void)
{
    static struct parameter_file file;
    FILE *stream;

    put("31\t2.5\n5161   0.1\n5220 1\n100 0\n");
    TEST_ASSERT_TRUE(parameter_file_read(&file, path));
    TEST_ASSERT_EQUAL_DOUBLE(2.5, takt_parameters_get(&file.values, 31));
    TEST_ASSERT_TRUE(takt_parameters_set(&file.values, 5221, -1.25));
    TEST_ASSERT_TRUE(takt_parameters_set(&file.values, 200, 9)); /* neither listed nor persistent */
    stream = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(stream);
    parameter_file_write(stream, &file);
    (void)fclose(stream);
    TEST_ASSERT_EQUAL_STRING("31\t2.5\n100\t0\n5161\t0.1\n5220\t1\n5221\t-1.25\n", get());
    TEST_ASSERT_TRUE(parameter_file_read(&file, path));
    TEST_ASSERT_TRUE(takt_parameters_get(&file.values, 5161) == 0.1);
}

static void test_a_parameter_file_with_a_mistake_is_refused(void)
{
    static const char *const bad[] = {"0 1\n",      "5602 1\n",     "5161\n",  "x 1\n",
                                      "5161 1 2\n", "31 1\n31 1\n", "31 inf\n"};
    static struct parameter_file file;

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        put(bad[i]);
        TEST_ASSERT_FALSE_MESSAGE(parameter_file_read(&file, path), bad[i]);
    }
}

static void test_an_output_file_appears_when_it_is_placed(void)
{
    static struct output_file file;

    put("old");
    TEST_ASSERT_TRUE(output_file_open(&file, path));
    (void)fputs("new", file.stream);
    TEST_ASSERT_EQUAL_STRING("old", get());
    TEST_ASSERT_TRUE(output_file_finish(&file));
    TEST_ASSERT_EQUAL_STRING("old", get());
    TEST_ASSERT_TRUE(output_file_place(&file));
    TEST_ASSERT_EQUAL_STRING("new", get());
}

/* tearDown finds anything that is left. */
static void test_a_discarded_output_file_leaves_nothing(void)
{
    static struct output_file file;

    TEST_ASSERT_TRUE(output_file_open(&file, path));
    (void)fputs("new", file.stream);
    output_file_discard(&file);
    output_file_discard(&file);
    TEST_ASSERT_NULL(get());
    TEST_ASSERT_TRUE(output_file_open(&file, path));
    TEST_ASSERT_TRUE(output_file_finish(&file));
    output_file_discard(&file);
    TEST_ASSERT_NULL(get());
}

static void test_an_output_file_in_no_folder_is_refused(void)
{
    static struct output_file file;
    char nowhere[80];

    (void)snprintf(nowhere, sizeof nowhere, "%s/no/file", folder);
    TEST_ASSERT_FALSE(output_file_open(&file, nowhere));
    TEST_ASSERT_NULL(file.stream);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tool_table_is_read_as_linuxcnc_writes_it);
    RUN_TEST(test_a_tool_table_with_a_mistake_is_refused);
    RUN_TEST(test_many_tools_are_kept);
    RUN_TEST(test_parameters_are_read_and_written_again);
    RUN_TEST(test_a_parameter_file_with_a_mistake_is_refused);
    RUN_TEST(test_an_output_file_appears_when_it_is_placed);
    RUN_TEST(test_a_discarded_output_file_leaves_nothing);
    RUN_TEST(test_an_output_file_in_no_folder_is_refused);
    return UNITY_END();
}
