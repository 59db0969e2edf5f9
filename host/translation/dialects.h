/* The languages of other controllers, by number and name. */
#ifndef TAKT_HOST_TRANSLATION_DIALECTS_H
#define TAKT_HOST_TRANSLATION_DIALECTS_H

enum dialect {
    DIALECT_LINUXCNC,
    DIALECT_GRBL,
    DIALECT_FANUC,
    DIALECT_HAAS,
    DIALECT_MACH3,
    DIALECT_MARLIN,
    DIALECT_SIEMENS,
    DIALECT_COUNT,
    DIALECT_AUTO = DIALECT_COUNT
};

/* As in options; NULL when there is no such number. */
const char *dialect_name(enum dialect dialect);
/* DIALECT_COUNT + 1: none has this name. */
unsigned dialect_find(const char *name);

#endif
