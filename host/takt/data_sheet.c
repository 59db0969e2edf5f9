#include "takt/data_sheet.h"

#include "takt/message.h"
#include "takt/text.h"

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
    *drive =
        (struct virtual_drive_config){.node = wiring->node, .increments_per_mm = 1, .is_io = true};
    drive_plant_set_default(&drive->plant);
    for (unsigned i = 0; i < IO_BITS_MAX; i++) {
        if (wiring->input[i] == IO_STOP || wiring->input[i] == IO_LIMIT)
            drive->closed |= (uint16_t)(1U << i);
    }
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
