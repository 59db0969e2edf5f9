#include "semihosting/semihosting.h"

#include "semihosting/semihosting_call.h"

#include <string.h>

/* Operations, by their numbers. */
enum operation {
    SYS_OPEN = 0x01,
    SYS_WRITE = 0x05,
    SYS_READ = 0x06,
    SYS_SEEK = 0x0A,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};

#define STOPPED_APPLICATION_EXIT 0x20026U

static uintptr_t call(enum operation operation, const uintptr_t *arguments)
{
    return takt_semihosting_call((uintptr_t)operation, arguments);
}

static uintptr_t address(const void *at)
{
    return (uintptr_t)at;
}

int takt_semihosting_open(const char *path, enum semihosting_mode mode)
{
    const uintptr_t block[] = {address(path), (uintptr_t)mode, strlen(path)};

    return (int)call(SYS_OPEN, block);
}

size_t takt_semihosting_read(int file, void *bytes, size_t size)
{
    const uintptr_t block[] = {(uintptr_t)file, address(bytes), size};
    const uintptr_t missing = call(SYS_READ, block);

    return missing <= size ? size - missing : 0;
}

bool takt_semihosting_write(int file, const void *bytes, size_t size)
{
    const uintptr_t block[] = {(uintptr_t)file, address(bytes), size};

    return call(SYS_WRITE, block) == 0;
}

bool takt_semihosting_seek(int file, uint32_t offset)
{
    const uintptr_t block[] = {(uintptr_t)file, offset};

    return call(SYS_SEEK, block) == 0;
}

bool takt_semihosting_command_line(char *text, size_t size)
{
    uintptr_t block[] = {address(text), size};

    return call(SYS_GET_CMDLINE, block) == 0;
}

void takt_semihosting_exit(uint32_t status)
{
    const uintptr_t block[] = {STOPPED_APPLICATION_EXIT, status};

    (void)call(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}
