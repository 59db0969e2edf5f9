#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EMPTY_JUMP "o00000000 goto [00000000] [00]"
#define ANY_LABEL  98000000U

void jumps_note_label(struct translator *t, size_t offset)
{
    const struct line_word *w = line_number(&t->line);

    t->line_offset = offset;
    if (t->survey.jumps && w != NULL)
        jumps_add_label(t, line_whole(w->value));
}

void jumps_add_label(struct translator *t, uint32_t number)
{
    if (t->labels == t->label_room) {
        const size_t room = 2 * t->label_room + 256;
        struct label *grown = realloc(t->label, room * sizeof *grown);

        t->result->text.failed = t->result->text.failed || grown == NULL;
        if (grown == NULL)
            return;
        t->label = grown;
        t->label_room = room;
    }
    t->label[t->labels++] = (struct label){t->program, number, t->number, t->line_offset, t->depth};
}

/* Where it is filled in is a place in behind, until the line is put out. */
static void put_jump(struct translator *t, uint32_t number, enum jump_way way, bool possible)
{
    if (t->jumps < TRANSLATE_JUMPS_MAX)
        t->jump[t->jumps++] = (struct jump){.way = way,
                                            .program = t->program,
                                            .number = number,
                                            .line = t->number,
                                            .patch = t->behind.length + (t->behind.slash ? 2 : 1),
                                            .depth = t->depth,
                                            .possible = possible};
    else
        translate_wrong(t, NULL, "GOTO: a program may jump from %u places", TRANSLATE_JUMPS_MAX);
    translate_add(&t->behind, "%s", EMPTY_JUMP);
}

void jumps_go_to(struct translator *t, uint32_t number, enum jump_way way)
{
    put_jump(t, number, way, false);
}

void jumps_go_to_any(struct translator *t, const char *expression)
{
    const struct survey *s = &t->survey;
    const unsigned label = ANY_LABEL + t->number % 1000000U;

    if (s->targets > TRANSLATE_TARGETS_MAX || t->jumps + s->targets > TRANSLATE_JUMPS_MAX) {
        translate_wrong(t, NULL, "GOTO%.40s: more lines have an N than it can choose from",
                        expression);
        return;
    }
    for (unsigned i = 0; i < s->targets; i++) {
        translate_add(&t->behind, "o%u if [[%s] EQ %u]", label, expression, (unsigned)s->target[i]);
        put_jump(t, s->target[i], JUMP_ANYWHERE, true);
        translate_add(&t->behind, "o%u endif", label);
    }
    translate_add(&t->behind, "(abort,GOTO: no line has this N)");
}

/*
 * One further back takes the place of what has been found before it; where both ways are looked,
 * what is behind the jump goes before what is in front of it.
 */
static bool is_better(const struct jump *j, const struct label *label, const struct label *found)
{
    if (label->program != j->program || label->number != j->number || label->depth > j->depth)
        return false;
    switch (j->way) {
    case JUMP_FORWARD:
        return found == NULL && label->line > j->line;
    case JUMP_BACK:
        return label->line <= j->line;
    case JUMP_ANYWHERE:
        break;
    }
    return found == NULL || (found->line <= j->line && label->line > j->line);
}

static const struct label *find_label(const struct translator *t, const struct jump *j)
{
    const struct label *found = NULL;

    for (unsigned i = 0; i < t->labels; i++) {
        if (is_better(j, &t->label[i], found))
            found = &t->label[i];
    }
    return found;
}

void jumps_finish(struct translator *t)
{
    for (unsigned i = 0; i < t->jumps; i++) {
        const struct jump *j = &t->jump[i];
        const struct label *label = find_label(t, j);
        char text[64];
        int length;

        if (label != NULL && label->offset <= 99999999U)
            length = snprintf(text, sizeof text, "o%08u goto [%08u] [%02u]",
                              (unsigned)label->offset, (unsigned)label->line, label->depth);
        else if (j->possible)
            length = snprintf(text, sizeof text, "%*s", (int)sizeof EMPTY_JUMP - 1, "");
        else
            length = snprintf(text, sizeof text, "o00000000 goto %15s", "");
        memcpy(t->result->text.bytes + j->patch, text, (size_t)length);
    }
}
