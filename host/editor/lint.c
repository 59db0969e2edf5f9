#include "editor/lint.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "session/planner.h"
#include "words/line.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#define PRINTED_MAX 100
/* Heights are told in float: nearer than this they are the same. */
#define SAME_MM 1e-3
/* Feeds that are looked for, and the share of one that counts as reached. */
#define FEEDS_MAX          64
#define REACHED            0.99
#define SECONDS_PER_MINUTE 60.0

enum rule { RULE_RAPID, RULE_SPINDLE, RULE_RADIUS, RULE_TOOL, RULE_COUNT };

/* A programmed feed, and the highest that came of it. */
struct feed {
    double program_mm_s, best_mm_s;
    enum governor governor;
    uint32_t line; /* the first with it */
};

struct lint {
    const struct session *session;
    double stock_top_mm; /* work coordinate of Z */
    unsigned findings;
    uint32_t lines;
    /* of each line: bit of a rule that has found it, bit RULE_COUNT: it has been executed */
    uint8_t *seen;
    /* what the moves so far leave */
    struct point at;
    bool z_known, turns, turned_told, radius_told;
    double hole[2], hole_z; /* where the tool has last been down at feed, and how far */
    struct feed feed[FEEDS_MAX];
    unsigned feeds;
    double program_mm_s[FEEDS_MAX]; /* the different feeds of the program */
    unsigned left;                  /* of them, those that are not known to be reached */
};

__attribute__((format(printf, 3, 4))) static void tell(struct lint *l, uint32_t line,
                                                       const char *format, ...)
{
    char text[256];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (l->findings++ < PRINTED_MAX) {
        const char *name = program_text_place(&l->session->program, &line);

        message_warning(name, line, 1, "%s", text);
    }
}

/* Once for each line. */
static bool is_new(struct lint *l, enum rule rule, uint32_t line)
{
    const uint8_t bit = (uint8_t)(1U << rule);
    const bool fresh = line <= l->lines && (l->seen[line] & bit) == 0;

    if (fresh)
        l->seen[line] = (uint8_t)(l->seen[line] | bit);
    return fresh;
}

/* ---- moves ---- */

static double work_z(const struct move *m, const struct point *at)
{
    return at->at[AXIS_Z] - (double)m->work_mm[AXIS_Z] - (double)m->overhang_mm[AXIS_Z];
}

static bool goes_sideways(const struct lint *l, const struct move *m)
{
    return hypot(m->end.at[AXIS_X] - l->at.at[AXIS_X], m->end.at[AXIS_Y] - l->at.at[AXIS_Y]) >
           SAME_MM;
}

/* A hole that has been cut down to there: pecks go back into it at rapid. */
static bool is_open(const struct lint *l, const struct move *m)
{
    return hypot(m->end.at[AXIS_X] - l->hole[0], m->end.at[AXIS_Y] - l->hole[1]) <= SAME_MM &&
           m->end.at[AXIS_Z] >= l->hole_z - SAME_MM;
}

static void look_at_rapid(struct lint *l, const struct move *m)
{
    const double from = work_z(m, &l->at);
    const double to = work_z(m, &m->end);
    const double low = fmin(from, to);

    if (!l->z_known || low >= l->stock_top_mm - SAME_MM)
        return;
    if (goes_sideways(l, m)) {
        if (is_new(l, RULE_RAPID, m->line))
            tell(l, m->line, "rapid sideways at Z%.4g mm, below the top of the stock (Z%.4g)", low,
                 l->stock_top_mm);
    } else if (to < from - SAME_MM && !is_open(l, m) && is_new(l, RULE_RAPID, m->line)) {
        tell(l, m->line, "rapid down to Z%.4g mm, below the top of the stock (Z%.4g)", to,
             l->stock_top_mm);
    }
}

static void look_at_cut(struct lint *l, const struct move *m)
{
    const bool same =
        hypot(m->end.at[AXIS_X] - l->hole[0], m->end.at[AXIS_Y] - l->hole[1]) <= SAME_MM;

    if (!l->turns && !l->turned_told) {
        l->turned_told = true;
        if (is_new(l, RULE_SPINDLE, m->line))
            tell(l, m->line, "feed while the spindle stands");
    }
    l->hole_z = same ? fmin(l->hole_z, m->end.at[AXIS_Z]) : m->end.at[AXIS_Z];
    l->hole[0] = m->end.at[AXIS_X];
    l->hole[1] = m->end.at[AXIS_Y];
}

static void look_at_tool(struct lint *l, const struct move *m)
{
    const struct tool_table *table = &l->session->tools.table;

    if (!m->tool_change || m->tool == 0 || takt_tool_table_find(table, m->tool) != NULL ||
        !is_new(l, RULE_TOOL, m->line))
        return;
    if (table->count == 0)
        tell(l, m->line, "tool %u: there is no tool table (--tools)", (unsigned)m->tool);
    else
        tell(l, m->line, "tool %u is not in the tool table", (unsigned)m->tool);
}

/* Compensation that moves nothing. */
static void look_at_modes(struct lint *l, const struct program *p, uint32_t line)
{
    const struct program_modes *m = takt_program_get_modes(p);
    const bool idle = m->cutter_code != NULL && m->cutter_radius_mm == 0.0;

    if (idle && !l->radius_told && is_new(l, RULE_RADIUS, line))
        tell(l, line, "cutter compensation of a tool without a radius moves nothing");
    l->radius_told = idle;
}

/* Another feed than those before? As the planner counts them. */
static void count_feed(struct lint *l, const struct move *m)
{
    if (m->kind == MOVE_RAPID || m->feed_rev_mm != 0.0)
        return;
    for (unsigned i = 0; i < l->left; i++) {
        if (l->program_mm_s[i] == m->feed_mm_s)
            return;
    }
    if (l->left < FEEDS_MAX)
        l->program_mm_s[l->left++] = m->feed_mm_s;
}

static void look_at_motion(struct lint *l, const struct move *m, bool mill)
{
    count_feed(l, m);

    if (m->kind == MOVE_RAPID && mill)
        look_at_rapid(l, m);
    else if (m->kind == MOVE_FEED || move_is_curved(m))
        look_at_cut(l, m);
    l->z_known = l->z_known || m->end.at[AXIS_Z] != l->at.at[AXIS_Z];
    l->at = m->end;
}

static void look_at_move(struct lint *l, const struct move *m, bool mill)
{
    if (move_is_motion(m)) {
        look_at_motion(l, m, mill);
    } else if (m->kind == MOVE_TOOL) {
        look_at_tool(l, m);
    } else if (m->kind == MOVE_SPINDLE) {
        l->turns = m->direction != SPINDLE_OFF && (m->speed_rpm > 0.0 || m->surface_mm_s > 0.0);
        l->turned_told = false;
    }
}

static void note_line(void *listener, const struct program *p)
{
    struct lint *l = listener;

    if (p->lexer.line <= l->lines)
        l->seen[p->lexer.line] |= 1U << RULE_COUNT;
}

static enum command_status look_at_moves(struct lint *l)
{
    static _Thread_local struct session_reading reading;
    const unsigned of_mills = 1U << AXIS_X | 1U << AXIS_Y | 1U << AXIS_Z;
    struct program_config config;
    struct source source;
    struct diagnostic ignored;
    struct move move;

    session_begin_reading(l->session, &reading, &config, &source);
    config.say = note_line;
    config.listener = l;
    takt_program_open(&reading.program, &config, &source);
    l->at = config.start;
    while (takt_program_next(&reading.program, &move, &ignored) == PROGRAM_MOVE &&
           !interrupt_asked()) {
        look_at_modes(l, &reading.program, move.line);
        look_at_move(l, &move, (config.axes & of_mills) == of_mills);
    }
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

/* ---- lines ---- */

/* A line that does something when it is executed; O-words and what they stand for are none. */
static bool has_words(const char *bytes, size_t length)
{
    static _Thread_local struct line line;

    if (!line_read(&line, bytes, length))
        return true;
    for (unsigned i = 0; i < line.words; i++) {
        const struct line_word *w = &line.word[i];

        if (w->letter == 'o' || w->letter == '%' || w->letter == '/')
            return false;
        if (w->kind != WORD_COMMENT && w->letter != 'n' && w->letter != ' ')
            return true;
    }
    return false;
}

static bool is_passed_over(const struct lint *l, uint32_t line)
{
    char text[LINE_MAX_BYTES];

    return (l->seen[line] & 1U << RULE_COUNT) == 0 &&
           has_words(text, program_text_line(&l->session->program, line, 0, text, sizeof text));
}

/* Lines beside each other are told together; what says nothing in between does not part them. */
static void look_at_lines(struct lint *l)
{
    uint32_t first = 0;
    uint32_t last = 0;

    for (uint32_t line = 1; line <= l->lines + 1; line++) {
        const bool executed = line > l->lines || (l->seen[line] & 1U << RULE_COUNT) != 0;

        if (line <= l->lines && is_passed_over(l, line)) {
            first = first == 0 ? line : first;
            last = line;
        } else if (executed && first != 0) {
            if (first == last)
                tell(l, first, "this line is never reached");
            else
                tell(l, first, "lines %u to %u are never reached", (unsigned)first, (unsigned)last);
            first = 0;
        }
    }
}

/* ---- feeds ---- */

static struct feed *find_feed(struct lint *l, double feed_mm_s)
{
    for (unsigned i = 0; i < l->feeds; i++) {
        if (l->feed[i].program_mm_s == feed_mm_s)
            return &l->feed[i];
    }
    return NULL;
}

static bool is_reached(const struct feed *f)
{
    return f->best_mm_s >= REACHED * f->program_mm_s;
}

/* The first block of a feed, or one that comes nearer to it. */
static void take_block(void *context, const struct planned_block *planned)
{
    struct lint *l = context;
    const double program = planned->program_mm_s;
    const double best = planned->feed_cruise_mm_s;
    struct feed *feed = program > 0.0 ? find_feed(l, program) : NULL;

    if (program > 0.0 && feed == NULL && l->feeds < FEEDS_MAX) {
        feed = &l->feed[l->feeds++];
        *feed = (struct feed){.program_mm_s = program, .line = planned->block->move.line};
    }
    if (feed == NULL || best <= feed->best_mm_s)
        return;
    l->left -= !is_reached(feed) && best >= REACHED * program ? 1U : 0U;
    feed->best_mm_s = best;
    feed->governor = planned->governor;
}

/*
 * Once all feeds of the program have been reached, its rest, which may take days, has no more to
 * say.
 */
static bool wants_more(void *context, const struct planned_block *planned)
{
    struct lint *l = context;

    if (planned->program_mm_s > 0.0 && planned->feed_cruise_mm_s >= REACHED * planned->program_mm_s)
        take_block(l, planned);
    return l->left > 0;
}

static const char *reason(enum governor governor)
{
    switch (governor) {
    case GOVERNOR_VELOCITY:
        return "an axis goes no faster";
    case GOVERNOR_RAMP:
    case GOVERNOR_SHORT:
        return "its moves are too short for the acceleration and jerk of the axes";
    case GOVERNOR_PROGRAM:
    case GOVERNOR_ACCELERATION:
    case GOVERNOR_JERK:
    case GOVERNOR_CHORD:
    case GOVERNOR_SMOOTH:
        break;
    }
    return "its moves are too bent for the acceleration and jerk of the axes";
}

static enum command_status look_at_feeds(struct lint *l)
{
    struct planner_totals totals;
    const struct planner_listener listener = {
        .context = l, .take = take_block, .wants_more = wants_more};
    const enum command_status status = planner_walk(l->session, &listener, &totals);

    for (unsigned i = 0; i < l->feeds && status == STATUS_DONE; i++) {
        const struct feed *f = &l->feed[i];

        if (!is_reached(f))
            tell(l, f->line, "F%.6g mm/min is never reached, %.4g at most: %s",
                 f->program_mm_s * SECONDS_PER_MINUTE, f->best_mm_s * SECONDS_PER_MINUTE,
                 reason(f->governor));
    }
    return status;
}

/* ---- the whole ---- */

static uint32_t count_lines(const struct session *s)
{
    static _Thread_local struct program_text_reader reader;
    struct source source;
    char bytes[4096];
    uint32_t lines = 1;
    long got;

    program_text_read(&s->program, &reader, &source);
    while ((got = source.read(source.context, bytes, sizeof bytes)) > 0) {
        for (long i = 0; i < got; i++)
            lines += bytes[i] == '\n' ? 1U : 0U;
    }
    return lines;
}

enum command_status lint_program(const struct session *s, double stock_top_mm, unsigned *findings)
{
    static _Thread_local struct lint l;
    enum command_status status;

    l = (struct lint){.session = s, .stock_top_mm = stock_top_mm, .lines = count_lines(s)};
    l.hole_z = HUGE_VAL;
    l.seen = calloc(l.lines + 2U, 1);
    if (l.seen == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = look_at_moves(&l);
    if (status == STATUS_DONE) {
        look_at_lines(&l);
        status = look_at_feeds(&l);
    }
    free(l.seen);
    *findings = l.findings;
    return status;
}

bool lint_read_top(const char *text, double *top_mm)
{
    char *end;

    *top_mm = 0.0;
    if (text == NULL)
        return true;
    *top_mm = strtod(text, &end);
    if (end != text && *end == '\0' && *top_mm > -1e6 && *top_mm < 1e6)
        return true;
    message_command_error("--stock-top %s: a height in mm is expected", text);
    return false;
}
