// eye.h - a living eye in time, and what stands in the way of light in it (Ritschel 2009, 8.2)
//
// Pupil, lens, vitreous body and lids move; where they are at one moment is a list of discs and
// strokes in the plane of the pupil, which glare.h turns into a picture of scattered light. Lengths
// in millimetres in that plane, x right and y up as the world sees the eye.
#ifndef RELUME_EYE_H
#define RELUME_EYE_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Particles of one kind: opaque discs. Radii are spread evenly in the logarithm from
// radius / spread to radius * spread.
struct relume_particles {
    int count;         // [0, 20000]
    double radius_mm;  // [0.001, 1]
    double spread;     // [1, 20]; 1: all of one size, as the thesis draws them
    double opacity;    // [0, 1]: 1 - transmittance of the amplitude
};

// Of a file's name and its folder's.
enum { RELUME_SUBJECT_PATH = 1024 };

// One person. Every field counts as it stands: begin with relume_subject_default().
struct relume_subject {
    uint64_t seed;  // another seed, another person with the same measures
    struct {
        bool moon_spencer;    // mean diameter by Moon and Spencer 1944 in cd/m^2; else Eq. 8.2 as
                              // printed
        double hippus;        // gain of the noise of Eq. 8.1, [0, 1]
        double adaptation_s;  // time constant of the field luminance, [0.01, 60]
    } pupil;                  // how it follows and trembles
    struct relume_particles cornea;  // static
    struct {
        struct relume_particles particles;
        double radius_mm;     // of the equator, [2, 6]
        double thickness_mm;  // [1, 8]
        double nucleus;       // the particles' part of the radius, (0, 1]
        double travel_mm;     // amplitude of the ciliary muscle, [0, 0.5]
    } lens;                   // its particles, its size and its movement
    struct {
        int spokes;       // as the thesis draws them, of one thickness; [0, 20000]
        double halo_deg;  // else spaced for a halo of this radius at 575 nm; 0: `spokes`; [0, 10]
        double inner_mm, outer_mm;  // of the cortex, [0, 6]
        double width_mm;            // of one fibre's edge, [0.0005, 0.2]
        double opacity;             // [0, 1]
    } fibres;                       // of the lens: what makes the halo
    struct {
        struct relume_particles particles;
        double radius_mm;       // of the body, [5, 15]
        double damping;         // 1/s, [0.1, 100]
        double saccades_per_s;  // [0, 20]
        double kick;            // rad/s that a saccade leaves, [0, 10]
    } vitreous;                 // its particles and their movement
    struct {
        int lashes;               // of both lids together, [0, 1000]
        double lash_width_mm;     // at the root, [0.001, 0.5]
        double blink_interval_s;  // mean, 0: never; [0, 3600]
        double blink_s;           // how long one takes, [0.05, 5]
        double squint;            // how far the lids are held closed, [0, 1)
        // A picture of the upper lid's lashes, 14 mm wide, the lid's edge at its top, in place of
        // drawn ones: what is darker than half is a lash. The lower lid's are the same upside down
        // and 0.45 times as long. Empty: none.
        char lash_image[RELUME_SUBJECT_PATH];
    } lids;  // lashes, blinks, squinting
    struct {
        double defocus_dpt;  // residual defocus, the distance d of E in Eq. 8.3 as 1/d; [-5, 5]
        double age;          // years, [1, 120]: of the veil beyond the computed field
        double pigment;      // of the iris: 0 black, 0.5 brown, 1.0 green, 1.2 blue; [0, 1.2]
    } optics;                // focus, age, pigment
};

// A healthy adult.
RELUME_API struct relume_subject relume_subject_default(void);
// A JSON file of such fields (docs/glare.md) over the defaults; a picture is looked for from the
// file's folder. An input status with a sentence that
// names line, field and range; RELUME_ENOMEM.
RELUME_RESULT relume_status relume_subject_load(struct relume_subject *out, const char *path,
                                                const struct relume_log *log);

// Thread-safety: one thread at a time.
typedef struct relume_eye relume_eye;

// As it is now; plain numbers for panels and plots.
struct relume_eye_state {
    double time_s;             // since the eye was created
    double luminance;          // the field luminance that the pupil has adapted to, cd/m^2
    double mean_pupil_mm;      // p of Eq. 8.2
    double pupil_mm;           // h of Eq. 8.1, in [1.5, 9]
    double muscle_mm;          // displacement of the lens's equator, inwards < 0
    double vitreous_rad[3];    // yaw, pitch, torsion
    double vitreous_rad_s[3];  // its angular velocity
    double openness;           // of the lids, 0 closed, 1 open
};

// An eye at time 0, adapted to `luminance` cd/m^2. `subject` NULL: the default. RELUME_EINVAL for a
// field out of its range, an input status for a picture of lashes that cannot be read,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_eye_create(relume_eye **out,
                                              const struct relume_subject *subject,
                                              double luminance);
RELUME_API void relume_eye_destroy(relume_eye **eye);

// Let `dt_s` >= 0 pass in a field of `luminance` cd/m^2. Motion is computed on a fixed clock of
// 1/600 s, so that an eye at some time is the same however the time was divided; of spans beyond
// 10 s only the last 10 s are computed. RELUME_EINVAL when a number is negative or not finite.
RELUME_RESULT relume_status relume_eye_advance(relume_eye *eye, double dt_s, double luminance);

// It belongs to the eye.
RELUME_API const struct relume_subject *relume_eye_subject(const relume_eye *eye);
// It belongs to the eye and changes with it.
RELUME_API const struct relume_eye_state *relume_eye_state(const relume_eye *eye);

#ifdef __cplusplus
}
#endif
#endif
