/*
 * The language of Siemens' controllers, before the table of differences, its words; values are in
 * values.c, flow in flow.c, subprograms in programs.c, orders in orders.c, cycles in cycles.c: what
 * it says in words and brackets.
 *
 *     X=R1+2*(R2-1) CR=5 TURN=2       X[#101+2*[#102-1]] R5 P3
 *     R1=5 R2=R1*2                    #101=5, #102=[#101*2]
 *     IF R1>5 ... ELSE ... ENDIF      o98000010 if [#101 GT 5] ... o98000010 else ... o98000010 endif
 *     IF R1>5 GOTOF END ... END:      the same about a jump
 *     L100 P2; _N_L100_SPF ... M17    o<l100> call, twice; o<l100> sub ... o<l100> endsub
 *     MCALL CYCLE81(50,0,2,-10)       X1 Y1 is then G81 X1 Y1 Z-10 R2
 *     TRANS X10; SUPA; MSG("text")    G52 X10; G53; (msg,text)
 *
 * A parameter R5 is #105.
 */
#include "siemens/scan.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((format(printf, 2, 3))) void scan_put(struct scan *s, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    const int length = vsnprintf(s->out + s->length, sizeof s->out - s->length, format, arguments);

    va_end(arguments);
    s->failed = s->failed || length < 0 || s->length + (size_t)length >= sizeof s->out;
    s->length += s->failed ? 0 : (size_t)length;
}

void scan_skip(struct scan *s)
{
    while (*s->at == ' ' || *s->at == '\t')
        s->at++;
}

static bool is_letter(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

bool scan_name(struct scan *s, char name[NAME_MAX_])
{
    size_t length = 0;

    scan_skip(s);
    if (!is_letter(*s->at))
        return false;
    while (is_letter(s->at[length]) || scan_is_digit(s->at[length]))
        length++;
    for (size_t i = 0; i < length && i < NAME_MAX_; i++)
        name[i < NAME_MAX_ - 1 ? i : NAME_MAX_ - 1] = (char)toupper((unsigned char)s->at[i]);
    name[length < NAME_MAX_ ? length : NAME_MAX_ - 1] = '\0';
    s->at += length;
    return true;
}

bool scan_take(struct scan *s, const char *text)
{
    scan_skip(s);
    if (strncmp(s->at, text, strlen(text)) != 0)
        return false;
    s->at += strlen(text);
    return true;
}

/* ---- words ---- */

/* X=IC(5) is 5 further, X=AC(5) at 5, in any mode; centres with AC are no distances. */
static void axis_value(struct scan *s, char letter, const char *way)
{
    static const char axes[] = "XYZABC";
    static const char centres[] = "IJK";
    const char low = (char)tolower((unsigned char)letter);
    const char *centre = strchr(centres, letter);
    const bool relative = strcmp(way, "IC") == 0;

    scan_put(s, "%c[", letter);
    if (centre != NULL && !relative)
        scan_put(s, "0-#<_%c>+", "xyz"[centre - centres]);
    else if (centre == NULL && strchr(axes, letter) == NULL)
        s->failed = true;
    else if (relative != s->t->incremental && centre == NULL)
        scan_put(s, "%s%s#<_%c>+", relative ? "" : "0-",
                 letter == 'X' && s->t->diameter ? "2*" : "", low);
    scan_bracketed(s);
    scan_put(s, "]");
}

static const char *letter_of(const char *name)
{
    static const char *const names[][2] = {{"CR", "R"},       {"LIMS", "D"},   {"ADIS", "P"},
                                           {"SPOS", "M19 R"}, {"TURN", "P1+"}, {"S1", "S"},
                                           {"M1", "M"}};

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(name, names[i][0]) == 0)
            return names[i][1];
    }
    return name[1] == '\0' ? name : NULL;
}

/*
 * R1=5 R2=R1 come one after the other: a line of its own for each, behind words that stand before
 * it.
 */
void scan_assign(struct scan *s, const char *name)
{
    struct translator *t = s->t;
    const size_t before = s->length;
    const bool first = strspn(s->out, " /") >= before;
    const char kind = scan_kind(s, name);

    if (kind == 'v')
        translate_wrong(t, NULL,
                        "'%s' is VAR: a value that the subprogram gives it does not come back, "
                        "which is not supported: use an R parameter",
                        name);
    scan_operand(s, name);
    scan_put(s, "=");
    scan_given(s, kind);
    if (!s->failed)
        translate_add(first ? &t->before : &t->behind, "%s", s->out + before);
    s->length = before;
    s->out[before] = '\0';
}

/* T="DRILL 8": which number this tool has is said by the machine file, as TOOL_DRILL_8. */
static void named_tool(struct scan *s)
{
    const struct dialect_codes *codes = s->t->codes;
    const char *end = strchr(++s->at, '"');
    char name[64];

    s->failed = s->failed || end == NULL || end == s->at || end - s->at > 50;
    if (s->failed)
        return;
    (void)snprintf(name, sizeof name, "TOOL_%.*s", (int)(end - s->at), s->at);
    const bool number = strspn(name + 5, "0123456789") == strlen(name + 5);

    for (char *c = name; *c != '\0'; c++)
        *c = (char)(isalnum((unsigned char)*c) ? toupper((unsigned char)*c) : '_');
    s->at = end + 1;
    for (unsigned i = 0; i < codes->values; i++) {
        if (strcmp(codes->value[i].name, name) == 0) {
            scan_put(s, "T[%.0f]", codes->value[i].value);
            return;
        }
    }
    if (number)
        scan_put(s, "T%s", name + 5);
    else
        scan_put(s, "T#<%s>", name);
}

/* NAME = value */
static void assigned_word(struct scan *s, const char *name)
{
    const char *letter = letter_of(name);
    const char *before;
    char way[NAME_MAX_];

    if ((name[0] == 'R' && scan_is_digit(name[1])) || scan_is_variable(s, name)) {
        scan_assign(s, name);
        return;
    }
    if (letter == NULL) {
        s->failed = true;
        return;
    }
    scan_skip(s);
    if (strcmp(name, "T") == 0 && *s->at == '"') {
        named_tool(s);
        return;
    }
    before = s->at;
    if (scan_name(s, way) && (strcmp(way, "AC") == 0 || strcmp(way, "IC") == 0)) {
        axis_value(s, letter[0], way);
        return;
    }
    s->at = before;
    if (strcmp(letter, "P1+") == 0) {
        scan_put(s, "P[1+");
        scan_value(s);
        scan_put(s, "]");
        return;
    }
    scan_put(s, "%s", letter);
    scan_brackets(s);
}

/* What changes nothing here: how the path is followed says G64, by the machine's limits. */
static bool is_quiet(const char *name)
{
    static const char *const names[] = {
        "SOFT",     "BRISK",     "DRIVE",     "FFWON",   "FFWOF",       "COMPON",
        "COMPOF",   "COMPCAD",   "COMPCURV",  "CFC",     "CFTCP",       "CFIN",
        "NORM",     "KONT",      "STOPRE",    "ORIWKS",  "ORIAXES",     "ORIMKS",
        "CUT2D",    "CUT2DF",    "DIAMCYCOF", "TRAFOOF", "SPCOF",       "FNORM",
        "FLIN",     "RTLION",    "RTLIOF",    "OVR",     "WALIMON",     "WALIMOF",
        "CYCLE832", "WORKPIECE", "DISPLOF",   "SAVE",    "GROUP_BEGIN", "GROUP_END"};
    const size_t count = sizeof names / sizeof names[0];

    for (size_t i = 0; i < count; i++) {
        if (strcmp(name, names[i]) == 0)
            return true;
    }
    return false;
}

/* ( ... ) with strings in it. */
static void skip_arguments(struct scan *s)
{
    unsigned depth = 0;
    bool quoted = false;

    scan_skip(s);
    if (*s->at != '(')
        return;
    for (; *s->at != '\0'; s->at++) {
        quoted = quoted != (*s->at == '"');
        depth += !quoted && *s->at == '(';
        depth -= !quoted && *s->at == ')';
        if (depth == 0) {
            s->at++;
            return;
        }
    }
}

bool scan_keyword(struct scan *s, const char *name)
{
    static const char *const words[][2] = {
        {"SUPA", "G53"}, {"DIAMON", "G7"}, {"DIAM90", "G7"}, {"DIAMOF", "G8"}, {"RET", "M17"}};

    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(name, words[i][0]) == 0) {
            const bool follows = strcmp(name, "DIAM90") == 0;

            if (strncmp(name, "DIAM", 4) == 0)
                s->t->diameter_follows = follows;
            scan_put(s, "%s", follows && s->t->incremental ? "G8" : words[i][1]);
            return true;
        }
    }
    /* without arguments it lays a tilted plane flat */
    if (!is_quiet(name) && !(strcmp(name, "CYCLE800") == 0 && scan_take(s, "()")))
        return false;
    skip_arguments(s);
    return true;
}

/* A letter and a number in one: X10, G642, D1. */
static void plain_word(struct scan *s, const char *name)
{
    const char digit = *s->at;

    scan_put(s, "%s", name);
    if (name[1] == '\0' && (digit == '-' || digit == '+' || digit == '.')) {
        if (digit == '-' || digit == '+')
            scan_put(s, "%c", *s->at++);
        scan_number(s);
    } else if (name[1] != '\0' && digit == '.') {
        scan_number(s);
    } else if (name[1] == '\0' && digit == '(' && strchr("XYZABCIJKF", name[0]) != NULL) {
        scan_bracketed(s);
    }
}

/* The edge of the tool: its length counts from there on; D0: no more. */
static bool take_edge(struct scan *s, const char *name)
{
    char *end;

    if (name[0] != 'D' || !scan_is_digit(name[1]))
        return false;
    const unsigned long edge = strtoul(name + 1, &end, 10);

    if (*end != '\0')
        return false;
    if (edge > 1)
        translate_wrong(s->t, NULL,
                        "'%s': tools have one edge here: make a tool of it, and call that by T",
                        name);
    scan_put(s, edge == 0 ? "G49" : "G43");
    return true;
}

static void refuse_edge(struct scan *s, const char *name)
{
    if (strcmp(name, "D") == 0)
        translate_wrong(s->t, NULL,
                        "'D=' has an edge that is known only when the program runs, which is not "
                        "supported: write D1 or D0");
}

static void word(struct scan *s)
{
    char name[NAME_MAX_];

    if (!scan_name(s, name)) {
        scan_put(s, "%c", *s->at++);
        return;
    }
    if (scan_take(s, "=")) {
        refuse_edge(s, name);
        assigned_word(s, name);
    } else if (scan_return(s, name)) {
        skip_arguments(s);
    } else if (!take_edge(s, name) && !siemens_call(s, name) && !scan_keyword(s, name)) {
        const bool plain = name[1] == '\0' || scan_is_digit(name[1]);

        s->failed = s->failed || !plain;
        plain_word(s, name);
    }
    scan_put(s, " ");
}

void scan_words(struct scan *s)
{
    for (scan_skip(s); *s->at != '\0' && *s->at != ';' && !s->failed; scan_skip(s))
        word(s);
    if (*s->at == ';')
        scan_put(s, "%s", s->at);
}
