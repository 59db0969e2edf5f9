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
