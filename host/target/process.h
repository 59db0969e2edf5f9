/*
 * QEMU as a child process with an image that reads and writes files of ours.
 */
#ifndef TAKT_TARGET_PROCESS_H
#define TAKT_TARGET_PROCESS_H

#include <stdbool.h>
#include <sys/types.h>

/* What the image opens, in this order: setup, program, the pipes it reads and writes, and a plan or -1. */
#define PROCESS_FILES 5

/* A board of QEMU. */
struct process_board {
    const char *name; /* of the target */
    const char *qemu; /* the program */
    const char *package;
    const char *options[5]; /* up to the first NULL */
};

/* The board that a target's name stands for; NULL: none. */
const struct process_board *process_board(const char *name);

/* Starts QEMU. The files stay the caller's. 0: it cannot be started; errno says why. */
pid_t process_start(const struct process_board *board, const char *image,
                    const int file[PROCESS_FILES]);

/* Waits for its end, which has been asked for; ends it if it lasts. */
void process_end(pid_t process);

#endif
