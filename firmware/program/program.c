#include "program/program.h"

#include "program/coordinates.h"
#include "program/emit.h"
#include "program/lexer.h"
#include "program/modes.h"
#include "program/words.h"

#include <assert.h>

static_assert(sizeof(struct program) + sizeof(struct parameters) <= PROGRAM_MEMORY_MAX,
              "the interpreter outgrew the memory set aside for it");
static_assert(STEP_COUNT <= 32, "steps are bits of a word");

void program_open(struct program *p, const struct program_config *config,
                  const struct source *source)
{
    p->config = *config;
    lexer_open(&p->lexer, source);
    p->names.count = 0;
    p->queue_first = 0;
    p->queue_count = 0;
    p->warnings = 0;
    p->phase = PROGRAM_AT_START;
    modes_open(p);
    coordinates_open(p);
}

static bool run_steps(struct program *p)
{
    for (unsigned step = 0; step < STEP_COUNT; step++) {
        if (words_has_step(p, (enum step)step)) {
            const struct program_code *code = p->words.code[step];

            if (!code->run(p, code)) {
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

    if (!words_read(p)) {
        return false;
    }
    if (words_assign(p) && run_steps(p)) {
        return true;
    }
    words_take_back(p);
    p->modes = before;
    p->queue_count = 0;
    return false;
}

static void end(struct program *p)
{
    emit_event(p, MOVE_END);
    p->phase = PROGRAM_ENDED;
}

/* A line of '%' alone opens a program when it is the first that says something, else it ends it. */
static bool is_percent(const struct program_lexer *l)
{
    return l->length == 1 && l->text[0] == '%';
}

static bool take_line(struct program *p)
{
    struct program_lexer *l = &p->lexer;

    if (l->length == 0) {
        return true;
    }
    const bool first = p->phase == PROGRAM_AT_START;

    p->phase = PROGRAM_IN_TEXT;
    if (is_percent(l)) {
        if (!first) {
            end(p);
        }
        return true;
    }
    if (lexer_accept(l, '/') && p->config.block_delete) {
        return true;
    }
    return run_line(p);
}

/* Reads one line; false: p->error is set. */
static bool advance(struct program *p)
{
    switch (lexer_next_line(&p->lexer, &p->error)) {
    case LEXER_LINE:
        return take_line(p);
    case LEXER_END:
        end(p);
        return true;
    case LEXER_UNREADABLE:
        p->phase = PROGRAM_ENDED;
        return false;
    case LEXER_ERROR:
        break;
    }
    return false;
}

enum program_result program_next(struct program *p, struct move *move,
                                 struct diagnostic *diagnostic)
{
    while (p->queue_count == 0) {
        if (p->phase == PROGRAM_ENDED) {
            return PROGRAM_END;
        }
        if (!advance(p)) {
            *diagnostic = p->error;
            return PROGRAM_ERROR;
        }
    }
    *move = p->queue[p->queue_first];
    p->queue_first = (p->queue_first + 1) % PROGRAM_QUEUE_MAX;
    p->queue_count--;
    return PROGRAM_MOVE;
}

bool program_warning(struct program *p, struct diagnostic *diagnostic)
{
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
