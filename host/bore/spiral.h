/*
 * The spiral of hole milling: an involute that ends tangent, and with the same radius of curvature,
 * on the circle of the hole (seed 001, eq. 5 to 16). Coordinates in mm about the centre of the
 * hole; counter-clockwise.
 */
#ifndef TAKT_BORE_SPIRAL_H
#define TAKT_BORE_SPIRAL_H

#include <stdbool.h>

struct bore_spiral {
    double radius_mm;  /* R of the circle it ends on */
    double turns;      /* n, a whole number: R = 2 pi n r */
    double base_mm;    /* r of the base circle */
    double start_rad;  /* phi0, unrolled at the start, 0 ... 2 pi n */
    double turned_rad; /* psi: the curve begins at the centre in this direction */
};

/* Six numbers that tell an involute arc without its base circle (seed 001, eq. 12, 13). */
struct bore_form {
    double length_mm;
    double start_mm[2];
    double heading_rad;                    /* of the curve at its start */
    double radius_start_mm, radius_end_mm; /* of curvature */
};

/* n turns from the centre to the circle of radius R > 0. */
void bore_spiral_set(struct bore_spiral *s, double radius_mm, unsigned turns);

/* Lets it begin at a point nearer to the centre than R; at the centre the direction stays. */
void bore_spiral_begin_at(struct bore_spiral *s, const double start_mm[2]);

/*
 * Lets it begin where the radius of curvature is this, 0 ... R; or where so much length is left, up
 * to all.
 */
void bore_spiral_begin_radius(struct bore_spiral *s, double radius_start_mm);
void bore_spiral_begin_length(struct bore_spiral *s, double length_mm);

/*
 * The phi, 0 ... 2 pi n, at which a spiral of that base circle is distance_mm, 0 ... R, from the
 * centre.
 */
double bore_unrolled(double base_mm, double turns, double distance_mm);

/* Where it is when phi is unrolled, and the other way: how far from the centre. */
void bore_spiral_point(const struct bore_spiral *s, double unrolled_rad, double point_mm[2]);
double bore_spiral_distance(double base_mm, double unrolled_rad);

double bore_spiral_length(const struct bore_spiral *s);
void bore_spiral_base_centre(const struct bore_spiral *s, double centre_mm[2]);

/* The same spiral in six numbers, and its base circle and start angle out of them. */
void bore_spiral_form(const struct bore_spiral *s, struct bore_form *form);
double bore_form_base(const struct bore_form *form);
double bore_form_unrolled(const struct bore_form *form);

#endif
