#include "cli/suggest.h"

#include <ctype.h>
#include <string.h>

static unsigned smaller(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

static int lower(char c)
{
    return tolower((unsigned char)c);
}

/*
 * One row of the table of distances. Optimal string alignment:
 *   d(i, j) = min(d(i-1, j) + 1, d(i, j-1) + 1, d(i-1, j-1) + [a_i != b_j], and d(i-2, j-2) + 1 for a swap).
 */
static void distance_row(unsigned row[], const unsigned up[], const unsigned up2[], const char *a,
                         size_t i, const char *b)
{
    row[0] = (unsigned)i;
    for (size_t j = 1; b[j - 1] != '\0'; j++) {
        unsigned best = smaller(up[j], row[j - 1]) + 1;

        best = smaller(best, up[j - 1] + (lower(a[i - 1]) != lower(b[j - 1])));
        if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
            lower(a[i - 2]) == lower(b[j - 1]))
            best = smaller(best, up2[j - 2] + 1);
        row[j] = best;
    }
}

/*
 * Fills in the table of distances. Returns its last row: element j is the distance of a to the
 * first j letters of b.
 */
static const unsigned *distance_rows(unsigned rows[3][SUGGEST_WORD_MAX + 1], const char *a,
                                     const char *b)
{
    size_t length = strlen(b);

    for (size_t j = 0; j <= length; j++)
        rows[0][j] = (unsigned)j;
    for (size_t i = 1; a[i - 1] != '\0'; i++)
        distance_row(rows[i % 3], rows[(i + 2) % 3], rows[(i + 1) % 3], a, i, b);
    return rows[strlen(a) % 3];
}

unsigned suggest_distance(const char *a, const char *b)
{
    unsigned rows[3][SUGGEST_WORD_MAX + 1] = {{0}};

    return distance_rows(rows, a, b)[strlen(b)];
}

/* Distance to the nearest beginning of b, and one more: a whole word is better. */
static unsigned beginning_distance(const char *a, const char *b)
{
    unsigned rows[3][SUGGEST_WORD_MAX + 1] = {{0}};
    const unsigned *last = distance_rows(rows, a, b);
    unsigned least = last[0];

    for (size_t j = 1; j <= strlen(b); j++)
        least = smaller(least, last[j]);
    return least + 1;
}

const char *suggest_word(const char *word, const char *const words[], size_t count)
{
    const char *nearest = NULL;
    unsigned limit = (unsigned)strlen(word) / 3 + 1;

    if (strlen(word) > SUGGEST_WORD_MAX)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        unsigned distance;

        if (strlen(words[i]) > SUGGEST_WORD_MAX)
            continue;
        distance = smaller(suggest_distance(word, words[i]), beginning_distance(word, words[i]));
        if (distance < limit) {
            limit = distance;
            nearest = words[i];
        }
    }
    return nearest;
}
