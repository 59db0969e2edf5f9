#include "drives/eds.h"

#include "servo/dictionary.h"

#include <stdarg.h>
#include <string.h>

#define NEWLINE "\r\n" /* CiA 306, 4.2 */

__attribute__((format(printf, 3, 4))) static void write_pair(FILE *stream, const char *key,
                                                             const char *format, ...)
{
    va_list arguments;
    (void)fprintf(stream, "%s=", key);
    va_start(arguments, format);
    (void)vfprintf(stream, format, arguments);
    va_end(arguments);
    (void)fputs(NEWLINE, stream);
}

static void write_file_info(FILE *stream, const char *name)
{
    (void)fputs("[FileInfo]" NEWLINE, stream);
    write_pair(stream, "FileName", "%s", name);
    write_pair(stream, "FileVersion", "1");
    write_pair(stream, "FileRevision", "0");
    write_pair(stream, "EDSVersion", "4.0");
    write_pair(stream, "Description", "Virtual CiA 402 drive of takt");
    write_pair(stream, "CreatedBy", "takt");
    (void)fputs(NEWLINE, stream);
}

static uint32_t constant_of(const struct dictionary *dictionary, uint16_t index, uint8_t sub)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(dictionary, index, sub, &has_index);
    return row != NULL ? (uint32_t)row->initial : 0;
}

static void write_device_info(FILE *stream, const struct dictionary *dictionary)
{
    static const unsigned kilobits[] = {10, 20, 50, 125, 250, 500, 800, 1000};
    char key[32];
    (void)fputs("[DeviceInfo]" NEWLINE, stream);
    write_pair(stream, "VendorName", "takt");
    write_pair(stream, "VendorNumber", "0x%08X", (unsigned)constant_of(dictionary, 0x1018, 1));
    write_pair(stream, "ProductName", "takt CiA 402 drive");
    write_pair(stream, "ProductNumber", "0x%08X", (unsigned)constant_of(dictionary, 0x1018, 2));
    write_pair(stream, "RevisionNumber", "0x%08X", (unsigned)constant_of(dictionary, 0x1018, 3));
    for (unsigned i = 0; i < sizeof kilobits / sizeof kilobits[0]; i++) {
        (void)snprintf(key, sizeof key, "BaudRate_%u", kilobits[i]);
        write_pair(stream, key, "1");
    }
    write_pair(stream, "SimpleBootUpMaster", "0");
    write_pair(stream, "SimpleBootUpSlave", "1");
    write_pair(stream, "Granularity", "8");
    write_pair(stream, "DynamicChannelsSupported", "0");
    write_pair(stream, "GroupMessaging", "0");
    write_pair(stream, "NrOfRXPDO", "%u", DRIVE_PDO_COUNT);
    write_pair(stream, "NrOfTXPDO", "%u", DRIVE_PDO_COUNT);
    write_pair(stream, "LSS_Supported", "1");
    (void)fputs(NEWLINE, stream);
}

/* Data types that an RPDO may skip. */
static void write_dummies(FILE *stream, const struct dictionary *dictionary)
{
    char key[16];
    (void)fputs("[DummyUsage]" NEWLINE, stream);
    for (unsigned type = 1; type <= OBJECT_UNSIGNED32; type++) {
        (void)snprintf(key, sizeof key, "Dummy%04X", type);
        write_pair(stream, key, "%u", dictionary->dummies >> type & 1);
    }
    (void)fputs(NEWLINE, stream);
}

/* The objects by what a tool may expect of every device. */
enum eds_list { EDS_MANDATORY, EDS_OPTIONAL, EDS_MANUFACTURER };

static enum eds_list list_of(uint16_t index)
{
    if (index == 0x1000 || index == 0x1001 || index == 0x1018)
        return EDS_MANDATORY;
    return index >= 0x2000 && index < 0x6000 ? EDS_MANUFACTURER : EDS_OPTIONAL;
}

static bool is_listed(const struct object_row *row, enum eds_list list)
{
    return row->kind != OBJECT_SAME && list_of(row->index) == list;
}

static void write_list(FILE *stream, const struct dictionary *dictionary, const char *name,
                       enum eds_list list)
{
    unsigned count = 0;
    for (unsigned i = 0; i < dictionary->count; i++)
        count += is_listed(&dictionary->row[i], list);
    (void)fprintf(stream, "[%s]" NEWLINE, name);
    write_pair(stream, "SupportedObjects", "%u", count);
    count = 0;
    for (unsigned i = 0; i < dictionary->count; i++)
        if (is_listed(&dictionary->row[i], list))
            (void)fprintf(stream, "%u=0x%04X" NEWLINE, ++count, dictionary->row[i].index);
    (void)fputs(NEWLINE, stream);
}

static const char *access_text(const struct object_row *row)
{
    switch ((enum object_access)row->access) {
    case OBJECT_CONST:
        return "const";
    case OBJECT_RO:
        return "ro";
    case OBJECT_WO:
        return "wo";
    case OBJECT_RW:
        break;
    }
    if (row->flags & OBJECT_TO_RPDO && !(row->flags & OBJECT_TO_TPDO))
        return "rww"; /* by RPDO alone */
    return "rw";
}

static bool is_signed(const struct object_row *row)
{
    return row->type >= OBJECT_INTEGER8 && row->type <= OBJECT_INTEGER32;
}

static void write_number(FILE *stream, const struct object_row *row, const char *key, int64_t value)
{
    if (is_signed(row))
        write_pair(stream, key, "%lld", (long long)value);
    else
        write_pair(stream, key, "0x%llX", (unsigned long long)value);
}

/* What goes on by itself, so that it can be sent in a TPDO, has no default. */
static void write_default(FILE *stream, const struct object_row *row,
                          const struct drive_objects *objects, uint8_t node)
{
    bool is_measured = row->flags & OBJECT_TO_TPDO;
    if (row->type == OBJECT_STRING && row->flags & OBJECT_FIXED)
        write_pair(stream, "DefaultValue", "%s", row->title);
    if (takt_object_type_bytes((enum object_type)row->type) == 0 || is_measured ||
        row->access == OBJECT_WO)
        return;
    uint32_t raw = takt_object_read(row, objects);
    if (row->flags & OBJECT_NODE_ID)
        write_pair(stream, "DefaultValue", "$NODEID+0x%X", (unsigned)(raw - node));
    else
        write_number(stream, row, "DefaultValue",
                     takt_object_type_value((enum object_type)row->type, raw));
}

static void write_limits(FILE *stream, const struct object_row *row)
{
    if (!(row->flags & OBJECT_LIMITED))
        return;
    write_number(stream, row, "LowLimit", row->min);
    write_number(stream, row, "HighLimit", row->max);
}

static void write_entry(FILE *stream, const struct object_row *row,
                        const struct drive_objects *objects, uint8_t node)
{
    bool is_mappable = row->flags & (OBJECT_TO_TPDO | OBJECT_TO_RPDO);
    write_pair(stream, "ParameterName", "%s", row->name);
    write_pair(stream, "ObjectType", "0x%X",
               row->type == OBJECT_DOMAIN ? 2u : (unsigned)OBJECT_VAR);
    write_pair(stream, "DataType", "0x%04X", row->type);
    write_pair(stream, "AccessType", "%s", access_text(row));
    write_default(stream, row, objects, node);
    write_limits(stream, row);
    write_pair(stream, "PDOMapping", "%d", is_mappable);
    (void)fputs(NEWLINE, stream);
}

static unsigned count_subs(const struct dictionary *dictionary, const struct object_row *first)
{
    unsigned count = 0;
    const struct object_row *end = dictionary->row + dictionary->count;
    for (const struct object_row *row = first; row < end && row->index == first->index; row++)
        count++;
    return count;
}

static void write_row(FILE *stream, const struct dictionary *dictionary,
                      const struct object_row *row, const struct drive_objects *objects,
                      uint8_t node)
{
    bool is_compound = row->kind == OBJECT_ARRAY || row->kind == OBJECT_RECORD;
    if (is_compound) {
        (void)fprintf(stream, "[%04X]" NEWLINE, row->index);
        write_pair(stream, "ParameterName", "%s", row->title);
        write_pair(stream, "ObjectType", "0x%X", row->kind);
        write_pair(stream, "SubNumber", "%u", count_subs(dictionary, row));
        (void)fputs(NEWLINE, stream);
    }
    if (is_compound || row->kind == OBJECT_SAME)
        (void)fprintf(stream, "[%04Xsub%X]" NEWLINE, row->index, row->sub);
    else
        (void)fprintf(stream, "[%04X]" NEWLINE, row->index);
    write_entry(stream, row, objects, node);
}

void eds_write(FILE *stream, const struct servo *drive, const char *name)
{
    const struct dictionary *dictionary = drive->dictionary;
    struct drive_objects objects = drive->objects;
    objects.communication = drive->initial.communication;
    objects.settings = drive->initial.settings;
    write_file_info(stream, name);
    write_device_info(stream, dictionary);
    write_dummies(stream, dictionary);
    write_list(stream, dictionary, "MandatoryObjects", EDS_MANDATORY);
    write_list(stream, dictionary, "OptionalObjects", EDS_OPTIONAL);
    write_list(stream, dictionary, "ManufacturerObjects", EDS_MANUFACTURER);
    for (unsigned i = 0; i < dictionary->count; i++)
        write_row(stream, dictionary, &dictionary->row[i], &objects, drive->config.node);
}
