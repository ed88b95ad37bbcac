// loader.c - codes of views, read by a thread of its own while frames are drawn
#include "relit/loader.h"

#include <pthread.h>
#include <stdlib.h>

enum stage { IDLE, ASKED, READING, READ };

struct loader {
    struct code_source source;
    int views;
    pthread_t thread;
    pthread_mutex_t lock;  // of everything below
    pthread_cond_t requested, news;
    enum stage *stage;      // [views]
    uint64_t *order;        // [views]: when it was asked for
    struct loaded *result;  // [views]
    uint64_t asked;
    bool stop;
};

// The view of that stage which was asked for first, or -1.
static int first_of(const struct loader *l, enum stage stage)
{
    int first = -1;
    for (int i = 0; i < l->views; i++)
        if (l->stage[i] == stage && (first < 0 || l->order[i] < l->order[first]))
            first = i;
    return first;
}

static struct loaded read_view(struct loader *l, int view)
{
    struct loaded result = {.view = view};
    result.status = l->source.codes(&result.codes, l->source.user, view);
    return result;
}

static void *read_views(void *context)
{
    struct loader *l = context;
    pthread_mutex_lock(&l->lock);
    while (!l->stop) {
        const int view = first_of(l, ASKED);
        if (view < 0) {
            pthread_cond_wait(&l->requested, &l->lock);
            continue;
        }
        l->stage[view] = READING;
        pthread_mutex_unlock(&l->lock);
        const struct loaded result = read_view(l, view);
        pthread_mutex_lock(&l->lock);
        l->result[view] = result;
        l->stage[view] = READ;
        pthread_cond_signal(&l->news);
    }
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

static void release(struct loader *l)
{
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->requested);
    pthread_cond_destroy(&l->news);
    free(l->stage);
    free(l->order);
    free(l->result);
    free(l);
}

relume_status loader_create(struct loader **out, const struct code_source *source, int views)
{
    *out = NULL;
    struct loader *l = calloc(1, sizeof *l);
    if (!l)
        return RELUME_ENOMEM;
    l->source = *source;
    l->views = views;
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->requested, NULL);
    pthread_cond_init(&l->news, NULL);
    l->stage = calloc((size_t)views, sizeof *l->stage);
    l->order = calloc((size_t)views, sizeof *l->order);
    l->result = calloc((size_t)views, sizeof *l->result);
    relume_status status = l->stage && l->order && l->result ? RELUME_OK : RELUME_ENOMEM;
    if (!status && pthread_create(&l->thread, NULL, read_views, l))
        status = RELUME_ESYSTEM;
    if (status)
        release(l);
    else
        *out = l;
    return status;
}

void loader_destroy(struct loader **loader)
{
    struct loader *l = *loader;
    *loader = NULL;
    if (!l)
        return;
    pthread_mutex_lock(&l->lock);
    l->stop = true;
    pthread_cond_signal(&l->requested);
    pthread_mutex_unlock(&l->lock);
    pthread_join(l->thread, NULL);
    for (int i = 0; i < l->views; i++)
        if (l->stage[i] == READ && !l->result[i].status && l->source.drop)
            l->source.drop(l->source.user, i);
    release(l);
}

void loader_ask(struct loader *loader, int view)
{
    pthread_mutex_lock(&loader->lock);
    if (loader->stage[view] == IDLE) {
        loader->stage[view] = ASKED;
        loader->order[view] = loader->asked++;
        pthread_cond_signal(&loader->requested);
    }
    pthread_mutex_unlock(&loader->lock);
}

void loader_clear(struct loader *loader)
{
    pthread_mutex_lock(&loader->lock);
    for (int i = 0; i < loader->views; i++)
        if (loader->stage[i] == ASKED)
            loader->stage[i] = IDLE;
    pthread_mutex_unlock(&loader->lock);
}

bool loader_take(struct loaded *out, struct loader *loader, bool wait)
{
    pthread_mutex_lock(&loader->lock);
    int view = first_of(loader, READ);
    while (view < 0 && wait && (first_of(loader, ASKED) >= 0 || first_of(loader, READING) >= 0)) {
        pthread_cond_wait(&loader->news, &loader->lock);
        view = first_of(loader, READ);
    }
    if (view >= 0) {
        *out = loader->result[view];
        loader->stage[view] = IDLE;
    }
    pthread_mutex_unlock(&loader->lock);
    return view >= 0;
}
