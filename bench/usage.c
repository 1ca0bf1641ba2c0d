/* usage PROGRAM ARGUMENT…: runs it without input and output, and prints what it used: microseconds of CPU,
   peak memory in KiB, its exit code. A process starts with the memory of its parent, so the parent must be small:
   Python, for instance, is larger than what is measured. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int count, char** arguments) {
  if (count < 2) return 2;
  const pid_t child = fork();
  if (child == 0) {
    const int nothing = open("/dev/null", O_RDWR);
    for (int file = 0; file <= 2; ++file)
      dup2(nothing, file);
    execv(arguments[1], arguments + 1);
    _exit(127);
  }
  int status = 0;
  struct rusage used;
  if (child < 0 || wait4(child, &status, 0, &used) != child) return 1;
  const long long cpu = (used.ru_utime.tv_sec + used.ru_stime.tv_sec) * 1000000LL +
                        used.ru_utime.tv_usec + used.ru_stime.tv_usec;
  printf("%lld %ld %d\n", cpu, used.ru_maxrss, WIFEXITED(status) ? WEXITSTATUS(status) : 255);
  return 0;
}
