#include "bore/path.h"

#include <stdlib.h>
#include <string.h>

void bore_path_begin(struct bore_path *p, const double from_mm[2])
{
    *p = (struct bore_path){.from_mm = {from_mm[0], from_mm[1]}};
}

void bore_path_free(struct bore_path *p)
{
    free(p->piece);
    *p = (struct bore_path){0};
}

static bool grow(struct bore_path *p)
{
    size_t capacity = p->capacity == 0 ? 64 : 2 * p->capacity;
    struct bore_piece *piece = realloc(p->piece, capacity * sizeof *piece);

    if (piece == NULL)
        return false;
    p->piece = piece;
    p->capacity = capacity;
    return true;
}

void bore_path_add(struct bore_path *p, const struct bore_piece *piece)
{
    struct bore_piece copy = *piece; /* it may be one of the path's own */

    if (p->failed || (p->count == p->capacity && !grow(p))) {
        p->failed = true;
        return;
    }
    p->piece[p->count++] = copy;
}

void bore_path_line(struct bore_path *p, double x_mm, double y_mm)
{
    struct bore_piece piece = {.kind = BORE_LINE, .to_mm = {x_mm, y_mm}};

    bore_path_add(p, &piece);
}

void bore_path_arc(struct bore_path *p, const double to_mm[2], const double centre_mm[2])
{
    struct bore_piece piece = {
        .kind = BORE_ARC, .to_mm = {to_mm[0], to_mm[1]}, .centre_mm = {centre_mm[0], centre_mm[1]}};

    bore_path_add(p, &piece);
}

void bore_path_helix(struct bore_path *p, double down_mm)
{
    const double *at_mm = bore_path_start(p, p->count);
    struct bore_piece piece = {.kind = BORE_ARC, .to_mm = {at_mm[0], at_mm[1]}, .down_mm = down_mm};

    bore_path_add(p, &piece);
}

const double *bore_path_start(const struct bore_path *p, size_t piece)
{
    return piece == 0 ? p->from_mm : p->piece[piece - 1].to_mm;
}

/* v' = 2 (v . u) u - v, u the direction of the axis */
static void mirror(const double axis[2], const double v[2], double image[2])
{
    double square = axis[0] * axis[0] + axis[1] * axis[1];
    double along = 2 * (v[0] * axis[0] + v[1] * axis[1]) / square;
    double x = along * axis[0] - v[0];
    double y = along * axis[1] - v[1];

    image[0] = x;
    image[1] = y;
}

void bore_path_add_mirrored(struct bore_path *p, size_t first, size_t count)
{
    double axis[2];

    memcpy(axis, bore_path_start(p, p->count), sizeof axis);
    for (size_t i = count; i > first && !p->failed; i--) {
        struct bore_piece piece = p->piece[i - 1];

        mirror(axis, bore_path_start(p, i - 1), piece.to_mm);
        mirror(axis, piece.centre_mm, piece.centre_mm);
        bore_path_add(p, &piece);
    }
}
