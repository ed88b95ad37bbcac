// dipole.c - Jensen, Marschner, Levoy and Hanrahan 2001, "A practical model for subsurface light
// transport": light that enters is a source one mean free path below the surface, and the boundary
// an image of it above, of the other sign
//
//     R_d(r) = alpha' / (4 pi) sum over both of  z (1 + sigma_tr d) exp(-sigma_tr d) / d^3,
//     d^2 = r^2 + z^2
//
// whose integral over a disc has a closed form, as the integral over r of one term is
// -z exp(-sigma_tr d) / d. Distances are those between the two points, on whatever surface: the
// distances from sources put below a curved one may be 0.
#include "world/transport/dipole.h"

#include <math.h>

double dipole_passes(double index, double cosine)
{
    const double c = fmin(fabs(cosine), 1.0), s = sqrt(1.0 - c * c) / index;
    const double within = sqrt(fmax(1.0 - s * s, 0.0));
    const double across = (c - index * within) / (c + index * within);
    const double along = (within - index * c) / (within + index * c);
    return c > 0.0 ? 1.0 - 0.5 * (across * across + along * along) : 0.0;
}

// Over all directions, each by its cosine.
static double passes_on_average(double index)
{
    enum { STEPS = 256 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        sum += dipole_passes(index, sqrt((i + 0.5) / STEPS)) / STEPS;
    return sum;
}

static double distance_of(const struct dipole *d, double place)
{
    const double t = place / DIPOLE_STEPS;
    return t < 1.0 ? d->half * t / (1.0 - t) : INFINITY;
}

void dipole_make(struct dipole *out, const struct scattering *s, double mm)
{
    const double n = (double)s->index;
    // what an even light inside meets of the boundary: Egan and Hilgeman's fit
    const double inside = -1.440 / (n * n) + 0.710 / n + 0.668 + 0.0636 * n;
    const double edge = (1.0 + inside) / (1.0 - inside);
    *out = (struct dipole){.index = n, .enters = passes_on_average(n), .half = INFINITY};
    for (int c = 0; c < 3; c++) {
        const double absorbed = (double)s->absorption[c] * mm;
        const double scattered = (double)s->reduced[c] * mm, all = absorbed + scattered;
        out->albedo[c] = scattered / all;
        out->falloff[c] = sqrt(3.0 * absorbed * all);
        out->below[c] = 1.0 / all;
        out->above[c] = (1.0 + 4.0 / 3.0 * edge) / all;
        out->half = fmin(out->half, 4.0 * out->below[c]);
    }
    for (int i = 0; i <= DIPOLE_STEPS; i++)
        for (int c = 0; c < 3; c++)
            out->near[i][c] = (float)dipole_exact(out, c, distance_of(out, i));
}

static double of_source(double z, double falloff, double distance)
{
    const double d = sqrt(distance * distance + z * z);
    return z * (1.0 + falloff * d) * exp(-falloff * d) / (d * d * d);
}

double dipole_exact(const struct dipole *d, int colour, double distance)
{
    if (!(distance < INFINITY))
        return 0.0;
    return d->albedo[colour] / (4.0 * M_PI) *
           (of_source(d->below[colour], d->falloff[colour], distance) +
            of_source(d->above[colour], d->falloff[colour], distance));
}

void dipole_at(float rgb[3], const struct dipole *d, double distance)
{
    const double place = DIPOLE_STEPS * (distance / (distance + d->half));
    const int i = (int)place;
    const float part = (float)(place - i);
    for (int c = 0; c < 3; c++)
        rgb[c] = d->near[i][c] + part * (d->near[i + 1][c] - d->near[i][c]);
}

static double of_disc(double z, double falloff, double radius)
{
    const double d = sqrt(radius * radius + z * z);
    return exp(-falloff * z) - (d < INFINITY ? z / d * exp(-falloff * d) : 0.0);
}

double dipole_disc(const struct dipole *d, int colour, double radius)
{
    return 0.5 * d->albedo[colour] *
           (of_disc(d->below[colour], d->falloff[colour], radius) +
            of_disc(d->above[colour], d->falloff[colour], radius));
}
