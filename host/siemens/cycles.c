/*
 * Drilling cycles of Siemens' language (siemens.c).
 */
#include "siemens/scan.h"

#include <stdio.h>
#include <string.h>

/* Arguments in their places. */
enum {
    ARGUMENT_RETURN,                 /* RTP: height of the return */
    ARGUMENT_REFERENCE,              /* RFP */
    ARGUMENT_SAFETY,                 /* SDIS, above the reference */
    ARGUMENT_DEPTH,                  /* DP, */
    ARGUMENT_DEEP,                   /* or DPR below the reference */
    ARGUMENT_DWELL,                  /* of CYCLE82: DTB; of CYCLE83: */
    ARGUMENT_FIRST = ARGUMENT_DWELL, /* FDEP: the end of the first stroke, */
    ARGUMENT_FIRST_DEEP,             /* or FDPR below the reference */
    ARGUMENT_LESS,                   /* DAM: by so much each is shorter, and not below it */
    ARGUMENT_DWELL_BOTTOM,           /* DTB, at the end of each */
    ARGUMENT_DWELL_TOP,              /* DTS, where the chips fall off */
    ARGUMENT_FEED,                   /* FRF: the feed of the first, as a factor */
    ARGUMENT_CHIPS,                  /* VARI: 1 goes out of the hole after each stroke */
    ARGUMENT_AXIS,                   /* the rest: _AXN, _MDEP, _VRT, _DTD, _DIS1 */
    ARGUMENT_LEAST,
    ARGUMENT_BACK, /* _VRT: how far it goes back to break chips, else 1 mm */
    ARGUMENT_DWELL_END,
    ARGUMENT_ABOVE /* _DIS1: where rapid into the hole ends above the last stroke */
};

/* A cycle as it is called. */
struct hole {
    char argument[SCAN_ARGUMENTS][48]; /* empty: left out */
    char top[100], bottom[100];
};

static bool is_given(const struct hole *h, unsigned argument)
{
    return h->argument[argument][0] != '\0';
}

static const char *value_or(const struct hole *h, unsigned argument, const char *other)
{
    return is_given(h, argument) ? h->argument[argument] : other;
}

/* A depth, or one below the reference. */
static void put_depth(const struct hole *h, unsigned argument, char text[100])
{
    if (is_given(h, argument))
        (void)snprintf(text, 100, "%s", h->argument[argument]);
    else
        (void)snprintf(text, 100, "[%s-%s]", h->argument[ARGUMENT_REFERENCE],
                       h->argument[argument + 1]);
}

static void read_hole(struct scan *s, struct hole *h)
{
    memset(h, 0, sizeof *h);
    (void)scan_arguments(s, h->argument);
    scan_skip(s);
    s->failed = s->failed || !scan_is_end(s) || !is_given(h, ARGUMENT_RETURN) ||
                !is_given(h, ARGUMENT_REFERENCE) ||
                (!is_given(h, ARGUMENT_DEPTH) && !is_given(h, ARGUMENT_DEEP));
    put_depth(h, ARGUMENT_DEPTH, h->bottom);
    (void)snprintf(h->top, sizeof h->top, "[%s+%s]", h->argument[ARGUMENT_REFERENCE],
                   value_or(h, ARGUMENT_SAFETY, "0"));
}

/* CYCLE81 and CYCLE82 are G81 and G82. */
static void put_plain(const struct hole *h, bool waits, char text[TRANSLATE_CALL_MAX])
{
    const int at = snprintf(text, TRANSLATE_CALL_MAX, "G98 G%s R%s Z%s%s", waits ? "82" : "81",
                            h->top, h->bottom, waits ? " P" : "");

    if (waits)
        (void)snprintf(text + at, TRANSLATE_CALL_MAX - (size_t)at, "%s",
                       value_or(h, ARGUMENT_DWELL, "0"));
}

/* ---- pecks ---- */

/* Labels of what begins and ends on one line. */
#define PECK_LABEL 95000000U

/*
 * CYCLE83 stroke by stroke, in lines: ? is the axis across the plane, @ begins a label. The first
 * stroke goes from the reference to FDEP. Each later one is shorter by DAM, but not shorter than
 * DAM; a rest of up to 2 DAM is halved.
 */
static const char begin_pecks[] = "o@1 if [#<_peck> LE 0]\n"
                                  "(abort,CYCLE83: FDEP must be below RFP)\n"
                                  "o@1 endif\n"
                                  "o@1 if [#<_peck_less> LT 0]\n"
                                  "(abort,CYCLE83: DAM must not be below 0 here)\n"
                                  "o@1 endif\n"
                                  "G0 ?#<_peck_top>\n";
static const char begin_stroke[] = "o@1 if [#<_peck_at> LT #<_peck_bottom>]\n"
                                   "#<_peck_at>=#<_peck_bottom>\n"
                                   "o@1 endif\n"
                                   "G1 ?#<_peck_at>\n";
static const char end_stroke[] = "#<_peck_rest>=[#<_peck_at>-#<_peck_bottom>]\n"
                                 "o@1 if [#<_peck_rest> GT 0]\n";
static const char next_stroke[] = "o@2 if [#<_peck_less> GT 0]\n"
                                  "#<_peck_next>=[#<_peck>-#<_peck_less>]\n"
                                  "o@3 if [#<_peck_next> LT #<_peck_less>]\n"
                                  "#<_peck_next>=#<_peck_less>\n"
                                  "o@3 endif\n"
                                  "o@3 if [#<_peck_next> LT #<_peck>]\n"
                                  "#<_peck>=#<_peck_next>\n"
                                  "o@3 endif\n"
                                  "o@3 if [#<_peck_rest> LE #<_peck_less>]\n"
                                  "#<_peck>=#<_peck_rest>\n"
                                  "o@3 elseif [#<_peck_rest> LE [2*#<_peck_less>]]\n"
                                  "#<_peck>=[#<_peck_rest>/2]\n"
                                  "o@3 endif\n"
                                  "o@2 endif\n"
                                  "#<_peck_at>=[#<_peck_at>-#<_peck>]\n"
                                  "o@1 endif\n";
/* Up to 30 mm deep it is 0.6 mm, then a fiftieth of the depth, at most 7 mm. */
static const char distance_above[] = "#<_peck_above>=[#<_peck_rest>/50]\n"
                                     "o@1 if [#<_peck_rest> LE [30*#<_peck_mm>]]\n"
                                     "#<_peck_above>=[0.6*#<_peck_mm>]\n"
                                     "o@1 elseif [#<_peck_rest> GT [350*#<_peck_mm>]]\n"
                                     "#<_peck_above>=[7*#<_peck_mm>]\n"
                                     "o@1 endif\n";

static char axis_across(const struct translator *t)
{
    return (char)(t->across - 'i' + 'X');
}

static void put_line(struct translator *t, const char *line, size_t length)
{
    char text[LINE_MAX_BYTES];
    size_t at = 0;

    for (size_t i = 0; i < length && at + 16 < sizeof text; i++) {
        if (line[i] == '@')
            at += (size_t)snprintf(text + at, sizeof text - at, "%u",
                                   PECK_LABEL + (unsigned)(line[++i] - '0'));
        else if (line[i] == '?')
            text[at++] = axis_across(t);
        else
            text[at++] = line[i];
    }
    translate_add(&t->behind, "%.*s", (int)at, text);
}

static void put_lines(struct translator *t, const char *lines)
{
    for (const char *end; (end = strchr(lines, '\n')) != NULL; lines = end + 1)
        put_line(t, lines, (size_t)(end - lines));
}

static bool is_zero_or_left_out(const struct hole *h, unsigned argument)
{
    return !is_given(h, argument) || strcmp(h->argument[argument], "[0]") == 0;
}

static void put_dwell(struct translator *t, const struct hole *h, unsigned argument)
{
    if (!is_zero_or_left_out(h, argument))
        translate_add(&t->behind, "G4 P%s", h->argument[argument]);
}

/* The first stroke may have a feed of its own. */
static void put_feed(struct translator *t, const struct hole *h, bool first)
{
    const char *factor = h->argument[ARGUMENT_FEED];

    if (is_zero_or_left_out(h, ARGUMENT_FEED) || strcmp(factor, "[1]") == 0)
        return;
    if (first)
        translate_add(&t->behind, "#<_peck_feed>=#<_feed>");
    translate_add(&t->behind, first ? "F[#<_peck_feed>*%s]" : "F#<_peck_feed>", factor);
}

static void put_values(struct translator *t, const struct hole *h)
{
    const char *reference = h->argument[ARGUMENT_REFERENCE];
    char first[100];

    put_depth(h, ARGUMENT_FIRST, first);
    translate_add(&t->behind, "#<_peck_mm>=[1/[1+24.4*#<_imperial>]]");
    translate_add(&t->behind, "#<_peck_top>=%s", h->top);
    translate_add(&t->behind, "#<_peck_bottom>=%s", h->bottom);
    translate_add(&t->behind, "#<_peck_at>=%s", first);
    translate_add(&t->behind, "#<_peck>=[%s-#<_peck_at>]", reference);
    translate_add(&t->behind, "#<_peck_less>=%s", value_or(h, ARGUMENT_LESS, "0"));
    translate_add(&t->behind, "#<_peck_rest>=[%s-#<_peck_bottom>]", reference);
    put_lines(t, distance_above);
}

/* Out of the hole, or back a little. */
static void put_return(struct translator *t, const struct hole *h)
{
    const char axis = axis_across(t);
    const bool back = !is_zero_or_left_out(h, ARGUMENT_BACK);
    const bool above = !is_zero_or_left_out(h, ARGUMENT_ABOVE);

    put_line(t, "o@2 if ", 7);
    t->behind.length--;
    output_print(&t->behind, "[%s EQ 1]\n", value_or(h, ARGUMENT_CHIPS, "0"));
    put_lines(t, "G0 ?#<_peck_top>\n");
    put_dwell(t, h, ARGUMENT_DWELL_TOP);
    translate_add(&t->behind, "G0 %c[#<_peck_at>+%s]", axis,
                  above ? h->argument[ARGUMENT_ABOVE] : "#<_peck_above>");
    put_lines(t, "o@2 else\n");
    translate_add(&t->behind, "G1 %c[#<_peck_at>+%s]", axis,
                  back ? h->argument[ARGUMENT_BACK] : "#<_peck_mm>");
    put_lines(t, "o@2 endif\n");
}

static void put_pecks(struct scan *s, const struct hole *h)
{
    struct translator *t = s->t;

    if (t->incremental)
        translate_add(&t->behind, "G90");
    put_values(t, h);
    put_lines(t, begin_pecks);
    put_feed(t, h, true);
    put_lines(t, "o@0 do\n");
    put_lines(t, begin_stroke);
    put_dwell(t, h, ARGUMENT_DWELL_BOTTOM);
    put_feed(t, h, false);
    put_lines(t, end_stroke);
    put_return(t, h);
    put_lines(t, next_stroke);
    put_lines(t, "o@0 while [#<_peck_rest> GT 0]\n");
    translate_add(&t->behind, "G0 %c%s", axis_across(t), h->argument[ARGUMENT_RETURN]);
    if (t->incremental)
        translate_add(&t->behind, "G91");
}

/* ---- calls ---- */

static bool is_drilling(const char *name)
{
    return strcmp(name, "CYCLE81") == 0 || strcmp(name, "CYCLE82") == 0 ||
           strcmp(name, "CYCLE83") == 0;
}

/* What is called by a name and arguments: one word each for what a line has besides. */
static void read_call(struct scan *s, const char *name, struct hole *h)
{
    const bool pecks = strcmp(name, "CYCLE83") == 0;

    read_hole(s, h);
    s->failed =
        s->failed || (pecks && !is_given(h, ARGUMENT_FIRST) && !is_given(h, ARGUMENT_FIRST_DEEP));
    for (unsigned i = ARGUMENT_AXIS; pecks && i < SCAN_ARGUMENTS; i++)
        s->failed = s->failed || (i != ARGUMENT_LEAST && i != ARGUMENT_BACK &&
                                  i != ARGUMENT_ABOVE && !is_zero_or_left_out(h, i));
}

/* At X and Y where the tool is. */
static void call_here(struct scan *s, const char *name, const struct hole *h)
{
    struct translator *t = s->t;
    char text[TRANSLATE_CALL_MAX];

    if (strcmp(name, "CYCLE83") == 0) {
        put_pecks(s, h);
    } else {
        put_plain(h, strcmp(name, "CYCLE82") == 0, text);
        translate_add(&t->behind, "G0 Z%s", h->argument[ARGUMENT_RETURN]);
        translate_add(&t->behind, "%s X#<_x> Y#<_y>", text);
    }
    translate_add(&t->behind, "G80 %s", t->straight != NULL ? t->straight : "G0");
}

/* Here and now; or at every place from the next line on (MCALL). */
bool siemens_cycle(struct scan *s, const char *name)
{
    struct translator *t = s->t;
    char cycle[NAME_MAX_];
    struct hole h;
    const bool modal = strcmp(name, "MCALL") == 0;

    scan_skip(s);
    if (modal && scan_is_end(s)) {
        scan_clear(s);
        if (t->modal_call[0] != '\0')
            translate_add(&t->behind, "G80 G0");
        t->modal_call[0] = '\0';
        return true;
    }
    (void)snprintf(cycle, sizeof cycle, "%s", name);
    if ((modal && !scan_name(s, cycle)) || !is_drilling(cycle))
        return false;
    const char *arguments = s->at;

    read_call(s, cycle, &h);
    if (s->failed)
        return true;
    scan_clear(s);
    if (!modal) {
        call_here(s, cycle, &h);
        return true;
    }
    (void)snprintf(t->modal_call, sizeof t->modal_call, "%s%s", cycle, arguments);
    if (strcmp(cycle, "CYCLE83") != 0)
        translate_add(&t->behind, "G0 Z%s", h.argument[ARGUMENT_RETURN]);
    return true;
}

/*
 * With MCALL a place is a hole, also one that a rotary axis leads to: the cycle itself has no words
 * for it.
 */
void siemens_drill(struct scan *s)
{
    struct translator *t = s->t;
    struct scan call = {.t = t, .at = t->modal_call};
    char name[NAME_MAX_];
    char text[TRANSLATE_CALL_MAX];
    struct hole h;
    struct line l;
    bool turns = false;

    if (!scan_name(&call, name) || !line_read(&l, s->out, s->length) || !line_has_axis(&l))
        return;
    for (unsigned i = 0; i < l.words; i++) {
        turns = turns || strchr("abc", l.word[i].letter) != NULL;
        if (line_code(&l.word[i]) == 0 || line_code(&l.word[i]) == 10)
            line_blank(&l, &l.word[i]);
    }
    const bool pecks = strcmp(name, "CYCLE83") == 0;

    read_call(&call, name, &h);
    put_plain(&h, strcmp(name, "CYCLE82") == 0, text);
    s->length = 0;
    scan_put(s, turns || pecks ? "G0 %s" : "%s %s", l.text, text);
    if (pecks)
        put_pecks(s, &h);
    else if (turns)
        translate_add(&t->behind, "%s X#<_x> Y#<_y>", text);
}
