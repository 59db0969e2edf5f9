/* firmware/base/fnv.h against FNV-1a over a string of bytes, itself checked by published values. */
#include "base/fnv.h"

#include "unity.h"

#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static uint64_t fnv_of_bytes(uint64_t digest, const unsigned char *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++)
        digest = (digest ^ bytes[i]) * UINT64_C(1099511628211);
    return digest;
}

static uint64_t fnv_of_string(const char *s)
{
    return fnv_of_bytes(FNV_START, (const unsigned char *)s, strlen(s));
}

/* From the test vectors of the algorithm's authors. */
static void test_the_comparison_gives_the_published_values(void)
{
    TEST_ASSERT_TRUE(fnv_of_string("") == UINT64_C(0xcbf29ce484222325));
    TEST_ASSERT_TRUE(fnv_of_string("a") == UINT64_C(0xaf63dc4c8601ec8c));
    TEST_ASSERT_TRUE(fnv_of_string("foobar") == UINT64_C(0x85944171f73967e8));
}

static void check_double(double value, const char *bytes_from_the_least)
{
    uint64_t expected = fnv_of_bytes(FNV_START, (const unsigned char *)bytes_from_the_least, 8);
    TEST_ASSERT_TRUE(takt_fnv_add_double(FNV_START, value) == expected);
}

static void test_a_double_counts_as_its_eight_bytes_from_the_least_significant(void)
{
    check_double(0.0, "\0\0\0\0\0\0\0\0");
    check_double(-0.0, "\0\0\0\0\0\0\0\x80");
    check_double(1.0, "\0\0\0\0\0\0\xf0\x3f");
    check_double(-2.0, "\0\0\0\0\0\0\0\xc0");
    check_double(0x1.23456789abcdep+10, "\xde\xbc\x9a\x78\x56\x34\x92\x40");
}

static void test_the_order_of_values_counts(void)
{
    uint64_t forward = takt_fnv_add_double(takt_fnv_add_double(FNV_START, 1.0), 2.0);
    uint64_t backward = takt_fnv_add_double(takt_fnv_add_double(FNV_START, 2.0), 1.0);
    TEST_ASSERT_TRUE(forward != backward);
    TEST_ASSERT_TRUE(forward ==
                     fnv_of_bytes(FNV_START,
                                  (const unsigned char *)"\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\0\x40",
                                  16));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_comparison_gives_the_published_values);
    RUN_TEST(test_a_double_counts_as_its_eight_bytes_from_the_least_significant);
    RUN_TEST(test_the_order_of_values_counts);
    return UNITY_END();
}
