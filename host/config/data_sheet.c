#include "config/data_sheet.h"

#include "cli/message.h"
#include "cli/text.h"
#include "drives/dictionary_read.h"

bool data_sheet_load(struct dictionary *dictionary, const char *path)
{
    struct dictionary_problem wrong;
    struct text text;

    if (!text_read(&text, path))
        return false;
    bool good = dictionary_read(dictionary, text.bytes, text.length, &wrong);

    if (!good)
        message_error(path, wrong.line, 0, "%s", wrong.text);
    text_free(&text);
    return good;
}

void data_sheet_set_io(struct virtual_drive_config *drive, const struct io_wiring *wiring)
{
    *drive = (struct virtual_drive_config){
        .node = wiring->node, .bus = wiring->bus, .increments_per_mm = 1, .is_io = true};
    drive_plant_set_default(&drive->plant);
    for (unsigned i = 0; i < IO_BITS_MAX; i++) {
        if (wiring->input[i] == IO_STOP || wiring->input[i] == IO_LIMIT)
            drive->closed |= (uint16_t)(1U << i);
    }
}

static bool add_drive(struct virtual_drives_config *config, const struct machine_setup *setup,
                      unsigned index, struct dictionary *sheet)
{
    const struct machine *machine = &setup->machine;
    const struct machine_gantry *gantry =
        index < MACHINE_SECOND_DRIVE ? NULL : &machine->gantry[index - MACHINE_SECOND_DRIVE];
    const struct machine_axis *axis = &machine->axis[gantry != NULL ? gantry->axis : index];
    const bool is_reversed = gantry != NULL && gantry->is_reversed;
    struct virtual_drive_config *drive = &config->drive[config->count++];

    *drive = (struct virtual_drive_config){
        .node = gantry != NULL ? gantry->drive_node : axis->drive_node,
        .bus = gantry != NULL ? gantry->drive_bus : axis->drive_bus,
        .increments_per_mm = is_reversed ? -axis->increments_per_mm : axis->increments_per_mm,
        .velocity_units_per_mm_s = axis->velocity_units_per_mm_s,
        .cycle_us = machine->cycle_us,
    };
    return data_sheet_set_drive(drive, &setup->drive[index], sheet);
}

bool data_sheet_set_machine(struct virtual_drives_config *config, const struct machine_setup *setup,
                            struct dictionary sheet[DATA_SHEETS_MAX])
{
    config->count = 0;
    config->is_fd = setup->machine.can_data_bitrate > 0;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&setup->machine.axis[i]) &&
            !add_drive(config, setup, i, &sheet[i]))
            return false;
    }
    for (unsigned i = 0; i < takt_machine_gantry_count(&setup->machine); i++) {
        const unsigned index = MACHINE_SECOND_DRIVE + i;

        if (!add_drive(config, setup, index, &sheet[index]))
            return false;
    }
    for (unsigned i = 0; i < takt_machine_io_count(&setup->machine); i++)
        data_sheet_set_io(&config->drive[config->count++], &setup->machine.io[i]);
    return true;
}

bool data_sheet_set_drive(struct virtual_drive_config *drive, const struct machine_drive *config,
                          struct dictionary *sheet)
{
    drive->plant = config->plant;
    drive->boot_us = 1000 * config->boot_ms;
    drive->sdo_us = 1000 * config->sdo_ms;
    if (config->eds[0] == '\0')
        return true;
    drive->dictionary = sheet;
    return data_sheet_load(sheet, config->eds);
}
