#include "dialect/difference.h"

#include <string.h>

#define GRBL     (1U << DIALECT_GRBL)
#define FANUC    (1U << DIALECT_FANUC)
#define HAAS     (1U << DIALECT_HAAS)
#define MACH3    (1U << DIALECT_MACH3)
#define MARLIN   (1U << DIALECT_MARLIN)
#define SIEMENS  (1U << DIALECT_SIEMENS)
#define INDUSTRY (FANUC | HAAS | MACH3)

/* One code, or several in a row. */
#define CODES(dialects, letter, first, last, kind, text)                                           \
    {                                                                                              \
        dialects, letter, first, last, kind, false, text                                           \
    }
#define CODE(dialects, letter, number_x10, kind, text)                                             \
    CODES(dialects, letter, number_x10, number_x10, kind, text)
/* One that no program for LinuxCNC has. */
#define TELLS(dialects, letter, number_x10, kind, text)                                            \
    {                                                                                              \
        dialects, letter, number_x10, number_x10, kind, true, text                                 \
    }

static const struct difference rows[] = {
    /* what switches off what is never on here */
    TELLS(INDUSTRY | GRBL, 'g', 150, DIFFERENCE_QUIET, "polar coordinates off"),
    TELLS(INDUSTRY, 'g', 131, DIFFERENCE_QUIET, "polar interpolation off"),
    CODE(INDUSTRY, 'g', 220, DIFFERENCE_AXES, "stored stroke check"),
    CODE(INDUSTRY, 'g', 230, DIFFERENCE_QUIET, "stored stroke check off"),
    CODE(INDUSTRY, 'g', 250, DIFFERENCE_QUIET, "spindle speed watch off"),
    TELLS(INDUSTRY, 'g', 401, DIFFERENCE_QUIET, "normal direction control off"),
    TELLS(INDUSTRY, 'g', 501, DIFFERENCE_AXES, "mirror image off"),
    CODE(HAAS, 'g', 1000, DIFFERENCE_AXES, "mirror image off"),
    TELLS(INDUSTRY, 'g', 670, DIFFERENCE_QUIET, "modal macro call off"),
    TELLS(INDUSTRY, 'g', 690, DIFFERENCE_QUIET, "rotation off"),
    TELLS(INDUSTRY, 'g', 1130, DIFFERENCE_QUIET, "polar interpolation off"),
    /* how a block is worked on: takt decides that by its limits */
    CODE(INDUSTRY, 'g', 51, DIFFERENCE_AXES, "high-speed contouring"),
    CODE(FANUC | HAAS, 'g', 80, DIFFERENCE_DROP, "blocks read ahead"),
    CODE(FANUC | HAAS, 'g', 90, DIFFERENCE_DROP, "exact stop of one block"),
    TELLS(HAAS, 'g', 1030, DIFFERENCE_DROP, "blocks read ahead"),
    TELLS(HAAS, 'g', 1870, DIFFERENCE_DROP, "smoothness of corners"),
    CODE(FANUC, 'm', 290, DIFFERENCE_DROP, "rigid tapping"),
    /* the same by another name */
    CODE(FANUC | HAAS | MACH3, 'g', 310, DIFFERENCE_REPLACE, "G38.3"),
    CODE(FANUC | HAAS, 'm', 190, DIFFERENCE_REPLACE, "M19 R0"),
    CODE(HAAS, 'g', 1100, DIFFERENCE_REPLACE, "G59.1"),
    CODE(HAAS, 'g', 1110, DIFFERENCE_REPLACE, "G59.2"),
    CODE(HAAS, 'm', 880, DIFFERENCE_REPLACE, "M7"),
    CODE(HAAS, 'm', 890, DIFFERENCE_REPLACE, "M9"),
    CODE(MARLIN, 'm', 6000, DIFFERENCE_REPLACE, "M0"),
    TELLS(GRBL, 'g', 282, DIFFERENCE_LINE, "homing"),
    TELLS(GRBL, 'g', 283, DIFFERENCE_LINE, "homing"),
    /* what this machine does not have */
    CODES(HAAS, 'm', 100, 130, DIFFERENCE_DROP, "brake of a rotary axis"),
    CODES(HAAS, 'm', 310, 330, DIFFERENCE_DROP, "chip conveyor"),
    CODES(HAAS, 'm', 340, 360, DIFFERENCE_DROP, "coolant spigot"),
    CODES(HAAS, 'm', 410, 420, DIFFERENCE_DROP, "gear"),
    CODES(HAAS, 'm', 800, 810, DIFFERENCE_DROP, "automatic door"),
    CODES(HAAS, 'm', 830, 840, DIFFERENCE_DROP, "air blast"),
    CODES(MACH3, 'm', 400, 410, DIFFERENCE_DROP, "gear"),
    /*
     * Siemens: inches by other numbers, offsets beyond G57, stops at corners and what else shapes a
     * path
     */
    CODE(SIEMENS, 'g', 700, DIFFERENCE_REPLACE, "G20"),
    CODE(SIEMENS, 'g', 7000, DIFFERENCE_REPLACE, "G20"),
    CODE(SIEMENS, 'g', 710, DIFFERENCE_REPLACE, "G21"),
    CODE(SIEMENS, 'g', 7100, DIFFERENCE_REPLACE, "G21"),
    CODE(SIEMENS, 'g', 600, DIFFERENCE_REPLACE, "G61.1"),
    CODES(SIEMENS, 'g', 6410, 6450, DIFFERENCE_REPLACE, "G64"),
    CODES(SIEMENS, 'g', 6010, 6030, DIFFERENCE_QUIET, "when an exact stop is reached"),
    CODE(SIEMENS, 'g', 1530, DIFFERENCE_REPLACE, "G53"),
    CODE(SIEMENS, 'g', 960, DIFFERENCE_REPLACE, "G96 G95"),
    CODE(SIEMENS, 'g', 970, DIFFERENCE_REPLACE, "G97 G95"),
    CODE(SIEMENS, 'g', 9610, DIFFERENCE_REPLACE, "G96 G94"),
    CODE(SIEMENS, 'g', 9710, DIFFERENCE_REPLACE, "G97 G94"),
    CODE(SIEMENS, 'g', 9620, DIFFERENCE_REPLACE, "G96"),
    CODE(SIEMENS, 'g', 9720, DIFFERENCE_REPLACE, "G97"),
    CODE(SIEMENS, 'g', 90, DIFFERENCE_DROP, "exact stop of one block"),
    CODE(SIEMENS, 'g', 5050, DIFFERENCE_REPLACE, "G58"),
    CODE(SIEMENS, 'g', 5060, DIFFERENCE_REPLACE, "G59"),
    CODE(SIEMENS, 'g', 5070, DIFFERENCE_REPLACE, "G59.1"),
    CODE(SIEMENS, 'g', 5080, DIFFERENCE_REPLACE, "G59.2"),
    CODE(SIEMENS, 'g', 5090, DIFFERENCE_REPLACE, "G59.3"),
    CODES(SIEMENS, 'g', 4500, 4510, DIFFERENCE_QUIET, "outer corners of compensation"),
    CODES(SIEMENS, 'g', 4600, 4620, DIFFERENCE_QUIET, "crossings in compensation"),
    CODE(SIEMENS, 'm', 170, DIFFERENCE_REPLACE, "M2"),
    /* printers: what is left is the way of the nozzle */
    CODES(MARLIN, 'g', 290, 300, DIFFERENCE_LINE, "probing of the bed"),
    CODES(MARLIN, 'g', 100, 110, DIFFERENCE_LINE, "filament"),
    CODE(MARLIN, 'g', 800, DIFFERENCE_LINE, "levelling of the bed"),
    CODES(MARLIN, 'm', 170, 180, DIFFERENCE_LINE, "motors"),
    CODES(MARLIN, 'm', 200, 290, DIFFERENCE_LINE, "memory card"),
    CODES(MARLIN, 'm', 310, 320, DIFFERENCE_LINE, "print time"),
    CODES(MARLIN, 'm', 700, 780, DIFFERENCE_LINE, "print job"),
    CODES(MARLIN, 'm', 790, 810, DIFFERENCE_LINE, "power supply"),
    CODES(MARLIN, 'm', 820, 830, DIFFERENCE_LINE, "extruder"),
    CODES(MARLIN, 'm', 840, 870, DIFFERENCE_LINE, "motors"),
    CODES(MARLIN, 'm', 920, 990, DIFFERENCE_LINE, "settings"),
    CODES(MARLIN, 'm', 1000, 1030, DIFFERENCE_LINE, "extruder"),
    CODES(MARLIN, 'm', 1040, 1059, DIFFERENCE_LINE, "temperature"),
    CODES(MARLIN, 'm', 1060, 1079, DIFFERENCE_LINE, "fan"),
    CODES(MARLIN, 'm', 1080, 1089, DIFFERENCE_LINE, "extruder"),
    CODES(MARLIN, 'm', 1090, 1099, DIFFERENCE_LINE, "temperature"),
    CODES(MARLIN, 'm', 1100, 1399, DIFFERENCE_LINE, "talk with the sender"),
    CODES(MARLIN, 'm', 1400, 1440, DIFFERENCE_LINE, "temperature"),
    CODES(MARLIN, 'm', 1450, 1599, DIFFERENCE_LINE, "settings"),
    CODES(MARLIN, 'm', 1600, 1999, DIFFERENCE_LINE, "temperature"),
    CODES(MARLIN, 'm', 2000, 5999, DIFFERENCE_LINE, "settings of the printer"),
    CODES(MARLIN, 'm', 6010, 65000, DIFFERENCE_LINE, "settings of the printer"),
};

static bool covers(const struct difference *row, char letter, unsigned number_x10)
{
    return row->letter == letter && number_x10 >= row->first_x10 && number_x10 <= row->last_x10;
}

const struct difference *difference_find(enum dialect dialect, char letter, unsigned number_x10)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if ((rows[i].dialects & (1U << dialect)) != 0 && covers(&rows[i], letter, number_x10))
            return &rows[i];
    }
    return NULL;
}

unsigned difference_dialects(char letter, unsigned number_x10)
{
    unsigned dialects = 0;

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (rows[i].tells && covers(&rows[i], letter, number_x10))
            dialects |= rows[i].dialects;
    }
    return dialects;
}
