/*
 * Ctrl-C while a study computes. The linker leads resonance_fit here (--wrap), which asks for the
 * end as if it came in the middle of the work.
 */
#include "cli/interrupt.h"
#include "studies/resonance_test.h"
#include "unity.h"

#include <signal.h>
#include <string.h>

bool __wrap_resonance_fit(const struct resonance_record *record, struct resonance_fit *fit);

static unsigned fits;

bool __wrap_resonance_fit(const struct resonance_record *record, struct resonance_fit *fit)
{
    TEST_ASSERT_TRUE(record->count > 0);
    memset(fit, 0, sizeof *fit);
    fits++;
    TEST_ASSERT_EQUAL(0, raise(SIGINT));
    return true;
}

void setUp(void)
{
    interrupt_catch();
}

void tearDown(void)
{
}

static void test_the_search_for_modes_ends_behind_the_axis_at_which_it_is_asked(void)
{
    static struct resonance_test test;
    static struct options options;

    TEST_ASSERT_EQUAL_INT(STATUS_INTERRUPTED, resonance_test_run(&test, 0, &options));
    TEST_ASSERT_EQUAL_UINT(1, fits);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_search_for_modes_ends_behind_the_axis_at_which_it_is_asked);
    return UNITY_END();
}
