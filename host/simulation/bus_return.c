#define _POSIX_C_SOURCE 200809L

#include "simulation/bus_return.h"

#include <signal.h>
#include <string.h>

void bus_return_init(struct bus_return *way, const char *spec, const struct link_config *config)
{
    memset(way, 0, sizeof *way);
    way->spec = spec;
    way->config = *config;
}

static void *try(void *context)
{
    struct bus_return *way = context;
    struct link_error error;

    way->link = link_open(way->spec, &way->config, &error);
    atomic_store(&way->has_tried, true);
    return NULL;
}

/* Signals are for the control thread. */
static void start_trying(struct bus_return *way)
{
    sigset_t all, before;

    atomic_store(&way->has_tried, false);
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    way->is_trying = pthread_create(&way->thread, NULL, try, way) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static struct link *join(struct bus_return *way)
{
    struct link *link;

    if (!way->is_trying)
        return NULL;
    (void)pthread_join(way->thread, NULL);
    way->is_trying = false;
    link = way->link;
    way->link = NULL;
    return link;
}

static void wait_longer(struct bus_return *way, uint64_t now_ns)
{
    way->next_ns = now_ns + way->pause_ns;
    way->pause_ns *= 2;
    if (way->pause_ns > BUS_RETURN_LONGEST_NS)
        way->pause_ns = BUS_RETURN_LONGEST_NS;
}

struct link *bus_return_look(struct bus_return *way, uint64_t now_ns)
{
    struct link *link = NULL;

    if (!way->is_looking) {
        way->is_looking = true;
        way->pause_ns = BUS_RETURN_FIRST_NS;
        wait_longer(way, now_ns);
    }
    if (way->is_trying && atomic_load(&way->has_tried)) {
        link = join(way);
        wait_longer(way, now_ns);
        way->is_looking = link == NULL;
    } else if (!way->is_trying && now_ns >= way->next_ns) {
        start_trying(way);
    }
    return link;
}

void bus_return_stop(struct bus_return *way)
{
    link_close(join(way));
    way->is_looking = false;
}
