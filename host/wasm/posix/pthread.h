/* A page's worker is one thread: see posix.h. */
#ifndef TAKT_WASM_PTHREAD_H
#define TAKT_WASM_PTHREAD_H

#include "posix.h"

#endif
