// called.h - names that people know of what is made under others
#ifndef BASE_CALLED_H
#define BASE_CALLED_H

#include <stddef.h>

struct called {
    const char *path;  // where it is made
    const char *name;  // what it will be
    struct called *next;
};
// Both texts live until it leaves. Leaving without having entered is fine. Thread-safety: safe.
void called_enter(struct called *c);
void called_leave(const struct called *c);
// The same sentence with the names, within `size` bytes.
void called_rename(char *text, size_t size);

#endif
