/*
 * Flow of Siemens' language (siemens.c): labels, jumps, branches and loops.
 */
#include "siemens/scan.h"
#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK_LABEL  98000000U
#define REPEAT_LABEL 99000000U
/* Jumps go to names: their numbers begin behind those of blocks. */
#define NAME_NUMBER 100000000U
/* Parameters behind those of R count the rounds of REPEAT with a label. */
#define ROUNDS_FIRST 1100U
#define ROUNDS_MAX   1000U

/* ---- jumps ---- */

static uint32_t number_of(struct scan *s, const char *name)
{
    struct translator *t = s->t;

    for (unsigned i = 0; i < t->names; i++) {
        if (strcmp(t->name[i], name) == 0)
            return NAME_NUMBER + i;
    }
    s->failed = s->failed || t->names == TRANSLATE_NAMES_MAX;
    if (s->failed)
        return 0;
    (void)snprintf(t->name[t->names], sizeof t->name[0], "%s", name);
    return NAME_NUMBER + t->names++;
}

/* N100, or a name. */
static uint32_t target_of(struct scan *s, const char *name)
{
    const bool numbered = name[0] == 'N' && scan_is_digit(name[1]) &&
                          strspn(name + 1, "0123456789") == strlen(name + 1);

    return numbered ? (uint32_t)strtoul(name + 1, NULL, 10) : number_of(s, name);
}

bool scan_label(struct scan *s)
{
    const char *before = s->at;
    char name[NAME_MAX_];

    if (!scan_name(s, name))
        return false;
    const bool named = *s->at == ':' && s->at[1] != '=';

    if (named || (name[0] == 'N' && scan_is_digit(name[1]) &&
                  strspn(name + 1, "0123456789") == strlen(name + 1))) {
        s->at += named ? 1 : 0;
        jumps_add_label(s->t, target_of(s, name));
        return !s->failed;
    }
    s->at = before;
    return false;
}

/* GOTOC and GOTOS are not known. */
static bool take_jump(struct scan *s, const char *name)
{
    char target[NAME_MAX_];

    if (strncmp(name, "GOTO", 4) != 0)
        return false;
    const enum jump_way way = name[4] == 'F'   ? JUMP_FORWARD
                              : name[4] == 'B' ? JUMP_BACK
                                               : JUMP_ANYWHERE;

    s->failed = s->failed || (name[4] != '\0' && (way == JUMP_ANYWHERE || name[5] != '\0')) ||
                !scan_name(s, target);
    const uint32_t number = s->failed ? 0 : target_of(s, target);

    if (s->failed)
        return true;
    scan_clear(s);
    jumps_go_to(s->t, number, way);
    return true;
}

/* ---- blocks ---- */

static uint32_t label_of(const struct translator *t, uint32_t first)
{
    return first + t->number % 1000000U;
}

static uint32_t open_block(struct scan *s, uint32_t first)
{
    struct translator *t = s->t;
    const uint32_t label = label_of(t, first);

    s->failed = s->failed || t->blocks == TRANSLATE_BLOCKS_MAX;
    if (!s->failed)
        t->block[t->blocks++] = label;
    t->depth = t->blocks;
    return label;
}

static uint32_t close_block(struct translator *t)
{
    const uint32_t label = t->blocks > 0 ? t->block[--t->blocks] : 0;

    t->depth = t->blocks;
    return label;
}

static void take_if(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];
    const char *before;

    scan_brackets(s);
    before = s->at;
    const bool jumps = scan_name(s, name) && strncmp(name, "GOTO", 4) == 0;

    if (s->failed)
        return;
    scan_clear(s);
    if (!jumps) {
        s->at = before;
        translate_add(&t->before, "o%u if %s", (unsigned)open_block(s, BLOCK_LABEL), s->out);
        return;
    }
    translate_add(&t->behind, "o%u if %s", (unsigned)label_of(t, BLOCK_LABEL), s->out);
    (void)take_jump(s, name);
    translate_add(&t->behind, "o%u endif", (unsigned)label_of(t, BLOCK_LABEL));
}

static void take_for(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];
    char variable[NAME_MAX_ + 16];

    s->failed = s->failed || !scan_name(s, name) || !scan_take(s, "=");
    scan_operand(s, name);
    (void)snprintf(variable, sizeof variable, "%.*s", (int)s->length, s->out);
    s->length = 0;
    scan_brackets(s);
    s->failed = s->failed || !scan_name(s, name) || strcmp(name, "TO") != 0;
    if (s->failed)
        return;
    translate_add(&t->before, "%s=[%s-1]", variable, s->out);
    s->length = 0;
    scan_brackets(s);
    translate_add(&t->before, "o%u while [%s LT %s]", (unsigned)open_block(s, REPEAT_LABEL),
                  variable, s->out);
    translate_add(&t->before, "%s=[%s+1]", variable, variable);
    scan_clear(s);
}

static void take_loop(struct scan *s, const char *condition)
{
    struct translator *t = s->t;

    translate_add(&t->before, "o%u while %s", (unsigned)open_block(s, REPEAT_LABEL), condition);
    scan_clear(s);
}

static void end_loop(struct scan *s)
{
    struct translator *t = s->t;

    translate_add(&t->behind, "o%u endwhile", (unsigned)close_block(t));
    scan_clear(s);
}

/* REPEAT ... UNTIL a */
static void take_until(struct scan *s)
{
    struct translator *t = s->t;

    scan_brackets(s);
    if (s->failed)
        return;
    translate_add(&t->behind, "o%u while [1-%s]", (unsigned)close_block(t), s->out);
    scan_clear(s);
}

/* CASE(a) OF 1 GOTOF B 2 GOTOF C DEFAULT GOTOF D */
static void take_case(struct scan *s)
{
    struct translator *t = s->t;
    const unsigned label = label_of(t, BLOCK_LABEL);
    char asked[LINE_MAX_BYTES + 1];
    char name[NAME_MAX_];

    scan_brackets(s);
    (void)snprintf(asked, sizeof asked, "%s", s->out);
    s->failed = s->failed || !scan_name(s, name) || strcmp(name, "OF") != 0;
    for (scan_skip(s); !s->failed && !scan_is_end(s); scan_skip(s)) {
        const char *before = s->at;
        const bool rest = scan_name(s, name) && strcmp(name, "DEFAULT") == 0;

        s->at = rest ? s->at : before;
        s->length = 0;
        if (!rest)
            scan_single(s);
        if (s->failed)
            return;
        translate_add(&t->behind, "o%u if [%s EQ %s]", label, rest ? "0" : asked,
                      rest ? "0" : s->out);
        s->failed = !scan_name(s, name) || !take_jump(s, name) || s->failed;
        translate_add(&t->behind, "o%u endif", label);
    }
}

/*
 * REPEAT NAME P=3: from the label to here three times more. The rounds are counted by a parameter
 * that is 0 before and behind.
 */
static void take_section_again(struct scan *s)
{
    struct translator *t = s->t;
    const unsigned counter = ROUNDS_FIRST + t->repeats;
    char target[NAME_MAX_] = "";
    char name[NAME_MAX_] = "";

    s->failed = s->failed || !scan_name(s, target) || t->repeats == ROUNDS_MAX;
    s->length = 0;
    if (scan_is_end(s))
        scan_put(s, "1");
    else if (scan_name(s, name) && strcmp(name, "P") == 0 && scan_take(s, "="))
        scan_brackets(s);
    else if (name[0] == 'P' && scan_is_digit(name[1]))
        scan_put(s, "%s", name + 1);
    else
        s->failed = true;
    scan_skip(s);
    const uint32_t number = s->failed ? 0 : target_of(s, target);

    s->failed = s->failed || !scan_is_end(s);
    if (s->failed)
        return;
    t->repeats++;
    scan_clear(s);
    translate_add(&t->behind, "#%u=[#%u+1]", counter, counter);
    translate_add(&t->behind, "o%u if [#%u LE %s]", (unsigned)label_of(t, BLOCK_LABEL), counter,
                  s->out);
    jumps_go_to(t, number, JUMP_BACK);
    translate_add(&t->behind, "o%u endif", (unsigned)label_of(t, BLOCK_LABEL));
    translate_add(&t->behind, "#%u=0", counter);
}

void scan_pass_block(struct scan *s, const char *name)
{
    const bool branches = strcmp(name, "IF") == 0 && strstr(s->t->line.text, "GOTO") == NULL;

    s->failed = false;
    if (branches)
        translate_add(&s->t->behind, "o%u if [0]", (unsigned)open_block(s, BLOCK_LABEL));
    else if (strcmp(name, "WHILE") == 0 || strcmp(name, "FOR") == 0)
        translate_add(&s->t->behind, "o%u while [0]", (unsigned)open_block(s, REPEAT_LABEL));
}

bool scan_flow(struct scan *s, const char *name)
{
    struct translator *t = s->t;

    scan_skip(s);
    if (take_jump(s, name))
        return true;
    if (strcmp(name, "IF") == 0) {
        take_if(s);
    } else if (strcmp(name, "CASE") == 0) {
        take_case(s);
    } else if (strcmp(name, "FOR") == 0) {
        take_for(s);
    } else if (strcmp(name, "WHILE") == 0) {
        scan_brackets(s);
        if (!s->failed)
            take_loop(s, s->out);
    } else if (strcmp(name, "LOOP") == 0) {
        take_loop(s, "[1]");
    } else if (strcmp(name, "ENDFOR") == 0 || strcmp(name, "ENDWHILE") == 0 ||
               strcmp(name, "ENDLOOP") == 0) {
        end_loop(s);
    } else if (strcmp(name, "REPEAT") == 0 && scan_is_end(s)) {
        translate_add(&t->before, "o%u do", (unsigned)open_block(s, REPEAT_LABEL));
        scan_clear(s);
    } else if (strcmp(name, "REPEAT") == 0) {
        take_section_again(s);
    } else if (strcmp(name, "UNTIL") == 0) {
        take_until(s);
    } else if (strcmp(name, "ELSE") == 0 && t->blocks > 0) {
        translate_add(&t->behind, "o%u else", (unsigned)t->block[t->blocks - 1]);
        scan_clear(s);
    } else if (strcmp(name, "ENDIF") == 0) {
        translate_add(&t->behind, "o%u endif", (unsigned)close_block(t));
        scan_clear(s);
    } else {
        return false;
    }
    return true;
}
