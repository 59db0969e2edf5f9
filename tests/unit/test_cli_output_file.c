/*
 * What reaches the disk, and in which order. The linker leads fsync and rename here (--wrap), which
 * look at the files and pass the call on; a power cut between two of them leaves what was brought
 * to the disk before.
 */
#define _XOPEN_SOURCE 700

#include "cli/files_read.h"
#include "cli/output_file.h"
#include "unity.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define CALLS_MAX 8

int __real_fsync(int descriptor);
int __real_rename(const char *from, const char *to);
int __wrap_fsync(int descriptor);
int __wrap_rename(const char *from, const char *to);

enum call { CALL_SYNC, CALL_SYNC_FOLDER, CALL_RENAME };

struct made {
    enum call call;
    ino_t file;
    off_t size;
};

static struct made made[CALLS_MAX];
static unsigned calls;
static int file_error, folder_error; /* what fsync ends with; 0: done */
static char folder[] = "output-XXXXXX";

static void note(enum call call, const struct stat *status)
{
    TEST_ASSERT_LESS_THAN(CALLS_MAX, calls);
    made[calls++] = (struct made){call, status->st_ino, status->st_size};
}

int __wrap_fsync(int descriptor)
{
    struct stat status;
    int error;

    TEST_ASSERT_EQUAL(0, fstat(descriptor, &status));
    note(S_ISDIR(status.st_mode) ? CALL_SYNC_FOLDER : CALL_SYNC, &status);
    error = S_ISDIR(status.st_mode) ? folder_error : file_error;
    if (error == 0)
        return __real_fsync(descriptor);
    errno = error;
    return -1;
}

int __wrap_rename(const char *from, const char *to)
{
    struct stat status;

    TEST_ASSERT_EQUAL(0, stat(from, &status));
    note(CALL_RENAME, &status);
    return __real_rename(from, to);
}

static ino_t number_of(const char *path)
{
    struct stat status;

    TEST_ASSERT_EQUAL(0, stat(path, &status));
    return status.st_ino;
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");

    TEST_ASSERT_NOT_NULL(file);
    (void)fputs(text, file);
    TEST_ASSERT_EQUAL(0, fclose(file));
}

static void check_text(const char *path, const char *text)
{
    char there[64] = "";
    FILE *file = fopen(path, "r");

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_UINT(strlen(text), fread(there, 1, sizeof there - 1, file));
    (void)fclose(file);
    TEST_ASSERT_EQUAL_STRING(text, there);
}

static unsigned files_in(const char *path)
{
    DIR *listing = opendir(path);
    unsigned count = 0;

    TEST_ASSERT_NOT_NULL(listing);
    for (const struct dirent *entry = readdir(listing); entry != NULL; entry = readdir(listing))
        count += entry->d_name[0] != '.';
    (void)closedir(listing);
    return count;
}

void setUp(void)
{
    calls = 0;
    file_error = folder_error = 0;
    (void)strcpy(folder, "output-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    TEST_ASSERT_EQUAL(0, chdir(folder));
    write_text("a", "old");
}

void tearDown(void)
{
    (void)unlink("a");
    (void)unlink("b");
    TEST_ASSERT_EQUAL(0, chdir(".."));
    TEST_ASSERT_EQUAL(0, rmdir(folder));
}

static void write_new(struct output_file *file, const char *path)
{
    TEST_ASSERT_TRUE(output_file_open(file, path));
    (void)fputs("new text", file->stream);
}

static void test_a_file_is_on_the_disk_before_its_name_and_its_name_before_the_end(void)
{
    struct output_file file;

    write_new(&file, "a");
    TEST_ASSERT_TRUE(output_file_finish(&file));
    check_text("a", "old");
    TEST_ASSERT_TRUE(output_file_place(&file));
    check_text("a", "new text");
    TEST_ASSERT_EQUAL(3, calls);
    TEST_ASSERT_EQUAL(CALL_SYNC, made[0].call);
    TEST_ASSERT_EQUAL(8, made[0].size);
    TEST_ASSERT_EQUAL(CALL_RENAME, made[1].call);
    TEST_ASSERT_EQUAL(8, made[1].size);
    TEST_ASSERT_TRUE(made[0].file == made[1].file && made[0].file == number_of("a"));
    TEST_ASSERT_EQUAL(CALL_SYNC_FOLDER, made[2].call);
    TEST_ASSERT_TRUE(made[2].file == number_of("."));
}

static void test_the_folder_is_that_of_the_file(void)
{
    struct output_file file;

    TEST_ASSERT_EQUAL(0, mkdir("sub", 0777));
    write_new(&file, "sub/b");
    TEST_ASSERT_TRUE(output_file_finish(&file) && output_file_place(&file));
    TEST_ASSERT_EQUAL(CALL_SYNC_FOLDER, made[2].call);
    TEST_ASSERT_TRUE(made[2].file == number_of("sub"));
    TEST_ASSERT_EQUAL(0, unlink("sub/b"));
    TEST_ASSERT_EQUAL(0, rmdir("sub"));
}

static void test_all_files_of_a_command_are_on_the_disk_before_the_first_is_placed(void)
{
    struct output_file a, b;

    write_new(&a, "a");
    write_new(&b, "b");
    TEST_ASSERT_TRUE(output_file_finish(&a) && output_file_finish(&b));
    TEST_ASSERT_EQUAL(2, calls);
    TEST_ASSERT_TRUE(made[0].call == CALL_SYNC && made[1].call == CALL_SYNC);
    TEST_ASSERT_TRUE(output_file_place(&a) && output_file_place(&b));
}

static void test_a_file_that_does_not_reach_the_disk_leaves_the_old_one(void)
{
    struct output_file file;

    file_error = EIO;
    write_new(&file, "a");
    TEST_ASSERT_FALSE(output_file_finish(&file));
    check_text("a", "old");
    TEST_ASSERT_EQUAL(1, files_in("."));
    TEST_ASSERT_EQUAL(1, calls);
}

static void test_a_folder_that_cannot_be_brought_to_the_disk_is_no_error(void)
{
    struct output_file file;

    folder_error = EINVAL;
    write_new(&file, "a");
    TEST_ASSERT_TRUE(output_file_finish(&file) && output_file_place(&file));
    check_text("a", "new text");
}

static void test_a_file_that_is_given_up_is_not_brought_to_the_disk(void)
{
    struct output_file file;

    write_new(&file, "a");
    output_file_discard(&file);
    check_text("a", "old");
    TEST_ASSERT_EQUAL(1, files_in("."));
    TEST_ASSERT_EQUAL(0, calls);
}

static void test_what_is_no_regular_file_is_written_straight(void)
{
    struct output_file file;

    write_new(&file, "/dev/null");
    TEST_ASSERT_TRUE(output_file_finish(&file) && output_file_place(&file));
    TEST_ASSERT_EQUAL(0, calls);
}

static void test_a_file_that_is_read_is_not_written_over(void)
{
    struct output_file file;

    files_read_begin();
    files_read_note("a");
    TEST_ASSERT_FALSE(output_file_open(&file, "./a"));
    check_text("a", "old");
    TEST_ASSERT_TRUE(output_file_replace(&file, "a", "./a"));
    TEST_ASSERT_TRUE(output_file_finish(&file) && output_file_place(&file));
    files_read_begin();
    write_new(&file, "a");
    files_read_note("a");
    TEST_ASSERT_FALSE(output_file_finish(&file));
    TEST_ASSERT_EQUAL(1, files_in("."));
    files_read_begin();
}

static void test_two_options_of_a_command_do_not_write_one_file(void)
{
    const char *const option[] = {"output", "json", "report"};

    TEST_ASSERT_EQUAL(0, symlink("a", "link"));
    TEST_ASSERT_TRUE(output_file_differ(option, (const char *const[]){"a", NULL, "new"}, 3));
    TEST_ASSERT_FALSE(output_file_differ(option, (const char *const[]){"a", NULL, "link"}, 3));
    TEST_ASSERT_FALSE(output_file_differ(option, (const char *const[]){NULL, "new", "new"}, 3));
    TEST_ASSERT_FALSE(output_file_differ(option, (const char *const[]){"-", "a", "-"}, 3));
    TEST_ASSERT_EQUAL(0, unlink("link"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_file_is_on_the_disk_before_its_name_and_its_name_before_the_end);
    RUN_TEST(test_the_folder_is_that_of_the_file);
    RUN_TEST(test_all_files_of_a_command_are_on_the_disk_before_the_first_is_placed);
    RUN_TEST(test_a_file_that_does_not_reach_the_disk_leaves_the_old_one);
    RUN_TEST(test_a_folder_that_cannot_be_brought_to_the_disk_is_no_error);
    RUN_TEST(test_a_file_that_is_given_up_is_not_brought_to_the_disk);
    RUN_TEST(test_what_is_no_regular_file_is_written_straight);
    RUN_TEST(test_a_file_that_is_read_is_not_written_over);
    RUN_TEST(test_two_options_of_a_command_do_not_write_one_file);
    return UNITY_END();
}
