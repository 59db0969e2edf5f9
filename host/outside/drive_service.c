#define _POSIX_C_SOURCE 200809L

#include "outside/drive_service.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/text.h"
#include "drives/drive_event.h"
#include "drives/drive_store.h"
#include "drives/eds.h"
#include "simulation/bus_log.h"
#include "simulation/drive_images.h"

#include <stdlib.h>
#include <unistd.h>

/* Frames taken before the time is looked at again. */
#define FRAMES_PER_ROUND_MAX 256

/* Cycles a drive makes up for when it has been kept from running; what is more is lost time. */
#define CYCLES_BEHIND_MAX 100

/*
 * A controller that says nothing for so long is given up, as drives are by it
 * (simulation/lockstep.h).
 */
#define PATIENCE_NS UINT64_C(5000000000)

struct eds_text {
    char *bytes;
    size_t length;
};

struct drive_service {
    const struct drive_service_config *config;
    struct link *link;
    struct can_port port;
    uint64_t cycle_ns;
    uint64_t next_ns;    /* end of the cycle under way, by link_clock_ns */
    uint64_t departures; /* of others, seen so far */
    struct bus_log bus_log;
    struct eds_text eds[VIRTUAL_DRIVES_MAX];
    struct virtual_drives set;
    struct drive_images images;
    struct probe_contact contact;
};

static void log_event(void *context, const struct drive_event *event)
{
    FILE *log = context;

    drive_event_write(log, event);
    (void)fflush(log);
}

static void log_start(struct drive_service *service)
{
    FILE *log = service->config->log;

    if (log == NULL)
        return;
    (void)fprintf(log, "0.000000 bus %s\n", link_get_address(service->link));
    (void)fflush(log);
    virtual_drives_observe(&service->set, &(struct drive_observer){log_event, log});
}

/* Each drive gives its own data sheet away, object 1021. */
static bool make_eds(struct virtual_drive *drive, struct eds_text *text)
{
    FILE *stream = open_memstream(&text->bytes, &text->length);

    if (stream == NULL)
        return false;
    eds_write(stream, &drive->servo, "takt-drive.eds");
    if (fclose(stream) != 0)
        return false;
    virtual_drive_set_eds(drive, text->bytes, text->length);
    return true;
}

static void store_path(const struct drive_service *service, const struct servo *drive,
                       char path[OUTPUT_PATH_MAX])
{
    (void)snprintf(path, OUTPUT_PATH_MAX, "%s/takt-drive-%u.store", service->config->store,
                   (unsigned)drive->number);
}

/* A message says so when it fails; the drive tells its master. */
static bool keep_stored(void *context, const struct servo *drive)
{
    static _Thread_local struct output_file file;
    char path[OUTPUT_PATH_MAX];

    store_path(context, drive, path);
    if (!output_file_replace(&file, path, path))
        return false;
    drive_store_write(file.stream, drive);
    return output_file_finish(&file) && output_file_place(&file);
}

/* False after a message. A drive that has stored nothing has no file. */
static bool load_stored(struct drive_service *service, struct servo *drive)
{
    char path[OUTPUT_PATH_MAX];
    struct drive_store_problem wrong;
    struct text text;
    bool good;

    takt_servo_keep(drive, &(struct drive_keeper){keep_stored, service});
    store_path(service, drive, path);
    if (access(path, F_OK) != 0)
        return true;
    if (!text_read(&text, path))
        return false;
    good = drive_store_read(drive, text.bytes, text.length, &wrong);
    if (!good)
        message_error(path, wrong.line, 0, "%s", wrong.text);
    text_free(&text);
    return good;
}

static bool load_all_stored(struct drive_service *service)
{
    for (unsigned i = 0; i < service->set.count && service->config->store != NULL; i++) {
        if (!load_stored(service, &service->set.drive[i].servo))
            return false;
    }
    return true;
}

static bool make_all_eds(struct drive_service *service)
{
    for (unsigned i = 0; i < service->set.count; i++) {
        if (!make_eds(&service->set.drive[i], &service->eds[i])) {
            message_command_error("out of memory");
            return false;
        }
    }
    return true;
}

static enum command_status open_link(struct drive_service *service)
{
    struct link_config config = {.bitrate = service->config->rates.nominal,
                                 .data_bitrate = service->config->rates.data};
    struct link_error error;

    service->link = link_open(service->config->bus, &config, &error);
    if (service->link == NULL) {
        message_command_error("--bus: %s", error.text);
        return error.is_environment ? STATUS_ENVIRONMENT : STATUS_INPUT;
    }
    service->port = link_get_port(service->link);
    return STATUS_DONE;
}

static enum command_status start(struct drive_service *service)
{
    const struct drive_service_config *config = service->config;
    enum command_status status = open_link(service);

    if (status != STATUS_DONE)
        return status;
    if (!bus_log_open(&service->bus_log, config->bus_log))
        return STATUS_ENVIRONMENT;
    bus_log_observe_link(&service->bus_log, service->link);
    service->cycle_ns = (uint64_t)config->cycle_us * 1000;
    if (config->target != NULL &&
        !drive_images_open(&service->images, config->target, config->image, config->drives))
        return STATUS_ENVIRONMENT;
    virtual_drives_open(&service->set, &service->port, config->drives);
    if (!make_all_eds(service))
        return STATUS_ENVIRONMENT;
    if (!load_all_stored(service))
        return STATUS_INPUT;
    if (config->script != NULL)
        virtual_drives_inject(&service->set, config->script);
    probe_contact_wire(&service->contact, config->probe, config->machine, &service->set);
    log_start(service);
    virtual_drives_boot(&service->set);
    service->next_ns = link_clock_ns() + service->cycle_ns;
    return STATUS_DONE;
}

static void take_frames(struct drive_service *service)
{
    struct can_frame frame;

    for (unsigned n = 0; n < FRAMES_PER_ROUND_MAX; n++) {
        if (!service->port.receive(service->port.context, &frame))
            return;
        if (service->config->is_paced)
            virtual_drives_take(&service->set, &frame);
        else
            (void)virtual_drives_take_by_sync(&service->set, &frame);
    }
}

static void look_who_left(struct drive_service *service)
{
    const uint64_t departures = link_get_counts(service->link)->departures;

    if (departures != service->departures || !link_hears_departures(service->link))
        virtual_drives_leave(&service->set);
    service->departures = departures;
}

/* The cycles that have gone by on the wall clock. */
static void keep_time(struct drive_service *service)
{
    uint64_t now_ns = link_clock_ns();
    bool by_sync = !service->config->is_paced && virtual_drives_follow_sync(&service->set);

    if (now_ns > service->next_ns + CYCLES_BEHIND_MAX * service->cycle_ns)
        service->next_ns = now_ns;
    for (; service->next_ns <= now_ns; service->next_ns += service->cycle_ns) {
        if (by_sync)
            virtual_drives_wait(&service->set, (uint32_t)service->cycle_ns, PATIENCE_NS);
        else
            virtual_drives_step(&service->set, (uint32_t)service->cycle_ns);
    }
}

/* False after a message: an image has gone, or does not do what the drive here does. */
static bool check_images(struct drive_service *service)
{
    const char *problem = drive_images_problem(&service->images);
    char first[DRIVE_IMAGES_FIRST_MAX];

    if (problem != NULL) {
        message_command_error("%s", problem);
        return false;
    }
    if (drive_images_differences(&service->images) == 0)
        return true;
    drive_images_write_first(&service->images, first);
    message_command_error("%s: the image sends or turns what the drive here does not", first);
    return false;
}

static enum command_status run(struct drive_service *service)
{
    while (!interrupt_asked()) {
        if (link_wait(service->link, service->next_ns) == LINK_BROKEN) {
            message_command_error("--bus: %s", link_get_problem(service->link));
            return STATUS_ENVIRONMENT;
        }
        take_frames(service);
        look_who_left(service);
        keep_time(service);
        bus_log_keep(&service->bus_log);
        if (!check_images(service))
            return STATUS_ENVIRONMENT;
    }
    return STATUS_DONE;
}

enum command_status drive_service_run(const struct drive_service_config *config)
{
    struct drive_service *service = calloc(1, sizeof *service);
    enum command_status status;

    if (service == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    service->config = config;
    status = start(service);
    if (status == STATUS_DONE)
        status = run(service);
    drive_images_close(&service->images);
    link_close(service->link);
    if (!bus_log_close(&service->bus_log) && status == STATUS_DONE)
        status = STATUS_ENVIRONMENT;
    for (unsigned i = 0; i < VIRTUAL_DRIVES_MAX; i++)
        free(service->eds[i].bytes);
    free(service);
    return status;
}
