#define _POSIX_C_SOURCE 200809L

#include "target/process.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#define QEMU "qemu-system-arm"

/* The image's files get the numbers from here on, which are free: takt has far fewer open. */
#define FIRST_FILE 200

#define ARGUMENT_MAX  200
#define ARGUMENTS_MAX 20

/* An image that has been told to end is gone after so many looks, or will not go. */
#define END_LOOKS   200
#define END_LOOK_NS 10000000L

extern char **environ;

const char *process_board(const char *name)
{
    if (strcmp(name, "m4f") == 0)
        return "mps2-an386";
    return strcmp(name, "m7") == 0 ? "mps2-an500" : NULL;
}

/* Without a share of the signals that Ctrl-C sends to the foreground. */
static int start(pid_t *process, char *const *arguments, const int *file)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error;

    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawnattr_init(&attributes);
    (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    for (int i = 0; i < PROCESS_FILES && file[i] >= 0; i++)
        (void)posix_spawn_file_actions_adddup2(&actions, file[i], FIRST_FILE + i);
    error = posix_spawnp(process, QEMU, &actions, &attributes, arguments, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    (void)posix_spawnattr_destroy(&attributes);
    return error;
}

/* The words the image is started with. */
static void name_files(char *words, size_t size, const int file[PROCESS_FILES])
{
    int length = snprintf(words, size, "enable=on,target=native,arg=takt");

    for (int i = 0; i < PROCESS_FILES && file[i] >= 0; i++)
        length +=
            snprintf(words + length, size - (size_t)length, ",arg=/dev/fd/%d", FIRST_FILE + i);
}

/*
 * -icount shift=0: an instruction takes a nanosecond, so that the image's clock counts instructions, and two runs are
 * the same. sleep=off: never waits for real time.
 */
pid_t process_start(const char *board, const char *image, const int file[PROCESS_FILES])
{
    char machine[ARGUMENT_MAX], kernel[] = "-kernel", path[4096], semihosting[ARGUMENT_MAX];
    char *const arguments[] = {
        (char[]){QEMU},
        (char[]){"-M"},
        machine,
        kernel,
        path,
        (char[]){"-display"},
        (char[]){"none"},
        (char[]){"-monitor"},
        (char[]){"none"},
        (char[]){"-serial"},
        (char[]){"null"},
        (char[]){"-semihosting-config"},
        semihosting,
        (char[]){"-icount"},
        (char[]){"shift=0,sleep=off"},
        NULL,
    };
    pid_t process = 0;
    int error;

    (void)snprintf(machine, sizeof machine, "%s", board);
    if (snprintf(path, sizeof path, "%s", image) >= (int)sizeof path) {
        errno = ENAMETOOLONG;
        return 0;
    }
    name_files(semihosting, sizeof semihosting, file);
    error = start(&process, arguments, file);
    errno = error;
    return error == 0 ? process : 0;
}

void process_end(pid_t process)
{
    const struct timespec look = {.tv_nsec = END_LOOK_NS};

    for (unsigned i = 0; i < END_LOOKS; i++) {
        if (waitpid(process, NULL, WNOHANG) != 0)
            return;
        (void)nanosleep(&look, NULL);
    }
    (void)kill(process, SIGKILL);
    (void)waitpid(process, NULL, 0);
}
