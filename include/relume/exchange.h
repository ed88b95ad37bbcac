// exchange.h - formats of the field: .ptm, .rti, relight's folders for the web
#ifndef RELUME_EXCHANGE_H
#define RELUME_EXCHANGE_H

#include <relume/base.h>
#include <relume/context.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_import_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    enum relume_compression compression;
    int threads;                         // default: all cores
    const struct relume_reader *reader;  // read this in place of the file; `path` is a name whose
                                         // ending says what it is (io.h). Not for folders: these
                                         // are asked for by name (relume_files, context.h)
    const struct relume_writer *writer;  // write here in place of the file `out`, which may be NULL
};
#define relume_import_params(...)                                                                  \
    (&(const struct relume_import_params){RELUME_SIZED(relume_import_params), __VA_ARGS__})

// Turn `path` (.ptm, .rti, .hsh, a relight folder or its info.json) into the relume file `out` that
// relights as the format says. Codes stay as they are, but for those in YCC, which become 16-bit
// RGB. Returns an input status, RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_import(const char *path, const char *out,
                                          const struct relume_import_params *params);

// Kinds of files and folders.
enum relume_kind {
    RELUME_KIND_RELUME = 0,  // a relume file, or an .exr file that no other kind claims
    RELUME_KIND_FOREIGN,     // what relume_import reads
    RELUME_KIND_CAPTURE,     // a capture.json, its folder, a .lp file or a folder with one
    RELUME_KIND_PICTURE,     // a picture or photograph
    RELUME_KIND_UNKNOWN,     // nothing there, or anything else
    RELUME_KIND_MATERIAL,    // a BTF: a folder with btf.json, or a .btf file (btf.h)
    RELUME_KIND_MODEL,       // a 3D model, by its ending (mesh.h)
    RELUME_KIND_BAKED,       // an object with its light (bake.h)
    RELUME_KIND_SCENE,       // a scene file (tableau.h)
    RELUME_KIND_OBJECTS,     // a description of objects (object.h), or any other .json file
    RELUME_KIND_MAPS,        // a folder of maps, with maps.json (maps.h)
    RELUME_KIND_FITTED,      // a model of a BTF: a folder with model.json, or a g-BRDF (.exr)
    RELUME_KIND_SURFACE,     // a surface of a material: a folder with surface.json (surface.h)
};
// Returns the kind of the file or folder `path`: by its first bytes or by the files in it, and by
// the ending of its name if these do not decide. Reads a whole .json file only if the member
// "format" is not in its first 4096 bytes.
// Thread-safety: safe.
RELUME_API enum relume_kind relume_kind_of(const char *path);
// For sentences; constant.
RELUME_API const char *relume_kind_name(enum relume_kind kind);

// How anything is opened. `log` is used as long as the pack lives; the rest is borrowed during the
// call.
struct relume_open_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    bool allow_outside;  // of captures, as relume_capture_params
    bool sphere;         // a picture shows all directions, twice as wide as high: a panorama
    int threads;         // default: all cores
    const struct relume_reader *reader;  // as relume_import_params. A relume file is read as long
                                         // as the pack lives; a capture.json or .lp names pictures
                                         // in the folder of `path`
    bool keep_going;                     // of relume files, as relume_pack_params
};
#define relume_open_params(...)                                                                    \
    (&(const struct relume_open_params){RELUME_SIZED(relume_open_params), __VA_ARGS__})

// Open anything that can be shown as a relume file: relume files themselves; what relume_import
// reads; captures, encoded by the defaults; a picture of linear light (floats), which looks the
// same under any light. What is made on the way is a file without a name in $TMPDIR or /tmp.
// Photographs and other folders are refused with a sentence that says what to do. Returns
// An input status, RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_open(relume_pack **out, const char *path,
                                        const struct relume_open_params *params);

// Formats of other programs.
enum relume_exchange {
    RELUME_EXCHANGE_RELIGHT = 0,  // info.json and plane JPEGs, for OpenLIME and relight
    RELUME_EXCHANGE_PTM,          // .ptm, PTM_FORMAT_RGB; with a quality, size or PSNR JPEG_RGB
    RELUME_EXCHANGE_LPTM,         // .ptm, PTM_FORMAT_LRGB; likewise JPEG_LRGB
    RELUME_EXCHANGE_RTI,          // .rti, hemispherical harmonics
    RELUME_EXCHANGE_DEEPZOOM,     // as RELIGHT, the planes as DeepZoom tiles
    RELUME_EXCHANGE_BC1,          // DDS textures of 4 bits a pixel and term, for shaders
    RELUME_EXCHANGE_BC7,          // the same of 8 bits
    RELUME_EXCHANGE_BC6H,         // the same as half floats
    RELUME_EXCHANGE_OLAT,         // one EXR with a layer for every light: one light at a time
};
// "relight", "ptm", "lptm", "rti", "deepzoom", "bc1", "bc7", "bc6h", "olat". RELUME_EINVAL when
// `name` is none of these.
RELUME_RESULT relume_status relume_exchange_parse(enum relume_exchange *out, const char *name);

// How the planes of RELIGHT and DEEPZOOM follow the light.
enum relume_web_type {
    RELUME_WEB_BILINEAR = 0,  // principal components, their weights in a grid over the hemisphere
    RELUME_WEB_RBF,           // principal components, Gaussians around the lights
    RELUME_WEB_PTM,           // biquadratic polynomials, 6 coefficients
    RELUME_WEB_LPTM,          // the same for the luminance, times a colour
    RELUME_WEB_HSH,           // hemispherical harmonics, 9 coefficients
    RELUME_WEB_SH,            // spherical harmonics, 9 coefficients
};

// Zero in a field means its default. Of bytes_per_pixel, psnr_db and quality at most one is given.
struct relume_export_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int view;                   // of a slab
    enum relume_web_type type;  // RELIGHT, DEEPZOOM
    bool ycc;                   // ptm, hsh, sh: only the luminance follows the light; bilinear,
                                // rbf: planes for luminance and chroma apart (mycc)
    int coefficients;           // planes of bilinear and rbf, at most 45, default: up to 27
                                // (mycc: 45), as many as are worth their bytes; terms of the other
                                // types
    int resolution;  // bilinear: side of the grid of lights, [3, 33]; default 15, for many lights
                     // more
    double bytes_per_pixel;  // of all plane JPEGs together (PTM, LPTM: of the file), not exceeded
    double psnr_db;          // against the file's own pictures under its lights, reached
    int quality;             // [1, 100]; default: so high, 95 or more, that its error is not to be
                             // seen; PTM, LPTM: default 0, raw planes; not for RTI
    bool force;              // replace an existing folder that is not empty
    int threads;             // default: all cores
    const struct relume_writer *writer;  // PTM, LPTM, RTI, OLAT: write here in place of the file;
                                         // `path` is only a name then, or NULL
    int level;  // of a view with reduced levels (relume_pack_info): 1 is half its size, of which no
                // more is read; default: 0, the view itself
};
#define relume_export_params(...)                                                                  \
    (&(const struct relume_export_params){RELUME_SIZED(relume_export_params), __VA_ARGS__})

// What an export became; measured by reading it back, under at most 16 of the file's lights.
struct relume_export_report {
    int planes;
    double bytes_per_pixel;  // of plane JPEGs, or of the file
    double psnr_db;          // mean over the lights, 8-bit sRGB, against the file's own pictures
    bool exact;              // the file's codes as they are
    int quality;             // of RELIGHT, DEEPZOOM: asked for or chosen; 0: by size or PSNR
    int layers;              // of OLAT: lights; the others are 0 then
};

// Write view `params->view` of `pack` as a file or folder `path`, whole or not at all; `report` may
// be NULL. Returns RELUME_EINVAL, RELUME_EUNFIT (panoramas; a target that cannot be reached),
// RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_export(relume_pack *pack, const char *path,
                                          enum relume_exchange format,
                                          struct relume_export_report *report,
                                          const struct relume_export_params *params);

#ifdef __cplusplus
}
#endif
#endif
