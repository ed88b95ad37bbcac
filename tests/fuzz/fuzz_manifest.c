// fuzz_manifest.c - capture.json, .lp files and EXRs of light stages made of noise
#include "fuzz.h"

#include <relume/exchange.h>
#include <relume/image/directions.h>

static const struct relume_limits limits = {
    .max_side = 256, .max_pixels = 1 << 14, .max_lights = 200, .max_views = 16};

static const char *const words[] = {
    "format",     "version",     "transfer",  "projection",  "lights",
    "directions", "intensities", "positions", "window",      "slab",
    "panorama",   "views",       "images",    "depth",       "mask",
    "uv",         "slabs",       "axes",      "origin",      "camera",
    "planar",     "cube",        "gamma:2.2", "v0-0.exr",    "null",
    "[",          "]",           "{",         "}",           ",",
    "1e308",      "-0",          "\"",        "\\u0000",     "\n",
    " ",          "nan",         "chlist",    "light0000.R", "olat.directions",
    "v3f",        NULL};

static bool open_as(struct fuzz *f, const char *name, struct bytes b, bool skip)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    fuzz_store(path, b);
    relume_capture *capture;
    const relume_status status = relume_capture_open(
        &capture, path, relume_capture_params(.limits = &limits, .skip_missing = skip));
    struct relume_image image;
    if (!status) {
        for (int v = 0; v < relume_capture_manifest(capture)->views; v++) {
            if (!relume_capture_image(&image, capture, v, 0, NULL))
                relume_image_destroy(&image);
            if (!relume_capture_depth(&image, capture, v, NULL))
                relume_image_destroy(&image);
            if (!relume_capture_mask(&image, capture, v, NULL))
                relume_image_destroy(&image);
        }
        relume_capture_destroy(&capture);
    }
    struct relume_vec3 *lights;
    int n;
    const bool read = !relume_captured_lights_read(&lights, &n, path, NULL);
    if (read)
        free(lights);
    return read || !status;
}

static bool one(struct fuzz *f, struct bytes b)
{
    const bool json = memchr(b.data, '{', b.size < 4 ? b.size : 4) != NULL;
    const bool exr = b.data[0] == 0x76;
    fuzz_store(f->path, b);
    return open_as(f,
                   exr    ? "stage.exr"
                   : json ? "capture.json"
                          : "lights.lp",
                   b, b.data[b.size - 1] % 2);
}

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

// A layer for each light, of the capture in a folder.
static struct bytes stage(const char *folder)
{
    char path[128];
    relume_pack *pack;
    snprintf(path, sizeof path, "%s/capture.json", folder);
    relume_status status = relume_open(&pack, path, relume_open_params(.threads = 1));
    if (status)
        abort();
    snprintf(path, sizeof path, "%s/stage.exr", folder);
    status = relume_export(pack, path, RELUME_EXCHANGE_OLAT, NULL, NULL);
    relume_pack_destroy(&pack);
    if (status)
        abort();
    return fuzz_load(path);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    const struct fixture plain = {.width = 4, .height = 3, .lights = 5, .views = 1, .mask = true};
    const struct fixture slab = {.width = 4, .height = 3, .lights = 3, .views = 2, .depth = true};
    char path[128];
    fuzz_begin(&f, "fuzz_manifest", argc, argv);
    snprintf(path, sizeof path, "%s/capture.json", f.folder);
    fixture_write(&slab, f.folder);
    fuzz_add(&f, fuzz_load(path));
    fixture_write(&plain, f.folder);
    fuzz_add(&f, fuzz_load(path));
    fixture_write(&(struct fixture){.width = 4, .height = 3, .lights = 2, .views = 4, .slabs = 2},
                  f.folder);
    fuzz_add(&f, fuzz_load(path));
    fixture_write(&plain, f.folder);
    fuzz_add(&f, stage(f.folder));
    fuzz_add(&f, text("3\nv0-0.exr 0 0 1\nv0-1.exr 1 0 1\nv0-2.exr 0 1 1\n"));
    fuzz_add(&f, text("\xef\xbb\xbf"
                      "2\r\nC:\\a b\\V0-0.EXR 0,5 0 1\r\n\r\nv0-1.exr .1 2 3 \r\n"));
    fuzz_add(
        &f,
        text("{\"format\":\"relume-capture\",\"version\":1,\"transfer\":\"gamma:2.2\","
             "\"projection\":\"cylindrical\",\"panorama\":{\"v_min\":-1,\"v_max\":2,"
             "\"center\":[0,1,2],\"discs\":1},\"lights\":{\"positions\":[[1,2,3]],\"intensities\":"
             "[[1,2,0.5]]},\"views\":[{\"images\":[\"v0-0.exr\"],\"depth\":null}]}"));
    fuzz_add(&f, text("# directions\n0 0 1\n1, 0, 0.5\n\n0 1 0 # last\n"));
    return fuzz_run(&f, argc, argv, one);
}
