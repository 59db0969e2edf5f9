/*
 * A part program as it is found: of another dialect it is translated, codes that the machine file
 * declares become what it says, and subroutines that lie in files of their own are brought in
 * behind it.
 */
#ifndef TAKT_HOST_PROGRAM_FRONT_H
#define TAKT_HOST_PROGRAM_FRONT_H

#include "cli/program_text.h"
#include "dialect/dialect.h"

#include <stdbool.h>

#define PROGRAM_FRONT_FOLDERS_MAX 66

struct program_front {
    enum dialect dialect; /* DIALECT_AUTO: by what the program says of itself */
    const struct dialect_codes *codes;
    unsigned folders; /* where subroutines are looked for, beside the program's own folder */
    const char *folder[PROGRAM_FRONT_FOLDERS_MAX];
    bool quiet; /* says nothing but errors and warnings */
};

/* Makes of an opened text what is to be read. False after a message. */
bool program_front_prepare(const struct program_front *front, struct program_text *text);

/*
 * A program and what belongs to it as one text, for those who keep it whole. False after a message.
 */
bool program_front_read(const struct program_front *front, const char *path, struct text *text);

#endif
