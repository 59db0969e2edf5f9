#include "page/page_link.h"

enum { STAGE_FREE, STAGE_ASKED, STAGE_DONE };

void page_link_put(struct page_link *link, const struct page_cycle *cycle)
{
    const unsigned at = atomic_load_explicit(&link->written, memory_order_relaxed);

    if (at - atomic_load_explicit(&link->read, memory_order_acquire) == PAGE_LINK_CYCLES)
        return;
    link->cycle[at % PAGE_LINK_CYCLES] = *cycle;
    atomic_store_explicit(&link->written, at + 1, memory_order_release);
}

bool page_link_take(struct page_link *link, struct page_cycle *cycle)
{
    const unsigned at = atomic_load_explicit(&link->read, memory_order_relaxed);

    if (at == atomic_load_explicit(&link->written, memory_order_acquire))
        return false;
    *cycle = link->cycle[at % PAGE_LINK_CYCLES];
    atomic_store_explicit(&link->read, at + 1, memory_order_release);
    return true;
}

struct page_job *page_link_get_job(struct page_link *link)
{
    return atomic_load(&link->stage) == STAGE_ASKED ? &link->job : NULL;
}

void page_link_finish(struct page_link *link)
{
    atomic_store(&link->stage, STAGE_DONE);
}

struct page_job *page_link_next_job(struct page_link *link)
{
    return atomic_load(&link->stage) == STAGE_FREE ? &link->job : NULL;
}

void page_link_ask(struct page_link *link)
{
    link->job.problem[0] = '\0';
    atomic_store(&link->stage, STAGE_ASKED);
}

/* Until the next ask it is the page's. */
const struct page_job *page_link_answer(struct page_link *link)
{
    if (atomic_load(&link->stage) != STAGE_DONE)
        return NULL;
    atomic_store(&link->stage, STAGE_FREE);
    return &link->job;
}
