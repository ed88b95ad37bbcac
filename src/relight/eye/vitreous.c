// vitreous.c - the vitreous body: rigid, damped, kicked by saccades (Ritschel 2009, 8.2.4)
#include "relight/eye/eye.h"

#include "core/base/memory.h"
#include "core/math/random.h"
#include "relight/eye/pupil.h"

#include <math.h>

// The body hangs on the eye's wall: it creeps back within a few seconds, 1/s^2.
static const double suspension = 1.0;
// Particles further from the axis never cross a pupil, mm.
static const double reach = 5.5;

relume_status vitreous_create(struct vitreous *body, const struct relume_subject *s,
                              struct relume_eye_disc *discs)
{
    const int count = s->vitreous.particles.count;
    const double radius = s->vitreous.radius_mm, side = fmin(reach, radius);
    *body = (struct vitreous){.particle = mem_array((size_t)count, sizeof *body->particle)};
    if (!body->particle)
        return RELUME_ENOMEM;
    for (int i = 0; i < count; i++) {
        struct random random = random_stream(s->seed, (uint64_t)i, 0x76697472u);
        double x, y, z;
        do {
            x = random_range(&random, -side, side);
            y = random_range(&random, -side, side);
            z = random_range(&random, -radius, radius);
        } while (x * x + y * y + z * z > radius * radius || x * x + y * y > side * side);
        body->particle[i] = (struct relume_vec3){x, y, z};
        discs[i] = (struct relume_eye_disc){
            .radius = (float)particle_radius(&s->vitreous.particles, random_next(&random)),
            .opacity = (float)s->vitreous.particles.opacity,
        };
    }
    return RELUME_OK;
}

void vitreous_destroy(struct vitreous *body)
{
    mem_free(body->particle);
    body->particle = NULL;
}

// Saccades are a Poisson process; one turns the eye mostly sideways.
void vitreous_step(struct vitreous *body, const struct relume_subject *s, int64_t step, double dt)
{
    static const double share[3] = {1.0, 0.6, 0.3};  // yaw, pitch, torsion
    struct random random = random_stream(s->seed, (uint64_t)step, 0x73616363u);
    const bool saccade = random_next(&random) < s->vitreous.saccades_per_s * dt;
    for (int a = 0; a < 3; a++) {
        if (saccade)
            body->rate[a] += s->vitreous.kick * share[a] * random_range(&random, -1.0, 1.0);
        // Forward Euler with the damping's exact decay, so that any damping is stable.
        body->rate[a] =
            exp(-s->vitreous.damping * dt) * body->rate[a] - dt * suspension * body->angle[a];
        body->angle[a] += dt * body->rate[a];
    }
}

void vitreous_place(const struct vitreous *body, const struct relume_subject *s,
                    struct relume_eye_disc *discs)
{
    const double cy = cos(body->angle[0]), sy = sin(body->angle[0]);
    const double cp = cos(body->angle[1]), sp = sin(body->angle[1]);
    const double ct = cos(body->angle[2]), st = sin(body->angle[2]);
    for (int i = 0; i < s->vitreous.particles.count; i++) {
        const struct relume_vec3 p = body->particle[i];
        const double y = cp * p.y - sp * p.z, z = sp * p.y + cp * p.z;
        const double x = cy * p.x + sy * z;
        discs[i].x = (float)(ct * x - st * y);
        discs[i].y = (float)(st * x + ct * y);
        discs[i].depth = (float)(s->vitreous.radius_mm + cy * z - sy * p.x);
    }
}
