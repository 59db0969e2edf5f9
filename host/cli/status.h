/*
 * How takt ends: the exit status of every sub-command.
 */
#ifndef TAKT_HOST_STATUS_H
#define TAKT_HOST_STATUS_H

/* Exit status. */
enum command_status {
    STATUS_DONE = 0,         /* and every check held */
    STATUS_FAILED = 1,       /* the run finished and a check failed */
    STATUS_INPUT = 2,        /* the user's input is wrong; a message says what */
    STATUS_ENVIRONMENT = 3,  /* the machine takt runs on refused something */
    STATUS_STOPPED = 4,      /* every check held, but --until came before the program's end */
    STATUS_INTERRUPTED = 130 /* by a signal; the process ends with interrupt_status() */
};

#endif
