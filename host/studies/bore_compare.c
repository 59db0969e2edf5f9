#define _GNU_SOURCE

#include "studies/bore_compare.h"

#include "base/maths.h"
#include "bore/picture.h"
#include "bore/removal.h"
#include "bore/rival.h"
#include "bore/write.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "config/machine_file.h"
#include "session/session.h"
#include "simulation/simulation.h"

#include <stdlib.h>
#include <string.h>

/* Cycles between two looks at Ctrl-C. */
#define LOOK_CYCLES 4096

struct comparison {
    const struct bore_job *job;
    struct bore_spiral spiral;
    struct session session; /* of one program after the other */
    struct bore_track track[BORE_RIVALS];
    double length_mm[BORE_RIVALS];
    struct bore_removal removal[BORE_RIVALS];
    struct bore_removal helix_level; /* of one level of a helix */
    unsigned rivals;                 /* that are run */
    double down_mm;                  /* of the helix */
};

static enum command_status out_of_memory(void)
{
    message_command_error("out of memory");
    return STATUS_ENVIRONMENT;
}

/* The program of a spiral, in memory. */
static bool write_rival(struct comparison *c, enum bore_rival rival)
{
    struct text *text = &c->session.program.whole;
    struct bore_path path;
    FILE *stream = open_memstream(&text->bytes, &text->length);
    bool good = stream != NULL;

    bore_rival_path(rival, c->spiral.radius_mm, (unsigned)c->spiral.turns, c->job->tolerance_mm,
                    c->down_mm, &path);
    text->name = bore_rival_name(rival);
    c->session.program.name = text->name;
    if (good) {
        bore_write_path(stream, text->name, &path, c->job->feed_mm_min);
        good = fclose(stream) == 0 && !path.failed;
    }
    bore_path_free(&path);
    return good;
}

/* False: memory is short, or interrupted. */
static bool follow(struct comparison *c, enum bore_rival rival, struct simulation *s)
{
    struct bore_track *track = &c->track[rival];
    bool good = true;

    bore_track_begin(track, bore_rival_name(rival), 1e-6 * c->session.setup.machine.cycle_us);
    while (good && takt_controller_get_state(&s->controller) < CONTROLLER_COMPLETED) {
        const struct cycle_record *record;

        good = simulation_step(s);
        record = takt_controller_get_record(&s->controller);
        if (record != NULL)
            good = good && bore_track_add(track, record->set.at[AXIS_X], record->set.at[AXIS_Y],
                                          record->set.at[AXIS_Z]);
        if (s->cycles % LOOK_CYCLES == 0)
            good = good && !interrupt_asked();
    }
    return good;
}

/* Length of the polygon of setpoints: of the path but for chord errors. */
static double track_length(const struct bore_track *t)
{
    double length_mm = 0;

    for (size_t i = 1; i < t->count; i++)
        length_mm += bore_track_motion(t, i).feed_mm_s * t->cycle_s;
    return length_mm;
}

static enum command_status run_checked(struct comparison *c, enum bore_rival rival)
{
    struct simulation *s;
    enum command_status status = simulation_open(&c->session, &s);

    if (status != STATUS_DONE)
        return status;
    if (!follow(c, rival, s))
        status = interrupt_asked() ? STATUS_INTERRUPTED : out_of_memory();
    else if (takt_controller_get_state(&s->controller) == CONTROLLER_FAULTED) {
        message_program_error(&c->session.program, takt_controller_get_fault(&s->controller));
        status = STATUS_FAILED;
    }
    c->length_mm[rival] = track_length(&c->track[rival]);
    simulation_close(s);
    return status;
}

/* False: memory is short. */
static bool measure(struct comparison *c, enum bore_rival rival)
{
    const struct bore_track *track = &c->track[rival];
    const double cutter_mm = 0.5 * c->job->cutter_mm;

    return rival == BORE_RIVAL_HELIX
               ? bore_removal_make_helix(&c->removal[rival], &c->helix_level, track, cutter_mm,
                                         c->down_mm, (unsigned)c->spiral.turns + 2)
               : bore_removal_make(&c->removal[rival], track, cutter_mm);
}

static enum command_status run_rival(struct comparison *c, enum bore_rival rival)
{
    struct session_totals totals;
    enum command_status status;

    if (!write_rival(c, rival))
        return out_of_memory();
    status = session_check(&c->session, 1, &totals);
    if (status == STATUS_DONE)
        status = run_checked(c, rival);
    if (status == STATUS_DONE && !measure(c, rival))
        status = out_of_memory();
    program_text_close(&c->session.program);
    return status;
}

/* The smaller limits of the axes of the plane. */
static struct bore_motion limits_of(const struct machine *machine)
{
    const struct machine_axis *x = &machine->axis[AXIS_X];
    const struct machine_axis *y = &machine->axis[AXIS_Y];

    return (struct bore_motion){
        x->max_velocity_mm_s < y->max_velocity_mm_s ? x->max_velocity_mm_s : y->max_velocity_mm_s,
        x->max_acceleration_mm_s2 < y->max_acceleration_mm_s2 ? x->max_acceleration_mm_s2
                                                              : y->max_acceleration_mm_s2,
        x->max_jerk_mm_s3 < y->max_jerk_mm_s3 ? x->max_jerk_mm_s3 : y->max_jerk_mm_s3,
    };
}

/*
 * The first turn has none before it; the last joined arc ends part of a turn before the circle
 * begins.
 */
#define FIRST_TURN     1.25
#define BEFORE_CIRCLE  0.5
#define DEGREES(angle) (180.0 / MATHS_PI * (angle))

static void print_removal(FILE *stream, const struct comparison *c)
{
    (void)fprintf(stream, "\n  %-26s %22s %26s %20s\n", "removed", "layer [mm]",
                  "chip area/depth [mm]", "engaged [deg]");
    for (unsigned i = 0; i < c->rivals; i++) {
        struct bore_evenness e;

        bore_removal_evenness(&c->removal[i], FIRST_TURN, c->spiral.turns - BEFORE_CIRCLE, &e);
        if (!(e.layer_mm.most >= e.layer_mm.least))
            continue;
        (void)fprintf(stream, "  %-26s %10.4f .. %8.4f %14.4f .. %8.4f %10.2f .. %6.2f\n",
                      c->track[i].name, e.layer_mm.least, e.layer_mm.most, e.width_mm.least,
                      e.width_mm.most, DEGREES(e.engaged_rad.least), DEGREES(e.engaged_rad.most));
    }
}

static void print_level(FILE *stream, const struct comparison *c)
{
    struct bore_evenness e;

    bore_removal_evenness(&c->helix_level, 0, 1, &e);
    (void)fprintf(stream,
                  "  The helix: the mean of all levels that are under way at a moment; at each of "
                  "them %.2f .. %.2f deg are engaged.\n",
                  DEGREES(e.engaged_rad.least), DEGREES(e.engaged_rad.most));
}

static void print_helix(FILE *stream, const struct comparison *c)
{
    const struct bore_job *job = c->job;

    if (c->rivals == BORE_RIVALS) {
        print_level(stream, c);
        return;
    }
    if (2 * c->spiral.radius_mm <= job->cutter_mm) {
        (void)fprintf(stream, "  A helix is not among them: it needs --depth.\n");
        return;
    }
    (void)fprintf(
        stream,
        "  A helix is not among them: it leaves a core unless the cutter exceeds half the "
        "hole, %g mm.\n",
        0.5 * job->hole_mm);
}

static void print_table(FILE *stream, const struct comparison *c)
{
    struct bore_motion limit = limits_of(&c->session.setup.machine);

    (void)fprintf(stream,
                  "hole %g mm, cutter %g mm: %g turns to a radius of %g mm and the circle, feed %g "
                  "mm/min\n%s: %g mm/s2, %g mm/s3\n\n"
                  "  %-26s %12s %14s %28s %26s\n",
                  c->job->hole_mm, c->job->cutter_mm, c->spiral.turns, c->spiral.radius_mm,
                  c->job->feed_mm_min, c->session.setup.machine.name, limit.acceleration_mm_s2,
                  limit.jerk_mm_s3, "spiral", "time [s]", "length [mm]",
                  "peak acceleration [mm/s2]", "peak jerk [mm/s3]");
    for (unsigned i = 0; i < c->rivals; i++) {
        const struct bore_track *t = &c->track[i];
        struct bore_motion most = bore_track_peaks(t, 0, t->count);

        (void)fprintf(stream, "  %-26s %12.3f %14.3f %20.3f %5.1f %% %18.1f %5.1f %%\n", t->name,
                      bore_track_time(t), c->length_mm[i], most.acceleration_mm_s2,
                      100 * most.acceleration_mm_s2 / limit.acceleration_mm_s2, most.jerk_mm_s3,
                      100 * most.jerk_mm_s3 / limit.jerk_mm_s3);
    }
    print_removal(stream, c);
    print_helix(stream, c);
}

static enum command_status draw(const struct comparison *c, const char *path)
{
    struct bore_picture picture = {
        .track = c->track,
        .removal = c->removal,
        .tracks = c->rivals,
        .turns = c->spiral.turns,
        .radius_mm = c->spiral.radius_mm,
        .limit = limits_of(&c->session.setup.machine),
    };
    static _Thread_local struct output_file file;
    bool good = output_file_open(&file, path);

    if (good) {
        bore_picture_write(file.stream, &picture);
        good = output_file_finish(&file) && output_file_place(&file);
    }
    output_file_discard(&file);
    return good ? STATUS_DONE : STATUS_ENVIRONMENT;
}

static enum command_status compare(struct comparison *c, const struct options *options)
{
    enum command_status status = STATUS_DONE;
    bool picture_to_stdout = options->output != NULL && strcmp(options->output, "-") == 0;

    c->session.options = options;
    takt_parameters_clear(&c->session.parameters.values);
    if (!machine_file_load(&c->session.setup, options))
        return STATUS_INPUT;
    for (unsigned i = 0; i < c->rivals && status == STATUS_DONE; i++)
        status = run_rival(c, (enum bore_rival)i);
    if (status == STATUS_DONE && options->output != NULL)
        status = draw(c, options->output);
    if (status == STATUS_DONE)
        print_table(picture_to_stdout ? stderr : stdout, c);
    return status;
}

enum command_status bore_compare(const struct bore_job *job, const struct options *options)
{
    struct comparison *c = calloc(1, sizeof *c);
    enum command_status status;

    if (c == NULL)
        return out_of_memory();
    c->job = job;
    bore_set_spiral(job, BORE_ROUGHING, &c->spiral);
    c->down_mm = job->depth_mm / bore_depth_steps(job);
    c->rivals = c->down_mm > 0 && 2 * c->spiral.radius_mm <= job->cutter_mm ? BORE_RIVALS
                                                                            : BORE_RIVAL_HELIX;
    status = compare(c, options);
    for (unsigned i = 0; i < BORE_RIVALS; i++) {
        bore_track_free(&c->track[i]);
        bore_removal_free(&c->removal[i]);
    }
    bore_removal_free(&c->helix_level);
    free(c);
    return status;
}
