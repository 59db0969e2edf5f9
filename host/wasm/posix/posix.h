/*
 * What the C library of WebAssembly leaves out of POSIX and the desk's rooms call: one thread, no
 * signals, files that lie in memory. Included before every source (toolchain.cmake).
 */
#ifndef TAKT_WASM_POSIX_H
#define TAKT_WASM_POSIX_H

#include <stdio.h>
#include <sys/select.h> /* sigset_t */
#include <sys/types.h>

#define PTHREAD_MUTEX_INITIALIZER                                                                  \
    {                                                                                              \
        0                                                                                          \
    }
#define PTHREAD_ONCE_INIT 0

/* Always refused: who asks goes on alone. */
int pthread_create(pthread_t *thread, const void *attributes, void *(*run)(void *), void *context);
int pthread_join(pthread_t thread, void **result);
int pthread_mutex_init(pthread_mutex_t *mutex, const void *attributes);
int pthread_mutex_destroy(pthread_mutex_t *mutex);
int pthread_mutex_lock(pthread_mutex_t *mutex);
int pthread_mutex_unlock(pthread_mutex_t *mutex);
int pthread_once(pthread_once_t *once, void (*run)(void));
int pthread_atfork(void (*before)(void), void (*in_parent)(void), void (*in_child)(void));
int pthread_sigmask(int how, const sigset_t *set, sigset_t *before);

FILE *tmpfile(void);
int mkstemp(char *name);
mode_t umask(mode_t mask);
int fchmod(int file, mode_t mode);
char *realpath(const char *path, char *real);

struct pollfd;
struct timespec;
int ppoll(struct pollfd *files, unsigned long count, const struct timespec *timeout,
          const sigset_t *mask);

#endif
