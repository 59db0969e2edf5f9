/*
 * A build without the forms of interpolation and feed for comparison refuses machines that ask for
 * them.
 */
#include "classic/classic.h"
#include "classic/interpolator.h"
#include "classic/limiter.h"
#include "machine/machine_check.h"
#include "unity.h"

static struct machine machine;

/* In the place of the room's own. */
bool takt_classic_is_there(void)
{
    return false;
}

void setUp(void)
{
    takt_machine_set_default(&machine);
}

void tearDown(void)
{
}

static void expect(const char *text)
{
    struct diagnostic wrong;
    char said[DIAGNOSTIC_TEXT_MAX];

    TEST_ASSERT_FALSE(takt_machine_check(&machine, &wrong));
    TEST_ASSERT_EQUAL(TAKT_ERROR_MACHINE_FORM, wrong.code);
    (void)takt_diagnostic_text(&wrong, said);
    TEST_ASSERT_EQUAL_STRING(text, said);
}

static void test_the_default_machine_can_work(void)
{
    struct diagnostic wrong;

    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
}

static void test_an_interpolator_a_limiter_and_a_landing_for_comparison_are_refused(void)
{
    machine.interpolator = INTERPOLATOR_ROTATE;
    expect("'interpolator' of this machine is for comparison: this image has only its default");
    takt_machine_set_default(&machine);
    machine.limiter = LIMITER_SMOOTH;
    expect("'limiter' of this machine is for comparison: this image has only its default");
    takt_machine_set_default(&machine);
    machine.landing = LANDING_SCALE;
    expect("'landing' of this machine is for comparison: this image has only its default");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_default_machine_can_work);
    RUN_TEST(test_an_interpolator_a_limiter_and_a_landing_for_comparison_are_refused);
    return UNITY_END();
}
