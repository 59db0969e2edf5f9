/*
 * A random program of everything that takt correct writes, in all planes, units and coordinate
 * systems, by its seed.
 */
#ifndef TAKT_TESTS_OFFLINE_PROGRAM_H
#define TAKT_TESTS_OFFLINE_PROGRAM_H

#include "base/maths.h"
#include "unity.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define MOTIONS  24
#define TEXT_MAX 65536

/* Positions stay within the table of errors. */
#define REACH_MM 180.0

static uint64_t state;
static char text[TEXT_MAX];
static size_t length;

/* xorshift64*: S. Vigna, 2016. */
static inline double uniform(double low, double high)
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return low + (high - low) * (double)((state * UINT64_C(0x2545F4914F6CDD1D)) >> 11) * 0x1p-53;
}

static inline unsigned below(unsigned count)
{
    return (unsigned)uniform(0.0, count - 1e-9);
}

__attribute__((format(printf, 1, 2))) static inline void say(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    length += (size_t)vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
    TEST_ASSERT_TRUE(length < sizeof text);
}

/* What the program being written is in. */
static struct {
    unsigned plane; /* first axis: 0 XY, 2 ZX, 1 YZ */
    double unit_mm;
    bool incremental;
    bool turned;     /* G17 alone */
    double at_mm[3]; /* work coordinates */
} now;

static inline void say_axes(const double to_mm[3])
{
    for (unsigned i = 0; i < 3; i++)
        say(" %c%.9f", AXIS_LETTERS[i],
            (to_mm[i] - (now.incremental ? now.at_mm[i] : 0.0)) / now.unit_mm);
    memcpy(now.at_mm, to_mm, sizeof now.at_mm);
}

static inline void say_line(const char *code)
{
    double to_mm[3];

    for (unsigned i = 0; i < 3; i++)
        to_mm[i] = uniform(-REACH_MM / 2, REACH_MM / 2);
    say("%s", code);
    say_axes(to_mm);
    say(below(4) == 0 ? " (on) F%d\n" : "\n", 500 + (int)below(1000));
}

/* Goes to a place near the middle first, so that the curve stays inside. */
static inline void say_approach(double u, double v)
{
    double to_mm[3];

    for (unsigned i = 0; i < 3; i++)
        to_mm[i] = uniform(-30, 30);
    to_mm[now.plane] = u;
    to_mm[(now.plane + 1) % 3] = v;
    say("G1");
    say_axes(to_mm);
    say("\n");
}

static inline void say_end(double u, double v)
{
    double to_mm[3];

    memcpy(to_mm, now.at_mm, sizeof to_mm);
    to_mm[now.plane] = u;
    to_mm[(now.plane + 1) % 3] = v;
    to_mm[(now.plane + 2) % 3] += below(2) == 0 ? 0.0 : uniform(-20, 20);
    say_axes(to_mm);
}

static inline void say_centre(double u, double v)
{
    say(" %c%.9f %c%.9f", 'I' + (char)now.plane, u / now.unit_mm, 'I' + (char)((now.plane + 1) % 3),
        v / now.unit_mm);
}

static inline void say_arc(void)
{
    const double radius = uniform(0.5, 60), from = uniform(-3, 3), to = uniform(-3, 3);
    const double cu = uniform(-30, 30), cv = uniform(-30, 30);

    say_approach(cu + radius * cos(from), cv + radius * sin(from));
    say(below(2) == 0 ? "G2" : "G3");
    say_end(cu + radius * cos(to), cv + radius * sin(to));
    say_centre(-radius * cos(from), -radius * sin(from));
    say(below(3) == 0 ? " (round)\n" : "\n");
}

static inline void string_end(double r, double hand, double heading, double phi, double at[2])
{
    at[0] = r * (cos(heading + hand * phi) + hand * phi * sin(heading + hand * phi));
    at[1] = r * (sin(heading + hand * phi) - hand * phi * cos(heading + hand * phi));
}

static inline void say_involute(void)
{
    const double r = exp(uniform(log(0.3), log(10))), turns = 60 / r;
    const double from = below(3) == 0 ? 0.0 : uniform(0, turns);
    const double to = from + (from < turns / 2 ? 1 : -1) * uniform(0.3, turns / 2);
    const double hand = below(2) == 0 ? 1 : -1, heading = uniform(-3, 3);
    double a[2], b[2];

    string_end(r, hand, heading, from, a);
    string_end(r, hand, heading, to, b);
    say_approach(a[0], a[1]);
    say((hand > 0) == (to > from) ? "G3.2" : "G2.2");
    say_end(b[0], b[1]);
    say_centre(-a[0], -a[1]);
    say(" R%.9f\n", r / now.unit_mm);
}

/* A hole with the spindle on, and back to what the others expect. */
static inline void say_cycle(void)
{
    static const char *const codes[] = {"G81", "G82 P0.1", "G83 Q5",   "G84 P0.1",
                                        "G85", "G86 P0.1", "G89 P0.1", "G73 Q5"};
    const char *const code = codes[below(8)];
    const double top = uniform(10, 20), bottom = top - uniform(2, 20);
    double to_mm[3] = {uniform(-80, 80), uniform(-80, 80), 40};
    const bool incremental = now.incremental;

    say("G17 G90 M3 S300\nG1");
    now.incremental = false;
    say_axes(to_mm);
    say("\n%s X%.9f Y%.9f Z%.9f R%.9f (hole)\n", code, to_mm[0] / now.unit_mm,
        to_mm[1] / now.unit_mm, bottom / now.unit_mm, top / now.unit_mm);
    say("G80 M5 %s\n", incremental ? "G91" : "");
    now.incremental = incremental;
    now.plane = 0;
}

/* Offsets that are set where the machine stands; 'now' counts on with the coordinates they give. */
static inline void say_offset(void)
{
    const double x = uniform(-20, 20);

    say(below(2) == 0 ? "G92 X%.9f\n" : "G10 L20 P0 X%.9f\n", x / now.unit_mm);
    now.at_mm[0] = x;
}

/* A thread, or a tapped hole. */
static inline void say_thread(void)
{
    double to_mm[3] = {uniform(-50, 50), uniform(-50, 50), uniform(-50, 50)};
    double before_mm[3];

    memcpy(before_mm, now.at_mm, sizeof before_mm);
    say("M3 S300\n");
    say(below(2) == 0 ? "G33" : "G33.1 (tap)");
    say_axes(to_mm);
    say(" K%.6f\nM5\n", 1.25 / now.unit_mm);
    if (strstr(text + length - 120, "(tap)") != NULL)
        memcpy(now.at_mm, before_mm, sizeof before_mm);
}

static inline void say_change(void)
{
    static const char *const planes[] = {"G17", "G19", "G18"};

    now.plane = now.turned ? 0 : below(3);
    say("%s", planes[now.plane]);
    now.unit_mm = below(3) == 0 ? 25.4 : 1.0;
    say(now.unit_mm > 1.0 ? " G20 F%d" : " G21 F%d", now.unit_mm > 1.0 ? 20 : 600);
    now.incremental = below(3) == 0;
    say(now.incremental ? " G91" : " G90");
    say(" (change)\n");
}

static inline void say_motion(unsigned what)
{
    switch (what) {
    case 0:
        say_line("G0");
        break;
    case 1:
        say_arc();
        break;
    case 2:
    case 3:
        say_involute();
        break;
    case 4:
        say_cycle();
        break;
    case 5:
        say_offset();
        break;
    case 6:
        say_change();
        break;
    case 7:
        say_thread();
        break;
    default:
        say_line("G1");
    }
}

static inline void say_program(unsigned seed)
{
    state = UINT64_C(0x9E3779B97F4A7C15) * (seed + 1);
    length = 0;
    memset(&now, 0, sizeof now);
    now.unit_mm = 1.0;
    say("(program %u)\nG21 G90 G17 G61 F600\n", seed);
    now.turned = below(4) == 0;
    say("G10 L2 P1 X%.3f Y%.3f Z%.3f R%.3f\nG54\n", uniform(-20, 20), uniform(-20, 20),
        uniform(-20, 20), now.turned ? uniform(-90, 90) : 0.0);
    say_line("G0");
    for (unsigned i = 0; i < MOTIONS; i++)
        say_motion(below(10));
    say("M2\n");
}

#endif
