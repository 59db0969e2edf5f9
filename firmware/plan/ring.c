#include "plan/ring.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/scale.h"

#include <string.h>

_Static_assert(PATH_BYTES_MAX / PATH_BYTES_STEP <= 1 << 12, "places fit into path_block.record");
_Static_assert(RAMP_PROFILE_CYCLES_MAX < 1 << 9, "windows fit into path_block.cycles");
_Static_assert(sizeof(struct path_block) == 32, "no padding");

double takt_path_block_top(const struct path_block *b)
{
    return maths_min(BLOCK_OVERRIDE_MAX * (double)b->feed_program_mm_s, (double)b->feed_limit_mm_s);
}

/* -- room -- */

/* The oldest block whose record must stay: those before the oldest one are needed to read it. */
static uint32_t oldest_record(uint32_t kept)
{
    return kept > RECORD_BEFORE ? kept - RECORD_BEFORE : 0;
}

/*
 * Where a record of that size begins that is written now: it does not wrap around. False: no room.
 */
static bool find_place(const struct path_ring *r, uint32_t tail, uint32_t size, uint32_t *place)
{
    TAKT_ASSERT(size <= RECORD_MAX && r->place <= PATH_BYTES_MAX);
    *place = r->place;
    if (r->place >= tail && r->place + size <= PATH_BYTES_MAX) {
        return true;
    }
    if (r->place >= tail) {
        *place = 0;
    }
    return *place + size < tail;
}

/* Modes that no block has any more; PATH_MODES_MAX: there are none. */
static unsigned free_modes(const struct path_ring *r, uint32_t kept)
{
    unsigned k = 0;

    while (k < PATH_MODES_MAX && r->modes_used[k] != 0 && (int32_t)(r->modes_used[k] - kept) > 0) {
        k++;
    }
    return k;
}

bool takt_ring_has_room(const struct path_ring *r, uint32_t kept, uint32_t pushed, uint32_t size)
{
    const uint32_t oldest = oldest_record(kept);
    const uint32_t tail =
        oldest == pushed ? PATH_BYTES_MAX : ring_at(r, oldest)->record * PATH_BYTES_STEP;
    uint32_t place;

    TAKT_ASSERT(pushed - kept <= PATH_BLOCKS_MAX - RECORD_BEFORE);
    return pushed - kept < PATH_BLOCKS_MAX - RECORD_BEFORE && find_place(r, tail, size, &place) &&
           free_modes(r, kept) < PATH_MODES_MAX;
}

/* -- writing -- */

/* Place of the new modes, which are most often those of the newest block. */
static unsigned find_modes(struct path_ring *r, uint32_t kept, const struct record_modes *modes)
{
    unsigned k = r->modes_newest;

    for (unsigned i = 0; i < PATH_MODES_MAX; i++, k = (k + 1) % PATH_MODES_MAX) {
        if (r->modes_used[k] != 0 && takt_record_is_same(&r->modes[k], modes, sizeof(*modes))) {
            return k;
        }
    }
    k = free_modes(r, kept);
    TAKT_ASSERT(k < PATH_MODES_MAX);
    r->modes[k] = *modes;
    return k;
}

static unsigned push_modes(struct path_ring *r, uint32_t kept, uint32_t pushed,
                           const struct block *b, bool smooth)
{
    struct record_modes modes;

    takt_record_modes_of(b, smooth, &modes);
    r->modes_newest = find_modes(r, kept, &modes);
    r->modes_used[r->modes_newest] = pushed + 1;
    return r->modes_newest;
}

static uint32_t push_record(struct path_ring *r, const struct block *b,
                            const struct point control[4], unsigned modes)
{
    uint8_t bytes[RECORD_MAX];
    const uint32_t size = takt_record_write(bytes, b, control, modes, &r->chain);
    const uint32_t place = r->place + size <= PATH_BYTES_MAX ? r->place : 0;

    TAKT_ASSERT(size <= RECORD_MAX && place + size <= PATH_BYTES_MAX &&
                place % PATH_BYTES_STEP == 0);
    memcpy(&r->byte[place], bytes, size);
    r->place = (place + size + PATH_BYTES_STEP - 1) / PATH_BYTES_STEP * PATH_BYTES_STEP;
    return place;
}

void takt_ring_push(struct path_ring *r, uint32_t kept, uint32_t pushed, const struct block *b,
                    const struct point control[4])
{
    TAKT_ASSERT(takt_ring_has_room(r, kept, pushed, RECORD_SHORT_MAX));
    const unsigned modes = push_modes(r, kept, pushed, b, control != NULL);
    const uint32_t place = push_record(r, b, control, modes);
    const unsigned may = b->move.overrides;

    r->block[pushed % PATH_BLOCKS_MAX] = (struct path_block){
        .start = b->start,
        .feed_program_mm_s = takt_maths_float_below(b->feed_program_mm_s),
        .record = (place / PATH_BYTES_STEP) & 0xfffU,
        .motion = block_is_motion(b),
        .rapid = b->move.kind == MOVE_RAPID,
        .rotary = b->curve.rotary,
        .may_feed = (may & OVERRIDE_FEED) != 0,
        .may_hold = (may & OVERRIDE_HOLD) != 0,
        .per_revolution = b->move.feed_rev_mm != 0.0,
        .smooth = control != NULL,
    };
}

void takt_ring_limit(struct path_ring *r, uint32_t index, const struct block *b)
{
    struct path_block *to = &r->block[index % PATH_BLOCKS_MAX];
    enum governor governor = GOVERNOR_PROGRAM;
    const double limit_mm_s = takt_block_limit(b, &governor);
    TAKT_ASSERT(limit_mm_s >= 0.0 && b->a_mm_s2 >= 0.0 && b->j_mm_s3 >= 0.0);

    to->feed_limit_mm_s = takt_maths_float_below(limit_mm_s);
    to->a_mm_s2 = takt_maths_float_below(b->a_mm_s2);
    to->j_mm_s3 = takt_maths_float_below(b->j_mm_s3);
    takt_record_set_governor(&r->byte[(size_t)to->record * PATH_BYTES_STEP], governor);
}

void takt_ring_join(struct path_ring *r, uint32_t index, const struct block *b)
{
    struct path_block *to = &r->block[index % PATH_BLOCKS_MAX];

    TAKT_ASSERT(b->feed_junction_mm_s >= 0.0 && b->end <= JUNCTION_STOP);
    to->feed_junction_mm_s = takt_maths_float_below(b->feed_junction_mm_s);
    to->end = (unsigned)b->end & 3U;
    to->continues = b->continues;
}

void takt_ring_promise(struct path_ring *r, uint32_t index, uint32_t cycles, bool known)
{
    struct path_block *b = &r->block[index % PATH_BLOCKS_MAX];

    TAKT_ASSERT(cycles <= RAMP_PROFILE_CYCLES_MAX);
    b->cycles = cycles & 0x1ffU;
    b->cycles_known = known;
}

/* -- reading -- */

static const struct record_modes *modes_of(const struct path_ring *r, uint32_t index)
{
    const unsigned number = takt_record_modes_number(ring_record(r, index));

    TAKT_ASSERT(number < PATH_MODES_MAX);
    return &r->modes[number];
}

void takt_ring_read_move(const struct path_ring *r, uint32_t index, struct move *move)
{
    takt_record_read_move(ring_record(r, index), modes_of(r, index), move);
}

static void read_limits(const struct path_block *from, uint64_t end, struct block *b)
{
    TAKT_ASSERT(!from->motion || (int64_t)(end - from->start) >= 0);
    b->start = from->start;
    b->length = from->motion ? end - from->start : 0;
    b->feed_program_mm_s = (double)from->feed_program_mm_s;
    b->feed_cap_mm_s = (double)from->feed_limit_mm_s;
    b->feed_max_mm_s = takt_path_block_top(from);
    b->a_mm_s2 = (double)from->a_mm_s2;
    b->j_mm_s3 = (double)from->j_mm_s3;
    b->feed_junction_mm_s = (double)from->feed_junction_mm_s;
    b->end = (enum junction_kind)from->end;
    b->curve.rotary = from->rotary;
    b->continues = from->continues;
}

static void find_before(const struct path_ring *r, uint32_t index,
                        const uint8_t *before[RECORD_BEFORE])
{
    for (uint32_t i = 0; i < RECORD_BEFORE; i++) {
        before[i] = i < index ? ring_record(r, index - 1 - i) : NULL;
    }
}

void takt_ring_control(const struct path_ring *r, uint32_t index, struct point control[4])
{
    const uint8_t *before[RECORD_BEFORE];

    find_before(r, index, before);
    takt_record_control(ring_record(r, index), before, control);
}

static void take(struct path_ring *r, uint32_t index, struct path_view *view)
{
    const uint8_t *before[RECORD_BEFORE];

    find_before(r, index, before);
    takt_record_take(ring_record(r, index), before, view->from, &view->block);
}

static void finish(const struct path_ring *r, uint32_t index, uint64_t end, struct block *b)
{
    b->scale = takt_scale_of_curve(&b->curve, &r->scale);
    b->length_mm = b->curve.length_mm / b->scale;
    read_limits(ring_at(r, index), end, b);
}

void takt_ring_prepare(struct path_ring *r, uint32_t index, uint64_t end)
{
    struct path_view *view = &r->view[index % 2];
    const uint8_t *record = ring_record(r, index);

    switch (view->index == index ? view->state : VIEW_EMPTY) {
    case VIEW_EMPTY:
        view->from = takt_record_begin(record, modes_of(r, index), &view->block);
        view->state = VIEW_BEGUN;
        view->index = index;
        break;
    case VIEW_BEGUN:
        take(r, index, view);
        view->state = VIEW_TAKEN;
        break;
    case VIEW_TAKEN:
        view->state = VIEW_CURVED;
        if (takt_record_begin_curve(record, &view->block)) {
            break; /* the end of an arc is a part for itself */
        }
        /* fall through */
    case VIEW_CURVED:
        takt_record_finish(record, &view->block);
        view->state = VIEW_FINISHED;
        break;
    case VIEW_FINISHED:
        finish(r, index, end, &view->block);
        view->state = VIEW_READ;
        break;
    case VIEW_READ:
        break;
    }
}

const struct block *takt_ring_read(struct path_ring *r, uint32_t index, uint64_t end)
{
    while (!ring_is_read(r, index)) {
        takt_ring_prepare(r, index, end);
    }
    return &r->view[index % 2].block;
}
