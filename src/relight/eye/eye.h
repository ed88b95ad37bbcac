// eye.h - the moving parts of an eye, one struct each, put together by eye.c
#ifndef POST_EYE_H
#define POST_EYE_H

#include "relight/eye/pupil.h"

#include <relume/relight/eye.h>

// Every field within the range that eye.h states; else its dotted name and the range in words.
bool subject_valid(const struct relume_subject *subject, char why[160]);

// ---------------------------------------------------------------- lens.c

enum { LENS_NODES = 17 };
// Particles in a lens that breathes with its muscle. The section is a grid of springs which are
// stiff against the muscle's few hertz, so it is always at rest: a displacement of the equator by
// 1 mm moves node (radius, axis) by `response`.
struct lens {
    double response[LENS_NODES][LENS_NODES];  // [axis][radius]: outwards, mm per mm
    struct lens_particle {
        double r, z, cos_phi, sin_phi;  // mm
    } * particle;
    int count;
};
relume_status lens_create(struct lens *lens, const struct relume_subject *subject,
                          struct relume_eye_disc *discs);
void lens_destroy(struct lens *lens);
// Positions of discs for a muscle displacement.
void lens_place(const struct lens *lens, const struct relume_subject *subject, double muscle_mm,
                struct relume_eye_disc *discs);
// Accommodative microfluctuations (Gray, Winn, Gilmartin 1993) at a time for a pupil of p mm.
double lens_muscle(const struct relume_subject *subject, double time_s, double mean_pupil_mm);

// ---------------------------------------------------------------- vitreous.c

// A rigid body on a soft, strongly damped suspension.
struct vitreous {
    double angle[3], rate[3];  // yaw, pitch, torsion
    struct relume_vec3 *particle;
};
relume_status vitreous_create(struct vitreous *body, const struct relume_subject *subject,
                              struct relume_eye_disc *discs);
void vitreous_destroy(struct vitreous *body);
// The step of that number, `dt` long: what it does is in its number and the seed.
void vitreous_step(struct vitreous *body, const struct relume_subject *subject, int64_t step,
                   double dt);
void vitreous_place(const struct vitreous *body, const struct relume_subject *subject,
                    struct relume_eye_disc *discs);

// ---------------------------------------------------------------- fibres.c, lids.c

int fibres_count(const struct relume_subject *subject);
void fibres_draw(const struct relume_subject *subject, struct relume_eye_stroke *strokes);

// Pieces of a picture's lashes, mm: beside the lid's middle, from its edge on, and how wide at both
// ends.
struct lash_piece {
    float x[2], far[2], width[2];
};
struct lashes {
    struct lash_piece *piece;  // NULL: they are drawn
    int count;
};
// Of a picture, see relume_subject. An input status with a sentence, RELUME_ENOMEM.
relume_status lashes_load(struct lashes *out, const char *path, const struct relume_log *log);
void lashes_destroy(struct lashes *lashes);

int lashes_count(const struct relume_subject *subject, const struct lashes *image);  // strokes
// Openness of the lids, without squint.
double lids_openness(const struct relume_subject *subject, double time_s);
// Lids and lashes at that openness.
void lids_place(const struct relume_subject *subject, const struct lashes *image, double openness,
                struct relume_aperture *aperture, struct relume_eye_stroke *lashes);

// Radius of particle i: one of `particles`' spread.
double particle_radius(const struct relume_particles *particles, double uniform);

#endif
