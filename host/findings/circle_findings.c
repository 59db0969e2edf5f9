#include "findings/circle_findings.h"

#include "circle/picture.h"

#include <math.h>
#include <stddef.h>

void circle_findings_take(struct circle_findings *found)
{
    const struct circle_turn *const turn[] = {&found->test.turn[CIRCLE_CCW],
                                              &found->test.turn[CIRCLE_CW]};

    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        circle_figures_of(&turn[way], 1, &found->figures[way]);
    circle_figures_of(turn, CIRCLE_WAYS, &found->figures[CIRCLE_WAYS]);
}

/* In um, without a minus before 0.000. */
static double shown_um(double mm)
{
    return round(1e6 * mm) / 1000 + 0.0;
}

static void print_row(const struct circle_findings *found, const char *name, size_t field)
{
    (void)printf("  %-34s", name);
    for (unsigned i = 0; i <= CIRCLE_WAYS; i++)
        (void)printf(" %9.3f",
                     1000 *
                         *(const double *)(const void *)((const char *)&found->figures[i] + field));
    (void)fputc('\n', stdout);
}

/* At the end of an axis' way on which side: + first, + second, - first, - second. */
static void print_reversals(const struct circle_findings *found)
{
    for (unsigned quadrant = 0; quadrant < CIRCLE_QUADRANTS; quadrant++) {
        const char axis = AXIS_LETTERS[found->axis[quadrant % 2]];

        (void)printf("  reversal at %c%c, step               ", quadrant < 2 ? '+' : '-', axis);
        for (unsigned way = 0; way < CIRCLE_WAYS; way++)
            (void)printf(" %9.3f", shown_um(found->figures[way].reversal[quadrant].step_mm));
        (void)printf("\n                  spike              ");
        for (unsigned way = 0; way < CIRCLE_WAYS; way++)
            (void)printf(" %9.3f", shown_um(found->figures[way].reversal[quadrant].spike_mm));
        (void)fputc('\n', stdout);
    }
}

void circle_findings_print(const struct circle_findings *found)
{
    const struct circle_test *t = &found->test;

    (void)printf("circle about %c %g %c %g, R %g mm, F%g: um\n\n", AXIS_LETTERS[found->axis[0]],
                 t->centre_mm[0], AXIS_LETTERS[found->axis[1]], t->centre_mm[1], t->radius_mm,
                 t->feed_mm_min);
    (void)printf("  %-34s %9s %9s %9s\n", "", "G3", "G2", "both");
    print_row(found, "circular deviation G", offsetof(struct circle_figures, deviation_mm));
    print_row(found, "radial deviation F max", offsetof(struct circle_figures, most_mm));
    print_row(found, "                 F min", offsetof(struct circle_figures, least_mm));
    print_row(found, "radius, from the programmed one",
              offsetof(struct circle_figures, radius_out_mm));
    print_row(found, "centre, first axis", offsetof(struct circle_figures, centre_mm));
    print_row(found, "        second axis",
              offsetof(struct circle_figures, centre_mm) + sizeof(double));
    print_reversals(found);
}

static char *json_text(const struct circle_findings *found)
{
    static const char *const names[] = {"ccw", "cw", "both"};
    const struct circle_test *t = &found->test;
    const char plane[] = {AXIS_LETTERS[found->axis[0]], AXIS_LETTERS[found->axis[1]], '\0'};
    cJSON *root = cJSON_CreateObject();
    char *text;

    cJSON_AddStringToObject(root, "plane", plane);
    cJSON_AddItemToObject(root, "centre_mm", cJSON_CreateDoubleArray(t->centre_mm, 2));
    cJSON_AddNumberToObject(root, "radius_mm", t->radius_mm);
    cJSON_AddNumberToObject(root, "feed_mm_min", t->feed_mm_min);
    cJSON_AddNumberToObject(root, "feed_reached_mm_min", t->reached_mm_min);
    for (unsigned i = 0; i <= CIRCLE_WAYS; i++)
        cJSON_AddItemToObject(root, names[i], circle_figures_json(&found->figures[i]));
    text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}

void circle_findings_write_picture(FILE *file, const struct circle_findings *found)
{
    const struct circle_picture picture = {
        .axis = {AXIS_LETTERS[found->axis[0]], AXIS_LETTERS[found->axis[1]]},
        .radius_mm = found->test.radius_mm,
        .feed_mm_min = found->test.feed_mm_min,
        .turn = found->test.turn,
        .figures = found->figures,
    };

    circle_picture_write(file, &picture);
}

void circle_findings_write_json(FILE *file, const struct circle_findings *found)
{
    char *text = json_text(found);

    (void)fprintf(file, "%s\n", text != NULL ? text : "");
    cJSON_free(text);
}
