/*
 * Drilling cycles of Siemens' language (siemens.c).
 */
#include "siemens/scan.h"

#include <stdio.h>
#include <string.h>

/*
 * Return height, reference, safety above it, depth, depth below the reference; then a dwell, or the
 * first peck and the rest.
 */
static void drill(struct scan *s, const char *name, char text[TRANSLATE_CALL_MAX])
{
    char a[SCAN_ARGUMENTS][48] = {{0}};
    const unsigned count = scan_arguments(s, a);
    const bool relative = a[3][0] == '\0';
    const char *dwell = count > 5 && a[5][0] != '\0' ? a[5] : "0";

    s->failed = s->failed || count < 4 || a[0][0] == '\0' || a[1][0] == '\0' ||
                (relative && a[4][0] == '\0');
    if (s->failed)
        return;
    if (a[2][0] == '\0')
        (void)snprintf(a[2], sizeof a[2], "0");
    const int at =
        snprintf(text, TRANSLATE_CALL_MAX, "G98 G%s R[%s+%s] Z[%s%s%s]",
                 strcmp(name, "CYCLE83") == 0   ? "83"
                 : strcmp(name, "CYCLE82") == 0 ? "82"
                                                : "81",
                 a[1], a[2], relative ? a[1] : "", relative ? "-" : "", relative ? a[4] : a[3]);

    if (strcmp(name, "CYCLE82") == 0)
        (void)snprintf(text + at, TRANSLATE_CALL_MAX - (size_t)at, " P[%s]", dwell);
    /* pecks are as deep as the first one: an absolute depth, or one below the reference */
    if (strcmp(name, "CYCLE83") == 0 && a[5][0] != '\0')
        (void)snprintf(text + at, TRANSLATE_CALL_MAX - (size_t)at, " Q[ABS[%s-%s]]", a[1], a[5]);
    else if (strcmp(name, "CYCLE83") == 0)
        (void)snprintf(text + at, TRANSLATE_CALL_MAX - (size_t)at, " Q[ABS[%s]]", a[6]);
    translate_add(&s->t->behind, "G0 Z%s", a[0]);
}

static bool is_drilling(const char *name)
{
    return strcmp(name, "CYCLE81") == 0 || strcmp(name, "CYCLE82") == 0 ||
           strcmp(name, "CYCLE83") == 0;
}

/* Here and now, at X and Y where the tool is; or at every place from the next line on (MCALL). */
bool siemens_cycle(struct scan *s, const char *name)
{
    struct translator *t = s->t;
    char cycle[NAME_MAX_];
    char text[TRANSLATE_CALL_MAX];
    const bool modal = strcmp(name, "MCALL") == 0;

    if (modal && scan_is_end(s)) {
        (void)line_read(&t->line, "", 0);
        if (t->modal_call[0] != '\0')
            translate_add(&t->behind, "G80 G0");
        t->modal_call[0] = '\0';
        return true;
    }
    (void)snprintf(cycle, sizeof cycle, "%s", name);
    if (modal && !scan_name(s, cycle))
        return false;
    if (!is_drilling(cycle))
        return false;
    drill(s, cycle, text);
    if (s->failed)
        return true;
    (void)line_read(&t->line, "", 0);
    if (modal)
        memcpy(t->modal_call, text, sizeof text);
    else
        translate_add(&t->behind, "%s X#<_x> Y#<_y>", text);
    if (!modal)
        translate_add(&t->behind, "G80 G0");
    return true;
}

/*
 * With MCALL a place is a hole, also one that a rotary axis leads to: the cycle itself has no words
 * for it.
 */
void siemens_drill(struct scan *s)
{
    struct translator *t = s->t;
    struct line l;
    bool turns = false;

    if (t->modal_call[0] == '\0' || !line_read(&l, s->out, s->length) || !line_has_axis(&l))
        return;
    for (unsigned i = 0; i < l.words; i++) {
        turns = turns || strchr("abc", l.word[i].letter) != NULL;
        if (line_code(&l.word[i]) == 0 || line_code(&l.word[i]) == 10)
            line_blank(&l, &l.word[i]);
    }
    s->length = 0;
    if (turns) {
        scan_put(s, "G0 %s", l.text);
        translate_add(&t->behind, "%s X#<_x> Y#<_y>", t->modal_call);
    } else {
        scan_put(s, "%s %s", l.text, t->modal_call);
    }
}
