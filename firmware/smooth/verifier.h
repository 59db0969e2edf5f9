/*
 * What a piece of the curve needs of the axes, and whether it is within the tolerance.
 */
#ifndef TAKT_SMOOTH_VERIFIER_H
#define TAKT_SMOOTH_VERIFIER_H

#include "smooth/order.h"
#include "smooth/window.h"

/* Most of |dx/du|, |d2x/du2|, |d3x/du3| on a piece, u in s of nominal time; by slot. */
struct verifier_need {
    float first[AXIS_COUNT];
    float second[AXIS_COUNT];
    float third[AXIS_COUNT];
    float linear_mm_s; /* over X, Y, Z: the feed of motions of one of them, */
    float rotary_mm_s; /* and over the others: of those of them alone */
};

/* How fast nominal time may pass on a piece. */
struct verifier_rate {
    float most;       /* by the axes' limits: never exceeded */
    float by;         /* how fast it may change there, 1/s */
    float programmed; /* at the programmed feed; infinite for a rapid */
};

/* How fast the rate of nominal time may change where the axes of a chain move: 1/s. */
struct verifier_change {
    double by;         /* on every piece, */
    double wanted;     /* and on those that can leave it: a power of two times that */
    double rounding_s; /* over which it is rounded */
};

/* The way of a chain to its end. */
struct verifier_way {
    double known_mm;
    double expected_mm; /* no less; infinite: as long as it may be */
};

/* What a machine's axes are left for changes of rate, where a piece takes so long. */
void takt_verifier_change(const struct smooth_limits *limits, double interval_s,
                          const struct verifier_way *way, struct verifier_change *change);
void takt_verifier_need(const struct window *w, const struct route *r, unsigned piece,
                        struct verifier_need *need);
void takt_verifier_rate(const struct verifier_need *need, const struct route *r, uint32_t element,
                        const struct verifier_change *change, struct verifier_rate *rate);
/*
 * How fast the rate may change on a piece while it is not above the highest one, and not above 1:
 * 1/s, a power of two times change->by, so that neighbours mostly have the same.
 */
float takt_verifier_change_on(const struct verifier_need *need, const struct route *r,
                              const struct verifier_change *change,
                              const struct verifier_rate *rate);
/*
 * The rate at which a piece is gone along at the programmed feed of an element; infinite for a
 * rapid.
 */
float takt_verifier_programmed(const struct verifier_need *need, const struct route *r,
                               uint32_t element);
/* What is said of a window's pieces. */
struct verifier_verdict {
    unsigned good; /* pieces from the first one on that keep the tolerance in order */
    /*
     * how far the next piece leaves the tolerance; 0 or less if it does not, but breaks the order
     */
    float beyond_mm;
    /*
     * by number of pieces, those after which the curve can be as far as it is thought to be: no
     * corner is left out
     */
    unsigned char whole[SMOOTH_SAMPLES_MAX];
    unsigned followed;  /* the last of those of the pieces that were to be kept, */
    struct order order; /* and what can have been come to there */
};

/*
 * Verifies the first count pieces, of which keep are to be kept. order: what can have been come to
 * where they begin. Tells the window whose feed is theirs.
 */
void takt_verifier_pieces(struct window *w, const struct route *r, unsigned count, unsigned keep,
                          const struct order *order, struct verifier_verdict *v);
/* The order after the first count pieces, and whose feed is theirs. */
void takt_verifier_order(struct window *w, const struct route *r, unsigned count,
                         struct order *order);

#endif
