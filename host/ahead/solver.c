#include "ahead/solver.h"

#include "ahead/crew.h"
#include "ahead/excess.h"
#include "ahead/warp.h"
#include "base/maths.h"
#include "convex/interior.h"

#include <stdlib.h>
#include <string.h>

/* Intervals of a window, and the longest: what is left at a trajectory's end joins the last. */
#define WINDOW     2000
#define WINDOW_MAX (WINDOW + WINDOW / 2)

/* What a step may use of the tolerance, so that between half knots it is kept as well. */
#define INSIDE 0.97

/* Steps of changes of the curve alone that a repair takes; repairs before the solver gives up. */
#define POLISH_STEPS 3
#define REPAIRS_MAX  12

/*
 * The rounds end when so many in a row, with windows cut both ways, each change less than this part
 * of the time; the first ones bring the guess within the limits and say nothing.
 */
#define FIRST_ROUNDS 2
#define STILL_ROUNDS 2
#define STILL_PART   3e-4

/* A trajectory that has grown beyond so many times what is of use in a round is not waited for. */
#define ROUND_GROWTH 2

/*
 * Intervals before and behind those to be repaired that are worked on; of a slow-down before and
 * behind its middle.
 */
#define MARGIN      120
#define SLOW_MARGIN 24

/* From this repair on time is added, with e between these. */
#define SLOW_FROM  2
#define SLOW_LEAST 1e-3
#define SLOW_MOST  0.3

enum job_kind { JOB_KEEP, JOB_ROUND, JOB_REPAIR };

/* A stretch of the trajectory and what becomes of it. */
struct job {
    enum job_kind kind;
    size_t first;
    size_t intervals;
    struct trail result;
};

/* What one core works with. */
struct bench {
    struct interior *interior;
    struct problem problem;
    double (*slow)[4];
};

struct solver {
    unsigned workers;
    struct bench bench[CREW_MAX];
    const struct ahead_path *path;
    const struct ahead_limits *limits;
    struct trail *trail;
    struct job *job;
    size_t jobs;
    size_t jobs_max;
    unsigned repair;
    double stuck_mm;
    size_t longest; /* a trajectory of more intervals is of no use */
    bool stopped;
    bool (*progress)(void *context, double part);
    void *context;
    double part_done; /* of all the work, before this round */
    double part_round;
    size_t done; /* jobs of the first core in this round */
};

static bool bench_allocate(struct bench *b, const struct ahead_modes *modes)
{
    b->interior = interior_new(WINDOW_MAX, modes->count, modes->strays);
    b->problem.cell = calloc(WINDOW_MAX, sizeof *b->problem.cell);
    b->problem.map = modes->count > 0 ? calloc(WINDOW_MAX, sizeof *b->problem.map) : NULL;
    b->problem.stray = modes->strays > 0 ? calloc(WINDOW_MAX, sizeof *b->problem.stray) : NULL;
    b->slow = calloc(WINDOW_MAX, sizeof *b->slow);
    return b->interior != NULL && b->problem.cell != NULL && b->slow != NULL &&
           (modes->count == 0 || b->problem.map != NULL) &&
           (modes->strays == 0 || b->problem.stray != NULL);
}

static void bench_free(struct bench *b)
{
    interior_free(b->interior);
    free(b->problem.cell);
    free(b->problem.map);
    free(b->problem.stray);
    free(b->slow);
}

struct solver *solver_new(unsigned workers, const struct ahead_modes *modes)
{
    struct solver *s = calloc(1, sizeof *s);
    bool done = s != NULL;

    if (!done)
        return NULL;
    s->workers = workers < 1 ? 1 : workers > CREW_MAX ? CREW_MAX : workers;
    for (unsigned i = 0; i < s->workers; i++)
        done = bench_allocate(&s->bench[i], modes) && done;
    if (done)
        return s;
    solver_free(s);
    return NULL;
}

void solver_free(struct solver *s)
{
    if (s == NULL)
        return;
    for (unsigned i = 0; i < s->workers; i++)
        bench_free(&s->bench[i]);
    free(s->job);
    free(s);
}

double solver_stuck_mm(const struct solver *s)
{
    return s->stuck_mm;
}

/* One step on the whole of a piece. */
static bool step(struct bench *b, const struct window *w, size_t cells, bool timed,
                 struct trail *result)
{
    b->problem.cells = cells;
    b->problem.timed = timed;
    window_build(&b->problem, w);
    return warp_window(w, cells, interior_solve(b->interior, &b->problem), timed, result);
}

static bool copy_piece(const struct solver *s, size_t first, size_t intervals, struct trail *to)
{
    const struct trail *from = s->trail;

    if (!trail_allocate(to, intervals, from->modes))
        return false;
    memcpy(to->control, from->control + first,
           (intervals + trail_ends(from->modes)) * sizeof *to->control);
    memcpy(to->place_mm, from->place_mm + 2 * first, (2 * intervals + 1) * sizeof *to->place_mm);
    trail_continue(to, from, first, intervals);
    trail_follow(to, &s->limits->modes);
    return true;
}

static double measure(struct bench *b, const struct window *w)
{
    b->problem.cells = w->trail->intervals;
    window_build(&b->problem, w);
    return excess_measure(w, &b->problem);
}

/*
 * By how much an interval is passed more slowly: enough for its velocity, e = -2 (beyond - 1), and
 * twice as much in every repair.
 */
static double slowness(const struct solver *s, double beyond)
{
    const double least = maths_max(2 * (beyond - 1), SLOW_LEAST);

    return maths_min(least * (double)(UINT32_C(1) << (s->repair - SLOW_FROM)), SLOW_MOST);
}

/* e around every interval that is beyond its limits. */
static void slow_down(const struct solver *s, struct bench *b, const struct trail *piece)
{
    const size_t cells = piece->intervals;
    const size_t ends = trail_ends(piece->modes);

    memset(b->slow, 0, cells * sizeof *b->slow);
    for (size_t i = 0; i < cells; i++) {
        if (piece->beyond[i] <= 1)
            continue;
        const double low = slowness(s, piece->beyond[i]);

        for (size_t k = i > SLOW_MARGIN ? i - SLOW_MARGIN : 0; k < i + SLOW_MARGIN; k++) {
            const double x = ((double)k - (double)i) / SLOW_MARGIN;
            const double bump = (1 - x * x) * (1 - x * x);

            const size_t point = k + piece->modes;

            if (point >= ends && point < cells)
                b->slow[point - ends][3] = maths_min(b->slow[point - ends][3], -low * bump);
        }
    }
}

/* Replaces a piece by what a change of time makes of it. */
static bool replace_slower(const struct solver *s, struct bench *b, struct trail *piece)
{
    const struct window w = {s->path, s->limits, piece, 0, INSIDE};
    struct trail slower;

    (void)measure(b, &w);
    slow_down(s, b, piece);
    if (!warp_window(&w, piece->intervals, b->slow, true, &slower))
        return false;
    trail_free(piece);
    *piece = slower;
    return true;
}

/* Changes of the curve alone, as long as they help. */
static bool polish(const struct solver *s, struct bench *b, struct trail *piece)
{
    struct window w = {s->path, s->limits, piece, 0, INSIDE};
    double beyond = measure(b, &w);

    for (int i = 0; i < POLISH_STEPS && beyond > 1; i++) {
        struct trail next;
        double then;

        if (!step(b, &w, piece->intervals, false, &next))
            return false;
        w.trail = &next;
        then = measure(b, &w);
        w.trail = piece;
        if (then < beyond) {
            trail_free(piece);
            *piece = next;
            beyond = then;
        } else {
            trail_free(&next);
            break;
        }
    }
    return true;
}

static bool do_repair(const struct solver *s, struct bench *b, struct job *job)
{
    if (!copy_piece(s, job->first, job->intervals, &job->result))
        return false;
    if (s->repair >= SLOW_FROM && job->intervals < WINDOW && !replace_slower(s, b, &job->result))
        return false;
    return polish(s, b, &job->result);
}

static bool do_job(void *context, unsigned worker, size_t piece)
{
    struct solver *s = context;
    struct job *job = &s->job[piece];
    const struct window w = {s->path, s->limits, s->trail, job->first, INSIDE};
    bool done;

    if (worker == 0 && s->progress != NULL &&
        !s->progress(s->context, s->part_done + s->part_round * (double)piece / (double)s->jobs)) {
        s->stopped = true;
        return false;
    }
    if (job->kind == JOB_KEEP)
        done = copy_piece(s, job->first, job->intervals, &job->result);
    else if (job->kind == JOB_ROUND)
        done = step(&s->bench[worker], &w, job->intervals, true, &job->result);
    else
        done = do_repair(s, &s->bench[worker], job);
    return done;
}

static bool add_job(struct solver *s, enum job_kind kind, size_t first, size_t intervals)
{
    if (s->jobs == s->jobs_max) {
        const size_t most = s->jobs_max != 0 ? 2 * s->jobs_max : 64;
        struct job *grown = realloc(s->job, most * sizeof *grown);

        if (grown == NULL)
            return false;
        s->job = grown;
        s->jobs_max = most;
    }
    s->job[s->jobs++] = (struct job){.kind = kind, .first = first, .intervals = intervals};
    return true;
}

/* Puts the pieces together: neighbours share their last and first control points. */
static bool join(struct solver *s)
{
    struct trail joined;
    size_t intervals = 0;
    size_t at = 0;

    for (size_t i = 0; i < s->jobs; i++)
        intervals += s->job[i].result.intervals;
    if (!trail_allocate(&joined, intervals, s->trail->modes))
        return false;
    for (size_t i = 0; i < s->jobs; i++) {
        struct trail *r = &s->job[i].result;

        memcpy(joined.control + at, r->control,
               (r->intervals + trail_ends(r->modes)) * sizeof *r->control);
        memcpy(joined.place_mm + 2 * at, r->place_mm, (2 * r->intervals + 1) * sizeof *r->place_mm);
        at += r->intervals;
        trail_free(r);
    }
    joined.rest = s->trail->rest;
    trail_follow(&joined, &s->limits->modes);
    trail_free(s->trail);
    *s->trail = joined;
    return true;
}

static bool do_jobs(struct solver *s)
{
    bool done = crew_run(s->workers, s->jobs, do_job, s);

    done = done && join(s);
    for (size_t i = 0; i < s->jobs && !done; i++)
        trail_free(&s->job[i].result);
    return done;
}

/* Windows of a round; every other round begins with half of one. */
static bool plan_round(struct solver *s, unsigned round)
{
    const size_t all = s->trail->intervals;
    size_t first = 0;

    s->jobs = 0;
    while (first < all) {
        size_t intervals = first == 0 && round % 2 == 1 ? WINDOW / 2 : WINDOW;

        if (all - first < intervals + WINDOW / 2)
            intervals = all - first;
        if (!add_job(s, JOB_ROUND, first, intervals))
            return false;
        first += intervals;
    }
    return true;
}

/* How far every interval is beyond its limits; the largest. */
static double measure_all(struct solver *s)
{
    double worst = 0;

    for (size_t first = 0; first < s->trail->intervals; first += WINDOW) {
        const struct window w = {s->path, s->limits, s->trail, first, INSIDE};
        struct problem *p = &s->bench[0].problem;
        const size_t left = s->trail->intervals - first;

        p->cells = left < WINDOW ? left : WINDOW;
        window_build(p, &w);
        worst = maths_max(worst, excess_measure(&w, p));
    }
    return worst;
}

/* The next stretch to be repaired, at or behind first: its end and begin. All: none. */
static size_t next_repair(const struct solver *s, size_t first, size_t *end)
{
    const size_t all = s->trail->intervals;
    size_t bad = first;
    size_t last;
    size_t begin;

    while (bad < all && s->trail->beyond[bad] <= 1)
        bad++;
    if (bad == all)
        return all;
    begin = bad > first + MARGIN ? bad - MARGIN : first;
    last = bad;
    for (size_t i = bad; i < all && i <= last + MARGIN && i < begin + WINDOW - MARGIN; i++) {
        if (s->trail->beyond[i] > 1)
            last = i;
    }
    *end = last + MARGIN < all ? last + MARGIN : all;
    if (*end > all - trail_ends(s->trail->modes) - 1)
        *end = all;
    return begin;
}

static bool plan_repair(struct solver *s)
{
    size_t first = 0;

    s->jobs = 0;
    while (first < s->trail->intervals) {
        size_t end = 0;
        const size_t begin = next_repair(s, first, &end);

        if (begin > first && !add_job(s, JOB_KEEP, first, begin - first))
            return false;
        if (begin < s->trail->intervals && !add_job(s, JOB_REPAIR, begin, end - begin))
            return false;
        first = begin < s->trail->intervals ? end : begin;
    }
    return true;
}

static double place_of_worst(const struct solver *s)
{
    size_t worst = 0;

    for (size_t i = 0; i < s->trail->intervals; i++) {
        if (s->trail->beyond[i] > s->trail->beyond[worst])
            worst = i;
    }
    return s->trail->place_mm[2 * worst];
}

static enum solver_result failed(const struct solver *s)
{
    return s->stopped ? SOLVER_STOPPED : SOLVER_MEMORY;
}

static enum solver_result give_up(struct solver *s)
{
    s->stuck_mm = place_of_worst(s);
    return SOLVER_STUCK;
}

static enum solver_result repair_all(struct solver *s)
{
    s->part_round = 0;
    for (s->repair = 0; measure_all(s) > 1; s->repair++) {
        if (s->repair == REPAIRS_MAX || s->trail->intervals > s->longest)
            return give_up(s);
        if (!plan_repair(s) || !do_jobs(s))
            return failed(s);
    }
    return s->trail->intervals > s->longest ? give_up(s) : SOLVER_DONE;
}

/* Has a round changed the time by next to nothing? */
static bool is_still(size_t before, size_t after)
{
    const double change = (double)before - (double)after;

    return maths_abs(change) <= STILL_PART * (double)after;
}

/* Rounds until the time stands still. SOLVER_DONE: go on. */
static enum solver_result go_round(struct solver *s)
{
    struct trail *trail = s->trail;

    for (unsigned round = 0, still = 0; round < SOLVER_ROUNDS && still < STILL_ROUNDS; round++) {
        const size_t before = trail->intervals;

        s->part_done = (double)round / (SOLVER_ROUNDS + 1);
        s->part_round = 1.0 / (SOLVER_ROUNDS + 1);
        if (!plan_round(s, round) || !do_jobs(s))
            return failed(s);
        if (trail->intervals / ROUND_GROWTH > s->longest)
            return give_up(s);
        still = round >= FIRST_ROUNDS && is_still(before, trail->intervals) ? still + 1 : 0;
    }
    return SOLVER_DONE;
}

/* A machine with modes begins with what a stiff one would do. */
static enum solver_result soften(struct solver *s, const struct ahead_limits *limits)
{
    struct ahead_limits stiff = *limits;
    enum solver_result result;

    stiff.modes.count = 0;
    s->limits = &stiff;
    result = go_round(s);
    s->limits = limits;
    if (result != SOLVER_DONE)
        return result;
    return trail_soften(s->trail, &limits->modes) ? SOLVER_DONE : SOLVER_MEMORY;
}

enum solver_result solver_run(struct solver *s, const struct ahead_path *path,
                              const struct ahead_limits *limits, struct trail *trail,
                              size_t longest, bool (*progress)(void *context, double part),
                              void *context)
{
    enum solver_result result = SOLVER_DONE;

    s->path = path;
    s->limits = limits;
    s->trail = trail;
    s->longest = longest;
    s->stopped = false;
    s->progress = progress;
    s->context = context;
    if (limits->modes.count > 0)
        result = soften(s, limits);
    if (result == SOLVER_DONE)
        result = go_round(s);
    s->part_done = (double)SOLVER_ROUNDS / (SOLVER_ROUNDS + 1);
    return result == SOLVER_DONE ? repair_all(s) : result;
}
