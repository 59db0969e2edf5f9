/*
 * takt as a library: the same run whatever the steps, the thread and the neighbours; nothing
 * printed; errors told.
 */
#include "library/library.h"

#include <pthread.h>
#include <string.h>
#include <unity.h>

#define PROGRAM "<program>"
#define THREADS 4

static const char short_move[] = "G21 G90\nG1 F3000 X5\nM2\n";
static const char wrong_move[] = "G21 G90\nG1 F100 X1 Q\nM2\n";

void setUp(void)
{
}

void tearDown(void)
{
}

/* A run of a text with one key of the machine set; NULL: none. */
static struct takt_job *open_run(const char *text, const char *set)
{
    const char *const argv[] = {"run", PROGRAM, "--set", set};
    const struct takt_text held = {PROGRAM, text, strlen(text)};

    return takt_open(set != NULL ? 4 : 2, argv, &held, 1);
}

/* Its digest at the end, going this many cycles at a time. */
static uint64_t digest_in_steps(const char *set, uint64_t cycles)
{
    struct takt_job *job = open_run(short_move, set);
    struct takt_state state;

    TEST_ASSERT_EQUAL_INT(0, takt_start(job, TAKT_KEEPS_TRACE));
    while (!takt_is_over(job))
        TEST_ASSERT_EQUAL_INT(0, takt_step(job, cycles));
    takt_get_state(job, &state);
    TEST_ASSERT_EQUAL_INT(0, takt_finish(job, 0));
    TEST_ASSERT_EQUAL_UINT64(state.cycles, takt_count_rows(job));
    takt_close(job);
    return state.digest;
}

static void test_steps_of_any_length_give_the_same_setpoints(void)
{
    const uint64_t digest = digest_in_steps(NULL, 1);

    TEST_ASSERT_EQUAL_UINT64(digest, digest_in_steps(NULL, 7));
    TEST_ASSERT_EQUAL_UINT64(digest, digest_in_steps(NULL, 1000000));
    TEST_ASSERT_TRUE(digest != digest_in_steps("axis.X.max_jerk_mm_s3=20000", 1000));
}

static const char *const machines[THREADS] = {
    "axis.X.max_jerk_mm_s3=10000", "axis.X.max_jerk_mm_s3=20000", "axis.X.max_jerk_mm_s3=30000",
    "axis.X.max_jerk_mm_s3=40000"};

struct threaded {
    const char *set;
    uint64_t digest;
};

static void *run_in_thread(void *context)
{
    struct threaded *t = context;

    t->digest = digest_in_steps(t->set, 13);
    return NULL;
}

static void test_threads_do_not_meet(void)
{
    struct threaded threaded[THREADS];
    pthread_t thread[THREADS];

    for (unsigned i = 0; i < THREADS; i++) {
        threaded[i] = (struct threaded){.set = machines[i]};
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread[i], NULL, run_in_thread, &threaded[i]));
    }
    for (unsigned i = 0; i < THREADS; i++) {
        TEST_ASSERT_EQUAL_INT(0, pthread_join(thread[i], NULL));
        TEST_ASSERT_EQUAL_UINT64(digest_in_steps(machines[i], 1000), threaded[i].digest);
    }
}

static void test_an_error_says_where(void)
{
    struct takt_job *job = open_run(wrong_move, NULL);
    const struct takt_message *message;
    unsigned count;

    TEST_ASSERT_EQUAL_INT(2, takt_start(job, 0));
    message = takt_get_messages(job, &count);
    TEST_ASSERT_EQUAL_UINT(1, count);
    TEST_ASSERT_EQUAL_STRING("error", message->kind);
    TEST_ASSERT_EQUAL_STRING(PROGRAM, message->file);
    TEST_ASSERT_EQUAL_UINT32(2, message->line);
    takt_close(job);
}

static void test_words_of_a_command_line_are_refused_as_there(void)
{
    const char *const argv[] = {"run", PROGRAM, "--nonsense"};
    struct takt_job *job = takt_open(3, argv, NULL, 0);
    unsigned count;

    TEST_ASSERT_EQUAL_INT(2, takt_start(job, 0));
    (void)takt_get_messages(job, &count);
    TEST_ASSERT_EQUAL_UINT(1, count);
    takt_close(job);
}

static void test_texts_are_those_of_the_commands(void)
{
    static const char *const commands[] = {"canon", "plan", "compile", "machine"};
    static const char *const begin[] = {"2 feed X5.000000", "{\n  \"program\"", "", "# A machine"};

    for (unsigned i = 0; i < 4; i++) {
        const char *const argv[] = {commands[i], PROGRAM};
        const struct takt_text held = {PROGRAM, short_move, strlen(short_move)};
        struct takt_job *job = takt_open(i < 3 ? 2 : 1, argv, &held, 1);
        size_t length;

        TEST_ASSERT_EQUAL_INT(0, takt_write(job));
        TEST_ASSERT_EQUAL_STRING_LEN(begin[i], takt_get_text(job, &length), strlen(begin[i]));
        TEST_ASSERT_TRUE(length > 0);
        takt_close(job);
    }
}

static void test_inputs_stay_in_their_ranges(void)
{
    struct takt_job *job = open_run(short_move, NULL);
    struct takt_inputs inputs;

    TEST_ASSERT_EQUAL_INT(0, takt_start(job, 0));
    takt_get_inputs(job, &inputs);
    TEST_ASSERT_EQUAL_DOUBLE(100, inputs.feed_override_percent);
    inputs.feed_override_percent = 120.5;
    TEST_ASSERT_EQUAL_INT(2, takt_set_inputs(job, &inputs));
    inputs.feed_override_percent = 50;
    TEST_ASSERT_EQUAL_INT(0, takt_set_inputs(job, &inputs));
    takt_get_inputs(job, &inputs);
    TEST_ASSERT_EQUAL_DOUBLE(50, inputs.feed_override_percent);
    takt_close(job);
}

/* Asked for help a command line is good, and still none to start a run by. */
static void test_help_is_no_run(void)
{
    const char *const argv[] = {"run", "--help"};
    struct takt_job *job = takt_open(2, argv, NULL, 0);
    unsigned count;

    TEST_ASSERT_EQUAL_INT(2, takt_start(job, 0));
    TEST_ASSERT_EQUAL_STRING("error", takt_get_messages(job, &count)[0].kind);
    takt_close(job);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_steps_of_any_length_give_the_same_setpoints);
    RUN_TEST(test_threads_do_not_meet);
    RUN_TEST(test_an_error_says_where);
    RUN_TEST(test_words_of_a_command_line_are_refused_as_there);
    RUN_TEST(test_help_is_no_run);
    RUN_TEST(test_texts_are_those_of_the_commands);
    RUN_TEST(test_inputs_stay_in_their_ranges);
    return UNITY_END();
}
