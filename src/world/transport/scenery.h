// scenery.h - a captured view as rays meet it: a mesh through the places that its pixels show,
// which sends in all directions what the pixels show under the present light
#ifndef TRANSPORT_SCENERY_H
#define TRANSPORT_SCENERY_H

#include "core/math/vec.h"
#include "shape/mesh/trace.h"

#include <relume/capture.h>
#include <relume/image.h>

struct scenery;

// Of a view of that geometry, seen from `eye`, whose pixels show `places` (NaN: nothing; all of
// them: nobody knows). What is much farther away than anything else, or not known, is background:
// no part of the mesh. RELUME_ENOMEM, RELUME_ESYSTEM as trace_create.
relume_status scenery_create(struct scenery **out, const struct relume_geometry *geometry, vec3 eye,
                             const struct relume_image *places, const struct relume_log *log);
void scenery_destroy(struct scenery **c);
// Whether it is seen on all sides: a panorama.
bool scenery_is_around(const struct scenery *c);

// It sends from now on what `relit` shows, of the places' size; scenery_draw goes by what of it
// arrives at `middle`. RELUME_ENOMEM, RELUME_EINVAL (another size).
relume_status scenery_light(struct scenery *c, const struct relume_image *relit, vec3 middle);

// The eye, and the mesh, of which the eye sees one side of each triangle. Under the present light a
// place of a triangle, of those weights of its second and third corner, sends that.
vec3 scenery_eye(const struct scenery *c);
const struct mesh *scenery_mesh(const struct scenery *c);
void scenery_sent(float rgb[3], const struct scenery *c, size_t triangle, float u, float v);

// Its vertices are blocks of so many pixels each way, row by row, `*across` of them in each; so are
// the pieces of the background.
int scenery_blocks(int *across, const struct scenery *c);

// The background lies in pieces: the solid angle of one, 0 where it is none, what comes from there
// on average, and the direction of (x, y) of it, 0 to 1.
size_t scenery_pieces(const struct scenery *c);
double scenery_piece(vec3 *direction, float sent[3], const struct scenery *c, size_t piece,
                     double x, double y);

// Where a ray meets it.
struct scenery_hit {
    vec3 place, normal;  // the normal is unit, towards the ray's origin
    double distance;
    float sent[3];
    size_t source;  // of what sends it: for scenery_density
};
// False where it goes on into the background; then `sent` is that, and black where nobody looked.
bool scenery_meet(struct scenery_hit *out, const struct scenery *c, vec3 origin, vec3 direction);
// A direction from `origin` to something that sends light, bright things more often, by three
// numbers in [0, 1); its source, which may turn out to be hidden. False: all is black.
bool scenery_draw(vec3 *towards, size_t *source, const struct scenery *c, vec3 origin,
                  const double random[3]);
// How often, per solid angle, the direction of such a hit is drawn from its ray's origin.
double scenery_density(const struct scenery *c, const struct scenery_hit *hit, vec3 direction);
// Where rays from a place near it begin: off it by what depth may be wrong by.
vec3 scenery_leave(const struct scenery *c, vec3 place, vec3 normal);
// Whether nothing of it lies on the way from where a ray begins to what shines there from
// `distance` away.
bool scenery_reached(const struct scenery *c, vec3 start, vec3 towards, double distance);
// Whether a place is one of surfaces, not of the background.
bool scenery_holds(const struct scenery *c, vec3 place);
// The mean of what the eye sees over all directions; where it is no panorama, of the pixels.
void scenery_mean(float rgb[3], const struct scenery *c);

#endif
