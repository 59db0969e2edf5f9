/* A line of the program with the words of its motion replaced. */
#include "program/words.h"
#include "takt/offline_private.h"

#include <stdlib.h>
#include <string.h>

/* Letters that say where a straight move goes, an arc, a cycle. */
#define WORDS_STRAIGHT LETTERS_AXES
#define WORDS_ARC      (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p'))
#define WORDS_CYCLE                                                                                \
    (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p') | LETTER_BIT('q') |         \
     LETTER_BIT('l'))

static bool is_cycle(const struct offline_line *line)
{
    const struct program_code *motion = line->context.modes.motion;

    return motion != NULL && motion->letter == 'g' && motion->number_x10 >= 730 &&
           motion->number_x10 <= 890 && motion->number_x10 != 800;
}

static bool refuse(struct offline_rewriter *r, const struct offline_line *line)
{
    r->wrong =
        "this motion cannot be corrected in the program: lines, arcs and drilling cycles can; "
        "correct others while they run";
    r->wrong_line = line->line;
    return false;
}

/* What can be written: lines and arcs, and cycles that are made of lines and waits. */
static bool can_write(const struct offline_line *line)
{
    const bool cycle = is_cycle(line);

    if (words_has_step(&line->context, STEP_REFERENCE))
        return false;
    for (unsigned i = 0; i < line->moves; i++) {
        const struct move *m = &line->move[i];

        if (m->kind > MOVE_ARC_CCW && !(cycle && m->kind == MOVE_DWELL))
            return false;
        if (m->feed_rev_mm != 0.0)
            return false;
    }
    return cycle || line->moves == 1;
}

/* ---- cutting words out of the line ---- */

/* Which bytes of the line go; the place of the first of them gets the new words. */
struct cuts {
    bool gone[PROGRAM_LINE_MAX + 2];
    size_t first; /* the line's length: none is gone */
};

static void cut(struct cuts *cuts, const struct offline_line *line, const struct program_span *span)
{
    const struct program_lexer *lexer = &line->context.lexer;
    const size_t from = lexer->column[span->begin] - 1U;
    const size_t to = lexer->column[span->end - 1];
    unsigned nested = 0;

    for (size_t i = from; i < to && i < line->raw_length; i++) {
        nested += line->raw[i] == '(' ? 1 : 0;
        cuts->gone[i] = nested == 0;
        nested -= line->raw[i] == ')' && nested > 0 ? 1 : 0;
    }
    if (from < cuts->first)
        cuts->first = from;
}

/* Letters' spans begin at their letter. */
static void cut_words(struct cuts *cuts, const struct offline_line *line, uint32_t letters)
{
    for (unsigned i = 0; i < 26; i++) {
        if ((line->context.words.given & letters & UINT32_C(1) << i) != 0)
            cut(cuts, line, &line->context.words.span[i]);
    }
}

/* Where new words go when none is taken out: before comments at the end. */
static size_t end_of_words(const struct offline_line *line)
{
    const struct program_lexer *lexer = &line->context.lexer;

    return lexer->length > 0 ? lexer->column[lexer->length - 1] : 0;
}

static void print_first(const struct offline_line *line, const struct cuts *cuts, const char *words,
                        struct offline_text *text)
{
    size_t place = cuts->first < line->raw_length ? cuts->first : end_of_words(line);
    size_t from = 0;

    for (size_t i = 0; i <= line->raw_length; i++) {
        const bool insert = i == place;

        if (insert || i == line->raw_length || cuts->gone[i]) {
            offline_text_add(text, line->raw + from, i - from);
            from = i;
        }
        if (insert) {
            const bool spaced = text->length > 0 && text->bytes[text->length - 1] == ' ';

            words += spaced && words[0] == ' ' ? 1 : 0;
            offline_text_add(text, words, strlen(words));
        }
        if (i < line->raw_length && cuts->gone[i])
            from = i + 1;
    }
}

/* ---- the lines of all pieces ---- */

static bool begins_with_slash(const struct offline_line *line)
{
    size_t i = 0;

    while (i < line->raw_length && (line->raw[i] == ' ' || line->raw[i] == '\t'))
        i++;
    return i < line->raw_length && line->raw[i] == '/';
}

static const char *code_of(const struct move *move)
{
    if (move->kind == MOVE_ARC_CW)
        return "G2";
    if (move->kind == MOVE_ARC_CCW)
        return "G3";
    return move->kind == MOVE_RAPID ? "G0" : "G1";
}

/* G93: a piece takes its part of the time. */
static void print_feed(const struct offline_line *line, const struct move *move, unsigned n,
                       struct offline_text *text)
{
    if (line->context.modes.inverse_time && move->kind != MOVE_RAPID && n > 1)
        offline_text_print(text, " F%.9g", words_value(&line->context, 'f') * n);
}

/* What comes after the first piece of a move. */
static void print_rest(struct offline_rewriter *r, const struct offline_line *line,
                       const struct move *move, const struct offline_piece *pieces, unsigned n,
                       struct offline_text *text)
{
    for (unsigned k = 1; k < n; k++) {
        offline_text_print(text, "\n%s%s%s", begins_with_slash(line) ? "/" : "",
                           words_has_step(&line->context, STEP_MACHINE) ? "G53 " : "",
                           code_of(move));
        print_feed(line, move, n, text);
        offline_print_words(r, line, move, &pieces[k], text);
        r->written = pieces[k].end;
        r->totals.pieces++;
    }
}

/* The stop at the end of the line comes behind the last piece. */
static bool has_late_stop(const struct offline_line *line, unsigned n)
{
    return n > 1 && words_has_step(&line->context, STEP_STOP);
}

static void print_stop(const struct offline_line *line, struct offline_text *text)
{
    const struct program_span *span = &line->context.words.code_span[STEP_STOP];

    offline_text_print(text, "\n%s%.*s", begins_with_slash(line) ? "/" : "",
                       (int)(span->end - span->begin), line->context.lexer.text + span->begin);
}

static bool rewrite_motion(struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_piece *pieces, struct offline_text *text)
{
    const struct move *move = &line->move[0];
    struct offline_text words = {0};
    struct cuts cuts = {.first = line->raw_length};
    unsigned n = offline_divide(r, move, pieces);

    if (n == 0)
        return false;
    cut_words(&cuts, line, move_is_arc(move) ? WORDS_ARC : WORDS_STRAIGHT);
    if (has_late_stop(line, n))
        cut(&cuts, line, &line->context.words.code_span[STEP_STOP]);
    if (line->context.modes.inverse_time && n > 1)
        cut_words(&cuts, line, LETTER_BIT('f'));
    print_feed(line, move, n, &words);
    offline_print_words(r, line, move, &pieces[0], &words);
    r->written = pieces[0].end;
    r->totals.pieces++;
    print_first(line, &cuts, words.bytes, text);
    print_rest(r, line, move, pieces, n, text);
    if (has_late_stop(line, n))
        print_stop(line, text);
    text->failed |= words.failed;
    offline_text_free(&words);
    return true;
}

/* A cycle's moves one by one, since the hole may lean; its words and code go. */
static bool rewrite_cycle(struct offline_rewriter *r, const struct offline_line *line,
                          struct offline_piece *pieces, struct offline_text *text)
{
    struct cuts cuts = {.first = line->raw_length};

    cut_words(&cuts, line, WORDS_CYCLE);
    if (words_has_step(&line->context, STEP_MOTION))
        cut(&cuts, line, &line->context.words.code_span[STEP_MOTION]);
    print_first(line, &cuts, "", text);
    for (unsigned i = 0; i < line->moves; i++) {
        const struct move *move = &line->move[i];
        unsigned n;

        if (move->kind == MOVE_DWELL) {
            offline_text_print(text, "\nG4 P%.9g", move->dwell_s);
            continue;
        }
        n = offline_divide(r, move, pieces);
        if (n == 0)
            return false;
        offline_text_print(text, "\n%s", code_of(move));
        offline_print_words(r, line, move, &pieces[0], text);
        r->written = pieces[0].end;
        r->totals.pieces++;
        print_rest(r, line, move, pieces, n, text);
        r->at = move->end;
    }
    return true;
}

bool offline_rewrite_line(struct offline_rewriter *r, const struct offline_line *line,
                          struct offline_text *text)
{
    struct offline_piece *pieces = malloc(OFFLINE_PIECES_MAX * sizeof *pieces);
    bool good = pieces != NULL;

    if (!good)
        text->failed = true;
    if (good && !can_write(line))
        good = refuse(r, line);
    if (good)
        good = is_cycle(line) ? rewrite_cycle(r, line, pieces, text)
                              : rewrite_motion(r, line, pieces, text);
    for (unsigned i = 0; i < line->moves; i++) {
        if (move_is_motion(&line->move[i]))
            r->at = line->move[i].end;
        r->totals.compensated |= line->move[i].cutter_side != CUTTER_OFF;
    }
    free(pieces);
    return good;
}
