/*
 * Blocks are read back from the ring as they were pushed: moves and curves to the last bit, limits
 * never above theirs.
 */
#include "plan/path.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

#define MOVES 20000

static const struct plan_limits limits = {63,
                                          {100, 100, 100, 10, 10, 10},
                                          {1000, 1000, 1000, 100, 100, 100},
                                          {50000, 50000, 50000, 5000, 5000, 5000},
                                          1e-3,
                                          1e-3,
                                          RAMP_PROFILE_JERK,
                                          LANDING_SPAN};

static struct path path;
static uint64_t seed;

/* Pushed and not passed yet. */
static struct expected {
    struct move move;
    struct curve curve;
    bool motion;
    uint32_t number;
} expected[PATH_BLOCKS_MAX];

void setUp(void)
{
    const struct point start = {{0}};

    seed = 1;
    takt_path_init(&path, &limits, &start);
}

void tearDown(void)
{
}

/* 0 <= x < 1. Knuth's linear congruential generator (MMIX). */
static double uniform(void)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(seed >> 11) * 0x1p-53;
}

static unsigned below(unsigned count)
{
    return (unsigned)(uniform() * count);
}

static void set_modes(struct move *m)
{
    static float zero_mm = 0.0F;

    if (below(50) == 0) {
        zero_mm = (float)uniform();
    }
    m->work_mm[AXIS_X] = zero_mm;
    m->overhang_mm[AXIS_Z] = 120.5F;
    m->tool = 7;
    m->overrides = below(20) == 0 ? 0U : OVERRIDE_FEED | OVERRIDE_HOLD;
    m->correction_off = 3;
    m->contour_side = CUTTER_LEFT;
}

static void set_event(struct move *m)
{
    m->kind = (enum move_kind)(MOVE_DWELL + below(MOVE_END - MOVE_DWELL + 1));
    m->dwell_s = uniform();
    m->speed_rpm = 1000.0 * uniform();
    m->direction = SPINDLE_CCW;
    m->orient_rad = uniform();
    m->channel = below(4);
    m->output = uniform();
    m->optional = below(2) == 0;
    m->flood = below(2) == 0;
    m->input_wait = INPUT_FALL;
}

static void set_arc(struct move *m, const struct point *from)
{
    m->kind = below(2) == 0 ? MOVE_ARC_CW : MOVE_ARC_CCW;
    m->turns = 1 + below(3);
    m->centre_mm[0] = from->at[AXIS_X] + 5.0 + uniform();
    m->centre_mm[1] = from->at[AXIS_Y];
    m->end.at[AXIS_X] = 2.0 * m->centre_mm[0] - from->at[AXIS_X];
    m->end.at[AXIS_Y] = from->at[AXIS_Y];
    if (below(2) == 0) {
        m->end.at[AXIS_C] = uniform();
    }
}

static void set_line(struct move *m)
{
    static const enum move_kind kinds[] = {MOVE_FEED, MOVE_FEED, MOVE_RAPID, MOVE_PROBE,
                                           MOVE_TAP_OUT};

    m->kind = kinds[below(5)];
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        m->end.at[i] = below(3) == 0 ? m->end.at[i] : 20.0 * uniform() - 10.0;
    }
    m->end.at[AXIS_X] += 0.5 + uniform();
    m->probe_away = m->kind == MOVE_PROBE && below(2) == 0;
    m->speed_ratio = m->kind == MOVE_TAP_OUT ? 1.5 : 0.0;
    m->feed_rev_mm = below(4) == 0 ? 0.25 : 0.0;
}

static void push_any(void)
{
    struct expected e;

    memset(&e, 0, sizeof(e));
    e.move.line = 50000 + 3 * path.pushed;
    e.move.feed_mm_s = 1.0 + 60.0 * uniform();
    set_modes(&e.move);
    if (below(10) == 0) {
        set_event(&e.move);
        e.number = path.motions;
    } else {
        e.move.end = path.end;
        if (below(3) == 0) {
            set_arc(&e.move, &path.end);
        } else {
            set_line(&e.move);
        }
        e.motion = true;
        e.number = path.motions + 1;
        TEST_ASSERT_TRUE(takt_move_curve(&e.move, &path.end, &e.curve));
    }
    expected[path.pushed % PATH_BLOCKS_MAX] = e;
    takt_path_push(&path, &e.move);
}

static void check_point(const struct point *a, const struct point *b)
{
    TEST_ASSERT_EQUAL_MEMORY(a->at, b->at, sizeof(a->at));
}

static void check_number(double a, double b)
{
    TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof(a));
}

static void check_curve(const struct curve *a, const struct curve *b)
{
    TEST_ASSERT_EQUAL(a->kind, b->kind);
    TEST_ASSERT_EQUAL(a->rotary, b->rotary);
    check_number(a->length_mm, b->length_mm);
    check_point(&a->start, &b->start);
    check_point(&a->end, &b->end);
    check_point(&a->slope, &b->slope);
    for (unsigned i = 0; i < 9; i++) {
        struct point p, q;
        const double s = a->length_mm * i / 8.0;

        takt_curve_point(a, s, &p);
        takt_curve_point(b, s, &q);
        check_point(&p, &q);
    }
}

/* scale: of the path, by which a feed per revolution is kept */
static void check_move(const struct move *a, const struct move *b, double scale)
{
    TEST_ASSERT_EQUAL(a->kind, b->kind);
    TEST_ASSERT_EQUAL(a->line, b->line);
    TEST_ASSERT_EQUAL(a->overrides, b->overrides);
    TEST_ASSERT_EQUAL_MEMORY(a->work_mm, b->work_mm, sizeof(a->work_mm));
    TEST_ASSERT_EQUAL_MEMORY(a->overhang_mm, b->overhang_mm, sizeof(a->overhang_mm));
    TEST_ASSERT_EQUAL(a->tool, b->tool);
    TEST_ASSERT_EQUAL(a->correction_off, b->correction_off);
    TEST_ASSERT_EQUAL(a->contour_side, b->contour_side);
    TEST_ASSERT_EQUAL(a->turns, b->turns);
    TEST_ASSERT_EQUAL(a->probe_away, b->probe_away);
    check_number(a->feed_rev_mm / scale, b->feed_rev_mm);
    check_number(a->speed_ratio, b->speed_ratio);
    check_point(&a->end, &b->end);
}

static void check_event(const struct move *a, const struct move *b)
{
    check_number(a->dwell_s, b->dwell_s);
    check_number(a->speed_rpm, b->speed_rpm);
    check_number(a->orient_rad, b->orient_rad);
    check_number(a->output, b->output);
    TEST_ASSERT_EQUAL(a->direction, b->direction);
    TEST_ASSERT_EQUAL(a->channel, b->channel);
    TEST_ASSERT_EQUAL(a->optional, b->optional);
    TEST_ASSERT_EQUAL(a->flood, b->flood);
    TEST_ASSERT_EQUAL(a->input_wait, b->input_wait);
}

/*
 * Read in one, or in up to four parts, and before it is the oldest one. Needs two that are closed.
 */
static void pass_and_check(void)
{
    for (unsigned parts = below(9); parts > 0; parts--) {
        path_prepare(&path, path.first + below(2));
    }
    const struct block *b = path_first(&path);
    const struct expected *e = &expected[path.first % PATH_BLOCKS_MAX];

    TEST_ASSERT_EQUAL(e->number, b->number);
    check_move(&e->move, &b->move, e->motion ? b->scale : 1.0);
    if (e->motion) {
        check_curve(&e->curve, &b->curve);
    } else {
        check_event(&e->move, &b->move);
    }
    takt_path_pass(&path);
    path.kept = path.first;
}

static void test_what_is_read_is_what_was_pushed_however_often_the_ring_goes_round(void)
{
    unsigned fullest = 0;

    /* Records have the lower halves of line and number: both pass 65,536. */
    path.motions = 60000;
    for (unsigned done = 0; done < MOVES;) {
        while (takt_path_has_room(&path) && below(400) != 0) {
            push_any();
            done++;
        }
        if (path.pushed - path.first > fullest) {
            fullest = path.pushed - path.first;
        }
        for (unsigned i = below(300); i > 0 && path.first + 1 < path.closed; i--) {
            pass_and_check();
        }
    }
    TEST_ASSERT_GREATER_THAN(100, fullest);
}

static void test_limits_are_never_above_the_exact_ones(void)
{
    const double part = 1.0 - 0x1p-23;

    for (unsigned i = 0; i < 1000; i++) {
        struct point from = {{uniform()}};
        struct move m;
        struct curve curve;
        struct block exact;

        memset(&m, 0, sizeof(m));
        m.feed_mm_s = 1.0 + 60.0 * uniform();
        if (below(2) == 0) {
            set_arc(&m, &from);
        } else {
            set_line(&m);
        }
        TEST_ASSERT_TRUE(takt_move_curve(&m, &from, &curve));
        takt_block_set_motion(&exact, &m, &curve, &limits);
        takt_block_set_jerk_budget(&exact, BLOCK_JERK_BUDGET_MAX * uniform());
        takt_ring_push(&path.ring, i, i, &exact, NULL);
        takt_ring_limit(&path.ring, i, &exact);
        const struct path_block *b = ring_at(&path.ring, i);

        TEST_ASSERT_TRUE((double)b->a_mm_s2 <= exact.a_mm_s2);
        TEST_ASSERT_TRUE((double)b->j_mm_s3 <= exact.j_mm_s3);
        TEST_ASSERT_TRUE(takt_path_block_top(b) <= exact.feed_max_mm_s);
        TEST_ASSERT_TRUE((double)b->a_mm_s2 >= part * exact.a_mm_s2);
        TEST_ASSERT_TRUE((double)b->j_mm_s3 >= part * exact.j_mm_s3);
        TEST_ASSERT_TRUE(takt_path_block_top(b) >= part * exact.feed_max_mm_s);
    }
}

/* Lines of six axes take more bytes than there are for every block. */
static void test_a_full_ring_of_bytes_is_no_room(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = 50.0;
    while (takt_path_has_room(&path)) {
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            m.end.at[i] += 1.0 + uniform();
        }
        takt_path_push(&path, &m);
    }
    TEST_ASSERT_LESS_THAN(PATH_BLOCKS_MAX - RECORD_BEFORE, path.pushed);
    TEST_ASSERT_GREATER_THAN(180, path.pushed);
    path.first = 10;
    path.kept = 10;
    TEST_ASSERT_TRUE(takt_path_has_room(&path));
}

static void test_lines_of_three_axes_fill_all_blocks(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = 50.0;
    while (takt_path_has_room(&path)) {
        for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
            m.end.at[i] += 1.0 + uniform();
        }
        takt_path_push(&path, &m);
    }
    TEST_ASSERT_EQUAL(PATH_BLOCKS_MAX - RECORD_BEFORE, path.pushed);
}

static void test_no_more_modes_than_there_are_places_for_is_no_room(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = 50.0;
    while (takt_path_has_room(&path)) {
        m.end.at[AXIS_X] += 1.0;
        m.tool++;
        takt_path_push(&path, &m);
    }
    TEST_ASSERT_EQUAL(PATH_MODES_MAX, path.pushed);
    path.first = 1;
    path.kept = 1;
    TEST_ASSERT_TRUE(takt_path_has_room(&path));
}

/* Blocks that are not closed yet need room for those that close them. */
static void test_short_blocks_of_a_mode_each_never_stand_for_ever(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = 50.0;
    for (unsigned i = 0; i < 1000; i++) {
        m.end.at[AXIS_X] += 0.001;
        m.tool++;
        takt_path_push(&path, &m);
        while (path.first + 1 < path.closed) {
            takt_path_pass(&path);
        }
        path.kept = path.first;
        TEST_ASSERT_TRUE(takt_path_has_room(&path));
    }
}

static struct point random_point(void)
{
    return (struct point){{uniform(), uniform(), uniform(), 0.0, uniform()}};
}

static void read_back(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                      const struct record_modes *modes, struct block *b)
{
    takt_record_take(record, before, takt_record_begin(record, modes, b), b);
    (void)takt_record_begin_curve(record, b);
    takt_record_finish(record, b);
}

/*
 * Every piece from its own control point and those of the three before it, one of which has all its
 * own.
 */
static void test_a_piece_of_a_smoothed_curve_is_found_from_those_before(void)
{
    static uint8_t bytes[8][RECORD_MAX];
    struct point control[11];
    struct record_chain chain;
    struct record_modes modes;
    struct block b, back;
    uint32_t size[8];

    takt_record_begin_chain(&chain);
    memset(&b, 0, sizeof(b));
    b.move.kind = MOVE_FEED;
    for (unsigned i = 0; i < 11; i++) {
        control[i] = random_point();
    }
    for (unsigned i = 0; i < 8; i++) {
        const uint8_t *const before[RECORD_BEFORE] = {
            i > 0 ? bytes[i - 1] : NULL, i > 1 ? bytes[i - 2] : NULL, i > 2 ? bytes[i - 3] : NULL};

        takt_curve_set_spline(&b.curve, &control[i], 0.1 + uniform());
        b.move.end = i == 7 ? b.curve.end : control[0];
        takt_record_modes_of(&b, true, &modes);
        size[i] = takt_record_write(bytes[i], &b, &control[i], 0, &chain);
        read_back(bytes[i], before, &modes, &back);
        check_curve(&b.curve, &back.curve);
    }
    TEST_ASSERT_LESS_THAN(size[0] / 2, size[1]);
    check_point(&b.move.end, &back.move.end);
}

/* In pieces, as the path cuts it. */
static void test_pieces_of_an_involute_are_read_back(void)
{
    static uint8_t bytes[2][RECORD_MAX];
    const double centre[2] = {1.0, 2.0};
    const struct point from = {{4.0, 2.0, 0.5}}, to = {{-7.5, 8.25, 1.5}};
    struct record_chain chain;
    struct record_modes modes;
    struct curve whole;
    struct block b, back;
    double at_mm = 0.0;

    takt_record_begin_chain(&chain);
    memset(&b, 0, sizeof(b));
    b.move.kind = MOVE_INVOLUTE_CCW;
    b.move.end = to;
    takt_record_modes_of(&b, false, &modes);
    TEST_ASSERT_TRUE(takt_curve_set_involute(&whole, &from, &to, PLANE_XY, centre, 1.0, false));
    for (unsigned i = 0; at_mm < whole.length_mm; i++) {
        const double to_mm = takt_curve_piece_end(&whole, at_mm);
        const uint8_t *const before[RECORD_BEFORE] = {i > 0 ? bytes[1 - i % 2] : NULL};

        takt_curve_cut(&whole, at_mm, to_mm, &b.curve);
        (void)takt_record_write(bytes[i % 2], &b, NULL, 0, &chain);
        read_back(bytes[i % 2], before, &modes, &back);
        check_curve(&b.curve, &back.curve);
        check_point(&b.move.end, &back.move.end);
        TEST_ASSERT_EQUAL(b.curve.involute.cusp_start, back.curve.involute.cusp_start);
        at_mm = to_mm;
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_read_is_what_was_pushed_however_often_the_ring_goes_round);
    RUN_TEST(test_limits_are_never_above_the_exact_ones);
    RUN_TEST(test_a_full_ring_of_bytes_is_no_room);
    RUN_TEST(test_lines_of_three_axes_fill_all_blocks);
    RUN_TEST(test_no_more_modes_than_there_are_places_for_is_no_room);
    RUN_TEST(test_short_blocks_of_a_mode_each_never_stand_for_ever);
    RUN_TEST(test_a_piece_of_a_smoothed_curve_is_found_from_those_before);
    RUN_TEST(test_pieces_of_an_involute_are_read_back);
    return UNITY_END();
}
