// pack.h - the relume file: a multi-part OpenEXR file of coefficients (docs/format.md)
#ifndef RELUME_PACK_H
#define RELUME_PACK_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/context.h>
#include <relume/format/codebook.h>
#include <relume/format/coder.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

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

// Large views are kept at half, a quarter, ... of their size too, so that a smaller picture of all
// is soon there.
enum { RELUME_MOST_LEVELS = 16 };
// Whether a file gets these levels.
enum relume_pyramid {
    RELUME_PYRAMID_DEFAULT = 0,  // views of more than 16 megapixels, but not of slabs
    RELUME_PYRAMID_YES,
    RELUME_PYRAMID_NO,
};
// The reduced levels of a view, each half of the one before. The first pixel of one covers the
// first 2 x 2 of the one before; of an odd side the last covers what is left.
struct relume_pack_levels {
    int levels;                                      // how many
    relume_coefficients *level[RELUME_MOST_LEVELS];  // [levels], relume_coefficients_destroy
    struct relume_image share[RELUME_MOST_LEVELS];   // of each pixel, within the mask; or empty
    // Of views that are coded, as relume_pack_view.coded; mem_free
    uint32_t *coded[RELUME_MOST_LEVELS];
    size_t coded_words[RELUME_MOST_LEVELS];  // how many
};

// What goes into a file beside the coefficients. Borrowed.
struct relume_pack_view {
    const relume_coefficients *coefficients;
    double uv[2];                      // slab: where the camera stands
    int slab;                          // which of several slabs
    const struct relume_image *depth;  // one channel, or NULL
    const struct relume_image *mask;   // one channel, or NULL
    // Codebooks instead of planes: all views or none, as many books in each. Views that have the
    // same ones share them in the file when all do.
    const relume_books *books;
    const uint16_t *const *index;             // [books] -> [height][width], as relume_books_assign
    const struct relume_pack_levels *levels;  // NULL: none. All views have as many. With them the
                                              // view is kept in tiles, of which a reader takes
                                              // those that it needs
    // The planes coded with loss, in place of what `coefficients` hold, of all views or none: words
    // of docs/format.md, "Coded planes". `coefficients` are of RELUME_STORE_12.
    const uint32_t *coded;
    size_t coded_words;  // how many
    bool predicted;      // coded planes: from those of another view, which is not predicted itself
    int anchor;          // that view
    float depth_step;    // depth is written in steps of its inverse, of that size; 0: as it is
    const struct relume_image *shadow;  // as relume_shadows_learn gives it, or NULL; it is coded
                                        // with a little loss
    const struct relume_image *gloss;   // likewise, as relume_gloss_learn gives it, of files of one
                                        // view without `shadow`
    double model_bytes;  // what either may take: it is coded more coarsely, within limits, for
                         // that; 0: half a byte a pixel
};
// Which part of a file is written, where several machines share the work; relume_pack_join makes
// one file of all parts. Borrowed.
struct relume_pack_share {
    int part, parts;                // 1 .. parts
    int first, views;               // those that it holds, or rows of one
    const char *capture, *options;  // what must be the same in all parts; texts
    bool free_storage;              // nobody asked for the storage: join refuses coarse steps
    enum relume_step step;          // what was asked for
    enum relume_pyramid pyramid;    // likewise
    bool shared_books;              // all views of all parts have the same
    const struct relume_encode_report *measured;  // [views] of it; `coded`: one of all views
    bool coded;  // planes are coded with loss: it holds the views that have `coded` words, of all
                 // tiles or of some; tiles of 0 bytes are another part's
    int group;   // then: the number of its first group
};

// What is written. Everything is borrowed while relume_pack_write runs.
struct relume_pack_contents {
    const relume_coder *coder;
    enum relume_domain domain;
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY
    struct relume_geometry geometry;
    int slabs;                           // as struct relume_manifest
    const struct relume_geometry *slab;  // [slabs]
    int views;
    const struct relume_pack_view *view;  // [views]
    struct relume_encode_report report;   // over all views; NaN: not known
    // The picture of the first part, for ordinary EXR viewers, of the views' size, or where they
    // have reduced levels, of that of relume_pack_shown: fill linear rgb[rows][width][3] from `row`
    // on, and return what failed. Called from several threads. NULL: black. relume_pack_preview
    // makes one.
    relume_status (*preview)(void *user, int row, int rows, float *rgb);
    void *preview_user;                     // of `preview`
    const struct relume_pack_share *share;  // NULL: all of it
    const char *provenance;                 // as struct relume_manifest, or NULL
};

// The middle view relit from the front, panoramas from above: hand it in as `preview`, the contents
// themselves (struct relume_pack_contents) as its user. Always in plain C, so that files do not
// depend on the processor. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_pack_preview(void *contents, int row, int rows, float *rgb);

// Which level the first part shows, 0: the view itself.
RELUME_API int relume_pack_shown(const struct relume_pack_view *view);

// The reduced levels of `view`, made of its coefficients, for its `levels`; none where `pyramid`
// asks for none. What is used of `contents` is what all of a file has in common, and of `params`
// log, step, threads and scratch. RELUME_EUNFIT with a sentence where YES cannot be had: slabs,
// luminance coefficients. RELUME_EIO, RELUME_ENOMEM. End with
// relume_pack_levels_destroy.
RELUME_RESULT relume_status relume_pack_reduce(struct relume_pack_levels *out,
                                               const struct relume_pack_contents *contents,
                                               const struct relume_pack_view *view,
                                               enum relume_pyramid pyramid,
                                               const struct relume_encode_params *params);
RELUME_API void relume_pack_levels_destroy(struct relume_pack_levels *levels);

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

// Write `path` whole or not at all. Returns RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL,
// RELUME_ESYSTEM, RELUME_EINVAL for a `shadow` or `gloss` whose numbers are not finite (a thickness
// may be infinite) or too far apart for a float, or what `preview` returned.
RELUME_RESULT relume_status relume_pack_write(const struct relume_pack_contents *contents,
                                              const char *path,
                                              const struct relume_pack_params *params);

// Encode every view of `capture` by `coder` and write the file `path`: relume_encode and
// relume_pack_write in one call, temporary data beside `path`'s folder. `report` may be NULL.
struct relume_pack_encode_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_domain domain;
    enum relume_storage storage;
    enum relume_step step;
    enum relume_compression compression;
    int threads;
    const struct relume_books_params *books;  // codebooks instead of planes; threads are
                                              // those of this struct
    bool share;                               // one set of codebooks for all views
    bool no_depth;                            // leave depth out: no near lights, no views by depth
    enum relume_pyramid pyramid;              // reduced levels of large views
    // With loss: as few bytes as reproduce the captured images at this PSNR (that of
    // relume_evaluation.psnr_pooled_db), or as good as so many bytes of the file for each pixel of
    // each view allow. At most one of the two; 0: without loss. `storage`, `step`, `compression`
    // and `books` do not count then.
    double psnr_db, bytes_per_pixel;
    const struct relume_writer *writer;  // write here in place of the file, as
                                         // relume_pack_params; temporary data in $TMPDIR
    // Only one of several parts of the work, 1 .. parts, for relume_pack_join. With `share` only in
    // a team. With loss a part holds groups of views, of which there may be fewer than parts;
    // without a team each part codes all of them, to find the steps. Default: all of it.
    int part, parts;
    const char *options;  // what parts say they were asked for; those that say otherwise are not
                          // joined
    bool free_storage;    // nobody asked for `storage`: coarse steps are refused when joined
    const struct relume_team *team;  // the other parts (team.h): `part` is its member; default:
                                     // nothing is shared with them
    bool learn_only;                 // share what the team needs for its steps, and write nothing
    struct relume_transfer display;  // as relume_encode_params
    bool shadows;  // learn what shadows are traced with (shadow.h). Of captures with depth and
                   // distant lights; not in parts or with reduced levels
    const struct relume_image *gloss;  // what highlights wander by (relume_gloss_learn), of the
                                       // only view; likewise, and without `shadows`. Default: none
};
#define relume_pack_encode_params(...)                                                             \
    (&(const struct relume_pack_encode_params){RELUME_SIZED(relume_pack_encode_params),            \
                                               __VA_ARGS__})
// The whole way from a capture to a file. An input status, RELUME_EIO, RELUME_ENOMEM,
// RELUME_ECANCEL.
RELUME_RESULT relume_status relume_pack_encode(const relume_capture *capture,
                                               const relume_coder *coder, const char *path,
                                               struct relume_encode_report *report,
                                               const struct relume_pack_encode_params *params);

// The coder that needs the fewest bytes for `encode`'s psnr_db, or reproduces the captured lights
// best in its bytes_per_pixel: principal components, or where shadows are hard the captured images
// themselves (`table`), as tried on one view. `coder` may fix the interpolant, and the number of
// components: then it is these. It works in the display domain, which is what to encode in. Errors
// of relume_coder_decide and relume_encode.
RELUME_RESULT relume_status relume_pack_decide(relume_coder **out, const relume_capture *capture,
                                               const struct relume_coder_params *coder,
                                               const struct relume_pack_encode_params *encode);

// What a part is. Plain data.
struct relume_pack_part {
    int part, parts;     // 1 .. parts
    int first, views;    // that it holds, of
    int all_views;       // of the whole
    int row, rows;       // of the view, where it holds no more; else 0
    char creator[64];    // "relume 0.1.0"
    char options[4096];  // as they were given to relume_pack_encode
    uint64_t file_bytes;
    bool coded;  // with loss: it holds groups of neighbours, of which `first` is the lowest view
    char capture[RELUME_DIGEST];  // relume_capture_digest of what it was made from
    int tiles, all_tiles;  // coded: that it holds of its groups, of how many; views of a group are
                           // cut alike
    bool has_sums;         // as relume_pack_info
};
// An input status with a sentence when `path` is no part. Of `params` log, limits and reader are
// used.
RELUME_RESULT relume_status relume_pack_part_read(struct relume_pack_part *out, const char *path,
                                                  const struct relume_pack_params *params);

// One file of all parts: what relume_pack_encode would have written in one go, byte for byte.
// RELUME_EUNFIT with a sentence when a part is missing or doubled or does not belong to the others;
// an input status when one is damaged; RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL. `report` may be
// NULL. Of `params` log, limits, threads and writer are used.
RELUME_RESULT relume_status relume_pack_join(const char *const *parts, int count, const char *path,
                                             struct relume_encode_report *report,
                                             const struct relume_pack_params *params);

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
    struct relume_encode_report report;  // NaN where the file does not say
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

// Most bytes of notes that a file holds itself.
enum { RELUME_PACK_MOST_NOTES = 1 << 26 };
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
// Those of a rectangle of it alone, of which no more is read than the rows of the file that hold
// it, or tiles. They belong to the caller, but for codebooks, which stay until the pack's are
// dropped. RELUME_EINVAL where the rectangle does not lie within the view.
RELUME_RESULT relume_status relume_pack_codes_part(struct relume_codes_part *out, relume_pack *pack,
                                                   int view, const struct relume_rect *rect);
// The size of a view at a level: 0 is the view itself, 1 .. info.levels are reduced.
RELUME_API void relume_pack_level_size(int *width, int *height, const relume_pack *pack, int level);
// A rectangle of a view at a level, of whose pixels it is counted; else as relume_pack_codes_part.
RELUME_RESULT relume_status relume_pack_codes_level(struct relume_codes_part *out,
                                                    relume_pack *pack, int view, int level,
                                                    const struct relume_rect *rect);
// Forget the codes of one view to save memory.
RELUME_API void relume_pack_drop(relume_pack *pack, int view);
// Depth or mask of a view, one channel; empty when it has none. The caller destroys it.
RELUME_RESULT relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack,
                                              int view);
// The same at a level, as relume_pack_level_size: of each pixel what lies beside its middle.
RELUME_RESULT relume_status relume_pack_depth_level(struct relume_image *out, relume_pack *pack,
                                                    int view, int level);
// Likewise: one channel, above 0.5 where the object is.
RELUME_RESULT relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view);

// Channels of a model of moving shadows (relight/shadow.h).
enum {
    RELUME_SHADOW_THICK = 0,     // world units behind the surface, along the axis of the view or
                                 // away from its eye, in which light is stopped; above 0
    RELUME_SHADOW_COLOUR = 1,    // r, g, b of luminance 1, or black
    RELUME_SHADOW_MATTE = 4,     // a, then b in the world
    RELUME_SHADOW_CHANNELS = 8,  // in all
};

// Channels of a model of moving highlights.
enum {
    RELUME_GLOSS_COLOUR = 0,     // r, g, b: of the matte surface, or what a metal shines like;
                                 // linear, 0 or more
    RELUME_GLOSS_NORMAL = 3,     // x and y of a unit vector towards the viewer
    RELUME_GLOSS_ROUGHNESS = 5,  // glTF's, 0 to 1
    RELUME_GLOSS_SHINE = 6,      // reflectance at normal incidence; below 0: a metal
    RELUME_GLOSS_SHARE = 7,      // of that which counts, 0 or more
    RELUME_GLOSS_CHANNELS = 8,   // in all
};

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
