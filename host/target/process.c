#define _POSIX_C_SOURCE 200809L

#include "target/process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The image's files get the numbers from here on, which are free: takt has far fewer open. */
#define FIRST_FILE 200

#define ARGUMENT_MAX  200
#define ARGUMENTS_MAX 20

/* The talk takes two places. */
#define FILES_MAX (1 + PROCESS_FILES)

/* An image that has been told to end is gone after this many looks, or will not go. */
#define END_LOOKS   200
#define END_LOOK_NS 10000000L

extern char **environ;

static const struct process_board boards[] = {
    {"m4f", "qemu-system-arm", "qemu-system-arm", {"-M", "mps2-an386"}, true},
    {"m7", "qemu-system-arm", "qemu-system-arm", {"-M", "mps2-an500"}, true},
    {"rv64", "qemu-system-riscv64", "qemu-system-misc", {"-M", "virt", "-bios", "none"}, false},
};

const struct process_board *process_board(const char *name)
{
    for (size_t i = 0; i < sizeof boards / sizeof boards[0]; i++) {
        if (strcmp(name, boards[i].name) == 0)
            return &boards[i];
    }
    return NULL;
}

/* Without a share of the signals that Ctrl-C sends to the foreground. */
static int start(pid_t *process, const char *qemu, char *const *arguments, const int *file)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error;

    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawnattr_init(&attributes);
    (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    for (int i = 0; i < FILES_MAX && file[i] >= 0; i++)
        (void)posix_spawn_file_actions_adddup2(&actions, file[i], FIRST_FILE + i);
    error = posix_spawnp(process, qemu, &actions, &attributes, arguments, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    (void)posix_spawnattr_destroy(&attributes);
    return error;
}

/* The words the image is started with. */
static void name_files(char *words, size_t size, const int file[FILES_MAX])
{
    int length = snprintf(words, size, "enable=on,target=native,arg=takt");

    for (int i = 0; i < FILES_MAX && file[i] >= 0; i++)
        length +=
            snprintf(words + length, size - (size_t)length, ",arg=/dev/fd/%d", FIRST_FILE + i);
}

/* posix_spawn takes words that may be changed, and changes none. */
static char *word(const char *text)
{
    char *own;

    memcpy(&own, &text, sizeof own);
    return own;
}

/*
 * -icount shift=0: an instruction takes a nanosecond, so that the image's clock counts
 * instructions, and two runs are the same. sleep=off: never waits for real time.
 */
static pid_t start_image(const struct process_board *board, const char *image,
                         const int file[FILES_MAX])
{
    char semihosting[ARGUMENT_MAX];
    const char *const last[] = {
        "-kernel",   image,      "-display",
        "none",      "-monitor", "none",
        "-serial",   "null",     "-semihosting-config",
        semihosting, "-icount",  "shift=0,sleep=off",
    };
    char *arguments[ARGUMENTS_MAX + 1] = {NULL};
    unsigned count = 0;
    pid_t process = 0;
    int error;

    name_files(semihosting, sizeof semihosting, file);
    arguments[count++] = word(board->qemu);
    for (unsigned i = 0; board->options[i] != NULL; i++)
        arguments[count++] = word(board->options[i]);
    for (unsigned i = 0; i < sizeof last / sizeof last[0]; i++)
        arguments[count++] = word(last[i]);
    error = start(&process, board->qemu, arguments, file);
    errno = error;
    return error == 0 ? process : 0;
}

/* Ends of pipes that QEMU must not keep open beside its own. */
static bool open_pipe(int ends[2])
{
    if (pipe(ends) != 0)
        return false;
    (void)fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    return true;
}

bool process_start(struct process *process, const struct process_board *board, const char *image,
                   const int file[PROCESS_FILES])
{
    int files[FILES_MAX];
    int to[2], from[2];
    unsigned count = 0;

    *process = (struct process){.to = -1, .from = -1};
    if (access(image, R_OK) != 0 || !open_pipe(to))
        return false;
    process->to = to[1];
    if (!open_pipe(from)) {
        (void)close(to[0]);
        return false;
    }
    process->from = from[0];
    for (unsigned i = 0; i < PROCESS_FILES; i++) {
        files[count++] = file[i] == PROCESS_TALK ? to[0] : file[i];
        if (file[i] == PROCESS_TALK)
            files[count++] = from[1];
    }
    process->pid = start_image(board, image, files);
    (void)close(to[0]);
    (void)close(from[1]);
    return process->pid != 0;
}

static void wait_for_end(pid_t pid)
{
    const struct timespec look = {.tv_nsec = END_LOOK_NS};

    for (unsigned i = 0; i < END_LOOKS; i++) {
        if (waitpid(pid, NULL, WNOHANG) != 0)
            return;
        (void)nanosleep(&look, NULL);
    }
    (void)kill(pid, SIGKILL);
    (void)waitpid(pid, NULL, 0);
}

void process_end(struct process *process)
{
    if (process->to >= 0)
        (void)close(process->to);
    if (process->from >= 0)
        (void)close(process->from);
    if (process->pid > 0)
        wait_for_end(process->pid);
    *process = (struct process){.to = -1, .from = -1};
}
