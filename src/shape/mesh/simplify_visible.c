// simplify_visible.c - from how far away a turned normal is seen (Guthe 2008, sections 10.2, 10.3)
//
// The shading of a point is a function of how its surface is turned against eye and light. On the
// scale of just noticeable differences it is a sum of spherical harmonics over the normals that
// face the eye; where it is not known the smoothest ones are taken, min sum |c|^2 l^2. (The thesis
// divides by f^2; that overshoots where nothing is known.) The light turns about the eye's axis,
// which only turns the phases of m, so that a degree's amplitude holds for all of its azimuths; of
// elevations the largest counts.
//
// A harmonic of degree l turned by `angle` differs by at most a sqrt(2 - 2 cos(l angle)); those of
// all degrees add up as squares. How fine the pattern is is told by the mesh (simplify_look.c). It
// is seen where difference * C(f) reaches the threshold that the original's own pattern, as fine as
// that, sets by masking. From farther away f is higher: the finest of all channels counts. Where C
// has a second root nearby, nearer than its peak, that is passed over.
#include "shape/mesh/simplify.h"

#include "core/math/lsq.h"
#include "core/math/sh.h"
#include "image/compare/jnd.h"

#include <math.h>
#include <relume/image/jnd.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
    DEGREE = 15,
    COEFFICIENTS = (DEGREE + 1) * (DEGREE + 1),
    ACROSS = 16,  // normals on a hemisphere: ACROSS from its pole, 2 ACROSS around
    NORMALS = 2 * ACROSS * ACROSS,
    ELEVATIONS = 8,
};

// Of a grey plastic: what is matte, and the highlight's peak; light from everywhere.
#define MATTE     0.5
#define HIGHLIGHT 0.3
#define AMBIENT   0.02
// Against samples, so that the fit is as good as the samples are.
#define PENALTY 1e-4
// Shading is steepest where light grazes the surface; what is found in pictures is so many times
// the mean over all directions.
#define STRONGEST 2.6
// What of the original's own differences around a place masks there. Of 0.05 to 1 tried, 0.15 to
// 0.3 took the fewest triangles at equal pictures.
#define MASKER_SHARE 0.25

struct fit {
    double normal[NORMALS][3];
    double basis[NORMALS][COEFFICIENTS];
    double gram[COEFFICIENTS * COEFFICIENTS];
    double right[ELEVATIONS * RELUME_OPPONENTS][COEFFICIENTS];
};

static vec3 normal_at(int i)
{
    // equal areas: z = (k + 1/2) / ACROSS
    const double z = (i / (2 * ACROSS) + 0.5) / ACROSS, r = sqrt(1.0 - z * z);
    const double phi = PI * (i % (2 * ACROSS) + 0.5) / ACROSS;
    return vec3_of(r * cos(phi), r * sin(phi), z);
}

// Lambert and Blinn, seen along z.
static double shade(vec3 n, vec3 light, double gloss)
{
    const vec3 half = vec3_unit(vec3_add(light, vec3_of(0, 0, 1)));
    const double facing = fmax(vec3_dot(n, light), 0.0), h = fmax(vec3_dot(n, half), 0.0);
    return AMBIENT + MATTE * facing +
           (gloss > 0.0 && facing > 0.0 ? HIGHLIGHT * pow(h, gloss) : 0.0);
}

static void sample(struct fit *f, double gloss, double white)
{
    for (int i = 0; i < NORMALS; i++)
        for (int e = 0; e < ELEVATIONS; e++) {
            const double theta = 0.5 * PI * e / ELEVATIONS;
            const double v = shade(normal_at(i), vec3_of(sin(theta), 0, cos(theta)), gloss);
            double seen[RELUME_OPPONENTS];
            relume_jnd_opponent(seen, (const double[]){v, v, v}, white);
            for (int c = 0; c < RELUME_OPPONENTS; c++)
                for (int k = 0; k < COEFFICIENTS; k++)
                    f->right[e * RELUME_OPPONENTS + c][k] += seen[c] * f->basis[i][k] / NORMALS;
        }
}

static bool solve(struct fit *f, double gloss, double white)
{
    for (int i = 0; i < NORMALS; i++)
        sh_evaluate(DEGREE, normal_at(i), f->basis[i]);
    lsq_add_gram(f->gram, COEFFICIENTS, f->basis[0], NORMALS);
    for (int k = 0; k < COEFFICIENTS * COEFFICIENTS; k++)
        f->gram[k] /= NORMALS;
    for (int k = 0; k < COEFFICIENTS; k++) {
        const int l = (int)sqrt(k + 0.5);
        f->gram[k * (COEFFICIENTS + 1)] += PENALTY * (l * l + 0.01);
    }
    sample(f, gloss, white);
    return lsq_solve(f->gram, COEFFICIENTS, f->right[0], ELEVATIONS * RELUME_OPPONENTS);
}

// The largest value of a degree's part of the shading, by the addition theorem.
static double amplitude_of(const double *coefficients, int degree)
{
    double sum = 0.0;
    for (int k = degree * degree; k < (degree + 1) * (degree + 1); k++)
        sum += coefficients[k] * coefficients[k];
    return sqrt(sum * (2 * degree + 1) / (4.0 * PI));
}

// The shading's difference where its normal is `angle` off, of all degrees.
static double difference(const double amplitude[DEGREE + 1], double angle)
{
    double sum = 0.0;
    for (int l = 1; l <= DEGREE; l++) {
        const double a = amplitude[l];
        sum += a * a * (2.0 - 2.0 * cos(fmin(l * angle, PI)));
    }
    return sqrt(sum);
}

static double finest_of(enum relume_opponent channel, double seen, double masker, double jnd)
{
    const double peak = channel == RELUME_OPPONENT_WHITE ? relume_jnd_sensitivity(channel, 3.43)
                                                         : relume_jnd_sensitivity(channel, 0.0);
    double low = 0.0, high = peak;
    if (seen * peak < jnd * relume_jnd_threshold(masker * peak))
        return 0.0;
    for (int i = 0; i < 40; i++) {
        const double c = 0.5 * (low + high);
        *(seen * c < jnd * relume_jnd_threshold(masker * c) ? &low : &high) = c;
    }
    return relume_jnd_finest(channel, high);
}

relume_status visible_create(struct visible *v, double jnd, double gloss, double white)
{
    struct fit *f = mem_zeroed(1, sizeof *f);
    relume_status status = f ? RELUME_OK : RELUME_ENOMEM;
    double amplitude[RELUME_OPPONENTS][DEGREE + 1] = {{0}};
    if (!status && !solve(f, gloss, white))
        status = RELUME_EINVAL;
    for (int i = 0; !status && i < ELEVATIONS * RELUME_OPPONENTS; i++)
        for (int l = 1; l <= DEGREE; l++) {
            double *a = &amplitude[i % RELUME_OPPONENTS][l];
            *a = fmax(*a, amplitude_of(f->right[i], l));
        }
    memset(v, 0, sizeof *v);
    for (int j = 0; !status && j <= VISIBLE_MASKERS; j++)
        for (int k = 1; k <= VISIBLE_ANGLES; k++) {
            const double angle = PI * k * k / (VISIBLE_ANGLES * VISIBLE_ANGLES);
            const double masker = PI * j * j / (VISIBLE_MASKERS * VISIBLE_MASKERS);
            double most = (double)v->finest[j][k - 1];
            for (int c = 0; c < RELUME_OPPONENTS; c++)
                most = fmax(most, finest_of((enum relume_opponent)c,
                                            STRONGEST * difference(amplitude[c], angle),
                                            MASKER_SHARE * difference(amplitude[c], masker), jnd));
            v->finest[j][k] = (float)most;
        }
    mem_free(f);
    return status;
}

double visible_finest(const struct visible *v, double angle, double masker)
{
    const double k = VISIBLE_ANGLES * sqrt(fmin(angle / PI, 1.0));
    const int j = (int)floor(VISIBLE_MASKERS * sqrt(fmin(masker / PI, 1.0)));
    const int i = (int)k < VISIBLE_ANGLES ? (int)k : VISIBLE_ANGLES - 1;
    const double t = k - i;
    return (1.0 - t) * (double)v->finest[j][i] + t * (double)v->finest[j][i + 1];
}
