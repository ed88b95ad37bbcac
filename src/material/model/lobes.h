// lobes.h - sums of powers of cosines (Lafortune et al. 1997) fitted to samples by
// Levenberg-Marquardt:  y_i ~ w_i sum_j max(0, t_j . d_i)^n_j
#ifndef BTF_MODEL_LOBES_H
#define BTF_MODEL_LOBES_H

#include "material/model/model.h"

struct lobe {
    double t[3];  // its length to the n-th power is the lobe's height
    double n;
};

// Exponents stay between these. Below the lower one a lobe is a step at its horizon; above the
// upper one it is narrower than any captured set of lights resolves.
static const double LOBE_LEAST_N = 0.4, LOBE_MOST_N = 64.0;

static inline double lobe_at(const struct lobe *lobe, const double d[3])
{
    const double s = lobe->t[0] * d[0] + lobe->t[1] * d[1] + lobe->t[2] * d[2];
    return s > 1e-9 ? exp(lobe->n * log(s)) : 0.0;
}

struct lobe_samples {
    const double (*d)[3];
    const double *w, *y;  // w NULL: all 1
    int n;
};
// Improve `lobe[count]` from where they are; count <= MODEL_LOBES. Returns the squared error.
double lobes_fit(struct lobe *lobe, int count, const struct lobe_samples *samples);

// A lobe of exponent `n` along the unit vector `d`, `height` high.
struct lobe lobe_along(const double d[3], double n, double height);
// Lower the lobe where it would stand higher than `most`: between samples nothing else holds it.
void lobe_limit(struct lobe *lobe, double most);

#endif
