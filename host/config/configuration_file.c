#include "config/configuration_file.h"

#include "canopen/sdo.h"
#include "canopen/sdo_client.h"
#include "cli/message.h"

/* The first four bytes are a number of entries, which is far below 2^24. */
static bool is_text(const struct text *text)
{
    return text->length >= 4 && text->bytes[3] != '\0';
}

static bool load(struct text *text, struct concise_dcf *dcf, const char *path)
{
    uint32_t object;

    if (!text_read(text, path))
        return false;
    if (text->length > UINT32_MAX) {
        message_error(path, 0, 0, "this is too long");
        return false;
    }
    *dcf = (struct concise_dcf){.bytes = (const uint8_t *)text->bytes,
                                .length = (uint32_t)text->length};
    if (takt_concise_dcf_is_well(dcf, &object))
        return true;
    if (is_text(text))
        message_error(
            path, 0, 0,
            "this is a text, and dcf wants a concise configuration (CiA 302, object 1F22), as "
            "Lely's dcfgen writes it; a DCF or EDS is for eds, or for the maker's tool "
            "and drive_is_set_up = 1");
    else if (object != 0)
        message_error(path, 0, 0, "the entry of object %04X:%02X has no value of 1 to %d bytes",
                      (unsigned)sdo_index(object), (unsigned)sdo_sub(object), SDO_CLIENT_VALUE_MAX);
    else
        message_error(path, 0, 0,
                      "this is no concise configuration (CiA 302, object 1F22): it has not as many "
                      "entries as it says");
    return false;
}

bool configuration_files_load(struct configuration_files *files, const struct machine_setup *setup)
{
    *files = (struct configuration_files){0};
    for (unsigned i = 0; i < MACHINE_SETUP_DRIVES_MAX; i++) {
        if (setup->drive[i].dcf[0] != '\0' &&
            !load(&files->text[i], &files->dcf[i], setup->drive[i].dcf))
            return false;
    }
    return true;
}

void configuration_files_free(struct configuration_files *files)
{
    for (unsigned i = 0; i < MACHINE_SETUP_DRIVES_MAX; i++)
        text_free(&files->text[i]);
}
