/*
 * How a drive's loops answer a step of the target, and follow a small move, with given gains.
 */
#ifndef TAKT_HOST_TUNE_ANSWER_H
#define TAKT_HOST_TUNE_ANSWER_H

#include "machine/machine.h"
#include "studies/tune_drive.h"
#include "studies/tune_test.h"

/* What is asked of a drive with either gains, so that both can be compared. */
struct tune_task {
    double step;     /* of the target; with its sign */
    double settle_s; /* the step is looked at for so long */
    double way;      /* of the move; with its sign */
    double move_s;
};

/*
 * For the gains that have been found: a step that asks for half of the torque, a move within the
 * axis' limits.
 */
struct tune_task tune_task_of(const struct tune_axis *result, const struct tuning_gains *found,
                              const struct tune_drive *drive, const struct machine_axis *axis);

/* answer->gains are tried. NULL; else what is wrong. */
const char *tune_answer_run(struct tune_answer *answer, struct tune_drive *drive,
                            const struct tune_task *task);

#endif
