// eye.c - an eye in time: the clock, the pupil, and the list of what stands in the way
#include <relume/relight/eye.h>

#include "core/base/memory.h"
#include "core/math/random.h"
#include "relight/eye/eye.h"
#include "relight/eye/noise.h"
#include "relight/eye/pupil.h"

#include <math.h>

static const double clock_hz = 600.0;  // whole steps for films of 24, 25, 30, 50 and 60 frames
static const double memory_s = 10.0;   // what lies further back has been forgotten
static const double pupil_least_mm = 1.5, pupil_most_mm = 9.0;

struct relume_eye {
    struct relume_subject subject;
    struct relume_eye_state state;
    struct relume_aperture aperture;
    struct lens lens;
    struct vitreous vitreous;
    struct lashes lashes;
    int64_t step;         // of the clock
    double hippus_phase;  // integral of dt / p: t / p of Eq. 8.1 for a p that changes
    struct relume_eye_disc *disc;
    struct relume_eye_stroke *stroke;
};

// ---------------------------------------------------------------- pupil

double relume_pupil_mm(double luminance, bool moon_spencer)
{
    // Moon and Spencer's constant for millilamberts is 0.5; 1 mL is 10 / pi cd/m^2.
    const double offset = moon_spencer ? 0.5 - log10(10.0 / M_PI) : 1.0;
    return 4.9 - 3.0 * tanh(0.4 * (log10(fmax(luminance, 0.0)) + offset));
}

static double hippus(const struct relume_eye *eye, double p)
{
    const uint64_t key = random_mix(eye->subject.seed ^ 0x6869707075u);
    const double swing = pupil_most_mm / p * sqrt(1.0 - p / pupil_most_mm);
    const double h = p + eye->subject.pupil.hippus * noise_octaves(key, eye->hippus_phase) * swing;
    return fmin(fmax(h, pupil_least_mm), pupil_most_mm);
}

// ---------------------------------------------------------------- time

static void step_eye(struct relume_eye *eye, double luminance)
{
    const double dt = 1.0 / clock_hz;
    struct relume_eye_state *const s = &eye->state;
    s->luminance += (luminance - s->luminance) * -expm1(-dt / eye->subject.pupil.adaptation_s);
    s->mean_pupil_mm = relume_pupil_mm(s->luminance, eye->subject.pupil.moon_spencer);
    eye->hippus_phase += dt / s->mean_pupil_mm;
    vitreous_step(&eye->vitreous, &eye->subject, eye->step, dt);
    eye->step++;
}

// Everything that follows from the state.
static void place_surfaces(struct relume_eye *eye)
{
    struct relume_eye_state *const s = &eye->state;
    struct relume_aperture *const a = &eye->aperture;
    const double now = (double)eye->step / clock_hz;
    s->pupil_mm = hippus(eye, s->mean_pupil_mm);
    s->muscle_mm = lens_muscle(&eye->subject, now, s->mean_pupil_mm);
    for (int k = 0; k < 3; k++) {
        s->vitreous_rad[k] = eye->vitreous.angle[k];
        s->vitreous_rad_s[k] = eye->vitreous.rate[k];
    }
    s->openness = lids_openness(&eye->subject, now) * (1.0 - eye->subject.lids.squint);
    a->pupil_radius = (float)(0.5 * s->pupil_mm);
    lens_place(&eye->lens, &eye->subject, s->muscle_mm, eye->disc + a->lens.first);
    vitreous_place(&eye->vitreous, &eye->subject, eye->disc + a->vitreous.first);
    lids_place(&eye->subject, &eye->lashes, s->openness, a, eye->stroke + a->lashes.first);
}

relume_status relume_eye_advance(relume_eye *eye, double dt_s, double luminance)
{
    if (!(dt_s >= 0.0 && dt_s <= 1e9) || !(luminance >= 0.0 && isfinite(luminance)))
        return RELUME_EINVAL;
    eye->state.time_s += dt_s;
    // The half step keeps sums of frame times from falling just short of a tick.
    const int64_t until = (int64_t)floor(eye->state.time_s * clock_hz + 0.5);
    const int64_t most = (int64_t)(memory_s * clock_hz);
    if (until - eye->step > most) {
        const double skipped_s = (double)(until - most - eye->step) / clock_hz;
        eye->state.luminance += (luminance - eye->state.luminance) *
                                -expm1(-skipped_s / eye->subject.pupil.adaptation_s);
        eye->hippus_phase += skipped_s / eye->state.mean_pupil_mm;
        eye->step = until - most;
    }
    while (eye->step < until)
        step_eye(eye, luminance);
    place_surfaces(eye);
    return RELUME_OK;
}

// ---------------------------------------------------------------- life

static void place_cornea(const struct relume_subject *s, struct relume_eye_disc *discs)
{
    for (int i = 0; i < s->cornea.count; i++) {
        struct random random = random_stream(s->seed, (uint64_t)i, 0x636f726eu);
        const double r = 0.5 * pupil_most_mm * sqrt(random_next(&random));
        const double phi = 2.0 * M_PI * random_next(&random);
        discs[i] = (struct relume_eye_disc){
            .x = (float)(r * cos(phi)),
            .y = (float)(r * sin(phi)),
            .radius = (float)particle_radius(&s->cornea, random_next(&random)),
            .opacity = (float)s->cornea.opacity,
        };
    }
}

static relume_status allocate(struct relume_eye *eye)
{
    const struct relume_subject *const s = &eye->subject;
    struct relume_aperture *const a = &eye->aperture;
    a->cornea = (struct relume_eye_range){0, s->cornea.count};
    a->lens = (struct relume_eye_range){a->cornea.count, s->lens.particles.count};
    a->vitreous =
        (struct relume_eye_range){a->lens.first + a->lens.count, s->vitreous.particles.count};
    a->fibres = (struct relume_eye_range){0, fibres_count(s)};
    a->lashes = (struct relume_eye_range){a->fibres.count, lashes_count(s, &eye->lashes)};
    a->disc = eye->disc =
        mem_zeroed((size_t)(a->vitreous.first + a->vitreous.count), sizeof *eye->disc);
    a->stroke = eye->stroke =
        mem_zeroed((size_t)(a->lashes.first + a->lashes.count), sizeof *eye->stroke);
    return eye->disc && eye->stroke ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_eye_create(relume_eye **out, const struct relume_subject *subject,
                                double luminance)
{
    char why[160];
    const struct relume_subject chosen = subject ? *subject : relume_subject_default();
    *out = NULL;
    if (!subject_valid(&chosen, why) || !(luminance >= 0.0 && isfinite(luminance)))
        return RELUME_EINVAL;
    relume_eye *eye = mem_zeroed(1, sizeof *eye);
    if (!eye)
        return RELUME_ENOMEM;
    eye->subject = chosen;
    eye->state.luminance = luminance;
    eye->state.mean_pupil_mm = relume_pupil_mm(luminance, chosen.pupil.moon_spencer);
    relume_status status = RELUME_OK;
    if (chosen.lids.lash_image[0])
        status = lashes_load(&eye->lashes, chosen.lids.lash_image, NULL);
    if (!status)
        status = allocate(eye);
    if (!status)
        status = lens_create(&eye->lens, &eye->subject, eye->disc + eye->aperture.lens.first);
    if (!status)
        status = vitreous_create(&eye->vitreous, &eye->subject,
                                 eye->disc + eye->aperture.vitreous.first);
    if (status) {
        relume_eye_destroy(&eye);
        return status;
    }
    place_cornea(&eye->subject, eye->disc);
    fibres_draw(&eye->subject, eye->stroke);
    place_surfaces(eye);
    *out = eye;
    return RELUME_OK;
}

void relume_eye_destroy(relume_eye **eye)
{
    if (!*eye)
        return;
    lens_destroy(&(*eye)->lens);
    vitreous_destroy(&(*eye)->vitreous);
    lashes_destroy(&(*eye)->lashes);
    mem_free((*eye)->disc);
    mem_free((*eye)->stroke);
    mem_free(*eye);
    *eye = NULL;
}

void relume_eye_squint(relume_eye *eye, double squint)
{
    eye->subject.lids.squint = squint > 0.0 ? fmin(squint, 0.99) : 0.0;
    place_surfaces(eye);
}

const struct relume_subject *relume_eye_subject(const relume_eye *eye)
{
    return &eye->subject;
}

const struct relume_eye_state *relume_eye_state(const relume_eye *eye)
{
    return &eye->state;
}

const struct relume_aperture *relume_eye_aperture(const relume_eye *eye)
{
    return &eye->aperture;
}
