// batch.c - relight many files by one light; shows how far it is and stops cleanly on Ctrl-C
//
//     cc -std=c11 batch.c $(pkg-config --cflags --libs relume) -o batch
//     ./batch raking 1 0 0.2 *.exr        # statue.exr -> statue-raking.png
#include <relume/relume.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

static void say(void *user, enum relume_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "batch: %s%s\n", level == RELUME_WARNING ? "warning: " : "", text);
}

// Called while the library works; `false` asks it to stop.
static bool go_on(void *user, const char *what, double done)
{
    fprintf(stderr, "%s: %s %3.0f %%\r", (const char *)user, what, 100.0 * done);
    return !stopped;
}

static relume_status relight(const char *file, const char *name, const struct relume_light *light)
{
    const struct relume_log log = {.message = say, .progress = go_on, .user = (void *)(size_t)file};
    const char *dot = strrchr(file, '.');
    const int stem = dot ? (int)(dot - file) : (int)strlen(file);
    char out[4096];
    struct relume_image picture = {0};
    relume_pack *pack = NULL;

    snprintf(out, sizeof out, "%.*s-%s.png", stem, file, name);
    relume_status status = relume_open(&pack, file, relume_open_params(.log = &log));
    if (!status)
        status = relume_frame(&picture, pack, &(struct relume_camera){0}, light, 1,
                              relume_frame_params(.log = &log));
    if (!status)
        status = relume_image_save(&picture, out, relume_image_params(.log = &log));
    if (!status)
        printf("%s\n", out);
    relume_image_destroy(&picture);
    relume_pack_destroy(&pack);
    return status;
}

int main(int argc, char **argv)
{
    if (argc < 6)
        return fprintf(stderr, "usage: batch NAME X Y Z FILE...\n"), 2;
    const struct relume_light light = {.direction = {atof(argv[2]), atof(argv[3]), atof(argv[4])},
                                       .rgb = {1, 1, 1}};
    int failed = 0;
    signal(SIGINT, stop);
    for (int i = 5; i < argc && !stopped; i++)
        failed += relight(argv[i], argv[1], &light) != RELUME_OK;
    return stopped ? 130 : failed ? 1 : 0;
}
