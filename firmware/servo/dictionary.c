#include "servo/dictionary.h"

#include "base/assert.h"

#include <string.h>

static uint32_t place(uint16_t index, uint8_t sub)
{
    return (uint32_t)index << 8 | sub;
}

const struct object_row *takt_dictionary_find(const struct dictionary *dictionary, uint16_t index,
                                              uint8_t sub, bool *has_index)
{
    const struct object_row *row = dictionary->row;
    unsigned low = 0, high = dictionary->count;
    while (low < high) {
        unsigned middle = (low + high) / 2;
        if (place(row[middle].index, row[middle].sub) < place(index, sub))
            low = middle + 1;
        else
            high = middle;
    }
    *has_index = (low < dictionary->count && row[low].index == index) ||
                 (low > 0 && row[low - 1].index == index);
    if (low == dictionary->count || row[low].index != index || row[low].sub != sub)
        return NULL;
    return &row[low];
}

bool takt_dictionary_is_memory(const struct object_row *row)
{
    return !(row->flags & OBJECT_FIXED) && row->field >= offsetof(struct drive_objects, extra);
}

void takt_dictionary_set_initial(const struct dictionary *dictionary, enum dictionary_part part,
                                 struct drive_objects *objects, uint8_t node)
{
    for (unsigned i = 0; i < dictionary->count; i++) {
        const struct object_row *row = &dictionary->row[i];
        bool is_of_machine = row->flags & OBJECT_BY_MACHINE;
        if (takt_object_type_bytes((enum object_type)row->type) == 0 ||
            (is_of_machine && part == DICTIONARY_NOT_OF_MACHINE))
            continue;
        uint32_t added = row->flags & OBJECT_NODE_ID ? node : 0;
        takt_object_write(row, objects, (uint32_t)row->initial + added);
    }
}

void takt_dictionary_copy_memory(const struct dictionary *dictionary, struct drive_objects *to,
                                 const struct drive_objects *from, uint16_t last)
{
    for (unsigned i = 0; i < dictionary->count; i++) {
        const struct object_row *row = &dictionary->row[i];
        if (row->index <= last && takt_dictionary_is_memory(row))
            takt_object_write(row, to, takt_object_read(row, from));
    }
}
