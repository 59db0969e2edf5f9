#include "findings/tune_findings.h"

#include "base/maths.h"
#include "canopen/little_endian.h"
#include "tuning/loop_object.h"
#include "tuning/picture.h"

#include <cjson/cJSON.h>

/* What a drive makes of it: a whole number of the object's unit. */
static double number_of(const struct tuning_gains *gains, unsigned i)
{
    return loop_object_of(gains, i) / loop_number[i].per_unit;
}

static bool is_rotary(unsigned axis)
{
    return axis >= AXIS_LINEAR_COUNT;
}

/* um, thousandths of a degree */
static double small_of(unsigned axis, double length)
{
    return 1e3 * (is_rotary(axis) ? length * 180 / MATHS_PI : length);
}

static const char *small_name(unsigned axis)
{
    return is_rotary(axis) ? "mdeg" : "um";
}

/* -- figures -- */

static void print_answer(const char *name, const struct tune_answer *a, unsigned axis)
{
    (void)printf("  %-7s %9.3f %8.2f %9.3f %8.1f", name, 1e4 * a->gains.told_inertia_kg_m2,
                 a->gains.velocity_bandwidth_hz, 1e3 * a->gains.velocity_integral_s,
                 a->gains.position_gain_per_s);
    if (!a->is_steady)
        (void)printf("  it does not come to rest\n");
    else
        (void)printf(" %7.1f %7.1f %8.1f %12.3f %9.3f\n", a->margins.velocity_phase_deg,
                     a->margins.position_phase_deg, 100 * a->overshoot,
                     small_of(axis, a->error_max), small_of(axis, a->error_rms));
}

void tune_findings_print_axis(const struct tune_axis *t, unsigned axis)
{
    const struct tuning_plant *p = &t->plant;
    const char *unit = small_name(axis);

    (void)printf(
        "axis %c: its torque went to and fro by %.3g Nm, which moved it from %.3f to %.3f %s\n",
        AXIS_LETTERS[axis], t->torque_nm, small_of(axis, t->low) / 1e3,
        small_of(axis, t->high) / 1e3, is_rotary(axis) ? "deg" : "mm");
    (void)printf(
        "  inertia %.4g +- %.1g kg m2, viscous friction %.3g Nm s/rad, dry %.3g Nm, weight "
        "%.3g Nm, delay %.0f us\n",
        p->inertia_kg_m2, 2 * p->inertia_deviation_kg_m2, p->viscous_nm_s_per_rad, p->dry_nm,
        p->weight_nm, 1e6 * p->delay_s);
    (void)printf("  a step of %.3f %s without feed-forward; a move there and back\n\n",
                 small_of(axis, t->step), unit);
    (void)printf("          inertia  bandwidth  Ti       Kv   phase margin, deg overshoot  "
                 "following error, %s\n",
                 unit);
    (void)printf("          kg cm2      Hz       ms      1/s  velocity position   %%          max  "
                 "     rms\n");
    print_answer("before", &t->before, axis);
    print_answer("after", &t->after, axis);
    (void)printf("%s\n", t->is_kept ? "  what it has is as good: it is left as it is\n" : "");
}

/* -- files -- */

static const struct tuning_gains *gains_of(const struct tune_axis *t)
{
    return t->is_kept ? &t->before.gains : &t->after.gains;
}

static void write_section(FILE *file, const struct tune_axis *t, unsigned axis)
{
    (void)fprintf(file, "# axis %c: overshoot %.1f %%, following error %.3f %s%s\n",
                  AXIS_LETTERS[axis], 100 * (t->is_kept ? &t->before : &t->after)->overshoot,
                  small_of(axis, (t->is_kept ? &t->before : &t->after)->error_max),
                  small_name(axis), t->is_kept ? "; as it was" : "");
    if (t->bus > 0)
        (void)fprintf(file, "[drive %u:%u]\n", t->bus, t->node);
    else
        (void)fprintf(file, "[drive %u]\n", t->node);
    for (unsigned i = 0; i < LOOP_NUMBERS; i++)
        (void)fprintf(file, "%s = %.9g\n", loop_number[i].key, number_of(gains_of(t), i));
}

void tune_findings_write_sections(FILE *file, const struct tune_test *test)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (test->axis[i].is_measured)
            write_section(file, &test->axis[i], i);
    }
}

static void write_bytes(FILE *file, uint32_t value, unsigned bytes)
{
    uint8_t byte[4];

    little_endian_write32(byte, value);
    (void)fwrite(byte, 1, bytes, file);
}

/* Gains of the axis that was measured: a concise configuration (CiA 302, 1F22). */
void tune_findings_write_dcf(FILE *file, const struct tune_test *test)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        if (!test->axis[axis].is_measured)
            continue;
        write_bytes(file, LOOP_NUMBERS, 4);
        for (unsigned i = 0; i < LOOP_NUMBERS; i++) {
            write_bytes(file, LOOP_OBJECT, 2);
            write_bytes(file, i + 1, 1);
            write_bytes(file, loop_number[i].bytes, 4);
            write_bytes(file, loop_object_of(gains_of(&test->axis[axis]), i), loop_number[i].bytes);
        }
    }
}

static cJSON *answer_json(const struct tune_answer *a)
{
    cJSON *root = cJSON_CreateObject();

    for (unsigned i = 0; i < LOOP_NUMBERS; i++)
        cJSON_AddNumberToObject(root, loop_number[i].key, number_of(&a->gains, i));
    cJSON_AddBoolToObject(root, "is_steady", a->is_steady);
    cJSON_AddNumberToObject(root, "velocity_phase_margin_deg", a->margins.velocity_phase_deg);
    cJSON_AddNumberToObject(root, "position_phase_margin_deg", a->margins.position_phase_deg);
    cJSON_AddNumberToObject(root, "model_overshoot_ratio", a->margins.overshoot);
    cJSON_AddNumberToObject(root, "overshoot_ratio", a->overshoot);
    cJSON_AddNumberToObject(root, "following_error_max", a->error_max);
    cJSON_AddNumberToObject(root, "following_error_rms", a->error_rms);
    return root;
}

static cJSON *axis_json(const struct tune_axis *t, unsigned axis)
{
    const char letter[] = {AXIS_LETTERS[axis], '\0'};
    const struct tuning_plant *p = &t->plant;
    cJSON *root = cJSON_CreateObject();

    cJSON_AddStringToObject(root, "axis", letter);
    cJSON_AddStringToObject(root, "unit", is_rotary(axis) ? "rad" : "mm");
    cJSON_AddNumberToObject(root, "torque_nm", t->torque_nm);
    cJSON_AddNumberToObject(root, "moved_from", t->low);
    cJSON_AddNumberToObject(root, "moved_to", t->high);
    cJSON_AddNumberToObject(root, "inertia_kg_m2", p->inertia_kg_m2);
    cJSON_AddNumberToObject(root, "inertia_deviation_kg_m2", p->inertia_deviation_kg_m2);
    cJSON_AddNumberToObject(root, "viscous_friction_nm_s_per_rad", p->viscous_nm_s_per_rad);
    cJSON_AddNumberToObject(root, "dry_friction_nm", p->dry_nm);
    cJSON_AddNumberToObject(root, "weight_nm", p->weight_nm);
    cJSON_AddNumberToObject(root, "delay_s", p->delay_s);
    cJSON_AddNumberToObject(root, "step", t->step);
    cJSON_AddBoolToObject(root, "is_kept", t->is_kept);
    cJSON_AddItemToObject(root, "before", answer_json(&t->before));
    cJSON_AddItemToObject(root, "after", answer_json(&t->after));
    return root;
}

void tune_findings_write_json(FILE *file, const struct tune_test *test)
{
    cJSON *root = cJSON_CreateArray();
    char *text;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (test->axis[i].is_measured)
            cJSON_AddItemToArray(root, axis_json(&test->axis[i], i));
    }
    text = cJSON_Print(root);
    (void)fprintf(file, "%s\n", text != NULL ? text : "");
    cJSON_free(text);
    cJSON_Delete(root);
}

#define OLD  "#c2581b"
#define NEW  "#1f6fb4"
#define TOLD "#888"

static void draw_axis(FILE *file, const struct tune_axis *t, unsigned axis)
{
    const struct tune_answer *b = &t->before, *a = &t->after;
    const double um = small_of(axis, 1), from = t->relay.position[0];
    const double told = b->step.input[0], step = told < from ? -t->step : t->step;
    const char *unit = is_rotary(axis) ? "thousandths of a degree" : "um";
    const struct picture_curve relay[] = {{"position", NEW, &t->relay, PICTURE_POSITION, from, um}};
    const struct picture_curve steps[] = {
        {"told", TOLD, &b->step, PICTURE_INPUT, told - step, um},
        {"before", OLD, &b->step, PICTURE_POSITION, told - step, um},
        {"after", NEW, &a->step, PICTURE_POSITION, told - step, um},
    };
    const struct picture_curve move[] = {
        {"told", TOLD, &a->move, PICTURE_INPUT, a->move.input[0], um / 1e3}};
    const struct picture_curve lag[] = {
        {"before", OLD, &b->move, PICTURE_LAG, 0, um},
        {"after", NEW, &a->move, PICTURE_LAG, 0, um},
    };

    (void)fprintf(file, "<h2>Axis %c</h2>\n", AXIS_LETTERS[axis]);
    picture_write(file, "Relay test of the torque", unit, relay, 1);
    picture_write(file, "A step of the target, without feed-forward", unit, steps, 3);
    picture_write(file, "A move", is_rotary(axis) ? "deg" : "mm", move, 1);
    picture_write(file, "Following error of the move", unit, lag, 2);
}

static void write_row(FILE *file, const char *name, const struct tune_answer *a, unsigned axis)
{
    (void)fprintf(file, "<tr><th>%s</th>", name);
    for (unsigned i = 0; i < LOOP_NUMBERS; i++)
        (void)fprintf(file, "<td>%.6g</td>", number_of(&a->gains, i));
    (void)fprintf(file, "<td>%s</td><td>%.1f</td><td>%.1f</td><td>%.1f</td><td>%.3f</td></tr>\n",
                  a->is_steady ? "yes" : "no", a->margins.velocity_phase_deg,
                  a->margins.position_phase_deg, 100 * a->overshoot, small_of(axis, a->error_max));
}

void tune_findings_write_report(FILE *file, const struct tune_test *test)
{
    (void)fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                "<title>takt tune</title><style>body{font-family:sans-serif;margin:2em}"
                "td,th{padding:.2em .6em;text-align:right}svg{display:block}</style></head><body>\n"
                "<h1>Loops of the drives</h1>\n",
                file);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct tune_axis *t = &test->axis[i];

        if (!t->is_measured)
            continue;
        draw_axis(file, t, i);
        (void)fputs("<table><tr><th></th>", file);
        for (unsigned n = 0; n < LOOP_NUMBERS; n++)
            (void)fprintf(file, "<th>%s</th>", loop_number[n].key);
        (void)fprintf(file,
                      "<th>comes to rest</th><th>phase margin, velocity, deg</th><th>position</th>"
                      "<th>overshoot, %%</th><th>following error, %s</th></tr>\n",
                      small_name(i));
        write_row(file, "before", &t->before, i);
        write_row(file, "after", &t->after, i);
        (void)fputs("</table>\n", file);
    }
    (void)fputs("</body></html>\n", file);
}
