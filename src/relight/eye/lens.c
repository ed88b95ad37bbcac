// lens.c - the lens: a grid of springs pulled by the ciliary muscle, and particles that follow it
// (Ritschel 2009, 8.2.3)
#include "relight/eye/eye.h"

#include "core/base/memory.h"
#include "core/math/random.h"
#include "relight/eye/noise.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <string.h>

enum { N = LENS_NODES, NODES = N * N };

// ---------------------------------------------------------------- springs

// Displacements of all nodes: radius, then axis. Node (j, i) rests at radius i, axis j - N / 2.
struct field {
    double u[2][NODES];
};

// The axis does not move sideways, the middle stays, the muscle holds the equator.
static bool held(int node, int axis)
{
    const int i = node % N, j = node / N;
    return (axis == 0 && i == 0) || (axis == 1 && i == 0 && j == N / 2) ||
           (i == N - 1 && j == N / 2);
}

// Forces of springs to the eight neighbours, each along its own direction; held nodes feel none.
static void forces(struct field *out, const struct field *in, double dr, double dz)
{
    static const int step[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    memset(out, 0, sizeof *out);
    for (int node = 0; node < NODES; node++)
        for (int s = 0; s < 4; s++) {
            const int i = node % N + step[s][0], j = node / N + step[s][1];
            if (i < 0 || i >= N || j >= N)
                continue;
            const int other = j * N + i;
            const double x = step[s][0] * dr, z = step[s][1] * dz, l = hypot(x, z);
            const double pull =
                ((in->u[0][other] - in->u[0][node]) * x + (in->u[1][other] - in->u[1][node]) * z) /
                (l * l);
            out->u[0][node] += pull * x;
            out->u[1][node] += pull * z;
            out->u[0][other] -= pull * x;
            out->u[1][other] -= pull * z;
        }
    for (int axis = 0; axis < 2; axis++)
        for (int node = 0; node < NODES; node++)
            if (held(node, axis))
                out->u[axis][node] = 0.0;
}

static double product(const struct field *a, const struct field *b)
{
    double sum = 0.0;
    for (int axis = 0; axis < 2; axis++)
        for (int node = 0; node < NODES; node++)
            sum += a->u[axis][node] * b->u[axis][node];
    return sum;
}

static void add(struct field *a, double s, const struct field *b)
{
    for (int axis = 0; axis < 2; axis++)
        for (int node = 0; node < NODES; node++)
            a->u[axis][node] += s * b->u[axis][node];
}

// Equilibrium by conjugate gradients: the forces are a symmetric negative matrix of the field.
static void relax(struct field *u, double dr, double dz)
{
    struct field residual, direction, change;
    forces(&residual, u, dr, dz);
    direction = residual;
    double error = product(&residual, &residual);
    const double enough = 1e-18 * error;
    for (int round = 0; round < 4 * NODES && error > enough; round++) {
        forces(&change, &direction, dr, dz);
        const double step = error / -product(&direction, &change);
        add(u, step, &direction);
        add(&residual, step, &change);
        const double next = product(&residual, &residual), turn = next / error;
        error = next;
        for (int axis = 0; axis < 2; axis++)
            for (int node = 0; node < NODES; node++)
                direction.u[axis][node] = residual.u[axis][node] + turn * direction.u[axis][node];
    }
}

// ---------------------------------------------------------------- particles

double particle_radius(const struct relume_particles *particles, double uniform)
{
    return particles->radius_mm * pow(particles->spread, 2.0 * uniform - 1.0);
}

static void scatter(struct lens *lens, const struct relume_subject *s,
                    struct relume_eye_disc *discs)
{
    const double across = s->lens.radius_mm * s->lens.nucleus;
    const double along = 0.5 * s->lens.thickness_mm * s->lens.nucleus;
    for (int i = 0; i < lens->count; i++) {
        struct random random = random_stream(s->seed, (uint64_t)i, 0x6c656e73u);
        double x, y, z;
        do {  // rejection sampling of the ellipsoid
            x = random_range(&random, -1.0, 1.0);
            y = random_range(&random, -1.0, 1.0);
            z = random_range(&random, -1.0, 1.0);
        } while (x * x + y * y + z * z > 1.0);
        const double phi = 2.0 * M_PI * random_next(&random);
        lens->particle[i] =
            (struct lens_particle){across * hypot(x, y), along * z, cos(phi), sin(phi)};
        discs[i] = (struct relume_eye_disc){
            .radius = (float)particle_radius(&s->lens.particles, random_next(&random)),
            .opacity = (float)s->lens.particles.opacity,
        };
    }
}

relume_status lens_create(struct lens *lens, const struct relume_subject *s,
                          struct relume_eye_disc *discs)
{
    struct field u = {{{0}}};
    lens->count = s->lens.particles.count;
    lens->particle = mem_array((size_t)lens->count, sizeof *lens->particle);
    if (!lens->particle)
        return RELUME_ENOMEM;
    u.u[0][N / 2 * N + N - 1] = 1.0;
    relax(&u, s->lens.radius_mm / (N - 1), s->lens.thickness_mm / (N - 1));
    memcpy(lens->response, u.u[0], sizeof lens->response);
    scatter(lens, s, discs);
    return RELUME_OK;
}

void lens_destroy(struct lens *lens)
{
    mem_free(lens->particle);
    lens->particle = NULL;
}

static double respond(const struct lens *lens, double column, double row)
{
    const int i = (int)fmin(fmax(column, 0.0), N - 2.0), j = (int)fmin(fmax(row, 0.0), N - 2.0);
    const double x = column - i, y = row - j;
    const double(*const f)[N] = lens->response;
    return (1.0 - y) * ((1.0 - x) * f[j][i] + x * f[j][i + 1]) +
           y * ((1.0 - x) * f[j + 1][i] + x * f[j + 1][i + 1]);
}

void lens_place(const struct lens *lens, const struct relume_subject *s, double muscle_mm,
                struct relume_eye_disc *discs)
{
    for (int i = 0; i < lens->count; i++) {
        const struct lens_particle *const p = &lens->particle[i];
        const double column = p->r / s->lens.radius_mm * (N - 1);
        const double row = (p->z / s->lens.thickness_mm + 0.5) * (N - 1);
        const double r = p->r + muscle_mm * respond(lens, column, row);
        discs[i].x = (float)(r * p->cos_phi);
        discs[i].y = (float)(r * p->sin_phi);
    }
}

// ---------------------------------------------------------------- muscle

// Low part: octaves at 0.15, 0.3 and 0.6 Hz, growing with the pupil; high part: lines between 1.3
// and 2.1 Hz.
static const double low_hz = 0.15, high_from_hz = 1.3, high_to_hz = 2.1, high_share = 0.3;
enum { LINES = 5 };

double lens_muscle(const struct relume_subject *s, double time_s, double mean_pupil_mm)
{
    const double low = noise_octaves(random_mix(s->seed ^ 0x6d7573636cu), time_s * low_hz);
    struct random random = random_stream(s->seed, 0, 0x68696768u);
    double high = 0.0;
    for (int i = 0; i < LINES; i++) {
        const double hz = random_range(&random, high_from_hz, high_to_hz);
        high += sin(2.0 * M_PI * (hz * time_s + random_next(&random))) / LINES;
    }
    return s->lens.travel_mm * (mean_pupil_mm / 9.0 * low + high_share * high);
}
