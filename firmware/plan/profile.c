#include "plan/profile.h"

#include <assert.h>

/* s = s0 + v0 t + a0 t^2/2 + j t^3/6, v = v0 + a0 t + j t^2/2, a = a0 + j t */
static struct profile_state piece_state(const struct profile_piece *piece, double t_s)
{
    const double j = piece->j_mm_s3;
    const double a = piece->a_mm_s2;
    const double v = piece->v_mm_s;

    return (struct profile_state){
        .s_mm = piece->s_mm + t_s * (v + t_s * (0.5 * a + t_s * j / 6.0)),
        .v_mm_s = v + t_s * (a + 0.5 * t_s * j),
        .a_mm_s2 = a + t_s * j,
    };
}

struct profile_state profile_append(struct profile *p, struct profile_state at, double duration_s,
                                    double j_mm_s3)
{
    struct profile_piece *piece = &p->piece[p->count];

    assert(p->count < PROFILE_PIECES_MAX);
    p->count++;
    *piece = (struct profile_piece){duration_s, at.s_mm, at.v_mm_s, at.a_mm_s2, j_mm_s3};
    p->duration_s += duration_s;
    return piece_state(piece, duration_s);
}

void profile_evaluate(const struct profile *p, double t_s, struct profile_state *state)
{
    unsigned i = 0;

    while (i + 1 < p->count && t_s > p->piece[i].duration_s) {
        t_s -= p->piece[i].duration_s;
        i++;
    }
    *state = piece_state(&p->piece[i], t_s);
}
