/*
 * Ctrl-C and SIGTERM: long work asks now and then and ends in good order, without partial output files.
 */
#ifndef TAKT_HOST_INTERRUPT_H
#define TAKT_HOST_INTERRUPT_H

#include <stdbool.h>

/* From now on SIGINT, SIGTERM and SIGHUP are remembered instead of ending the process; a closed pipe is an error of
 * the write instead of a signal. */
void interrupt_catch(void);

bool interrupt_asked(void);

#endif
