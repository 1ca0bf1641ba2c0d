// A clock without jumps, for a QEMU that runs in real time (LD_PRELOAD, by scripts/python/board.py).
//
// While the emulated processor idles, its time follows the host's clock. When the host is busy with something else, the time
// that QEMU had to wait would pass for the robot in one jump, without an instruction executed: its watchdog would reset it,
// and it would miss all of its deadlines. So this clock advances by at most MOST_NS between two readings: a busy host makes
// the robot slow, as it does in all emulation that counts instructions.
#include <dlfcn.h>
#include <pthread.h>
#include <stdint.h>
#include <time.h>

// The longest sleep of a firmware, a period of its safety thread (10 ms), plus the time to wake QEMU. A firmware that sleeps
// longer wakes later, by a few readings of the clock.
#define MOST_NS INT64_C(12000000)
#define SECOND_NS INT64_C(1000000000)

typedef int ClockGettime(clockid_t clock, struct timespec* now);

static ClockGettime* host_clock_gettime;
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static int64_t last_ns, left_out_ns;

__attribute__((constructor)) static void find_host_clock(void) {
  host_clock_gettime = (ClockGettime*)dlsym(RTLD_NEXT, "clock_gettime");
}

static int64_t without_jumps(int64_t host_ns) {
  pthread_mutex_lock(&mutex);
  const int64_t passed = host_ns - last_ns;
  if (last_ns != 0 && passed > MOST_NS) left_out_ns += passed - MOST_NS;
  if (passed > 0) last_ns = host_ns;  // a thread with a later reading may get here first
  const int64_t steady_ns = host_ns - left_out_ns;
  pthread_mutex_unlock(&mutex);
  return steady_ns;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  if (host_clock_gettime == NULL)
    find_host_clock();  // called by the constructor of another library
  const int failed = host_clock_gettime(clock, now);
  if (failed != 0 || clock != CLOCK_MONOTONIC) return failed;
  const int64_t ns = without_jumps(now->tv_sec * SECOND_NS + now->tv_nsec);
  now->tv_sec = ns / SECOND_NS;
  now->tv_nsec = ns % SECOND_NS;
  return 0;
}
