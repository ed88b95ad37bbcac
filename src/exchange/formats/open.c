// open.c - a file of another kind is opened as if it were a relume file: by way of one without a
// name
#include <relume/exchange.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/photograph.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "exchange/formats/kind.h"
#include "exchange/formats/still.h"
#include "image/image/picture.h"

#include <errno.h>
#include <relume/capture.h>
#include <relume/capture/acquire.h>
#include <relume/encode.h>
#include <relume/image/photograph.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

// ---------------------------------------------------------------- what it becomes

// As `relume encode --lossless` does, but for shadows and highlights, which take longer to learn.
static relume_status encode(const char *path, const char *out, const struct relume_open_params *p)
{
    relume_capture *capture;
    relume_status status = relume_capture_open_photographs(
        &capture, path, relume_capture_params(.log = p->log, .allow_outside = p->allow_outside),
        NULL, NULL);
    if (!status)
        status = relume_encode_capture(
            out, capture, NULL,
            relume_encode_capture_params(.log = p->log, .threads = p->threads, .name = path,
                                         .lossless = true, .shadows = RELUME_MOVING_NO,
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

static relume_status unknown(const char *path, const struct relume_open_params *p)
{
    const enum input_kind kind = input_kind(path, p->log);
    const char *q = relume_name_quotes(path);
    if (kind == INPUT_NONE)
        return log_fail(p->log, RELUME_ENOTFOUND, "%s: no such file; expected a relume file", path);
    if (kind != INPUT_FOLDER)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: relume cannot open this; expected a relume file (.exr), .ptm, .rti, "
                        ".hsh, a web folder, a capture (.lp, capture.json) or an HDR picture",
                        path);
    const relume_status status = photographs_refuse_tiles(path, p->log);
    if (status)
        return status;
    return log_fail(
        p->log, RELUME_EFORMAT,
        "%s: a folder without capture.json, info.json or a single .lp file; if it holds "
        "photographs, make a capture of them first: relume capture %s%s%s -o DIR",
        path, q, path, q);
}

// Says why a kind cannot be relit, and what to do with it.
static relume_status refuse(enum relume_kind kind, const char *path,
                            const struct relume_open_params *p)
{
    const char *q = relume_name_quotes(path);
    switch (kind) {
    case RELUME_KIND_MATERIAL:
    case RELUME_KIND_FITTED:
    case RELUME_KIND_SURFACE:
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: this is a measured material; work with it by 'relume btf', or see it: "
                        "relume-view %s%s%s",
                        path, q, path, q);
    case RELUME_KIND_MODEL:
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: this is a 3D model; see it: relume-view %s%s%s, or make what pages "
                        "show of it: relume bake %s%s%s -o OUT.exr",
                        path, q, path, q, q, path, q);
    case RELUME_KIND_BAKED:
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: this is a baked object; put it into a scene with --objects, see it: "
                        "relume-view %s%s%s, or draw it: relume btf render %s%s%s -o OUT.png",
                        path, q, path, q, q, path, q);
    case RELUME_KIND_SCENE:
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: a scene file, which 'relume relight' and 'relume info' open; expected "
                        "one of the captures that it names",
                        path);
    default: return unknown(path, p);
    }
}

static bool can_convert(enum relume_kind kind)
{
    return kind == RELUME_KIND_FOREIGN || kind == RELUME_KIND_CAPTURE ||
           kind == RELUME_KIND_PICTURE;
}

static relume_status convert(enum relume_kind kind, const char *path, const char *out,
                             const struct relume_open_params *p)
{
    switch (kind) {
    case RELUME_KIND_FOREIGN:
        return relume_import(path, out,
                             relume_import_params(.log = p->log, .limits = p->limits,
                                                  .threads = p->threads,
                                                  .compression = RELUME_COMPRESS_NONE));
    case RELUME_KIND_CAPTURE: return encode(path, out, p);
    default: return picture(path, out, p);
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
    if (kind == RELUME_KIND_RELUME)
        return relume_pack_open(out, path,
                                relume_pack_params(.log = log, .limits = p.limits,
                                                   .threads = p.threads, .reader = p.reader,
                                                   .keep_going = p.keep_going));
    return can_convert(kind) ? open_converted(out, kind, path, &p, log) : refuse(kind, path, &p);
}
