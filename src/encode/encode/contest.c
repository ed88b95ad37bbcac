// contest.c - components against pictures, by a model of some rows of a view
#include "encode/encode/contest.h"

#include "core/math/scalar.h"
#include "encode/encode/rate_model.h"
#include "format/coder/basis.h"
#include "format/coder/coefficients.h"
#include "format/team/array.h"

#include <math.h>
#include <string.h>

// Rows of the middle view that are looked at.
enum { ROWS = 64 };
static const enum av1_preset_number LOOKED_AT = AV1_REALTIME_9;

// A view of pictures is decoded whole to relight it once. In large views that is waited for,
// and pictures are to take half of the bytes.
static const double MANY_PIXELS = 1e6, WAITING = 2.0;

// A number of the functions, as text in the header (format/pack/functions.h), takes about six bits.
static const double BYTES_EACH = 0.75;

// What half the bytes cost beyond the finest quantiser, in dB.
static const double EACH_HALF = 5.0;

// Components and pictures.
struct contest {
    const relume_coder *coder[2];
    double fit[2];
    const relume_capture *capture;
    const struct relume_pack_encode_params *p;
    const struct relume_project_params *encode;
    struct rate_curve curve[2];
    int member;
    struct rate_curve made[2];  // by the first member, for all
};

static double pixels_of(const relume_capture *capture)
{
    return (double)relume_capture_width(capture) * relume_capture_height(capture);
}

// A view's share of the functions.
static double header_bytes(const relume_coder *coder, int views)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    return info->basis->joint ? 3.0 * info->coefficients * info->functions * BYTES_EACH / views
                              : 0.0;
}

// The curve of a view by its middle rows.
static relume_status look(struct rate_curve *out, const relume_coder *coder,
                          const struct contest *c)
{
    const int view = relume_capture_manifest(c->capture)->views / 2;
    const int height = relume_capture_height(c->capture), rows = smaller_of(ROWS, height);
    const int row = (height - rows) / 2 / BAND_ROWS * BAND_ROWS;
    relume_coefficients *some = NULL;
    relume_status status = project_some_rows(&some, coder, c->capture, view, row, rows, c->encode);
    if (!status)
        status = coefficients_share_steps(&some, 1, false, c->encode->step);
    if (!status)
        status = rate_model_curve(out, some, row, rows, c->capture, av1_presets[LOOKED_AT].bits,
                                  c->encode->threads);
    for (int i = 0; !status && i < RATE_POINTS; i++)
        out->bytes[i] *= (double)height / rows;
    relume_coefficients_destroy(&some);
    return status;
}

static relume_status begin_look(void *context, int member)
{
    struct contest *c = context;
    c->member = member;
    memset(c->made, 0, sizeof c->made);
    return RELUME_OK;
}

static relume_status look_at_both(void *context)
{
    struct contest *c = context;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && c->member == 0 && i < 2 && c->coder[i]; i++)
        status = look(&c->made[i], c->coder[i], c);
    return status;
}

static relume_status keep_curves(void *context)
{
    struct contest *c = context;
    if (c->member == 0)
        memcpy(c->curve, c->made, sizeof c->curve);
    return RELUME_OK;
}

static relume_status look_together(struct contest *c)
{
    static const struct team_work work = {begin_look, look_at_both, keep_curves};
    struct team_array made = {c->made, sizeof c->made};
    return team_share(c->p->team, "look", &work, c, &team_array_bytes, &made, c->p->log);
}

// The bytes of a view at the PSNR that is asked for.
static double bytes_at(double *error, const struct contest *c, int i)
{
    const struct rate_curve *curve = &c->curve[i];
    const double wanted = pow(10.0, -0.1 * c->p->psnr_db);
    const double q = rate_curve_find_error(curve, fmax(wanted - c->fit[i], 0.0));
    *error = rate_curve_error(curve, q) + c->fit[i];
    return rate_curve_bytes(curve, q);
}

// How good one of them is at the target: minus the decibels that its bytes are worth; or, where
// bytes are asked for, its PSNR.
static double merit_of(const struct contest *c, int i)
{
    const struct rate_curve *curve = &c->curve[i];
    const double header = header_bytes(c->coder[i], relume_capture_manifest(c->capture)->views);
    const bool waits =
        i == 1 && pixels_of(c->capture) > MANY_PIXELS && c->p->effort != RELUME_EFFORT_SMALLEST;
    const double weight = waits ? WAITING : 1.0;
    if (c->p->psnr_db > 0.0) {
        double error;
        const double own = bytes_at(&error, c, i);
        const double missing = fmax(c->p->psnr_db - decibels(error), 0.0);
        return -EACH_HALF * log2(weight * (own + header)) - missing;
    }
    const double bytes = fmax(c->p->bytes_per_pixel * pixels_of(c->capture) - header, 1.0);
    const double q = rate_curve_find_bytes(curve, bytes / weight);
    return decibels(rate_curve_error(curve, q) + c->fit[i]);
}

relume_status contest_keep_better(relume_coder **out, relume_coder *pictures, double fit,
                                  const relume_capture *capture,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_project_params *encode)
{
    struct contest c = {
        .coder = {*out, pictures}, .fit = {fit, 0.0}, .capture = capture, .p = p, .encode = encode};
    const relume_status status = look_together(&c);
    if (!status && merit_of(&c, 1) > merit_of(&c, 0)) {
        relume_coder *const components = *out;
        *out = pictures;
        pictures = components;
    }
    relume_coder_destroy(&pictures);
    if (status)
        relume_coder_destroy(out);
    return status;
}

relume_status contest_foretell(double *bytes, const relume_coder *coder, double fit,
                               const relume_capture *capture,
                               const struct relume_pack_encode_params *p,
                               const struct relume_project_params *encode)
{
    struct contest c = {
        .coder = {coder, NULL}, .fit = {fit, 0.0}, .capture = capture, .p = p, .encode = encode};
    double error = 0.0;
    const relume_status status = look_together(&c);
    *bytes = status ? 0.0 : bytes_at(&error, &c, 0) * relume_capture_manifest(capture)->views;
    return status;
}
