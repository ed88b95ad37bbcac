// pack.h - the relume file: a multi-part OpenEXR file of coefficients (docs/format.md)
#ifndef RELUME_PACK_H
#define RELUME_PACK_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/context.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// A basis prepared for one set of lights. Never changes. Thread-safety: safe.
typedef struct relume_coder relume_coder;

// The stored coefficients of a view in memory (relume/format/coder.h).
struct relume_codes;

// In which light the coefficients live (architecture: "Domain").
enum relume_domain { RELUME_DOMAIN_AUTO = 0, RELUME_DOMAIN_LINEAR, RELUME_DOMAIN_DISPLAY };

// In memory codes of 8 bits are uint8_t, floats float, all others 16-bit words. `log` is a way of
// encoding: half floats rounded to 8 significant bits, even steps of brightness that compress
// better; what is stored is `half`.
enum relume_storage {
    RELUME_STORE_DEFAULT = 0,
    RELUME_STORE_8,
    RELUME_STORE_16,
    RELUME_STORE_HALF,
    RELUME_STORE_10,
    RELUME_STORE_12,
    RELUME_STORE_FLOAT,
    RELUME_STORE_LOG,
};

// The quantiser's step: every plane's own range over all codes, or one step for all planes, which
// is the rate-distortion optimum where the functions are orthonormal. Halved: the common step,
// halved for planes of small range, which few bits then keep as well; for lossy planes.
enum relume_step {
    RELUME_STEP_DEFAULT = 0,
    RELUME_STEP_PLANE,
    RELUME_STEP_COMMON,
    RELUME_STEP_HALVED
};

// Time for lossy planes, which become smaller with it. Default: usual.
enum relume_effort {
    RELUME_EFFORT_DEFAULT = 0,
    RELUME_EFFORT_FAST,
    RELUME_EFFORT_USUAL,
    RELUME_EFFORT_SMALLEST
};

// Pixels of a view that carry little or no information; those outside the mask do not count.
struct relume_census {
    size_t pixels;
    size_t black;           // exactly 0 under every light
    size_t clipped;         // as bright as the files can say, in a colour, under some light
    size_t always_clipped;  // in the same colour under every light
    size_t repaired;        // pixels of images that held NaN or infinity, masked ones too
    int black_images;       // lights under which nothing is seen
};

// How well a view was encoded, in the coefficients' own domain over the captured lights, in units
// where 1 is white; measured on two rows of 16 or 64.
struct relume_fidelity {
    double fit_rms;    // captured samples against unquantised coefficients
    double store_rms;  // unquantised against stored coefficients
    double steps_rms;  // the same before a codebook; 0 from a file
    double psnr_db;    // of display values, as `relume eval` measures it, with a codebook what that
                       // leaves; 0 from a file
    double typical;    // captured sample above 0: squared mean of the roots; 0 from a file
    struct relume_census census;  // zeros where it is read from a file
};

// How EXR packs the codes, always without loss.
enum relume_compression {
    RELUME_COMPRESS_DEFAULT = 0,  // PIZ
    RELUME_COMPRESS_NONE,
    RELUME_COMPRESS_RLE,
    RELUME_COMPRESS_ZIP,
    RELUME_COMPRESS_PIZ,
};
// "none", "rle", "zip", "piz". RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_compression_parse(enum relume_compression *out,
                                                     const char *name);

// Whether a file gets these levels.
enum relume_pyramid {
    RELUME_PYRAMID_DEFAULT = 0,  // views of more than 16 megapixels, but not of slabs
    RELUME_PYRAMID_YES,
    RELUME_PYRAMID_NO,
};

// How relume files are written and opened. Borrowed during the call; an open pack goes on using
// `log` and what `reader` reads from.
struct relume_pack_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;   // reading
    enum relume_compression compression;  // writing
    int threads;                          // default: all cores
    const struct relume_reader *reader;   // reading: this in place of the file; the path is only a
                                          // name then, or NULL. It is copied: what it reads from
                                          // must outlive the pack
    const struct relume_writer *writer;   // writing: likewise
    bool keep_going;                      // reading: tiles of coded planes that are damaged hold no
                                          // light and are a warning, not an error
};
#define relume_pack_params(...)                                                                    \
    (&(const struct relume_pack_params){RELUME_SIZED(relume_pack_params), __VA_ARGS__})

// An open relume file. Views are read when first asked for and stay until dropped.
// Thread-safety: one thread at a time.
typedef struct relume_pack relume_pack;

// Everything in a file is checked before it is used. The pack keeps the log and its limits, which
// must outlive it. Returns an input status, RELUME_ENOMEM; RELUME_EINVAL without path and reader.
RELUME_RESULT relume_status relume_pack_open(relume_pack **out, const char *path,
                                             const struct relume_pack_params *params);
RELUME_API void relume_pack_destroy(relume_pack **pack);

// What a file holds; pointers belong to the pack.
struct relume_pack_info {
    int version;  // of the format
    const relume_coder *coder;
    enum relume_domain domain;
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY
    enum relume_storage storage;
    const char *compression;  // of the coefficients: "piz", ...; "av1": coded with loss
    struct relume_geometry geometry;
    int slabs;  // around an object, each with its own pose; 0: `geometry` is all there is
    const struct relume_geometry *slab;  // [slabs]; the first is `geometry`
    int width, height;                   // of each view
    int levels;                          // reduced ones of each view
    int tile;  // side of the tiles that views are kept or coded in, 0: runs of rows
    int views;
    const double (*uv)[2];  // [views]; slab: camera places
    const int *slab_of;     // [views]; several slabs: which one; else NULL
    bool has_depth, has_mask;
    int coefficients, planes;  // as stored. The coder has one more where there are masks and a mean
    int books;                 // codebooks for each pixel, 0: planes
    int codes;                 // vectors of the first book
    bool shared;               // all views have the same codebooks
    struct relume_fidelity report;  // NaN where the file does not say
    uint64_t file_bytes;
    bool has_shadow;  // shadows can be traced: relume_pack_shadow
    bool has_gloss;   // highlights wander: relume_pack_gloss
    bool has_sums;    // check sums, by which relume_pack_check notices any byte that has changed
    const char *provenance;  // of the photographs, a JSON object (docs/format.md), or NULL
    const char *notes;       // that the file holds itself, a page of annotations
                             // (relume/exchange/notes.h), or NULL
};
// It belongs to the pack.
RELUME_API const struct relume_pack_info *relume_pack_info(const relume_pack *pack);

// Put a page of annotations (relume/exchange/notes.h, UTF-8) into the file `path`, in place of one
// that it holds; NULL: take it out. All else stays as it is, pictures byte by byte, check sums are
// made anew; the file is replaced as a whole or not at all, and one that is open goes on to be what
// it was. RELUME_EFORMAT for what is no relume file, RELUME_ELIMIT for longer notes, an input
// status, RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_pack_keep_notes(const char *path, const char *notes,
                                                   const struct relume_log *log);

// Where the pixels of a view lie: `geometry`, or its slab.
RELUME_API const struct relume_geometry *relume_pack_geometry(const relume_pack *pack, int view);

// The codes of one view; they belong to the pack and stay valid until relume_pack_drop or destroy.
RELUME_RESULT relume_status relume_pack_codes(const struct relume_codes **out, relume_pack *pack,
                                              int view);
// Forget the codes of one view to save memory.
RELUME_API void relume_pack_drop(relume_pack *pack, int view);
// Depth or mask of a view, one channel; empty when it has none. The caller destroys it.
RELUME_RESULT relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack,
                                              int view);
// Likewise: one channel, above 0.5 where the object is.
RELUME_RESULT relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view);

// Model of the moving shadows of a view, as it was coded; empty when the file has none.
RELUME_RESULT relume_status relume_pack_shadow(struct relume_image *out, relume_pack *pack,
                                               int view);
// Model of the moving highlights of a view; empty when the file has none.
RELUME_RESULT relume_status relume_pack_gloss(struct relume_image *out, relume_pack *pack,
                                              int view);

// Read all of a file, or of a part, compare it with its check sums (docs/format.md) and call
// `found` for each run of rows of a part that has changed, is missing or cannot be decoded, rows
// from the top of the part. Returns RELUME_OK when the file is whole; an input status when it is
// not, with a sentence where it is more than those rows: a header, a value out of range. Files of
// earlier versions have no sums: what PIZ and no compression decode in spite of damage to single
// bits is not noticed there.
struct relume_pack_check_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    int threads;
    void (*found)(void *user, const char *part, int row, int rows);  // or NULL
    void *user;
    // Likewise, of coded planes: a tile, by column and row of tiles, and what it covers; or NULL.
    void (*tile)(void *user, const char *part, int column, int row, const struct relume_rect *at);
    const struct relume_reader *reader;  // as relume_pack_params
    bool *has_sums;                      // whether it has check sums; or NULL
};
#define relume_pack_check_params(...)                                                              \
    (&(const struct relume_pack_check_params){RELUME_SIZED(relume_pack_check_params), __VA_ARGS__})
// An input status when anything is damaged, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_pack_check(const char *path,
                                              const struct relume_pack_check_params *params);

#ifdef __cplusplus
}
#endif
#endif
