#include "posix.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

int pthread_create(pthread_t *thread, const void *attributes, void *(*run)(void *), void *context)
{
    (void)thread;
    (void)attributes;
    (void)run;
    (void)context;
    return EAGAIN;
}

int pthread_join(pthread_t thread, void **result)
{
    (void)thread;
    (void)result;
    return 0;
}

int pthread_mutex_init(pthread_mutex_t *mutex, const void *attributes)
{
    (void)attributes;
    memset(mutex, 0, sizeof *mutex);
    return 0;
}

int pthread_mutex_destroy(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}

int pthread_mutex_lock(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}

int pthread_mutex_unlock(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}

int pthread_once(pthread_once_t *once, void (*run)(void))
{
    if (*once == PTHREAD_ONCE_INIT) {
        *once = 1;
        run();
    }
    return 0;
}

/* Nothing forks here. */
int pthread_atfork(void (*before)(void), void (*in_parent)(void), void (*in_child)(void))
{
    (void)before;
    (void)in_parent;
    (void)in_child;
    return 0;
}

int pthread_sigmask(int how, const sigset_t *set, sigset_t *before)
{
    (void)how;
    (void)set;
    *before = 0;
    return 0;
}

int sigfillset(sigset_t *set)
{
    *set = 0xFF;
    return 0;
}

int sigemptyset(sigset_t *set)
{
    *set = 0;
    return 0;
}

int sigaction(int number, const struct sigaction *action, struct sigaction *before)
{
    (void)number;
    (void)action;
    (void)before;
    return 0;
}

/* Names end in six places for letters. */
int mkstemp(char *name)
{
    static _Thread_local unsigned count;
    char *end = name + strlen(name) - 6;
    unsigned number = count++;

    for (unsigned i = 0; i < 6; i++, number /= 26)
        end[i] = (char)('a' + number % 26);
    return open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
}

/* Its memory is free again with the module's: each run has a module of its own. */
FILE *tmpfile(void)
{
    char name[] = "/tmp.XXXXXX";
    const int file = mkstemp(name);

    return file >= 0 ? fdopen(file, "w+b") : NULL;
}

mode_t umask(mode_t mask)
{
    (void)mask;
    return 0;
}

int fchmod(int file, mode_t mode)
{
    (void)file;
    (void)mode;
    return 0;
}

int sched_setscheduler(pid_t process, int policy, const struct sched_param *parameters)
{
    (void)process;
    (void)policy;
    (void)parameters;
    return -1;
}

int mlockall(int flags)
{
    (void)flags;
    return -1;
}

/* There are no links: a name is what it is. */
char *realpath(const char *path, char *real)
{
    (void)path;
    (void)real;
    return NULL;
}

/* Nothing outside is ever open. */
int ppoll(struct pollfd *files, unsigned long count, const struct timespec *timeout,
          const sigset_t *mask)
{
    (void)files;
    (void)count;
    (void)timeout;
    (void)mask;
    return 0;
}
