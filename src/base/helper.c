#include "base/helper.h"

#include "base/channel.h"
#include "base/memory.h"
#include "base/module.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

// The program, once it is started. It ends by itself when nobody asks for long.
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int control = -1;
static pid_t program;

// This process' environment, with libraries of mathematics told to start no threads.
static char **quiet_environment(void)
{
    static char quiet[][32] = {"OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1"};
    enum { QUIET = sizeof quiet / sizeof *quiet };
    size_t n = 0;
    while (environ[n])
        n++;
    char **all = mem_array(n + QUIET + 1, sizeof *all);
    if (!all)
        return NULL;
    for (size_t i = 0; i < QUIET; i++)
        all[i] = quiet[i];
    memcpy(all + QUIET, environ, (n + 1) * sizeof *all);
    return all;
}

// Nothing is open there but its channel; what its libraries print is for nobody, unless sanitizers
// have something to say.
static int spawn(const char *path, int end)
{
    posix_spawn_file_actions_t files;
    char *const arguments[] = {(char[]){"relume-helper"}, NULL};
    char **environment = quiet_environment();
    if (!environment)
        return ENOMEM;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, end, HELPER_CHANNEL);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#endif
    const int error = posix_spawn(&program, path, &files, NULL, arguments, environment);
    posix_spawn_file_actions_destroy(&files);
    free(environment);
    return error;
}

static bool start_program(char why[HELPER_WHY])
{
    int ends[2];
    char path[PATH_MAX];
    if (!module_program("relume-helper", path)) {
        snprintf(why, HELPER_WHY, "relume-helper is not beside the library");
        return false;
    }
    int error = channel_pair(ends) ? 0 : errno;
    if (!error) {
        error = spawn(path, ends[1]);
        close(ends[1]);
        if (error)
            close(ends[0]);
    }
    if (error)
        snprintf(why, HELPER_WHY, "relume-helper cannot be started; %s", strerror(error));
    else
        control = ends[0];
    return !error;
}

static void drop_program(void)
{
    close(control);
    control = -1;
    kill(program, SIGKILL);
    while (waitpid(program, NULL, 0) < 0 && errno == EINTR)
        ;
}

// Asks the program, which is started where there is none, or where it has ended in the meantime.
static bool ask(struct helper_reply *reply, const struct helper_order *order, int end)
{
    *reply = (struct helper_reply){0};
    for (int attempt = 0; attempt < 2; attempt++) {
        if (control < 0 && !start_program(reply->why))
            return false;
        if (channel_send(control, order, sizeof *order, end) &&
            channel_receive(control, reply, sizeof *reply, NULL))
            return true;
        drop_program();
        snprintf(reply->why, sizeof reply->why, "relume-helper has ended");
    }
    return false;
}

static bool ask_in_turn(struct helper_reply *reply, const struct helper_order *order, int end)
{
    pthread_mutex_lock(&lock);
    const bool good = ask(reply, order, end);
    pthread_mutex_unlock(&lock);
    reply->why[HELPER_WHY - 1] = '\0';
    return good;
}

relume_status helper_start(struct helper_job *job, enum helper_kind kind)
{
    const struct helper_order order = {.version = RELUME_VERSION, .kind = kind};
    struct helper_reply reply;
    int ends[2];
    *job = (struct helper_job){.channel = -1};
    if (!channel_pair(ends)) {
        snprintf(job->why, HELPER_WHY, "no channel to relume-helper; %s", strerror(errno));
        return RELUME_ESYSTEM;
    }
    const bool good = ask_in_turn(&reply, &order, ends[1]) && reply.process > 0;
    close(ends[1]);
    if (!good) {
        close(ends[0]);
        snprintf(job->why, HELPER_WHY, "%s", reply.why);
        return RELUME_ESYSTEM;
    }
    job->channel = ends[0];
    job->process = reply.process;
    return RELUME_OK;
}

// Its channel is closed, so it ends, or has.
static relume_status find_out(struct helper_job *job)
{
    const struct helper_order order = {.version = RELUME_VERSION, .ended = job->process};
    struct helper_reply reply;
    close(job->channel);
    job->channel = -1;
    const int how = ask_in_turn(&reply, &order, -1) ? reply.how : 0;
    const int number = WIFSIGNALED(how) ? WTERMSIG(how) : 0;
    if (number == SIGXCPU || number == SIGKILL)
        snprintf(job->why, HELPER_WHY,
                 "reading it takes for ever; damaged, or made to keep machines busy");
    else
        snprintf(job->why, HELPER_WHY, "its reader crashed (%s); damaged, or made to do harm",
                 number ? strsignal(number) : "no answer");
    return RELUME_EDATA;
}

relume_status helper_tell(struct helper_job *job, const void *message, size_t size, int file)
{
    if (job->channel < 0)
        return RELUME_EDATA;
    return channel_send(job->channel, message, size, file) ? RELUME_OK : find_out(job);
}

relume_status helper_hear(struct helper_job *job, void *answer, size_t size)
{
    if (job->channel < 0)
        return RELUME_EDATA;
    return channel_receive(job->channel, answer, size, NULL) ? RELUME_OK : find_out(job);
}

void helper_end(struct helper_job *job)
{
    if (job->process && job->channel >= 0)
        close(job->channel);
    *job = (struct helper_job){.channel = -1};
}
