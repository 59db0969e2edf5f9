/*
 * Values of the keys: text to number, with their ranges.
 */
#include "inject/inject_private.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODE_MAX      127
#define ID_MAX        0x7FF
#define TIME_MAX_S    86400.0
#define NS_PER_SECOND 1e9

/* Digits in the base, nothing else, at most max. Hexadecimal numbers may begin with 0x. */
static bool read_integer(const char *text, int base, uint32_t max, uint32_t *value)
{
    const char *digits = base == 16 ? "0123456789abcdefABCDEF" : "0123456789";
    if (base == 16 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X'))
        text += 2;
    size_t length = strlen(text);
    if (length == 0 || length > 10 || strspn(text, digits) != length)
        return false;
    unsigned long long number = strtoull(text, NULL, base);
    if (number > max)
        return false;
    *value = (uint32_t)number;
    return true;
}

/* A number as people write it; nothing strtod knows beside it ("inf", "0x1p3"). */
static bool read_number(const char *text, char **end, double *value)
{
    if (strspn(text, "+-.0123456789eE") == 0)
        return false;
    if (text[strspn(text, "+-.")] < '0' || text[strspn(text, "+-.")] > '9' || strpbrk(text, "xX"))
        return false;
    *value = strtod(text, end);
    return *end != text && isfinite(*value);
}

bool inject_read_time(const char *text, uint64_t *time_ns)
{
    static const struct {
        const char *name;
        double seconds;
    } units[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}};
    char *end;
    double number;
    if (!read_number(text, &end, &number) || number < 0)
        return false;
    for (unsigned i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (strcmp(end, units[i].name) != 0)
            continue;
        if (number * units[i].seconds > TIME_MAX_S)
            return false;
        *time_ns = (uint64_t)(number * units[i].seconds * NS_PER_SECOND + 0.5);
        return true;
    }
    return false;
}

bool inject_read_node(const char *text, uint8_t *node)
{
    uint32_t number;
    if (!read_integer(text, 10, NODE_MAX, &number) || number == 0)
        return false;
    *node = (uint8_t)number;
    return true;
}

bool inject_read_address(const char *text, uint8_t *bus, uint8_t *node)
{
    *bus = 0;
    if (isdigit((unsigned char)text[0]) && text[1] == ':') {
        *bus = (uint8_t)(text[0] - '0');
        text += 2;
    }
    return inject_read_node(text, node);
}

static bool read_any_node(const char *text, uint8_t *node)
{
    if (strcmp(text, "controller") != 0)
        return inject_read_node(text, node);
    *node = INJECT_CONTROLLER;
    return true;
}

/* "6041", "1018:01". */
static bool read_object(struct inject_fault *fault, const char *text)
{
    char index[INJECT_WORD_MAX + 1];
    uint32_t main_index, sub = 0;
    const char *colon = strchr(text, ':');
    size_t length = colon ? (size_t)(colon - text) : strlen(text);
    if (length > INJECT_WORD_MAX)
        return false;
    memcpy(index, text, length);
    index[length] = '\0';
    if (!read_integer(index, 16, 0xFFFF, &main_index) || main_index == 0)
        return false;
    if (colon && !read_integer(colon + 1, 16, 0xFF, &sub))
        return false;
    fault->index = (uint16_t)main_index;
    fault->sub = (uint8_t)sub;
    return true;
}

static bool read_what(const char *text, enum inject_mute *what)
{
    static const char *const names[] = {
        [INJECT_MUTE_ALL] = "all",   [INJECT_MUTE_HEARTBEAT] = "heartbeat",
        [INJECT_MUTE_TPDO] = "tpdo", [INJECT_MUTE_SDO] = "sdo",
        [INJECT_MUTE_EMCY] = "emcy",
    };
    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(text, names[i]) == 0) {
            *what = (enum inject_mute)i;
            return true;
        }
    }
    return false;
}

static bool read_between(const char *text, double min, double max, double *value)
{
    char *end;
    double number;
    if (!read_number(text, &end, &number) || *end != '\0' || number < min || number > max)
        return false;
    *value = number;
    return true;
}

static bool read_id(const char *text, uint16_t *id)
{
    uint32_t number;
    if (!read_integer(text, 16, ID_MAX, &number))
        return false;
    *id = (uint16_t)number;
    return true;
}

static bool read_register(const char *text, uint8_t *error_register)
{
    uint32_t number;
    if (!read_integer(text, 16, 0xFF, &number))
        return false;
    *error_register = (uint8_t)number;
    return true;
}

static bool read_frames(const char *text, uint32_t *frames)
{
    if (strcmp(text, "all") != 0)
        return read_integer(text, 10, INJECT_ALL - 1, frames) && *frames > 0;
    *frames = INJECT_ALL;
    return true;
}

/* An emergency has 16 bits of code, and 0 would say that all is well. */
static bool read_code(struct inject_fault *fault, const char *text)
{
    uint32_t max = fault->kind == INJECT_SDO_ABORT ? UINT32_MAX : 0xFFFF;
    uint32_t number;
    if (!read_integer(text, 16, max, &number) || number == 0)
        return false;
    fault->code = number;
    return true;
}

static bool read_duration(const char *text, uint64_t *time_ns)
{
    uint64_t number;
    if (!inject_read_time(text, &number) || number == 0)
        return false;
    *time_ns = number;
    return true;
}

bool inject_read_value(struct inject_fault *fault, enum inject_key key, const char *value)
{
    switch (key) {
    case INJECT_KEY_NODE:
        return read_any_node(value, &fault->node);
    case INJECT_KEY_ID:
        return read_id(value, &fault->id);
    case INJECT_KEY_SKIP:
        return read_integer(value, 10, UINT32_MAX, &fault->skip);
    case INJECT_KEY_FRAMES:
        return read_frames(value, &fault->frames);
    case INJECT_KEY_RATIO:
        return read_between(value, 0, 1, &fault->ratio);
    case INJECT_KEY_SEED:
        return read_integer(value, 10, UINT32_MAX, &fault->seed);
    case INJECT_KEY_BY:
        return read_duration(value, &fault->by_ns);
    case INJECT_KEY_BY_MM:
        return read_between(value, -1e6, 1e6, &fault->by_mm);
    case INJECT_KEY_FOR:
        return read_duration(value, &fault->for_ns);
    case INJECT_KEY_OBJECT:
        return read_object(fault, value);
    case INJECT_KEY_VALUE:
        return read_integer(value, 16, UINT32_MAX, &fault->value);
    case INJECT_KEY_CODE:
        return read_code(fault, value);
    case INJECT_KEY_REGISTER:
        return read_register(value, &fault->error_register);
    case INJECT_KEY_WHAT:
        return read_what(value, &fault->what);
    case INJECT_KEYS:
        break;
    }
    return false;
}
