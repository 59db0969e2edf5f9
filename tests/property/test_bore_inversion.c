/*
 * The start angle of a hole-milling spiral, found from the distance of its start: for random base
 * circles, numbers of turns and starts, also within a nanometre of the centre and of the circle.
 *
 * test_bore_inversion NUMBER tries this many instead of RUNS.
 */
#include "base/maths.h"
#include "bore/spiral.h"
#include "property_arguments.h"

#include <stdio.h>
#include <unity.h>

#define RUNS 200000

static unsigned runs = RUNS;
static uint64_t seed;

void setUp(void)
{
    seed = 1;
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* Half of them anywhere, a quarter each within a nanometre of the centre and of the circle. */
static double random_distance(unsigned run, double radius_mm)
{
    const double near_mm = 1e-9 * random_between(0.0, 1.0);

    if (run % 4 == 0) {
        return near_mm;
    }
    return run % 4 == 1 ? radius_mm - near_mm : random_between(0.0, radius_mm);
}

static void test_every_start_is_found(void)
{
    double worst = 0.0;

    for (unsigned run = 0; run < runs; run++) {
        const double radius_mm = takt_maths_power(10.0, random_between(-1.0, 3.0));
        const unsigned turns = 1U + (unsigned)random_between(0.0, run % 7 == 0 ? 2000.0 : 30.0);
        const double distance_mm = random_distance(run, radius_mm);
        const double angle = random_between(-3.2, 3.2);
        const double start[2] = {distance_mm * takt_maths_cos(angle),
                                 distance_mm * takt_maths_sin(angle)};
        struct bore_spiral s;
        double p[2];
        char where[120];

        bore_spiral_set(&s, radius_mm, turns);
        bore_spiral_begin_at(&s, start);
        bore_spiral_point(&s, s.start_rad, p);
        const double x = p[0] - start[0];
        const double y = p[1] - start[1];
        const double off = maths_sqrt(x * x + y * y) / radius_mm;

        (void)snprintf(where, sizeof(where), "run %d: R %.17g, n %u, distance %.17g: off %g R", run,
                       radius_mm, turns, distance_mm, off);
        TEST_ASSERT_TRUE_MESSAGE(s.start_rad >= 0.0 && s.start_rad <= MATHS_TWO_PI * turns, where);
        TEST_ASSERT_TRUE_MESSAGE(off < 1e-14, where);
        worst = maths_max(worst, off);
    }
    (void)printf("a million starts hit within %.2g of the radius\n", worst);
}

int main(int argc, char **argv)
{
    read_number(argc, argv, &runs);
    UNITY_BEGIN();
    RUN_TEST(test_every_start_is_found);
    return UNITY_END();
}
