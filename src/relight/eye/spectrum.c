// spectrum.c - wavelengths as taps of the chromatic sum (Ritschel 2009, 8.4.3)
//
// Colour matching functions: Wyman, Sloan, Shirley 2013, "Simple analytic approximations to the CIE
// XYZ color matching functions", Eq. 4: within 1 % of the CIE 1931 observer.
#include <relume/relight/psf.h>

#include "core/base/log.h"
#include "relight/eye/pattern.h"
#include "relight/eye/psf.h"

#include <math.h>

static const double from_nm = 380.0, to_nm = 770.0;

static double lobe(double nm, double middle, double below, double above)
{
    const double t = (nm - middle) * (nm < middle ? below : above);
    return exp(-0.5 * t * t);
}

static void match(double xyz[3], double nm)
{
    xyz[0] = 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
             0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
    xyz[1] = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
    xyz[2] = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
}

// Planck's law up to a factor; second radiation constant 1.4388e7 nm K.
static double black_body(double nm, double kelvin)
{
    return pow(nm / PSF_NM, -5.0) / expm1(1.4388e7 / (nm * kelvin));
}

static void to_rgb(double rgb[3], const double xyz[3])
{
    static const double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                   {-0.9692660, 1.8760108, 0.0415560},
                                   {0.0556434, -0.2040259, 1.0572252}};
    for (int c = 0; c < 3; c++)
        rgb[c] = m[c][0] * xyz[0] + m[c][1] * xyz[1] + m[c][2] * xyz[2];
}

// Equal ratios from tap to tap keep the smear between them the same everywhere.
static double wavelength(const struct relume_psf_params *p, int i, int n)
{
    if (n == 1)
        return PSF_NM;
    return p->literal ? from_nm + i * (to_nm - from_nm) / n
                      : from_nm * pow(to_nm / from_nm, (i + 0.5) / n);
}

relume_status relume_psf_spectrum(struct relume_psf_spectrum *out,
                                  const struct relume_psf_params *params)
{
    struct relume_psf_params p;
    *out = (struct relume_psf_spectrum){0};
    const relume_status status = psf_defaults(&p, params);
    if (status)
        return status;
    const int n = p.wavelengths;
    double weight[RELUME_PSF_MOST_TAPS][3], sum[3] = {0.0};
    for (int i = 0; i < n; i++) {
        const double nm = wavelength(&p, i, n), scale = PSF_NM / nm;
        double xyz[3];
        match(xyz, nm);
        // Equal ratios mean widths that grow with the wavelength.
        const double light = p.temperature_k > 0.0 ? black_body(nm, p.temperature_k) : 1.0;
        for (int k = 0; k < 3; k++)
            xyz[k] *= light * (p.literal ? 1.0 : nm);
        to_rgb(weight[i], xyz);
        for (int c = 0; c < 3; c++) {
            weight[i][c] = n == 1 ? 1.0 : weight[i][c];
            sum[c] += weight[i][c] * (p.literal ? 1.0 / (scale * scale) : 1.0);
        }
        out->tap[i].scale = (float)scale;
    }
    for (int i = 0; i < n; i++) {
        const double scale = (double)out->tap[i].scale;
        for (int c = 0; c < 3; c++)
            out->tap[i].rgb[c] = (float)(weight[i][c] / sum[c] * (p.literal ? 1.0 : scale * scale));
    }
    out->taps = n;
    // A needle at half the field's radius moves by about a texel between the fine scales.
    const double ratio = pow(to_nm / from_nm, 1.0 / n);
    out->fines = p.literal || n == 1 ? 1 : n >= 128 ? 2 : 4;
    for (int j = 0; j < out->fines; j++)
        out->fine[j] = (float)pow(ratio, (j + 0.5) / out->fines - 0.5);
    return RELUME_OK;
}
