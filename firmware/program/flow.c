#include "program/flow.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/calls.h"
#include "program/emit.h"
#include "program/expression.h"
#include "program/lexer.h"
#include "program/report.h"

#include <string.h>

/* As good as for ever. */
#define ROUNDS_MAX 4e9

void takt_flow_open(struct program *p)
{
    memset(&p->flow, 0, sizeof(p->flow));
}

void takt_flow_fail(struct program *p)
{
    struct program_flow *f = &p->flow;

    f->failed = true;
    for (unsigned call = 1; call <= f->calls; call++) {
        if (f->frame[call].sub < PROGRAM_SUBS_MAX) {
            f->sub[f->frame[call].sub].visited = true;
        }
    }
}

bool takt_flow_jump(struct program *p, const struct program_place *place, const struct oword *o)
{
    return takt_lexer_seek(&p->lexer, place) || takt_oword_error(p, TAKT_ERROR_JUMP_BACK, o, 0.0);
}

/* Blocks below this one belong to callers. */
static unsigned first_block(const struct program *p)
{
    TAKT_ASSERT(p->flow.frame[p->flow.calls].blocks <= p->flow.blocks);
    return p->flow.frame[p->flow.calls].blocks;
}

/* The innermost open block of this call with the label; NULL when there is none. */
static struct program_block *find_block(struct program *p, const struct oword *o)
{
    for (unsigned i = p->flow.blocks; i > first_block(p); i--) {
        if (oword_same_label(&p->flow.block[i - 1].label, &o->label)) {
            return &p->flow.block[i - 1];
        }
    }
    return NULL;
}

static struct program_block *innermost(struct program *p)
{
    TAKT_ASSERT(p->flow.blocks > 0);
    return &p->flow.block[p->flow.blocks - 1];
}

static void close_block(struct program *p)
{
    TAKT_ASSERT(p->flow.blocks > first_block(p));
    p->flow.blocks--;
    p->flow.skip = SKIP_NOTHING;
}

/* NULL: p->error is set. */
static struct program_block *open_block(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;
    const struct program_block *same = find_block(p, o);

    TAKT_ASSERT(f->blocks <= PROGRAM_BLOCKS_MAX);
    if (same != NULL) {
        (void)takt_oword_error(p, TAKT_ERROR_OWORD_LABEL_USED, o, same->line);
        return NULL;
    }
    if (f->blocks == PROGRAM_BLOCKS_MAX) {
        (void)takt_oword_error(p, TAKT_ERROR_OWORD_TOO_DEEP, o, PROGRAM_BLOCKS_MAX);
        return NULL;
    }
    struct program_block *b = &f->block[f->blocks++];

    *b = (struct program_block){.label = o->label,
                                .again = takt_lexer_place(&p->lexer).offset,
                                .line = o->line,
                                .column = o->column,
                                .kind = (uint8_t)o->kind};
    return b;
}

/* The open block that o belongs to, which must be the innermost; NULL: p->error is set. */
static struct program_block *block_of(struct program *p, const struct oword *o,
                                      enum oword_kind kind)
{
    struct program_block *b = find_block(p, o);

    if (b == NULL || b->kind != (uint8_t)kind) {
        (void)takt_oword_error(p, TAKT_ERROR_OWORD_UNMATCHED, o, 0.0);
        return NULL;
    }
    if (b != innermost(p)) {
        (void)takt_oword_error(p, TAKT_ERROR_OWORD_CROSSED, o, innermost(p)->line);
        return NULL;
    }
    return b;
}

/* To the next round; the line of WHILE is read again. */
static bool jump_again(struct program *p, const struct program_block *b, const struct oword *o)
{
    const struct program_place again = {b->again, b->kind == OWORD_WHILE ? b->line - 1 : b->line};

    return takt_flow_jump(p, &again, o);
}

/* The value in brackets behind the keyword, and nothing else. */
static bool read_value(struct program *p, const struct oword *o, double *value)
{
    if (p->lexer.text[p->lexer.at] != '[') {
        return takt_oword_error(p, TAKT_ERROR_BRACKET_EXPECTED, o, 0.0);
    }
    return takt_expression_read(p, value) && takt_oword_finish(p, o);
}

/*
 * A branch begins when its condition holds. One that cannot be read does not begin, nor do those
 * behind it.
 */
static bool try_branch(struct program *p, const struct oword *o, struct program_block *b)
{
    double value = 0.0;

    if (!read_value(p, o, &value)) {
        b->done = true;
        p->flow.skip = SKIP_TO_END;
        return false;
    }
    b->done = value != 0.0;
    p->flow.skip = b->done ? SKIP_NOTHING : SKIP_TO_BRANCH;
    return true;
}

static bool take_if(struct program *p, const struct oword *o)
{
    struct program_block *b = open_block(p, o);

    return b != NULL && try_branch(p, o, b);
}

static bool take_elseif(struct program *p, const struct oword *o)
{
    struct program_block *b = block_of(p, o, OWORD_IF);

    if (b == NULL) {
        return false;
    }
    if (b->done) {
        p->flow.skip = SKIP_TO_END;
        return true;
    }
    return try_branch(p, o, b);
}

static bool take_else(struct program *p, const struct oword *o)
{
    struct program_block *b = block_of(p, o, OWORD_IF);

    if (b == NULL) {
        return false;
    }
    p->flow.skip = b->done ? SKIP_TO_END : SKIP_NOTHING;
    b->done = true;
    return takt_oword_finish(p, o);
}

static bool take_endif(struct program *p, const struct oword *o)
{
    if (block_of(p, o, OWORD_IF) == NULL) {
        return false;
    }
    close_block(p);
    return takt_oword_finish(p, o);
}

/* Enters the loop or passes it over. What would be repeated needs a source that can go back. */
static bool enter_loop(struct program *p, const struct oword *o, struct program_block *b,
                       bool enters, bool repeats)
{
    b->done = !enters;
    p->flow.skip = enters ? SKIP_NOTHING : SKIP_TO_END;
    if (!repeats || takt_lexer_can_seek(&p->lexer)) {
        return true;
    }
    b->done = true;
    p->flow.skip = SKIP_TO_END;
    return takt_oword_error(p, TAKT_ERROR_JUMP_BACK, o, 0.0);
}

/* The end of DO. */
static bool take_do_while(struct program *p, const struct oword *o, const struct program_block *b)
{
    const bool leaves = b->done;
    double value = 0.0;

    p->flow.skip = SKIP_NOTHING;
    if (leaves) {
        close_block(p);
        return true;
    }
    const bool good = read_value(p, o, &value);

    if (!good || value == 0.0 || p->flow.failed || !takt_lexer_can_seek(&p->lexer)) {
        close_block(p);
    }
    if (!good || value == 0.0 || p->flow.failed) {
        return good;
    }
    return jump_again(p, b, o);
}

/* The beginning of WHILE, which is read again before each round. */
static bool take_while(struct program *p, const struct oword *o)
{
    const struct program_block *opened = find_block(p, o);
    double value = 0.0;

    if (opened != NULL && opened->kind == OWORD_DO) {
        return block_of(p, o, OWORD_DO) != NULL && take_do_while(p, o, opened);
    }
    struct program_block *b = open_block(p, o);

    if (b == NULL) {
        return false;
    }
    b->again = takt_lexer_this_line(&p->lexer).offset;
    if (!read_value(p, o, &value)) {
        (void)enter_loop(p, o, b, false, false);
        return false;
    }
    return enter_loop(p, o, b, value != 0.0, value != 0.0);
}

static bool take_endwhile(struct program *p, const struct oword *o)
{
    const struct program_block *b = block_of(p, o, OWORD_WHILE);

    if (b == NULL) {
        return false;
    }
    const bool leaves = b->done || p->flow.failed;

    close_block(p);
    return takt_oword_finish(p, o) && (leaves || jump_again(p, b, o));
}

static bool take_do(struct program *p, const struct oword *o)
{
    return open_block(p, o) != NULL && takt_oword_finish(p, o);
}

static bool take_repeat(struct program *p, const struct oword *o)
{
    struct program_block *b = open_block(p, o);
    double value = 0.0;

    if (b == NULL) {
        return false;
    }
    if (!read_value(p, o, &value)) {
        (void)enter_loop(p, o, b, false, false);
        return false;
    }
    const double rounds = takt_maths_round(maths_min(value, ROUNDS_MAX));

    b->left = rounds >= 1.0 ? (uint32_t)rounds - 1U : 0U;
    return enter_loop(p, o, b, rounds >= 1.0, b->left > 0);
}

static bool take_endrepeat(struct program *p, const struct oword *o)
{
    struct program_block *b = block_of(p, o, OWORD_REPEAT);

    if (b == NULL || !takt_oword_finish(p, o)) {
        return false;
    }
    if (b->done || b->left == 0 || p->flow.failed) {
        close_block(p);
        return true;
    }
    b->left--;
    p->flow.skip = SKIP_NOTHING;
    return jump_again(p, b, o);
}

/* BREAK and CONTINUE leave the blocks inside the loop and go to the loop's end. */
static bool leave_round(struct program *p, const struct oword *o)
{
    struct program_block *b = find_block(p, o);

    if (b == NULL || b->kind == OWORD_IF) {
        return takt_oword_error(p, TAKT_ERROR_OWORD_UNMATCHED, o, 0.0);
    }
    if (!takt_oword_finish(p, o)) {
        return false;
    }
    p->flow.blocks = (uint8_t)(b - p->flow.block + 1);
    b->done = o->kind == OWORD_BREAK;
    p->flow.skip = SKIP_TO_END;
    return true;
}

/*
 * O<place> GOTO [line] [blocks]: what a translator makes of a jump. The line begins at this place
 * of the text, inside so many blocks of this call. Without them there is no such line.
 */
static bool take_goto(struct program *p, const struct oword *o)
{
    double line;
    double blocks;

    if (p->lexer.at == p->lexer.length) {
        return takt_oword_error(p, TAKT_ERROR_JUMP_NOWHERE, o, 0.0);
    }
    if (!takt_expression_read(p, &line) || !takt_expression_read(p, &blocks)) {
        return false;
    }
    if (!(blocks >= 0.0 && first_block(p) + blocks <= p->flow.blocks) ||
        !(line >= 1.0 && line <= PROGRAM_LABEL_MAX)) {
        return takt_oword_error(p, TAKT_ERROR_OWORD_UNMATCHED, o, 0.0);
    }
    if (p->flow.failed) {
        return true;
    }
    const struct program_place place = {o->label.id, (uint32_t)line - 1U};

    p->flow.blocks = (uint8_t)(first_block(p) + (unsigned)blocks);
    return takt_flow_jump(p, &place, o);
}

static bool (*const actions[])(struct program *, const struct oword *) = {
    [OWORD_PROGRAM] = takt_calls_begin_program,
    [OWORD_SUB] = takt_calls_define,
    [OWORD_ENDSUB] = takt_calls_return,
    [OWORD_RETURN] = takt_calls_return,
    [OWORD_CALL] = takt_calls_call,
    [OWORD_IF] = take_if,
    [OWORD_ELSEIF] = take_elseif,
    [OWORD_ELSE] = take_else,
    [OWORD_ENDIF] = take_endif,
    [OWORD_WHILE] = take_while,
    [OWORD_ENDWHILE] = take_endwhile,
    [OWORD_DO] = take_do,
    [OWORD_REPEAT] = take_repeat,
    [OWORD_ENDREPEAT] = take_endrepeat,
    [OWORD_BREAK] = leave_round,
    [OWORD_CONTINUE] = leave_round,
    [OWORD_GOTO] = take_goto,
};

static bool is_branch(enum oword_kind kind)
{
    return kind == OWORD_ELSEIF || kind == OWORD_ELSE || kind == OWORD_ENDIF;
}

static bool is_end_of(const struct program_block *b, enum oword_kind kind)
{
    switch (b->kind) {
    case OWORD_IF:
        return kind == OWORD_ENDIF;
    case OWORD_WHILE:
        return kind == OWORD_ENDWHILE;
    case OWORD_REPEAT:
        return kind == OWORD_ENDREPEAT;
    default:
        return kind == OWORD_WHILE;
    }
}

static bool opens_block(enum oword_kind kind)
{
    return kind == OWORD_IF || kind == OWORD_WHILE || kind == OWORD_DO || kind == OWORD_REPEAT;
}

/* An O-word inside a block that is passed over. */
static bool pass_block(struct program *p, const struct oword *o)
{
    const struct program_block *b = innermost(p);

    if (!oword_same_label(&b->label, &o->label)) {
        return true;
    }
    if (is_end_of(b, o->kind) || (p->flow.skip == SKIP_TO_BRANCH && is_branch(o->kind))) {
        return actions[o->kind](p, o);
    }
    return !opens_block(o->kind) || takt_oword_error(p, TAKT_ERROR_OWORD_LABEL_USED, o, b->line);
}

/*
 * What stands in lines that are passed over need not be right; a label may be one that cannot be
 * worked out.
 */
static bool pass_over(struct program *p)
{
    struct oword o;

    if (!takt_oword_read(p, &o)) {
        return true;
    }
    if ((o.kind == OWORD_SUB || o.kind == OWORD_PROGRAM) &&
        !(takt_oword_keep(p, &o) && takt_calls_note(p, &o))) {
        return false;
    }
    if (p->flow.skip == SKIP_TO_SUB || p->flow.skip == SKIP_TO_ENDSUB) {
        return takt_calls_pass(p, &o);
    }
    return pass_block(p, &o);
}

bool takt_flow_take(struct program *p)
{
    struct oword o;

    if (flow_is_skipping(p)) {
        return pass_over(p);
    }
    return takt_oword_read(p, &o) && takt_oword_keep(p, &o) && actions[o.kind](p, &o);
}

/* A program that means to run for ever has been read for long enough. */
static bool stop_reading(struct program *p)
{
    takt_report_warning(p, TAKT_ERROR_REPEATS, (struct program_span){0, 0}, p->config.repeats_max);
    p->phase = PROGRAM_ENDED;
    takt_emit_event(p, MOVE_END);
    return true;
}

/*
 * Behind a jump forward lines are new, too, though not all before them has been read. A line that
 * goes on (lexer.c) begins one byte behind the last; passing over an empty line, which is no more,
 * leaves nothing out.
 */
static bool is_new(struct program_flow *f, uint64_t offset, const struct program_place *behind)
{
    const bool is_ahead = offset >= f->read_to;

    if (offset == f->furthest.offset || offset == f->furthest.offset + 1) {
        f->furthest = *behind;
    }
    f->read_to = is_ahead ? behind->offset : f->read_to;
    return is_ahead;
}

bool takt_flow_count_line(struct program *p)
{
    struct program_flow *f = &p->flow;
    const struct program_place behind = takt_lexer_place(&p->lexer);

    if (is_new(f, takt_lexer_this_line(&p->lexer).offset, &behind)) {
        return true;
    }
    f->lines_repeated++;
    if (p->config.repeats_max > 0 && f->lines_repeated > p->config.repeats_max) {
        if (f->restarted) {
            return stop_reading(p);
        }
        takt_diagnostic_set(&p->error, TAKT_ERROR_ENDLESS, p->lexer.line, 0, "", 0,
                            p->config.repeats_max);
        return false;
    }
    if (f->lines_again++ < PROGRAM_CIRCLE_LINES_MAX) {
        return true;
    }
    if (p->approach.pending) {
        takt_diagnostic_set(&p->error, TAKT_ERROR_FROM_LINE_MISSED, 0, 0, "", 0,
                            p->config.from_line);
    } else {
        takt_diagnostic_set(&p->error, TAKT_ERROR_CIRCLE, p->lexer.line, 0, "", 0,
                            PROGRAM_CIRCLE_LINES_MAX);
    }
    return false;
}

bool takt_flow_end_of_text(struct program *p)
{
    struct program_flow *f = &p->flow;

    f->all_seen = true;
    if (f->skip == SKIP_TO_SUB || f->skip == SKIP_TO_ENDSUB || f->blocks == first_block(p)) {
        return takt_calls_end_of_text(p);
    }
    const struct program_block *b = innermost(p);
    const struct oword o = {(enum oword_kind)b->kind, b->label, b->line, b->column};

    return takt_oword_error(p, TAKT_ERROR_OWORD_UNCLOSED, &o, 0.0);
}
