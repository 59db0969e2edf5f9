#include "stm32/findings.h"

#include "stm32/step_slots.h"

#include <string.h>

/* Longest cycle of step drives. */
#define STEP_CYCLE_US (STEP_SLOTS_MAX * STEP_SLOT_NS / 1000U)

static bool is_problem(struct diagnostic *problem, enum takt_error code, double value)
{
    takt_diagnostic_set(problem, code, 0, 0, "", 0, value);
    return true;
}

/* A crash or a bite of the watchdog wants somebody to look before anything moves again. */
static bool find_crash(const struct findings *found, struct diagnostic *problem)
{
    if (!found->has_crashed)
        return false;
    if (found->crash.cause == CRASH_INVARIANT) {
        takt_diagnostic_set(problem, TAKT_ERROR_INVARIANT_BROKEN, 0, 0, found->crash.file,
                            strlen(found->crash.file), (double)found->crash.address);
        return true;
    }
    (void)is_problem(problem, TAKT_ERROR_CRASHED, (double)found->crash.address);
    problem->meaning = takt_crash_name(found->crash.cause);
    return true;
}

static bool find_bite(const struct findings *found, struct diagnostic *problem)
{
    return found->was_bitten && !found->has_crashed &&
           is_problem(problem, TAKT_ERROR_WATCHDOG_RESET, 0);
}

static bool find_image(const struct findings *found, struct diagnostic *problem)
{
    *problem = found->image;
    return problem->code != TAKT_OK;
}

static bool find_settings(const struct findings *found, struct diagnostic *problem)
{
    *problem = found->settings;
    return problem->code != TAKT_OK;
}

static bool find_crystal(const struct findings *found, struct diagnostic *problem)
{
    return found->needs_can && found->clock != CLOCK_CRYSTAL &&
           is_problem(problem, TAKT_ERROR_CRYSTAL_ABSENT, 0);
}

static bool find_rate(const struct findings *found, struct diagnostic *problem)
{
    return found->needs_can && found->can_impossible != 0 &&
           is_problem(problem, TAKT_ERROR_CAN_RATE, found->can_impossible);
}

static bool find_can(const struct findings *found, struct diagnostic *problem)
{
    if (!found->needs_can || found->can_impossible != 0 || found->can == CAN_ON)
        return false;
    return is_problem(problem,
                      found->can == CAN_ABSENT ? TAKT_ERROR_CAN_ABSENT : TAKT_ERROR_CAN_BUS, 0);
}

static bool find_steps(const struct findings *found, struct diagnostic *problem)
{
    const uint32_t longest_us = STEP_CYCLE_US;

    return found->needs_steps && !found->has_steps &&
           is_problem(problem, TAKT_ERROR_STEP_CYCLE, (double)longest_us);
}

bool takt_findings_next(const struct findings *found, unsigned *at, struct diagnostic *problem)
{
    static bool (*const kinds[])(const struct findings *found, struct diagnostic *problem) = {
        find_image,   find_crash, find_bite, find_settings,
        find_crystal, find_rate,  find_can,  find_steps};

    while (*at < sizeof kinds / sizeof kinds[0]) {
        if (kinds[(*at)++](found, problem))
            return true;
    }
    return false;
}
