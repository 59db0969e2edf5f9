/*
 * The object dictionary of a drive: takt's own (object_table.h), or that of an electronic data
 * sheet (CiA 306), so that a master can be tried against a drive that is not there.
 *
 * What counts of a data sheet: which objects there are, their access, defaults and limits, what may
 * be mapped where, the number of PDOs and of their entries, dummies, and the modes. Objects that
 * takt's own drive has, of the same size, do what they do there; all others are memory.
 */
#ifndef TAKT_SERVO_DICTIONARY_H
#define TAKT_SERVO_DICTIONARY_H

#include "servo/object_table.h"

struct dictionary {
    const struct object_row *row; /* by rising index and sub-index */
    unsigned count;
    uint8_t dummies;           /* bit n: RPDOs may skip a place of data type n */
    struct object_row *memory; /* of one that has been read: the rows, by who read it, and */
    char *names;
};

extern const struct dictionary takt_dictionary_own;
/* That of an I/O node (CiA 401) with this many bytes of inputs, and as many of outputs. */
extern const struct dictionary takt_dictionary_io;
#define DICTIONARY_IO_BYTES     2
#define DICTIONARY_IO_ANALOGUES 4 /* outputs of 16 bits */

/* NULL: no such entry. *has_index: the index exists, so the sub-index is what is missing. */
const struct object_row *takt_dictionary_find(const struct dictionary *dictionary, uint16_t index,
                                              uint8_t sub, bool *has_index);

enum dictionary_part { DICTIONARY_ALL, DICTIONARY_NOT_OF_MACHINE };

/*
 * Default values of the objects, with the node id where it belongs; of all, or without those that
 * the machine decides.
 */
void takt_dictionary_set_initial(const struct dictionary *dictionary, enum dictionary_part part,
                                 struct drive_objects *objects, uint8_t node);

/* The value is nothing but memory: takt's own drive does not have the object. */
bool takt_dictionary_is_memory(const struct object_row *row);
/* Copies the values of such objects up to this index. */
void takt_dictionary_copy_memory(const struct dictionary *dictionary, struct drive_objects *to,
                                 const struct drive_objects *from, uint16_t last);

#endif
