// sandbox.h - what a process that reads a foreign file may still do
#ifndef BASE_SANDBOX_H
#define BASE_SANDBOX_H

#include <stdbool.h>
#include <stdint.h>

// From here on the process may compute, and read and write what is open already: nothing is opened,
// started or reached any more, as far as the kernel can see to it (seccomp, and Landlock where it
// has that; without them the process is merely one of its own).
void sandbox_close(void);

// Memory beyond what was in use at the first call, and time on a processor beyond what is used up;
// both may be set again, up or down. sandbox_memory is false where the process was started with
// less (ulimit -v).
bool sandbox_memory(uint64_t bytes);
void sandbox_time(double seconds);
// Time on processors so far.
double sandbox_time_used(void);

#endif
