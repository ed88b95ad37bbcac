// sandbox.h - what a process that reads a foreign file may still do
#ifndef BASE_SANDBOX_H
#define BASE_SANDBOX_H

#include <stdint.h>

// From here on the process may compute, and read and write what is open already: nothing is opened,
// started or reached any more, as far as the kernel can see to it (seccomp, and Landlock where it
// has that; without them the process is merely one of its own).
void sandbox_close(void);

// Memory beyond what is in use now, and time on a processor beyond what is used up; both may be set
// again, up or down.
void sandbox_memory(uint64_t bytes);
void sandbox_time(unsigned seconds);

#endif
