#include "takt/configuration_file.h"

#include "canopen/sdo.h"
#include "canopen/sdo_client.h"
#include "takt/message.h"
#include "takt/text.h"

/* A machine's; the machine has no more than their places. */
static struct text texts[MACHINE_SETUP_DRIVES_MAX];
static struct concise_dcf configurations[MACHINE_SETUP_DRIVES_MAX];

static bool load(const char *path, unsigned i)
{
    struct concise_dcf *dcf = &configurations[i];
    uint32_t object;

    text_free(&texts[i]);
    texts[i] = (struct text){0};
    if (!text_read(&texts[i], path))
        return false;
    if (texts[i].length > UINT32_MAX) {
        message_error(path, 0, 0, "this is too long");
        return false;
    }
    *dcf = (struct concise_dcf){.bytes = (const uint8_t *)texts[i].bytes,
                                .length = (uint32_t)texts[i].length};
    if (concise_dcf_is_well(dcf, &object))
        return true;
    if (object != 0)
        message_error(path, 0, 0, "the entry of object %04X:%02X has no value of 1 to %d bytes",
                      (unsigned)sdo_index(object), (unsigned)sdo_sub(object), SDO_CLIENT_VALUE_MAX);
    else
        message_error(path, 0, 0,
                      "this is no concise configuration (CiA 302, object 1F22): it has not as many "
                      "entries as it says");
    return false;
}

bool configuration_files_load(const struct machine_setup *setup)
{
    for (unsigned i = 0; i < MACHINE_SETUP_DRIVES_MAX; i++) {
        configurations[i] = (struct concise_dcf){0};
        if (setup->drive[i].dcf[0] != '\0' && !load(setup->drive[i].dcf, i))
            return false;
    }
    return true;
}

const struct concise_dcf *configuration_files_get(void)
{
    return configurations;
}
