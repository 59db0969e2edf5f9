#define _POSIX_C_SOURCE 200809L

#include "ahead/crew.h"

#include <pthread.h>
#include <unistd.h>

struct crew {
    pthread_mutex_t lock;
    size_t next;
    size_t count;
    bool failed;
    bool (*work)(void *context, unsigned worker, size_t piece);
    void *context;
};

struct crew_member {
    struct crew *crew;
    unsigned worker;
    pthread_t thread;
};

/* The next piece, or count: none. */
static size_t take_piece(struct crew *crew)
{
    size_t piece;

    (void)pthread_mutex_lock(&crew->lock);
    piece = crew->failed ? crew->count : crew->next;
    if (piece < crew->count)
        crew->next++;
    (void)pthread_mutex_unlock(&crew->lock);
    return piece;
}

static void fail(struct crew *crew)
{
    (void)pthread_mutex_lock(&crew->lock);
    crew->failed = true;
    (void)pthread_mutex_unlock(&crew->lock);
}

static void *run(void *argument)
{
    const struct crew_member *member = argument;
    struct crew *crew = member->crew;
    size_t piece;

    while ((piece = take_piece(crew)) < crew->count) {
        if (!crew->work(crew->context, member->worker, piece))
            fail(crew);
    }
    return NULL;
}

bool crew_run(unsigned workers, size_t count,
              bool (*work)(void *context, unsigned worker, size_t piece), void *context)
{
    struct crew crew = {.count = count, .work = work, .context = context};
    struct crew_member member[CREW_MAX];
    unsigned started = 1;

    (void)pthread_mutex_init(&crew.lock, NULL);
    member[0] = (struct crew_member){.crew = &crew};
    for (; started < workers && started < CREW_MAX && started < count; started++) {
        member[started] = (struct crew_member){.crew = &crew, .worker = started};
        if (pthread_create(&member[started].thread, NULL, run, &member[started]) != 0)
            break; /* fewer cores do the same work */
    }
    (void)run(&member[0]);
    while (started-- > 1)
        (void)pthread_join(member[started].thread, NULL);
    (void)pthread_mutex_destroy(&crew.lock);
    return !crew.failed;
}

unsigned crew_cores(void)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);

    return cores < 1 ? 1 : cores > CREW_MAX ? CREW_MAX : (unsigned)cores;
}
