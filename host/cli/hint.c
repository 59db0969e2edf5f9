#include "cli/hint.h"

#include "cli/found_word.h"
#include "translation/codes.h"
#include "words/line.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

struct hint {
    enum takt_error code;
    const char *text;
};

static const struct hint hints[] = {
    {TAKT_ERROR_COMMENT_UNCLOSED, "a comment ends with ')' on its own line"},
    {TAKT_ERROR_FEED_MISSING,
     "give it on this line or before: F600 is 600 mm/min, or inch/min after G20; or in [codes] of "
     "the machine file, or as --set codes.F=600, for programs that never do"},
    {TAKT_ERROR_MOTION_MODE_MISSING,
     "begin with G0 (rapid) or G1 (cutting); G80 and cycles end them"},
    {TAKT_ERROR_ARC_ENDPOINT, "I J K count from the arc's start; if they are absolute, G90.1 comes "
                              "before. Or give R instead"},
    {TAKT_ERROR_ARC_RADIUS_SMALL, "R must be half of the distance to the end, at least"},
    {TAKT_ERROR_ARC_CENTRE_MISSING,
     "in G17 the centre is I J, in G18 I K, in G19 J K; G1 goes straight"},
    {TAKT_ERROR_TOOL_ABSENT, "give a table with --tools FILE, or tool_table in the machine file; "
                             "--tools auto takes what the program says"},
    {TAKT_ERROR_TRAVEL_EXCEEDED, "look at the units (G20, G21), the work offsets (--parameters), "
                                 "G91, and the travel in the machine file"},
    {TAKT_ERROR_AXIS_MISSING, "an axis is added to a machine file by [axis A]"},
    {TAKT_ERROR_SUB_UNKNOWN,
     "its file (NAME.ngc, O1000.nc) is looked for beside the program, and in folders given by "
     "--subroutines"},
    {TAKT_ERROR_PARAMETER_UNDEFINED,
     "set it before: #<name> = 0; without _ it belongs to its subroutine alone"},
    {TAKT_ERROR_SPINDLE_STANDS, "M3 S1000 starts it"},
    {TAKT_ERROR_TOOL_MISSING, "T1 M6 takes tool 1"},
    {TAKT_ERROR_CUTTER_ON, "G40 ends it"},
    {TAKT_ERROR_CUTTER_EXIT_ARC, "leave the contour by G1 or G0"},
    {TAKT_ERROR_OFFSET_ENTRY_SHORT, "begin the contour further away than the tool's radius"},
    {TAKT_ERROR_DWELL_MISSING, "G4 P0.5 waits for half a second"},
    {TAKT_ERROR_OWORD_UNCLOSED, "its end has the same number or name: o1 if ... o1 endif"},
    {TAKT_ERROR_CIRCLE, "what its condition asks for never changes"},
    {TAKT_ERROR_LINE_TOO_LONG, "make two lines of it; a comment at its end does not count"},
    {TAKT_ERROR_SPINDLE_NO_ENCODER, "encoder_counts in [spindle] of the machine file"},
};

#define LAST_OFFSETS "G54 to G59.3 are there: G10 L2 P7 X10 sets G59.1, P8 and P9 the last two"

/*
 * Codes of other controllers that move something: to leave them out would cut something else, or
 * elsewhere. ?: any digit.
 */
static const struct moving {
    const char *word;
    const char *meaning;
    const char *cure;
} moving[] = {
    {"G12", "a round pocket (Haas)", "G12 I5. F200 is read with --dialect haas"},
    {"G13", "a round pocket (Haas)", "G13 I5. F200 is read with --dialect haas"},
    {"G12.1", "a face cut by turning C", "C and X of one path are not calculated here"},
    {"G112", "a face cut by turning C", "C and X of one path are not calculated here"},
    {"G113", "a face cut by turning C", "C and X of one path are not calculated here"},
    {"G7.1", "a path on a cylinder", "C and Z of one path are not calculated here"},
    {"G107", "a path on a cylinder", "C and Z of one path are not calculated here"},
    {"G16", "polar coordinates", "@10 ^30 is 10 from the origin at 30 degrees"},
    {"G27", "a check of the reference, at a place", "G0 goes to the place, G28 to the reference"},
    {"G29", "the way back from the reference", "G0 goes to each place of it"},
    {"G31", "a probing move", "G38.3 Z-5 F50 is one"},
    {"G37", "a tool measured by a probe", "G38.2 probes, G10 L1 P1 Z50 sets a length"},
    {"G44", "a tool's length taken off", "G43 adds it: write it with the other sign"},
    {"G63", "a thread tapped by hand (Siemens)", "G33.1 Z-20 K1.5 taps and turns back"},
    {"G331", "a thread tapped (Siemens)", "G33.1 Z-20 K1.5 taps and turns back"},
    {"G332", "the way back of tapping (Siemens)", "G33.1 Z-20 K1.5 taps and turns back"},
    {"G32", "a thread in one cut", "G33 Z-20 K1.5 cuts it"},
    {"G34", "a thread of changing pitch", "G33 has one pitch"},
    {"G43.4", "the tool's tip led while rotary axes turn",
     "write the program with a postprocessor for this machine"},
    {"G43.5", "the tool's tip led while rotary axes turn",
     "write the program with a postprocessor for this machine"},
    {"G54.1", "a work offset beyond P3", LAST_OFFSETS},
    {"G154", "a work offset beyond P3 (Haas)", LAST_OFFSETS},
    {"G11?", "a work offset beyond G59.3 (Haas)", LAST_OFFSETS},
    {"G12?", "a work offset beyond G59.3 (Haas)", LAST_OFFSETS},
    {"G51", "a scaled program", "the program that makes programs scales them"},
    {"G51.1", "a mirrored program", "the program that makes programs mirrors them"},
    {"G53.1", "the tool turned upright on a tilted plane",
     "write the program with a postprocessor for this machine"},
    {"G68", "a turned program", "G10 L2 P1 R30 turns G54 by 30 degrees, R0 back"},
    {"G68.2", "a tilted plane", "write the program with a postprocessor for this machine"},
    {"G47", "engraved text (Haas)", "the program that makes programs engraves text"},
    {"G101", "a mirrored program (Haas)", "the program that makes programs mirrors them"},
    {"G150", "a pocket of any shape (Haas)", "the program that makes programs has pockets"},
    {"G234", "the tool's tip led while rotary axes turn (Haas)",
     "write the program with a postprocessor for this machine"},
    {"G254", "a part that turns with its table (Haas)",
     "write the program with a postprocessor for this machine"},
    {"M97", "a call of a line of this program (Haas)", "M98 P1000 calls O1000"},
};

static bool is_like(const char *pattern, const char *word)
{
    while (*pattern != '\0' &&
           (*pattern == *word || (*pattern == '?' && isdigit((unsigned char)*word)))) {
        pattern++;
        word++;
    }
    return *pattern == '\0' && *word == '\0';
}

/* The first row that a word is like; NULL: none. */
static const struct moving *moving_of(const char *word)
{
    for (size_t i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        if (is_like(moving[i].word, word))
            return &moving[i];
    }
    return NULL;
}

const char *hint_meaning(const struct diagnostic *d)
{
    const struct moving *row = d->code == TAKT_ERROR_WORD_UNKNOWN ? moving_of(d->word) : NULL;

    return row != NULL ? row->meaning : NULL;
}

static const char *cure_of(const char *word)
{
    const struct moving *row = moving_of(word);

    return row != NULL ? row->cure : NULL;
}

static const char *find(enum takt_error code)
{
    for (size_t i = 0; i < sizeof hints / sizeof hints[0]; i++) {
        if (hints[i].code == code)
            return hints[i].text;
    }
    return NULL;
}

static void write(char text[HINT_MAX], const char *hint)
{
    (void)snprintf(text, HINT_MAX, "    %s\n", hint);
}

/* Codes of the line, such as "G0 and G28". */
static unsigned list_codes(const char *line, size_t length, char *text, size_t size)
{
    static _Thread_local struct line l;
    unsigned count = 0;
    size_t used = 0;

    text[0] = '\0';
    if (!line_read(&l, line, length))
        return 0;
    for (unsigned i = 0; i < l.words; i++) {
        const struct line_word *w = &l.word[i];

        if (line_code(w) >= 0 && used < size)
            used += (size_t)snprintf(text + used, size - used, "%s%.*s", count++ > 0 ? ", " : "",
                                     (int)(w->end - w->begin), &l.text[w->begin]);
    }
    return count;
}

static void write_shared(const char *line, size_t length, char text[HINT_MAX])
{
    char codes[128];

    if (list_codes(line, length, codes, sizeof codes) > 1)
        (void)snprintf(text, HINT_MAX, "    give these codes lines of their own: %s\n", codes);
}

/* A hole along Z of a program for lathes, whose R may be two things. */
static bool is_turned_hole(const struct diagnostic *d, struct line *l, const struct line_word *code)
{
    const int number = line_code(code);

    return d->word[0] == 'Y' && code->letter == 'g' &&
           (number == 730 || (number >= 810 && number <= 890)) && line_find(l, 'r', 0) != NULL;
}

/* The code that stands where the error is. */
static void write_missing(const struct diagnostic *d, const char *line, size_t length, size_t at,
                          char text[HINT_MAX])
{
    static _Thread_local struct line l;

    if (!line_read(&l, line, length))
        return;
    for (unsigned i = 0; i < l.words; i++) {
        const struct line_word *w = &l.word[i];

        if (w->begin > at || at >= w->end)
            continue;
        (void)snprintf(text, HINT_MAX, "    %.*s needs %s on its line\n", (int)(w->end - w->begin),
                       &l.text[w->begin], d->word);
        if (is_turned_hole(d, &l, w))
            (void)snprintf(text, HINT_MAX,
                           "    %.*s drills along Y in G18, along Z in G17; of a lathe of Fanuc or "
                           "Haas say what its R is, to the\n"
                           "    machine file, or as --set codes.R=distance:\n"
                           "    [codes]\n"
                           "    R = distance         (from where the tool is; or: height)\n",
                           (int)(w->end - w->begin), &l.text[w->begin]);
    }
}

/* Characters that only look like others: minus signs and spaces of text processors. */
static const char *look_alike(const unsigned char *c, size_t left)
{
    if (left >= 3 && c[0] == 0xe2 && c[1] == 0x88 && c[2] == 0x92)
        return "this is another character than '-': type it anew";
    if (left >= 3 && c[0] == 0xe2 && c[1] == 0x80 && (c[2] == 0x93 || c[2] == 0x94))
        return "this is a dash of a text processor, not '-': type it anew";
    if (left >= 2 && c[0] == 0xc2 && c[1] == 0xa0)
        return "this is a space of a text processor: type it anew";
    if (left >= 1 && c[0] == ',')
        return "decimals have a point: X1.5";
    if (left >= 1 && c[0] != '\0' && strchr("+-*/", (char)c[0]) != NULL)
        return "calculations stand in brackets: #1 = [#2 + 3], X[#1 * 2]";
    return NULL;
}

/* 0 BEGIN PGM NAME MM */
static bool is_plain_language(const char *line, size_t length)
{
    static _Thread_local struct line l;

    return line_read(&l, line, length) &&
           line_begins(l.text + strspn(l.text, "0123456789 "), "begin pgm ");
}

static void write_character(const char *line, size_t length, size_t at, char text[HINT_MAX])
{
    const char *hint =
        at < length ? look_alike((const unsigned char *)line + at, length - at) : NULL;

    if (hint == NULL && is_plain_language(line, length))
        hint = "this is Heidenhain's plain language: have the program written in G codes (ISO)";
    if (hint != NULL)
        write(text, hint);
}

/* The letter O for the digit 0. */
static void write_number(const char *line, size_t length, size_t at, char text[HINT_MAX])
{
    if (at + 1 < length && line_lower(line[at + 1]) == 'o')
        write(text, "this is the letter O, not the digit 0");
}

/* Only the machine's owner can know what it is for. */
static void write_code(const struct diagnostic *d, char text[HINT_MAX])
{
    struct dialect_code code;

    if (cure_of(d->word) != NULL)
        write(text, cure_of(d->word));
    else if (dialect_code_read(&code, d->word, "ignore") == NULL)
        (void)snprintf(text, HINT_MAX,
                       "    if this machine can do without it, add to the machine file, or as "
                       "--set codes.%s=ignore:\n"
                       "    [codes]\n"
                       "    %s = ignore         (or: stop, output 3 on, subroutine NAME)\n",
                       d->word, d->word);
}

/* LinuxCNC's configuration and signals: _INI[TRAJ]X is a number of the machine file. */
static bool write_value(const struct diagnostic *d, char text[HINT_MAX])
{
    const bool asked = d->code == TAKT_ERROR_PARAMETER_UNDEFINED &&
                       (strncmp(d->word, "_INI[", 5) == 0 || strncmp(d->word, "_HAL[", 5) == 0);

    if (asked)
        (void)snprintf(text, HINT_MAX,
                       "    the machine file answers it, in the letters of the program:\n"
                       "    [values]\n"
                       "    _%c%c%c%s = NUMBER\n",
                       line_lower(d->word[1]), line_lower(d->word[2]), line_lower(d->word[3]),
                       d->word + 4);
    return asked;
}

/* #<_NAME>, which another program may have set. */
static bool write_global(const struct diagnostic *d, char text[HINT_MAX])
{
    const bool asked = d->code == TAKT_ERROR_PARAMETER_UNDEFINED && d->word[0] == '_';

    if (asked)
        (void)snprintf(
            text, HINT_MAX,
            "    set it before; or, if another program sets it, what it has from there, to the "
            "machine file, or as --set values.%s=NUMBER:\n"
            "    [values]\n"
            "    %s = NUMBER\n",
            d->word, d->word);
    return asked;
}

/* #NAME, which the sender puts a number for. */
static bool write_name(const struct diagnostic *d, const char *line, size_t length, size_t at,
                       char text[HINT_MAX])
{
    const bool asked = d->code == TAKT_ERROR_PARAMETER_UNDEFINED && at > 0 && at < length &&
                       line[at - 1] == '#' && line_lower(line[at]) == line_lower(d->word[0]);

    if (asked)
        (void)snprintf(
            text, HINT_MAX,
            "    the number that the program's sender puts here, to the machine file, or "
            "as --set values.%s=0:\n"
            "    [values]\n"
            "    %s = 0\n",
            d->word, d->word);
    return asked;
}

/* T="NAME" of Siemens' controllers. */
static bool write_tool(const struct diagnostic *d, char text[HINT_MAX])
{
    const bool asked =
        d->code == TAKT_ERROR_PARAMETER_UNDEFINED && strncmp(d->word, "TOOL_", 5) == 0;

    if (asked)
        (void)snprintf(text, HINT_MAX,
                       "    the number of the tool of this name, to the machine file, or as "
                       "--set values.%s=1:\n"
                       "    [values]\n"
                       "    %s = 1\n",
                       d->word, d->word);
    return asked;
}

/* U V W of LinuxCNC, which have no axes of their own here. */
static bool write_letter(const struct diagnostic *d, char text[HINT_MAX])
{
    const bool asked = d->code == TAKT_ERROR_AXIS_MISSING && strchr("UVW", d->word[0]) != NULL;

    if (asked)
        (void)snprintf(text, HINT_MAX,
                       "    if an axis of this machine bears another letter, or it can do without, "
                       "add to the machine file, or as --set codes.%c=ignore:\n"
                       "    [codes]\n"
                       "    %c = ignore         (or: A, the axis that it drives)\n",
                       d->word[0], d->word[0]);
    return asked;
}

void hint_write(const struct diagnostic *d, const char *line, size_t length, size_t at,
                char text[HINT_MAX])
{
    const char *hint = find(d->code);

    text[0] = '\0';
    if (write_value(d, text) || write_global(d, text) || write_tool(d, text) ||
        write_name(d, line, length, at, text) || write_letter(d, text))
        return;
    if (d->code == TAKT_ERROR_OWORD_UNCLOSED && !found_word_is_oword(d->word))
        write(text, "its end is missing: ENDIF, ENDLOOP, END1 or what else goes with it");
    else if (hint != NULL)
        write(text, hint);
    else if (d->code == TAKT_ERROR_WORD_UNKNOWN)
        write_code(d, text);
    else if (d->code == TAKT_ERROR_WORD_SHARED || d->code == TAKT_ERROR_WORDS_CONFLICT)
        write_shared(line, length, text);
    else if (d->code == TAKT_ERROR_WORD_MISSING)
        write_missing(d, line, length, at, text);
    else if (d->code == TAKT_ERROR_CHARACTER_UNKNOWN)
        write_character(line, length, at, text);
    else if (d->code == TAKT_ERROR_NUMBER_EXPECTED)
        write_number(line, length, at, text);
}
