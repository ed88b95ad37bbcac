// encode_capture.c - a capture becomes a relume file by one call, which makes every decision:
//
//     check -> shadows? -> learn the coder -> highlights? -> write -> report
//
// A file whose JND is asked for is several of these (jnd_search.c). Where libaom crashes, the file
// is encoded once more without it (crash.h).
#include <relume/encode.h>

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/params.h"
#include "encode/encode/again.h"
#include "encode/encode/crash.h"
#include "encode/encode/jnd_search.h"
#include "encode/encode/jpeg_model.h"
#include "encode/encode/lossy_choice.h"
#include "encode/encode/moving.h"
#include "encode/encode/request.h"
#include "encode/encode/together.h"
#include "format/coder/coding.h"
#include "format/team/folder.h"

#include <math.h>
#include <sys/stat.h>

// ---------------------------------------------------------------- the coder

// Where the quality is left open, coding errs by 13 dB less than lights between the captured ones
// are missed by, which costs these about 0.1 dB. Captured lights have the usual quality at least,
// or what the coefficients reach.
static const double BELOW_UNSEEN_DB = 13.0, MOST_DB = 46.0, LEAST_COST_DB = 0.3;

// And the file takes at most this share of its photographs as JPEG files.
static const double MOST_OF_JPEG = 0.5;

// By default coding is to take less time than the rest. Seconds of a core: for a byte of the model
// that is coded a few times, for a pixel of a photograph that is read and fitted, for any file.
static const double CODING = 1.5e-6, READING = 0.15e-6, SHORTLY = 2.0;

static double mean_square(double psnr_db)
{
    return pow(10.0, -0.1 * psnr_db);
}

static void settle_quality(struct encode_request *r, const struct relume_decision *decision)
{
    const double usual = fmin(RELUME_USUAL_DB, decision->pooled_db - LEAST_COST_DB);
    const double unseen = decision->unseen_db > 0.0 ? decision->unseen_db : RELUME_USUAL_DB;
    const double coding = fmin(unseen + BELOW_UNSEEN_DB, MOST_DB);
    const double all = mean_square(coding) + mean_square(decision->pooled_db);
    r->pack.domain = RELUME_DOMAIN_DISPLAY;
    r->pack.least_db = usual;
    r->pack.psnr_db = fmax(usual, -10.0 * log10(all));
    r->result.quality_db = r->pack.psnr_db;
    if (r->result.unseen_db == 0.0)
        r->result.unseen_db = decision->unseen_db;
}

static double pixels_of(const relume_capture *capture)
{
    return (double)relume_capture_width(capture) * relume_capture_height(capture) *
           relume_capture_manifest(capture)->views;
}

static relume_status settle_bytes(struct encode_request *r)
{
    double jpeg = 0.0;
    const relume_status status =
        jpeg_model_bytes(&jpeg, r->capture, r->pack.team, r->pack.threads, r->log);
    r->pack.bytes_per_pixel = MOST_OF_JPEG * jpeg / pixels_of(r->capture);
    return status;
}

static bool is_slow(const struct encode_request *r, double bytes)
{
    const double pixels = pixels_of(r->capture);
    const double coded = fmin(bytes, r->pack.bytes_per_pixel * pixels);
    const int lights = relume_capture_manifest(r->capture)->lights;
    return CODING * coded > READING * pixels * lights + SHORTLY;
}

static void stay_lossless(struct encode_request *r, const struct relume_decision *decision)
{
    r->is_open = false;
    r->pack.psnr_db = r->pack.least_db = r->pack.bytes_per_pixel = 0.0;
    r->pack.domain = decision->domain;
    r->pack.storage = decision->storage;
}

// By default these stay lossless: high dynamic range, pictures of linear light, which display
// values would darken between the lamps, and what takes long to code.
static relume_status settle(struct encode_request *r, const relume_coder *coder,
                            const struct relume_decision *decision)
{
    bool keeps = r->is_unasked && (decision->is_hdr || decision->domain != RELUME_DOMAIN_DISPLAY);
    relume_status status = RELUME_OK;
    double bytes = 0.0;
    if (!keeps) {
        settle_quality(r, decision);
        status = settle_bytes(r);
    }
    if (!status && !keeps && r->is_unasked)
        status = lossy_foretell(&bytes, coder, decision->pooled_db, r->capture,
                                r->asked->writer ? NULL : r->path, &r->pack);
    keeps |= !status && is_slow(r, bytes);
    if (keeps)
        stay_lossless(r, decision);
    return status;
}

static relume_status learn(relume_coder **coder, struct encode_request *r)
{
    const struct relume_project_params encode = {.log = r->log,
                                                 .domain = r->pack.domain,
                                                 .display = r->pack.display,
                                                 .storage = r->pack.storage,
                                                 .threads = r->pack.threads,
                                                 .team = r->pack.team};
    struct relume_decision decision;
    relume_status status = RELUME_OK;
    if (request_is_lossy(r) && r->decides) {
        status = lossy_decide(coder, &decision, r->capture, &r->coder, &r->pack);
        return status || !r->is_open ? status : settle(r, *coder, &decision);
    }
    if (request_is_table(r))
        status = relume_coder_between(&r->coder, r->capture, &encode);
    if (status)
        return status;
    if (!r->decides)
        return relume_coder_learn(coder, r->basis, r->capture, &r->coder, &encode);
    status = relume_coder_decide(coder, &decision, r->capture, r->result.quality_db, false,
                                 &r->coder, &encode);
    r->pack.domain = decision.domain;
    r->pack.storage = decision.storage;
    if (r->result.unseen_db == 0.0)
        r->result.unseen_db = decision.unseen_db;
    if (r->result.quality_db == 0.0)
        r->result.quality_db = RELUME_USUAL_DB;
    return status;
}

// Traced shadows are added to flat triangles of the captured lights.
static void fix_interpolant(struct encode_request *r)
{
    if (!r->pack.shadows || r->coder.interpolant)
        return;
    r->coder.interpolant = relume_interpolant_find("delaunay");
    r->coder.choose = false;
}

// ---------------------------------------------------------------- the file

static relume_status pack_encode(struct encode_request *r, const relume_coder *coder)
{
    return relume_pack_encode(r->capture, coder, r->path, &r->result.measured, &r->pack);
}

// Writes even steps, or half floats where these steps are too coarse.
static relume_status write_finely(struct encode_request *r, const relume_coder *coder)
{
    const relume_status status = pack_encode(r, coder);
    if (status || !relume_fidelity_is_coarse(&r->result.measured))
        return status;
    r->pack.storage = RELUME_STORE_HALF;
    return pack_encode(r, coder);
}

// A writer that also learns the size of what is written.
struct counted_writer {
    const struct relume_writer *to;
    double bytes;
};

static bool write_counted(void *user, const void *bytes, size_t size, uint64_t offset)
{
    struct counted_writer *c = user;
    c->bytes = fmax(c->bytes, (double)(offset + size));
    return c->to->write(c->to->user, bytes, size, offset);
}

static bool finish_counted(void *user, bool whole)
{
    const struct counted_writer *c = user;
    return !c->to->finish || c->to->finish(c->to->user, whole);
}

// A writer is written once: what may be encoded twice waits in memory.
static relume_status write_finely_to(struct encode_request *r, const relume_coder *coder,
                                     const struct relume_writer *writer)
{
    struct relume_buffer buffer = {0};
    const struct relume_writer to_memory = relume_buffer_writer(&buffer);
    r->pack.writer = &to_memory;
    relume_status status = write_finely(r, coder);
    if (!status)
        status = outfile_save_to(r->path, writer, buffer.data, buffer.size, r->log);
    relume_buffer_destroy(&buffer);
    return status;
}

static relume_status write_file(struct encode_request *r, const relume_coder *coder)
{
    const bool is_fixed = r->asked->storage || request_is_lossy(r) || r->pack.parts;
    struct counted_writer counted = {r->asked->writer, 0.0};
    const struct relume_writer writer = {write_counted, finish_counted, &counted};
    if (!counted.to)
        return is_fixed ? pack_encode(r, coder) : write_finely(r, coder);
    r->pack.writer = &writer;
    const relume_status status =
        is_fixed ? pack_encode(r, coder) : write_finely_to(r, coder, &writer);
    r->result.file_bytes = counted.bytes;
    return status;
}

// ---------------------------------------------------------------- the report

// The error of the file comes on top of that of the prediction: dB of both.
static double both_errors(double a_db, double b_db)
{
    return -10.0 * log10(pow(10.0, -0.1 * a_db) + pow(10.0, -0.1 * b_db));
}

static double file_bytes(const char *path)
{
    struct stat file;
    return path && !stat(path, &file) && S_ISREG(file.st_mode) ? (double)file.st_size : 0.0;
}

// 0 when one of them is no file.
static double photograph_bytes(const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    double sum = 0.0;
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++) {
            const double bytes = m->view[v].images ? file_bytes(m->view[v].images[i]) : 0.0;
            if (bytes == 0.0)
                return 0.0;
            sum += bytes;
        }
    return sum;
}

static enum relume_reach find_reach(const struct encode_request *r)
{
    const struct relume_encode_result *result = &r->result;
    const double asked_db = r->is_open ? r->pack.least_db : r->pack.psnr_db;
    const double asked = r->is_open ? 0.0 : r->pack.bytes_per_pixel;
    const double psnr_db = result->measured.psnr_db, bytes = result->bytes_per_pixel;
    if (!request_is_lossy(r))
        return r->decides && result->quality_db > psnr_db + 0.5 && result->lights > 1 &&
                       !r->coder.coefficients
                   ? RELUME_REACH_COEFFICIENTS
                   : RELUME_REACHED;
    return asked_db > psnr_db + 0.3                                    ? RELUME_REACH_PSNR_ABOVE
           : asked_db > 0.0 && asked_db < psnr_db - 1.0 && !r->is_open ? RELUME_REACH_PSNR_BELOW
           : asked > 0.0 && bytes > 1.1 * asked                        ? RELUME_REACH_BYTES_BELOW
           : bytes > 0.0 && bytes < 0.7 * asked                        ? RELUME_REACH_BYTES_ABOVE
                                                                       : RELUME_REACHED;
}

static void report_coder(struct encode_request *r, const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_encode_result *out = &r->result;
    out->basis = info->basis;
    out->coefficients = info->coefficients;
    out->joint = info->joint;
    out->lights = info->lights;
    out->views = relume_capture_manifest(r->capture)->views;
    out->lossy = request_is_lossy(r);
}

static void report_file(struct encode_request *r)
{
    struct relume_encode_result *out = &r->result;
    const double pixels =
        (double)out->views * relume_capture_width(r->capture) * relume_capture_height(r->capture);
    out->made = r->pack.learn_only                         ? RELUME_LEARNT_ALL
                : r->asked->team && r->asked->team->member ? RELUME_ENCODED_ELSEWHERE
                : r->asked->parts                          ? RELUME_ENCODED_PART
                                                           : RELUME_ENCODED_FILE;
    out->domain = relume_capture_domain(r->capture, r->pack.domain);
    out->display = relume_encode_curve(r->capture, r->pack.display);
    out->storage = r->pack.storage ? r->pack.storage : RELUME_STORE_8;
    out->is_coarse = (r->asked->storage || r->asked->parts) && !out->lossy &&
                     relume_fidelity_is_coarse(&out->measured);
    if (!r->asked->writer)
        out->file_bytes = file_bytes(r->path);
    out->bytes_per_pixel = out->file_bytes / pixels;
    out->photograph_bytes = photograph_bytes(r->capture);
    if (out->lights == 1)
        out->unseen_db = 0.0;
    if (out->unseen_db > 0.0)
        out->unseen_db = both_errors(out->unseen_db, out->measured.psnr_db);
    out->reach = find_reach(r);
}

// ---------------------------------------------------------------- one capture

// Components that had too few bytes for the least quality: pictures may need fewer.
static relume_status try_pictures(relume_coder **coder, struct encode_request *r)
{
    const double least_db = r->pack.least_db;
    struct relume_decision decision;
    const struct encode_request before = *r;
    r->pack.psnr_db = r->result.quality_db = least_db;
    r->pack.least_db = 0.0;
    relume_coder_destroy(coder);
    relume_status status = lossy_decide(coder, &decision, r->capture, &r->coder, &r->pack);
    r->pack.least_db = least_db;
    if (status || relume_coder_info(*coder)->basis != &relume_basis_table) {
        *r = before;
        return status;
    }
    report_coder(r, *coder);
    return pack_encode(r, *coder);
}

static bool is_short(const struct encode_request *r)
{
    static const double NEAR_DB = 0.3;
    return r->is_open && !r->asked->writer && !r->pack.parts &&
           r->result.measured.psnr_db < r->pack.least_db - NEAR_DB;
}

static relume_status encode_request(struct encode_request *r)
{
    relume_coder *coder = NULL;
    struct relume_image gloss = {0};
    relume_status status = moving_refuse_highlights(r);
    if (!status)  // which may take minutes
        status = moving_decide_shadows(r);
    fix_interpolant(r);
    if (!status)
        status = learn(&coder, r);
    if (!status)  // in the domain that was chosen
        status = moving_decide_highlights(r, &gloss);
    if (!status)
        report_coder(r, coder);
    if (!status && (!r->pack.learn_only || request_has_steps(r)))
        status = r->asked->team ? together_write(r, coder) : write_file(r, coder);
    if (!status && is_short(r))
        status = try_pictures(&coder, r);
    if (!status)
        report_file(r);
    relume_image_destroy(&gloss);
    relume_coder_destroy(&coder);
    return status;
}

// Forms the team of all parts that have the same capture and options.
static relume_status form_team(relume_team_files **files, struct encode_request *r)
{
    char digest[RELUME_DIGEST];
    relume_status status = relume_capture_digest(digest, r->capture, r->log);
    char *about = status ? NULL
                         : mem_format("relume %s, capture %s, options %s", RELUME_VERSION, digest,
                                      r->pack.options);
    if (!status && !about)
        status = RELUME_ENOMEM;
    if (!status)
        status = relume_team_folder(files, r->asked->learnt, r->pack.part - 1, r->pack.parts, about,
                                    r->pack.learn_only, r->log);
    r->pack.team = status ? NULL : relume_team_of_folder(*files);
    mem_free(about);
    return status;
}

static relume_status encode_by_folder(struct encode_request *r)
{
    relume_team_files *files = NULL;
    relume_status status = form_team(&files, r);
    if (!status)
        status = encode_request(r);
    if (r->pack.learn_only && status == RELUME_ECANCEL && relume_team_folder_waits(files)) {
        r->result.made = request_has_steps(r) ? RELUME_LEARNT_STEP : RELUME_LEARNT_SHARE;
        status = RELUME_OK;
    }
    relume_team_folder_destroy(&files);
    return status;
}

// Near lights are resampled where the positions of the pixels are known (capture.h).
static bool ignores_positions(const struct relume_manifest *m)
{
    const enum relume_projection p = m->geometry.projection;
    return m->positions && p != RELUME_PLANAR && (p != RELUME_SLAB || !m->view[0].depth);
}

// Encodes once; `psnr_db` above 0 replaces the PSNR that is asked for.
static relume_status encode_once(const char *path, const relume_capture *capture, double psnr_db,
                                 struct relume_encode_result *result,
                                 const struct relume_encode_capture_params *p)
{
    struct encode_request r;
    request_make(&r, path, capture, p);
    r.pack.psnr_db = psnr_db > 0.0 ? psnr_db : r.pack.psnr_db;
    if (p->learn_only && !request_learns_first(&r) && !request_has_steps(&r)) {
        result->made = RELUME_LEARNT_NOTHING;
        return RELUME_OK;
    }
    if (ignores_positions(relume_capture_manifest(capture)))
        log_line(r.coder.log, RELUME_WARNING, "the lights stand near; they are treated as distant");
    if (p->team) {
        r.pack.team = p->team;
        r.pack.part = p->team->member + 1;
        r.pack.parts = p->team->members;
    }
    const relume_status status = p->learnt ? encode_by_folder(&r) : encode_request(&r);
    *result = r.result;
    return status;
}

static relume_status encode_as_asked(const char *path, const relume_capture *capture,
                                     struct relume_encode_result *result,
                                     const struct relume_encode_capture_params *p)
{
    return p->jnd > 0.0 ? jnd_search(path, capture, result, p, encode_once)
                        : encode_once(path, capture, 0.0, result, p);
}

// Parts agree about how they are coded, and a writer may have got bytes already: these fail.
static relume_status encode_safely(const char *path, const relume_capture *capture,
                                   struct relume_encode_result *result,
                                   const struct relume_encode_capture_params *p)
{
    struct crash_watch watch;
    struct relume_encode_capture_params attempt = *p;
    attempt.log = crash_watch_begin(&watch, p->log);
    const relume_status status = encode_as_asked(path, capture, result, &attempt);
    const bool crashed = status == RELUME_ECODER && !p->parts && !p->team && !p->writer;
    crash_watch_end(&watch, !crashed);
    if (!crashed)
        return status;
    crash_say(&watch, p, capture);
    attempt = crash_params(p);
    *result = (struct relume_encode_result){0};
    const relume_status again = encode_as_asked(path, capture, result, &attempt);
    result->coder_crashed = true;
    return again;
}

relume_status relume_encode_capture(const char *path, const relume_capture *capture,
                                    struct relume_encode_result *result,
                                    const struct relume_encode_capture_params *params)
{
    const struct relume_encode_capture_params p = PARAMS_WORK(relume_encode_capture_params, params);
    struct relume_encode_result own = {0};
    if ((!path && !p.writer) || (p.team && p.writer))
        return RELUME_EINVAL;
    relume_status status = relume_encode_check(&p);
    if (!status)
        status = encode_safely(path, capture, &own, &p);
    if (status)
        own = (struct relume_encode_result){0};
    if (result)
        *result = own;
    return status;
}

// ---------------------------------------------------------------- a file that is coded again

static relume_status check_again(const struct relume_encode_capture_params *p)
{
    if (!p->lossless && !p->jnd && !p->parts && !p->team && !p->learnt && !p->basis &&
        !p->coefficients)
        return relume_encode_check(p);
    return log_fail(p->log, RELUME_EINVAL,
                    "a relume file is coded again with loss, as it is; expected --psnr, "
                    "--bytes-per-pixel, --effort or none of them, and nothing about the model");
}

static relume_status encode_again(struct encode_request *r, relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct again_capture a;
    relume_status status = again_open(&a, pack, r->log);
    r->capture = a.capture;
    r->pack.domain = info->domain;
    r->pack.display = info->display;
    r->pack.writer = r->asked->writer;
    if (r->is_open || !request_is_lossy(r)) {  // no photographs say how good it is to be
        r->is_open = false;
        r->pack.psnr_db = r->result.quality_db = RELUME_LOSSY_DB;
        r->pack.least_db = 0.0;
    }
    if (!r->pack.pyramid)
        r->pack.pyramid = info->levels ? RELUME_PYRAMID_YES : RELUME_PYRAMID_NO;
    if (!status)
        status = again_write(r, &a, pack);
    if (!status) {
        report_coder(r, a.coder);
        report_file(r);
    }
    again_close(&a);
    return status;
}

relume_status relume_encode_again(const char *path, relume_pack *pack,
                                  struct relume_encode_result *result,
                                  const struct relume_encode_capture_params *params)
{
    const struct relume_encode_capture_params p = PARAMS_WORK(relume_encode_capture_params, params);
    struct encode_request r;
    if (!path && !p.writer)
        return RELUME_EINVAL;
    relume_status status = check_again(&p);
    request_make(&r, path, NULL, &p);
    if (!status)
        status = encode_again(&r, pack);
    if (status)
        r.result = (struct relume_encode_result){0};
    if (result)
        *result = r.result;
    return status;
}
