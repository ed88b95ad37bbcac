// open.c - a file of another kind is opened as if it were a relume file: by way of one without a
// name
#include <relume/exchange.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/base/tree.h"
#include "exchange/formats/kind.h"
#include "exchange/formats/still.h"
#include "image/image/picture.h"

#include <errno.h>
#include <relume/capture.h>
#include <relume/encode.h>
#include <relume/image/photograph.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

// ---------------------------------------------------------------- what it is

static bool holds(const char *folder, const char *name, const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, name);
    const bool found = path && input_exists(path, log);
    mem_free(path);
    return found;
}

static enum relume_kind kind_of_folder(const char *path, const struct relume_log *log)
{
    if (holds(path, "info.json", log))
        return RELUME_KIND_FOREIGN;
    if (holds(path, "btf.json", log) || holds(path, "model.json", log) ||
        holds(path, "surface.json", log))
        return RELUME_KIND_MATERIAL;
    if (holds(path, "capture.json", log) || relume_capture_is_olat(path, log))
        return RELUME_KIND_CAPTURE;
    char *lp = tree_only(path, ".lp");
    if (!lp)
        lp = tree_only_below(path, ".lp");
    mem_free(lp);
    return lp ? RELUME_KIND_CAPTURE : RELUME_KIND_UNKNOWN;
}

enum { HEAD = 4096 };
static const char exr_magic[] = "\x76\x2f\x31\x01", gbrdf[] = "gbrdfVersion",
                  baked[] = "bakedVersion";

static bool is_among(const char *path, const char *const *endings)
{
    while (*endings && !path_ends(path, *endings))
        endings++;
    return *endings != NULL;
}

static enum relume_kind kind_of_json(const char *head, size_t n, const char *path)
{
    if (memmem(head, n, "relume-capture", strlen("relume-capture")))
        return RELUME_KIND_CAPTURE;
    return path_ends(path, "info.json") || memmem(head, n, "colorspace", strlen("colorspace"))
               ? RELUME_KIND_FOREIGN
               : RELUME_KIND_UNKNOWN;
}

enum relume_kind exchange_kind_of(const char *path, const struct relume_log *log)
{
    static const char *const foreign[] = {".ptm", ".lptm", ".rti", ".hsh", NULL};
    static const char *const models[] = {".obj", ".ply", ".gltf", ".glb", ".fbx",
                                         ".dae", ".stl", ".3ds",  ".off", NULL};
    static const char *const photographs[] = {".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", NULL};
    char head[HEAD];
    const enum input_kind kind = input_kind(path, log);
    if (kind == INPUT_NONE)
        return RELUME_KIND_UNKNOWN;
    if (kind == INPUT_FOLDER)
        return kind_of_folder(path, log);
    if (is_among(path, foreign))
        return RELUME_KIND_FOREIGN;
    if (path_ends(path, ".lp"))
        return RELUME_KIND_CAPTURE;
    if (path_ends(path, ".btf"))
        return RELUME_KIND_MATERIAL;
    if (is_among(path, models))
        return RELUME_KIND_MODEL;
    FILE *f = input_open(path, log);
    const size_t n = f ? fread(head, 1, HEAD, f) : 0;
    if (f)
        fclose(f);
    if (path_ends(path, ".json"))
        return kind_of_json(head, n, path);
    if (n > 4 && !memcmp(head, exr_magic, 4) && memmem(head, n, gbrdf, sizeof gbrdf))
        return RELUME_KIND_MATERIAL;
    if (n > 4 && !memcmp(head, exr_magic, 4) && memmem(head, n, baked, sizeof baked))
        return RELUME_KIND_BAKED;
    if (n > 4 && !memcmp(head, exr_magic, 4))
        return picture_head_is_relume(head, n)     ? RELUME_KIND_RELUME
               : relume_capture_is_olat(path, log) ? RELUME_KIND_CAPTURE
                                                   : RELUME_KIND_PICTURE;
    if (relume_image_can_save(path) || is_among(path, photographs))
        return path_ends(path, ".exr") ? RELUME_KIND_RELUME : RELUME_KIND_PICTURE;
    return RELUME_KIND_UNKNOWN;
}

enum relume_kind relume_kind_of(const char *path)
{
    return exchange_kind_of(path, NULL);
}

const char *relume_kind_name(enum relume_kind kind)
{
    static const char *const names[] = {"relume file", "RTI of another format", "capture",
                                        "picture",     "nothing known",         "measured material",
                                        "3D model",    "baked object"};
    return names[kind];
}

// ---------------------------------------------------------------- what it becomes

// As `relume encode` does, but for shadows and highlights, which take longer to learn.
static relume_status encode(const char *path, const char *out, const struct relume_open_params *p)
{
    relume_capture *capture;
    relume_status status = relume_capture_open(
        &capture, path, relume_capture_params(.log = p->log, .allow_outside = p->allow_outside));
    if (!status)
        status = relume_encode_capture(
            out, capture, NULL,
            relume_encode_capture_params(.log = p->log, .threads = p->threads, .name = path,
                                         .shadows = RELUME_MOVING_NO,
                                         .highlights = RELUME_MOVING_NO));
    relume_capture_destroy(&capture);
    return status;
}

static relume_status picture(const char *path, const char *out, const struct relume_open_params *p)
{
    struct relume_exif notes;
    const relume_status status = relume_exif_read(&notes, path, p->log);
    if (status)
        return status;
    if (!notes.floats)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: one photograph under one light cannot be relit; expected the .lp file "
                        "or the folder of all of them, or 'relume capture PHOTO... -o DIR' first",
                        path);
    return still_write(path, out, p);
}

static bool is_scene(const char *path, const struct relume_log *log)
{
    static const char word[] = "\"relume-scene\"";
    char head[HEAD];
    FILE *f = path_ends(path, ".json") ? input_open(path, log) : NULL;
    const size_t n = f ? fread(head, 1, sizeof head, f) : 0;
    if (f)
        fclose(f);
    return memmem(head, n, word, strlen(word));
}

static relume_status unknown(const char *path, const struct relume_open_params *p)
{
    const enum input_kind kind = input_kind(path, p->log);
    const char *q = relume_name_quotes(path);
    if (kind == INPUT_NONE)
        return log_fail(p->log, RELUME_ENOTFOUND, "%s: no such file; expected a relume file", path);
    if (kind != INPUT_FOLDER && is_scene(path, p->log))
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: a scene file, which 'relume relight' and 'relume info' open; expected "
                        "one of the captures that it names",
                        path);
    if (kind != INPUT_FOLDER)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: relume cannot open this; expected a relume file (.exr), .ptm, .rti, "
                        ".hsh, a web folder, a capture (.lp, capture.json) or an HDR picture",
                        path);
    if (holds(path, "info.xml", p->log))
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "%s: tiles of WebRTI (info.xml), which relume does not read; expected the "
                        ".ptm or .rti that they were made from",
                        path);
    return log_fail(
        p->log, RELUME_EFORMAT,
        "%s: a folder without capture.json, info.json or a single .lp file; if it holds "
        "photographs, make a capture of them first: relume capture %s%s%s -o DIR",
        path, q, path, q);
}

// What cannot be relit, and what to do with it.
static relume_status elsewhere(enum relume_kind kind, const char *path,
                               const struct relume_log *log)
{
    const char *q = relume_name_quotes(path);
    switch (kind) {
    case RELUME_KIND_MATERIAL:
        return log_fail(log, RELUME_EFORMAT,
                        "%s: this is a measured material; work with it by 'relume btf', or see it: "
                        "relume-view %s%s%s",
                        path, q, path, q);
    case RELUME_KIND_MODEL:
        return log_fail(log, RELUME_EFORMAT,
                        "%s: this is a 3D model; see it: relume-view %s%s%s, or make what pages "
                        "show of it: relume bake %s%s%s -o OUT.exr",
                        path, q, path, q, q, path, q);
    default:
        return log_fail(log, RELUME_EFORMAT,
                        "%s: this is a baked object; put it into a scene with --objects, see it: "
                        "relume-view %s%s%s, or draw it: relume btf render %s%s%s -o OUT.png",
                        path, q, path, q, q, path, q);
    }
}

static relume_status convert(enum relume_kind kind, const char *path, const char *out,
                             const struct relume_open_params *p)
{
    switch (kind) {
    case RELUME_KIND_MATERIAL:
    case RELUME_KIND_MODEL:
    case RELUME_KIND_BAKED: return elsewhere(kind, path, p->log);
    case RELUME_KIND_FOREIGN:
        return relume_import(path, out,
                             relume_import_params(.log = p->log, .limits = p->limits,
                                                  .threads = p->threads,
                                                  .compression = RELUME_COMPRESS_NONE));
    case RELUME_KIND_CAPTURE: return encode(path, out, p);
    case RELUME_KIND_PICTURE: return picture(path, out, p);
    default: return unknown(path, p);
    }
}

// The relume file never has a name, so nothing of it is left, whatever happens.
static relume_status open_converted(relume_pack **out, enum relume_kind kind, const char *path,
                                    const struct relume_open_params *p,
                                    const struct relume_log *log)
{
    const int fd = scratch_open(NULL);
    if (fd < 0)
        return log_fail(p->log, RELUME_EIO, "%s: no temporary file can be made; %s",
                        scratch_folder(), strerror(errno));
    char *name = mem_format("/proc/self/fd/%d", fd);
    relume_status status = name ? convert(kind, path, name, p) : RELUME_ENOMEM;
    if (!status)
        status = relume_pack_open(
            out, name, relume_pack_params(.log = log, .limits = p->limits, .threads = p->threads));
    mem_free(name);
    close(fd);
    return status;
}

relume_status relume_open(relume_pack **out, const char *path,
                          const struct relume_open_params *params)
{
    struct relume_open_params p = PARAMS_WORK(relume_open_params, params);
    const struct relume_log *log = p.log;
    struct one_input one;
    *out = NULL;
    path = infile_name(path);
    p.log = one_input(&one, path, p.reader, log);
    const enum relume_kind kind = exchange_kind_of(path, p.log);
    if (kind == RELUME_KIND_UNKNOWN)
        return unknown(path, &p);
    return kind == RELUME_KIND_RELUME
               ? relume_pack_open(out, path,
                                  relume_pack_params(.log = log, .limits = p.limits,
                                                     .threads = p.threads, .reader = p.reader,
                                                     .keep_going = p.keep_going))
               : open_converted(out, kind, path, &p, log);
}
