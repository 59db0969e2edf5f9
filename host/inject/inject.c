/*
 * Reading of scripts: lines into words, words into faults.
 */
#include "inject/inject_private.h"

#include <assert.h>
#include <ctype.h>
#include <stdarg.h>
#include <string.h>

struct reader {
    const char *at;  /* next character of the line */
    const char *end; /* of the line */
    const char *line_start;
    uint32_t line;
    struct inject_error *error;
};

/* A word of a line, copied. */
struct word {
    char text[INJECT_WORD_MAX + 1];
    uint32_t column;
};

__attribute__((format(printf, 3, 4))) static bool refuse(struct reader *reader, uint32_t column,
                                                         const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(reader->error->text, sizeof reader->error->text, format, arguments);
    va_end(arguments);
    reader->error->line = reader->line;
    reader->error->column = column;
    return false;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* The next word of the line; empty at its end. A comment begins with # and goes to the end. */
static bool next_word(struct reader *reader, struct word *word)
{
    size_t length = 0;
    memset(word, 0, sizeof *word);
    while (reader->at < reader->end && is_space(*reader->at))
        reader->at++;
    if (reader->at < reader->end && *reader->at == '#')
        reader->at = reader->end;
    word->column = (uint32_t)(reader->at - reader->line_start) + 1;
    while (reader->at < reader->end && !is_space(*reader->at) && *reader->at != '#') {
        unsigned char c = (unsigned char)*reader->at++;
        if (length == INJECT_WORD_MAX)
            return refuse(reader, word->column, "a word of more than %d characters",
                          INJECT_WORD_MAX);
        if (c < ' ' || c > '~')
            return refuse(reader, word->column + (uint32_t)length, "a character that is not ASCII");
        word->text[length++] = (char)c;
    }
    word->text[length] = '\0';
    return true;
}

/* "power", "power+0.5s", "enabled+20ms". */
static bool read_when(struct reader *reader, const struct word *word, struct inject_fault *fault)
{
    static const char *const anchors[] = {[INJECT_POWER] = "power", [INJECT_ENABLED] = "enabled"};
    for (unsigned i = 0; i < sizeof anchors / sizeof anchors[0]; i++) {
        size_t length = strlen(anchors[i]);
        if (strncmp(word->text, anchors[i], length) != 0)
            continue;
        fault->anchor = (enum inject_anchor)i;
        if (word->text[length] == '\0')
            return true;
        if (word->text[length] == '+' &&
            inject_read_time(word->text + length + 1, &fault->after_ns))
            return true;
    }
    return refuse(reader, word->column,
                  "'%s' is no time; power, power+0.5s, enabled or enabled+20ms is expected",
                  word->text);
}

/* "bus", for that of another number "can1". */
static bool is_bus(const char *text, uint8_t *bus)
{
    const bool is_numbered =
        strncmp(text, "can", 3) == 0 && isdigit((unsigned char)text[3]) && text[4] == '\0';
    *bus = is_numbered ? (uint8_t)(text[3] - '0') : 0;
    return is_numbered || strcmp(text, "bus") == 0;
}

/* A bus, or "drive" or "io" and its node. */
static bool read_where(struct reader *reader, const struct word *word, struct inject_fault *fault,
                       bool *of_bus)
{
    struct word node;
    *of_bus = is_bus(word->text, &fault->bus);
    if (*of_bus)
        return true;
    if (strcmp(word->text, "drive") != 0 && strcmp(word->text, "io") != 0)
        return refuse(reader, word->column, "'%s' cannot fail; bus or drive NODE is expected",
                      word->text);
    if (!next_word(reader, &node))
        return false;
    if (!inject_read_address(node.text, &fault->bus, &fault->node))
        return refuse(reader, node.column, "'%s' is no node id; 1 ... 127 is expected", node.text);
    return true;
}

static void list_kinds(bool of_bus, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (unsigned i = 0; i < INJECT_KINDS && used < size; i++)
        if (inject_kinds[i].of_bus == of_bus)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                     inject_kinds[i].name);
}

static bool read_kind(struct reader *reader, const struct word *word, bool of_bus,
                      struct inject_fault *fault)
{
    char known[INJECT_ERROR_TEXT_MAX];
    for (unsigned i = 0; i < INJECT_KINDS; i++) {
        if (inject_kinds[i].of_bus == of_bus && strcmp(word->text, inject_kinds[i].name) == 0) {
            fault->kind = (enum inject_kind)i;
            return true;
        }
    }
    list_kinds(of_bus, known, sizeof known);
    return refuse(reader, word->column, "'%s' is no fault of a %s; known are %s", word->text,
                  of_bus ? "bus" : "drive", known);
}

static enum inject_key find_key(const char *name)
{
    unsigned key = 0;
    while (key < INJECT_KEYS && strcmp(inject_keys[key].name, name) != 0)
        key++;
    return (enum inject_key)key;
}

static bool read_pair(struct reader *reader, struct word *word, struct inject_fault *fault,
                      uint32_t *given)
{
    const struct inject_kind_row *row = &inject_kinds[fault->kind];
    char *equals = strchr(word->text, '=');
    if (!equals)
        return refuse(reader, word->column, "'%s': KEY=VALUE is expected", word->text);
    *equals = '\0';
    enum inject_key key = find_key(word->text);
    if (key == INJECT_KEYS || !(row->allowed & INJECT_BIT(key)))
        return refuse(reader, word->column, "'%s' means nothing for %s", word->text,
                      inject_name(fault->kind));
    if (*given & INJECT_BIT(key))
        return refuse(reader, word->column, "'%s' is given twice", word->text);
    *given |= INJECT_BIT(key);
    if (inject_read_value(fault, key, equals + 1))
        return true;
    return refuse(reader, word->column + (uint32_t)(equals + 1 - word->text),
                  "%s=%s: %s is expected", inject_keys[key].name, equals + 1,
                  inject_keys[key].form);
}

static bool check_required(struct reader *reader, const struct inject_fault *fault, uint32_t given)
{
    uint32_t missing = inject_kinds[fault->kind].required & ~given;
    for (unsigned key = 0; key < INJECT_KEYS; key++)
        if (missing & INJECT_BIT(key))
            return refuse(reader, (uint32_t)(reader->end - reader->line_start) + 1,
                          "%s needs %s=%s", inject_name(fault->kind), inject_keys[key].name,
                          inject_keys[key].form);
    return true;
}

static bool read_pairs(struct reader *reader, struct inject_fault *fault)
{
    struct word word;
    uint32_t given = 0;
    for (;;) {
        if (!next_word(reader, &word))
            return false;
        if (word.text[0] == '\0')
            return check_required(reader, fault, given);
        if (!read_pair(reader, &word, fault, &given))
            return false;
    }
}

/* One frame, unless a probability, a duration or a number of frames asks for more. */
static void complete(struct inject_fault *fault)
{
    bool has_for = inject_kinds[fault->kind].allowed & INJECT_BIT(INJECT_KEY_FOR);
    if (fault->frames == 0)
        fault->frames = fault->for_ns != 0 || fault->ratio < 1 ? INJECT_ALL : 1;
    if (has_for && fault->for_ns == 0)
        fault->for_ns = INJECT_ALWAYS;
}

static bool read_fault(struct reader *reader, struct word *word, struct inject_fault *fault)
{
    bool of_bus;
    *fault = (struct inject_fault){
        .line = reader->line, .node = INJECT_ANY_NODE, .id = INJECT_ANY_ID, .ratio = 1, .seed = 1};
    if (!read_when(reader, word, fault) || !next_word(reader, word) ||
        !read_where(reader, word, fault, &of_bus) || !next_word(reader, word) ||
        !read_kind(reader, word, of_bus, fault) || !read_pairs(reader, fault))
        return false;
    complete(fault);
    return true;
}

static bool read_line(struct reader *reader, struct inject *script)
{
    struct word word;
    if (!next_word(reader, &word))
        return false;
    if (word.text[0] == '\0')
        return true;
    if (script->count == INJECT_FAULTS_MAX)
        return refuse(reader, word.column, "more than %d faults", INJECT_FAULTS_MAX);
    if (!read_fault(reader, &word, &script->fault[script->count]))
        return false;
    script->count++;
    return true;
}

bool inject_read(struct inject *script, const char *text, size_t length, struct inject_error *error)
{
    struct reader reader = {.at = text, .error = error};
    const char *text_end = text + length;
    script->count = 0;
    while (reader.at < text_end) {
        const char *newline = memchr(reader.at, '\n', (size_t)(text_end - reader.at));
        reader.line++;
        reader.line_start = reader.at;
        reader.end = newline ? newline : text_end;
        if (!read_line(&reader, script))
            return false;
        reader.at = newline ? newline + 1 : text_end;
    }
    return true;
}

bool inject_is_in_force(const struct inject_fault *fault, const struct inject_clock *clock)
{
    uint64_t anchor_ns = fault->anchor == INJECT_POWER ? 0 : clock->enabled_ns;
    if (anchor_ns == INJECT_ALWAYS || clock->now_ns < anchor_ns + fault->after_ns)
        return false;
    if (fault->for_ns == 0 || fault->for_ns == INJECT_ALWAYS)
        return true;
    return clock->now_ns - anchor_ns - fault->after_ns < fault->for_ns;
}

bool inject_is_of_bus(enum inject_kind kind)
{
    return inject_kinds[kind].of_bus;
}

const char *inject_name(enum inject_kind kind)
{
    return inject_kinds[kind].name;
}
