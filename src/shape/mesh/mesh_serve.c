// mesh_serve.c - in the helper: one model, read by Assimp for the process that sent it. Files
// beside the model - buffers of glTF, materials - are asked for by name.
#include "shape/mesh/mesh_serve.h"

#include "core/base/channel.h"
#include "core/base/memory.h"
#include "core/base/sandbox.h"
#include "shape/mesh/mesh_bridge.h"

#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

struct serving {
    int channel, file;
    struct mesh_ask ask;
    struct mesh_file model;
};

// The model's own file, or one beside it; -1: there is none.
static int open_for_assimp(void *context, const char *name)
{
    struct serving *s = context;
    struct mesh_answer need = {.what = MESH_NEEDS};
    struct mesh_ask reply;
    int file;
    if (!strcmp(name, s->ask.name))
        return dup(s->file);
    if (strlen(name) >= sizeof need.text)
        return -1;
    snprintf(need.text, sizeof need.text, "%s", name);
    if (!channel_send(s->channel, &need, sizeof need, -1) ||
        !channel_receive(s->channel, &reply, sizeof reply, &file))
        _exit(0);
    return file;
}

static size_t names_bytes(const struct mesh_file *m)
{
    size_t bytes = 0;
    for (int i = 0; i < m->parts; i++)
        bytes += strlen(m->part[i]) + 1;
    for (int i = 0; i < m->picture_count; i++)
        bytes += strlen(m->pictures[i].name) + 1;
    return bytes;
}

static size_t picture_bytes(const struct mesh_file *m)
{
    size_t bytes = 0;
    for (int i = 0; i < m->picture_count; i++)
        bytes += m->pictures[i].size;
    return bytes;
}

static struct mesh_answer answer_of(const struct mesh_file *m)
{
    return (struct mesh_answer){.what = MESH_READ,
                                .has_uv = m->has_uv,
                                .made_normals = m->made_normals,
                                .has_colours = m->colour != NULL,
                                .vertices = m->mesh.vertex_count,
                                .triangles = m->mesh.triangle_count,
                                .parts = (uint64_t)m->parts,
                                .pictures = (uint64_t)m->picture_count,
                                .names_bytes = names_bytes(m),
                                .picture_bytes = picture_bytes(m)};
}

size_t mesh_answer_bytes(const struct mesh_answer *a)
{
    const uint64_t bound = UINT32_MAX, few = 1 << 16;
    if (a->vertices > bound || a->triangles > bound || a->parts > few || a->pictures > few ||
        a->names_bytes > 1 << 20 || a->picture_bytes > bound)
        return 0;
    return (size_t)(a->vertices * (sizeof(struct vertex) + (a->has_colours ? 4 : 0)) +
                    a->triangles * sizeof(struct triangle) + a->pictures * sizeof(uint64_t) +
                    a->parts * sizeof(struct mesh_look) + a->names_bytes + a->picture_bytes);
}

double mesh_read_s(uint64_t file_bytes)
{
    enum { SECONDS = 20, BYTES_A_SECOND = 1 << 19 };
    return SECONDS + (double)file_bytes / BYTES_A_SECOND;
}

// Assimp holds texts many times their size, and a vertex as two hundred bytes.
static enum helper_short enter_sandbox(const struct mesh_ask *ask)
{
    static const uint64_t always = 512 << 20;
    enum { TIMES = 256 };
    const uint64_t fit = always + TIMES * ask->file_bytes;
    const bool limited = ask->max_memory < fit;
    const bool fits = sandbox_memory(limited ? ask->max_memory : fit);
    sandbox_time(mesh_read_s(ask->file_bytes));
    sandbox_close();
    return !fits ? HELPER_SHORT_MACHINE : limited ? HELPER_SHORT_LIMIT : HELPER_SHORT_FILE;
}

static bool read_model(struct serving *s, const struct assimp_bridge *bridge)
{
    struct mesh_answer answer = {.what = MESH_FAILED};
    const struct mesh_source source = {s->ask.name, open_for_assimp, s};
    answer.memory = (int)enter_sandbox(&s->ask);
    if (bridge->read(&s->model, &source, answer.text))
        answer = answer_of(&s->model);
    return channel_send(s->channel, &answer, sizeof answer, -1);
}

static char *put(char *to, const void *from, size_t size)
{
    if (size)
        memcpy(to, from, size);
    return to + size;
}

static char *put_parts(char *to, const struct mesh_file *m)
{
    for (int i = 0; i < m->picture_count; i++) {
        const uint64_t size = m->pictures[i].size;
        to = put(to, &size, sizeof size);
    }
    to = put(to, m->look, (size_t)m->parts * sizeof *m->look);
    for (int i = 0; i < m->parts; i++)
        to = put(to, m->part[i], strlen(m->part[i]) + 1);
    for (int i = 0; i < m->picture_count; i++)
        to = put(to, m->pictures[i].name, strlen(m->pictures[i].name) + 1);
    for (int i = 0; i < m->picture_count; i++)
        to = put(to, m->pictures[i].bytes, m->pictures[i].size);
    return to;
}

static bool hand_over(struct serving *s, int memory)
{
    const struct mesh_file *m = &s->model;
    const struct mesh_answer answer = answer_of(m);
    const size_t vertices = m->mesh.vertex_count * sizeof *m->mesh.vertices;
    const size_t triangles = m->mesh.triangle_count * sizeof *m->mesh.triangles;
    const size_t all = mesh_answer_bytes(&answer);
    char *const map = channel_map(memory, all);
    if (!map)
        return false;
    char *to = put(put(map, m->mesh.vertices, vertices), m->mesh.triangles, triangles);
    if (m->colour)
        to = put(to, m->colour, m->mesh.vertex_count * sizeof *m->colour);
    put_parts(to, m);
    munmap(map, all);
    return channel_send(s->channel, &answer, sizeof answer, -1);
}

void mesh_serve(int channel, const void *bridge)
{
    struct mesh_ask take;
    int memory;
    struct serving *s = mem_zeroed(1, sizeof *s);
    if (!s)
        return;
    s->channel = channel;
    if (channel_receive(channel, &s->ask, sizeof s->ask, &s->file) && read_model(s, bridge) &&
        channel_receive(channel, &take, sizeof take, &memory))
        (void)hand_over(s, memory);
}
