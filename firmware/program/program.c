#include "program/program.h"

#include "base/assert.h"
#include "program/approach.h"
#include "program/changes.h"
#include "program/comment.h"
#include "program/contour.h"
#include "program/coordinates.h"
#include "program/cutter.h"
#include "program/cycles.h"
#include "program/emit.h"
#include "program/flow.h"
#include "program/lexer.h"
#include "program/modes.h"
#include "program/probe.h"
#include "program/refused.h"
#include "program/spline.h"
#include "program/tool_values.h"
#include "program/words.h"

_Static_assert(sizeof(struct program) + sizeof(struct parameters) <= PROGRAM_MEMORY_MAX,
               "the interpreter outgrew the memory set aside for it");
_Static_assert(STEP_COUNT <= 32, "steps are bits of a word");

void takt_program_open(struct program *p, const struct program_config *config,
                       const struct source *source)
{
    p->config = *config;
    takt_lexer_open(&p->lexer, source);
    p->names.count = 0;
    p->names.text_length = 0;
    p->names.call = 0;
    p->queue_first = 0;
    p->queue_count = 0;
    p->warnings = 0;
    p->phase = PROGRAM_AT_START;
    p->question = QUESTION_NONE;
    p->tools.count = 0;
    takt_changes_open(p);
    takt_cycles_open(p);
    takt_modes_open(p);
    takt_coordinates_open(p);
    takt_flow_open(p);
    takt_approach_open(p);
}

const struct program_modes *takt_program_get_modes(const struct program *p)
{
    return &p->modes;
}

static bool run_step(struct program *p, const struct program_code *code,
                     const struct program_modes *before)
{
    takt_cycles_see(p, code);
    return takt_spline_allows(p, code) && takt_cutter_allows(p, code) && code->run(p, code) &&
           takt_cutter_allows_change(p, code, before);
}

static bool run_steps(struct program *p, const struct program_modes *before)
{
    for (unsigned step = 0; step < STEP_COUNT; step++) {
        if (words_has_step(p, (enum step)step)) {
            if (!run_step(p, p->words.code[step], before)) {
                return false;
            }
        }
    }
    return true;
}

/* A line with an error moves nothing and changes no mode and no parameter. */
static bool run_line(struct program *p)
{
    const struct program_modes before = p->modes;

    if (takt_words_assign(p) && run_steps(p, &before)) {
        takt_words_note_changes(p);
        takt_tool_values_note_changes(p);
        return true;
    }
    takt_words_take_back(p);
    takt_tool_values_take_back(p);
    takt_cycles_open(p);
    p->modes = before;
    p->queue_count = 0;
    return false;
}

/*
 * The last line, unless a subroutine was looked for in vain: then the text goes on behind the call.
 */
static bool end_text(struct program *p)
{
    const bool searching = p->flow.skip == SKIP_TO_SUB;
    const bool good = takt_spline_ends(p) && takt_flow_end_of_text(p);

    if (good) {
        takt_emit_event(p, MOVE_END);
    }
    if (!searching) {
        p->phase = PROGRAM_ENDED;
    }
    return good;
}

/* A line of '%' alone opens a program when it is the first that says something, else it ends it. */
static bool is_percent(const struct program_lexer *l)
{
    return l->length == 1 && l->text[0] == '%';
}

static bool take_words(struct program *p)
{
    takt_tool_values_begin_line(p);
    const bool read = takt_words_read(p) && takt_comment_run(p);

    if (contour_is_open(p)) {
        return read && takt_contour_take_line(p);
    }
    return takt_refused_judge(p, read && run_line(p));
}

static bool take_line(struct program *p)
{
    struct program_lexer *l = &p->lexer;

    if (l->length == 0) {
        return flow_is_skipping(p) || takt_comment_run(p);
    }
    const bool first = p->phase == PROGRAM_AT_START;

    p->phase = PROGRAM_IN_TEXT;
    if (is_percent(l)) {
        return first || end_text(p);
    }
    if (takt_lexer_accept(l, '/') && p->config.block_delete) {
        return true;
    }
    if (takt_oword_begins(p)) {
        return takt_flow_take(p);
    }
    if (flow_is_skipping(p)) {
        return true;
    }
    return take_words(p);
}

/* The line to start at waits until the way to it has been fetched. */
static bool take_or_approach(struct program *p)
{
    bool good;

    if (!takt_approach_begins(p, &good)) {
        return take_line(p);
    }
    return good;
}

/* Reads one line; false: p->error is set. */
static bool read_line(struct program *p)
{
    if (p->approach.holds_line) {
        return takt_approach_goes_on(p) || take_line(p);
    }
    const enum lexer_result result = takt_lexer_next_line(&p->lexer, &p->error);

    if (result != LEXER_END && !takt_flow_count_line(p)) {
        p->phase = PROGRAM_ENDED;
        return false;
    }
    if (p->phase == PROGRAM_ENDED) {
        return true;
    }
    switch (result) {
    case LEXER_LINE:
        return take_or_approach(p);
    case LEXER_END:
        return end_text(p);
    case LEXER_UNREADABLE:
        p->phase = PROGRAM_ENDED;
        return false;
    case LEXER_ERROR:
        break;
    }
    return false;
}

static bool is_elsewhere(const struct point *a, const struct point *b)
{
    bool differs = false;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        differs = differs || a->at[i] != b->at[i];
    }
    return differs;
}

/* Does a move go somewhere, or wait? A program may repeat it for ever, which takes as long. */
static bool takes_time(const struct move *m, const struct point *from)
{
    switch (m->kind) {
    case MOVE_RAPID:
    case MOVE_FEED:
    case MOVE_THREAD:
    case MOVE_TAP:
    case MOVE_TAP_OUT:
        return is_elsewhere(&m->end, from);
    case MOVE_DWELL:
        return m->dwell_s > 0.0;
    case MOVE_SPINDLE:
    case MOVE_ORIENT:
    case MOVE_COOLANT:
    case MOVE_TOOL:
    case MOVE_OUTPUT:
    case MOVE_WEAR:
    case MOVE_SETUP:
        return false;
    case MOVE_ARC_CW:
    case MOVE_ARC_CCW:
    case MOVE_INVOLUTE_CW:
    case MOVE_INVOLUTE_CCW:
    case MOVE_SPLINE:
    case MOVE_PROBE:
    case MOVE_INPUT:
    case MOVE_STOP:
    case MOVE_END:
        break;
    }
    return true;
}

/* Has the line just read, begun at a place, made a move that takes time? */
static bool has_progress(const struct program *p, const struct point *from)
{
    bool has = p->cycle.code != NULL;

    for (unsigned i = 0; i < p->queue_count && !has; i++) {
        has = takes_time(&p->queue[(p->queue_first + i) % PROGRAM_QUEUE_MAX], from);
    }
    return has;
}

/* One step further; false: p->error is set. */
static bool advance(struct program *p)
{
    const struct point from = p->modes.at;
    const bool good = takt_contour_follow(p, read_line(p));

    if (!good) {
        takt_flow_fail(p);
    }
    if (p->approach.pending) {
        return takt_approach_drop(p) && good;
    }
    if (has_progress(p, &from)) {
        p->flow.lines_again = 0;
    }
    return good;
}

static enum program_question question_of(const struct move *move)
{
    if (move->kind == MOVE_PROBE) {
        return QUESTION_PROBE;
    }
    if (move->kind == MOVE_SETUP && move->setup_ends) {
        return QUESTION_SETUP;
    }
    return move->kind == MOVE_INPUT ? QUESTION_INPUT : QUESTION_NONE;
}

enum program_result takt_program_next(struct program *p, struct move *move,
                                      struct diagnostic *diagnostic)
{
    if (p->question != QUESTION_NONE && p->config.waits) {
        return PROGRAM_WAIT;
    }
    p->question = QUESTION_NONE;
    while (!takt_emit_take(p, move)) {
        if (p->phase == PROGRAM_ENDED) {
            return PROGRAM_END;
        }
        if (!takt_lexer_can_go_on(&p->lexer)) {
            return PROGRAM_LATER;
        }
        if (!advance(p)) {
            *diagnostic = p->error;
            return PROGRAM_ERROR;
        }
    }
    p->question = question_of(move);
    takt_changes_stamp(p, move);
    return PROGRAM_MOVE;
}

void takt_program_answer(struct program *p, const struct program_answer *answer)
{
    switch (p->question) {
    case QUESTION_PROBE:
        takt_probe_take(p, answer);
        break;
    case QUESTION_INPUT:
        (void)takt_parameters_set(p->config.parameters, PARAMETER_INPUT, answer->value);
        break;
    case QUESTION_SETUP:
    case QUESTION_NONE:
        break;
    }
    p->question = QUESTION_NONE;
}

void takt_program_settle(struct program *p, const struct point *at)
{
    for (unsigned i = 0; i < p->queue_count; i++) {
        if (move_is_motion(&p->queue[(p->queue_first + i) % PROGRAM_QUEUE_MAX])) {
            return;
        }
    }
    p->modes.at = *at;
}

bool takt_program_warning(struct program *p, struct diagnostic *diagnostic)
{
    TAKT_ASSERT(p->warnings <= PROGRAM_WARNINGS_MAX);
    if (p->warnings == 0) {
        return false;
    }
    *diagnostic = p->warning[0];
    p->warnings--;
    for (unsigned i = 0; i < p->warnings; i++) {
        p->warning[i] = p->warning[i + 1];
    }
    return true;
}
