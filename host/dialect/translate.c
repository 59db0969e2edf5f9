#include "dialect/translate.h"

#include "lathe/lathe.h"
#include "siemens/siemens.h"
#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * A dwell written without a point is in milliseconds from here on: nobody waits for less than that,
 * or for minutes.
 */
#define DWELL_MS_MIN 100.0

/* ---- whole lines ---- */

static void clear_line(struct translator *t)
{
    (void)line_read(&t->line, "", 0);
}

/* Orders of senders, and remarks as other languages have them. */
static bool is_no_line(const struct line *l)
{
    const char *text = l->text;

    return line_is_order(l) || (text[0] != '\0' && strchr("$?!~", text[0]) != NULL) ||
           strncmp(text, "//", 2) == 0 ||
           (text[0] == '#' &&
            (text[1] == ' ' ||
             (line_name_length(l, 1) > 0 && !line_is_assigned(l, 1 + line_name_length(l, 1)))));
}

/* A comment that is not closed ends with its line. */
static void close_comment(struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];

        if (w->kind == WORD_COMMENT && w->letter == '(' && l->text[w->end - 1] != ')')
            l->text[w->begin] = ';';
    }
}

/* N10 G1 X1*57 */
static void drop_checksum(struct line *l)
{
    const char *star = line_checksum(l);

    if (star == NULL)
        return;
    l->length = (size_t)(star - l->text);
    l->text[l->length] = '\0';
    (void)line_read(l, l->text, l->length);
}

static void translate_start(struct translator *t)
{
    struct line *l = &t->line;

    const char *message;
    size_t length;

    if (is_no_line(l) || line_is_directive(l))
        clear_line(t);
    message = line_message(l, &length);
    if (message != NULL) {
        translate_message(t, message, length);
        clear_line(t);
    }
    drop_checksum(l);
    close_comment(l);
    if (l->words == 0)
        return;
    if (l->text[0] == '%' && l->words > 1)
        (void)line_read(l, "%", 1);
    if (l->text[0] == ':')
        l->text[0] = 'O';
    (void)line_read(l, l->text, l->length);
    struct line_word *first = &l->word[0];

    if (first->letter == 'o' && first->kind == WORD_BARE) {
        for (size_t i = 0; i < l->length && l->text[i] != '(' && l->text[i] != ';'; i++)
            l->text[i] = ' ';
        (void)line_read(l, l->text, l->length);
    }
    if (l->text[0] == '/' && l->text[1] >= '1' && l->text[1] <= '9' &&
        translate_is(t, TRANSLATE_MACROS)) {
        l->text[1] = ' ';
        (void)line_read(l, l->text, l->length);
    }
}

/* ---- numbers ---- */

/* 1.5e-17 is written out. */
static void write_out(struct line *l, struct line_word *w)
{
    char *end;
    char text[64];
    const double value = strtod(&l->text[w->value_begin], &end);
    const int length = snprintf(text, sizeof text, "%c%.9f", l->text[w->begin], value);

    w->end = (uint16_t)(end - l->text);
    if (length > 0 && length < (int)sizeof text)
        (void)line_replace(l, w, text);
}

static void translate_numbers(struct translator *t)
{
    struct line *l = &t->line;

    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];
        const char *behind = &l->text[w->end];

        if (w->kind == WORD_VALUE && w->is_number && line_lower(behind[0]) == 'e' &&
            (behind[1] == '-' || behind[1] == '+') && behind[2] >= '0' && behind[2] <= '9')
            write_out(l, &l->word[i]);
    }
}

static bool is_assignment(const struct line_word *w)
{
    return w->kind == WORD_ASSIGNED && w->value_begin > 0;
}

/* #1 = #2 + 3, up to the next one or a comment, in brackets. False: there is none from there on. */
static bool bracket_next(struct line *l, unsigned from)
{
    char text[LINE_MAX_BYTES + 8];
    unsigned next;

    while (from < l->words && !line_is_calculation(l, &l->word[from]))
        from++;
    if (from >= l->words)
        return false;
    for (next = from + 1;
         next < l->words && l->word[next].kind != WORD_COMMENT && !is_assignment(&l->word[next]);)
        next++;
    const size_t begin = l->word[from].value_begin;
    const size_t end = next < l->words ? l->word[next].begin : l->length;
    const int length = snprintf(text, sizeof text, "%.*s[%.*s]%s", (int)begin, l->text,
                                (int)(end - begin), &l->text[begin], &l->text[end]);

    return line_read(l, text, (size_t)length);
}

/* AND, OR and XOR of Fanuc work on bits, here on what is true: the same of conditions alone. */
static void refuse_bits(struct translator *t, const struct line_word *w)
{
    static const char *const comparisons[] = {"eq", "ne", "gt", "ge", "lt", "le"};
    const char *text = &t->line.text[w->value_begin];
    const char *combines = NULL;

    for (const char *c = text; c < &t->line.text[w->end]; c++) {
        c += *c == '<' ? strcspn(c, ">") : 0; /* #<force> has none */
        if (line_begins(c, "and") || line_begins(c, "or"))
            combines = c;
        for (size_t i = 0; i < sizeof comparisons / sizeof comparisons[0]; i++) {
            if (line_begins(c, comparisons[i]))
                return;
        }
    }
    if (combines != NULL)
        translate_wrong(
            t, w, "'%.*s': AND, OR and XOR of bits are not supported, of conditions are",
            (int)(w->end - w->begin) < 60 ? (int)(w->end - w->begin) : 60, &t->line.text[w->begin]);
}

static void translate_assignments(struct translator *t)
{
    struct line *l = &t->line;

    for (unsigned i = 0; i < TRANSLATE_LINES_MAX && bracket_next(l, 0); i++)
        ;
    for (unsigned i = 0; i < l->words; i++) {
        if (is_assignment(&l->word[i]))
            refuse_bits(t, &l->word[i]);
    }
}

/* M6 of a program that never says which tool: somebody changes it. */
static void translate_change(struct translator *t)
{
    struct line_word *change = line_find_code(&t->line, 'm', 60);

    t->has_tool = t->has_tool || line_find(&t->line, 't', 0) != NULL;
    if (change != NULL && !t->has_tool)
        (void)line_replace(&t->line, change, "M0");
}

/* ---- words that mean nothing ---- */

/* Of several words of a letter the last counts. */
static void leave_last(struct line *l, char letter)
{
    struct line_word *w = line_find(l, letter, 0);

    while (w != NULL && line_find(l, letter, (unsigned)(w - l->word) + 1) != NULL) {
        line_blank(l, w);
        w = line_find(l, letter, 0);
    }
}

/* A cycle that does not wait has no use for P, nor has M6; of two S and F the last counts. */
static void translate_unused(struct translator *t)
{
    static const uint16_t cycles[] = {730, 810, 830, 850};
    struct line *l = &t->line;
    struct line_word *p = line_find(l, 'p', 0);

    for (size_t i = 0; i < sizeof cycles / sizeof cycles[0] && p != NULL; i++) {
        if (line_find_code(l, 'g', cycles[i]) != NULL && p->kind == WORD_VALUE) {
            translate_note(t, p, "dwell of a cycle");
            line_blank(l, p);
        }
    }
    if (p != NULL && p->kind == WORD_VALUE && line_find_code(l, 'm', 60) != NULL &&
        line_find_code(l, 'g', 40) == NULL)
        line_blank(l, p);
    for (unsigned i = 1;
         i < l->words && (l->word[0].letter == 'n' || translate_is(t, TRANSLATE_MACROS)); i++) {
        if (l->word[i].kind == WORD_VALUE && l->word[i].letter == 'n')
            line_blank(l, &l->word[i]);
    }
    leave_last(l, 's');
    leave_last(l, 'f');
}

static void translate_arc(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *w = line_find(l, t->across, 0);
    unsigned centres = 0;

    for (const char *c = "ijk"; *c != '\0'; c++)
        centres += line_find(l, *c, 0) != NULL ? 1U : 0U;
    if (w != NULL && w->is_number && w->value == 0.0 && centres > 1)
        line_blank(l, w);
}

/* ---- words ---- */

static void set_value(struct line *l, struct line_word *w, char letter, double value)
{
    char text[64];

    (void)snprintf(text, sizeof text, "%c%.6f", letter, value);
    (void)line_replace(l, w, text);
}

/* P of a dwell in seconds, from milliseconds; X, U and S are other names of it. */
static void translate_dwell(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *p = line_find(l, 'p', 0);
    const bool dwells = line_find_code(l, 'g', 40) != NULL;

    if (!dwells && series_find_cycle(l) == NULL)
        return;
    for (unsigned i = 0; i < l->words && dwells && p == NULL; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind == WORD_VALUE && w->is_number &&
            strchr(translate_is(t, TRANSLATE_MARLIN) ? "s" : "xu", w->letter) != NULL) {
            set_value(l, w, 'P', w->value);
            return;
        }
    }
    if (p == NULL && dwells &&
        translate_is(t, TRANSLATE_MARLIN)) { /* until all has moved, as everything here does */
        line_blank(l, line_find_code(l, 'g', 40));
        return;
    }
    if (p != NULL && p->is_number && !p->has_point &&
        (p->value >= DWELL_MS_MIN || (translate_is(t, TRANSLATE_MARLIN) && dwells)))
        set_value(l, p, 'P', 1e-3 * p->value);
}

/* ---- a line ---- */

static void note_python(struct translator *t)
{
    for (unsigned i = 0; i < t->line.words; i++) {
        struct line_word w = t->line.word[i];

        if (line_runs_python(&t->line, &w)) {
            w.end = (uint16_t)(strchr(&t->line.text[w.begin], ',') - t->line.text);
            translate_note(t, &w, "Python");
        }
    }
}

/* What programs of Fanuc and Haas assign, turn, call and jump to. */
static void translate_macros(struct translator *t)
{
    translate_assignments(t);
    variables_set(t);
    offsets_translate(t);
    if (t->survey.lathe) {
        turning_translate(t);
        passes_translate(t);
        lathe_translate_increments(t);
    }
    pocket_translate(t);
    if (t->survey.lathe)
        threads_translate(t);
    calls_translate(t);
    flow_translate(t);
    series_translate_fine_boring(t);
}

static void translate_foreign(struct translator *t)
{
    if (translate_is(t, TRANSLATE_SIEMENS))
        siemens_translate(t);
    translate_start(t);
    if (translate_is(t, TRANSLATE_MARLIN))
        printer_leave_macro(t); /* E is the extruder, in X10E-3 too */
    else
        translate_numbers(t);
    if (translate_is(t, TRANSLATE_MACROS))
        variables_translate(t);
    names_begin(t);
    names_translate(t);
    if (translate_is(t, TRANSLATE_MACROS))
        translate_macros(t);
    registers_translate_unit(t);
    codes_translate(t);
    translate_unused(t);
    translate_change(t);
    if (translate_is(t, TRANSLATE_MARLIN))
        printer_translate(t);
    if (translate_is(t, TRANSLATE_MACROS | TRANSLATE_MARLIN))
        translate_dwell(t);
    if (translate_is(t, TRANSLATE_MACROS)) {
        upright_translate(t);
        holes_translate(t);
        if (t->survey.lathe && t->dialect == DIALECT_FANUC)
            arcs_translate(t);
        registers_translate(t);
        lathe_translate(t);
    }
    registers_translate_speed(t);
    motion_follow_modes(t);
    motion_translate_reference(t);
    translate_arc(t);
    motion_translate_machine(t);
    motion_translate(t);
}

static bool has_slash(const struct line *l)
{
    return l->words > 0 && l->word[0].letter == '/';
}

/* All lines that one has become, the first without DIALECT_GOES_ON. */
static void put_out(struct translator *t, unsigned jumps)
{
    struct dialect_text *out = &t->result->text;
    const bool blank = line_is_blank(&t->line);
    struct dialect_text all = {.slash = t->before.slash && !blank && !has_slash(&t->line)};

    output_add(&all, t->before.bytes, t->before.length);
    if (!blank || t->before.length + t->behind.length == 0)
        translate_add(&all, "%s", t->line.text);
    for (unsigned i = jumps; i < t->jumps; i++)
        t->jump[i].patch += out->length + all.length - 1;
    output_add(&all, t->behind.bytes, t->behind.length);
    output_add(out, all.bytes + 1, all.length - 1);
    out->failed = out->failed || all.failed || t->before.failed || t->behind.failed;
    dialect_text_free(&all);
    t->before.length = t->behind.length = 0;
}

static void translate_line(void *translator, const char *bytes, size_t length)
{
    struct translator *t = translator;
    const unsigned jumps = t->jumps;

    const char *end = memchr(bytes, DIALECT_TEXT_END, length);

    t->number++;
    length = end != NULL ? (size_t)(end - bytes) : length;
    if (length > 0 && bytes[length - 1] == '\r')
        length--;
    if (!line_read(&t->line, bytes, length)) {
        output_add(&t->result->text, bytes, length);
        output_add(&t->result->text, "\n", 1);
        return;
    }
    jumps_note_label(t, t->result->text.length);
    t->before.slash = t->behind.slash = has_slash(&t->line);
    globals_begin(t);
    values_translate(t);
    polar_translate(t);
    if (translate_is(t, TRANSLATE_NOT_FOREIGN)) {
        motion_follow_modes(t);
        codes_translate(t);
        note_python(t);
    } else {
        translate_foreign(t);
    }
    t->begun = t->begun || (t->line.words > 0 && strchr("%o", t->line.word[0].letter) == NULL);
    put_out(t, jumps);
}

/* Calls take for each line of a text; a byte order mark is no part of the first. */
static void each_line(const char *bytes, size_t length,
                      void (*take)(void *context, const char *, size_t), void *context)
{
    const char *end = bytes + length;

    if (length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0)
        bytes += 3;
    while (bytes < end) {
        const char *next = memchr(bytes, '\n', (size_t)(end - bytes));

        take(context, bytes, (size_t)((next != NULL ? next : end) - bytes));
        bytes = next != NULL ? next + 1 : end;
    }
}

static void survey_line(void *translator, const char *bytes, size_t length)
{
    struct translator *t = translator;
    struct line *l = &t->line;

    if (!line_read(l, bytes, length))
        return;
    siemens_survey(&t->survey, l);
    if (!translate_is(t, TRANSLATE_MACROS))
        return;
    calls_survey(&t->survey, l);
    flow_survey(&t->survey, l);
    names_survey(&t->survey, l);
    passes_survey(&t->survey, l);
    series_survey(&t->survey, l);
    t->survey.rotary = t->survey.rotary || upright_turns(l);
    t->survey.whole = t->survey.whole || turning_is_whole(l);
    registers_survey(&t->survey, l);
}

struct guess {
    struct dialect_detector detector;
    const struct dialect_codes *codes;
};

static void guess_line(void *guess, const char *bytes, size_t length)
{
    struct guess *g = guess;

    dialect_guess_line(&g->detector, bytes, length, g->codes);
}

/* The program does not say so, but centres of its arcs are absolute. */
static bool is_absolute(const struct translator *t)
{
    struct guess guess = {.codes = t->codes};

    if (translate_is(t, TRANSLATE_NOT_FOREIGN))
        return false;
    each_line(t->source, t->source_length, guess_line, &guess);
    return dialect_guess_end(&guess.detector).absolute;
}

bool dialect_translate(enum dialect dialect, const struct dialect_codes *codes, const char *called,
                       const char *bytes, size_t length, struct dialect_result *result)
{
    struct translator *t = calloc(1, sizeof *t);

    *result = (struct dialect_result){0};
    if (t == NULL)
        return false;
    t->dialect = dialect;
    t->codes = codes;
    t->called = called;
    t->result = result;
    t->source = bytes;
    t->source_length = length;
    t->absolute = is_absolute(t);
    each_line(bytes, length, survey_line, t);
    registers_survey_end(&t->survey);
    t->across = t->survey.lathe ? 'j' : 'k';
    each_line(bytes, length, translate_line, t);
    if (translate_is(t, TRANSLATE_SIEMENS))
        siemens_finish(t);
    if (translate_is(t, TRANSLATE_MACROS))
        flow_end_program(t);
    jumps_finish(t);
    dialect_text_free(&t->before);
    dialect_text_free(&t->behind);
    free(t->label);
    free(t);
    return !result->text.failed;
}
