// fuzz_acquire.c - what comes with photographs, made of noise: lights of domes, camera responses,
// COLMAP's poses, exposure times, and names that hold a camera's place
#include "fuzz.h"

#include "capture/manifest/light_names.h"
#include "capture/multiview/views.h"
#include "capture/multiview/views_colmap.h"
#include "cli/commands/capture_times.c"
#include "core/math/vec.h"

#include <relume/image/directions.h>
#include <relume/image/response.h>

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
                                    "{row}",
                                    "{column}",
                                    "{n}",
                                    "{u}",
                                    "{v}",
                                    "*",
                                    "1/60",
                                    "IMG_1.jpg",
                                    "name,x,y,z\n",
                                    "theta;phi;image\n",
                                    "// ",
                                    ",",
                                    ";",
                                    "\t",
                                    "\r",
                                    "\"",
                                    "0,6",
                                    "\xc3\xa9",
                                    "e\xcc\x81",
                                    "\xff\xfe",
                                    "\\",
                                    NULL};
static const char *const parts[] = {"cameras.txt", "images.txt", "points3D.txt"};

// A list that names every photograph once gives each the light of its name.
static void try_pairs(const struct relume_captured_lights *list)
{
    const struct light_names names = {
        .path = "list", .count = list->count, .name = (const char *const *)list->name};
    int *order = calloc((size_t)list->count, sizeof *order), matched;
    if (order && !light_names_pair(order, &matched, &names, names.name, list->count, NULL))
        for (int i = 0; i < list->count; i++)
            if (order[i] < -1 || order[i] >= list->count)
                abort();
    free(order);
}

static bool try_lights(const char *path)
{
    bool read = false;
    for (int positions = 0; positions < 2; positions++) {
        struct relume_captured_lights list;
        const relume_status status = relume_captured_lights_load(&list, path, positions, NULL);
        if (!status && list.count < 1)
            abort();
        for (int i = 0; i < list.count; i++)
            if (!(fabs(vec3_length(list.direction[i]) - 1.0) < 1e-9))
                abort();
        read |= !status;
        if (!status && list.name)
            try_pairs(&list);
        relume_captured_lights_destroy(&list);
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

// What the tool's reader of times needs of the tool.
relume_status refuse(relume_status status, const char *format, ...)
{
    (void)format;
    return status;
}

static bool try_times(const char *path, struct bytes b)
{
    char names[2][16] = {"IMG_1.jpg", "IMG_2.jpg"}, *photos[] = {names[0], names[1]};
    const struct relume_photographs list = {.count = 2, .path = photos};
    struct relume_exif notes[2] = {{.iso = 1.0}};
    fuzz_store(path, (struct bytes){b.data + 1, b.size - 1});
    if (read_times(path, &list, notes, NULL))
        return false;
    for (int i = 0; i < 2; i++)
        if (!(notes[i].time_s > 0.0) || isinf(notes[i].time_s))
            abort();
    return true;
}

// A pattern, or none, and names, line by line.
static bool try_names(struct bytes b)
{
    enum { MOST = 16 };
    char *text = calloc(b.size + 1, 1), *save, *lines = text;
    struct camera_photos camera[MOST];
    struct view_place places[MOST];
    struct photo_set set = {.camera = camera};
    if (!text)
        return false;
    memcpy(text, b.data + 1, b.size - 1);
    const char *pattern = *lines == '\n' ? NULL : strtok_r(lines, "\n", &save);
    for (char *name = strtok_r(pattern ? NULL : lines, "\n", &save); name && set.count < MOST;
         name = strtok_r(NULL, "\n", &save))
        camera[set.count++] = (struct camera_photos){.name = name};
    const bool taken = set.count && !view_places(places, &set, pattern, NULL);
    for (int i = 0; taken && i < set.count; i++)
        if (!isfinite(places[i].u) || !isfinite(places[i].v) || places[i].row < 0)
            abort();
    free(text);
    return taken;
}

static bool one(struct fuzz *f, struct bytes b)
{
    fuzz_store(f->path, b);
    if (b.data[0] == 'n')
        return try_names(b);
    if (b.data[0] == 't')
        return try_times(f->path, b);
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

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_acquire", argc, argv);
    fuzz_add(&f,
             text("{\"imageWidth\":200,\"lightConfiguration\":\"spherical\",\"positionsSphere\":"
                  "[{\"x\":0,\"y\":0,\"z\":150},{\"x\":90,\"y\":0,\"z\":120}],\"ledAdjust\":"
                  "[{\"r\":1,\"g\":1,\"b\":1},{\"r\":2,\"g\":1,\"b\":0.5}]}"));
    fuzz_add(&f, text("{\"lightConfiguration\":\"directional\",\"directions\":[[0,0,1],[1,0,1]]}"));
    fuzz_add(&f, text("2\na.jpg 0 0 1\nb.jpg 1 0 2\n"));
    fuzz_add(&f, text("file;z;y;x\n\"a b.jpg\";0,8;0;0,6\nc.jpg;1;0;0\n"));
    fuzz_add(&f, text("# azimuth elevation\r\ncaf\xc3\xa9.jpg 30 40\r\nx 50 60 // x\r\n"));
    fuzz_add(&f, text("000,0.349,0.899,0.265\n001,-.6,0,.8\n002,0,.6,.8\n"));
    fuzz_add(&f, text("IMG 1.jpg -.6 0 .8 800 left\nIMG 2.jpg 0 .6 .8 800\nb\\c.jpg .8 0 .6 1\n"));
    fuzz_add(&f, (struct bytes){(uint8_t *)memcpy(calloc(1, 32),
                                                  "\xff\xfe"
                                                  "a\0 \0000\0 \0000\0 \0001\0",
                                                  16),
                                16});
    fuzz_add(&f, text("1 PINHOLE 64 48 70 70 32 24\n2 OPENCV 64 48 70 70 32 24 .1 0 .01 0\n\f"
                      "# id q t camera name\n1 1 0 0 0 0 0 3 1 a b.jpg\n3 4 7 5 6 -1\n"
                      "2 .7 0 .7 0 1 0 3 2 c.jpg\n\n\f1 0.5 0.5 1 9 9 9 0.1 1 0\n"));
    fuzz_add(&f, text("nview_{row}_{column}\nview_0_0.png\nview_0_1.png\nview_1_00.png\n"));
    fuzz_add(&f, text("n*{u}*{v}\nat 0.5 -1.25.jpg\nat -3.5 7.125.jpg\n"));
    fuzz_add(&f, text("n\nout_00_01_-381.9_-776.5_.png\nout_01_01_-381.9_2776.5_.png\n"));
    fuzz_add(&f, text("n\nC000.png\nC001.png\nC002.png\nC003.png\n"));
    fuzz_add(&f, text("tIMG_1.jpg 1/60 # remark\nIMG_2.jpg 0.25s\n"));
    fuzz_add(&f, text("t1/60 # a\n\n0.25s\n"));
    fuzz_add(&f, text("tIMG_1.jpg 3\nIMG_1.jpg 1e-3\ndir/IMG_2.jpg,4\n"));
    fuzz_add(&f, response_seed(f.folder));
    return fuzz_run(&f, argc, argv, one);
}
