/* Abort codes of SDO transfers in words. */
#include "canopen/sdo.h"

/* CiA 301, table 22. */
static const struct {
    uint32_t code;
    const char *text;
} aborts[] = {
    {SDO_ABORT_TOGGLE, "toggle bit not alternated"},
    {SDO_ABORT_TIMEOUT, "SDO protocol timed out"},
    {SDO_ABORT_COMMAND, "command specifier unknown"},
    {SDO_ABORT_BLOCK_SIZE, "invalid block size"},
    {SDO_ABORT_SEQUENCE, "invalid sequence number"},
    {SDO_ABORT_CRC, "CRC error"},
    {SDO_ABORT_MEMORY, "out of memory"},
    {SDO_ABORT_ACCESS, "unsupported access to an object"},
    {SDO_ABORT_WRITE_ONLY, "object can only be written"},
    {SDO_ABORT_READ_ONLY, "object can only be read"},
    {SDO_ABORT_NO_OBJECT, "object does not exist"},
    {SDO_ABORT_NOT_MAPPABLE, "object cannot be mapped into the PDO"},
    {SDO_ABORT_PDO_LENGTH, "mapped objects exceed the length of the PDO"},
    {SDO_ABORT_PARAMETERS, "parameters do not go together"},
    {0x06040047, "internal incompatibility in the device"},
    {SDO_ABORT_HARDWARE, "hardware error"},
    {SDO_ABORT_LENGTH, "length of the value does not match"},
    {SDO_ABORT_TOO_LONG, "value too long"},
    {SDO_ABORT_TOO_SHORT, "value too short"},
    {SDO_ABORT_NO_SUB_INDEX, "sub-index does not exist"},
    {SDO_ABORT_VALUE, "invalid value"},
    {SDO_ABORT_TOO_HIGH, "value too high"},
    {SDO_ABORT_TOO_LOW, "value too low"},
    {0x06090036, "maximum below minimum"},
    {0x060A0023, "resource not available"},
    {SDO_ABORT_GENERAL, "general error"},
    {SDO_ABORT_STORE, "value cannot be stored"},
    {0x08000021, "value cannot be stored: local control"},
    {SDO_ABORT_STATE, "value cannot be stored in the present state of the device"},
    {0x08000023, "no object dictionary"},
    {SDO_ABORT_NO_DATA, "no data available"},
};

const char *takt_sdo_abort_text(uint32_t code)
{
    for (unsigned i = 0; i < sizeof aborts / sizeof aborts[0]; i++)
        if (aborts[i].code == code)
            return aborts[i].text;
    return "unknown abort code";
}
