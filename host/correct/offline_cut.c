/* What is left of a line when words are cut out of it. */
#include "correct/offline_private.h"
#include "program/lexer.h"
#include "program/words.h"

#include <string.h>

void offline_cuts_init(struct offline_cuts *cuts, const struct offline_line *line)
{
    memset(cuts, 0, sizeof *cuts);
    cuts->first = line->raw_length;
}

/* Comments within a word stay. */
static void cut(struct offline_cuts *cuts, const struct offline_line *line,
                const struct program_span *span)
{
    const struct program_lexer *lexer = &line->context.lexer;
    const size_t from = takt_lexer_column(lexer, span->begin) - 1U;
    const size_t to = takt_lexer_column(lexer, span->end - 1U);
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
void offline_cut_letters(struct offline_cuts *cuts, const struct offline_line *line,
                         uint32_t letters)
{
    for (unsigned i = 0; i < 26; i++) {
        if ((line->context.words.given & letters & UINT32_C(1) << i) != 0)
            cut(cuts, line, &line->context.words.span[i]);
    }
}

void offline_cut_code(struct offline_cuts *cuts, const struct offline_line *line, enum step step)
{
    if (words_has_step(&line->context, step))
        cut(cuts, line, &line->context.words.code_span[step]);
}

/* Where new words go when none is taken out: before comments at the end. */
static size_t end_of_words(const struct offline_line *line)
{
    const struct program_lexer *lexer = &line->context.lexer;

    return lexer->length > 0 ? takt_lexer_column(lexer, lexer->length - 1U) : 0;
}

/* Spaces that stood between words do not stay behind them. */
static void trim(const struct offline_line *line, struct offline_text *text)
{
    const bool ended = line->raw_length > 0 && line->raw[line->raw_length - 1] != ' ';

    while (ended && text->length > 0 && text->bytes[text->length - 1] == ' ')
        text->bytes[--text->length] = '\0';
}

void offline_print_kept(const struct offline_line *line, const struct offline_cuts *cuts,
                        const char *words, struct offline_text *text)
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
            const bool spaced = text->length == 0 || text->bytes[text->length - 1] == ' ';

            words += spaced && words[0] == ' ' ? 1 : 0;
            offline_text_add(text, words, strlen(words));
        }
        if (i < line->raw_length && cuts->gone[i])
            from = i + 1;
    }
    trim(line, text);
}
