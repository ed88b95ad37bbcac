// exchanger.c - light between a scene and the objects in it, by the library, in a thread of its own
#include "relit/exchanger.h"

#include "cli/program/clock.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    ENOUGH = 96,     // pixels along the longer side: smaller pictures are drawn at once
    SENTENCES = 16,  // that are remembered, the newest
    WORDS = 512
};

struct picture {
    struct exchange_request of;  // its lights are owned
    struct relume_image image;
    enum exchange_step step;
    uint64_t serial;
    double seconds;
};

struct slot {
    // With the lock.
    struct exchange_request wanted;  // its lights are owned; transport NULL: nothing
    uint64_t serial;                 // of it
    int next;                        // step of it
    relume_status failed;
    struct picture made;  // not shown yet; its image may be empty
    // Of who shows.
    struct picture shown;
};

struct exchanger {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t requested, news;
    struct slot slot[EXCHANGER_SLOTS];
    uint64_t serials;
    int working;              // slot, or -1
    enum exchange_step step;  // that it is at

    bool rests, stop;
    atomic_bool cancel;
    atomic_int percent;  // of the work in hand
    struct sentence {
        enum relume_level level;
        char words[WORDS];
    } sentence[SENTENCES];
    int sentences, spoken;  // the first of them are spoken
    struct relume_log log;
    const struct relume_log *to;
    struct exchange_drawer drawer;  // of the thread
};

// ---------------------------------------------------------------- requests

static bool is_small(const struct exchange_request *q)
{
    const int width = q->camera.width, height = q->camera.height;
    return (width > height ? width : height) <= ENOUGH;
}

static int first_step(const struct exchange_request *q)
{
    return q->waits || is_small(q) ? EXCHANGE_STEP_FINE : EXCHANGE_STEP_ROUGH;
}

// Behind the last.
static int end_of(const struct exchange_request *q)
{
    return q->moves && !q->waits && !is_small(q) ? EXCHANGE_STEP_FINE : EXCHANGE_STEPS;
}

static void picture_forget(struct picture *p)
{
    exchange_request_forget(&p->of);
    relume_image_destroy(&p->image);
    *p = (struct picture){.serial = 0};
}

// ---------------------------------------------------------------- the thread

// A sentence that was not heard before is kept for who speaks; the oldest makes room.
static void keep_sentence(void *user, enum relume_level level, const char *text)
{
    struct exchanger *e = user;
    if (e->drawer.opens && level != RELUME_ERROR)
        return;
    pthread_mutex_lock(&e->lock);
    bool known = false;
    for (int i = 0; i < e->sentences; i++)
        known |= !strncmp(e->sentence[i].words, text, WORDS - 1);
    if (!known && e->sentences == SENTENCES) {
        memmove(e->sentence, e->sentence + 1, (SENTENCES - 1) * sizeof *e->sentence);
        e->sentences--;
        e->spoken -= e->spoken > 0;
    }
    if (!known) {
        struct sentence *s = &e->sentence[e->sentences++];
        s->level = level;
        snprintf(s->words, WORDS, "%s", text);
        pthread_cond_broadcast(&e->news);
    }
    pthread_mutex_unlock(&e->lock);
}

static bool go_on(void *user, const char *what, double done)
{
    struct exchanger *e = user;
    (void)what;
    atomic_store(&e->percent, (int)(100.0 * done));
    return !atomic_load(&e->cancel);
}

// The slot whose next step is the roughest, or -1.
static int find_slot(const struct exchanger *e)
{
    for (int step = EXCHANGE_STEP_ROUGH; step < EXCHANGE_STEPS && !e->rests; step++)
        for (int i = 0; i < EXCHANGER_SLOTS; i++) {
            const struct slot *s = &e->slot[i];
            if (s->wanted.transport && !s->failed && s->next == step && step < end_of(&s->wanted))
                return i;
        }
    return -1;
}

// With the lock. Takes `picture`.
static void hand_over(struct exchanger *e, struct slot *s, struct picture *picture,
                      relume_status status)
{
    const bool wanted = s->serial == picture->serial && !e->rests;
    if (status == RELUME_ECANCEL || e->rests || !s->wanted.transport) {
        picture_forget(picture);
        return;
    }
    if (status) {
        s->failed = wanted ? status : s->failed;
        picture_forget(picture);
        return;
    }
    if (wanted)
        s->next = picture->step + 1;
    picture_forget(&s->made);
    s->made = *picture;
}

// With the lock, which it lets go of meanwhile.
static void draw_slot(struct exchanger *e, int number)
{
    struct slot *s = &e->slot[number];
    struct picture picture = {.step = (enum exchange_step)s->next, .serial = s->serial};
    relume_status status =
        exchange_request_copy(&picture.of, &s->wanted) ? RELUME_OK : RELUME_ENOMEM;
    e->working = number;
    e->step = picture.step;
    atomic_store(&e->cancel, false);
    atomic_store(&e->percent, 0);
    pthread_mutex_unlock(&e->lock);
    const double start = now_s();
    if (!status)
        status = exchange_draw(&picture.image, &e->drawer, number, &picture.of, picture.step);
    picture.seconds = now_s() - start;
    pthread_mutex_lock(&e->lock);
    e->working = -1;
    hand_over(e, s, &picture, status);
    pthread_cond_broadcast(&e->news);
}

static void *draw_pictures(void *context)
{
    struct exchanger *e = context;
    pthread_mutex_lock(&e->lock);
    while (!e->stop) {
        const int number = find_slot(e);
        if (number < 0)
            pthread_cond_wait(&e->requested, &e->lock);
        else
            draw_slot(e, number);
    }
    pthread_mutex_unlock(&e->lock);
    return NULL;
}

// ---------------------------------------------------------------- making

static void release(struct exchanger *e)
{
    for (int i = 0; i < EXCHANGER_SLOTS; i++) {
        struct slot *s = &e->slot[i];
        exchange_request_forget(&s->wanted);
        picture_forget(&s->made);
        picture_forget(&s->shown);
    }
    exchange_drawer_release(&e->drawer);
    pthread_mutex_destroy(&e->lock);
    pthread_cond_destroy(&e->requested);
    pthread_cond_destroy(&e->news);
    free(e);
}

relume_status exchanger_create(struct exchanger **out, const struct exchange_source *source)
{
    struct exchanger *e = calloc(1, sizeof *e);
    *out = NULL;
    if (!e)
        return RELUME_ENOMEM;
    e->working = -1;
    e->to = source->log;
    e->drawer = (struct exchange_drawer){.source = *source, .log = &e->log};
    e->log = (struct relume_log){.message = keep_sentence,
                                 .progress = go_on,
                                 .user = e,
                                 .context = source->log ? source->log->context : NULL};
    pthread_mutex_init(&e->lock, NULL);
    pthread_cond_init(&e->requested, NULL);
    pthread_cond_init(&e->news, NULL);
    if (pthread_create(&e->thread, NULL, draw_pictures, e)) {
        release(e);
        return RELUME_ESYSTEM;
    }
    *out = e;
    return RELUME_OK;
}

void exchanger_destroy(struct exchanger **exchanger)
{
    struct exchanger *e = *exchanger;
    *exchanger = NULL;
    if (!e)
        return;
    pthread_mutex_lock(&e->lock);
    e->stop = true;
    atomic_store(&e->cancel, true);
    pthread_cond_broadcast(&e->requested);
    pthread_mutex_unlock(&e->lock);
    pthread_join(e->thread, NULL);
    release(e);
}

// ---------------------------------------------------------------- asking

// With the lock: whether what is worked at is of no use for the request.
static bool is_useless(const struct exchanger *e, int slot, const struct exchange_request *q)
{
    const struct exchange_request *was = &e->slot[slot].wanted;
    if (e->working != slot)
        return false;
    return !q || e->step != EXCHANGE_STEP_ROUGH || !exchange_same_way(was, q) ||
           !(e->drawer.source.scene || exchange_same_eye(was, q));
}

// With the lock. `copy` is taken.
static void want(struct exchanger *e, int slot, struct exchange_request *copy)
{
    struct slot *s = &e->slot[slot];
    if (is_useless(e, slot, copy->transport ? copy : NULL))
        atomic_store(&e->cancel, true);
    exchange_request_forget(&s->wanted);
    s->wanted = *copy;
    s->serial = ++e->serials;
    s->next = first_step(copy);
    s->failed = RELUME_OK;
    pthread_cond_signal(&e->requested);
}

relume_status exchanger_ask(struct exchanger *e, int slot, const struct exchange_request *request)
{
    struct slot *s = &e->slot[slot];
    struct exchange_request copy = {.transport = NULL};
    relume_status status = RELUME_OK;
    pthread_mutex_lock(&e->lock);
    const bool same = request ? s->wanted.transport && exchange_same_request(&s->wanted, request)
                              : !s->wanted.transport;
    if (same && request && !e->rests) {
        s->wanted.moves = request->moves;
        s->wanted.waits = request->waits;
        if (s->next < first_step(&s->wanted))
            s->next = first_step(&s->wanted);
        pthread_cond_signal(&e->requested);
    } else if (!same || request) {
        if (request && !exchange_request_copy(&copy, request))
            status = RELUME_ENOMEM;
        else
            want(e, slot, &copy);
    }
    e->rests &= request == NULL;
    pthread_mutex_unlock(&e->lock);
    return status;
}

// With the lock.
static bool slot_is_busy(const struct exchanger *e, int slot)
{
    const struct slot *s = &e->slot[slot];
    return !e->rests && s->wanted.transport && !s->failed && s->next < end_of(&s->wanted);
}

enum exchange_fit exchanger_show(const struct relume_image **image, bool *fresh,
                                 struct exchanger *e, int slot)
{
    struct slot *s = &e->slot[slot];
    enum exchange_fit fit = EXCHANGE_NONE;
    pthread_mutex_lock(&e->lock);
    *fresh = s->made.image.data != NULL;
    if (*fresh) {
        picture_forget(&s->shown);
        s->shown = s->made;
        s->made = (struct picture){.serial = 0};
    }
    const struct picture *p = &s->shown;
    if (p->image.data && s->wanted.transport && !s->failed) {
        if (exchange_same_eye(&p->of, &s->wanted))
            fit = p->serial != s->serial          ? EXCHANGE_OLDER
                  : p->step == EXCHANGE_STEP_FINE ? EXCHANGE_FINE
                                                  : EXCHANGE_ROUGH;
        else if (e->drawer.source.scene)
            fit = EXCHANGE_ELSEWHERE;
    }
    pthread_mutex_unlock(&e->lock);
    *image = fit ? &s->shown.image : NULL;
    return fit;
}

bool exchanger_is_busy(struct exchanger *e)
{
    bool busy = false;
    pthread_mutex_lock(&e->lock);
    for (int i = 0; i < EXCHANGER_SLOTS; i++)
        busy |= slot_is_busy(e, i);
    pthread_mutex_unlock(&e->lock);
    return busy;
}

bool exchanger_has_news(struct exchanger *e)
{
    pthread_mutex_lock(&e->lock);
    bool news = e->spoken < e->sentences;
    for (int i = 0; i < EXCHANGER_SLOTS; i++)
        news |= e->slot[i].made.image.data != NULL;
    pthread_mutex_unlock(&e->lock);
    return news;
}

// With the lock: until there is news, or for a while.
static void wait_a_while(struct exchanger *e)
{
    enum { WHILE_NS = 50000000, SECOND_NS = 1000000000 };
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += WHILE_NS;
    until.tv_sec += until.tv_nsec / SECOND_NS;
    until.tv_nsec %= SECOND_NS;
    (void)pthread_cond_timedwait(&e->news, &e->lock, &until);
}

relume_status exchanger_wait(struct exchanger *e)
{
    const struct relume_log *log = e->to;
    bool goes_on = true;
    pthread_mutex_lock(&e->lock);
    while (goes_on && (slot_is_busy(e, 0) || slot_is_busy(e, 1))) {
        wait_a_while(e);
        pthread_mutex_unlock(&e->lock);
        goes_on = !log || !log->progress ||
                  log->progress(log->user, "light between objects and scene",
                                atomic_load(&e->percent) / 100.0);
        pthread_mutex_lock(&e->lock);
    }
    pthread_mutex_unlock(&e->lock);
    if (!goes_on)
        exchanger_rest(e);
    return goes_on ? RELUME_OK : RELUME_ECANCEL;
}

void exchanger_rest(struct exchanger *e)
{
    pthread_mutex_lock(&e->lock);
    e->rests = true;
    atomic_store(&e->cancel, true);
    while (e->working >= 0)
        pthread_cond_wait(&e->news, &e->lock);
    for (int i = 0; i < EXCHANGER_SLOTS; i++) {
        picture_forget(&e->slot[i].made);
        picture_forget(&e->slot[i].shown);
        exchange_request_forget(&e->slot[i].wanted);
    }
    pthread_mutex_unlock(&e->lock);
}

// ---------------------------------------------------------------- saying

void exchanger_state(struct exchange_state *out, struct exchanger *e, int slot)
{
    const struct slot *s = &e->slot[slot];
    pthread_mutex_lock(&e->lock);
    *out = (struct exchange_state){.works = slot_is_busy(e, slot),
                                   .width = s->shown.image.width,
                                   .height = s->shown.image.height,
                                   .seconds = s->shown.seconds,
                                   .status = s->failed};
    if (e->working == slot)
        out->done = atomic_load(&e->percent) / 100.0;
    pthread_mutex_unlock(&e->lock);
}

void exchanger_speak(struct exchanger *e)
{
    const struct relume_log *log = e->to;
    pthread_mutex_lock(&e->lock);
    while (e->spoken < e->sentences) {
        const struct sentence s = e->sentence[e->spoken++];
        pthread_mutex_unlock(&e->lock);
        if (log && log->message)
            log->message(log->user, s.level, s.words);
        pthread_mutex_lock(&e->lock);
    }
    pthread_mutex_unlock(&e->lock);
}
