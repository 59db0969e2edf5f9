#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void jumps_note_label(struct translator *t, size_t offset)
{
    const struct line_word *w = t->line.words > 0 ? &t->line.word[0] : NULL;

    t->line_offset = offset;
    if (t->survey.jumps && w != NULL && w->letter == 'n' && w->is_number)
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
void jumps_go_to(struct translator *t, uint32_t number)
{
    if (t->jumps < TRANSLATE_JUMPS_MAX)
        t->jump[t->jumps++] =
            (struct jump){t->program, number, t->number, t->behind.length + 1, t->depth};
    translate_add(&t->behind, "o00000000 goto [00000000] [00]");
}

static const struct label *find_label(const struct translator *t, const struct jump *j)
{
    for (unsigned i = 0; i < t->labels; i++) {
        if (t->label[i].program == j->program && t->label[i].number == j->number)
            return &t->label[i];
    }
    return NULL;
}

bool jumps_finish(struct translator *t)
{
    for (unsigned i = 0; i < t->jumps; i++) {
        const struct jump *j = &t->jump[i];
        const struct label *label = find_label(t, j);
        char text[64];

        if (label == NULL || label->depth > j->depth || label->offset > 99999999U) {
            t->result->wrong_line = j->line;
            t->result->wrong_number = j->number;
            return false;
        }
        const int length = snprintf(text, sizeof text, "o%08u goto [%08u] [%02u]",
                                    (unsigned)label->offset, (unsigned)label->line, label->depth);

        memcpy(t->result->text.bytes + j->patch, text, (size_t)length);
    }
    return true;
}
