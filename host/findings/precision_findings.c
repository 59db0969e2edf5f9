#include "findings/precision_findings.h"

#include "accuracy/bounds.h"
#include "base/maths.h"

#include <stdio.h>

/* Bits of an angle's word that the page names, and what they leave of evenness. */
#define ANGLE_BITS_LOW  6
#define ANGLE_BITS_HIGH 8

static double increment_mm(const struct precision *p)
{
    return 1 / p->machine.resolution_per_mm;
}

/* The farthest position of any axis, times a number of units per mm. */
static double farthest(const struct machine *machine, bool in_steps)
{
    double most = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];
        double units = in_steps ? axis->steps_per_mm : machine->resolution_per_mm;
        double end = maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm));

        if (axis->present)
            most = maths_max(most, end * units);
    }
    return most;
}

static double finest_steps(const struct machine *machine)
{
    double most = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            most = maths_max(most, machine->axis[i].steps_per_mm);
    }
    return most;
}

static double coarsest_step_mm(const struct machine *machine)
{
    double largest = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            largest = maths_max(largest, 1 / machine->axis[i].steps_per_mm);
    }
    return largest;
}

static unsigned count_axes(unsigned mask)
{
    unsigned count = 0;

    for (; mask != 0; mask &= mask - 1)
        count++;
    return count;
}

static void print_row(const char *method, const char *what, double measured, double bound,
                      const char *unit)
{
    (void)printf("  %-10s %-34s %11.3g  %11.3g %s\n", method, what, measured, bound, unit);
}

/* exact: what is left is the last bit of a double, at the farthest position. */
static void print_exact(const struct precision *p)
{
    double position = farthest(&p->machine, false) * increment_mm(p);

    (void)printf("  %-10s %-34s %11s  %11.3g mm\n", "exact", "last bit of a setpoint", "-",
                 position * 0x1p-53);
    (void)printf(
        "             words: setpoints of %u bits and more for whole increments; doubles have "
        "53\n",
        takt_bounds_word_bits(farthest(&p->machine, false)));
}

/* Longest way of a line in steps: the range of F. */
static double longest_steps(const struct precision *p)
{
    double most = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        most = maths_max(most, p->longest_mm[i] * p->machine.axis[i].steps_per_mm);
    return most;
}

/*
 * The error is that of the position when its setpoint is due. Even steps are off by half a step. By
 * evaluation functions a point is within a step of a line, or radially of a circle, whose start and
 * centre are rounded to steps: one more at most; and along it up to two steps early or late,
 * because ticks come evenly (firmware/step/README.md).
 */
static void print_steps(const struct precision *p)
{
    static const char *const names[] = {"even", "improved", "plain"};
    static const double bounds[] = {0.5, 4, 4};

    for (unsigned i = 0; i < PRECISION_FORMS; i++) {
        print_row(names[i], "position of an axis", p->form[i].off_steps, bounds[i], "steps");
        (void)printf("             highest rate %.0f steps/s\n", p->form[i].rate_hz);
    }
}

static void print_step_words(const struct precision *p)
{
    unsigned axes = count_axes(p->axes);
    double step_mm = coarsest_step_mm(&p->machine);

    (void)printf("             a line over %u axes is left by less than %.4g mm\n", axes,
                 takt_bounds_line_off_mm(axes, step_mm));
    (void)printf("             words: position %u bits; F of lines %u",
                 takt_bounds_word_bits(farthest(&p->machine, true)),
                 takt_bounds_word_bits(longest_steps(p)));
    if (p->radius_mm > 0)
        (void)printf(", of arcs %u",
                     takt_bounds_word_bits(2 * p->radius_mm * finest_steps(&p->machine)));
    (void)printf(
        " bits\n             at 1,000 ticks/s an axis does %.4g mm/s, the path up to %.4g\n",
        takt_bounds_axis_speed_mm_s(step_mm, 1000),
        takt_bounds_path_speed_mm_s(axes, step_mm, 1000));
}

/* Lines driven with a feed of their own, beside what the run took for them. */
static void print_ramps(const struct ramps *r)
{
    print_row("ramps", "off lines, with ramps of its own", r->off_mm, r->off_bound_mm, "mm");
    (void)printf("             %u lines in %llu cycles, the run took %llu; acceleration changes by "
                 "%.4g mm/s2 in a cycle\n",
                 r->lines, (unsigned long long)r->cycles, (unsigned long long)r->run_cycles,
                 r->step_mm_s2);
    if (r->slowest > 0)
        (void)printf("             end rule, N = %u: %.4f to %.4f of V_end\n", 1u << r->end_shift,
                     r->slowest, r->fastest);
}

static void print_integrate(const struct precision *p)
{
    const struct interpolator_errors *errors = takt_interpolator_get_errors(&p->integrate);
    unsigned fraction = takt_bounds_fraction_bits(errors->loss_ulp);
    unsigned whole = takt_bounds_word_bits(farthest(&p->machine, false));

    if (p->cycles_max == 0) {
        (void)printf("  %-10s no lines\n", "integrate");
        return;
    }
    print_row("integrate", "position on lines", errors->along_mm, errors->along_bound_mm, "mm");
    (void)printf(
        "             lost by truncation: up to %.4g units of the last place, which is %.3g mm in "
        "words of %u bits\n"
        "             words: %u bits behind the increment keep that below one; with the "
        "travel %u bits\n",
        errors->loss_ulp, p->integrate.config.unit_mm, p->machine.interpolator_word_bits, fraction,
        whole + fraction);
    print_ramps(&p->ramps);
}

static void print_rotate(const struct precision *p)
{
    const struct interpolator_errors *errors = takt_interpolator_get_errors(&p->rotate);

    if (p->radius_mm == 0) {
        (void)printf("  %-10s no arcs\n", "rotate");
        return;
    }
    print_row("rotate", "along arcs", errors->along_mm, errors->along_bound_mm, "mm");
    print_row("", "contour of arcs", errors->contour_mm, errors->contour_bound_mm, "mm");
    (void)printf(
        "             largest angle of a cycle %.4g rad\n"
        "             words: angle %d to %d bits, speed even to %.2g to %.2g; radius vector "
        "%u bits\n",
        errors->angle_rad, ANGLE_BITS_LOW, ANGLE_BITS_HIGH, 0x1p-6, 0x1p-8,
        takt_bounds_word_bits(p->radius_mm * p->machine.resolution_per_mm) +
            takt_bounds_fraction_bits(increment_mm(p) /
                                      maths_max(errors->contour_bound_mm, 1e-12)));
}

/* What the machine's limits alone say, whatever the program. */
static void print_machine(const struct precision *p)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &p->machine.axis[i];
        double cycle_s = machine_cycle_s(&p->machine);
        double ramp;
        struct bounds_cycles n;

        if (!axis->present)
            continue;
        ramp =
            takt_bounds_ramp_cycles(axis->max_velocity_mm_s, axis->max_acceleration_mm_s2, cycle_s);
        n = (struct bounds_cycles){ramp, p->cycles_max, ramp};
        (void)printf(
            "  axis %c     ramp to full feed %.0f cycles: integration loses up to %.4g units, "
            "%u bits; rotation %.3g mm a turn\n",
            AXIS_LETTERS[i], ramp, takt_bounds_truncation_ulp(&n),
            takt_bounds_fraction_bits(takt_bounds_truncation_ulp(&n)),
            takt_bounds_rotation_turn_mm(axis->max_acceleration_mm_s2, cycle_s));
    }
}

void precision_findings_print(const char *program, const struct precision *p)
{
    (void)printf("%s on %s: %llu setpoints, increment %.4g mm, cycle %.4g ms\n\n", program,
                 p->machine.name, (unsigned long long)p->setpoints, increment_mm(p),
                 1e-3 * (double)p->machine.cycle_us);
    (void)printf("  %-10s %-34s %11s  %11s\n", "method", "error", "measured", "bound");
    print_exact(p);
    print_integrate(p);
    print_rotate(p);
    print_steps(p);
    print_step_words(p);
    (void)fputc('\n', stdout);
    print_machine(p);
}
