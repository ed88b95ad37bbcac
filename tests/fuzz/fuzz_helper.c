// fuzz_helper.c - a helper that a hostile file has taken over: its answers, and what it puts into
// shared memory, are noise. Pictures and models that are accepted must be sound all the same.
#define FUZZ_HELPER
#include "fuzz_look.h"

#include "core/base/channel.h"
#include "core/base/context.h"
#include "image/image/picture_serve.h"
#include "shape/mesh/mesh.h"
#include "shape/mesh/mesh_serve.h"

#include <relume/image/photograph.h>
#include <sys/mman.h>

static const char *const words[] = {"a.bin", "../", "/", "part", "\x80\x3f", "\xc0\x7f", NULL};
static struct bytes said;  // what the helper has still to say

static size_t take(void *out, size_t size)
{
    const size_t n = size < said.size ? size : said.size;
    memcpy(out, said.data, n);
    said.data += n;
    said.size -= n;
    return n;
}

// ---------------------------------------------------------------- in place of core/base/helper.c

relume_status helper_start(struct helper_job *job, enum helper_kind kind, const char *path,
                           const struct relume_log *log)
{
    (void)kind, (void)path, (void)log;
    *job = (struct helper_job){0};
    return RELUME_OK;
}

// Files are not looked at; memory is filled.
relume_status helper_ask(struct helper_job *job, const void *message, size_t size, int file,
                         void *answer, size_t answer_size)
{
    const off_t bytes = file < 0 ? 0 : lseek(file, 0, SEEK_END);
    void *map = bytes > 0 ? channel_map(file, (size_t)bytes) : NULL;
    (void)message, (void)size;
    if (map) {
        take(map, (size_t)bytes);
        munmap(map, (size_t)bytes);
    }
    if (!said.size) {
        snprintf(job->why, sizeof job->why, "no answer");
        return RELUME_EDAMAGED;
    }
    memset(answer, 0, answer_size);
    take(answer, answer_size);
    return RELUME_OK;
}

void helper_end(struct helper_job *job)
{
    *job = (struct helper_job){0};
}

// ---------------------------------------------------------------- what reads its answers

static const struct relume_limits small = {
    .max_side = 256, .max_pixels = 1 << 14, .max_memory = 64 << 20};

static bool try_picture(const struct fuzz *f)
{
    char path[128];
    struct relume_image image;
    struct relume_exif notes;
    snprintf(path, sizeof path, "%s/picture.hdr", f->folder);
    if (relume_photograph_load(&image, &notes, path, relume_photograph_params(.limits = &small)))
        return false;
    if (notes.orientation < 1 || notes.orientation > 8 || image.width != notes.width ||
        image.height != notes.height)
        abort();
    for (int i = 0; i < image.width * image.height * image.channels; i++)
        if (!isfinite(image.data[i]))
            abort();
    if (!isfinite(relume_exif_exposure(&notes)))
        abort();
    relume_image_destroy(&image);
    return true;
}

static bool try_model(const struct fuzz *f)
{
    struct relume_context context = {.limits = &small};
    const struct relume_log log = {.context = &context};
    char path[128], material[128];
    const char *materials[1] = {material};
    relume_objects *o;
    snprintf(path, sizeof path, "%s/model.gltf", f->folder);
    snprintf(material, sizeof material, "%s/btf", f->folder);
    const bool read = !relume_objects_of_mesh(&o, path, materials, 1, 1.0,
                                              relume_objects_params(.log = &log, .limits = &small));
    if (read)
        look(o);
    relume_objects_destroy(&o);
    return read;
}

static bool one(struct fuzz *f, struct bytes b)
{
    fuzz_store(f->path, b);
    said = (struct bytes){b.data + 1, b.size - 1};
    return b.data[0] % 2 ? try_model(f) : try_picture(f);
}

// ---------------------------------------------------------------- what a sound helper says

static void say(struct bytes *to, const void *what, size_t size)
{
    to->data = realloc(to->data, to->size + size);
    if (!to->data)
        abort();
    memcpy(to->data + to->size, what, size);
    to->size += size;
}

static struct bytes picture_seed(bool bytes)
{
    const float band[3 * 4 * 3] = {0, 0.25f, 0.5f, 0.75f, 1};
    const struct picture_answer fine = {.status = RELUME_OK};
    const struct picture_answer open = {
        .info = {4, 3, 0, 0, 3, {0, 1, 2}, .bytes = bytes, .floats = !bytes, .linear = !bytes},
        .notes = {.orientation = 6, .time_s = 0.01, .camera = "made"}};
    struct bytes b = {0};
    say(&b, "p", 1);
    say(&b, &open, sizeof open);
    say(&b, band, bytes ? sizeof band / sizeof *band : sizeof band);
    for (int i = 0; i < 4; i++)
        say(&b, &fine, sizeof fine);
    return b;
}

static struct bytes model_seed(void)
{
    const struct vertex vertices[3] = {{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}},
                                       {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}},
                                       {{0, 1, 0}, {0, 0, 1}, {0, 1, 0}}};
    const struct triangle triangle = {{0, 1, 2}, 0};
    const struct mesh_answer needs = {.what = MESH_NEEDS, .text = "a.bin"};
    const struct mesh_answer read = {.what = MESH_READ,
                                     .has_uv = true,
                                     .vertices = 3,
                                     .triangles = 1,
                                     .parts = 1,
                                     .names_bytes = 5};
    struct bytes b = {0};
    say(&b, "m", 1);
    say(&b, &needs, sizeof needs);
    say(&b, &read, sizeof read);
    say(&b, vertices, sizeof vertices);
    say(&b, &triangle, sizeof triangle);
    say(&b, &mesh_look_none, sizeof mesh_look_none);
    say(&b, "part", 5);
    say(&b, &read, sizeof read);
    return b;
}

int main(int argc, char **argv)
{
    static const char radiance[] = "#?RADIANCE\n", gltf[] = "{\"asset\":{\"version\":\"2.0\"}}";
    struct fuzz f = {.words = words};
    char path[128];
    fuzz_begin(&f, "fuzz_helper", argc, argv);
    make_material(&f);
    snprintf(path, sizeof path, "%s/picture.hdr", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)radiance, sizeof radiance - 1});
    snprintf(path, sizeof path, "%s/model.gltf", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)gltf, sizeof gltf - 1});
    fuzz_add(&f, picture_seed(true));
    fuzz_add(&f, picture_seed(false));
    fuzz_add(&f, model_seed());
    return fuzz_run(&f, argc, argv, one);
}
