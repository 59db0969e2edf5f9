/*
 * QEMU as a child process with an image that reads and writes files of ours.
 */
#ifndef TAKT_TARGET_PROCESS_H
#define TAKT_TARGET_PROCESS_H

#include <stdbool.h>
#include <sys/types.h>

/*
 * What the image opens, in this order: files up to the first -1, and for PROCESS_TALK the two ends
 * of the talk.
 */
#define PROCESS_FILES 4
#define PROCESS_TALK  (-2)

/* A board of QEMU. */
struct process_board {
    const char *name; /* of the target */
    const char *qemu; /* the program */
    const char *package;
    const char *options[5]; /* up to the first NULL */
    bool has_drives;        /* takt-drive is built for it, too */
};

/* The board that a target's name stands for; NULL: none. */
const struct process_board *process_board(const char *name);

struct process {
    pid_t pid;    /* 0: none */
    int to, from; /* ends of pipes that the image reads and writes; -1: none */
};

/*
 * Starts QEMU. The files stay the caller's. False: it cannot be started; errno says why, and
 * process is to be ended.
 */
bool process_start(struct process *process, const struct process_board *board, const char *image,
                   const int file[PROCESS_FILES]);

/* Closes the talk and waits for the end, which has been asked for; ends it if it lasts. */
void process_end(struct process *process);

#endif
