// report.c - views as a whole: how well they were encoded, who encodes which
#include "core/base/log.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"

#include <math.h>

static void add_census(struct relume_census *sum, const struct relume_census *c)
{
    sum->pixels += c->pixels;
    sum->black += c->black;
    sum->clipped += c->clipped;
    sum->always_clipped += c->always_clipped;
    sum->repaired += c->repaired;
    sum->black_images += c->black_images;
}

struct relume_fidelity fidelity_mean(const struct relume_fidelity *view, int views)
{
    struct relume_fidelity sum = {0};
    for (int i = 0; i < views; i++) {
        sum.fit_rms += view[i].fit_rms * view[i].fit_rms / views;
        sum.store_rms += view[i].store_rms * view[i].store_rms / views;
        sum.steps_rms += view[i].steps_rms * view[i].steps_rms / views;
        sum.typical += view[i].typical / views;
        sum.psnr_db += view[i].psnr_db / views;
        add_census(&sum.census, &view[i].census);
    }
    sum.fit_rms = sqrt(sum.fit_rms);
    sum.store_rms = sqrt(sum.store_rms);
    sum.steps_rms = sqrt(sum.steps_rms);
    return sum;
}

// Codes are even steps up to the brightest value: a lamp in the picture of HDR radiance leaves the
// rest few of them.
bool relume_fidelity_is_coarse(const struct relume_fidelity *report)
{
    static const double COARSE = 0.05;  // photographs of 8 bits lose a hundredth of this
    const double lost = report->typical > 0.0 ? report->steps_rms / report->typical : 0.0;
    return lost >= COARSE && report->steps_rms >= report->fit_rms;
}

// The first of `parts` parts that is of view `v` or of one behind it.
static int first_part(int v, int parts, int views)
{
    return (int)((int64_t)parts * v / views);
}

// Where there are enough of them parts hold whole blocks of the file, which join then copies.
static bool share_rows(struct encode_share *out, int part, int parts, int views, int height)
{
    int v = 0;
    while (first_part(v + 1, parts, views) < part)
        v++;
    const int before = first_part(v, parts, views);
    const int64_t of = first_part(v + 1, parts, views) - before, i = part - 1 - before;
    const int blocks = (height + ENCODE_BLOCK - 1) / ENCODE_BLOCK;
    const int unit = of <= blocks ? ENCODE_BLOCK : BAND_ROWS;
    const int units = (height + unit - 1) / unit;
    const int first = (int)(units * i / of), end = (int)(units * (i + 1) / of);
    *out = (struct encode_share){.first = v, .views = 1, .row = first * unit};
    out->rows = (end < units ? end * unit : height) - out->row;
    return true;
}

bool encode_share_of(struct encode_share *out, int part, int parts, int views, int height)
{
    if ((int64_t)parts > (int64_t)views * ((height + BAND_ROWS - 1) / BAND_ROWS))
        return false;
    if (parts > views)
        return share_rows(out, part, parts, views, height);
    out->first = (int)((int64_t)views * (part - 1) / parts);
    out->views = (int)((int64_t)views * part / parts) - out->first;
    out->row = out->rows = 0;
    return true;
}

relume_status encode_share_find(struct encode_share *out, int part, int parts,
                                const relume_capture *capture, const struct relume_log *log)
{
    const int views = relume_capture_manifest(capture)->views;
    const int height = relume_capture_height(capture);
    if (encode_share_of(out, part, parts, views, height))
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT,
                    "%d views of %d rows cannot be shared by %d parts; expected 16 rows or more "
                    "for each",
                    views, height, parts);
}
