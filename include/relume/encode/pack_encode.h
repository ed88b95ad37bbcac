// pack_encode.h - a capture becomes a relume file by a coder that is there already, whole or in
// parts
//
// Most programs leave all decisions to relume_encode_capture (relume/encode.h), which calls these.
#ifndef RELUME_PACK_ENCODE_H
#define RELUME_PACK_ENCODE_H

#include <relume/format/codebook.h>
#include <relume/format/coder.h>
#include <relume/format/pack_write.h>

#ifdef __cplusplus
extern "C" {
#endif

// Encodes every view of `capture` by `coder` and writes the file `path`; temporary data lie in its
// folder. `report` may be NULL.
struct relume_pack_encode_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_domain domain;
    enum relume_storage storage;
    enum relume_step step;
    enum relume_compression compression;
    int threads;
    const struct relume_books_params *books;  // codebooks instead of planes; their threads
                                              // are not read
    bool share;                               // one set of codebooks for all views
    bool no_depth;                            // leave depth out: no near lights, no views by depth
    enum relume_pyramid pyramid;              // reduced levels of large views
    // Lossy: as few bytes as reproduce the captured images at this PSNR (that of
    // relume_evaluation.psnr_pooled_db), or as good as so many bytes of the file for each pixel of
    // each view allow. At most one of the two; 0: lossless. `storage`, `step`, `compression`
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
    struct relume_transfer display;  // as relume_project_params
    bool shadows;  // learn what shadows are traced with (shadow.h). Of captures with depth and
                   // distant lights; not in parts or with reduced levels
    const struct relume_image *gloss;  // the model of moving highlights, of the
                                       // only view; likewise, and without `shadows`. Default: none
    enum relume_effort effort;         // of lossy planes
    double least_db;  // with psnr_db: what samples of more bits, which take several times as long,
                      // are worth; default: psnr_db
};
#define relume_pack_encode_params(...)                                                             \
    (&(const struct relume_pack_encode_params){RELUME_SIZED(relume_pack_encode_params),            \
                                               __VA_ARGS__})
// The whole way from a capture to a file. An input status, RELUME_EIO, RELUME_ENOMEM,
// RELUME_ECANCEL.
RELUME_RESULT relume_status relume_pack_encode(const relume_capture *capture,
                                               const relume_coder *coder, const char *path,
                                               struct relume_fidelity *report,
                                               const struct relume_pack_encode_params *params);

// The coder that needs the fewest bytes for `encode`'s psnr_db, or reproduces the captured lights
// best in its bytes_per_pixel: principal components, or where shadows are hard the captured images
// themselves (`table`), as tried on one view. `coder` may fix the interpolant, and the number of
// components: then it is these. It works in the display domain, which is what to encode in. Errors
// of relume_coder_learn and relume_pack_encode.
RELUME_RESULT relume_status relume_pack_decide(relume_coder **out, const relume_capture *capture,
                                               const struct relume_coder_params *coder,
                                               const struct relume_pack_encode_params *encode);
// One file of all parts: what relume_pack_encode would have written in one go, byte for byte.
// RELUME_EUNFIT with a message when a part is missing or doubled or does not belong to the others;
// an input status when one is damaged; RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL. `report` may be
// NULL. Of `params` log, limits, threads and writer are used.
RELUME_RESULT relume_status relume_pack_join(const char *const *parts, int count, const char *path,
                                             struct relume_fidelity *report,
                                             const struct relume_pack_params *params);

#ifdef __cplusplus
}
#endif
#endif
