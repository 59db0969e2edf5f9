#include "program/calls.h"

#include "base/assert.h"
#include "program/changes.h"
#include "program/expression.h"
#include "program/flow.h"
#include "program/lexer.h"
#include "program/names.h"
#include "program/report.h"
#include "program/saved_modes.h"
#include "program/words.h"

#include <string.h>

static struct program_frame *current(struct program *p)
{
    return &p->flow.frame[p->flow.calls];
}

/* PROGRAM_SUBS_MAX when there is none. */
static unsigned find_sub(const struct program *p, const struct program_label *label)
{
    TAKT_ASSERT(p->flow.subs <= PROGRAM_SUBS_MAX);
    for (unsigned i = 0; i < p->flow.subs; i++) {
        if (oword_same_label(&p->flow.sub[i].label, label)) {
            return i;
        }
    }
    return PROGRAM_SUBS_MAX;
}

bool takt_calls_note(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;
    const struct program_place body = takt_lexer_place(&p->lexer);
    const unsigned known = find_sub(p, &o->label);

    if (known != PROGRAM_SUBS_MAX) {
        return f->sub[known].body.offset == body.offset ||
               takt_oword_error(p, TAKT_ERROR_SUB_DEFINED_TWICE, o, f->sub[known].body.line);
    }
    if (f->subs == PROGRAM_SUBS_MAX) {
        return takt_oword_error(p, TAKT_ERROR_SUBS_TOO_MANY, o, PROGRAM_SUBS_MAX);
    }
    f->sub[f->subs++] =
        (struct program_sub){.label = o->label, .body = body, .numbered = o->kind == OWORD_PROGRAM};
    return true;
}

bool takt_calls_begin_program(struct program *p, const struct oword *o)
{
    return takt_calls_note(p, o);
}

bool takt_calls_define(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;

    if (f->calls > 0) {
        return takt_oword_error(p, TAKT_ERROR_SUB_NESTED, o, 0.0);
    }
    f->skip = SKIP_TO_ENDSUB;
    f->skip_label = o->label;
    f->skip_line = o->line;
    f->skip_column = o->column;
    return takt_calls_note(p, o) && takt_oword_finish(p, o);
}

/* #5220 has a place already: another system than now has been selected before. */
static bool restore_modes(struct program *p, const struct program_frame *frame,
                          const struct oword *o)
{
    if (!takt_saved_modes_restore(p, frame)) {
        return takt_oword_error(p, TAKT_ERROR_CUTTER_ON, o, 0.0);
    }
    const double before = takt_parameters_get(p->config.parameters, PARAMETER_SYSTEM);

    if (!takt_parameters_set(p->config.parameters, PARAMETER_SYSTEM, p->modes.system)) {
        return takt_oword_error(p, TAKT_ERROR_PARAMETERS_FULL, o, 0.0);
    }
    takt_changes_note(p, PARAMETER_SYSTEM, before);
    return true;
}

/*
 * #1 ... that a caller has to find again: up to the last one with any bit set, since -0 is not 0
 * everywhere.
 */
static unsigned count_locals(const double local[PARAMETERS_LOCAL])
{
    unsigned count = PARAMETERS_LOCAL;
    uint64_t bits = 0;

    while (count > 0 && bits == 0) {
        count--;
        memcpy(&bits, &local[count], sizeof(bits));
    }
    return bits == 0 ? 0 : count + 1;
}

/* A numbered program shares them with its caller. False: there is no room. */
static bool keep_locals(struct program *p, struct program_frame *frame, unsigned kept)
{
    const double *local = p->config.parameters->local;
    const unsigned count = frame->numbered ? 0 : count_locals(local);

    if (kept + count > PROGRAM_KEPT_MAX) {
        return false;
    }
    memcpy(&p->flow.kept[kept], local, count * sizeof(local[0]));
    frame->kept = (uint16_t)kept;
    frame->locals = (uint8_t)count;
    return true;
}

static void bring_back_locals(struct program *p, const struct program_frame *frame)
{
    double *local = p->config.parameters->local;

    memset(local, 0, PARAMETERS_LOCAL * sizeof(local[0]));
    memcpy(local, &p->flow.kept[frame->kept], frame->locals * sizeof(local[0]));
}

/* Back behind the call. */
static bool leave(struct program *p, const struct oword *o)
{
    struct program_frame *frame = current(p);

    TAKT_ASSERT(p->flow.calls > 0);
    if (!frame->numbered) {
        bring_back_locals(p, frame);
    }
    takt_names_leave_call(&p->names);
    p->flow.blocks = frame->blocks;
    p->flow.calls--;
    if (!takt_flow_jump(p, &frame->back, o)) {
        return false;
    }
    return !frame->restores || restore_modes(p, frame, o);
}

static bool enter(struct program *p, const struct oword *o, unsigned sub)
{
    struct program_frame *frame = current(p);
    struct program_sub *s = &p->flow.sub[sub];

    TAKT_ASSERT(sub < p->flow.subs);
    if (s->numbered != frame->numbered) {
        (void)leave(p, o);
        return takt_oword_error(p, TAKT_ERROR_SUB_STYLE, o, 0.0);
    }
    frame->sub = (uint8_t)sub;
    s->visited = p->flow.failed;
    return takt_flow_jump(p, &s->body, o);
}

/* To the subroutine of the call that has just begun, or to where it may be found. */
static bool go_to_sub(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;
    const unsigned sub = find_sub(p, &o->label);

    if (sub != PROGRAM_SUBS_MAX) {
        return enter(p, o, sub);
    }
    if (f->all_seen) {
        (void)leave(p, o);
        return takt_oword_error(p, TAKT_ERROR_SUB_UNKNOWN, o, 0.0);
    }
    f->skip = SKIP_TO_SUB;
    f->skip_label = o->label;
    return takt_flow_jump(p, &f->furthest, o);
}

/* After an error each subroutine is read once more, to find the errors in it. */
static bool is_passed_over(const struct program *p, const struct oword *o)
{
    const unsigned sub = find_sub(p, &o->label);

    return p->flow.failed && sub != PROGRAM_SUBS_MAX && p->flow.sub[sub].visited;
}

static bool begin_call(struct program *p, const struct oword *o, uint32_t times)
{
    struct program_flow *f = &p->flow;

    if (!takt_lexer_can_seek(&p->lexer)) {
        return takt_oword_error(p, TAKT_ERROR_JUMP_BACK, o, 0.0);
    }
    if (f->calls == PROGRAM_CALLS_MAX) {
        return takt_oword_error(p, TAKT_ERROR_CALL_TOO_DEEP, o, PROGRAM_CALLS_MAX);
    }
    struct program_frame *frame = &f->frame[f->calls + 1];

    frame->numbered = o->kind == OWORD_M98;
    if (!keep_locals(p, frame, takt_saved_modes_end(current(p)))) {
        return takt_oword_error(p, TAKT_ERROR_PROGRAM_FULL, o, 0.0);
    }
    f->calls++;
    frame->back = takt_lexer_place(&p->lexer);
    frame->sub = PROGRAM_SUBS_MAX;
    frame->is_saved = false;
    frame->restores = false;
    frame->blocks = f->blocks;
    frame->times = times;
    frame->line = o->line;
    frame->column = o->column;
    takt_names_enter_call(&p->names);
    return go_to_sub(p, o);
}

/* [value] [value] ...; the rest of #1 ... #30 is 0. */
static bool read_arguments(struct program *p, const struct oword *o, double *values)
{
    for (unsigned i = 0; i < PARAMETERS_LOCAL; i++) {
        values[i] = 0.0;
        if (p->lexer.text[p->lexer.at] == '[' && !takt_expression_read(p, &values[i])) {
            return false;
        }
    }
    if (p->lexer.text[p->lexer.at] == '[') {
        return takt_oword_error(p, TAKT_ERROR_CALL_ARGUMENTS, o, PARAMETERS_LOCAL);
    }
    return takt_oword_finish(p, o);
}

bool takt_calls_call(struct program *p, const struct oword *o)
{
    double values[PARAMETERS_LOCAL];

    if (!read_arguments(p, o, values)) {
        return false;
    }
    if (is_passed_over(p, o)) {
        return true;
    }
    if (!begin_call(p, o, 1)) {
        return false;
    }
    memcpy(p->config.parameters->local, values, sizeof(values));
    return true;
}

/* The value behind RETURN and ENDSUB, for #<_value>. */
static bool read_returned(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;
    double value = 0.0;
    const bool given = p->lexer.text[p->lexer.at] == '[';

    if ((given && !takt_expression_read(p, &value)) || !takt_oword_finish(p, o)) {
        return false;
    }
    f->value = value;
    f->value_returned = given;
    return true;
}

/* ENDSUB has the label of its subroutine; RETURN leaves it whatever its own is. */
bool takt_calls_return(struct program *p, const struct oword *o)
{
    const struct program_frame *frame = current(p);

    if (p->flow.calls == 0) {
        return takt_oword_error(p, TAKT_ERROR_SUB_NOT_INSIDE, o, 0.0);
    }
    if (frame->numbered) {
        return takt_oword_error(p, TAKT_ERROR_SUB_STYLE, o, 0.0);
    }
    if (o->kind != OWORD_RETURN && !oword_same_label(&p->flow.sub[frame->sub].label, &o->label)) {
        return takt_oword_error(p, TAKT_ERROR_SUB_NOT_INSIDE, o, 0.0);
    }
    const bool good = read_returned(p, o);

    return leave(p, o) && good;
}

/* The definition, or the subroutine, that was looked for. */
static bool arrive(struct program *p, const struct oword *o)
{
    const struct program_frame *frame = current(p);
    const struct oword call = {frame->numbered ? OWORD_M98 : OWORD_CALL, o->label, frame->line,
                               frame->column};

    p->flow.skip = SKIP_NOTHING;
    return enter(p, &call, find_sub(p, &o->label));
}

bool takt_calls_pass(struct program *p, const struct oword *o)
{
    struct program_flow *f = &p->flow;
    const bool same = oword_same_label(&f->skip_label, &o->label);

    if (f->skip == SKIP_TO_SUB) {
        const bool begins = o->kind == OWORD_SUB || o->kind == OWORD_PROGRAM;

        return !(same && begins) || arrive(p, o);
    }
    if (o->kind == OWORD_SUB) {
        return takt_oword_error(p, TAKT_ERROR_SUB_NESTED, o, 0.0);
    }
    if (same && o->kind == OWORD_ENDSUB) {
        f->skip = SKIP_NOTHING;
    }
    return true;
}

bool takt_calls_end_of_text(struct program *p)
{
    struct program_flow *f = &p->flow;
    const struct program_frame *frame = current(p);
    struct oword o = {.label = f->skip_label, .line = f->skip_line, .column = f->skip_column};

    if (f->skip == SKIP_TO_SUB) {
        o.kind = frame->numbered ? OWORD_M98 : OWORD_CALL;
        o.line = frame->line;
        o.column = frame->column;
        f->skip = SKIP_NOTHING;
        return leave(p, &o) && takt_oword_error(p, TAKT_ERROR_SUB_UNKNOWN, &o, 0.0);
    }
    if (f->skip == SKIP_TO_ENDSUB) {
        o.kind = OWORD_SUB;
        return takt_oword_error(p, TAKT_ERROR_OWORD_UNCLOSED, &o, 0.0);
    }
    if (f->calls == 0) {
        return true;
    }
    o.kind = frame->numbered ? OWORD_PROGRAM : OWORD_SUB;
    o.label = f->sub[frame->sub].label;
    o.line = f->sub[frame->sub].body.line;
    o.column = 0;
    return takt_oword_error(p, TAKT_ERROR_OWORD_UNCLOSED, &o, 0.0);
}

static void place_of_code(const struct program *p, const struct program_code *code, struct oword *o)
{
    o->line = p->lexer.line;
    o->column = takt_lexer_column(&p->lexer, p->words.code_span[code->step].begin);
}

bool takt_calls_call_number(struct program *p, const struct program_code *code, uint32_t number)
{
    struct oword o = {.kind = OWORD_CALL, .label.id = number};

    place_of_code(p, code, &o);
    if (!begin_call(p, &o, 1)) {
        return false;
    }
    memset(p->config.parameters->local, 0, sizeof(p->config.parameters->local));
    return true;
}

static bool call_program(struct program *p, const struct program_code *code)
{
    struct oword o = {.kind = OWORD_M98};
    uint32_t number;
    uint32_t times = 1;

    place_of_code(p, code, &o);
    if (!words_has(p, 'p')) {
        return takt_report_error_code(p, TAKT_ERROR_CALL_P_MISSING, code->step, 0.0);
    }
    if (!takt_words_whole(p, 'p', 0.0, PROGRAM_LABEL_MAX, &number) ||
        (words_has(p, 'l') && !takt_words_whole(p, 'l', 0.0, PROGRAM_LABEL_MAX, &times))) {
        return false;
    }
    o.label.id = number;
    return times == 0 || is_passed_over(p, &o) || begin_call(p, &o, times);
}

/* M99 in the main program: once more from the beginning. After an error once is enough. */
static bool start_again(struct program *p, const struct oword *o)
{
    const struct program_place beginning = {0, 0};

    if (p->flow.failed) {
        p->phase = PROGRAM_ENDED;
        return true;
    }
    p->phase = PROGRAM_AT_START;
    p->flow.blocks = 0;
    p->flow.restarted = true;
    return takt_flow_jump(p, &beginning, o);
}

static bool end_program(struct program *p, const struct program_code *code)
{
    struct oword o = {.kind = OWORD_M99};
    struct program_frame *frame = current(p);

    place_of_code(p, code, &o);
    if (p->flow.calls == 0) {
        return start_again(p, &o);
    }
    if (!frame->numbered) {
        return takt_oword_error(p, TAKT_ERROR_SUB_STYLE, &o, 0.0);
    }
    if (frame->times <= 1 || p->flow.failed) {
        return leave(p, &o);
    }
    frame->times--;
    p->flow.blocks = frame->blocks;
    takt_names_leave_call(&p->names);
    takt_names_enter_call(&p->names);
    return takt_flow_jump(p, &p->flow.sub[frame->sub].body, &o);
}

bool takt_calls_run_code(struct program *p, const struct program_code *code)
{
    return code->argument == 0 ? call_program(p, code) : end_program(p, code);
}
