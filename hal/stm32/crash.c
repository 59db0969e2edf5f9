#include "stm32/crash.h"

#include "base/crc32.h"

#include <string.h>

#define MARK 0x54414B54U

static uint32_t check_of(const struct crash_record *record)
{
    return takt_crc32_add(CRC32_START, record, sizeof *record);
}

void takt_crash_keep(struct crash_memory *memory, const struct crash_record *record)
{
    memory->mark = MARK;
    memory->record = *record;
    memory->check = check_of(record);
}

bool takt_crash_take(struct crash_memory *memory, struct crash_record *record)
{
    const bool any = memory->mark == MARK && memory->check == check_of(&memory->record);

    *record = memory->record;
    memset(memory, 0, sizeof *memory);
    return any;
}

void crash_set_file(struct crash_record *record, const char *name)
{
    const size_t length = strlen(name);
    const size_t kept = length < CRASH_FILE_SIZE ? length : CRASH_FILE_SIZE - 1;

    memset(record->file, 0, sizeof record->file);
    memcpy(record->file, name + (length - kept), kept);
}

const char *takt_crash_name(uint32_t cause)
{
    static const char *const names[CRASH_CAUSES] = {
        "a hard fault",  "a memory fault",          "a bus fault",
        "a usage fault", "the crystal has stopped", "a broken invariant",
    };

    return cause < CRASH_CAUSES ? names[cause] : "an unknown cause";
}
