#include "program/words.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/changes.h"
#include "program/circular.h"
#include "program/contour.h"
#include "program/expression.h"
#include "program/lexer.h"
#include "program/names.h"
#include "program/predefined.h"
#include "program/report.h"
#include "program/system_parameters.h"

/* Letters that take a value now or, for U V W, are refused by name. */
#define LETTERS_KNOWN                                                                              \
    (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('d') | LETTER_BIT('e') | LETTER_BIT('f') |         \
     LETTER_BIT('h') | LETTER_BIT('l') | LETTER_BIT('p') | LETTER_BIT('q') | LETTER_BIT('r') |     \
     LETTER_BIT('s') | LETTER_BIT('t'))
#define LETTERS_NO_AXIS (LETTER_BIT('u') | LETTER_BIT('v') | LETTER_BIT('w'))

/* Largest difference of a code's number times ten from a whole number. */
#define CODE_WHOLE_MAX 1e-3

/* In a profile U and W are X and Z from where it has come to. */
static uint32_t letters_known(const struct program *p)
{
    return contour_is_open(p) ? LETTERS_KNOWN | LETTERS_NO_AXIS : LETTERS_KNOWN;
}

static struct program_span span_from(const struct program *p, unsigned begin)
{
    return (struct program_span){(uint16_t)begin, p->lexer.at};
}

static bool unknown_word(struct program *p, unsigned begin)
{
    struct program_lexer *l = &p->lexer;

    l->at = (uint16_t)(begin + 1);
    while ((l->text[l->at] >= '0' && l->text[l->at] <= '9') || l->text[l->at] == '.') {
        l->at++;
    }
    return takt_report_error(p, TAKT_ERROR_WORD_UNKNOWN, span_from(p, begin), 0.0);
}

static void add_step(struct program *p, const struct program_code *code, struct program_span span)
{
    p->words.steps |= UINT32_C(1) << code->step;
    p->words.code[code->step] = code;
    p->words.code_span[code->step] = span;
}

/* G80 beside another motion code says nothing. */
static bool is_superfluous(const struct program_words *w, const struct program_code *code)
{
    return code->group == GROUP_MOTION && code->words == 0 &&
           (w->steps & (UINT32_C(1) << STEP_MOTION)) != 0;
}

static bool contradicts(const struct program_words *w, const struct program_code *code)
{
    const bool taken = (w->groups & (UINT32_C(1) << code->group)) != 0;

    return taken && !(code->group == GROUP_MOTION && w->code[STEP_MOTION]->words == 0);
}

static bool add_code(struct program *p, const struct program_code *code, struct program_span span)
{
    struct program_words *w = &p->words;

    if (is_superfluous(w, code)) {
        return true;
    }
    if (contradicts(w, code)) {
        return takt_report_error(p, TAKT_ERROR_WORDS_CONFLICT, span, 0.0);
    }
    if (code->group != GROUP_NONE) {
        w->groups |= UINT32_C(1) << code->group;
    }
    add_step(p, code, span);
    return true;
}

/* G and M words. */
static bool read_code(struct program *p, char letter, unsigned begin)
{
    const struct program_code *code = NULL;
    double value;

    if (!takt_expression_read(p, &value)) {
        return false;
    }
    const double number_x10 = takt_maths_round(value * 10.0);

    if (maths_abs(value * 10.0 - number_x10) <= CODE_WHOLE_MAX && number_x10 >= 0.0 &&
        number_x10 < CODE_ANY) {
        code = takt_code_find(letter, (unsigned)number_x10);
    }
    if (code == NULL) {
        return takt_report_error(p, TAKT_ERROR_WORD_UNKNOWN, span_from(p, begin), 0.0);
    }
    return add_code(p, code, span_from(p, begin));
}

/* An axis word of an axis the machine does not have. */
static bool is_missing_axis(const struct program *p, char letter)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        if (AXIS_LETTERS[axis] - 'A' + 'a' == letter) {
            return (p->config.axes & (1U << axis)) == 0;
        }
    }
    return (LETTER_BIT(letter) & LETTERS_NO_AXIS) != 0;
}

/* Words with a value of their own. */
static bool read_value(struct program *p, char letter, unsigned begin)
{
    struct program_words *w = &p->words;
    const unsigned i = LETTER_INDEX(letter);

    if (!contour_is_open(p) && is_missing_axis(p, letter)) {
        return takt_report_error_at(p, TAKT_ERROR_AXIS_MISSING, begin, 0.0);
    }
    if ((LETTER_BIT(letter) & letters_known(p)) == 0) {
        return unknown_word(p, begin);
    }
    if (words_has(p, letter)) {
        return takt_report_error_at(p, TAKT_ERROR_WORD_REPEATED, begin, 0.0);
    }
    if (!takt_expression_read(p, &w->value[i])) {
        return false;
    }
    w->given |= LETTER_BIT(letter);
    w->span[i] = span_from(p, begin);
    const struct program_code *code = takt_code_find(letter, CODE_ANY);

    if (code != NULL) {
        add_step(p, code, w->span[i]);
    }
    return true;
}

static bool is_read_only(const struct program *p, const struct program_reference *reference)
{
    const char *name = p->lexer.text + reference->span.begin;
    double ignored;

    if (reference->number != 0) {
        return takt_system_parameter_is_read_only(reference->number);
    }
    return takt_predefined_get(p, name, (size_t)(reference->span.end - reference->span.begin),
                               &ignored);
}

static bool read_assignment(struct program *p, unsigned begin)
{
    struct program_words *w = &p->words;

    if (w->assignments == PROGRAM_ASSIGNMENTS_MAX) {
        return takt_report_error_at(p, TAKT_ERROR_ASSIGNMENTS_TOO_MANY, begin,
                                    PROGRAM_ASSIGNMENTS_MAX);
    }
    struct program_assignment *a = &w->assignment[w->assignments];

    if (!takt_expression_read_reference(p, &a->reference)) {
        return false;
    }
    if (is_read_only(p, &a->reference)) {
        return takt_report_error(p, TAKT_ERROR_PARAMETER_READ_ONLY, a->reference.span, 0.0);
    }
    if (!takt_lexer_accept(&p->lexer, '=')) {
        return takt_report_error(p, TAKT_ERROR_EQUALS_EXPECTED, span_from(p, begin), 0.0);
    }
    w->assignments++;
    return takt_expression_read(p, &a->value);
}

/* $0 is the only spindle there is, $-1 all of them. */
static bool read_spindle(struct program *p, unsigned begin)
{
    double number;

    if (!takt_expression_read(p, &number)) {
        return false;
    }
    if (number != 0.0 && number != -1.0) {
        return takt_report_error(p, TAKT_ERROR_WORD_OUT_OF_RANGE, span_from(p, begin), number);
    }
    return true;
}

static bool read_word(struct program *p)
{
    const unsigned begin = p->lexer.at++;
    const char letter = p->lexer.text[begin];

    if (letter == '#') {
        return read_assignment(p, begin);
    }
    if (letter == '$') {
        return read_spindle(p, begin);
    }
    if (letter < 'a' || letter > 'z') {
        return takt_report_error_at(p, TAKT_ERROR_CHARACTER_UNKNOWN, begin, 0.0);
    }
    if (letter == 'g' || letter == 'm') {
        return read_code(p, letter, begin);
    }
    return read_value(p, letter, begin);
}

/* N and its digits mean nothing. */
static bool skip_line_number(struct program *p)
{
    double ignored;

    return !takt_lexer_accept(&p->lexer, 'n') || takt_expression_read(p, &ignored);
}

/* The first of some letters, as they stand on the line; one of them is given. */
static char first_given(const struct program *p, uint32_t letters)
{
    static const char all[] = "abcdefghijklmnopqrstuvwxyz";
    unsigned first = PROGRAM_LINE_MAX + 1;
    char result = all[0];

    for (unsigned i = 0; i < sizeof(all) - 1; i++) {
        const unsigned begin = p->words.span[i].begin;

        if ((p->words.given & letters & (UINT32_C(1) << i)) != 0 && begin < first) {
            first = begin;
            result = all[i];
        }
    }
    return result;
}

/* Words of the line's codes in *used, those that more than one of them uses in *shared. */
static void gather_used(const struct program_words *w, uint32_t *used, uint32_t *shared)
{
    *used = 0;
    *shared = 0;
    for (unsigned step = 0; step < STEP_COUNT; step++) {
        if ((w->steps & (UINT32_C(1) << step)) != 0) {
            *shared |= *used & w->code[step]->words;
            *used |= w->code[step]->words;
        }
    }
}

/* Letters that ask for motion in the current mode when no code on the line uses them. */
static uint32_t motion_letters(const struct program *p)
{
    const struct program_code *motion = p->modes.motion;

    if (contour_is_open(p)) {
        return LETTERS_AXES | LETTERS_NO_AXIS;
    }
    if (motion != NULL && motion->run == takt_circular_move) {
        return LETTERS_AXES | LETTERS_CENTRE;
    }
    return LETTERS_AXES;
}

/* A line with axis words but no code for them goes on with the motion before it. */
static bool add_implied_motion(struct program *p, uint32_t used)
{
    const uint32_t asking = p->words.given & motion_letters(p);

    if (asking == 0 || (used & LETTERS_AXES) != 0 || words_has_step(p, STEP_MOTION)) {
        return true;
    }
    const char letter = first_given(p, asking);

    if (p->modes.motion == NULL) {
        return takt_report_error_letter(p, TAKT_ERROR_MOTION_MODE_MISSING, letter, 0.0);
    }
    add_step(p, p->modes.motion, p->words.span[LETTER_INDEX(letter)]);
    return true;
}

static bool check_use(struct program *p)
{
    uint32_t used;
    uint32_t shared;

    gather_used(&p->words, &used, &shared);
    if (!add_implied_motion(p, used)) {
        return false;
    }
    if (contour_is_open(p)) {
        return true;
    }
    gather_used(&p->words, &used, &shared);
    if ((p->words.given & shared) != 0) {
        const char letter = first_given(p, shared);

        return takt_report_error_letter(p, TAKT_ERROR_WORD_SHARED, letter, 0.0);
    }
    if ((p->words.given & ~used) != 0) {
        const char letter = first_given(p, ~used);

        return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, letter, 0.0);
    }
    return true;
}

static void clear(struct program *p)
{
    p->words.given = 0;
    p->words.steps = 0;
    p->words.groups = 0;
    p->words.assignments = 0;
    p->words.names_before = p->names.count;
}

bool takt_words_read(struct program *p)
{
    clear(p);
    if (!skip_line_number(p)) {
        return false;
    }
    while (p->lexer.at < p->lexer.length) {
        if (!read_word(p)) {
            return false;
        }
    }
    return check_use(p);
}

static bool swap_named(struct program *p, struct program_assignment *a)
{
    const char *name = p->lexer.text + a->reference.span.begin;
    const size_t length = (size_t)(a->reference.span.end - a->reference.span.begin);
    const int known = takt_names_find(&p->names, name, length);
    double *place = known >= 0 ? &p->names.value[known] : takt_names_add(p, name, length);

    if (place == NULL) {
        return false;
    }
    const double old = *place;

    *place = a->value;
    a->value = old;
    return true;
}

static bool swap_numbered(struct program *p, struct program_assignment *a)
{
    const double old = takt_parameters_get(p->config.parameters, a->reference.number);

    if (!takt_parameters_set(p->config.parameters, a->reference.number, a->value)) {
        return false;
    }
    a->value = old;
    return true;
}

static bool swap(struct program *p, struct program_assignment *a)
{
    return a->reference.number == 0 ? swap_named(p, a) : swap_numbered(p, a);
}

bool takt_words_assign(struct program *p)
{
    struct program_words *w = &p->words;

    for (unsigned i = 0; i < w->assignments; i++) {
        if (!swap(p, &w->assignment[i])) {
            const struct program_span span = w->assignment[i].reference.span;

            w->assignments = i;
            takt_words_take_back(p);
            return takt_report_error(p, TAKT_ERROR_PARAMETERS_FULL, span, 0.0);
        }
    }
    return true;
}

bool takt_words_store(struct program *p, enum step step, unsigned number, double value)
{
    struct program_words *w = &p->words;

    TAKT_ASSERT(w->assignments < PROGRAM_ASSIGNMENTS_MAX + PROGRAM_STORES_MAX);
    struct program_assignment *a = &w->assignment[w->assignments];

    a->reference.number = (uint16_t)number;
    a->value = value;
    if (!swap_numbered(p, a)) {
        return takt_report_error_code(p, TAKT_ERROR_PARAMETERS_FULL, step, 0.0);
    }
    w->assignments++;
    return true;
}

void takt_words_take_back(struct program *p)
{
    for (unsigned i = p->words.assignments; i > 0; i--) {
        (void)swap(p, &p->words.assignment[i - 1]);
    }
    p->words.assignments = 0;
    p->names.count = p->words.names_before;
}

/* What has been swapped is what was there before. */
void takt_words_note_changes(struct program *p)
{
    for (unsigned i = 0; i < p->words.assignments; i++) {
        const struct program_assignment *a = &p->words.assignment[i];

        if (a->reference.number != 0) {
            takt_changes_note(p, a->reference.number, a->value);
        }
    }
}

bool takt_words_whole(struct program *p, char letter, double low, double high, uint32_t *whole)
{
    const double value = words_value(p, letter);
    double nearest;

    if (!takt_expression_whole(value, &nearest)) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_WHOLE, letter, value);
    }
    if (nearest < low || nearest > high) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_OUT_OF_RANGE, letter, value);
    }
    *whole = (uint32_t)nearest;
    return true;
}
