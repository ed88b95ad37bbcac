// report.c - how well views were encoded, all together
#include "coder/coefficients.h"

#include <math.h>

static void add_census(struct relume_encode_census *sum, const struct relume_encode_census *c)
{
    sum->pixels += c->pixels;
    sum->black += c->black;
    sum->clipped += c->clipped;
    sum->always_clipped += c->always_clipped;
    sum->repaired += c->repaired;
    sum->black_images += c->black_images;
}

struct relume_encode_report encode_report_mean(const struct relume_encode_report *view, int views)
{
    struct relume_encode_report sum = {0};
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
bool relume_encode_is_coarse(const struct relume_encode_report *report)
{
    static const double COARSE = 0.05;  // photographs of 8 bits lose a hundredth of this
    const double lost = report->typical > 0.0 ? report->steps_rms / report->typical : 0.0;
    return lost >= COARSE && report->steps_rms >= report->fit_rms;
}
