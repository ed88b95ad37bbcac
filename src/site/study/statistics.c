// statistics.c - distributions that studies ask for
#include "site/study/statistics.h"

#include <relume/site/study.h>

#include <math.h>

// Of even degrees the Poisson sum, of odd ones the normal tail and its recurrence (Abramowitz,
// Stegun 1964, 26.4.4, 26.4.5).
double relume_study_chi_squared_p(double x, int freedom)
{
    if (!(x > 0.0))
        return 1.0;
    const bool odd = freedom % 2;
    double term = odd ? sqrt(2.0 * x / 3.14159265358979323846) * exp(-0.5 * x) : exp(-0.5 * x);
    double sum = odd ? erfc(sqrt(0.5 * x)) : term;
    for (int k = odd ? 3 : 4; k <= freedom; k += 2) {
        if (odd) {
            sum += term;
            term *= x / k;
        } else {
            term *= x / (k - 2);
            sum += term;
        }
    }
    return fmin(sum, 1.0);
}

// The distribution rises: halved until doubles end.
double relume_study_normal_z(double p)
{
    double low = -40.0, high = 40.0;
    for (int i = 0; i < 80; i++) {
        const double z = 0.5 * (low + high);
        if (0.5 * erfc(-z / sqrt(2.0)) < p)
            low = z;
        else
            high = z;
    }
    return 0.5 * (low + high);
}
