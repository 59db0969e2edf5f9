/* A line of the program with the words of its motion replaced. */
#include "correct/offline_private.h"
#include "program/coordinates.h"
#include "program/flow.h"
#include "program/words.h"

#include <stdlib.h>
#include <string.h>

/* Letters that say where a straight move goes, a curve, a thread. */
#define WORDS_STRAIGHT LETTERS_AXES
#define WORDS_CURVE    (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p'))
#define WORDS_THREAD   (LETTERS_AXES | LETTER_BIT('k'))

static bool refuse(struct offline_rewriter *r, const struct offline_line *line, const char *why)
{
    r->wrong = why;
    r->wrong_line = line->line;
    return false;
}

static uint32_t letters_of(const struct move *move)
{
    if (move_is_arc(move) || move_is_involute(move))
        return WORDS_CURVE;
    return move->kind == MOVE_THREAD || move->kind == MOVE_TAP ? WORDS_THREAD : WORDS_STRAIGHT;
}

/* ---- the lines of all pieces ---- */

static bool begins_with_slash(const struct offline_line *line)
{
    size_t i = 0;

    while (i < line->raw_length && (line->raw[i] == ' ' || line->raw[i] == '\t'))
        i++;
    return i < line->raw_length && line->raw[i] == '/';
}

static const char *code_of(const struct move *move, const struct offline_piece *piece)
{
    if (piece->straight)
        return "G1";
    switch ((int)move->kind) {
    case MOVE_RAPID:
        return "G0";
    case MOVE_ARC_CW:
        return "G2";
    case MOVE_ARC_CCW:
        return "G3";
    case MOVE_INVOLUTE_CW:
        return "G2.2";
    case MOVE_INVOLUTE_CCW:
        return "G3.2";
    case MOVE_THREAD:
        return "G33";
    case MOVE_TAP:
        return "G33.1";
    default:
        return "G1";
    }
}

/* G93: a piece takes its part of the time. */
static void print_feed(const struct offline_line *line, const struct move *move, double share,
                       struct offline_text *text)
{
    if (line->context.modes.inverse_time && move->kind != MOVE_RAPID && share < 1.0)
        offline_text_print(text, " F%.9g", words_value(&line->context, 'f') / share);
}

static void print_piece(struct offline_rewriter *r, const struct offline_line *line,
                        const struct move *move, const struct offline_piece *piece,
                        struct offline_text *text)
{
    print_feed(line, move, piece->share, text);
    offline_print_words(r, line, move, piece, text);
    r->totals.pieces++;
}

void offline_print_pieces(struct offline_rewriter *r, const struct offline_line *line,
                          const struct move *move, const struct offline_piece *pieces,
                          unsigned first, unsigned n, struct offline_text *text)
{
    for (unsigned k = first; k < n; k++) {
        offline_text_print(text, "\n%s%s%s", begins_with_slash(line) ? "/" : "",
                           words_has_step(&line->context, STEP_MACHINE) ? "G53 " : "",
                           code_of(move, &pieces[k]));
        r->code = code_of(move, &pieces[k]);
        print_piece(r, line, move, &pieces[k], text);
    }
}

/* The stop at the end of the line comes behind the last piece. */
static bool has_late_stop(const struct offline_line *line, unsigned n)
{
    return n > 1 && words_has_step(&line->context, STEP_STOP);
}

static void print_span(const struct offline_line *line, const struct program_span *span,
                       struct offline_text *text)
{
    offline_text_add(text, line->context.lexer.text + span->begin,
                     (size_t)(span->end - span->begin));
}

/* M98 has words of its own. */
static uint32_t letters_of_stop(const struct offline_line *line)
{
    return line->context.words.given & line->context.words.code[STEP_STOP]->words;
}

void offline_cut_stop(struct offline_cuts *cuts, const struct offline_line *line)
{
    offline_cut_code(cuts, line, STEP_STOP);
    offline_cut_letters(cuts, line, letters_of_stop(line));
}

void offline_print_stop(const struct offline_line *line, struct offline_text *text)
{
    const struct program_words *words = &line->context.words;

    offline_text_print(text, "\n%s", begins_with_slash(line) ? "/" : "");
    print_span(line, &words->code_span[STEP_STOP], text);
    for (unsigned i = 0; i < 26; i++) {
        if ((letters_of_stop(line) & UINT32_C(1) << i) != 0)
            print_span(line, &words->span[i], text);
    }
}

/* ---- the forms of lines ---- */

/*
 * The line's own code stays if it is the right one. A line without a code gets one where what has
 * been written before it has left another one in effect.
 */
static void print_code(struct offline_rewriter *r, const struct offline_line *line,
                       const char *code, struct offline_cuts *cuts, struct offline_text *words)
{
    const bool own = words_has_step(&line->context, STEP_MOTION);

    if (own ? strcmp(code, code_of(&line->move[0], &(struct offline_piece){0})) != 0
            : r->code != NULL && strcmp(code, r->code) != 0) {
        offline_cut_code(cuts, line, STEP_MOTION);
        offline_text_print(words, " %s", code);
    }
    r->code = code;
}

/*
 * One motion: a line, an arc, an involute, a thread. G33.1 has two, the way back being that of the
 * way in.
 */
static bool rewrite_motion(struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_piece *pieces, struct offline_text *text)
{
    const struct move *move = &line->move[0];
    const struct point before = r->written;
    struct offline_text words = {0};
    struct offline_cuts cuts;
    const unsigned n = offline_divide(r, move, pieces);

    if (n == 0)
        return false;
    offline_cuts_init(&cuts, line);
    offline_cut_letters(&cuts, line, letters_of(move));
    if (has_late_stop(line, n))
        offline_cut_stop(&cuts, line);
    if (line->context.modes.inverse_time && n > 1)
        offline_cut_letters(&cuts, line, LETTER_BIT('f'));
    print_code(r, line, code_of(move, &pieces[0]), &cuts, &words);
    print_piece(r, line, move, &pieces[0], &words);
    offline_print_kept(line, &cuts, words.bytes, text);
    offline_print_pieces(r, line, move, pieces, 1, n, text);
    if (has_late_stop(line, n))
        offline_print_stop(line, text);
    if (move->kind == MOVE_TAP)
        r->written = before;
    text->failed |= words.failed;
    offline_text_free(&words);
    return true;
}

/* Machine coordinates of G28 or G30 of this line; false: the program has changed them. */
static bool is_reference_known(const struct offline_rewriter *r, const struct offline_line *line,
                               const double **reference_mm)
{
    const struct program *p = &line->context;
    const unsigned first = (unsigned)p->words.code[STEP_REFERENCE]->argument;

    *reference_mm = r->reference_mm[first == PARAMETER_REFERENCE_1 ? 0 : 1];
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (takt_coordinates_from_parameter(takt_parameters_get(p->config.parameters, first + i),
                                            (enum axis)i) != (*reference_mm)[i])
            return false;
    }
    return true;
}

/* G28, G30: only the point on the way is corrected. The reference is the machine's own. */
static bool rewrite_reference(struct offline_rewriter *r, const struct offline_line *line,
                              struct offline_piece *pieces, struct offline_text *text)
{
    const bool all = (line->context.words.given & LETTERS_AXES) == 0;
    const double *reference_mm;
    struct offline_text words = {0};
    struct offline_cuts cuts;

    if (!is_reference_known(r, line, &reference_mm))
        return refuse(r, line,
                      "the point of G28 or G30 has been set by this program, where the machine "
                      "stands corrected: set it outside of the program");
    offline_cuts_init(&cuts, line);
    if (!all) {
        (void)offline_divide(r, &line->move[0], pieces);
        offline_cut_letters(&cuts, line, LETTERS_AXES);
        offline_print_words(r, line, &line->move[0], &pieces[0], &words);
        r->totals.pieces++;
    }
    offline_print_kept(line, &cuts, words.bytes != NULL ? words.bytes : "", text);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (all || words_has(&line->context, takt_coordinates_letter((enum axis)i)))
            r->written.at[i] = (r->axes & 1U << i) != 0 ? reference_mm[i] : 0.0;
    }
    text->failed |= words.failed;
    offline_text_free(&words);
    return true;
}

/* ---- settings that take over where the machine stands ---- */

/* L of G10. */
#define LEAST_BY_POSITION   10.0
#define SETTING_BY_POSITION 20.0
#define SETTING_WEAR        12.0
#define SETTING_SETUP       13.0

enum setting { SETTING_NONE, SETTING_WRITABLE, SETTING_PART, SETTING_WORN, SETTING_OTHER };

static enum setting setting_of(const struct program *p)
{
    if (words_has_step(p, STEP_AXIS_OFFSET) && p->words.code[STEP_AXIS_OFFSET]->number_x10 == 920)
        return SETTING_WRITABLE;
    if (words_has_step(p, STEP_REFERENCE) && p->words.code[STEP_REFERENCE]->words == 0)
        return SETTING_OTHER;
    if (!words_has_step(p, STEP_SETTING) || words_value(p, 'l') < LEAST_BY_POSITION)
        return SETTING_NONE;
    if (words_value(p, 'l') == SETTING_WEAR)
        return SETTING_WORN;
    if (words_value(p, 'l') == SETTING_SETUP)
        return SETTING_PART;
    if (words_value(p, 'l') == SETTING_BY_POSITION &&
        (words_value(p, 'p') == 0.0 || words_value(p, 'p') == p->modes.system))
        return SETTING_WRITABLE;
    return SETTING_OTHER;
}

/* Lines that are passed over leave the words of an earlier one in their place. */
static bool has_words_of_its_own(const struct program *p)
{
    const char first = p->lexer.text[0];

    return p->lexer.length > 0 && first != 'o' && first != '%' &&
           !(first == '/' && p->config.block_delete) && !flow_is_skipping(p);
}

bool offline_is_setting(const struct program *p)
{
    return has_words_of_its_own(p) && setting_of(p) != SETTING_NONE;
}

void offline_set_up(struct offline_rewriter *r, const struct move *move)
{
    takt_correction_tell_setup(&r->correction, move->channel, move->setup);
    if (move->setup_ends) {
        (void)takt_correction_take_setup(&r->correction);
        takt_correction_settle_setup(&r->correction);
    }
}

/* G10 L13: the corrected coordinates have it in them, and the machine is not told. */
static bool rewrite_part(struct offline_rewriter *r, const struct offline_line *line,
                         struct offline_text *text)
{
    if (line->moves > 0)
        return refuse(r, line, "a set-up of the part stands on a line of its own");
    offline_text_print(text, "(the set-up of the part is in the coordinates from here on)");
    return true;
}

/* G92, G10 L20: the same offset comes out when the words grow by what the machine stands off. */
static bool rewrite_setting(struct offline_rewriter *r, const struct offline_line *line,
                            struct offline_text *text)
{
    struct offline_text words = {0};
    struct offline_cuts cuts;

    if (setting_of(&line->context) != SETTING_WRITABLE || line->moves > 0)
        return refuse(
            r, line,
            "this line takes over where the machine stands, which is corrected: set "
            "tools, other coordinate systems and reference points outside of the program");
    offline_cuts_init(&cuts, line);
    offline_cut_letters(&cuts, line, LETTERS_AXES);
    offline_print_setting(r, line, &words);
    offline_print_kept(line, &cuts, words.bytes != NULL ? words.bytes : "", text);
    text->failed |= words.failed;
    offline_text_free(&words);
    return true;
}

/* ---- any line ---- */

static bool is_single(const struct offline_line *line)
{
    const enum move_kind kind = line->move[0].kind;

    if (line->moves == 2)
        return kind == MOVE_TAP && line->move[1].kind == MOVE_TAP_OUT;
    return line->moves == 1 && kind <= MOVE_THREAD;
}

static bool rewrite(struct offline_rewriter *r, const struct offline_line *line,
                    struct offline_piece *pieces, struct offline_text *text)
{
    if (line->moves > 0 && line->move[0].kind == MOVE_PROBE)
        return refuse(r, line,
                      "where a probing motion ends is not known before it is run: correct this "
                      "program while it runs");
    if (setting_of(&line->context) == SETTING_WORN)
        return refuse(
            r, line,
            "what a tool has worn is counted while it cuts: leave G10 L12 out, or correct "
            "this program while it runs");
    if (setting_of(&line->context) == SETTING_PART)
        return rewrite_part(r, line, text);
    if (setting_of(&line->context) != SETTING_NONE)
        return rewrite_setting(r, line, text);
    if (words_has_step(&line->context, STEP_REFERENCE))
        return rewrite_reference(r, line, pieces, text);
    if (offline_is_cycle(line))
        return offline_rewrite_cycle(r, line, pieces, text);
    if (line->moves > 0 && line->move[0].kind == MOVE_SPLINE)
        return refuse(r, line,
                      "a spline cannot be corrected in the program: correct it while it runs");
    if (is_single(line))
        return rewrite_motion(r, line, pieces, text);
    return refuse(r, line, "this motion cannot be corrected in the program, only while it runs");
}

bool offline_rewrite_line(struct offline_rewriter *r, const struct offline_line *line,
                          struct offline_text *text)
{
    struct offline_piece *pieces = malloc(OFFLINE_PIECES_MAX * sizeof *pieces);
    const bool good = pieces != NULL && rewrite(r, line, pieces, text);

    if (pieces == NULL)
        text->failed = true;
    for (unsigned i = 0; i < line->moves; i++) {
        if (move_is_motion(&line->move[i]))
            r->at = line->move[i].end;
        r->totals.compensated |= line->move[i].cutter_side != CUTTER_OFF;
    }
    free(pieces);
    return good;
}
