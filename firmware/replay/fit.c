#include "replay/fit.h"

#include "base/assert.h"

/* Longest name of what is compared: "acceleration of X". */
#define NAME_MAX_LENGTH 24

static enum takt_error error_of(enum replay_fault fault)
{
    switch (fault) {
    case REPLAY_GOOD:
        return TAKT_OK;
    case REPLAY_FOREIGN:
        return TAKT_ERROR_PLAN_FOREIGN;
    case REPLAY_OTHER_VERSION:
        return TAKT_ERROR_PLAN_VERSION;
    case REPLAY_DAMAGED:
        break;
    }
    return TAKT_ERROR_PLAN_DAMAGED;
}

bool takt_replay_fit_read(struct replay_header *h, const uint8_t bytes[REPLAY_HEADER_BYTES],
                          struct diagnostic *why)
{
    takt_diagnostic_set(why, error_of(takt_replay_header_read(h, bytes)), 0, 0, "", 0, 0.0);
    return why->code == TAKT_OK;
}

static bool is_same(const char *name, size_t length, double there, double here,
                    struct diagnostic *why)
{
    if (there == here) {
        return true;
    }
    takt_diagnostic_set(why, TAKT_ERROR_PLAN_MACHINE, 0, 0, name, length, there);
    takt_diagnostic_set_limit(why, here);
    return false;
}

static bool is_same_limit(const char *what, int axis, double there, double here,
                          struct diagnostic *why)
{
    char name[NAME_MAX_LENGTH] = {AXIS_LETTERS[axis], ' '};
    size_t length = 2;

    TAKT_ASSERT(axis >= 0 && axis < AXIS_LINEAR_COUNT);
    for (; what[length - 2] != '\0' && length < NAME_MAX_LENGTH; length++) {
        name[length] = what[length - 2];
    }
    return is_same(name, length, there, here, why);
}

bool takt_replay_fit_machine(const struct replay_header *h, const struct replay_fit *here,
                             struct diagnostic *why)
{
    static const char cycle[] = "the cycle in us";
    const struct plan_limits *l = &here->limits;

    if (!is_same(cycle, sizeof(cycle) - 1, (double)h->cycle_us, (double)here->cycle_us, why)) {
        return false;
    }
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double is = (l->axes & (1U << i)) != 0 ? 1.0 : 0.0;

        if (!is_same_limit("velocity", i, h->velocity_mm_s[i], is * l->velocity_mm_s[i], why) ||
            !is_same_limit("acceleration", i, h->acceleration_mm_s2[i],
                           is * l->acceleration_mm_s2[i], why) ||
            !is_same_limit("jerk", i, h->jerk_mm_s3[i], is * l->jerk_mm_s3[i], why)) {
            return false;
        }
    }
    return true;
}

bool takt_replay_fit_text(const struct replay_header *h, const struct replay_fit *here,
                          struct diagnostic *why)
{
    if (h->text_size == here->text_size && h->text_crc == here->text_crc) {
        return true;
    }
    takt_diagnostic_set(why, TAKT_ERROR_PLAN_PROGRAM, 0, 0, "", 0, 0.0);
    return false;
}
