/*
 * What tests of host/dialect share: a text and what it becomes.
 */
#ifndef TAKT_TESTS_DIALECT_EXPECT_H
#define TAKT_TESTS_DIALECT_EXPECT_H

#include "dialect/dialect.h"

#include "unity.h"

#include <string.h>

static struct dialect_result result;
static struct dialect_codes codes;

void setUp(void)
{
    codes.count = codes.values = 0;
}

void tearDown(void)
{
    dialect_text_free(&result.text);
}

/* A text becomes another one; "|" begins what goes on with the line before. */
static inline void expect(enum dialect dialect, const char *from, const char *to)
{
    char found[4096];

    TEST_ASSERT_TRUE(dialect_translate(dialect, &codes, NULL, from, strlen(from), &result));
    TEST_ASSERT_TRUE(result.text.length < sizeof found);
    memcpy(found, result.text.bytes, result.text.length);
    found[result.text.length] = '\0';
    for (char *c = found; *c != '\0'; c++)
        if (*c == DIALECT_GOES_ON)
            *c = '|';
    TEST_ASSERT_EQUAL_STRING(to, found);
    dialect_text_free(&result.text);
}

static inline struct dialect_guess guess(const char *text)
{
    struct dialect_detector detector = {0};

    while (*text != '\0') {
        const size_t length = strcspn(text, "\n");

        dialect_guess_line(&detector, text, length, &codes);
        text += length + (text[length] == '\n' ? 1 : 0);
    }
    return dialect_guess_end(&detector);
}

#endif
