#include "drives/virtual_drives.h"
#include "canopen/target_pdo.h"

#include <assert.h>
#include <string.h>

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

static void on_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    (void)time_ns;
    virtual_drive_on_frame(context, frame);
}

void virtual_drives_init(struct virtual_drives *set, struct bus *bus,
                         const struct virtual_drives_config *config)
{
    uint8_t node[VIRTUAL_DRIVES_MAX];
    assert(config->count >= 1 && config->count <= VIRTUAL_DRIVES_MAX);
    set->count = config->count;
    for (unsigned i = 0; i < set->count; i++)
        node[i] = config->drive[i].node;
    for (unsigned i = 0; i < set->count; i++) {
        struct virtual_drive *drive = &set->drive[i];
        struct pdo target;
        target_pdo_set(&target, node, set->count, i);
        struct can_port port = bus_attach(bus, &(struct bus_listener){on_frame, drive});
        virtual_drive_init(drive, &config->drive[i], &target, &port);
        virtual_drive_boot(drive);
    }
}

void virtual_drives_step(struct virtual_drives *set, uint32_t cycle_ns)
{
    for (unsigned i = 0; i < set->count; i++)
        virtual_drive_step(&set->drive[i], cycle_ns);
}
