#include "console/lines.h"

#include "base/assert.h"

#include <string.h>

/* A line takes its mark and its end besides its characters. */
#define EMPTY_LINE 2U

/*
 * Between threads, or a background and what interrupts it: what was written before is there when
 * the new value is seen.
 */

static uint32_t get_place(const struct lines_place *place)
{
    return __atomic_load_n(&place->value, __ATOMIC_ACQUIRE);
}

static void set_place(struct lines_place *place, uint32_t value)
{
    __atomic_store_n(&place->value, value, __ATOMIC_RELEASE);
}

static bool get_flag(const struct lines_flag *flag)
{
    return __atomic_load_n(&flag->value, __ATOMIC_ACQUIRE);
}

static void set_flag(struct lines_flag *flag, bool value)
{
    __atomic_store_n(&flag->value, value, __ATOMIC_RELEASE);
}

void takt_lines_init(struct lines *l, uint8_t *byte, uint32_t size)
{
    TAKT_ASSERT((size & (size - 1)) == 0);
    memset(l, 0, sizeof *l);
    l->byte = byte;
    l->size = size;
}

static uint8_t *place(const struct lines *l, uint32_t at)
{
    TAKT_ASSERT(l->size > 0);
    return &l->byte[at & (l->size - 1)];
}

/* Behind the end of the whole line whose mark stands at a place. */
static uint32_t end_of(const struct lines *l, uint32_t mark)
{
    uint32_t at = mark + 1;

    while (*place(l, at) != '\n')
        at++;
    return at + 1;
}

static void copy_line(const struct lines *l, uint32_t mark, char *text)
{
    const uint32_t end = end_of(l, mark) - 1;
    uint32_t length = 0;

    for (uint32_t at = mark + 1; at != end; at++) {
        TAKT_ASSERT(length < LINES_LENGTH_MAX);
        text[length++] = (char)*place(l, at);
    }
    text[length] = '\0';
}

/* ---- console ---- */

static uint32_t free_bytes(const struct lines *l)
{
    TAKT_ASSERT(l->at - l->collected <= l->size);
    return l->size - (l->at - l->collected);
}

/* A line begins where more than an empty one finds room. */
static uint32_t room_of(uint32_t bytes)
{
    return bytes > 0 ? (bytes - 1U) / EMPTY_LINE : 0;
}

uint32_t takt_lines_room(const struct lines *l)
{
    return room_of(free_bytes(l));
}

uint32_t takt_lines_capacity(const struct lines *l)
{
    return room_of(l->size);
}

/* A line that is too long leaves its mark alone. */
static void finish_line(struct lines *l)
{
    TAKT_ASSERT(free_bytes(l) > 0);
    if (l->is_long) {
        l->at = l->written + 1;
        *place(l, l->written) = LINES_LONG;
    }
    *place(l, l->at++) = '\n';
    l->written = l->at;
    l->is_long = false;
}

/* There is always room for the end of a line that has begun. */
static bool put_character(struct lines *l, uint8_t byte)
{
    const bool has_room = free_bytes(l) >= EMPTY_LINE;

    if (!has_room || l->at - l->written > LINES_LENGTH_MAX)
        l->is_long = true;
    else
        *place(l, l->at++) = byte;
    return has_room;
}

bool takt_lines_put(struct lines *l, uint8_t byte)
{
    if (l->at == l->written) {
        if (free_bytes(l) <= EMPTY_LINE)
            return false;
        *place(l, l->at++) = LINES_NEW;
    }
    if (byte != '\n')
        return put_character(l, byte);
    finish_line(l);
    return true;
}

void takt_lines_spoil(struct lines *l)
{
    l->is_long = true;
}

void takt_lines_clear(struct lines *l)
{
    l->written = l->at = l->collected = 0;
    l->is_long = false;
    set_place(&l->released, 0);
    set_place(&l->read, 0);
    set_flag(&l->ends, false);
    set_flag(&l->has_why, false);
}

uint8_t takt_lines_look(const struct lines *l, char *text)
{
    const uint32_t at = get_place(&l->released);

    if (at == l->written)
        return 0;
    copy_line(l, at, text);
    return *place(l, at);
}

void takt_lines_release(struct lines *l)
{
    TAKT_ASSERT(get_place(&l->released) != l->written);
    set_place(&l->released, end_of(l, get_place(&l->released)));
}

/* A program passes over it; without one there is nobody else who would. */
void takt_lines_skip(struct lines *l)
{
    TAKT_ASSERT(get_place(&l->released) != l->written);
    *place(l, get_place(&l->released)) = LINES_OWN;
    takt_lines_release(l);
    if (!get_flag(&l->active))
        set_place(&l->read, get_place(&l->released));
}

void takt_lines_take_back(struct lines *l)
{
    set_place(&l->released, get_place(&l->read));
}

bool takt_lines_collect(struct lines *l, char *text, uint8_t *answer)
{
    while (l->collected != get_place(&l->read)) {
        *answer = *place(l, l->collected);
        copy_line(l, l->collected, text);
        l->last = l->collected;
        l->collected = end_of(l, l->collected);
        if (*answer < LINES_MARKS)
            return true;
    }
    return false;
}

void takt_lines_take_why(struct lines *l, struct diagnostic *why)
{
    why->code = TAKT_OK;
    if (!get_flag(&l->has_why) || l->why_at != l->last)
        return;
    *why = l->why;
    set_flag(&l->has_why, false);
}

bool takt_lines_are_read(const struct lines *l)
{
    return get_flag(&l->active);
}

void takt_lines_finish(struct lines *l)
{
    set_flag(&l->ends, true);
}

bool takt_lines_are_finished(const struct lines *l)
{
    return get_flag(&l->ends);
}

enum takt_error takt_lines_get_cause(const struct lines *l)
{
    return (enum takt_error)(int32_t)get_place(&l->cause);
}

/* ---- program ---- */

/*
 * The line handed out is done: its answer, then the place, so that the console finds the one when
 * it sees the other.
 */
static void finish_handed(struct lines *l)
{
    TAKT_ASSERT(l->is_handed);
    *place(l, get_place(&l->read)) = l->answer;
    l->is_handed = false;
    set_place(&l->read, l->end);
}

/*
 * The next line for the program; what the console has answered is passed over. False: there is
 * none.
 */
static bool hand_out(struct lines *l)
{
    const uint32_t released = get_place(&l->released);
    uint32_t at = get_place(&l->read);

    while (at != released && *place(l, at) == LINES_OWN)
        at = end_of(l, at);
    set_place(&l->read, at);
    if (at == released)
        return false;
    l->is_handed = true;
    l->out = at + 1;
    l->end = end_of(l, at);
    l->answer = 0;
    return true;
}

static long read_line(void *context, char *buffer, size_t size)
{
    struct lines *l = context;
    size_t count = 0;

    if (l->is_handed && l->out == l->end)
        finish_handed(l);
    if (!l->is_handed && !hand_out(l))
        return get_flag(&l->ends) ? SOURCE_END : SOURCE_LATER;
    for (; count < size && l->out != l->end; l->out++)
        buffer[count++] = (char)*place(l, l->out);
    return (long)count;
}

void takt_lines_open(struct lines *l, struct source *source)
{
    TAKT_ASSERT(!get_flag(&l->active));
    l->is_handed = false;
    set_flag(&l->ends, false);
    set_place(&l->cause, (uint32_t)TAKT_OK);
    set_flag(&l->active, true);
    *source = (struct source){.read = read_line, .context = l};
}

void takt_lines_refuse(struct lines *l, uint8_t answer, const struct diagnostic *why)
{
    if (!l->is_handed || l->answer != 0)
        return;
    l->answer = answer;
    if (get_flag(&l->has_why))
        return;
    l->why = *why;
    l->why_at = get_place(&l->read);
    set_flag(&l->has_why, true);
}

void takt_lines_end(struct lines *l, uint8_t answer, enum takt_error cause)
{
    if (l->is_handed) {
        l->answer = l->answer != 0 ? l->answer : answer;
        finish_handed(l);
    }
    set_place(&l->cause, (uint32_t)cause);
    set_flag(&l->active, false);
}
