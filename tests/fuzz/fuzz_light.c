// fuzz_light.c - photometric files, lights in words and rigs made of noise; what is accepted is
// shone on a surface, where every value must be finite
#include "relight/light/environment.h"

#include "fuzz.h"

static const char *const words[] = {
    "dir",  "point",  "spot",  "slide",  "area",   "env",        "ies",     "gonio",
    "rgb",  "nofall", "disc",  "format", "lights", "relume-rig", "version", "light",
    "name", "on",     "solo",  "TILT=",  "NONE",   "INCLUDE",    "IESNA",   "intensity",
    "true", "null",   "1e308", "-0",     "nan",    "inf",        "0",       "-1",
    "90",   "180",    "360",   "4096",   "1e-300", "'",          "\"",      "[",
    "]",    "{",      "}",     ",",      "\n",     "map.exr",    "a.ies",   NULL};

static const struct relume_vec3 axes[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                           {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
static relume_coder *coder;
static float points[4 * 3] = {0, 0, 0, 1, 0, 0, 0.3f, -0.2f, 1, INFINITY, 0, 0};

static void shine(const struct relume_light *lights, int n)
{
    static const uint8_t byte[12][4] = {{200, 3, 5, 7}, {0, 255, 9, 1}};
    static const float scale[12] = {.01f, .01f, .01f, .01f, .01f, .01f}, offset[12] = {0};
    const void *plane[12];
    for (int p = 0; p < 12; p++)
        plane[p] = byte[p];
    const struct relume_codes codes = {.coder = coder,
                                       .domain = RELUME_DOMAIN_LINEAR,
                                       .width = 2,
                                       .height = 2,
                                       .planes = 12,
                                       .storage = RELUME_STORE_8,
                                       .plane = plane,
                                       .scale = scale,
                                       .offset = offset};
    const struct relume_image surface = {2, 2, 3, .data = points};
    static relume_weight_grid *grid;
    mem_fail_after(0);
    if (!grid && relume_weight_grid_create(&grid, coder, relume_weight_grid_params(.steps = 16)))
        abort();
    struct relume_image out = {0};
    if (relume_relight(&out, &codes, lights, n < 20 ? n : 20,
                       relume_relight_params(.surface = &surface, .grid = grid, .threads = 1)))
        abort();  // a rig holds only lights that can be shown
    for (int i = 0; i < 12; i++)
        if (!isfinite(out.data[i]))
            abort();
    relume_image_destroy(&out);
}

static bool light_uniforms_rig(relume_rig *rig)
{
    const struct relume_light *lights;
    int n;
    if (!relume_rig_lights(&lights, &n, rig))
        shine(lights, n);
    return n > 0;
}

static bool as_words(struct fuzz *f, struct bytes b)
{
    relume_rig *rig;
    char *text = strndup((const char *)b.data, b.size);
    bool accepted = false;
    if (!relume_rig_create(&rig)) {
        const char *folder = strchr(text, '/') ? NULL : f->folder;
        accepted = folder && !relume_rig_add(rig, text, folder, NULL);
        mem_fail_after(0);
        if (accepted && relume_rig_add(rig, relume_rig_entry(rig, 0)->spec, NULL, NULL))
            abort();  // what it says of itself is understood
        light_uniforms_rig(rig);
    }
    relume_rig_destroy(&rig);
    free(text);
    return accepted;
}

static bool as_rig(struct fuzz *f, struct bytes b)
{
    relume_rig *rig;
    if (memchr(b.data, '/', b.size))
        return false;
    fuzz_store(f->path, b);
    if (relume_rig_load(&rig, f->path, NULL))
        return false;
    light_uniforms_rig(rig);
    relume_rig_destroy(&rig);
    return true;
}

static bool as_ies(struct fuzz *f, struct bytes b)
{
    relume_ies *ies;
    fuzz_store(f->path, b);
    if (relume_ies_parse(&ies, (const char *)b.data, b.size, "ies", NULL))
        return false;
    for (int v = -10; v < 200; v += 7)
        for (int h = -400; h < 800; h += 33) {
            const double value = relume_ies_value(ies, v, h);
            if (!(value >= 0.0 && value <= 1.000001))
                abort();
        }
    relume_ies_destroy(&ies);
    return true;
}

static bool one(struct fuzz *f, struct bytes b)
{
    if (memmem(b.data, b.size, "TILT", 4))
        return as_ies(f, b);
    return b.data[0] == '{' ? as_rig(f, b) : as_words(f, b);
}

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

int main(int argc, char **argv)
{
    static const char ies[] = "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n5 4\n";
    struct fuzz f = {.words = words};
    char path[128];
    struct relume_image map;
    fuzz_begin(&f, "fuzz_light", argc, argv);
    snprintf(path, sizeof path, "%s/map.exr", f.folder);
    if (relume_image_create(&map, 4, 2, 3) || relume_image_save(&map, path, NULL) ||
        relume_coder_create(&coder, &relume_basis_sh, axes, 6,
                            relume_coder_params(.coefficients = 4, .decode = true)))
        abort();
    relume_image_destroy(&map);
    snprintf(path, sizeof path, "%s/a.ies", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)ies, sizeof ies - 1});
    fuzz_add(&f, text("spot 1 2 3 0 0 -1 25 rgb 1 .5 2 nofall"));
    fuzz_add(&f, text("slide 0 0 2 0 0.5 -1 30 'map.exr'"));
    fuzz_add(&f, text("area 0 0 2 0 1 0 1 0 0 disc rgb 1 1 1"));
    fuzz_add(&f, text("env map.exr 30"));
    fuzz_add(&f, text("ies 0 0 2 0 0 -1 a.ies"));
    fuzz_add(&f, text("point 0 0 0"));
    fuzz_add(&f,
             text("{\"format\":\"relume-rig\",\"version\":1,\"lights\":[{\"light\":\"dir 0 0 1\","
                  "\"rgb\":[1,2,3],\"intensity\":0.5,\"on\":true,\"solo\":false},{\"name\":"
                  "\"key\",\"light\":\"env map.exr\"}]}"));
    fuzz_add(&f, text(ies));
    fuzz_add(&f,
             text("IESNA:LM-63-2002\n[TEST] x\nTILT=INCLUDE\n1 2\n0 90\n1 .5\n2 1000 1 3 3 1 1 0 "
                  "0 0\n1 1 10\n0 45 90\n0 45 90\n9 8 7\n6 5 4\n3 2 1\n"));
    return fuzz_run(&f, argc, argv, one);
}
