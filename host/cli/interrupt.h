/*
 * Ctrl-C, SIGTERM and SIGHUP: long work asks now and then and ends in good order, without partial
 * output files.
 */
#ifndef TAKT_HOST_INTERRUPT_H
#define TAKT_HOST_INTERRUPT_H

#include <stdbool.h>

/*
 * From now on SIGINT, SIGTERM and SIGHUP are remembered instead of ending the process; a closed
 * pipe is an error of the write instead of a signal.
 */
void interrupt_catch(void);

bool interrupt_asked(void);
/* How often: who asks once more does not want to wait for the good order. */
unsigned interrupt_times(void);
/*
 * The exit status of a command that the first signal has ended: 128 and its number, as shells
 * count.
 */
int interrupt_status(void);

#endif
