// fuzz_scene.c - scene files made of noise, which name a slab, a planar file and a mesh that are
// good; what is accepted is drawn, where every value must be finite
#include "world/tableau/which.h"

#include "fuzz.h"

#include <math.h>
#include <relume/exchange.h>

static const char *const words[] = {
    "format",   "version",  "relume-scene", "captures",    "objects",    "lights",
    "eye",      "look_at",  "up",           "fov",         "size",       "file",
    "name",     "pose",     "instead_of",   "translate",   "rotate",     "scale",
    "flat.exr", "slab.exr", "good.obj",     "mesh",        "parts",      "material",
    "diffuse",  "mirror",   "dir 0 1 1",    "point 0 0 2", "area 0 0 2", "1e308",
    "-0",       "1e-300",   "input.json",   "[",           "]",          "{",
    "}",        ",",        "null",         NULL};

// A light of every kind that needs no file.
static const struct relume_light lights[] = {
    {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}},
    {.kind = RELUME_LIGHT_POINT, .position = {0.1, 0.2, 2}, .rgb = {1, 1, 1}},
    {.kind = RELUME_LIGHT_AREA,
     .position = {0, 0, 2},
     .u = {0.2, 0, 0},
     .v = {0, -0.2, 0},
     .rgb = {1, 1, 1}},
};

static void look(relume_tableau *t)
{
    const struct relume_camera small = {.width = 6, .height = 5};
    struct relume_image image, which;
    mem_fail_after(0);
    const relume_status status =
        relume_tableau_frame(&image, t, &small, lights, 3, relume_render_params(.threads = 1));
    if (status && image.data)
        abort();
    for (int i = 0; !status && i < 6 * 5 * 3; i++)
        if (!isfinite(image.data[i]))
            abort();
    relume_image_destroy(&image);
    if (!status && relume_tableau_which(&which, t, &small))
        abort();
    if (!status)
        relume_image_destroy(&which);
}

static bool one(struct fuzz *f, struct bytes b)
{
    char path[128];
    relume_tableau *t;
    snprintf(path, sizeof path, "%s/input.json", f->folder);
    fuzz_store(path, b);
    (void)relume_kind_of(path);
    const relume_status status = relume_tableau_open(&t, path, relume_tableau_params(.threads = 1));
    if (!status)
        look(t);
    relume_tableau_destroy(&t);
    return !status;
}

static void make(struct fuzz *f, const struct fixture *fixture, const char *name)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    fixture_write(fixture, f->folder);
    fixture_must(fixture_encode(f->folder, path, &relume_basis_table, 0, NULL), path);
}

int main(int argc, char **argv)
{
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 .5\nf 1 2 3\nf 2 4 3\n";
    struct fuzz f = {.words = words};
    char path[128];
    fuzz_begin(&f, "fuzz_scene", argc, argv);
    make(&f, &(struct fixture){.width = 4, .height = 3, .lights = 4, .views = 1}, "flat.exr");
    make(&f, &(struct fixture){.width = 4, .height = 3, .lights = 4, .views = 2, .depth = true},
         "slab.exr");
    snprintf(path, sizeof path, "%s/good.obj", f.folder);
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)obj, sizeof obj - 1});
    fuzz_add_text(
        &f, "{\"format\":\"relume-scene\",\"version\":1,\"captures\":[{\"file\":\"flat.exr\"},"
            "{\"file\":\"slab.exr\",\"name\":\"s\",\"instead_of\":\"o\",\"pose\":{\"translate\":"
            "[1,2,3],\"rotate\":[0,1,0,30],\"scale\":2}}],\"objects\":[{\"mesh\":\"good.obj\","
            "\"name\":\"o\",\"parts\":[{\"material\":{\"diffuse\":0.5}}]}],\"lights\":"
            "[\"dir 0 1 1\",\"point 0 0 2 rgb 1 1 1\"],\"eye\":[0,0,4],\"look_at\":[0,0,0],\"up\":"
            "[0,1,0],\"fov\":50,\"size\":[8,6]}");
    fuzz_add_text(
        &f, "{\"format\":\"relume-scene\",\"version\":1,\"captures\":[{\"file\":\"slab.exr\"}]}");
    fuzz_add_text(&f,
                  "{\"format\":\"relume-scene\",\"version\":1,\"objects\":[{\"mesh\":\"good.obj\","
                  "\"parts\":[{\"material\":{\"mirror\":1}}]}]}");
    return fuzz_run(&f, argc, argv, one);
}
