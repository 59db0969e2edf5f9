#include "simulation/probe_contact.h"

static bool touches(void *context, const double position_mm[VIRTUAL_DRIVES_MAX])
{
    const struct probe_contact *contact = context;
    struct point at = contact->at;

    for (unsigned i = 0; i < contact->count; i++) {
        if (contact->axis[i] != AXIS_COUNT)
            at.at[contact->axis[i]] = position_mm[i];
    }
    return virtual_probe_touches(contact->probe, &at);
}

static enum axis axis_of(const struct machine *machine, uint8_t node)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i]) && machine->axis[i].drive_node == node)
            return (enum axis)i;
    }
    return AXIS_COUNT;
}

void probe_contact_wire(struct probe_contact *contact, const struct virtual_probe *probe,
                        const struct machine *machine, struct virtual_drives *drives)
{
    *contact = (struct probe_contact){.probe = probe, .count = drives->motors};
    for (unsigned i = 0; i < drives->motors; i++)
        contact->axis[i] = axis_of(machine, drives->drive[i].servo.config.node);
    if (probe->solids > 0)
        virtual_drives_set_contact(drives, &(struct virtual_drives_contact){touches, contact});
}
