/* Inside smooth: curves that are tried from rest. */
#ifndef TAKT_SMOOTH_TRIALS_H
#define TAKT_SMOOTH_TRIALS_H

#include "smooth/smooth.h"

/*
 * From rest: the quickest curve that is found, its first window as a search leaves it. Returns how
 * far it was gone along; in infinite time: there is none.
 */
struct worth_far takt_trials_from_rest(struct smooth *s, union smooth_scratch *scratch,
                                       struct verifier_verdict *v);

#endif
