/* clock RATE SECONDS: absolute deadlines with clock_nanosleep, FIFO 50, memory locked. Prints lateness p50 and p99 in
   µs and the share of cycles missed: a deadline that has passed is counted and left out, as hdrig's loop does. */
#define _GNU_SOURCE
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

static int order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int argc, char **argv) {
    if (argc < 3) return 2;
    const long rate = atol(argv[1]), ticks = (long)(rate * atof(argv[2])), period = 1000000000L / rate;
    struct sched_param priority = {.sched_priority = 50};
    if (sched_setscheduler(0, SCHED_FIFO, &priority)) fputs("FIFO refused\n", stderr);
    mlockall(MCL_CURRENT | MCL_FUTURE);
    prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
    double *late = calloc((size_t)ticks, sizeof *late);
    long count = 0, missed = 0;
    struct timespec now, at;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const long long start = now.tv_sec * 1000000000LL + now.tv_nsec;
    for (long k = 1; k <= ticks; k++) {
        const long long deadline = start + (long long)k * period;
        at.tv_sec = deadline / 1000000000LL;
        at.tv_nsec = deadline % 1000000000LL;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL);
        clock_gettime(CLOCK_MONOTONIC, &now);
        const long long behind = now.tv_sec * 1000000000LL + now.tv_nsec - deadline;
        late[count++] = (double)behind / 1000.0;
        if (behind > period) {
            missed += behind / period;
            k += behind / period;
        }
    }
    qsort(late, (size_t)count, sizeof *late, order);
    printf("%.3f %.3f %.9f\n", late[count / 2], late[(long)(0.99 * (double)count)], (double)missed / (double)ticks);
    return 0;
}
