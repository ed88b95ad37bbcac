// stopping.c - how the programs end when they are asked to
#include "cli/program/stopping.h"

#include <pthread.h>
#include <relume/base.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const struct timespec PATIENCE = {.tv_nsec = 800000000};

static volatile sig_atomic_t asked;
static sem_t anybody_asked;
static char line[64];  // with the line feed before it
static const volatile bool *is_midline;

static void on_signal(int number)
{
    asked = number;
    sem_post(&anybody_asked);
}

int stopping_asked(void)
{
    return asked;
}

int stopping_die(void)
{
    const int number = asked ? asked : SIGINT;
    signal(number, SIG_DFL);
    raise(number);
    return 128 + number;
}

static void *end_late(void *unused)
{
    while (sem_wait(&anybody_asked))
        ;
    nanosleep(&PATIENCE, NULL);
    relume_files_abandon();
    const bool midline = is_midline && *is_midline;
    (void)!write(STDERR_FILENO, line + !midline, strlen(line) - !midline);
    stopping_die();
    return unused;
}

static void start_watcher(void)
{
    pthread_t watcher;
    pthread_attr_t small;
    sem_init(&anybody_asked, 0, 0);
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 1 << 18);
    if (!pthread_create(&watcher, &small, end_late, NULL))
        pthread_detach(watcher);
    pthread_attr_destroy(&small);
}

void stopping_listen(const char *program, const volatile bool *midline)
{
    const struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESETHAND};
    struct sigaction before;
    snprintf(line, sizeof line, "\n%s: interrupted\n", program);
    is_midline = midline;
    start_watcher();
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL);
}
