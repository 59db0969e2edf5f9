/*
 * Built where no processes can be started: in a page. No target is known, so none is ever opened.
 */
#include "target/target.h"

#include <stdio.h>
#include <string.h>

bool target_is_known(const char *name)
{
    (void)name;
    return false;
}

bool target_open(struct target *target, const struct target_config *config)
{
    (void)config;
    memset(target, 0, sizeof *target);
    (void)snprintf(target->problem, sizeof target->problem, "this build of takt has no targets");
    return false;
}

void target_close(struct target *target)
{
    (void)target;
}

struct can_port target_get_port(struct target *target)
{
    return target->bus;
}

bool target_begin_cycle(struct target *target, const struct inputs *inputs, const double *rise_k)
{
    (void)target;
    (void)inputs;
    (void)rise_k;
    return false;
}

bool target_end_cycle(struct target *target, const struct controller *controller)
{
    (void)target;
    (void)controller;
    return false;
}

const struct cycle_record *target_get_record(const struct target *target)
{
    (void)target;
    return NULL;
}
