/*
 * Between the control cycle and the page's thread, beside the panel's exchange: what every cycle
 * did, and what has to be done between two cycles because only the control thread may look there.
 * The control cycle never waits here: a cycle that finds no room is left out of what pages show.
 *
 *     control thread    page_link_put               -> queue -> page_link_take      page's thread
 *                       page_link_get_job, _finish  <-  job  <- page_link_ask, _answer
 */
#ifndef TAKT_PAGE_PAGE_LINK_H
#define TAKT_PAGE_PAGE_LINK_H

#include "base/point.h"
#include "inject/inject.h"
#include "program/parameters.h"
#include "program/tools.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* A power of two: two seconds at 1 ms. */
#define PAGE_LINK_CYCLES 2048

#define PAGE_OBJECTS_MAX   1024
#define PAGE_RESPONSES_MAX 64
#define PAGE_PROBLEM_MAX   127
#define PAGE_FAULTS_SHOWN  INJECT_FAULTS_MAX

/* mm, rad. */
struct page_cycle {
    uint32_t number; /* register CYCLES */
    struct point set, following;
};

enum page_job_kind {
    PAGE_JOB_TABLES,  /* tools and parameters */
    PAGE_JOB_BUS,     /* bus, and faults that were ordered */
    PAGE_JOB_OBJECTS, /* all values of a drive's dictionary */
    PAGE_JOB_WRITE,   /* an object of a drive */
    PAGE_JOB_FAULT,   /* something goes wrong from now on */
    PAGE_JOB_CLEAR    /* what lasts of that ends */
};

struct page_bus {
    double load_percent;
    uint64_t frames, error_frames, dropped, refused;
    struct page_response {
        uint16_t id;
        uint32_t longest_ns;
    } response[PAGE_RESPONSES_MAX]; /* from the send call to the end of the frame */
    unsigned responses;
    struct page_fault {
        struct inject_fault fault;
        bool is_in_force;
    } fault[PAGE_FAULTS_SHOWN];
    unsigned faults;
};

struct page_values {
    uint32_t value[PAGE_OBJECTS_MAX];
    bool is_there[PAGE_OBJECTS_MAX];
    unsigned count;
};

/* Asked by the page's thread, done by the control thread, which owns it meanwhile. */
struct page_job {
    enum page_job_kind kind;
    unsigned drive;
    uint32_t object, value; /* of PAGE_JOB_WRITE: a mapping entry (canopen/pdo.h) */
    struct inject_fault fault;
    char problem[PAGE_PROBLEM_MAX + 1]; /* why it could not be done; empty: it is */
    struct parameters parameters;
    struct tool *tools; /* room for tools_max; the page's */
    size_t tools_count, tools_max;
    struct page_bus bus;
    struct page_values values;
};

struct page_link {
    struct page_cycle cycle[PAGE_LINK_CYCLES];
    atomic_uint written, read; /* count up */
    atomic_uint stage;
    struct page_job job;
};

/* Control thread. */
void page_link_put(struct page_link *link, const struct page_cycle *cycle);
/* Control thread. Something to do, followed by page_link_finish; NULL: nothing. */
struct page_job *page_link_get_job(struct page_link *link);
void page_link_finish(struct page_link *link);

/* Page's thread. False: no more. */
bool page_link_take(struct page_link *link, struct page_cycle *cycle);
/* Page's thread. The job to fill, followed by page_link_ask; NULL: one is under way. */
struct page_job *page_link_next_job(struct page_link *link);
void page_link_ask(struct page_link *link);
/* Page's thread. The job that has been done, once; NULL: none. */
const struct page_job *page_link_answer(struct page_link *link);

#endif
