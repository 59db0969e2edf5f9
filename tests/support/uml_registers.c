/*
 * Preloaded into user-mode Linux: lets it run on processors with more registers than it knows.
 *
 * It keeps the floating-point registers of its processes in a buffer of fixed size, and writes them
 * back from there by ptrace. On processors with AMX the state is larger, and the kernel takes the
 * whole of it or nothing. So the whole is read first, and the part it knows is laid over it.
 */
#define _GNU_SOURCE

#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#define STATE_MAX 16384

static long call(long request, long pid, void *address, void *data)
{
    return syscall(SYS_ptrace, request, pid, address, data);
}

/* The system call puts what it read where data points to; the C library's function returns it. */
static long peek(long request, long pid, void *address)
{
    long word = 0;
    return call(request, pid, address, &word) == 0 ? word : -1;
}

static long set_extended_state(long pid, void *address, struct iovec *part)
{
    static _Alignas(64) char state[STATE_MAX];
    struct iovec whole = {.iov_base = state, .iov_len = sizeof state};
    long result = call(PTRACE_GETREGSET, pid, address, &whole);
    if (result != 0)
        return result;
    memcpy(state, part->iov_base, part->iov_len < whole.iov_len ? part->iov_len : whole.iov_len);
    return call(PTRACE_SETREGSET, pid, address, &whole);
}

long ptrace(enum __ptrace_request request, ...)
{
    va_list arguments;
    va_start(arguments, request);
    long pid = va_arg(arguments, pid_t);
    void *address = va_arg(arguments, void *);
    void *data = va_arg(arguments, void *);
    va_end(arguments);
    if (request == PTRACE_SETREGSET && address == (void *)NT_X86_XSTATE)
        return set_extended_state(pid, address, data);
    if (request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER)
        return peek(request, pid, address);
    return call(request, pid, address, data);
}
