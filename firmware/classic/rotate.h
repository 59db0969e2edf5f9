/*
 * A circle by rotating its radius vector, once a cycle by a small angle:
 *
 *     a' = a (1 - dphi^2 / 2) - b dphi,   b' = b (1 - dphi^2 / 2) + a dphi        (counter-clockwise; dphi < 0 clockwise)
 *
 * It runs ahead by dphi^3 / 6 a step, and the radius grows by the factor sqrt(1 + dphi^4 / 4).
 * Source: seed 002, part B.
 */
#ifndef TAKT_CLASSIC_ROTATE_H
#define TAKT_CLASSIC_ROTATE_H

struct rotate {
    double a, b;        /* radius vector */
    double quantum_rad; /* angles are whole multiples of it; 0: any */
    double turned_rad;  /* by all steps, as their angles say */
    double wanted_rad;  /* turned, before quantisation */
};

/* quantum_rad: 0, or the last bit of the angle's word. */
void takt_rotate_begin(struct rotate *r, double a, double b, double quantum_rad);
/*
 * One cycle. What quantisation leaves over is carried to the next. Returns the angle of the step.
 */
double takt_rotate_step(struct rotate *r, double angle_rad);

#endif
