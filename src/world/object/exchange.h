// exchange.h - what the parts of light between a scene and the objects in it share
#ifndef OBJECT_EXCHANGE_H
#define OBJECT_EXCHANGE_H

#include "shape/mesh/places.h"
#include "world/object/object.h"

// Of the samples of an environment one in so many is looked for where light is on its way.
enum { ON_THE_WAY = 8 };

// What lamps show a white matte surface, without and with the objects: those that the scene lets
// through, and all.
enum { LET_THROUGH, LET_THROUGH_WITH, ALL, ALL_WITH, LAMPS };

struct layer {
    struct relume_image places, normals;  // NaN: nothing is there
};

struct exchange {
    const relume_objects *o;
    const struct scenery *scenery;
    const struct relume_viewport *viewport;
    const struct relume_transport *transport;
    struct relume_render_params params;
    float sends;  // of what objects send of their own, under each light
    int spacing;  // pixels from one that gathers to the next
    const struct bodies *bodies;
    const struct scenery *const *before;  // [befores]: all that blocks lamps, for `share`
    int befores;
    struct layer scene, objects, frame;
    float *behind;  // [pixels]: how far off the eye the backs of objects are
    int cameras;    // further ones
    struct further_pictures *further;
    vec3 eye;
    // Of the light in hand.
    struct lighting lighting;
    struct world world;
    const struct relume_image *lone;
    struct relume_image *lit, *reflected, *share;
    struct relume_image shown;            // what the frame shows, without light between
    struct relume_image without, with;    // gathered by the scene
    struct relume_image white, returned;  // by the objects: of white ones, and as they are
    struct relume_image ahead;            // what objects return of light of 1 from straight ahead
    struct relume_image lamps[LAMPS];     // before the scene, for lights of many samples
};

static inline size_t exchange_pixel(const struct exchange *e, int x, int y)
{
    return (size_t)y * (size_t)e->scene.places.width + (size_t)x;
}

static inline bool layer_holds(const struct layer *layer, size_t pixel)
{
    return !isnan(layer->places.data[3 * pixel]);
}

// One pixel of a picture of the exchange's.
typedef void do_pixel(struct exchange *e, int x, int y);

// `rays` for each pixel or so: who stops does not wait for more than some of them. RELUME_ECANCEL.
relume_status exchange_over_pixels(struct exchange *e, int rays, do_pixel *pixel);
struct ray exchange_ray(const struct exchange *e, int x, int y, const double at[2]);
// Whether what a part returns depends on where it is seen from: a matte surface is a lit texture;
// mirrors, and what is baked, do not gather for themselves.
bool exchange_shines(const struct exchange *e, int part);
// The objects as the middle of a pixel shows them, or else some other part of it: pixels along
// their outline need their light, too.
bool exchange_objects_at(struct surface_point *point, const struct exchange *e, int x, int y);

// ---------------------------------------------------------------- lamps (exchange_lamps.c)

// What lamps show a white matte surface at a pixel: those that the scene lets through, and all.
struct lamps {
    double let_through[3], all[3];
};
struct lit_by {
    struct lamps without, with;  // the objects
};

// One lamp in `every` is looked for.
struct lit_by exchange_lamps_at(const struct exchange *e, vec3 place, vec3 normal, int every,
                                uint64_t key);
// Into e->lamps and from there.
void exchange_put_lamps(const struct exchange *e, size_t pixel, vec3 place, vec3 normal);
struct lit_by exchange_lamps_put(const struct exchange *e, size_t pixel);
bool exchange_in_shadow(const struct exchange *e, vec3 place, vec3 normal, int every, uint64_t key);
// Of what a place of the scene shows, the part that it shows in the shadow of the objects. All else
// that it is lit by is taken to be what comes from everywhere. `context`: the exchange.
double exchange_dimmed(const void *context, vec3 place, vec3 normal, uint64_t key);
// What a pixel that shows `shown` is multiplied by. Where even with all lamps less arrives than it
// shows, the rest is light that nothing is known of, which no object hides.
void exchange_quotient(double part[3], const float shown[3], const struct lit_by *lit,
                       const float without[3], const float with[3]);

// ---------------------------------------------------------------- gathering (exchange_gather.c)

// Whether pixels between those that gather take lamps from them, too: shadows of one lamp are
// sharp; those of many samples are soft.
bool exchange_keeps_lamps(const struct exchange *e);
// At the pixels that gather, and then between them.
do_pixel exchange_gather_scene, exchange_gather_objects, exchange_fill_scene, exchange_fill_objects;
// At a place of the objects as `eye` sees it; what a white surface would gather is added to
// `white`, what it returns to `returned`.
void exchange_gather_at(struct exchange *e, const struct surface_point *point, vec3 eye,
                        uint64_t key, float white[3], float returned[3]);

// ---------------------------------------------------------------- cameras (exchange_further.c)

// Pictures of the objects from further cameras, under the light in hand. Part of e->world until
// they are destroyed. RELUME_ENOMEM.
relume_status exchange_further_create(struct exchange *e);
void exchange_further_destroy(struct exchange *e);
// Light that is gathered there, and then shown, too.
void exchange_further_gather(struct exchange *e);
void exchange_further_show(struct exchange *e);

#endif
