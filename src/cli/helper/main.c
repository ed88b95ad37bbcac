// main.c - relume-helper: the program in which foreign files are read and lossy planes are coded
// (core/base/helper.h)
//
// It loads a reader's module when the first file of its kind comes, and forks the processes that
// work. It ends with the process that started it, or when nobody asked for a while.
#include "core/base/channel.h"
#include "core/base/helper.h"
#include "core/base/module.h"
#include "format/lossy/av1_serve.h"
#include "image/image/picture_serve.h"
#include "shape/mesh/mesh_serve.h"

#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const struct {
    const char *module;  // or NULL
    void (*serve)(int channel, const void *bridge);
} kinds[] = {
    [HELPER_PICTURE] = {"oiio", picture_serve},
    [HELPER_MESH] = {"assimp", mesh_serve},
    [HELPER_AV1] = {NULL, av1_serve},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

// How processes ended that crashed, until somebody asks; the oldest go first.
static struct {
    pid_t process;
    int how;
} crashed[256];
static unsigned crashes;

static void note_end(pid_t process, int how)
{
    if (how) {
        crashed[crashes % 256].process = process;
        crashed[crashes++ % 256].how = how;
    }
}

// One that goes on without a channel for two seconds is ended.
static int how_ended(pid_t process)
{
    static const struct timespec moment = {.tv_nsec = 10000000};
    int how = 0;
    for (int i = 0; i < 256; i++)
        if (crashed[i].process == process)
            return crashed[i].how;
    for (int i = 0; i < 200; i++, nanosleep(&moment, NULL)) {
        const pid_t ended = waitpid(process, &how, WNOHANG);
        if (ended)
            return ended == process ? how : 0;
    }
    kill(process, SIGKILL);
    return 0;
}

// A process that works. It has nothing of the others: no channel to the program that starts
// processes, and no core file, which would be large and has somebody's picture in it.
static _Noreturn void serve(int kind, int channel, const void *bridge)
{
    const struct rlimit none = {0, 0};
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setrlimit(RLIMIT_CORE, &none);
    dup2(channel, HELPER_CHANNEL);
    close(channel);
    kinds[kind].serve(HELPER_CHANNEL, bridge);
    _exit(0);
}

static void start_process(struct helper_reply *reply, int kind, int channel)
{
    static const void *bridges[KINDS];
    if (kind < 0 || kind >= KINDS || channel < 0)
        return;
    if (!bridges[kind] && kinds[kind].module)
        bridges[kind] = module_open(kinds[kind].module, reply->why, &reply->error);
    if (!bridges[kind] && kinds[kind].module)
        return;
    const pid_t process = fork();
    if (process == 0)
        serve(kind, channel, bridges[kind]);
    reply->process = process > 0 ? process : 0;
    reply->error = process < 0 ? errno : 0;
    if (process < 0)
        snprintf(reply->why, sizeof reply->why, "no process; %s", strerror(errno));
}

static void answer(const struct helper_order *order, int channel)
{
    struct helper_reply reply = {0};
    if (strncmp(order->version, RELUME_VERSION, sizeof order->version))
        snprintf(reply.why, sizeof reply.why, "relume-helper is of version %s; expected %.15s",
                 RELUME_VERSION, order->version);
    else if (order->ended)
        reply.how = how_ended(order->ended);
    else
        start_process(&reply, order->kind, channel);
    channel_send(HELPER_CHANNEL, &reply, sizeof reply, -1);
}

// Signals of a terminal are for the tool: this ends with it.
static void settle(void)
{
    static const int others[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        signal(others[i], SIG_IGN);
    fcntl(HELPER_CHANNEL, F_SETFD, FD_CLOEXEC);
    (void)mallopt(M_ARENA_MAX, 1);  // each would take addresses that RLIMIT_AS counts
    close_range(HELPER_CHANNEL + 1, ~0U, 0);
}

int main(void)
{
    struct helper_order order;
    int channel;
    settle();
    struct pollfd asked = {.fd = HELPER_CHANNEL, .events = POLLIN};
    for (;;) {
        const int waited = poll(&asked, 1, HELPER_IDLE_S * 1000);
        // Whether any process is left.
        int how;
        pid_t ended;
        while ((ended = waitpid(-1, &how, WNOHANG)) > 0)
            note_end(ended, how);
        const bool busy = ended == 0;
        if (waited == 0 && !busy)
            _exit(0);
        if (waited <= 0)
            continue;
        if (!channel_receive(HELPER_CHANNEL, &order, sizeof order, &channel))
            _exit(0);  // what modules leave at their end is nobody's concern
        answer(&order, channel);
        if (channel >= 0)
            close(channel);
    }
}
