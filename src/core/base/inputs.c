// inputs.c - files that are read are noted, and kept from being replaced
#include "core/base/inputs.h"

#include "core/base/beside.h"
#include "core/base/context.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct identity {
    dev_t device;
    ino_t number;
};

struct inputs {
    pthread_mutex_t mutex;
    struct identity *item;
    size_t count, capacity;
    bool incomplete;  // memory was short: everything there counts as read
};

struct inputs *inputs_create(void)
{
    struct inputs *i = mem_zeroed(1, sizeof *i);
    if (i)
        pthread_mutex_init(&i->mutex, NULL);
    return i;
}

void inputs_destroy(struct inputs *i)
{
    if (!i)
        return;
    pthread_mutex_destroy(&i->mutex);
    mem_free(i->item);
    mem_free(i);
}

// Open addressing; `capacity` is a power of two, a free place has the number 0, which no file has.
static struct identity *find(struct identity *item, size_t capacity, struct identity id)
{
    size_t at = (size_t)(id.number * 0x9e3779b97f4a7c15u ^ id.device) & (capacity - 1);
    while (item[at].number && (item[at].number != id.number || item[at].device != id.device))
        at = (at + 1) & (capacity - 1);
    return &item[at];
}

static bool grow(struct inputs *i)
{
    const size_t capacity = i->capacity ? 2 * i->capacity : 64;
    struct identity *item = mem_zeroed(capacity, sizeof *item);
    if (!item)
        return false;
    for (size_t n = 0; n < i->capacity; n++)
        if (i->item[n].number)
            *find(item, capacity, i->item[n]) = i->item[n];
    mem_free(i->item);
    i->item = item;
    i->capacity = capacity;
    return true;
}

static void add(struct inputs *i, struct identity id)
{
    if (2 * (i->count + 1) > i->capacity && !grow(i)) {
        i->incomplete = true;
        return;
    }
    struct identity *place = find(i->item, i->capacity, id);
    i->count += !place->number;
    *place = id;
}

// Devices and pipes cannot be replaced, and a terminal may well be read and written.
void inputs_add(struct inputs *inputs, const char *path)
{
    struct stat s;
    if (stat(path, &s) || !(S_ISREG(s.st_mode) || S_ISDIR(s.st_mode)))
        return;
    pthread_mutex_lock(&inputs->mutex);
    add(inputs, (struct identity){s.st_dev, s.st_ino});
    pthread_mutex_unlock(&inputs->mutex);
}

static struct inputs *inputs_of(const struct relume_log *log)
{
    return context_of(log) ? log->context->inputs : NULL;
}

void input_note(const struct relume_log *log, const char *path)
{
    // what is being made here is not an input
    if (inputs_of(log) && !log->leave_unnoted && !beside_holds(path))
        inputs_add(inputs_of(log), path);
}

relume_status relume_input_fail(const struct relume_log *log, const char *path, const char *what,
                                int error)
{
    if (error == ENOMEM)
        return RELUME_ENOMEM;
    if (error == EMFILE || error == ENFILE)
        return log_fail(log, RELUME_ESYSTEM,
                        "%s: %s; too many files are open; raise the limit (ulimit -n)", path, what);
    return log_fail(log, error == EISDIR ? RELUME_EFORMAT : RELUME_ENOTFOUND, "%s: %s; %s", path,
                    what, strerror(error));
}

static bool holds(struct inputs *i, const struct stat *s)
{
    pthread_mutex_lock(&i->mutex);
    const struct identity id = {s->st_dev, s->st_ino};
    const bool found = i->incomplete || (i->capacity && find(i->item, i->capacity, id)->number);
    pthread_mutex_unlock(&i->mutex);
    return found;
}

static char *path_if_read(struct inputs *inputs, char *path)
{
    struct stat s;
    if (path && !lstat(path, &s) && holds(inputs, &s))
        return path;
    mem_free(path);
    return NULL;
}

// The first thing in or below `path` that is read, as a new string; NULL when there is none. Links
// are not followed: removing them takes nothing away.
static char *find_read(struct inputs *inputs, const char *path)
{
    struct stat s;
    struct tree_list all = {0};
    char *found = path_if_read(inputs, mem_text(path));
    if (!found && !lstat(path, &s) && S_ISDIR(s.st_mode))
        (void)!tree_list(&all, path);  // what may not be listed cannot be removed
    for (size_t i = 0; !found && i < all.count; i++)
        if (all.item[i].name)
            found = path_if_read(inputs, mem_format("%s/%s", path, all.item[i].name));
    tree_list_free(&all);
    return found;
}

relume_status input_refuse(const char *path, const char *output, const struct relume_log *log)
{
    char *found = inputs_of(log) ? find_read(inputs_of(log), path) : NULL;
    if (!found)
        return RELUME_OK;
    const char *inner = strcmp(found, path) ? found + strlen(path) + 1 : NULL;
    const relume_status status =
        inner ? log_fail(log, RELUME_EINVAL,
                         "%s: holds %s, which is read here and would be lost; choose another "
                         "folder",
                         output, inner)
              : log_fail(log, RELUME_EINVAL,
                         "%s: is read here and would be lost; choose another name", output);
    mem_free(found);
    return status;
}
