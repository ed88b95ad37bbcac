// object.h - the inside of relume_objects
#ifndef OBJECT_OBJECT_H
#define OBJECT_OBJECT_H

#include "core/base/json.h"
#include "material/model/environment.h"
#include "material/surface/texels.h"
#include "shape/mesh/mesh_file.h"
#include "shape/mesh/trace.h"
#include "world/baked/baked.h"
#include "world/object/drawn_objects.h"
#include "world/transport/scattering.h"
#include "world/transport/transport.h"

#include <relume/world/object.h>

// A material that light goes into and leaves elsewhere.
struct translucent {
    const char *name;  // NULL: it is another one
    struct scattering scattering;
    double mm;  // how long a unit of the world is; 0: nobody has said
};

// A baked object and how it stands in the world; `baked` NULL: the material is another one.
struct standing_baked {
    relume_baked *baked;
    struct frame frame;
};

struct relume_objects {
    struct relume_objects_info info;  // points to what is below
    struct mesh mesh;  // the same triangles for rays; their material is the number of the part
    tracer *tracer;
    struct trace_cloud *cloud;  // [clouds]: of objects that are shown as billboards; owned
    int clouds;
    struct relume_mesh_vertex *vertices;
    uint32_t (*triangles)[3];
    float (*tint)[3];                 // of each vertex, as relume_objects_info; NULL: none has one
    float (*vertex_tint)[3];          // the same of the mesh's, until the objects are finished
    bool tinted;                      // one of these is not white
    struct relume_object_part *part;  // [parts]
    struct relume_object_material *material;
    char **folder;                    // [materials]: as it was opened
    struct translucent *translucent;  // [materials]
    struct standing_baked *standing;  // [materials]
    relume_reflection **reflection;   // [objects]; NULL: as it is
    struct wanted_levels *wanted;     // [wants]: of objects that are shown in levels
    int wants;
    struct object_levels **levels;   // [objects]; NULL: none, or of one of them
    const relume_objects *shown_of;  // NULL; or these are others as an eye sees them, and own ...
    struct level_choice *choice;     // ... but the surface and these, [parts], nothing
    float *fold;                     // how far off its full surface that of a part is; or NULL
};

// One more vertex of the mesh, in the world; `colour` (sRGB) is part of the file's own look, and
// multiplies the values there; NULL: white.
uint32_t objects_vertex(relume_objects *o, struct relume_vec3 place, struct relume_vec3 normal,
                        struct relume_vec3 texture, const uint8_t *colour);

static inline vec3 objects_middle(const relume_objects *o)
{
    return vec3_scale(vec3_add(o->info.min, o->info.max), 0.5);
}

// The part's material, opened when it is not there yet; its number. An input status, RELUME_ENOMEM.
relume_status objects_material(relume_objects *o, const char *folder, int *number,
                               const struct relume_objects_params *params);

// Memory for one more. RELUME_ELIMIT with a sentence, RELUME_ENOMEM.
relume_status objects_need_material(relume_objects *o, const char *name,
                                    const struct relume_log *log);
// The model becomes the material's, and is destroyed where that fails. RELUME_ENOMEM.
relume_status objects_take_model(struct relume_object_material *m, relume_btf_fitted *fitted,
                                 const struct relume_log *log);
// What the file of a mesh says of a part itself, as a material; likewise, and an input status.
relume_status objects_own_look(relume_objects *o, const struct mesh_file *file, int part,
                               const char *path, int *number,
                               const struct relume_objects_params *params);
// Parts of which it says nothing become matte grey, with a note.
void objects_plain_look(struct mesh_file *file, const char *path, const struct relume_log *log);

// A mirror of that reflectance. RELUME_ELIMIT with a sentence, RELUME_ENOMEM.
relume_status objects_mirror(relume_objects *o, const float reflectance[3], int *number,
                             const struct relume_objects_params *params);
// A matte surface likewise. Errors of relume_btf_fit, too.
relume_status objects_matte(relume_objects *o, const float reflectance[3], int *number,
                            const struct relume_objects_params *params);
// A translucent one, which is shown matte where nothing scatters. Likewise.
relume_status objects_translucent(relume_objects *o, const struct translucent *translucent,
                                  int *number, const struct relume_objects_params *params);
// A baked object as a material, which it takes over on success: `*baked` is NULL then.
relume_status objects_take_baked(relume_objects *o, relume_baked **baked, const char *path,
                                 const struct frame *frame, int *number,
                                 const struct relume_objects_params *params);
// What JSON value `translucent` of a description says. RELUME_EFORMAT with a sentence.
relume_status translucent_read(struct translucent *out, const jvalue *value,
                               const struct relume_log *log);

// How a mesh stands and how its parts are covered.
struct covering {
    const char *part;  // NULL: all others
    int material;      // -1: what the mesh's file says itself
    double repeat[2], offset[2];
    bool nearest;
    bool used;
};
struct standing {
    struct frame frame;
    double billboards;  // their error, of the longest side of the object; 0: it is shown itself
    double levels;      // pixels that an error of fewer triangles may be seen as; 0: all of them
    struct covering *covering;
    int coverings;
    bool bare;  // what nobody gives a material is matte grey
};
// Add a mesh file. An input status, RELUME_ENOMEM.
relume_status objects_add(relume_objects *o, const char *path, struct standing *standing,
                          const struct relume_objects_params *params);
// Show the triangles from `first` on as billboards of that error. Errors of
// relume_billboards_create.
relume_status objects_add_cloud(relume_objects *o, size_t first, double error,
                                const struct relume_log *log);
// The same for a cushion: a square of side 2 that lies on z = 0 by its rim and rises to its middle.
relume_status objects_add_cushion(relume_objects *o, struct standing *standing,
                                  const struct relume_objects_params *params);
// A baked object as a whole, of a file. Errors of relume_baked_open.
relume_status objects_add_baked(relume_objects *o, const char *path, const struct frame *frame,
                                const struct relume_objects_params *params);
// The edits of JSON value `edit`, of the file `path`, for an object. Errors of
// relume_objects_load_reflections.
relume_status objects_read_reflections(relume_objects *o, int object, const jvalue *edit,
                                       const char *path,
                                       const struct relume_reflection_params *params);

// A pose: translate, rotate, scale; absent: as it is. RELUME_EFORMAT with a sentence.
relume_status objects_read_pose(struct frame *out, const jvalue *value,
                                const struct relume_log *log);
// The objects of a list in the file `path`, finished, without those that are `left_out` (NULL:
// none); of no list (NULL) none. Errors of relume_objects_open. `params` are filled in.
relume_status objects_read(relume_objects **out, const jvalue *list, const char *path,
                           const bool *left_out, const struct relume_objects_params *params);

// Tangents, and what rays need. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status objects_finish(relume_objects *o, const struct relume_objects_params *params);

// ---------------------------------------------------------------- rays

// Where a ray hits the objects.
struct surface_point {
    double distance;
    vec3 position;
    vec3 geometric;  // the normal of the triangle, towards the ray's origin
    vec3 lifted;     // the position where shadow rays start
    vec3 normal, tangent, bitangent;
    double s, t;
    double right[2], down[2];  // what (s, t) grow by from pixel to pixel; 0: nothing is known
    size_t triangle;
    double corner[3];  // weights
    int part;
};
struct ray {
    vec3 origin, direction;
};
bool objects_hit(struct surface_point *out, const relume_objects *o, vec3 origin, vec3 direction);
// What a ray in `direction` has hit.
void objects_point(struct surface_point *out, const relume_objects *o, const struct trace_hit *hit,
                   vec3 direction);
// The object whose surface is all around a place, as that of a closed mesh is; -1: there is none.
int objects_around(const relume_objects *o, vec3 place);
// A note that the eye is within an object, unless that was `said` before.
void objects_say_around(bool *said, const relume_objects *o, vec3 eye,
                        const struct relume_log *log);
// Where rays from the point begin: just off the surface.
vec3 point_leave(const struct surface_point *point);
// How far a pixel spreads over the surface: from the ray that hit the point to the rays of the
// pixels to the right and below (Igehy 1999).
void objects_spread(struct surface_point *point, const relume_objects *o, const struct ray *ray,
                    const struct ray *right, const struct ray *below);
// Whether nothing lies between a point of a surface and what shines `towards` it from `distance`
// away. `normal` may be zero: the point is not the objects'.
bool objects_reached(const relume_objects *o, vec3 point, vec3 normal, vec3 towards,
                     double distance);

// ---------------------------------------------------------------- light

// Neighbours look for other ones of the finer samples of an environment each; their mean is taken.
enum { SKY_PATTERN = 2, SKY_FINE = SKY_PATTERN * SKY_PATTERN * RELUME_OBJECT_LIGHTS_MOST };
// An environment on each of the materials; what is not shown has none.
struct sky_light {
    int first, light_samples;
    struct relume_light *fine;  // [SKY_FINE]: more of them, shared by SKY_PATTERN^2 pixels
    relume_prefiltered_maps **prefiltered;  // [materials]; NULL also where it is that of another
    relume_btf_environment **sky;           // [materials]
};
// What mirrors show: a panorama with the places that it shows, or environments.
struct surround {
    const struct relume_geometry *geometry;  // NULL: no panorama
    struct relume_image panorama, places;    // owned
    enum relume_filter filter;
    const struct relume_light *light;  // borrowed; other ones than environments do not count
    int lights;
    const struct scenery *scenery;  // shows what it sends, of one light; NULL: it does not
};
// Bodies of translucent material.
struct bodies;
struct glow;
struct lighting {
    struct surround surround;
    struct relume_object_light *light_sample;
    int light_samples;
    struct sky_light *sky;
    int skies;
    int materials;
    bool no_shadows;
    const struct scenery *const *scenery;  // [sceneries]: they stand in the way of lamps
    int sceneries;
    int every;     // of the samples of environments one in so many is looked for, ...
    uint64_t key;  // ... from any on
    // [skies]: which share of each reaches the objects, as share_of_sky has it, at value `pixel` of
    // images of three channels; NaN: look. NULL: look always.
    const struct relume_image *shares;
    size_t pixel;
    const struct bodies *bodies;   // NULL: what is translucent is shown matte
    struct glow *glow, *gathered;  // [bodies]: by lamps, and by arrivals; NULL: not
    float sends;                   // which part of what objects send of their own counts
    baked_lit **baked;             // [lights][materials]; NULL: it is near, or not baked
    size_t baked_count;
};
// RELUME_ENOMEM, RELUME_EINVAL. The caller destroys what is in `out`, whatever is returned.
relume_status lighting_create(struct lighting *out, const relume_objects *o,
                              const struct relume_light *lights, int n,
                              const struct relume_render_params *params);
void lighting_destroy(struct lighting *lighting);

// Whether a part is a mirror that has nothing to show, and what is said then.
#define SURROUND_LACKS                                                                             \
    "mirrors are black: outside of panoramas they show environment lights only, and there is "     \
    "none; add --light \"env MAP\""
bool objects_have_mirrors(const relume_objects *o);
bool surround_lacks(const struct surround *surround, const relume_objects *o);
// What lies in a direction (unit) from a place.
void surround_value(float rgb[3], const struct surround *surround, vec3 place, vec3 direction);
// What `eye` sees in a mirror at a point, past other mirrors. Objects are seen in it where light
// goes between them and a scene.
struct mirrored {
    float part[3];               // of it comes back
    vec3 from, direction;        // of the last mirror's ray
    bool meets;                  // an object, in `point`
    struct surface_point point;  // else what is around is seen
};
void mirror_follow(struct mirrored *out, const relume_objects *o, const struct surface_point *point,
                   vec3 eye, const struct lighting *lighting);
bool objects_mirror_at(const relume_objects *o, const struct surface_point *point);
// What a mirror shows to `eye` there.
void mirror_shade(float rgb[3], const relume_objects *o, const struct surface_point *point,
                  vec3 eye, const struct lighting *lighting);

// What the material shows at a point, of lights and to eyes in its own frame; no mirror, nothing
// baked.
void objects_ask(float rgb[3], const relume_objects *o, const struct surface_point *point,
                 const struct relume_btf_ray *ray);

// What is baked under the lights of a lighting. RELUME_ENOMEM; lighting_destroy frees it.
relume_status lighting_bakes(struct lighting *l, const relume_objects *o, int threads);
void lighting_bakes_free(struct lighting *l);
// As objects_shade and objects_return; false where the point is of nothing baked.
bool baked_shade(float rgb[3], const relume_objects *o, const struct surface_point *point, vec3 eye,
                 const struct lighting *lighting);
bool baked_return(float rgb[3], const relume_objects *o, const struct surface_point *point,
                  vec3 eye, const struct arrival *arrival);

// Whether nothing stands before a lamp.
bool objects_lit(const relume_objects *o, const struct surface_point *p, const struct lighting *l,
                 vec3 towards, double distance);

// The bodies of the materials that are shown, made anew when these are others; they begin as NULL.
// RELUME_ENOMEM, RELUME_ECANCEL.
relume_status bodies_need(struct bodies **bodies, const relume_objects *o, int threads,
                          const struct relume_log *log);
void bodies_destroy(struct bodies **bodies);
// The lamps of a lighting that is complete but for this enter the bodies, which are borrowed.
// RELUME_ENOMEM, RELUME_ECANCEL.
relume_status lighting_enters(struct lighting *l, const relume_objects *o,
                              const struct bodies *bodies, int threads,
                              const struct relume_log *log);
// What a way of transport gathers there enters, too. Likewise.
relume_status lighting_gathers(struct lighting *l, const relume_objects *o, const struct world *w,
                               const struct relume_transport *transport,
                               const struct relume_log *log);
void glows_free(struct glow **glows, const struct bodies *bodies);
// Which body a part belongs to; -1: none. Whether there is one.
int translucent_body(const struct lighting *l, int part);
bool lighting_scatters(const struct lighting *l);
// What of the lamps' light leaves a place of it, and which part of that goes towards `eye`, 1 on
// average.
void translucent_leaves(float rgb[3], const struct lighting *l, int body, vec3 place, vec3 normal);
double translucent_lets_out(const struct lighting *l, int body, const struct surface_point *p,
                            vec3 eye);
// Both, or of what has been gathered. False where the point is no body's.
bool translucent_shade(float rgb[3], const struct lighting *l, const struct surface_point *p,
                       vec3 eye);
bool translucent_return(float rgb[3], const struct lighting *l, const struct surface_point *p,
                        vec3 eye);

// Of what the samples of environment number `sky` send, each by its cosine, the part that arrives.
void share_of_sky(float share[3], const relume_objects *o, const struct surface_point *p,
                  const struct lighting *l, int sky);
// The same by the finer samples that pixel (x, y) has of SKY_PATTERN x SKY_PATTERN.
void share_in_pattern(float share[3], const relume_objects *o, const struct surface_point *p,
                      const struct lighting *l, int sky, int x, int y);
// What the point throws back of light that arrives; nothing of a mirror.
void objects_return(float rgb[3], const relume_objects *o, const struct surface_point *point,
                    vec3 eye, const struct arrival *arrival);
// What the point shows of all lights.
void objects_shade(float rgb[3], const relume_objects *o, const struct surface_point *point,
                   vec3 eye, const struct lighting *lighting);

// ---------------------------------------------------------------- pictures

// Pixels of a picture over several cores: `value` is called for places in pixels, centres at +0.5,
// `step` apart.
typedef void pixel_value(float rgb[3], const void *context, double x, double y, double step);
relume_status objects_trace(struct relume_image *out, pixel_value *value, const void *context,
                            const struct relume_render_params *params);

// What leaves bodies, for all pixels of a picture, of which `ray` gives the rays. NULL where there
// is none. RELUME_ENOMEM, RELUME_ECANCEL.
struct seen;
typedef struct ray pixel_ray(const void *context, double x, double y);
relume_status seen_create(struct seen **out, const relume_objects *o,
                          const struct lighting *lighting, int width, int height, pixel_ray *ray,
                          const void *context, const struct relume_render_params *params);
void seen_destroy(struct seen **s);
// As translucent_shade, by the pixel that the place lies in; false also where that is not known.
bool seen_shade(float rgb[3], const struct seen *s, const struct surface_point *point, vec3 eye,
                double x, double y);

// Whether what it says of transport is within its ranges.
bool render_params_good(const struct relume_render_params *params);
// Whether light goes between a scene and the objects.
bool render_exchanges(const struct relume_render_params *params);

// A scene and the objects, where they are before it.
struct layered {
    const relume_objects *o;
    const struct relume_viewport *viewport;
    const struct relume_image *scene, *places;
    const struct relume_image *reflected;  // light of the scene that objects show; empty: none
    const struct relume_image *shares;     // of environments, that reach objects; NULL: not known
    const struct lighting *lighting;
};
// `*out` is created, of the scene's size. Errors of objects_trace.
relume_status objects_layer(struct relume_image *out, const struct layered *l,
                            const struct relume_render_params *params);

// ---------------------------------------------------------------- the scene

// Which way the scene faces in a pixel, from the places beside it; 0 where they are too far away.
vec3 scene_normal(const struct relume_image *places, int x, int y);
// The share of `n` samples of a light that reach a place of the scene past the objects, one in
// `every` of them looked for.
double scene_share(const relume_objects *o, const struct relume_object_light *light_sample, int n,
                   vec3 place, vec3 normal, int every, uint64_t key);

// What one light shows of a scene, each pixel times that share, is added to a picture.
struct scene_in_shadow {
    const relume_objects *o;
    const struct relume_image *places, *lone;  // NaN: nowhere, where no object stands before it
    struct relume_image *sum;
    const struct relume_object_light *light_sample;
    int light_samples;
    bool none;  // no shadows
};
void scene_add(const struct scene_in_shadow *s, int threads);

// Light between a scene and the objects in it at the pixels of a frame.
struct exchange;
// `captured` and what else is handed over is borrowed. Each of `lights` that will come brings its
// part of what objects send of their own. RELUME_ENOMEM.
relume_status exchange_create(struct exchange **out, const relume_objects *o, int lights,
                              const struct bodies *bodies, const struct scenery *scenery,
                              const struct relume_viewport *viewport,
                              const struct relume_image *places,
                              const struct relume_render_params *params);
void exchange_destroy(struct exchange **e);
// What else than its scenery stands before lamps, for `share` below: with it all of them, borrowed.
void exchange_stand_before(struct exchange *e, const struct scenery *const *all, int count);
// Under one light, in which the scene alone shows `lone` and `captured` sends it: the scene as it
// is with the objects is added to `scene`, what objects show of its light to `reflected` (NULL:
// nobody asks), at pixels where objects are; `share` is filled with share_of_sky there, elsewhere
// with NaN (NULL: it is not asked for, or the light is no environment). RELUME_ENOMEM,
// RELUME_ECANCEL.
relume_status exchange_light(struct exchange *e, struct relume_image *scene,
                             struct relume_image *reflected, struct relume_image *share,
                             const struct relume_image *lone, const struct relume_light *light);

#endif
