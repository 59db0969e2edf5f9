/*
 * Cycles, written out: a hole may lean, and a thread be longer than programmed. What a cycle does
 * between its motions is written too: the spindle, waits, stops.
 */
#include "base/maths.h"
#include "correct/offline_private.h"
#include "program/words.h"

#define WORDS_DRILLING                                                                             \
    (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p') | LETTER_BIT('q') |         \
     LETTER_BIT('l'))
#define WORDS_THREADING (WORDS_DRILLING | LETTER_BIT('e') | LETTER_BIT('h'))

#define CODE_THREADING 760

static unsigned code_number(const struct offline_line *line)
{
    const struct program_code *motion = line->context.modes.motion;

    return motion != NULL && motion->letter == 'g' ? motion->number_x10 : 0;
}

bool offline_is_cycle(const struct offline_line *line)
{
    const unsigned number = code_number(line);

    return number >= 730 && number <= 890 && number != 800 &&
           !words_has_step(&line->context, STEP_REFERENCE);
}

bool offline_is_cycle_event(const struct move *move)
{
    return move->kind == MOVE_DWELL || move->kind == MOVE_SPINDLE || move->kind == MOVE_ORIENT ||
           move->kind == MOVE_STOP;
}

static const char *spindle_code(enum spindle_direction direction)
{
    switch (direction) {
    case SPINDLE_CW:
        return "M3";
    case SPINDLE_CCW:
        return "M4";
    case SPINDLE_OFF:
        break;
    }
    return "M5";
}

static void print_event(const struct move *move, struct offline_text *text)
{
    if (move->kind == MOVE_DWELL)
        offline_text_print(text, "\nG4 P%.9g", move->dwell_s);
    else if (move->kind == MOVE_SPINDLE)
        offline_text_print(text, "\n%s", spindle_code(move->direction));
    else if (move->kind == MOVE_ORIENT)
        offline_text_print(text, "\nM19 R%.9g", move->orient_rad * 180.0 / MATHS_PI);
    else
        offline_text_print(text, "\nM0");
}

/* Tapping and threading are not to be overridden: bits of what the cycle has locked. */
static void lock_overrides(unsigned *locked, unsigned wanted, struct offline_text *text)
{
    const unsigned changed = *locked ^ wanted;

    if ((changed & OVERRIDE_FEED) != 0)
        offline_text_print(text, "\nM50 P%d", (wanted & OVERRIDE_FEED) == 0);
    if ((changed & OVERRIDE_SPINDLE) != 0)
        offline_text_print(text, "\nM51 P%d", (wanted & OVERRIDE_SPINDLE) == 0);
    *locked = wanted;
}

static bool print_motion(struct offline_rewriter *r, const struct offline_line *line,
                         const struct move *move, struct offline_piece *pieces,
                         struct offline_text *text)
{
    const unsigned n = offline_divide(r, move, pieces);

    if (n == 0)
        return false;
    offline_print_pieces(r, line, move, pieces, 0, n, text);
    r->at = move->end;
    return true;
}

static bool print_moves(struct offline_rewriter *r, const struct offline_line *line, unsigned moves,
                        struct offline_piece *pieces, struct offline_text *text)
{
    const unsigned given = line->context.modes.overrides;
    unsigned locked = 0;

    for (unsigned i = 0; i < moves; i++) {
        const struct move *move = &line->move[i];

        if (!move_is_motion(move)) {
            print_event(move, text);
            continue;
        }
        lock_overrides(&locked, given & ~move->overrides, text);
        if (!print_motion(r, line, move, pieces, text))
            return false;
    }
    lock_overrides(&locked, 0, text);
    return true;
}

bool offline_rewrite_cycle(struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_piece *pieces, struct offline_text *text)
{
    const bool stops = words_has_step(&line->context, STEP_STOP);
    const bool own_stop = stops && line->move[line->moves - 1].kind == MOVE_STOP;
    struct offline_cuts cuts;

    offline_cuts_init(&cuts, line);
    offline_cut_letters(&cuts, line,
                        code_number(line) == CODE_THREADING ? WORDS_THREADING : WORDS_DRILLING);
    offline_cut_code(&cuts, line, STEP_MOTION);
    if (stops)
        offline_cut_stop(&cuts, line);
    offline_print_kept(line, &cuts, "", text);
    if (!print_moves(r, line, line->moves - (own_stop ? 1U : 0U), pieces, text))
        return false;
    if (stops)
        offline_print_stop(line, text);
    return true;
}
