// meso.c - rays and a relief, after parallax occlusion mapping (Tatarchuk 2006): steps of half a
// texel, and between the two around the first crossing the place where the relief is met
#include "material/gbrdf/meso.h"

// Lower rays are traced as if they had this z: they would cross hundreds of texels.
static const double FLATTEST = 0.03;
// No relief is stepped through more often than this; steps are longer then. So both rays of 32
// places stay below the 65535 rounds after which llvmpipe ends the loops of a pixel.
enum { MOST_STEPS = 960, REFINEMENTS = 7 };
// In texels: what rounding leaves of the height of a place on the relief itself.
static const double ABOVE = 0.01;

void meso_settle(struct meso *m)
{
    m->low = m->high = m->z[0];
    for (size_t i = 1; i < (size_t)m->width * (size_t)m->height; i++) {
        m->low = fminf(m->low, m->z[i]);
        m->high = fmaxf(m->high, m->z[i]);
    }
}

double meso_height(const struct meso *m, double x, double y)
{
    const struct bilinear b = bilinear_tiled(x - 0.5, y - 0.5, m->width, m->height);
    return bilinear_value(&b, m->z, 1, 0);
}

// What is passed along (x, y) while z rises by one.
struct run {
    double x, y;
};

static struct run run_of(vec3 d)
{
    const double up = fmax(d.z, FLATTEST);
    return (struct run){d.x / up, -d.y / up};
}

static int steps(double rise, struct run run)
{
    return 1 + (int)fmin(2.0 * rise * hypot(run.x, run.y), MOST_STEPS);
}

static vec3 at_height(double x, double y, struct run run, double z)
{
    return vec3_of(x + z * run.x, y + z * run.y, z);
}

static double above(const struct meso *m, vec3 p)
{
    return p.z - meso_height(m, p.x, p.y);
}

vec3 meso_seen(const struct meso *m, double x, double y, vec3 v)
{
    const struct run run = run_of(v);
    const int n = steps((double)m->high - (double)m->low, run);
    const double step = ((double)m->high - (double)m->low) / n;
    double over = m->high, under = over;
    double gap_under = above(m, at_height(x, y, run, under));
    for (int i = 1; i <= n && gap_under > 0.0; i++) {
        over = under;
        under = (double)m->high - step * i;
        gap_under = above(m, at_height(x, y, run, under));
    }
    // halved, since the relief between is no straight piece
    for (int i = 0; i < REFINEMENTS && gap_under <= 0.0; i++) {
        const double z = 0.5 * (over + under);
        if (above(m, at_height(x, y, run, z)) > 0.0)
            over = z;
        else
            under = z;
    }
    return at_height(x, y, run, under);
}

bool meso_open(const struct meso *m, vec3 from, vec3 d)
{
    const struct run run = run_of(d);
    const double rise = fmax((double)m->high - from.z, 0.0);
    const int n = steps(rise, run);
    for (int i = 1; i <= n; i++) {
        const double up = rise * i / n;
        if (above(m, vec3_of(from.x + up * run.x, from.y + up * run.y, from.z + up)) < -ABOVE)
            return false;
    }
    return true;
}

vec3 meso_normal(const struct meso *m, int x, int y)
{
    static const double smooth[3] = {0.25, 0.5, 0.25};
    double across = 0.0, down = 0.0;
    for (int i = -1; i <= 1; i++) {
        const size_t row = (size_t)index_wrapped(y + i, m->height) * (size_t)m->width;
        const size_t above_row = (size_t)index_wrapped(y - 1, m->height) * (size_t)m->width,
                     below_row = (size_t)index_wrapped(y + 1, m->height) * (size_t)m->width;
        const size_t left = (size_t)index_wrapped(x - 1, m->width),
                     right = (size_t)index_wrapped(x + 1, m->width),
                     column = (size_t)index_wrapped(x + i, m->width);
        across += 0.5 * smooth[i + 1] * ((double)m->z[row + right] - (double)m->z[row + left]);
        down += 0.5 * smooth[i + 1] *
                ((double)m->z[below_row + column] - (double)m->z[above_row + column]);
    }
    return vec3_unit(vec3_of(-across, down, 1.0));
}
