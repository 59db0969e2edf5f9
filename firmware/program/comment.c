#include "program/comment.h"

#include "program/lexer.h"

char takt_comment_lower(char c)
{
    if (c >= 'A' && c <= 'Z') {
        return (char)(c - 'A' + 'a');
    }
    return c;
}

unsigned takt_comment_match(const struct program_lexer *l, const char *word)
{
    unsigned at = 0;

    while (takt_lexer_comment(l, at) == ' ') {
        at++;
    }
    while (*word != '\0' && takt_comment_lower(takt_lexer_comment(l, at)) == *word) {
        word++;
        at++;
    }
    return *word == '\0' ? at : 0;
}

static bool end_program(struct program *p, unsigned from)
{
    char text[DIAGNOSTIC_WORD_MAX];
    size_t length = 0;

    while (length < sizeof(text) && from < p->lexer.comment_length) {
        text[length++] = takt_lexer_comment(&p->lexer, from++);
    }
    takt_diagnostic_set(&p->error, TAKT_ERROR_ABORTED, p->lexer.line, 0, text, length, 0.0);
    p->phase = PROGRAM_ENDED;
    return false;
}

bool takt_comment_run(struct program *p)
{
    const unsigned abort = takt_comment_match(&p->lexer, "abort,");

    if (p->config.say != NULL) {
        p->config.say(p->config.listener, p);
    }
    return abort == 0 || end_program(p, abort);
}
