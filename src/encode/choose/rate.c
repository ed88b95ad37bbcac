// rate.c - what is worth choosing among points of rate and quality
#include <relume/encode/heldout.h>

#include <math.h>

static bool is_point(double rate, double quality)
{
    return rate > 0.0 && isfinite(rate) && isfinite(quality);
}

// The point with which the hull goes on after `from`: the steepest way up; of several on one line
// the nearest. -1 when no point is better.
static int next_on_hull(const double *rate, const double *quality, int n, int from)
{
    int best = -1;
    double best_slope = 0.0;
    for (int i = 0; i < n; i++) {
        if (!is_point(rate[i], quality[i]) || quality[i] <= quality[from] || rate[i] <= rate[from])
            continue;
        const double slope = (quality[i] - quality[from]) / log(rate[i] / rate[from]);
        if (best < 0 || slope > best_slope || (slope == best_slope && rate[i] < rate[best])) {
            best = i;
            best_slope = slope;
        }
    }
    return best;
}

void relume_rate_hull(bool *on_hull, const double *rate, const double *quality, int n)
{
    int first = -1;
    for (int i = 0; i < n; i++) {
        on_hull[i] = false;
        if (is_point(rate[i], quality[i]) &&
            (first < 0 || rate[i] < rate[first] ||
             (rate[i] == rate[first] && quality[i] > quality[first])))
            first = i;
    }
    for (int i = first; i >= 0; i = next_on_hull(rate, quality, n, i))
        on_hull[i] = true;
}
