// legacy_jpeg.c - .ptm of JPEG planes: of a quality, or searched for a size or a PSNR
//
// Bytes and decibels fall with the quantisers' step, so the step is found by halving the interval
// of its logarithm that the qualities span.
#include "exchange/foreign/measure.h"
#include "exchange/formats/export.h"
#include "exchange/formats/legacy.h"
#include "exchange/formats/ptm.h"
#include "exchange/formats/web_step.h"

#include "core/base/log.h"
#include "core/base/outfile.h"
#include "image/image/jpeg.h"

#include <math.h>

// The finest: beyond what a file can say of itself, where every step is one code.
enum { COARSEST = 1, BEST_SAID = 100, FINEST = 140, HALVINGS = 9 };

struct trial {
    struct ptm_jpeg file;
    double bytes_per_pixel, psnr_db;
};

// The file says the whole quality that is nearest to the step's.
static relume_status try_quality(struct trial *t, const struct foreign *f, const struct export *e,
                                 double quality)
{
    const struct relume_export_params *p = e->params;
    const double step = web_step_of_quality(BEST_SAID) * exp2((BEST_SAID - quality) / 10.0);
    *t = (struct trial){.psnr_db = 0.0};
    relume_status status =
        ptm_encode_jpeg(&t->file, f, step, (int)lround(fmin(quality, BEST_SAID)), p->threads);
    if (status)
        return status;
    struct foreign decoded = *f;
    decoded.codes = t->file.codes;
    t->bytes_per_pixel = (double)t->file.size / (double)foreign_pixels(f);
    status = measure_psnr(&t->psnr_db, &decoded, e->source, NULL, p->threads);
    if (status)
        ptm_jpeg_free(&t->file);
    return status;
}

static bool is_good(const struct trial *t, const struct relume_export_params *p)
{
    return p->psnr_db > 0.0 ? t->psnr_db >= p->psnr_db : t->bytes_per_pixel <= p->bytes_per_pixel;
}

static relume_status out_of_reach(const struct trial *t, const struct export *e, const char *path)
{
    const struct relume_export_params *p = e->params;
    if (p->psnr_db > 0.0)
        return log_fail(e->log, RELUME_EUNFIT,
                        "%s: %g dB cannot be reached in this format; the best is %.2f dB", path,
                        p->psnr_db, t->psnr_db);
    return log_fail(e->log, RELUME_EUNFIT,
                    "%s: %g bytes a pixel is too small; the smallest possible is %.3f", path,
                    p->bytes_per_pixel, t->bytes_per_pixel);
}

// The coarsest quality that has the PSNR, or the finest that is small enough: first the one that is
// most likely to do at all, then halves.
static relume_status search(struct trial *best, const struct foreign *f, const struct export *e,
                            const char *path)
{
    const bool psnr = e->params->psnr_db > 0.0;
    double good = psnr ? FINEST : COARSEST, bad = psnr ? COARSEST : FINEST;
    relume_status status = try_quality(best, f, e, good);
    if (!status && !is_good(best, e->params)) {
        status = out_of_reach(best, e, path);
        ptm_jpeg_free(&best->file);
    }
    for (int i = 0; !status && i < HALVINGS; i++) {
        struct trial t;
        const double quality = 0.5 * (good + bad);
        status = try_quality(&t, f, e, quality);
        if (!status && !log_progress(e->log, "trials", (i + 1.0) / HALVINGS))
            status = RELUME_ECANCEL;
        const bool better = !status && is_good(&t, e->params);
        *(better ? &good : &bad) = quality;
        ptm_jpeg_free(better || status ? &best->file : &t.file);
        if (better)
            *best = t;
        else if (status)
            ptm_jpeg_free(&t.file);
    }
    return status;
}

bool legacy_wants_jpeg(const struct relume_export_params *p)
{
    return p->quality > 0 || p->bytes_per_pixel > 0.0 || p->psnr_db > 0.0;
}

relume_status legacy_check_jpeg(const struct export *e, const char *path,
                                enum relume_exchange format)
{
    const struct relume_codes *codes = e->source->codes;
    if (format == RELUME_EXCHANGE_RTI)
        return log_fail(e->log, RELUME_EINVAL, "quality: .rti cannot hold JPEG; use ptm or lptm");
    if (codes->width > JPEG_MOST_SIDE || codes->height > JPEG_MOST_SIDE)
        return log_fail(e->log, RELUME_ELIMIT, "%s: %d x %d pixels; expected at most %d for JPEG",
                        path, codes->width, codes->height, JPEG_MOST_SIDE);
    return RELUME_OK;
}

relume_status legacy_write_jpeg(const struct foreign *f, const struct export *e, const char *path,
                                struct relume_export_report *report)
{
    const int quality = e->params->quality;
    struct trial best;
    relume_status status = quality ? try_quality(&best, f, e, quality) : search(&best, f, e, path);
    if (status)
        return status;
    status = outfile_save_to(path, e->params->writer, best.file.bytes, best.file.size, e->log);
    report->bytes_per_pixel = best.bytes_per_pixel;
    report->psnr_db = best.psnr_db;
    report->exact = false;
    ptm_jpeg_free(&best.file);
    if (!status && f->width % 8)
        log_line(e->log, RELUME_WARNING,
                 "%s: width %d is not a multiple of 8; RTIViewer may show the JPEG planes wrongly",
                 path, f->width);
    return status;
}
