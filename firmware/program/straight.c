#include "program/straight.h"

#include "program/coordinates.h"
#include "program/emit.h"

static bool move_to(struct program *p, enum move_kind kind, const struct point *end)
{
    struct move m;

    emit_prepare(p, kind, end, &m);
    return emit_motion(p, &m);
}

bool straight_move(struct program *p, const struct program_code *code)
{
    struct point end;

    p->modes.motion = code;
    coordinates_end(p, &end);
    return move_to(p, (enum move_kind)code->argument, &end);
}

static void reference_point(const struct program *p, unsigned first, struct point *end)
{
    const bool all = (p->words.given & LETTERS_AXES) == 0;
    double ignored;

    *end = p->modes.at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        const bool present = (p->config.axes & (1U << i)) != 0;

        if (present && (all || coordinates_word(p, i, &ignored))) {
            end->at[i] =
                coordinates_from_parameter(parameters_get(p->config.parameters, first + i), i);
        }
    }
}

bool straight_to_reference(struct program *p, const struct program_code *code)
{
    struct point end;

    if ((p->words.given & LETTERS_AXES) != 0) {
        coordinates_end(p, &end);
        if (!move_to(p, MOVE_RAPID, &end)) {
            return false;
        }
    }
    reference_point(p, (unsigned)code->argument, &end);
    return move_to(p, MOVE_RAPID, &end);
}

bool straight_cancel(struct program *p, const struct program_code *code)
{
    (void)code;
    p->modes.motion = NULL;
    return true;
}
