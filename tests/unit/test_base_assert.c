/*
 * A broken invariant in a program on a desk: it says file, line and condition, and aborts. In every
 * kind of build.
 */
#define _POSIX_C_SOURCE 200809L /* fork, pipe */

#include "base/assert.h"

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_one_that_holds_costs_nothing_else(void)
{
    int evaluated = 0;

    TAKT_ASSERT(++evaluated == 1);
    TEST_ASSERT_EQUAL(1, evaluated);
}

/* A process of its own whose standard error is the pipe. */
static _Noreturn void break_one(const int *ends)
{
    const int channel = 7;

    (void)dup2(ends[1], STDERR_FILENO);
    TAKT_ASSERT(channel == 8);
    _exit(0);
}

static void test_a_broken_one_says_where_and_aborts(void)
{
    char text[200] = "";
    int ends[2], status;

    TEST_ASSERT_EQUAL(0, pipe(ends));
    const pid_t child = fork();
    if (child == 0)
        break_one(ends);
    TEST_ASSERT_EQUAL(child, waitpid(child, &status, 0));
    TEST_ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT);
    TEST_ASSERT_TRUE(read(ends[0], text, sizeof text - 1) > 0);
    TEST_ASSERT_NOT_NULL(strstr(text, "test_base_assert.c:"));
    TEST_ASSERT_NOT_NULL(strstr(text, ": broken invariant: channel == 8\n"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_one_that_holds_costs_nothing_else);
    RUN_TEST(test_a_broken_one_says_where_and_aborts);
    return UNITY_END();
}
