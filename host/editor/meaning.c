#include "editor/meaning.h"

#include "words/line.h"

#include <stdint.h>
#include <string.h>

static const struct {
    char letter;
    uint16_t number_x10;
    const char *text;
} codes[] = {
    {'g', 0, "rapid: straight on, every axis as fast as it may"},
    {'g', 10, "straight on at the feed F"},
    {'g', 20, "arc clockwise, around a centre (I J K) or with a radius (R), P turns"},
    {'g', 22, "involute of a circle, clockwise: centre I J K, radius R of the base circle"},
    {'g', 30, "arc counterclockwise, around a centre (I J K) or with a radius (R), P turns"},
    {'g', 32, "involute of a circle, counterclockwise: centre I J K, radius R of the base circle"},
    {'g', 40, "dwell of P seconds"},
    {'g', 50,
     "cubic spline: I J from its start to the first control point, P Q from its end to the second"},
    {'g', 51, "quadratic spline: I J from its start to the control point"},
    {'g', 52, "begins a NURBS of order L: each line gives a control point with its weight P"},
    {'g', 53, "ends the NURBS begun by G5.2"},
    {'g', 62, "NURBS by control points, knots K and weights R; P is its order"},
    {'g', 70, "words of X are diameters"},
    {'g', 80, "words of X are radii"},
    {'g', 100,
     "sets coordinate systems (L2, L20), tools (L1, L10, L11) and their wear (L12), the set-up of "
     "the part (L13)"},
    {'g', 170, "plane XY: arcs, compensation and cycles are in it"},
    {'g', 180, "plane ZX: arcs, compensation and cycles are in it"},
    {'g', 190, "plane YZ: arcs, compensation and cycles are in it"},
    {'g', 200, "lengths are inches"},
    {'g', 210, "lengths are millimetres"},
    {'g', 280, "to the first reference position, by way of the point that is named"},
    {'g', 281, "makes this position the first reference"},
    {'g', 300, "to the second reference position, by way of the point that is named"},
    {'g', 301, "makes this position the second reference"},
    {'g', 330, "thread: straight on, K further with each revolution of the spindle"},
    {'g', 331, "rigid tapping: in and out with the pitch K"},
    {'g', 382, "probes towards contact; without one the program ends"},
    {'g', 383, "probes towards contact"},
    {'g', 384, "probes away from contact; if it stays the program ends"},
    {'g', 385, "probes away from contact"},
    {'g', 400, "cutter compensation off"},
    {'g', 410,
     "cutter compensation, tool to the left of its way: the tool's radius, or that of tool D"},
    {'g', 411, "cutter compensation, tool to the left of its way: diameter D, orientation L"},
    {'g', 420,
     "cutter compensation, tool to the right of its way: the tool's radius, or that of tool D"},
    {'g', 421, "cutter compensation, tool to the right of its way: diameter D, orientation L"},
    {'g', 430, "tool length offset of the tool in the spindle, or of tool H"},
    {'g', 431, "tool length offset as the line says"},
    {'g', 432, "adds the length offset of tool H, or the words of the line"},
    {'g', 490, "tool length offset off"},
    {'g', 520, "offset of the coordinates, beside that of G54 to G59.3"},
    {'g', 530, "this line is in machine coordinates"},
    {'g', 540, "coordinate system 1"},
    {'g', 550, "coordinate system 2"},
    {'g', 560, "coordinate system 3"},
    {'g', 570, "coordinate system 4"},
    {'g', 580, "coordinate system 5"},
    {'g', 590, "coordinate system 6"},
    {'g', 591, "coordinate system 7"},
    {'g', 592, "coordinate system 8"},
    {'g', 593, "coordinate system 9"},
    {'g', 610, "exact path: every corner is met"},
    {'g', 611, "exact stop: rests at the end of each line"},
    {'g', 640,
     "smoothed path, within P of the programmed one; Q: of points nearer than this to a line some "
     "are left out"},
    {'g', 700, "turning: finishes the profile of subroutine Q in P passes from D to E"},
    {'g', 710, "turning: roughs the profile of subroutine Q in cuts of depth I along Z, leaving D"},
    {'g', 711, "turning: G71 without pockets"},
    {'g', 712, "turning: the pockets that G71.1 leaves"},
    {'g', 720, "turning: roughs the profile of subroutine Q in cuts of depth I along X, leaving D"},
    {'g', 721, "turning: G72 without pockets"},
    {'g', 722, "turning: the pockets that G72.1 leaves"},
    {'g', 730, "drilling that breaks chips: bites of Q, D back after each"},
    {'g', 740, "tapping, left-hand: feed in, turn round, feed out"},
    {'g', 760,
     "threading: P pitch, Z its end, I outer thread, J first cut, K depth, Q angle, H spring cuts, "
     "E L tapers"},
    {'g', 800, "ends cycles: no motion is in effect"},
    {'g', 810, "drilling: feed to Z, rapid back"},
    {'g', 820, "drilling with a dwell of P seconds at Z"},
    {'g', 830, "deep drilling: bites of Q, out of the hole after each, back to D above the last"},
    {'g', 840, "tapping: feed in, turn round, feed out"},
    {'g', 850, "boring: feed to Z and back"},
    {'g', 860, "boring: feed to Z, P seconds, spindle stops, rapid back"},
    {'g', 870, "back boring: aside by I J with an oriented spindle, down, up to K"},
    {'g', 880, "boring: feed to Z, P seconds, spindle and program stop"},
    {'g', 890, "boring: feed to Z, P seconds, feed back"},
    {'g', 900, "axis words are positions"},
    {'g', 901, "I J K are positions"},
    {'g', 910, "axis words are distances from where the tool is"},
    {'g', 911, "I J K are distances from the start"},
    {'g', 920, "this point has the coordinates that the line says"},
    {'g', 921, "offset of G92 off, and 0"},
    {'g', 922, "offset of G92 off; it is kept for G92.3"},
    {'g', 923, "offset of G92 as it was before G92.2"},
    {'g', 930, "F is one over the minutes that the line takes"},
    {'g', 940, "F is per minute"},
    {'g', 950, "F is per revolution of the spindle"},
    {'g', 960, "constant surface speed: S is m/min (feet/min), D the highest rev/min"},
    {'g', 970, "S is rev/min"},
    {'g', 980, "cycles go back to the height they began at"},
    {'g', 990, "cycles go back to R"},
    {'m', 0, "stop: the program waits for the operator"},
    {'m', 10, "optional stop: waits if the operator wants it"},
    {'m', 20, "end of the program"},
    {'m', 30, "spindle clockwise at S"},
    {'m', 40, "spindle counterclockwise at S"},
    {'m', 50, "spindle stops"},
    {'m', 60, "changes to the tool that T has selected"},
    {'m', 70, "mist on"},
    {'m', 80, "flood on"},
    {'m', 90, "coolant off"},
    {'m', 190, "spindle turns to R degrees and stays; P how, Q seconds to wait"},
    {'m', 300, "end of the program"},
    {'m', 480, "overrides of feed and spindle on"},
    {'m', 490, "overrides of feed and spindle off"},
    {'m', 500, "feed override on; P0: off"},
    {'m', 510, "spindle override on; P0: off"},
    {'m', 520, "adaptive feed on; P0: off"},
    {'m', 530, "feed hold allowed; P0: not"},
    {'m', 600, "stop, for a change of pallets"},
    {'m', 610, "says which tool is in the spindle: that of the last change, or Q"},
    {'m', 620, "digital output P on, with the next motion"},
    {'m', 630, "digital output P off, with the next motion"},
    {'m', 640, "digital output P on"},
    {'m', 650, "digital output P off"},
    {'m', 660,
     "waits for the digital input P or the analogue input E as L says, at most Q seconds"},
    {'m', 670, "analogue output E is Q, with the next motion"},
    {'m', 680, "analogue output E is Q"},
    {'m', 700, "saves the modes"},
    {'m', 710, "forgets saved modes"},
    {'m', 720, "the modes as they were saved"},
    {'m', 730, "saves the modes until the end of this call"},
    {'m', 980, "calls the program with the number P, L times"},
    {'m', 990, "back to the caller; in the main program: from its beginning again"},
    {'m', 1200, "layer P of the position-error correction on"},
    {'m', 1210, "layer P of the position-error correction off"},
};

static const struct {
    char letter;
    const char *text;
} letters[] = {
    {'a', "position of the rotary axis A, degrees"},
    {'b', "position of the rotary axis B, degrees"},
    {'c', "position of the rotary axis C, degrees"},
    {'d', "a diameter, a tool for its radius, or a distance, as the code says"},
    {'e', "an analogue channel, or a distance, as the code says"},
    {'f', "feed: along the path, as G93, G94 and G95 say"},
    {'h', "a tool, for its length; of G76 the number of spring cuts"},
    {'i', "centre of an arc along X; else as the code says"},
    {'j', "centre of an arc along Y; else as the code says"},
    {'k', "centre of an arc along Z; the pitch of a thread; else as the code says"},
    {'l', "how often, or which, as the code says"},
    {'n', "number of the line, which means nothing"},
    {'o', "an O-word: branches, loops and subroutines"},
    {'p', "seconds, turns, a number or a tolerance, as the code says"},
    {'q', "as the code says"},
    {'r', "radius of an arc; the height cycles retract to; else as the code says"},
    {'s', "speed of the spindle, rev/min; with G96 along the surface"},
    {'t', "selects a tool; M6 changes to it"},
    {'x', "position or distance along X"},
    {'y', "position or distance along Y"},
    {'z', "position or distance along Z"},
    {'@', "distance from the origin (polar coordinates)"},
    {'^', "angle around the origin, degrees (polar coordinates)"},
};

static const struct {
    const char *word; /* none is the beginning of a later one */
    const char *text;
} flow[] = {
    {"endsub", "end of a subroutine; a value in brackets is #<_value> of its caller"},
    {"sub", "begins a subroutine; its arguments are #1, #2 …"},
    {"return", "back to the caller"},
    {"call", "runs a subroutine with the arguments in brackets"},
    {"elseif", "goes on here if no condition before holds and this one does"},
    {"else", "goes on here if no condition before holds"},
    {"endif", "end of what depends on the conditions"},
    {"if", "goes on if the condition holds (is not 0)"},
    {"endwhile", "back to the condition of the loop"},
    {"while", "repeats as long as the condition holds; behind DO: the end of its loop"},
    {"do", "begins a loop that ends with WHILE"},
    {"endrepeat", "end of what is repeated"},
    {"repeat", "repeats so many times"},
    {"break", "leaves the loop"},
    {"continue", "on with the next round of the loop"},
};

const char *meaning_of_code(char letter, unsigned number_x10)
{
    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        if (codes[i].letter == letter && codes[i].number_x10 == number_x10)
            return codes[i].text;
    }
    return NULL;
}

const char *meaning_of_letter(char letter)
{
    for (size_t i = 0; i < sizeof letters / sizeof letters[0]; i++) {
        if (letters[i].letter == letter)
            return letters[i].text;
    }
    return NULL;
}

const char *meaning_of_flow(const char *text, size_t *length)
{
    for (size_t i = 0; i < sizeof flow / sizeof flow[0]; i++) {
        *length = strlen(flow[i].word);
        if (line_begins(text, flow[i].word))
            return flow[i].text;
    }
    return NULL;
}
