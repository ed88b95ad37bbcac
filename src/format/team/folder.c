// folder.c - a team by files: each piece is a file that appears whole, so that a member that is
// stopped leaves nothing that others could take for a piece
//
// "samples.3of8" holds three lines, what it is, what it belongs to and how many bytes follow with
// their sum, and then the bytes. While one is being made there is the file "samples.3of8.begun",
// which grows. That is a courtesy: others wait for the piece while it does, and then make it
// themselves, which comes to the same bytes.
#include <relume/format/team.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/thread.h"
#include "core/math/fnv.h"
#include "format/team/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define FIRST_LINE "relume-learnt 1"
#define BEGUN      ".begun"

enum { NAME = 64, LOOK_MS = 50, BEAT_MS = 200 };
static const double PATIENCE_S = 2.0;  // without a beat

struct relume_team_files {
    struct relume_team team;
    char *path, *about;
    bool own_only, waits;
    const struct relume_log *log;
};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---------------------------------------------------------------- one piece

static char *piece_path(const relume_team_files *f, const char *what, int member, const char *more)
{
    return mem_format("%s/%s.%dof%d%s", f->path, what, member + 1, f->team.members, more);
}

static char *piece_head(const relume_team_files *f, const char *what, int member, const void *bytes,
                        size_t size)
{
    return mem_format(FIRST_LINE " %s.%dof%d\n%s\n%zu %016" PRIx64 "\n", what, member + 1,
                      f->team.members, f->about, size, fnv_of_words(FNV_START, bytes, size));
}

static relume_status write_piece(const relume_team_files *f, const char *path, const char *what,
                                 int member, const struct relume_buffer *piece)
{
    char *head = piece_head(f, what, member, piece->data, piece->size);
    const size_t length = head ? strlen(head) : 0;
    char *all = head ? mem_array(length + piece->size, 1) : NULL;
    relume_status status = all ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        memcpy(all, head, length);
        if (piece->size)
            memcpy(all + length, piece->data, piece->size);
        status = outfile_save(path, all, length + piece->size, f->log);
    }
    mem_free(head);
    mem_free(all);
    return status;
}

// The line at *at, without its end; *at moves behind it. NULL: there is none.
static char *take_line(char **at)
{
    char *line = *at, *end = strchr(line, '\n');
    if (!end)
        return NULL;
    *end = 0;
    *at = end + 1;
    return line;
}

static relume_status damaged(const relume_team_files *f, const char *path)
{
    return log_fail(f->log, RELUME_EDAMAGED, "%s: damaged; remove it, and it is made again", path);
}

// `all` is what the file holds, which is freed or moves to `piece`.
static relume_status take_piece(const relume_team_files *f, const char *path, const char *what,
                                int member, char *all, size_t size, struct relume_buffer *piece)
{
    char wanted[2 * NAME], *at = all;
    uint64_t sum = 0;
    size_t bytes = 0;
    snprintf(wanted, sizeof wanted, FIRST_LINE " %s.%dof%d", what, member + 1, f->team.members);
    const char *first = take_line(&at), *about = first ? take_line(&at) : NULL;
    const char *numbers = about ? take_line(&at) : NULL;
    if (!numbers || strncmp(first, FIRST_LINE " ", sizeof FIRST_LINE) ||
        sscanf(numbers, "%zu %" SCNx64, &bytes, &sum) != 2 || bytes != size - (size_t)(at - all) ||
        sum != fnv_of_words(FNV_START, at, bytes))
        return damaged(f, path);
    if (strcmp(about, f->about))
        return log_fail(f->log, RELUME_EUNFIT,
                        "%s: learnt in other work; expected '%s'; found '%s'; remove %s, or name "
                        "another folder",
                        path, f->about, about, f->path);
    if (strcmp(first, wanted))
        return log_fail(f->log, RELUME_EUNFIT, "%s: expected '%s'; found '%s'; remove it", path,
                        wanted, first);
    memmove(all, at, bytes);
    *piece = (struct relume_buffer){(unsigned char *)all, bytes, size, true};
    return RELUME_OK;
}

static relume_status read_piece(const relume_team_files *f, const char *path, const char *what,
                                int member, struct relume_buffer *piece)
{
    const struct relume_limits most = limits_or_default(limits_of(NULL, f->log));
    char *all = NULL;
    size_t size = 0;
    relume_status status =
        input_load(&all, &size, path, most.max_memory, "what parts have learnt", f->log);
    if (!status)
        status = take_piece(f, path, what, member, all, size, piece);
    if (status)
        mem_free(all);
    return status;
}

// ---------------------------------------------------------------- begun

struct beating {
    int file;
    pthread_mutex_t mutex;
    pthread_cond_t end;
    bool ended;
};

static void beat(void *context)
{
    struct beating *b = context;
    pthread_mutex_lock(&b->mutex);
    while (!b->ended) {
        struct timespec t;
        clock_gettime(CLOCK_REALTIME, &t);
        t.tv_nsec += BEAT_MS * 1000000L;
        t.tv_sec += t.tv_nsec / 1000000000L;
        t.tv_nsec %= 1000000000L;
        pthread_cond_timedwait(&b->end, &b->mutex, &t);
        if (write(b->file, ".", 1) < 1)
            break;
    }
    pthread_mutex_unlock(&b->mutex);
}

// How long the file is, asked of who keeps it: what is opened is not an older copy. -1: none.
static off_t length_of(const char *path)
{
    struct stat s;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    const off_t length = file >= 0 && !fstat(file, &s) ? s.st_size : -1;
    if (file >= 0)
        close(file);
    return length;
}

// ---------------------------------------------------------------- all of them

// What was seen of the piece of a member that another has begun.
struct watch {
    off_t length;
    double since;
};

struct gathering {
    relume_team_files *folder;
    const char *what;
    relume_team_make *make;
    void *context;
    struct relume_buffer *pieces;
    struct watch *watch;  // [members]
};

static relume_status make_piece(struct gathering *g, int member, const char *path)
{
    relume_status status = g->make(g->context, member, &g->pieces[member]);
    if (!status)
        status = write_piece(g->folder, path, g->what, member, &g->pieces[member]);
    return status;
}

// With a sign of life in `file`, if it is one.
static relume_status make_alive(struct gathering *g, int member, const char *path, int file)
{
    struct beating b = {file, PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, file < 0};
    struct thread_task task = {0};
    if (file >= 0)
        thread_start(&task, beat, &b);
    const relume_status status = make_piece(g, member, path);
    pthread_mutex_lock(&b.mutex);
    b.ended = true;
    pthread_cond_signal(&b.end);
    pthread_mutex_unlock(&b.mutex);
    if (file >= 0)
        thread_wait(&task);
    return status;
}

static bool is_alive(struct watch *w, const char *begun)
{
    const off_t length = length_of(begun);
    if (length != w->length || w->since == 0.0)
        *w = (struct watch){length, now()};
    return now() - w->since < PATIENCE_S;
}

static bool there(const char *path)
{
    struct stat s;
    return !stat(path, &s);
}

// The piece of `member`, unless somebody else is making it and one may wait. Whether it is there
// now is whether it has data.
static relume_status get_piece(struct gathering *g, int member, bool wait)
{
    char *path = piece_path(g->folder, g->what, member, "");
    char *begun = piece_path(g->folder, g->what, member, BEGUN);
    relume_status status = path && begun ? RELUME_OK : RELUME_ENOMEM;
    if (!status && there(path)) {
        status = read_piece(g->folder, path, g->what, member, &g->pieces[member]);
    } else if (!status) {
        const int file = open(begun, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || !wait || !is_alive(&g->watch[member], begun))
            status = make_alive(g, member, path, file);
        if (file >= 0)
            close(file);
        if (g->pieces[member].data || file >= 0)
            remove(begun);
    }
    mem_free(path);
    mem_free(begun);
    return status;
}

// Leave the own piece where it is not there yet. The work may go on where all of them were there.
static relume_status leave_own(struct gathering *g)
{
    const struct relume_team *t = &g->folder->team;
    relume_status status = get_piece(g, t->member, false);
    g->folder->waits = false;
    for (int i = 0; !status && i < t->members; i++) {
        char *path = piece_path(g->folder, g->what, i, "");
        status = path ? RELUME_OK : RELUME_ENOMEM;
        g->folder->waits |= path && !there(path);
        mem_free(path);
    }
    return !status && g->folder->waits ? RELUME_ECANCEL : status;
}

// Own piece first, then the others from there on, so that several members meet late.
static relume_status look_round(struct gathering *g, int *missing)
{
    const struct relume_team *t = &g->folder->team;
    relume_status status = RELUME_OK;
    *missing = 0;
    for (int i = 0; !status && i < t->members; i++) {
        const int member = (t->member + i) % t->members;
        if (!g->pieces[member].data)
            status = get_piece(g, member, i > 0);
        *missing += !g->pieces[member].data;
    }
    return status;
}

static relume_status wait_a_little(const struct gathering *g, int missing)
{
    const struct timespec pause = {.tv_nsec = LOOK_MS * 1000000L};
    const int members = g->folder->team.members;
    nanosleep(&pause, NULL);
    return log_progress(g->folder->log, "waiting", (members - missing) / (double)members)
               ? RELUME_OK
               : RELUME_ECANCEL;
}

static relume_status share(void *user, const char *what, relume_team_make *make, void *context,
                           struct relume_buffer *pieces)
{
    struct gathering g = {user, what, make, context, pieces, NULL};
    int missing = 0;
    if (mkdir(g.folder->path, 0777) && errno != EEXIST)
        return log_fail(g.folder->log, RELUME_EIO, "%s: cannot be made; %s", g.folder->path,
                        strerror(errno));
    g.watch = mem_zeroed((size_t)g.folder->team.members, sizeof *g.watch);
    relume_status status = !g.watch             ? RELUME_ENOMEM
                           : g.folder->own_only ? leave_own(&g)
                                                : RELUME_OK;
    if (!status)
        status = look_round(&g, &missing);
    while (!status && missing) {
        status = wait_a_little(&g, missing);
        if (!status)
            status = look_round(&g, &missing);
    }
    mem_free(g.watch);
    return status;
}

// ---------------------------------------------------------------- interface

relume_status relume_team_folder(relume_team_files **out, const char *path, int member, int members,
                                 const char *about, bool own_only, const struct relume_log *log)
{
    *out = NULL;
    if (member < 0 || member >= members || strchr(about, '\n'))
        return RELUME_EINVAL;
    relume_team_files *f = mem_zeroed(1, sizeof *f);
    if (!f)
        return RELUME_ENOMEM;
    f->team = (struct relume_team){.member = member, .members = members, .share = share, .user = f};
    f->own_only = own_only;
    f->log = log;
    f->path = mem_text(path);
    f->about = mem_text(about);
    if (!f->path || !f->about)
        relume_team_folder_destroy(&f);
    *out = f;
    return f ? RELUME_OK : RELUME_ENOMEM;
}

bool relume_team_folder_waits(const relume_team_files *folder)
{
    return folder->waits;
}

const struct relume_team *relume_team_of_folder(const relume_team_files *folder)
{
    return &folder->team;
}

void relume_team_folder_destroy(relume_team_files **folder)
{
    if (*folder) {
        mem_free((*folder)->path);
        mem_free((*folder)->about);
    }
    mem_free(*folder);
    *folder = NULL;
}
