// request.c - the params of relume_encode_capture: checked, and completed by defaults
#include "encode/encode/request.h"

#include "core/base/params.h"
#include "encode/encode/coded.h"

#include <math.h>
#include <string.h>

// About four times what shadows take of a pixel, or highlights.
static const double MIN_SHADOW_BYTES = 1.0, MIN_HIGHLIGHT_BYTES = 0.5;

bool request_is_lossy(const struct encode_request *r)
{
    return encode_is_coded(&r->pack);
}

bool request_is_table(const struct encode_request *r)
{
    return request_is_lossy(r) && !r->decides && r->basis == &relume_basis_table &&
           !r->coder.interpolant && !r->coder.choose;
}

bool request_learns_first(const struct encode_request *r)
{
    return r->basis->learned || r->coder.choose || request_is_table(r);
}

bool request_has_steps(const struct encode_request *r)
{
    return request_is_lossy(r) ||
           (!r->pack.books && r->pack.parts > relume_capture_manifest(r->capture)->views);
}

bool request_is_display(const struct encode_request *r)
{
    return relume_capture_domain(r->capture, r->pack.domain) == RELUME_DOMAIN_DISPLAY;
}

static bool has_bytes_for(const struct encode_request *r, double least)
{
    return !request_is_lossy(r) || r->is_open || r->pack.bytes_per_pixel >= least;
}

// Shadows and highlights do not move together: who asks for highlights has chosen. Without being
// asked for they take no more than some of the bytes.
static void decide_moving(struct encode_request *r)
{
    const struct relume_encode_capture_params *p = r->asked;
    const bool tries = r->decides && p->highlights != RELUME_MOVING_YES;
    r->shadows = p->shadows                                    ? p->shadows
                 : tries && has_bytes_for(r, MIN_SHADOW_BYTES) ? RELUME_MOVING_AUTO
                                                               : RELUME_MOVING_NO;
    r->highlights =
        p->highlights || has_bytes_for(r, MIN_HIGHLIGHT_BYTES) ? p->highlights : RELUME_MOVING_NO;
}

static bool decides(const struct relume_encode_capture_params *p)
{
    return !p->basis && !p->books && !p->robust && !p->luminance;
}

// Less is no photograph, and small anyway.
static const double LEAST_PIXELS = 64.0 * 64.0;

static bool is_small(const relume_capture *capture)
{
    return (double)relume_capture_width(capture) * relume_capture_height(capture) < LEAST_PIXELS;
}

// Nothing says how the planes are stored. Parts may be more than lossy planes have tiles.
static bool is_usual(const struct relume_encode_capture_params *p, const relume_capture *capture)
{
    return !p->lossless && p->quality_db == 0.0 && !p->storage && !p->step && !p->compression &&
           (p->domain == RELUME_DOMAIN_AUTO || p->domain == RELUME_DOMAIN_DISPLAY) &&
           p->display.curve != RELUME_CURVE_LOG && !p->parts && !p->team && capture &&
           !is_small(capture);
}

// An effort alone, or nothing at all, leaves the quality to the photographs, which are known
// later.
static bool is_open(const struct relume_encode_capture_params *p, const relume_capture *capture)
{
    return decides(p) && (p->effort || is_usual(p, capture)) && p->psnr_db == 0.0 &&
           p->bytes_per_pixel == 0.0 && p->jnd == 0.0;
}

// The quality that is asked for. Trials of JND begin with a usual one.
static double wanted_psnr(const struct relume_encode_capture_params *p,
                          const relume_capture *capture)
{
    const bool alone = p->effort && p->psnr_db == 0.0 && p->bytes_per_pixel == 0.0;
    return p->jnd > 0.0 || is_open(p, capture) ? RELUME_USUAL_DB
           : alone                             ? RELUME_LOSSY_DB
                                               : p->psnr_db;
}

static bool asks_for_loss(const struct relume_encode_capture_params *p)
{
    return p->psnr_db > 0.0 || p->bytes_per_pixel > 0.0 || p->jnd > 0.0 || p->effort;
}

void request_make(struct encode_request *out, const char *path, const relume_capture *capture,
                  const struct relume_encode_capture_params *p)
{
    *out = (struct encode_request){
        .asked = p,
        .path = path,
        .capture = capture,
        .log = p->log,
        .basis = p->basis ? p->basis : &relume_basis_pca,
        .coder = {.coefficients = p->coefficients,
                  .ridge = p->ridge,
                  .no_ridge = p->no_ridge,
                  .choose = !p->interpolant && (p->choose_interpolant || !p->basis),
                  .interpolant = p->interpolant,
                  .luminance = p->luminance,
                  .robust = p->robust,
                  .force = p->force},
        .pack = {.log = p->log,
                 .domain = p->domain,
                 .display = p->display,
                 .storage = p->storage,
                 .step = p->step,
                 .compression = p->compression,
                 .pyramid = p->pyramid,
                 .no_depth = p->no_depth,
                 .psnr_db = wanted_psnr(p, capture),
                 .bytes_per_pixel = p->bytes_per_pixel,
                 .effort = p->effort,
                 .share = p->share,
                 .writer = p->writer,
                 .part = p->part,
                 .parts = p->parts,
                 .options = p->options ? p->options : "",
                 .free_storage = !p->storage,
                 .learn_only = p->learn_only,
                 .threads = p->threads},
        .decides = decides(p),
        .is_open = is_open(p, capture),
    };
    out->is_unasked = out->is_open && !p->effort;
    if (out->is_open)
        out->pack.least_db = RELUME_USUAL_DB;
    out->coder.log = log_at(&out->about, p->log, "%s: ", p->name ? p->name : "the capture");
    if (p->books) {
        out->books = PARAMS(relume_books_params, p->books);
        out->books.log = out->coder.log;
        out->pack.books = &out->books;
    }
    if (request_is_lossy(out) && !out->is_unasked && out->pack.domain == RELUME_DOMAIN_AUTO)
        out->pack.domain = RELUME_DOMAIN_DISPLAY;
    decide_moving(out);
    out->result.quality_db = p->jnd > 0.0              ? 0.0
                             : out->pack.psnr_db > 0.0 ? out->pack.psnr_db
                                                       : p->quality_db;
}

bool relume_encode_rereads(const struct relume_encode_capture_params *params)
{
    const struct relume_encode_capture_params p = PARAMS(relume_encode_capture_params, params);
    struct encode_request r;
    request_make(&r, NULL, NULL, &p);
    return request_learns_first(&r) || p.jnd > 0.0;
}

// ---------------------------------------------------------------- checks

struct number_range {
    const char *option;
    double value, least, most;
};

// 0 is the default of all of them.
static relume_status check_ranges(const struct relume_encode_capture_params *p)
{
    const struct number_range range[] = {
        {"--coefficients", p->coefficients, 1, RELUME_MOST_COEFFICIENTS},
        {"--quality", p->quality_db, 10, 60},
        {"--psnr", p->psnr_db, 10, 60},
        {"--bytes-per-pixel", p->bytes_per_pixel, 1e-3, 100},
        {"--jnd", p->jnd, 0.05, 100},
        {"--ridge", p->ridge, 0, 1},
    };
    for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
        const struct number_range *r = &range[i];
        if (r->value != 0.0 && !(r->value >= r->least && r->value <= r->most))
            return log_fail(p->log, RELUME_EINVAL, "%s: expected %g to %g; found %g", r->option,
                            r->least, r->most, r->value);
    }
    return RELUME_OK;
}

static relume_status check_loss(const struct relume_encode_capture_params *p)
{
    const bool jnd = p->jnd > 0.0, psnr = p->psnr_db > 0.0, bytes = p->bytes_per_pixel > 0.0;
    if (!asks_for_loss(p))
        return RELUME_OK;
    if (p->lossless)
        return log_fail(p->log, RELUME_EINVAL,
                        "--lossless keeps what lossy planes lose; expected without --psnr, --jnd, "
                        "--bytes-per-pixel and --effort");
    if (p->books || p->storage || p->step || p->compression || p->quality_db > 0.0 ||
        (psnr && bytes))
        return log_fail(
            p->log, RELUME_EINVAL,
            "--psnr, --bytes-per-pixel and --effort choose bits, step and compression; "
            "expected one of the first two, without --bits, --step, --compression, --quality and "
            "--codebook");
    if (jnd && (psnr || bytes || p->parts || p->learnt || p->team))
        return log_fail(p->log, RELUME_EINVAL,
                        "--jnd encodes several times and compares; expected without --psnr, "
                        "--bytes-per-pixel, and of one process");
    if (p->display.curve == RELUME_CURVE_LOG)
        return log_fail(p->log, RELUME_EINVAL,
                        "--psnr and --bytes-per-pixel are about what a screen shows; expected "
                        "them without --domain log");
    return RELUME_OK;
}

static relume_status check_parts(const struct relume_encode_capture_params *p)
{
    if (p->team && (p->parts || p->learnt || p->learn_only))
        return log_fail(p->log, RELUME_EINVAL,
                        "relume-mpi makes the parts, and joins them; expected without --part, "
                        "--commands and --learnt");
    if (p->learn_only && !p->learnt)
        return log_fail(p->log, RELUME_EINVAL,
                        "--learn-only: expected --learnt FOLDER, where the share is left");
    if (p->learnt && !p->parts)
        return log_fail(p->log, RELUME_EINVAL,
                        "--learnt is what parts share; expected --part or --commands with it");
    if (p->parts && (p->part < 1 || p->part > p->parts))
        return log_fail(p->log, RELUME_EINVAL, "--part: expected part 1 to %d of %d; found %d",
                        p->parts, p->parts, p->part);
    if (p->learnt && p->options && strchr(p->options, '\n'))
        return log_fail(p->log, RELUME_EINVAL,
                        "--learnt keeps what was asked for in one line; expected options without "
                        "line breaks");
    if (p->books && p->share && !p->learnt && p->parts)
        return log_fail(p->log, RELUME_EINVAL,
                        "--share learns one set of codebooks from all views; expected --learnt "
                        "FOLDER, where the parts share what it is learnt from");
    return RELUME_OK;
}

relume_status relume_encode_check(const struct relume_encode_capture_params *params)
{
    const struct relume_encode_capture_params p = PARAMS(relume_encode_capture_params, params);
    relume_status status = check_ranges(&p);
    if (!status && p.quality_db > 0.0 &&
        (p.basis || p.coefficients || p.books || p.robust || p.luminance))
        status = log_fail(p.log, RELUME_EINVAL,
                          "--quality chooses the coefficients of basis auto; expected without "
                          "--basis, --coefficients, --codebook and --robust");
    if (!status)
        status = check_loss(&p);
    return status ? status : check_parts(&p);
}
