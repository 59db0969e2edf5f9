#include "program/lexer.h"

#include "base/assert.h"

/* What has been seen of a line while it is read. */
struct scan {
    uint32_t column;         /* of the last character, from 1 */
    uint32_t open;           /* parentheses of the comment being read that are not closed */
    bool rest;               /* the rest of the line is a comment */
    uint32_t comment_column; /* where the comment began */
    bool failed;
};

void takt_lexer_open(struct program_lexer *l, const struct source *source)
{
    l->source = *source;
    l->input_at = 0;
    l->input_length = 0;
    l->input_offset = 0;
    l->line = 0;
    l->at = 0;
    l->length = 0;
    l->comment_length = 0;
    l->nesting = 0;
    l->text[0] = '\0';
}

/* More input when all has been read. Returns its length, or what the source says instead. */
static long fill(struct program_lexer *l)
{
    TAKT_ASSERT(l->input_at <= l->input_length);
    long count;

    if (l->input_at < l->input_length) {
        return (long)(l->input_length - l->input_at);
    }
    count = l->source.read(l->source.context, l->input, sizeof(l->input));
    l->input_offset += l->input_length;
    l->input_at = 0;
    l->input_length = count > 0 ? (size_t)count : 0;
    return count;
}

bool takt_lexer_can_go_on(struct program_lexer *l)
{
    return fill(l) != SOURCE_LATER;
}

/* The next byte, or what the source says instead. */
static int next_byte(struct program_lexer *l)
{
    const long count = fill(l);

    if (count <= 0) {
        return count == SOURCE_END ? SOURCE_END : SOURCE_ERROR;
    }
    return (unsigned char)l->input[l->input_at++];
}

/* Only the first fault of a line is told. */
static void fail(const struct program_lexer *l, struct scan *s, struct diagnostic *error,
                 enum takt_error code, uint32_t column, char c)
{
    if (!s->failed) {
        takt_diagnostic_set(error, code, l->line, column, &c, 1, PROGRAM_LINE_MAX);
        s->failed = true;
    }
}

/* What cannot be shown is told by its code: 0x1b. */
static void fail_unprintable(const struct program_lexer *l, struct scan *s,
                             struct diagnostic *error, unsigned char c)
{
    static const char digits[] = "0123456789abcdef";
    const char word[] = {'0', 'x', digits[c >> 4], digits[c & 15U]};

    if (!s->failed) {
        takt_diagnostic_set(error, TAKT_ERROR_CHARACTER_UNKNOWN, l->line, s->column, word,
                            sizeof(word), 0.0);
        s->failed = true;
    }
}

static void append(struct program_lexer *l, char c, uint32_t column)
{
    TAKT_ASSERT(l->length < PROGRAM_LINE_MAX);
    if (c >= 'A' && c <= 'Z') {
        c = (char)(c - 'A' + 'a');
    }
    l->dropped[l->length] = (uint8_t)(column - l->length - 1U);
    l->text[l->length++] = c;
}

static void begin_comment(struct program_lexer *l, struct scan *s, char c)
{
    s->open = c == '(' ? 1 : 0;
    s->rest = c == ';';
    s->comment_column = s->column;
    l->comment_length = 0;
}

/*
 * What a comment says may be an order. It is kept behind the text, backwards from the end of its
 * room: with the character that begins it they are never longer than the line.
 *
 *     text ... 0            ... tnemmoc
 */
static void scan_comment(struct program_lexer *l, struct scan *s, char c)
{
    if (!s->rest) {
        s->open += c == '(' ? 1U : 0U;
        s->open -= c == ')' ? 1U : 0U;
    }
    if ((s->open > 0 || s->rest) && s->column <= PROGRAM_LINE_MAX) {
        l->text[PROGRAM_LINE_MAX - l->comment_length++] = c;
    }
}

char takt_lexer_comment(const struct program_lexer *l, unsigned at)
{
    return (char)(at < l->comment_length ? l->text[PROGRAM_LINE_MAX - at] : '\0');
}

static void scan_character(struct program_lexer *l, struct scan *s, struct diagnostic *error,
                           char c)
{
    if (c == '(' || c == ';') {
        begin_comment(l, s, c);
    } else if (c > ' ' && c <= '~' && s->column > PROGRAM_LINE_MAX) {
        fail(l, s, error, TAKT_ERROR_LINE_TOO_LONG, s->column, c);
    } else if (c > ' ' && c <= '~') {
        append(l, c, s->column);
    } else if (c != ' ' && c != '\t') {
        fail_unprintable(l, s, error, (unsigned char)c);
    }
}

static void scan_byte(struct program_lexer *l, struct scan *s, struct diagnostic *error, char c)
{
    if (c == '\r') {
        return;
    }
    s->column++;
    if (s->open > 0 || s->rest) {
        scan_comment(l, s, c);
    } else {
        scan_character(l, s, error, c);
    }
}

static void close_line(struct program_lexer *l, struct scan *s, struct diagnostic *error)
{
    TAKT_ASSERT(l->length <= PROGRAM_LINE_MAX);
    if (s->open > 0) {
        fail(l, s, error, TAKT_ERROR_COMMENT_UNCLOSED, s->comment_column, '(');
    }
    l->text[l->length] = '\0';
    l->end_column = s->failed || s->column >= UINT16_MAX ? 0 : (uint16_t)(s->column + 1);
}

enum lexer_result takt_lexer_next_line(struct program_lexer *l, struct diagnostic *error)
{
    struct scan s = {0};

    l->line_offset = l->input_offset + l->input_at;
    int c = next_byte(l);

    if (c == SOURCE_END) {
        return LEXER_END;
    }
    if (c == LEXER_GOES_ON && l->line > 0) {
        l->line_offset++; /* who comes back to it reads a line, with its number */
        c = next_byte(l);
    } else {
        l->line++;
    }
    l->at = 0;
    l->length = 0;
    l->comment_length = 0;
    l->nesting = 0;
    while (c >= 0 && c != '\n') {
        scan_byte(l, &s, error, (char)c);
        c = next_byte(l);
    }
    if (c == SOURCE_ERROR) {
        takt_diagnostic_set(error, TAKT_ERROR_SOURCE_UNREADABLE, l->line, 0, "", 0, 0.0);
        return LEXER_UNREADABLE;
    }
    close_line(l, &s, error);
    return s.failed ? LEXER_ERROR : LEXER_LINE;
}

uint16_t takt_lexer_column(const struct program_lexer *l, unsigned at)
{
    TAKT_ASSERT(l->length <= PROGRAM_LINE_MAX);
    return at < l->length ? (uint16_t)(at + l->dropped[at] + 1U) : l->end_column;
}

struct program_place takt_lexer_place(const struct program_lexer *l)
{
    return (struct program_place){l->input_offset + l->input_at, l->line};
}

struct program_place takt_lexer_this_line(const struct program_lexer *l)
{
    return (struct program_place){l->line_offset, l->line - 1};
}

bool takt_lexer_can_seek(const struct program_lexer *l)
{
    return l->source.seek != NULL;
}

/* Short jumps stay inside what has been read already. */
bool takt_lexer_seek(struct program_lexer *l, const struct program_place *place)
{
    const uint64_t offset = place->offset;

    if (!takt_lexer_can_seek(l)) {
        return false;
    }
    if (offset >= l->input_offset && offset <= l->input_offset + l->input_length) {
        l->input_at = (size_t)(offset - l->input_offset);
    } else {
        if (!l->source.seek(l->source.context, offset)) {
            return false;
        }
        l->input_offset = offset;
        l->input_at = 0;
        l->input_length = 0;
    }
    l->line = place->line;
    return true;
}

bool takt_lexer_accept(struct program_lexer *l, char c)
{
    if (l->text[l->at] != c) {
        return false;
    }
    l->at++;
    return true;
}
