// called.c - a folder is made in a place that nobody has heard of: sentences call it by its name
#include "core/base/called.h"

#include <pthread.h>
#include <string.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct called *first;

void called_enter(struct called *c)
{
    pthread_mutex_lock(&lock);
    c->next = first;
    first = c;
    pthread_mutex_unlock(&lock);
}

void called_leave(const struct called *c)
{
    pthread_mutex_lock(&lock);
    for (struct called **at = &first; *at; at = &(*at)->next)
        if (*at == c) {
            *at = c->next;
            break;
        }
    pthread_mutex_unlock(&lock);
}

static void replace(char *text, size_t size, const struct called *c)
{
    const size_t n = strlen(c->path), m = strlen(c->name);
    for (char *at = strstr(text, c->path); at; at = strstr(at + m, c->path)) {
        const size_t left = size - (size_t)(at - text), tail = strlen(at + n) + 1;
        if (m + 1 > left)
            return;
        memmove(at + m, at + n, m + tail > left ? left - m : tail);
        memcpy(at, c->name, m);
        text[size - 1] = '\0';
    }
}

void called_rename(char *text, size_t size)
{
    pthread_mutex_lock(&lock);
    for (const struct called *c = first; c; c = c->next)
        replace(text, size, c);
    pthread_mutex_unlock(&lock);
}
