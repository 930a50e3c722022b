/* The clock that a rehearsed firmware is given: preloaded into it, so that its own program stays as it was built.
 *
 * Time goes on only while the firmware's main thread asks for it or sleeps, and no farther than it was granted. Every
 * state packet that the firmware has taken in grants one step more; when the time granted is used up, the main thread
 * waits, and racer is told. So the firmware flies in lockstep with racer's plant, however busy the machine is.
 *
 * RACER_CLOCK_PORT: where racer listens on this machine. It is sent a byte: 't' for time used up, 'r' for sticks taken.
 * RACER_CLOCK_STEP_NS: length of a step. RACER_CLOCK_BEGIN_NS: time granted at the start, for the firmware to boot in.
 */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>

/* Sizes of a state's and of the sticks' packet. */
enum { STATE = 144, STICKS = 40 };
/* What asking for the time takes, ns. */
enum { ASKING_NS = 1000 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t granted = PTHREAD_COND_INITIALIZER;
static pthread_t main_thread;
static int64_t now_ns, until_ns, step_ns;
static int told = -1;
static struct sockaddr_in racer;
static __thread ssize_t taken;

static void tell(char what)
{
    sendto(told, &what, 1, 0, (struct sockaddr *)&racer, sizeof racer);
}

static int64_t number(const char *name)
{
    const char *text = getenv(name);
    return text ? atoll(text) : 0;
}

__attribute__((constructor)) static void begin(void)
{
    main_thread = pthread_self();
    step_ns = number("RACER_CLOCK_STEP_NS");
    until_ns = number("RACER_CLOCK_BEGIN_NS");
    racer.sin_family = AF_INET;
    racer.sin_port = htons((uint16_t)number("RACER_CLOCK_PORT"));
    racer.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    told = socket(AF_INET, SOCK_DGRAM, 0);
    /* What it prints can be read while it runs, and it ends with racer. */
    setvbuf(stdout, NULL, _IOLBF, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

/* The main thread's time goes on, and waits where it must; the others read it. */
static int64_t passed(int64_t ns)
{
    pthread_mutex_lock(&lock);
    if (pthread_equal(pthread_self(), main_thread)) {
        now_ns += ns;
        if (now_ns >= until_ns) {
            now_ns = until_ns;
            tell('t');
            while (now_ns >= until_ns) {
                pthread_cond_wait(&granted, &lock);
            }
        }
    }
    int64_t now = now_ns;
    pthread_mutex_unlock(&lock);
    return now;
}

int clock_gettime(clockid_t clock, struct timespec *time)
{
    (void)clock;
    int64_t now = passed(ASKING_NS);
    time->tv_sec = now / 1000000000;
    time->tv_nsec = now % 1000000000;
    return 0;
}

int nanosleep(const struct timespec *wanted, struct timespec *left)
{
    static int (*really)(const struct timespec *, struct timespec *);
    if (pthread_equal(pthread_self(), main_thread)) {
        passed((int64_t)wanted->tv_sec * 1000000000 + wanted->tv_nsec);
        return 0;
    }
    if (!really) {
        really = (int (*)(const struct timespec *, struct timespec *))dlsym(RTLD_NEXT, "nanosleep");
    }
    return really(wanted, left);
}

ssize_t recvfrom(int fd, void *buffer, size_t size, int flags, struct sockaddr *from, socklen_t *length)
{
    static ssize_t (*really)(int, void *, size_t, int, struct sockaddr *, socklen_t *);
    if (!really) {
        really = (ssize_t (*)(int, void *, size_t, int, struct sockaddr *, socklen_t *))dlsym(RTLD_NEXT, "recvfrom");
    }
    return taken = really(fd, buffer, size, flags, from, length);
}

/* A thread that waits for the next packet has dealt with the last one. */
int select(int count, fd_set *reads, fd_set *writes, fd_set *errors, struct timeval *most)
{
    static int (*really)(int, fd_set *, fd_set *, fd_set *, struct timeval *);
    if (!really) {
        really = (int (*)(int, fd_set *, fd_set *, fd_set *, struct timeval *))dlsym(RTLD_NEXT, "select");
    }
    if (taken == STATE) {
        pthread_mutex_lock(&lock);
        until_ns += step_ns;
        pthread_cond_signal(&granted);
        pthread_mutex_unlock(&lock);
    } else if (taken == STICKS) {
        tell('r');
    }
    taken = 0;
    return really(count, reads, writes, errors, most);
}
