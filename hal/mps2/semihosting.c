#include "mps2/semihosting.h"

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

static uint32_t call(enum operation operation, const uint32_t *arguments)
{
    register uint32_t number __asm("r0") = (uint32_t)operation;
    register const uint32_t *block __asm("r1") = arguments;

    __asm volatile("bkpt 0xAB" : "+r"(number) : "r"(block) : "memory");
    return number;
}

static uint32_t address(const void *at)
{
    return (uint32_t)(uintptr_t)at;
}

int semihosting_open(const char *path, enum semihosting_mode mode)
{
    const uint32_t block[] = {address(path), (uint32_t)mode, (uint32_t)strlen(path)};

    return (int)call(SYS_OPEN, block);
}

size_t semihosting_read(int file, void *bytes, size_t size)
{
    const uint32_t block[] = {(uint32_t)file, address(bytes), (uint32_t)size};
    const uint32_t missing = call(SYS_READ, block);

    return missing <= size ? size - missing : 0;
}

bool semihosting_write(int file, const void *bytes, size_t size)
{
    const uint32_t block[] = {(uint32_t)file, address(bytes), (uint32_t)size};

    return call(SYS_WRITE, block) == 0;
}

bool semihosting_seek(int file, uint32_t offset)
{
    const uint32_t block[] = {(uint32_t)file, offset};

    return call(SYS_SEEK, block) == 0;
}

bool semihosting_command_line(char *text, size_t size)
{
    uint32_t block[] = {address(text), (uint32_t)size};

    return call(SYS_GET_CMDLINE, block) == 0;
}

void semihosting_exit(uint32_t status)
{
    const uint32_t block[] = {STOPPED_APPLICATION_EXIT, status};

    (void)call(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}
