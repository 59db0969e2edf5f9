/*
 * A line with an error moves nothing and changes no mode. A program that is read on, to find its
 * other errors, then is at another place than it means to be, with another motion and feed. An
 * error that asks for these, where a refused line would have set them, says nothing of its line.
 */
#include "program/refused.h"

#include "base/assert.h"
#include "program/words.h"

/* The line goes on with the motion before it. */
static bool goes_on(const struct program *p)
{
    const unsigned begin = p->words.code_span[STEP_MOTION].begin;

    TAKT_ASSERT(begin < sizeof(p->lexer.text));
    return !words_has_step(p, STEP_MOTION) || p->lexer.text[begin] != 'g';
}

/* Errors that ask where the move begins. */
static const enum takt_error of_place[] = {TAKT_ERROR_ARC_ENDPOINT,     TAKT_ERROR_ARC_RADIUS_ZERO,
                                           TAKT_ERROR_ARC_RADIUS_SMALL, TAKT_ERROR_ARC_CLOSED,
                                           TAKT_ERROR_INVOLUTE_START,   TAKT_ERROR_INVOLUTE_END,
                                           TAKT_ERROR_INVOLUTE_TURNS,   TAKT_ERROR_INVOLUTE_CLOSED,
                                           TAKT_ERROR_SPLINE_START,     TAKT_ERROR_PROBE_NO_WAY};
/* Errors that ask which motion it is. */
static const enum takt_error of_motion[] = {TAKT_ERROR_MOTION_MODE_MISSING,
                                            TAKT_ERROR_ARC_CENTRE_MISSING, TAKT_ERROR_WORD_MISSING,
                                            TAKT_ERROR_FEED_MISSING};

static bool is_among(const enum takt_error *codes, size_t count, enum takt_error code)
{
    for (size_t i = 0; i < count; i++) {
        if (codes[i] == code) {
            return true;
        }
    }
    return false;
}

static bool asks_for_place(const struct program *p)
{
    return is_among(of_place, sizeof(of_place) / sizeof(of_place[0]), p->error.code) ||
           (p->error.code == TAKT_ERROR_TRAVEL_EXCEEDED && p->modes.incremental);
}

static bool asks_for_motion(const struct program *p)
{
    const bool moves = (p->words.given & (LETTERS_AXES | LETTERS_CENTRE)) != 0;

    return is_among(of_motion, sizeof(of_motion) / sizeof(of_motion[0]), p->error.code) ||
           (p->error.code == TAKT_ERROR_WORD_UNUSED && moves) || asks_for_place(p);
}

/* Has the error come of a line that has been refused before? */
static bool is_explained(const struct program *p)
{
    const struct program_flow *f = &p->flow;
    const bool feed = p->error.code == TAKT_ERROR_FEED_MISSING;

    return (f->motion_refused && goes_on(p) && asks_for_motion(p)) ||
           ((f->refused & LETTERS_AXES) != 0 && asks_for_place(p)) ||
           ((f->refused & LETTER_BIT('f')) != 0 && feed);
}

static void note(struct program *p)
{
    struct program_flow *f = &p->flow;

    f->refused |= p->words.given & (LETTERS_AXES | LETTER_BIT('f'));
    f->motion_refused = f->motion_refused || !goes_on(p);
}

/* What the line has set is known again; a distance leads from one unknown place to another. */
static void forget(struct program *p)
{
    struct program_flow *f = &p->flow;

    f->refused &= ~(p->words.given & LETTER_BIT('f'));
    if (words_has_step(p, STEP_MOTION) && !p->modes.incremental) {
        f->refused &= ~(p->words.given & LETTERS_AXES);
    }
    f->motion_refused = f->motion_refused && goes_on(p);
}

bool takt_refused_judge(struct program *p, bool good)
{
    if (good) {
        forget(p);
        return true;
    }
    const bool explained = is_explained(p);

    note(p);
    return explained;
}
