// fuzz_shoot.c - what comes with photographs, made of noise: lights of domes, camera responses,
// COLMAP's poses, and photographs with EXIF
#include "fuzz.h"

#include "capture/views_colmap.h"
#include "made_exif.h"

#include <relume/lights.h>
#include <relume/photograph.h>
#include <relume/response.h>

static const char *const words[] = {"lightConfiguration",
                                    "directional",
                                    "spherical",
                                    "lights3d",
                                    "positionsSphere",
                                    "positions3d",
                                    "directions",
                                    "ledAdjust",
                                    "imageWidth",
                                    "relume-response",
                                    "PINHOLE",
                                    "OPENCV",
                                    "RADIAL",
                                    "SIMPLE_RADIAL",
                                    "Exif",
                                    "1e308",
                                    "-0",
                                    "nan",
                                    "inf",
                                    "{",
                                    "}",
                                    "[",
                                    "]",
                                    "\n",
                                    "#",
                                    " ",
                                    "\f",
                                    NULL};
static const char *const parts[] = {"cameras.txt", "images.txt", "points3D.txt"};

static bool try_lights(const char *path)
{
    bool read = false;
    for (int positions = 0; positions < 2; positions++) {
        struct relume_light_list list;
        const relume_status status = relume_lights_load(&list, path, positions, NULL);
        if (!status && list.count < 1)
            abort();
        read |= !status;
        relume_light_list_destroy(&list);
    }
    return read;
}

// Never falling, never negative: what everybody who decodes by it relies on.
static bool try_response(const char *path)
{
    struct relume_response r;
    if (relume_response_load(&r, path, NULL))
        return false;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < RELUME_CODES; i++)
            if (!(r.exposure[c][i] >= (i ? r.exposure[c][i - 1] : 0.0f)))
                abort();
    return true;
}

// The three files of a model, apart by form feeds.
static bool try_poses(const struct fuzz *f, struct bytes b)
{
    size_t at = 0;
    for (int i = 0; i < 3; i++) {
        char path[128];
        size_t end = at;
        while (end < b.size && b.data[end] != '\f')
            end++;
        snprintf(path, sizeof path, "%s/%s", f->folder, parts[i]);
        fuzz_store(path, (struct bytes){b.data + at, end - at});
        at = end < b.size ? end + 1 : end;
    }
    struct posed_model model;
    if (posed_model_read(&model, f->folder, NULL))
        return false;
    for (int i = 0; i < model.count; i++) {
        double xy[2];
        posed_project(xy, &model.camera[i], (struct relume_vec3){0.1, -0.2, 1.0});
    }
    posed_model_free(&model);
    return true;
}

static bool try_photograph(const char *path)
{
    static const struct relume_limits small = {.max_side = 256, .max_pixels = 1 << 14};
    struct relume_image image;
    struct relume_notes notes;
    if (relume_photograph_load(&image, &notes, path, relume_photograph_params(.limits = &small)))
        return false;
    if (notes.orientation < 1 || notes.orientation > 8 || image.width != notes.width)
        abort();
    relume_image_destroy(&image);
    return true;
}

static bool one(struct fuzz *f, struct bytes b)
{
    fuzz_store(f->path, b);
    if (b.data[0] == 0xff)
        return try_photograph(f->path);
    if (memchr(b.data, '\f', b.size))
        return try_poses(f, b);
    return b.data[0] == 'r' ? try_response(f->path) : try_lights(f->path);
}

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

static struct bytes response_seed(const char *folder)
{
    char path[128];
    struct relume_response r;
    snprintf(path, sizeof path, "%s/response", folder);
    relume_response_of(&r, (struct relume_transfer){.curve = RELUME_CURVE_SRGB});
    if (relume_response_save(&r, path, NULL))
        abort();
    return fuzz_load(path);
}

static struct bytes photograph_seed(const char *folder)
{
    char path[128];
    struct relume_image image;
    struct exif_bytes exif;
    snprintf(path, sizeof path, "%s/photo.jpg", folder);
    if (relume_image_create(&image, 16, 8, 3))
        abort();
    for (int i = 0; i < 3 * 16 * 8; i++)
        image.data[i] = (float)(i % 7) / 7.0f;
    if (relume_image_save(&image, path, NULL))
        abort();
    relume_image_destroy(&image);
    exif_make(&exif, 6);
    exif_insert(path, 0xe1, &exif);
    return fuzz_load(path);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_shoot", argc, argv);
    fuzz_add(&f,
             text("{\"imageWidth\":200,\"lightConfiguration\":\"spherical\",\"positionsSphere\":"
                  "[{\"x\":0,\"y\":0,\"z\":150},{\"x\":90,\"y\":0,\"z\":120}],\"ledAdjust\":"
                  "[{\"r\":1,\"g\":1,\"b\":1},{\"r\":2,\"g\":1,\"b\":0.5}]}"));
    fuzz_add(&f, text("{\"lightConfiguration\":\"directional\",\"directions\":[[0,0,1],[1,0,1]]}"));
    fuzz_add(&f, text("2\na.jpg 0 0 1\nb.jpg 1,0,2 # b\n"));
    fuzz_add(&f, text("1 PINHOLE 64 48 70 70 32 24\n2 OPENCV 64 48 70 70 32 24 .1 0 .01 0\n\f"
                      "# id q t camera name\n1 1 0 0 0 0 0 3 1 a b.jpg\n3 4 7 5 6 -1\n"
                      "2 .7 0 .7 0 1 0 3 2 c.jpg\n\n\f1 0.5 0.5 1 9 9 9 0.1 1 0\n"));
    fuzz_add(&f, response_seed(f.folder));
    fuzz_add(&f, photograph_seed(f.folder));
    return fuzz_run(&f, argc, argv, one);
}
