// relume_mpi.c - relume encode by all processes of an MPI launcher
//
//     mpirun -n 8 relume-mpi encode slab -o slab.exr
//
// Each process is a member of a team in memory (relume/format/team.h); the tool does the rest
// (encode/encode/together.c). Here is what MPI adds: pieces are exchanged by collective
// calls, a process that fails stops the others at their next one, and people read one voice: that
// of the first process, and of others what it has not said.
#include "cli/start.h"
#include "core/math/fnv.h"

#include <mpi.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_AT_ONCE = 1 << 30 };  // bytes: MPI counts them as int
static const int64_t MOST_PIECE = (int64_t)1 << 42;

struct processes {
    struct relume_team team;
    bool broken;      // somebody failed; nobody waits for anybody any more
    int64_t *number;  // [members]
};

static FILE *voice;  // standard error as it was; NULL: only heard
static char *heard;  // all that this process has said
static size_t heard_size;
static FILE *hearing;

// ---------------------------------------------------------------- pieces

// A name as a number that is not negative.
static int64_t number_of(const char *what)
{
    return (int64_t)(fnv_of_text(what) >> 1);
}

// Everybody's number; negative ones say that their process has failed.
static bool exchange(struct processes *p, int64_t mine)
{
    MPI_Allgather(&mine, 1, MPI_INT64_T, p->number, 1, MPI_INT64_T, MPI_COMM_WORLD);
    for (int i = 0; i < p->team.members; i++)
        p->broken |= p->number[i] < 0;
    return !p->broken;
}

static void spread(struct relume_buffer *piece, int from)
{
    for (size_t at = 0; at < piece->size; at += MOST_AT_ONCE) {
        const size_t left = piece->size - at;
        MPI_Bcast(piece->data + at, (int)(left < MOST_AT_ONCE ? left : MOST_AT_ONCE), MPI_BYTE,
                  from, MPI_COMM_WORLD);
    }
}

// Allocates a piece of another process; buffers are written by their writer alone.
static bool allocate_piece(struct relume_buffer *piece, int64_t size)
{
    const struct relume_writer writer = relume_buffer_writer(piece);
    return !size || (writer.write(writer.user, "", 1, (uint64_t)size - 1));
}

// All processes are at the same place: they share the same, of the same version of the program.
static relume_status agree(struct processes *p, const char *what)
{
    char all[128];
    snprintf(all, sizeof all, "relume %s: %s", RELUME_VERSION, what);
    if (!exchange(p, number_of(all)))
        return RELUME_ECANCEL;
    for (int i = 0; i < p->team.members; i++)
        if (p->number[i] != p->number[0]) {
            p->broken = true;
            fprintf(
                stderr,
                "relume: processes 1 and %d do not share the same (%s); expected one version of "
                "relume-mpi and one command line on all machines\n",
                i + 1, what);
            return RELUME_EUNFIT;
        }
    return RELUME_OK;
}

static relume_status refuse_size(int process, const char *what, int64_t size)
{
    fprintf(stderr, "relume: process %d wants to share %lld bytes (%s); expected fewer\n",
            process + 1, (long long)size, what);
    return RELUME_EDAMAGED;
}

static relume_status share(void *user, const char *what, relume_team_make *make, void *context,
                           struct relume_buffer *pieces)
{
    struct processes *p = user;
    const int own = p->team.member;
    if (p->broken)
        return RELUME_ECANCEL;
    relume_status status = agree(p, what);
    if (status)
        return status;
    status = make(context, own, &pieces[own]);
    if (!exchange(p, status ? -1 : (int64_t)pieces[own].size))
        return status ? status : RELUME_ECANCEL;
    for (int i = 0; !status && i < p->team.members; i++)
        if (p->number[i] > MOST_PIECE)
            status = refuse_size(i, what, p->number[i]);
        else if (i != own && !allocate_piece(&pieces[i], p->number[i]))
            status = RELUME_ENOMEM;
    if (!exchange(p, status ? -1 : 0))
        return status ? status : RELUME_ECANCEL;
    for (int i = 0; i < p->team.members; i++)
        spread(&pieces[i], i);
    return RELUME_OK;
}

// ---------------------------------------------------------------- one voice

static ssize_t hear(void *cookie, const char *text, size_t size)
{
    (void)cookie;
    if (voice) {
        fwrite(text, 1, size, voice);
        fflush(voice);
    }
    return (ssize_t)fwrite(text, 1, size, hearing);
}

static bool listen_to(bool first)
{
    hearing = open_memstream(&heard, &heard_size);
    voice = first ? stderr : NULL;
    FILE *const both = fopencookie(NULL, "w", (cookie_io_functions_t){.write = hear});
    if (!hearing || !both)
        return false;
    setvbuf(both, NULL, _IOLBF, 0);
    stderr = both;
    return true;
}

static void speak(const char *text)
{
    hear(NULL, text, strlen(text));
}

// The first process says what another has to say, but for lines that it has said itself.
static void repeat(char *text)
{
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        fflush(hearing);
        if (!heard || !strstr(heard, line))
            speak(line), speak("\n");
    }
}

// All others' texts, one after another; of processes that only stopped for others nothing.
static void gather_texts(const struct processes *p, bool stopped)
{
    fflush(hearing);
    int64_t size = stopped ? 0 : (int64_t)heard_size;
    if (p->team.member) {
        MPI_Send(&size, 1, MPI_INT64_T, 0, 0, MPI_COMM_WORLD);
        MPI_Send(heard, (int)size, MPI_BYTE, 0, 0, MPI_COMM_WORLD);
        return;
    }
    for (int i = 1; i < p->team.members; i++) {
        MPI_Recv(&size, 1, MPI_INT64_T, i, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        char *text = calloc((size_t)size + 1, 1);
        MPI_Recv(text, text ? (int)size : 0, MPI_BYTE, i, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (text)
            repeat(text);
        free(text);
    }
}

// ---------------------------------------------------------------- main

// Threads of each process: those of a machine are shared by all processes on it.
static int threads_each(void)
{
    MPI_Comm machine;
    int processes = 1;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &processes);
    MPI_Comm_free(&machine);
    return relume_cpu_count() > processes ? relume_cpu_count() / processes : 1;
}

// The exit status of all: that of the first process that failed by itself.
static int exit_of_all(struct processes *p, relume_status status)
{
    const bool stopped = status == RELUME_ECANCEL && p->broken;
    if (status == RELUME_ENOMEM)
        speak("relume: out of memory\n");
    if (status == RELUME_ECANCEL && !stopped)
        speak("relume: interrupted; no unfinished output is left\n");
    const int64_t own = stopped ? 0 : relume_status_exit(status);
    int code = 0;
    signal(SIGTERM, SIG_IGN);  // the launcher sends it when the first of several ends with an error
    gather_texts(p, stopped);
    MPI_Allgather(&own, 1, MPI_INT64_T, p->number, 1, MPI_INT64_T, MPI_COMM_WORLD);
    for (int i = 0; i < p->team.members && !code; i++)
        code = (int)p->number[i];
    return code;
}

int main(int argc, char **argv)
{
    int level, code = 3;
    struct processes p = {.team = {.close = true, .share = share, .user = &p}};
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &p.team.member);
    MPI_Comm_size(MPI_COMM_WORLD, &p.team.members);
    p.number = calloc((size_t)p.team.members, sizeof *p.number);
    if (p.number && listen_to(p.team.member == 0)) {
        const relume_status status = tool_run(argc, argv, &p.team, threads_each());
        if (!p.broken)
            exchange(&p, status ? -1 : 0);
        code = exit_of_all(&p, status);
    }
    MPI_Finalize();
    return code;
}
