#include "drives/virtual_drives.h"
#include "canopen/target_pdo.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

/* Longer is no cycle: such drives keep their own time. */
#define SYNC_PERIOD_MAX_US 1000000

void virtual_drives_set_default(struct virtual_drives_config *config, unsigned count)
{
    assert(count >= 1 && count <= VIRTUAL_DRIVES_MAX);
    memset(config, 0, sizeof *config);
    config->count = count;
    for (unsigned i = 0; i < count; i++) {
        config->drive[i].node = (uint8_t)(i + 1);
        config->drive[i].increments_per_mm = 100000;
        drive_plant_set_default(&config->drive[i].plant);
    }
}

static void start(struct virtual_drives *set, const struct virtual_drives_config *config)
{
    assert(config->count <= VIRTUAL_DRIVES_MAX);
    memset(set, 0, offsetof(struct virtual_drives, drive)); /* each is switched on by itself */
    set->count = config->count;
    while (set->motors < set->count && !config->drive[set->motors].is_io)
        set->motors++;
    set->clock.enabled_ns = INJECT_ALWAYS;
}

static void on_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    virtual_drive_on_frame_at(context, frame, time_ns);
}

/* RPDO2 of a motor, by the motors of its bus. */
static void set_target(struct pdo *target, const struct virtual_drives *set,
                       const struct virtual_drives_config *config, unsigned index, unsigned group)
{
    uint8_t node[VIRTUAL_DRIVES_MAX];
    unsigned count = 0, place = 0;
    for (unsigned i = 0; i < set->motors; i++) {
        if (config->drive[i].bus != config->drive[index].bus)
            continue;
        if (i == index)
            place = count;
        node[count++] = config->drive[i].node;
    }
    takt_target_pdo_set(target, node, count, place, group);
}

unsigned virtual_drives_on_bus(const struct virtual_drives *set, unsigned bus,
                               uint8_t node[VIRTUAL_DRIVES_MAX])
{
    unsigned count = 0;
    for (unsigned i = 0; i < set->count; i++)
        if (set->drive[i].bus == bus)
            node[count++] = set->drive[i].servo.config.node;
    return count;
}

void virtual_drives_init(struct virtual_drives *set, struct bus bus[],
                         const struct virtual_drives_config *config)
{
    const unsigned group = bus_is_fd(&bus[0]) ? TARGET_PDO_FD : TARGET_PDO_PAIR;
    start(set, config);
    for (unsigned i = 0; i < set->count; i++) {
        struct virtual_drive *drive = &set->drive[i];
        struct virtual_drive_config own = config->drive[i];
        struct pdo target;
        if (i < set->motors)
            set_target(&target, set, config, i, group);
        const struct bus_listener listener = {on_frame, drive};
        struct can_port port = bus_attach_filtered(&bus[own.bus], &listener, drive->servo.accepts);
        own.is_fd = bus_is_fd(&bus[own.bus]);
        virtual_drive_init(drive, &own, i < set->motors ? &target : NULL, &port);
        virtual_drive_boot(drive);
    }
}

/*
 * What one drive says the others of this process hear, too; a bus gives it only to other processes.
 */
static bool send_own(void *context, const struct can_frame *frame)
{
    const struct virtual_drives_port *way = context;
    struct virtual_drives *set = way->set;
    if (!set->port.send(set->port.context, frame))
        return false;
    if (set->own_count < VIRTUAL_DRIVES_OWN_FRAMES_MAX)
        set->own[set->own_count++] = (struct virtual_drives_own){way->index, *frame};
    return true;
}

static bool receive_nothing(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

void virtual_drives_open(struct virtual_drives *set, const struct can_port *port,
                         const struct virtual_drives_config *config)
{
    start(set, config);
    set->port = *port;
    for (unsigned i = 0; i < set->count; i++) {
        set->way[i] = (struct virtual_drives_port){set, i};
        const struct can_port port_own = {send_own, receive_nothing, &set->way[i]};
        struct virtual_drive_config own = config->drive[i];
        own.is_fd = config->is_fd;
        virtual_drive_init(&set->drive[i], &own, NULL, &port_own);
    }
}

/* Drives may answer each other; the round ends because no drive answers an answer. */
static void hand_round(struct virtual_drives *set)
{
    for (unsigned n = 0; n < set->own_count; n++) {
        const struct virtual_drives_own own = set->own[n];
        for (unsigned i = 0; i < set->count; i++)
            if (i != own.sender)
                virtual_drive_on_frame(&set->drive[i], &own.frame);
    }
    set->own_count = 0;
}

void virtual_drives_boot(struct virtual_drives *set)
{
    for (unsigned i = 0; i < set->count; i++)
        virtual_drive_boot(&set->drive[i]);
    hand_round(set);
}

void virtual_drives_observe(struct virtual_drives *set, const struct drive_observer *observer)
{
    for (unsigned i = 0; i < set->count; i++)
        virtual_drive_observe(&set->drive[i], observer);
}

void virtual_drives_inject(struct virtual_drives *set, const struct inject *script)
{
    for (unsigned i = 0; i < set->count; i++)
        virtual_drive_inject(&set->drive[i], script, &set->clock);
}

/* I/O nodes first: when the last drive has answered a SYNC, everybody has. */
void virtual_drives_take(struct virtual_drives *set, const struct can_frame *frame)
{
    for (unsigned i = set->motors; i < set->count; i++)
        virtual_drive_on_frame(&set->drive[i], frame);
    for (unsigned i = 0; i < set->motors; i++)
        virtual_drive_on_frame(&set->drive[i], frame);
    hand_round(set);
}

static bool all_enabled(const struct virtual_drives *set)
{
    for (unsigned i = 0; i < set->motors; i++)
        if (virtual_drive_get_state(&set->drive[i]) != CIA402_ENABLED)
            return false;
    return true;
}

void virtual_drives_set_contact(struct virtual_drives *set,
                                const struct virtual_drives_contact *contact)
{
    set->contact = *contact;
}

/* When so much of the last cycle had passed. */
static bool touched_at(const struct virtual_drives *set, double ratio)
{
    double position_mm[VIRTUAL_DRIVES_MAX] = {0};
    for (unsigned i = 0; i < set->motors; i++)
        position_mm[i] = takt_servo_get_position_at_mm(&set->drive[i].servo, ratio);
    return set->contact.touches(set->contact.context, position_mm);
}

/* Halvings of a cycle: fewer increments than 2^32 are passed in it. */
#define HALVINGS 32

/*
 * The edge lies between two moments of the last cycle; what touches for less than a cycle is not
 * seen.
 */
static void look_for_contact(struct virtual_drives *set)
{
    bool touches = touched_at(set, 1);
    double before = 0, after = 1;
    if (touches == set->touches)
        return;
    for (unsigned i = 0; i < HALVINGS; i++) {
        double middle = (before + after) / 2;
        if (touched_at(set, middle) == touches)
            after = middle;
        else
            before = middle;
    }
    set->touches = touches;
    for (unsigned i = 0; i < set->motors; i++)
        virtual_drive_touch(&set->drive[i], touches, after);
}

void virtual_drives_step(struct virtual_drives *set, uint32_t cycle_ns)
{
    for (unsigned i = 0; i < set->count; i++)
        virtual_drive_step(&set->drive[i], cycle_ns);
    if (set->contact.touches != NULL)
        look_for_contact(set);
    if (set->own_count > 0)
        hand_round(set);
    set->clock.now_ns += cycle_ns;
    if (set->clock.enabled_ns == INJECT_ALWAYS && all_enabled(set))
        set->clock.enabled_ns = set->clock.now_ns;
}

const struct inject_clock *virtual_drives_get_clock(const struct virtual_drives *set)
{
    return &set->clock;
}

/* The period of SYNC; 0: not all drives have been told the same. */
static uint32_t sync_period_us(const struct virtual_drives *set)
{
    uint32_t period_us = set->motors > 0 ? takt_servo_get_sync_period_us(&set->drive[0].servo) : 0;
    for (unsigned i = 1; i < set->motors; i++)
        if (takt_servo_get_sync_period_us(&set->drive[i].servo) != period_us)
            return 0;
    return period_us <= SYNC_PERIOD_MAX_US ? period_us : 0;
}

bool virtual_drives_follow_sync(const struct virtual_drives *set)
{
    return sync_period_us(set) != 0;
}

/* Without a heartbeat to watch: that of the built-in machine, 100 ms, three times. */
#define HEARTBEAT_TIME_MS 300

#define MILLISECOND_NS 1000000u

static uint32_t shortest_heartbeat_ms(const struct virtual_drives *set)
{
    uint32_t shortest_ms = 0;
    for (unsigned i = 0; i < set->count; i++) {
        uint32_t watched_ms = takt_servo_get_watched_ms(&set->drive[i].servo);
        if (watched_ms != 0 && (shortest_ms == 0 || watched_ms < shortest_ms))
            shortest_ms = watched_ms;
    }
    return shortest_ms != 0 ? shortest_ms : HEARTBEAT_TIME_MS;
}

static bool any_enabled(const struct virtual_drives *set)
{
    for (unsigned i = 0; i < set->motors; i++)
        if (virtual_drive_get_state(&set->drive[i]) == CIA402_ENABLED)
            return true;
    return false;
}

void virtual_drives_wait(struct virtual_drives *set, uint32_t waited_ns, uint64_t patience_ns)
{
    uint32_t period_us = sync_period_us(set);
    if (set->is_left)
        patience_ns = (uint64_t)shortest_heartbeat_ms(set) * MILLISECOND_NS * 2 / 3;
    if (period_us == 0 || (set->alone_ns == 0 && !any_enabled(set)))
        return;
    set->silent_ns += waited_ns;
    for (; set->silent_ns >= patience_ns + set->alone_ns;
         set->alone_ns += (uint64_t)period_us * 1000)
        virtual_drives_step(set, period_us * 1000);
}

void virtual_drives_leave(struct virtual_drives *set)
{
    set->is_left = true;
}

bool virtual_drives_take_by_sync(struct virtual_drives *set, const struct can_frame *frame)
{
    uint32_t period_us = sync_period_us(set);
    bool is_sync = takt_servo_is_sync(&set->drive[0].servo, frame);
    if (is_sync) {
        set->is_left = false;
        set->silent_ns = set->alone_ns = 0;
    }
    if (is_sync && period_us != 0 && set->has_sync)
        virtual_drives_step(set, period_us * 1000);
    virtual_drives_take(set, frame);
    set->has_sync = period_us != 0 && (set->has_sync || is_sync);
    return period_us != 0;
}
