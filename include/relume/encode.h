// encode.h - a capture becomes a relume file: one call that makes every decision
//
//     struct relume_encode_result result;
//     relume_encode_capture("statue.exr", capture, &result,
//                           relume_encode_capture_params(.psnr_db = 38.0, .log = &log));
//
// What the params leave open is chosen by the photographs: basis, number of coefficients, domain,
// bits, and whether shadows and highlights move with the light. `relume encode`, Python's
// `encode()` and pages call this function; the same capture and params give the same bytes.
#ifndef RELUME_ENCODE_H
#define RELUME_ENCODE_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/context.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// A choice between shadows or highlights that move with the light, and those that fade.
enum relume_moving {
    RELUME_MOVING_DEFAULT = 0,
    RELUME_MOVING_AUTO,  // they move where that predicts held-out lights better
    RELUME_MOVING_YES,
    RELUME_MOVING_NO,
};

// The PSNR of lossy planes where a basis and the effort alone are given, in dB: differences are
// hardly seen.
#define RELUME_LOSSY_DB 40.0

// Zero in a field means its default. Everything is borrowed during the call.
struct relume_encode_capture_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;       // default: all cores
    const char *name;  // how sentences call the capture; default: "the capture"

    // The model
    // Default: auto, by the photographs; pca with books, robust or luminance.
    const struct relume_basis *basis;
    // For each colour channel, joint bases: for all three; up to 4096. Default with auto: by
    // quality_db, at least 27. Other bases have their own.
    int coefficients;
    // PSNR of the photographs that auto reaches with at most 128 coefficients, 10 to 60;
    // default 38.
    double quality_db;
    const struct relume_interpolant *interpolant;  // pca, table. Default: the basis's own
    bool choose_interpolant;                       // by the photographs, as auto does
    bool luminance, robust, force;                 // as relume_coder_params
    double ridge;                                  // as relume_coder_params, 0 to 1
    bool no_ridge;                                 // as relume_coder_params
    enum relume_domain domain;       // default with auto: by the error; other bases: by the capture
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY, as relume_project_params
    // Traced through the depth. Default with auto: MOVING_AUTO for lossless files and from
    // bytes_per_pixel 1 on. Other bases: NO.
    enum relume_moving shadows;
    // Of planar captures without traced shadows. Default with auto: MOVING_AUTO without loss and
    // from bytes_per_pixel 0.5 on, for at least 64 x 64 pixels. Other bases: NO.
    enum relume_moving highlights;

    // The file
    // Default with auto: the fewest bits whose error is invisible. Other bases: 8 bits, or half
    // floats where these are too coarse.
    enum relume_storage storage;
    enum relume_step step;
    enum relume_compression compression;
    enum relume_pyramid pyramid;
    bool no_depth;                            // leave depth out: no near lights, no views by depth
    const struct relume_books_params *books;  // codebooks instead of planes
    bool share;                               // one set of codebooks for all views
    // Lossy, at most one of the three: the smallest file of a PSNR (10 to 60 dB), or the best file
    // of at most that many bytes for each pixel of each view (up to 100), or the smallest file in
    // which 99 % of the pixels of every photograph differ by less than `jnd` just noticeable
    // differences (0.05 to 100; several files are tried). Default: by the photographs, as `effort`.
    double psnr_db, bytes_per_pixel, jnd;
    // Write here instead of the file; temporary data in $TMPDIR
    const struct relume_writer *writer;

    // One of several machines (relume/format/team.h, relume/encode/pack_encode.h)
    int part, parts;      // only this part, 1 .. parts, for relume_pack_join; default: all
    const char *options;  // one line about these params: parts of other options are not joined
    const char *learnt;   // a folder by which the parts share what they learn; default: none
    bool learn_only;      // leave the share of this part there, and write nothing
    const struct relume_team *team;  // processes that run now: each writes a part, the first joins
                                     // them

    // Time for lossy planes. Alone, with basis auto, the photographs choose the quality: they are
    // reproduced at 38 dB or more where a lossless file does so. Lights between them are shown
    // about 0.1 dB worse than by a lossless file. With another basis, or where a file is coded
    // again, the quality is RELUME_LOSSY_DB.
    enum relume_effort effort;
    // Without loss; refused with what asks for loss. So are files with quality_db, storage, step,
    // compression, codebooks, a basis, or a domain other than display. By default captures of high
    // dynamic range, of fewer than 4096 pixels, or with hard shadows in linear light are lossless.
    // So are those that take longer to code than all the rest.
    bool lossless;
};
#define relume_encode_capture_params(...)                                                          \
    (&(const struct relume_encode_capture_params){RELUME_SIZED(relume_encode_capture_params),      \
                                                  __VA_ARGS__})

// Checks params before there is a capture, as relume_encode_capture does. RELUME_EINVAL with a
// message for params that are out of range or exclude each other. Messages name the options of
// `relume encode`.
RELUME_RESULT relume_status relume_encode_check(const struct relume_encode_capture_params *params);
// Returns true if photographs are read more than once: relume_capture_params.keep_bytes helps then.
RELUME_API bool relume_encode_rereads(const struct relume_encode_capture_params *params);

// Kinds of results.
enum relume_encoded {
    RELUME_ENCODED_FILE = 0,   // the whole file
    RELUME_ENCODED_PART,       // one part; without psnr_db in `measured`: rows that wait for others
    RELUME_ENCODED_ELSEWHERE,  // the first process of the team has joined the file
    // With learn_only
    RELUME_LEARNT_ALL,      // the part can be encoded now
    RELUME_LEARNT_SHARE,    // other parts have not learnt their shares yet
    RELUME_LEARNT_STEP,     // the same, and this part is to learn again then
    RELUME_LEARNT_NOTHING,  // these params need nothing learnt
};

// Reasons for which a quality or size is not kept.
enum relume_reach {
    RELUME_REACHED = 0,
    RELUME_REACH_COEFFICIENTS,  // quality_db is more than 128 coefficients reproduce
    RELUME_REACH_PSNR_ABOVE,    // psnr_db is more than the finest coding reaches
    RELUME_REACH_PSNR_BELOW,    // the coarsest coding is better than psnr_db
    RELUME_REACH_BYTES_BELOW,   // the coarsest coding needs more than bytes_per_pixel
    RELUME_REACH_BYTES_ABOVE,   // the finest coding needs less than bytes_per_pixel
    RELUME_REACH_JND,           // no coding is as good as jnd
};

// Outcome for shadows or highlights.
enum relume_moving_outcome {
    RELUME_MOVING_UNTRIED = 0,  // they fade: not asked for, or pictures too small to matter
    RELUME_MOVING_MOVES,        // with the gain, unless they were asked for
    RELUME_MOVING_FADES,        // moving predicts no better: the gain
    RELUME_MOVING_UNSUITED,     // the capture or the params do not do: `expected`
    RELUME_MOVING_SLOW,         // they fade, since moving takes minutes; highlights: the gain
    RELUME_MOVING_LARGE,        // moving takes more than limits.max_memory
    RELUME_MOVING_FAILED,       // no surface could be fitted: `status`
};
struct relume_moving_report {
    enum relume_moving_outcome outcome;
    int lights;                 // that were left out to see what moving gains
    double faded_db, moved_db;  // PSNR of these lights either way
    const char *expected;       // constant text
    relume_status status;
};

// Quality, size and decisions of a file that has been made. Plain data.
struct relume_encode_result {
    enum relume_encoded made;  // the rest is what is known so far, if this is no file
    const struct relume_basis *basis;
    int coefficients;  // for each colour channel, `joint`: for all three
    bool joint;
    int lights, views;
    enum relume_domain domain;
    struct relume_transfer display;   // the curve of DOMAIN_DISPLAY
    enum relume_storage storage;      // without loss
    bool lossy;                       // coded with loss
    struct relume_fidelity measured;  // over all views
    double unseen_db;   // predicted PSNR of light directions that were not captured; 0: unknown
    double quality_db;  // that was asked for, or the default of basis auto; 0: none
    enum relume_reach reach;  // of it, bytes_per_pixel or jnd
    double jnd;               // that 99 % of the pixels of every photograph keep; 0: not judged
    double file_bytes;        // 0 of pipes and devices
    double bytes_per_pixel;   // of each view, likewise
    double photograph_bytes;  // of the photographs' files; 0: unknown
    bool is_coarse;           // the storage asked for is too coarse for bright highlights
    struct relume_moving_report shadows, highlights;
    bool coder_crashed;  // the file is lossless; its shadows and highlights fade
};

// Encodes `capture` into the file `path`, whole or not at all; `path` is NULL with a writer.
// `result` may be NULL. Bytes do not depend on `threads`.
// RELUME_EINVAL as relume_encode_check, and without path and writer, or with both a team and a
// writer. RELUME_EUNFIT where the capture does not suit: its shadows or highlights cannot move, its
// lights determine fewer coefficients. An input status, RELUME_EIO, RELUME_ENOMEM, RELUME_ESYSTEM,
// RELUME_ECANCEL.
// libaom codes lossy planes in a process of relume-helper where that program is installed. If the
// process crashes or is killed, a warning says so and the file becomes lossless. Parts, teams and
// writers get RELUME_ECODER.
// Thread-safety: a capture may be encoded by several threads at once.
RELUME_RESULT relume_status relume_encode_capture(
    const char *path, const relume_capture *capture, struct relume_encode_result *result,
    const struct relume_encode_capture_params *params);

// Writes an open relume file with lossy planes into the file `path`. The file keeps its
// functions of light, depth, masks, levels and models of shadows and highlights; `measured.psnr_db`
// compares with what the file itself shows under its captured lights. Of the params log, threads,
// name, pyramid, psnr_db, bytes_per_pixel, effort and writer are used. RELUME_EINVAL for other
// params; errors as relume_encode_capture.
RELUME_RESULT relume_status relume_encode_again(const char *path, relume_pack *pack,
                                                struct relume_encode_result *result,
                                                const struct relume_encode_capture_params *params);

#ifdef __cplusplus
}
#endif
#endif
