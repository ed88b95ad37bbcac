// fuzz_baked.c - baked objects made of noise, alone or among others; what is accepted is rendered,
// where every value must be finite
#include "fuzz_look.h"

#include "core/base/arena.h"
#include "image/image/exr.h"

#include <relume/world/bake.h>

// Seeds have parts of a few hundred values.
static const struct relume_limits limits = {
    .max_side = 4096, .max_pixels = 1 << 14, .max_lights = 256};

static const char *const words[] = {"bakedVersion", "basis",       "fixed",      "haar",
                                    "sh",           "h-basis",     "table",      "coefficients",
                                    "kept",         "viewSide",    "clusters",   "components",
                                    "perView",      "bounces",     "triangles",  "compressionError",
                                    "atlas",        "weights",     "frames",     "components",
                                    "mesh",         "places",      "dataWindow", "lightDirections",
                                    "chunkCount",   "compression", "channels",   NULL};

// The first byte says whether it stands among others.
static bool one(struct fuzz *f, struct bytes b)
{
    char path[128];
    relume_objects *o;
    snprintf(path, sizeof path, "%s/input.exr", f->folder);
    fuzz_store(path, (struct bytes){b.data + 1, b.size - 1});
    if (b.data[0] % 2)
        snprintf(path, sizeof path, "%s/objects.json", f->folder);
    const relume_status status =
        relume_objects_open(&o, path, relume_objects_params(.limits = &limits, .threads = 1));
    if (!status)
        look(o);
    relume_objects_destroy(&o);
    return !status;
}

// ---------------------------------------------------------------- seeds

static relume_status copy_rows(void *context, int row, int rows, void *samples)
{
    const struct exr_part *p = context;
    const size_t bytes = (size_t)p->width * (size_t)p->channels * exr_sample_bytes(p->sample);
    exr_blocks *blocks;
    const void *from;
    if (exr_blocks_open(&blocks, p->from, p->from_part))
        abort();
    for (int y = 0; y < rows; y++) {
        if (exr_blocks_row(blocks, row + y, &from))
            abort();
        memcpy((char *)samples + (size_t)y * bytes, from, bytes);
    }
    exr_blocks_close(&blocks);
    return RELUME_OK;
}

// Without compression, so that noise reaches the values.
static void unpack(const char *to, const char *path)
{
    struct exr_part was[8], part[8];
    struct arena arena = {0};
    exr_file *file;
    if (exr_open(&file, path, NULL, NULL, NULL) || exr_part_count(file) > 8)
        abort();
    const int n = exr_part_count(file);
    for (int k = 0; k < n; k++) {
        if (exr_part_again(&was[k], file, k, &arena))
            abort();
        part[k] = was[k];
        part[k].from = NULL;
        part[k].codec = EXR_CODEC_NONE;
        part[k].rows = copy_rows;
        part[k].context = &was[k];
    }
    if (exr_write(to, NULL, part, n, false, 1, NULL))
        abort();
    exr_close(&file);
    arena_free(&arena);
}

static void add(struct fuzz *f, uint8_t first, const char *path)
{
    const struct bytes file = fuzz_load(path);
    struct bytes b = {malloc(file.size + 1), file.size + 1};
    if (!b.data)
        abort();
    b.data[0] = first;
    memcpy(b.data + 1, file.data, file.size);
    free(file.data);
    fuzz_add(f, b);
}

static void bake(struct fuzz *f, const char *material, const struct relume_bake_params *params)
{
    char description[128], whole[128], plain[128], text[512];
    relume_objects *o;
    relume_baked *b;
    snprintf(description, sizeof description, "%s/made.json", f->folder);
    snprintf(whole, sizeof whole, "%s/whole.exr", f->folder);
    snprintf(plain, sizeof plain, "%s/plain.exr", f->folder);
    const int n = snprintf(text, sizeof text,
                           "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":"
                           "\"made.obj\",\"parts\":[{\"material\":%s}]}]}",
                           material);
    fuzz_store(description, (struct bytes){(uint8_t *)text, (size_t)n});
    if (relume_objects_open(&o, description, NULL) || relume_bake(&b, o, params) ||
        relume_baked_save(b, whole, NULL))
        abort();
    unpack(plain, whole);
    add(f, 0, plain);
    add(f, 1, plain);
    add(f, 0, whole);
    relume_baked_destroy(&b);
    relume_objects_destroy(&o);
}

int main(int argc, char **argv)
{
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 .5\nvt 0 0\nvt 1 0\nvt 0 1\n"
                              "vt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 4/4/1 3/3/1\n";
    static const char among[] =
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"baked\":\"input.exr\","
        "\"pose\":{\"translate\":[0.2,0,0.1],\"rotate\":[0,1,0,30],\"scale\":2}},"
        "{\"mesh\":\"made.obj\",\"parts\":[{\"material\":{\"diffuse\":0.5}}]}]}";
    const struct relume_light light = {.direction = {0, 0.6, 0.8}, .rgb = {1, 1, 1}};
    struct fuzz f = {.words = words};
    char path[128];
    fuzz_begin(&f, "fuzz_baked", argc, argv);
    make_material(&f);
    snprintf(path, sizeof path, "%s/made.obj", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)obj, sizeof obj - 1});
    snprintf(path, sizeof path, "%s/objects.json", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)among, sizeof among - 1});
    bake(&f, "{\"diffuse\":0.5}",
         relume_bake_params(.threads = 1, .width = 8, .coefficients = 4, .clusters = 2,
                            .components = 2, .rays = 4));
    bake(&f, "\"btf\"",
         relume_bake_params(.threads = 1, .width = 8, .coefficients = 4, .side = 3, .clusters = 2,
                            .components = 1, .rays = 4));
    bake(&f, "\"btf\"",
         relume_bake_params(.threads = 1, .width = 8, .fixed = &light, .fixed_count = 1, .side = 2,
                            .per_view = true, .clusters = 2, .components = 1, .rays = 4));
    bake(&f, "{\"diffuse\":0.5}",
         relume_bake_params(.threads = 1, .width = 8, .cube = 2, .kept = 2, .clusters = 2,
                            .components = 1, .rays = 4));
    return fuzz_run(&f, argc, argv, one);
}
