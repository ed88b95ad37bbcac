// av1_encode.c - groups of sequences, coded in a process of the helper or in this one
//
// libaom can crash. In a process of its own it takes nothing else with it. Where there is no helper
// program, or it cannot be started, libaom runs here.
#include "core/base/channel.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/lossy/av1_serve.h"
#include "format/lossy/av1_writer.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// A group that is being coded.
struct group {
    struct av1_bytes *out;  // [members]
    const uint16_t *const *samples;
    const struct av1_shape *shape;
    const struct av1_effort *effort;
    int members, threads;
    const struct relume_log *log;
    size_t picture_samples;
    struct helper_job job;
    uint16_t *memory;  // shared with the process
};

static int halved(const struct av1_shape *shape, int picture)
{
    return shape->halved ? shape->halved[picture] : 0;
}

static const uint16_t *samples_of(const struct group *g, int picture, int member)
{
    return g->samples[member] + (size_t)picture * g->picture_samples;
}

static relume_status fail(const struct group *g, relume_status status, const char *why)
{
    return status == RELUME_ESYSTEM ? log_fail(g->log, status, "libaom: %s", why) : status;
}

// ---------------------------------------------------------------- in this process

static relume_status add_pictures(const struct group *g, av1_writer *w)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < g->shape->pictures; i++)
        for (int m = 0; !status && m < g->members; m++)
            status = av1_writer_add(w, samples_of(g, i, m), i, m, halved(g->shape, i));
    return status;
}

static relume_status encode_here(struct group *g)
{
    av1_writer *w;
    relume_status status = av1_writer_open(&w, g->shape, g->members, g->effort, g->threads);
    if (!status)
        status = add_pictures(g, w);
    for (int m = 0; !status && m < g->members; m++) {
        g->out[m] = *av1_writer_bytes(w, m);
        *av1_writer_bytes(w, m) = (struct av1_bytes){0};
    }
    status = fail(g, status, av1_writer_error(w));
    av1_writer_destroy(&w);
    return status;
}

// ---------------------------------------------------------------- in a process of the helper

// The slowest preset codes a thousand samples in a hundredth of a second.
static const double FIRST_S = 60.0, S_PER_SAMPLE = 1e-3;

static relume_status ask(struct group *g, struct av1_answer *answer, const struct av1_ask *what,
                         int file)
{
    if (helper_ask(&g->job, what, sizeof *what, file, answer, sizeof *answer))
        return log_fail(g->log, RELUME_ECODER, "libaom, the lossy coder, %s", g->job.why);
    answer->why[HELPER_WHY - 1] = '\0';
    const bool known = answer->status == RELUME_OK || answer->status == RELUME_ENOMEM;
    return known ? (relume_status)answer->status : fail(g, RELUME_ESYSTEM, answer->why);
}

static relume_status send_pictures(struct group *g)
{
    struct av1_answer answer;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < g->shape->pictures; i++)
        for (int m = 0; !status && m < g->members; m++) {
            const struct av1_ask what = {
                .what = AV1_PICTURE, .picture = i, .member = m, .halved = halved(g->shape, i)};
            memcpy(g->memory, samples_of(g, i, m), g->picture_samples * sizeof *g->memory);
            g->job.processor_s += S_PER_SAMPLE * (double)g->picture_samples;
            status = ask(g, &answer, &what, -1);
        }
    return status;
}

static relume_status take_bytes(struct group *g, int member)
{
    const size_t most = av1_shared_bytes(g->shape);
    struct av1_bytes *out = &g->out[member];
    struct av1_answer answer;
    relume_status status = RELUME_OK;
    do {
        const struct av1_ask what = {.what = AV1_TAKE, .member = member, .offset = out->size};
        status = ask(g, &answer, &what, -1);
        if (!status && !out->byte) {
            out->capacity = answer.bytes;
            out->byte = mem_array(out->capacity, 1);
        }
        if (!status && !out->byte)
            status = RELUME_ENOMEM;
        if (!status) {
            const size_t left = out->capacity - out->size, n = left < most ? left : most;
            memcpy(out->byte + out->size, g->memory, n);
            out->size += n;
        }
    } while (!status && out->size < out->capacity);
    return status;
}

static relume_status encode_by(struct group *g, int memory)
{
    const struct av1_shape *s = g->shape;
    const struct av1_ask first = {.what = AV1_BEGIN,
                                  .width = s->width,
                                  .height = s->height,
                                  .components = s->components,
                                  .pictures = s->pictures,
                                  .members = g->members,
                                  .quantiser = g->effort->quantiser,
                                  .preset = (int)g->effort->preset,
                                  .threads = g->threads};
    const struct av1_ask last = {.what = AV1_END};
    struct av1_answer answer;
    relume_status status = ask(g, &answer, &first, memory);
    if (!status)
        status = send_pictures(g);
    for (int m = 0; !status && m < g->members; m++)
        status = take_bytes(g, m);
    if (status != RELUME_ECODER)
        (void)helper_ask(&g->job, &last, sizeof last, -1, &answer, sizeof answer);
    return status;
}

static relume_status encode_elsewhere(struct group *g)
{
    const size_t size = av1_shared_bytes(g->shape);
    const int memory = channel_memory(size);
    void *map = memory < 0 ? NULL : channel_map(memory, size);
    g->memory = map;
    g->job.processor_s = FIRST_S;
    const relume_status status = map ? encode_by(g, memory) : RELUME_ENOMEM;
    if (map)
        munmap(map, size);
    if (memory >= 0)
        close(memory);
    return status;
}

// ---------------------------------------------------------------- either

relume_status av1_encode(struct av1_bytes *out, const uint16_t *const *samples, int members,
                         const struct av1_shape *shape, const struct av1_effort *effort,
                         int threads, const struct relume_log *log)
{
    struct group g = {.out = out,
                      .samples = samples,
                      .shape = shape,
                      .effort = effort,
                      .members = members,
                      .threads = threads,
                      .log = log,
                      .picture_samples = av1_shared_bytes(shape) / sizeof(uint16_t)};
    memset(out, 0, (size_t)members * sizeof *out);
    const bool helped = !helper_start(&g.job, HELPER_AV1, "", NULL);
    const relume_status status = helped ? encode_elsewhere(&g) : encode_here(&g);
    helper_end(&g.job);
    for (int m = 0; status && m < members; m++) {
        mem_free(out[m].byte);
        out[m] = (struct av1_bytes){0};
    }
    return status;
}
