/*
 * Turning cycles of Fanuc and Haas in those of LinuxCNC. The profile is blocks N10 to N20 of the
 * program, behind G71; it becomes a subroutine in front of the cycle, and the blocks themselves are
 * passed over:
 *
 *     G71 P10 Q20 U0.4 W0.1 D2. F0.2      o93000010 sub / ... / o93000010 endsub
 *                                         G71 Q93000010 D0.2 I2. R0.5, and back to where it began
 *     G70 P10 Q20                         G42 / G70 Q93000010 / G40, if the profile has G42
 *     G75 X0. I1.                         steps of 1 down to X0, a little back after each
 *     G74 R0.5 / G74 Z-40. Q5000          the same along Z, 0.5 back after each
 *     G76 X8. Z-20. K1.2 D0.4 F1.5        G76 P1.5 Z-20 I... J0.8 K2.4 R2
 *     G76 P020560 Q100 R50                2 finishing cuts, run-out over half a turn, flanks of 60 degrees
 *     G76 X8. Z-20. P1200 Q400 F1.5       the same thread, K and D in thousandths
 *
 * The two-line forms of G71 and G72 (G71 U2. R0.5 before) are read too.
 */
#include "lathe/lathe.h"

#include <stdio.h>
#include <string.h>

#define PROFILE_LABEL 93000000U
#define PECK_LABEL    94000000U
#define THREAD_LABEL  96000000U
/* Diameters that are as good as none: where the tool may be below the crest, and at least above. */
#define BELOW_MAX "0.0001"
#define GAP_MIN   "0.0000001"

/* The text of a word's value, as an expression; otherwise without it. */
static void expression(struct line *l, char letter, const char *otherwise, char *text, size_t size)
{
    const struct line_word *w = line_find(l, letter, 0);

    if (w != NULL)
        (void)snprintf(text, size, "%.*s", (int)(w->end - w->value_begin),
                       &l->text[w->value_begin]);
    else
        (void)snprintf(text, size, "%s", otherwise);
}

/* F and S of the line stay. */
static void leave_feed(struct translator *t)
{
    struct line *l = &t->line;

    for (unsigned i = 0; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind != WORD_COMMENT && (w->kind != WORD_VALUE || strchr("fsn", w->letter) == NULL))
            line_blank(l, w);
    }
}

/* ---- profiles ---- */

static const char *next_line(const struct translator *t, const char *at, struct line *l)
{
    const char *end = t->source + t->source_length;
    const char *stop = memchr(at, '\n', (size_t)(end - at));

    stop = stop != NULL ? stop : end;
    if (!line_read(l, at, (size_t)(stop - at)))
        (void)line_read(l, "", 0);
    return stop < end ? stop + 1 : end;
}

static bool has_number(const struct line *l, double number)
{
    const struct line_word *n = line_number(l);

    return n != NULL && n->value == number;
}

/* Side of the profile's compensation: 41, 42 or 0. */
static unsigned copy_profile(struct translator *t, double from, double to, unsigned label)
{
    static _Thread_local struct line l;
    const char *at = t->source;
    unsigned side = 0;
    bool inside = false;

    translate_add(&t->before, "o%u sub", label);
    while (at < t->source + t->source_length) {
        at = next_line(t, at, &l);
        inside = inside || has_number(&l, from);
        if (!inside)
            continue;
        side = line_find_code(&l, 'g', 410) != NULL ? 41 : side;
        side = line_find_code(&l, 'g', 420) != NULL ? 42 : side;
        const bool last = has_number(&l, to);

        /* A last block at rapid leaves the part: it is no piece of it. */
        if (last && line_find_code(&l, 'g', 0) != NULL && line_find(&l, 'z', 0) != NULL)
            break;
        for (unsigned i = 0; i < l.words; i++) {
            struct line_word *w = &l.word[i];

            if (w->kind != WORD_VALUE || strchr("xzuwirkac", w->letter) == NULL) {
                const int code = w->letter == 'g' ? line_code(w) : -1;

                if (code < 0 || code > 30)
                    line_blank(&l, w);
            }
        }
        if (!line_is_blank(&l))
            translate_add(&t->before, "%s", l.text);
        if (last)
            break;
    }
    translate_add(&t->before, "o%u endsub", label);
    return side;
}

static const struct turned *find_profile(struct translator *t, double from, double to)
{
    for (unsigned i = 0; i < t->profiles; i++) {
        if (t->profile[i].from == from && t->profile[i].to == to)
            return &t->profile[i];
    }
    if (t->profiles == TRANSLATE_LINES_MAX)
        return NULL;
    struct turned *p = &t->profile[t->profiles];

    *p = (struct turned){from, to, PROFILE_LABEL + line_whole(from), 0};
    p->label += 10000U * t->profiles++;
    p->side = copy_profile(t, from, to, p->label);
    return p;
}

/* ---- cycles ---- */

/* A value of whole thousandths, in inches ten-thousandths, if it is written without a point. */
static void thousandths(struct line *l, char letter, char *text, size_t size)
{
    const struct line_word *w = line_find(l, letter, 0);

    if (w != NULL && w->is_number && !w->has_point)
        (void)snprintf(text, size, "%.0f*[0.001-0.0009*#<_imperial>]", w->value);
    else
        expression(l, letter, "", text, size);
}

/*
 * From here on a distance without a point is in thousandths: no allowance and no depth of cut is
 * that large.
 */
#define WHOLE_MIN 100.0

bool turning_is_whole(struct line *l)
{
    if (line_find_code(l, 'g', 710) == NULL && line_find_code(l, 'g', 720) == NULL)
        return false;
    for (const char *letter = "uwrd"; *letter != '\0'; letter++) {
        const struct line_word *w = line_find(l, *letter, 0);

        if (w != NULL && w->is_number && !w->has_point && w->value >= WHOLE_MIN)
            return true;
    }
    return false;
}

/* A distance of G71 or G72. */
static void distance(struct translator *t, char letter, const char *otherwise, char *text,
                     size_t size)
{
    if (t->survey.whole && line_find(&t->line, letter, 0) != NULL)
        thousandths(&t->line, letter, text, size);
    else
        expression(&t->line, letter, otherwise, text, size);
}

static void begin_at(struct translator *t)
{
    translate_add(&t->before, "#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>");
}

static void go_back(struct translator *t)
{
    translate_add(&t->behind, "G0 X#<_turning_x>");
    translate_add(&t->behind, "Z#<_turning_z>");
}

/* G71 U2. R0.5: the depth and the way back of the next one. */
static void take_depths(struct translator *t)
{
    distance(t, 'u', "", t->depth_of_cut, sizeof t->depth_of_cut);
    distance(t, 'r', "", t->way_back, sizeof t->way_back);
    leave_feed(t);
}

static void take_rough(struct translator *t, unsigned code, double from, double to)
{
    const struct turned *p = find_profile(t, from, to);
    char depth[48];
    char u[48];
    char w[48];

    if (p == NULL)
        return;
    distance(t, 'd', t->depth_of_cut[0] != '\0' ? t->depth_of_cut : "1", depth, sizeof depth);
    distance(t, 'u', "0", u, sizeof u);
    distance(t, 'w', "0", w, sizeof w);
    leave_feed(t);
    begin_at(t);
    if (t->side != 0)
        translate_add(&t->before, "G40");
    /* the larger of U/2 and W remains everywhere */
    translate_add(&t->behind, "G%u Q%u D[[ABS[%s]/2+ABS[%s]+ABS[ABS[%s]/2-ABS[%s]]]/2] I[%s] R[%s]",
                  code / 10, p->label, u, w, u, w, depth,
                  t->way_back[0] != '\0' ? t->way_back : "0.5-0.48*#<_imperial>");
    go_back(t);
    if (t->side != 0)
        translate_add(&t->behind, "G%u", t->side);
    t->skip_from = from;
    t->skip_to = to;
}

static void take_finish(struct translator *t, double from, double to)
{
    const struct turned *p = find_profile(t, from, to);

    if (p == NULL)
        return;
    leave_feed(t);
    begin_at(t);
    const unsigned side = p->side != 0 ? p->side : t->side;

    if (t->side != 0)
        translate_add(&t->before, "G40");
    if (side != 0)
        translate_add(&t->behind, "G%u", side);
    translate_add(&t->behind, "G70 Q%u", p->label);
    if (side != 0)
        translate_add(&t->behind, "G40");
    go_back(t);
    if (t->side != 0)
        translate_add(&t->behind, "G%u", t->side);
}

/*
 * To `end` in steps, a little back after each: where the tool is stands in #<_turning_at>, and in
 * #<_turning_way> 1 where that falls, -1 where it rises (a groove from inside).
 */
static void put_pecks(struct translator *t, char axis, const char *end, const char *step,
                      const char *back)
{
    const unsigned label = PECK_LABEL + t->number % 1000000U;

    leave_feed(t);
    begin_at(t);
    translate_add(&t->behind, "#<_turning_at>=#<_turning_%c>", axis);
    translate_add(&t->behind, "#<_turning_way>=[1-2*[[%s] GT #<_turning_at>]]", end);
    translate_add(&t->behind, "o%u repeat [FUP[ABS[#<_turning_at>-[%s]]/[%s]]]", label, end, step);
    translate_add(&t->behind, "#<_turning_at>=[#<_turning_at>-#<_turning_way>*[%s]]", step);
    translate_add(&t->behind, "o%u if [#<_turning_way>*[#<_turning_at>-[%s]] LT 0]",
                  label + 1000000U, end);
    translate_add(&t->behind, "#<_turning_at>=[%s]", end);
    translate_add(&t->behind, "o%u endif", label + 1000000U);
    translate_add(&t->behind, "G1 %c#<_turning_at>", axis);
    translate_add(&t->behind, "G0 %c[#<_turning_at>+#<_turning_way>*[%s]]", axis, back);
    translate_add(&t->behind, "o%u endrepeat", label);
    go_back(t);
}

/* The step of a peck: I or K, or thousandths in P or Q. */
static void peck_step(struct line *l, char letter, char whole, char *text, size_t size)
{
    expression(l, letter, "", text, size);
    if (text[0] == '\0')
        thousandths(l, whole, text, size);
}

/* G75 down to X, G74 along Z; without either word it says how far a peck goes back. */
static void take_pecks(struct translator *t, char axis, char across)
{
    const double diameters = axis == 'x' ? 2.0 : 1.0;
    char end[48];
    char one[64];
    char step[96];
    char back[96];

    expression(&t->line, axis, "", end, sizeof end);
    if (end[0] == '\0' && line_find(&t->line, across, 0) == NULL &&
        line_find(&t->line, 'r', 0) != NULL) {
        take_depths(t);
        return;
    }
    peck_step(&t->line, axis == 'x' ? 'i' : 'k', axis == 'x' ? 'p' : 'q', one, sizeof one);
    if (end[0] == '\0' || one[0] == '\0' || line_find(&t->line, across, 0) != NULL)
        return;
    (void)snprintf(step, sizeof step, "%.0f*[%s]", diameters, one);
    (void)snprintf(back, sizeof back, "%.1f*[%s]",
                   t->way_back[0] != '\0' ? diameters : 0.1 * diameters,
                   t->way_back[0] != '\0' ? t->way_back : one);
    put_pecks(t, axis, end, step, back);
}

/* Of X or Z, or of the distances U and W to them. */
static void reach(struct line *l, char letter, char by, const char *from, char *text, size_t size)
{
    char value[48];

    expression(l, by, "", value, sizeof value);
    if (value[0] != '\0')
        (void)snprintf(text, size, "%s+[%s]", from, value);
    else
        expression(l, letter, "", text, size);
}

/* Diameters: the ground X, the height of the thread and its first cut. */
struct thread {
    char x[80], z[80], height[64], first[64], pitch[48];
    double finishing; /* cuts at full depth */
    double run_out;   /* turns of the spindle */
    double angle_deg; /* between the flanks */
};

/*
 * Outwards or inwards, and how far the tool is from the crest: it may touch it, from below the
 * crest it would come back through the thread.
 */
static void put_gap(struct translator *t, const struct thread *h)
{
    const unsigned label = THREAD_LABEL + t->number % 1000000U;

    translate_add(&t->behind, "#<_thread_way>=[1-2*[[%s] LT 2*#<_x>]]", h->x);
    translate_add(&t->behind, "#<_thread_gap>=[#<_thread_way>*[[%s]-2*#<_x>]-2*[%s]]", h->x,
                  h->height);
    translate_add(&t->behind, "o%u if [#<_thread_gap> LT -%s]", label, BELOW_MAX);
    translate_add(&t->behind, "(abort,G76 begins below its crest)");
    translate_add(&t->behind, "o%u endif", label);
}

static void put_thread(struct translator *t, const struct thread *h)
{
    char out[64] = "";

    if (h->x[0] == '\0' || h->z[0] == '\0' || h->height[0] == '\0' || h->first[0] == '\0' ||
        h->pitch[0] == '\0')
        return;
    if (h->run_out > 0.0)
        (void)snprintf(out, sizeof out, " E[%.1f*[%.40s]] L2", h->run_out, h->pitch);
    (void)line_read(&t->line, "", 0);
    put_gap(t, h);
    translate_add(&t->behind,
                  "G76 P[%s] Z[%s] I[#<_thread_way>*[#<_thread_gap>+%s+ABS[#<_thread_gap>-%s]]/2] "
                  "J[2*[%s]] K[2*[%s]] R2 Q[%.4f] H%.0f%s",
                  h->pitch, h->z, GAP_MIN, GAP_MIN, h->first, h->height, 0.5 * h->angle_deg,
                  h->finishing > 1.0 ? h->finishing - 1.0 : 0.0, out);
}

/*
 * K is the height of the thread, D the first cut, both of the radius; X the diameter at its ground.
 */
static void take_thread(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *a = line_find(l, 'a', 0);
    struct thread h = {.angle_deg = a != NULL && a->is_number ? a->value : 0.0};

    expression(l, 'x', "", h.x, sizeof h.x);
    expression(l, 'z', "", h.z, sizeof h.z);
    expression(l, 'k', "", h.height, sizeof h.height);
    expression(l, 'd', "", h.first, sizeof h.first);
    expression(l, 'f', "", h.pitch, sizeof h.pitch);
    put_thread(t, &h);
}

/*
 * The first line: P is three numbers of two digits. The second: P is the height, Q the first cut; R
 * would be a cone.
 */
static void take_thread_pair(struct translator *t, const struct line_word *p)
{
    struct line *l = &t->line;
    const struct line_word *cone = line_find(l, 'r', 0);
    const uint32_t form = t->thread_form;
    struct thread h = {.finishing = form / 10000 % 100,
                       .run_out = 0.1 * (form / 100 % 100),
                       .angle_deg = form % 100};

    if (!line_has_axis(l) && line_find(l, 'u', 0) == NULL && line_find(l, 'w', 0) == NULL) {
        t->thread_form = p->is_number ? line_whole(p->value) : 0;
        leave_feed(t);
        return;
    }
    if (cone != NULL && (!cone->is_number || cone->value != 0.0))
        return;
    reach(l, 'x', 'u', "2*#<_x>", h.x, sizeof h.x);
    reach(l, 'z', 'w', "#<_z>", h.z, sizeof h.z);
    thousandths(l, 'p', h.height, sizeof h.height);
    thousandths(l, 'q', h.first, sizeof h.first);
    expression(l, 'f', "", h.pitch, sizeof h.pitch);
    put_thread(t, &h);
}

static bool is_passed_over(struct translator *t)
{
    if (t->skip_to == 0.0 || (!t->skipping && !has_number(&t->line, t->skip_from)))
        return false;
    t->skipping = !has_number(&t->line, t->skip_to);
    t->skip_to = t->skipping ? t->skip_to : 0.0;
    (void)line_read(&t->line, "", 0);
    return true;
}

bool turning_tells(struct line *l)
{
    const bool paired = line_find(l, 'p', 0) != NULL && line_find(l, 'q', 0) != NULL;
    const struct line_word *q = line_find(l, 'q', 0);
    const bool pecks = q != NULL && q->is_number && !q->has_point && q->value >= WHOLE_MIN &&
                       line_find(l, 'z', 0) != NULL && line_find(l, 'y', 0) == NULL;

    if (pecks && line_find_code(l, 'g', 740) != NULL)
        return true;
    return paired && (line_find_code(l, 'g', 710) != NULL || line_find_code(l, 'g', 720) != NULL ||
                      (line_find_code(l, 'g', 760) != NULL && !line_has_axis(l)));
}

void turning_translate(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *p = line_find(l, 'p', 0);
    const struct line_word *q = line_find(l, 'q', 0);
    const bool profile = p != NULL && q != NULL && p->is_number && q->is_number;

    if (is_passed_over(t))
        return;
    for (unsigned code = 710; code <= 720; code += 10) {
        if (line_find_code(l, 'g', code) == NULL)
            continue;
        if (profile)
            take_rough(t, code, p->value, q->value);
        else
            take_depths(t);
        return;
    }
    struct line_word *repeating = line_find_code(l, 'g', 730);

    if (repeating != NULL && (profile || !line_has_axis(l)))
        translate_wrong(t, repeating,
                        "'G73', a profile that is repeated, is not supported: G71 is");
    else if (line_find_code(l, 'g', 700) != NULL && profile)
        take_finish(t, p->value, q->value);
    else if (line_find_code(l, 'g', 740) != NULL || line_find_code(l, 'g', 750) != NULL)
        take_pecks(t, line_find_code(l, 'g', 750) != NULL ? 'x' : 'z',
                   line_find_code(l, 'g', 750) != NULL ? 'z' : 'x');
    else if (line_find_code(l, 'g', 760) != NULL && p != NULL)
        take_thread_pair(t, p);
    else if (line_find_code(l, 'g', 760) != NULL)
        take_thread(t);
}
