/* What a sender is told of a probing move. */
#include "console_bench.h"

/* It has touched at 1.25, -2.5, 3.75, or has not. */
static bool touched;

static bool tell_touch(void *context, enum console_fact fact, double value[AXIS_COUNT])
{
    (void)context;
    takt_service_tell(&service, fact, value);
    if (fact == CONSOLE_FACT_PROBE) {
        value[AXIS_X] = 1.25;
        value[AXIS_Y] = -2.5;
        value[AXIS_Z] = 3.75;
    } else if (fact == CONSOLE_FACT_WORDS) {
        value[0] = touched ? 1.0 : 0.0;
    }
    return true;
}

void setUp(void)
{
    console_bench_set_up(0);
    console.config.port.tell = tell_touch;
}

void tearDown(void)
{
}

static void test_the_place_of_the_last_touch_is_told_on_every_axis_and_whether_there_was_one(void)
{
    touched = true;
    ask("$#", "[PRB:1.250,-2.500,3.750:1]\r\n");
    touched = false;
    ask("$#", "[PRB:1.250,-2.500,3.750:0]\r\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_place_of_the_last_touch_is_told_on_every_axis_and_whether_there_was_one);
    return UNITY_END();
}
