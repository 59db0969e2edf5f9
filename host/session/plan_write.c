#include "session/plan_write.h"

#include "session/planner.h"

#include "base/maths.h"

#include <assert.h>
#include <cjson/cJSON.h>
#include <stdlib.h>

/* What is shown of a block; the pieces of a smoothed curve that belong to one motion are one. */
struct plan_row {
    uint32_t first, last; /* motions that became it: several where short ones were merged */
    uint32_t line;
    enum move_kind kind;
    bool motion;
    bool rotary;
    unsigned pieces;                          /* of a smoothed curve; 0: the programmed curve */
    double length;                            /* mm or rad */
    double feed_start, feed_cruise, feed_end; /* along the curve, mm/s or rad/s */
    enum junction_kind end;
    enum governor governor;
    double governed_s; /* time of the longest piece, which it is the governor of */
    double time_s;
};

struct plan_print {
    FILE *table; /* NULL: no table */
    FILE *json;  /* NULL: no JSON */
    double cycle_s;
    bool any;            /* a block has been written: JSON needs a comma */
    uint32_t shown;      /* number of the last motion written */
    bool open;           /* there is a row that may still grow */
    struct plan_row row; /* that one */
    uint32_t moves;      /* of the program */
    double length_mm;    /* of the curves written; motions of rotary axes alone do not count */
};

static const char *kind_name(enum move_kind kind)
{
    static const char *const names[] = {
        "rapid",   "feed",   "arc_cw",  "arc_ccw", "involute_cw", "involute_ccw",
        "spline",  "thread", "tap",     "tap_out", "probe",       "dwell",
        "spindle", "orient", "coolant", "tool",    "output",      "input",
        "wear",    "setup",  "stop",    "end"};

    static_assert(sizeof names / sizeof names[0] == MOVE_END + 1, "a name for every kind");
    return names[kind];
}

static const char *governor_name(enum governor governor)
{
    static const char *const names[] = {"program", "velocity", "acceleration", "jerk",
                                        "chord",   "smooth",   "short",        "ramp"};

    return names[governor];
}

static const char *end_name(enum junction_kind end)
{
    static const char *const names[] = {"passed", "reduced", "stop"};

    return names[end];
}

/* Places on a smoothed piece at which its length is looked at. */
#define PIECE_PARTS 8

/*
 * |dx/ds| over linear axes, or rotary ones when only those move: 1 but for a smoothed piece, whose
 * s is nominal time.
 */
static double stretch_at(const struct block *block, double part)
{
    const int from = block->curve.rotary ? AXIS_LINEAR_COUNT : 0;
    const int to = block->curve.rotary ? AXIS_COUNT : AXIS_LINEAR_COUNT;
    struct point tangent;
    double square = 0;

    if (block->curve.kind != CURVE_SPLINE)
        return 1;
    takt_curve_tangent(&block->curve, part * block->curve.length_mm, &tangent);
    for (int axis = from; axis < to; axis++)
        square += tangent.at[axis] * tangent.at[axis];
    return maths_sqrt(square);
}

static double mean_stretch(const struct block *block)
{
    double sum = 0;

    for (int i = 0; i < PIECE_PARTS; i++)
        sum += stretch_at(block, (i + 0.5) / PIECE_PARTS);
    return sum / PIECE_PARTS;
}

static struct plan_row row_of(const struct plan_print *print, const struct planned_block *planned)
{
    const struct block *block = planned->block;
    struct plan_row row = {
        .line = block->move.line,
        .kind = block->move.kind,
        .motion = block_is_motion(block),
        .time_s = planned->time_s,
    };

    if (!row.motion)
        return row;
    row.last = block->number;
    row.first = print->shown < row.last ? print->shown + 1 : row.last;
    row.rotary = block->curve.rotary;
    row.pieces = block->curve.kind == CURVE_SPLINE ? 1 : 0;
    row.length = block->curve.length_mm * mean_stretch(block);
    row.feed_start = planned->feed_start_mm_s;
    row.feed_cruise = planned->feed_cruise_mm_s;
    row.feed_end = planned->feed_end_mm_s;
    row.end = block->end;
    row.governor = planned->governor;
    row.governed_s = planned->time_s;
    return row;
}

/* The next piece of the same motion. */
static void row_grow(struct plan_row *row, const struct plan_row *next)
{
    if (next->governed_s > row->governed_s) {
        row->governor = next->governor;
        row->governed_s = next->governed_s;
    }
    row->pieces += next->pieces;
    row->length += next->length;
    row->feed_cruise = maths_max(row->feed_cruise, next->feed_cruise);
    row->feed_end = next->feed_end;
    row->end = next->end;
    row->time_s += next->time_s;
}

/* mm/s to mm/min; of a motion of rotary axes alone rad/s to deg/min. */
static double shown_feed(const struct plan_row *row, double feed_mm_s)
{
    return feed_mm_s * 60.0 * (row->rotary ? 180.0 / MATHS_PI : 1.0);
}

static double shown_length(const struct plan_row *row)
{
    return row->length * (row->rotary ? 180.0 / MATHS_PI : 1.0);
}

static const char *length_unit(const struct plan_row *row)
{
    return row->rotary ? "deg" : "mm";
}

static void table_head(FILE *stream)
{
    (void)fprintf(stream, "%11s %7s  %-8s %14s %10s %10s %10s  %-8s %-13s %10s %7s\n", "block",
                  "line", "kind", "length", "F start", "F cruise", "F end", "end", "governor",
                  "time [s]", "pieces");
}

static void number_text(const struct plan_row *row, char *text, size_t size)
{
    if (row->first < row->last)
        (void)snprintf(text, size, "%u-%u", (unsigned)row->first, (unsigned)row->last);
    else
        (void)snprintf(text, size, "%u", (unsigned)row->last);
}

static void table_row(FILE *stream, const struct plan_row *row)
{
    char number[24];

    if (!row->motion) {
        (void)fprintf(stream, "%11s %7u  %-8s %70s %10.6f\n", "-", (unsigned)row->line,
                      kind_name(row->kind), "", row->time_s);
        return;
    }
    number_text(row, number, sizeof number);
    (void)fprintf(stream, "%11s %7u  %-8s %10.6f %-3s %10.3f %10.3f %10.3f  %-8s %-13s %10.6f",
                  number, (unsigned)row->line, kind_name(row->kind), shown_length(row),
                  length_unit(row), shown_feed(row, row->feed_start),
                  shown_feed(row, row->feed_cruise), shown_feed(row, row->feed_end),
                  end_name(row->end), governor_name(row->governor), row->time_s);
    if (row->pieces > 0)
        (void)fprintf(stream, " %7u", row->pieces);
    (void)fputc('\n', stream);
}

static void json_feeds(FILE *stream, const struct plan_row *row)
{
    const char *unit = length_unit(row);

    (void)fprintf(stream,
                  ", \"block_first\": %u, \"pieces\": %u, \"length_%s\": %.17g, "
                  "\"feed_start_%s_min\": %.17g, "
                  "\"feed_cruise_%s_min\": %.17g, \"feed_end_%s_min\": %.17g, \"end\": \"%s\", "
                  "\"governor\": \"%s\"",
                  (unsigned)row->first, row->pieces, unit, shown_length(row), unit,
                  shown_feed(row, row->feed_start), unit, shown_feed(row, row->feed_cruise), unit,
                  shown_feed(row, row->feed_end), end_name(row->end), governor_name(row->governor));
}

static void json_row(const struct plan_print *print, const struct plan_row *row)
{
    (void)fprintf(print->json, "%s\n    {\"block\": %u, \"line\": %u, \"kind\": \"%s\"",
                  print->any ? "," : "", (unsigned)row->last, (unsigned)row->line,
                  kind_name(row->kind));
    if (row->motion)
        json_feeds(print->json, row);
    (void)fprintf(print->json, ", \"time_s\": %.17g}", row->time_s);
}

/* Writes the row that is open. */
static void print_row(struct plan_print *print)
{
    if (!print->open)
        return;
    if (print->table != NULL)
        table_row(print->table, &print->row);
    if (print->json != NULL)
        json_row(print, &print->row);
    print->any = true;
    print->open = false;
    print->length_mm += print->row.rotary ? 0 : print->row.length;
    if (print->row.motion)
        print->shown = print->row.last;
}

static void take_block(void *context, const struct planned_block *planned)
{
    struct plan_print *print = context;
    const struct plan_row row = row_of(print, planned);

    if (print->open && row.pieces > 0 && print->row.pieces > 0 && row.last == print->row.last) {
        row_grow(&print->row, &row);
        return;
    }
    print_row(print);
    print->row = row_of(print, planned);
    print->open = true;
}

static void print_totals(const struct plan_print *print, const struct planner_totals *totals)
{
    double time_s = (double)totals->cycles * print->cycle_s;

    if (print->table != NULL)
        (void)fprintf(print->table, "%u moves, %.6f mm, %u stops, %.3f s\n", (unsigned)print->moves,
                      print->length_mm, (unsigned)totals->stops, time_s);
    if (print->json != NULL)
        (void)fprintf(print->json,
                      "\n  ],\n  \"totals\": {\"moves\": %u, \"length_mm\": %.17g, \"stops\": %u, "
                      "\"cycles\": %llu, "
                      "\"time_s\": %.17g}\n}\n",
                      (unsigned)print->moves, print->length_mm, (unsigned)totals->stops,
                      (unsigned long long)totals->cycles, time_s);
}

static void print_heads(const struct plan_print *print, const struct session *session)
{
    cJSON *name = cJSON_CreateString(session->program.name);
    char *quoted = name != NULL ? cJSON_PrintUnformatted(name) : NULL;

    if (print->table != NULL)
        table_head(print->table);
    if (print->json != NULL)
        (void)fprintf(print->json, "{\n  \"program\": %s,\n  \"blocks\": [",
                      quoted != NULL ? quoted : "null");
    free(quoted);
    cJSON_Delete(name);
}

enum command_status plan_write(const struct session *session, const struct session_totals *found,
                               FILE *table, FILE *json)
{
    struct plan_print print = {
        .table = table,
        .json = json,
        .cycle_s = machine_cycle_s(&session->setup.machine),
        .moves = found->curves,
    };
    struct planner_totals totals;
    enum command_status status;

    print_heads(&print, session);
    status = planner_walk(
        session, &(struct planner_listener){.context = &print, .take = take_block}, &totals);
    if (status != STATUS_DONE)
        return status;
    print_row(&print);
    print_totals(&print, &totals);
    return STATUS_DONE;
}
