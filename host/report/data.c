#include "report/data.h"

#include "base/maths.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- columns of numbers ---- */

/* RFC 4648: three bytes become four characters. They are collected first, and written at once. */
#define BASE64_BYTES 3072 /* a multiple of three */

struct base64 {
    FILE *file;
    unsigned count;
    uint8_t byte[BASE64_BYTES];
};

/* The last three are filled up with zeros; of each byte that is missing one character is =. */
static void base64_finish(struct base64 *b)
{
    static const char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned missing = (BASE64_BYTES - b->count) % 3;
    char text[BASE64_BYTES / 3 * 4], *end = text;
    memset(b->byte + b->count, 0, missing);
    for (const uint8_t *byte = b->byte; byte < b->byte + b->count; byte += 3) {
        *end++ = alphabet[byte[0] >> 2];
        *end++ = alphabet[(byte[0] << 4 | byte[1] >> 4) & 63];
        *end++ = alphabet[(byte[1] << 2 | byte[2] >> 6) & 63];
        *end++ = alphabet[byte[2] & 63];
    }
    memset(end - missing, '=', missing);
    (void)fwrite(text, 1, (size_t)(end - text), b->file);
    b->count = 0;
}

static void base64_add_byte(struct base64 *b, unsigned byte)
{
    b->byte[b->count++] = (uint8_t)byte;
    if (b->count == BASE64_BYTES)
        base64_finish(b);
}

static void base64_add_u32(struct base64 *b, uint32_t value)
{
    for (unsigned shift = 0; shift < 32; shift += 8)
        base64_add_byte(b, value >> shift & 255u);
}

static void base64_add_float(struct base64 *b, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    base64_add_u32(b, bits);
}

/* ---- series over time ---- */

static void write_series(FILE *file, const struct thin *thin, unsigned series,
                         struct thin_point *point)
{
    const unsigned count = thin_get_points(thin, series, point);
    struct base64 column = {.file = file};
    (void)fprintf(file, "{\"count\":%u,\"cycle\":\"", count);
    for (unsigned i = 0; i < count; i++)
        base64_add_u32(&column, point[i].cycle);
    base64_finish(&column);
    (void)fputs("\",\"value\":\"", file);
    for (unsigned i = 0; i < count; i++)
        base64_add_float(&column, point[i].value);
    base64_finish(&column);
    (void)fputs("\"}", file);
}

static void write_axis(FILE *file, const struct recording *rec, unsigned i,
                       struct thin_point *point)
{
    static const char *const name[AXIS_SERIES_COUNT] = {"velocity", "acceleration", "jerk",
                                                        "following"};
    const struct axis_history *axis = &rec->axis[i];
    (void)fprintf(file, "%s{\"name\":\"%c\",\"rotary\":%s,\"limit\":{", i > 0 ? ",\n" : "",
                  AXIS_LETTERS[axis->axis], axis->axis >= AXIS_LINEAR_COUNT ? "true" : "false");
    (void)fprintf(file, "\"velocity\":%.9g,\"acceleration\":%.9g,\"jerk\":%.9g}",
                  rec->limits.velocity_mm_s[axis->axis] * axis->edge_ratio,
                  rec->limits.acceleration_mm_s2[axis->axis] * axis->edge_ratio,
                  rec->limits.jerk_mm_s3[axis->axis] * axis->edge_ratio);
    for (unsigned series = 0; series < AXIS_SERIES_COUNT; series++) {
        (void)fprintf(file, ",\n\"%s\":", name[series]);
        write_series(file, &rec->thin, recording_axis_series(i, (enum axis_series)series), point);
    }
    (void)fputc('}', file);
}

static void write_all_series(FILE *file, const struct recording *rec, struct thin_point *point)
{
    static const char *const name[RUN_SERIES_COUNT] = {"feed", "override", "limiter"};
    for (unsigned series = 0; series < RUN_SERIES_COUNT; series++) {
        (void)fprintf(file, "\"%s\":", name[series]);
        write_series(file, &rec->thin, series, point);
        (void)fputs(",\n", file);
    }
    (void)fputs("\"axes\":[", file);
    for (unsigned i = 0; i < rec->axis_count; i++)
        write_axis(file, rec, i, point);
    (void)fputs("],\n", file);
}

/* ---- path ---- */

static void write_path_counters(FILE *file, const struct trail *trail)
{
    struct base64 column = {.file = file};
    (void)fputs("\"cycle\":\"", file);
    for (uint32_t k = 0; k < trail->count; k++)
        base64_add_u32(&column, trail->kept[k].cycle);
    base64_finish(&column);
    (void)fputs("\",\n\"line\":\"", file);
    for (uint32_t k = 0; k < trail->count; k++)
        base64_add_u32(&column, trail->kept[k].line);
    base64_finish(&column);
    (void)fputs("\",\n\"rapid\":\"", file);
    for (uint32_t k = 0; k < trail->count; k++)
        base64_add_byte(&column, trail->kept[k].rapid);
    base64_finish(&column);
}

static void write_path_numbers(FILE *file, const struct trail *trail)
{
    struct base64 column = {.file = file};
    (void)fputs("\",\n\"feed\":\"", file);
    for (uint32_t k = 0; k < trail->count; k++)
        base64_add_float(&column, (float)(trail->kept[k].feed_mm_s * 60.0));
    base64_finish(&column);
    for (unsigned axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
        (void)fprintf(file, "\",\n\"%c\":\"", AXIS_LETTERS[axis]);
        for (uint32_t k = 0; k < trail->count; k++)
            base64_add_float(&column, (float)trail->kept[k].at_mm[axis]);
        base64_finish(&column);
    }
    (void)fputc('"', file);
}

static void write_path(FILE *file, const struct trail *trail)
{
    (void)fprintf(file, "\"path\":{\"error_mm\":%.9g,\"count\":%" PRIu32 ",\n",
                  trail_get_error_mm(trail), trail->count);
    write_path_counters(file, trail);
    write_path_numbers(file, trail);
    (void)fputs("}", file);
}

bool data_write(FILE *file, const struct recording *rec)
{
    struct thin_point *point = malloc(THIN_POINTS_MAX * sizeof *point);
    if (point == NULL)
        return false;
    (void)fprintf(file, "{\"cycle_s\":%.9g,\"cycles\":%" PRIu64 ",\"width_cycles\":%" PRIu32 ",\n",
                  rec->limits.cycle_s, rec->cycles, rec->thin.width_cycles);
    write_all_series(file, rec, point);
    write_path(file, &rec->trail);
    (void)fputs("}", file);
    free(point);
    return ferror(file) == 0;
}
