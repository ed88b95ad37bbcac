//
#ifndef REFLECT_REFLECTION_H
#define REFLECT_REFLECTION_H

#include <relume/world/reflection.h>

// Plain data. Directions have any length but 0 and point away from the surface.
struct relume_reflection_constraint {
    struct relume_vec3 position;  // p, on the surface, world units
    struct relume_vec3 original;  // r: what is reflected there unedited, as `eye` sees it
    struct relume_vec3 edited;    // e: what shall be reflected
    struct relume_vec3 eye;       // where it was made from; to return to
};

// What a region of an edit is.
enum relume_reflection_shape {
    RELUME_REFLECTION_BALL = 0,  // all surface within `radius` of the centre, also of other pieces
    RELUME_REFLECTION_GEODESIC,  // `radius` along the surface, from its place nearest to the centre
    RELUME_REFLECTION_STROKES,   // within `radius` of lines drawn on the surface
};

// Where an edit is seen. Plain data; points are borrowed as said where it is used.
struct relume_reflection_region {
    enum relume_reflection_shape shape;  // BALL, GEODESIC or STROKES
    struct relume_vec3 centre;           // BALL, GEODESIC
    double radius;                       // > 0: within it the edit is seen whole
    double border;                       // >= 0: so much further out it has gone
    const struct relume_vec3 *stroke;    // STROKES: `points` places, at least one; a line from each
    int points;                          // to the next
};

enum {
    RELUME_REFLECTION_CONSTRAINTS_MOST = 256,
    RELUME_REFLECTION_REGIONS_MOST = 32
};  // of an edit

// What is done to the reflections of an object. Plain data.
struct relume_reflection_edit {
    const struct relume_reflection_constraint *constraint;  // [constraints]; none: all as it is
    int constraints;                                // at most RELUME_REFLECTION_CONSTRAINTS_MOST
    const struct relume_reflection_region *region;  // [regions]; none: everywhere
    int regions;                                    // at most RELUME_REFLECTION_REGIONS_MOST
    bool geodesic;                                  // d along the surface; else straight
    bool frozen;             // reflections are those that `eye` sees, wherever one looks from
    struct relume_vec3 eye;  // of `frozen`
};

// A surface, for distances along it: borrowed during the call. Triangles that meet in equal places
// are joined.
struct relume_reflection_surface {
    const float *position;  // x, y, z of the first vertex
    size_t stride;          // bytes from one vertex to the next
    size_t vertices;
    const uint32_t (*triangle)[3];  // [triangles]
    size_t triangles;
};

// Copies the edit. Warns of constraints outside every region, which do nothing, and of those in one
// place that want different things, of which the mean is shown. RELUME_EINVAL with a sentence where
// a number is not finite, a place or radius beyond 1e15, a direction 0, a radius not above 0, a
// count too large; RELUME_ENOMEM.
relume_status relume_reflection_create(relume_reflection **out,
                                       const struct relume_reflection_edit *edit,
                                       const struct relume_reflection_surface *surface,
                                       const struct relume_reflection_params *params);
void relume_reflection_destroy(relume_reflection **reflection);
// The edit, whose directions are unit vectors; it belongs to the reflection.
const struct relume_reflection_edit *relume_reflection_edit(const relume_reflection *reflection);

// Constraints that count together: those of a region, or all where there are no regions. They
// belong to the reflection.
struct relume_reflection_set {
    const int *member;  // [members]: numbers of constraints
    int members;        // how many
};
// One for each region, or a single one. `*least`, in world units: no distance to a constraint is
// taken to be less. For whoever draws by themselves.
struct relume_reflection_set relume_reflection_set_of(double *least,
                                                      const relume_reflection *reflection,
                                                      int region);
// Whether a constraint does something: it lies in a region, or there are no regions.
bool relume_reflection_acts(const relume_reflection *reflection, int constraint);
// Distances along the surface that the edit has measured: of each vertex, in world units, infinite
// on pieces that do not hang together with their origin. NULL: they are straight. They belong to
// the reflection. Between vertices they are interpolated, but near their origin, where that is
// wrong, straight distances count: up to 2 edges away, and less by a smooth step up to 4.
const float *relume_reflection_from_constraint(const relume_reflection *reflection, int constraint);
// The same from the centre of a region.
const float *relume_reflection_from_region(const relume_reflection *reflection, int region);
// Such an edge: the mean length of the triangles'; 0 where nothing is measured along the surface.
double relume_reflection_edge(const relume_reflection *reflection);
// a(q) of a region, in [0, 1].
double relume_reflection_weight(const relume_reflection *reflection, int region,
                                const struct relume_reflection_place *place);
// The edited direction e(q) = R_a(q) r of the unit vector r.
struct relume_vec3 relume_reflection_turn(const relume_reflection *reflection,
                                          const struct relume_reflection_place *place,
                                          struct relume_vec3 r);
// Many places.
struct relume_reflection_places {
    const float *x, *y, *z;  // [n] each: positions
    float *rx, *ry, *rz;     // [n] each: unit directions, in and out
    size_t n;                // how many
};

// r of Eq. 7.1, unit: what a mirror of unit normal n shows at `position` to `eye`, or to the eye of
// a frozen edit (NULL: no edit).
struct relume_vec3 relume_reflection_original(const relume_reflection *reflection,
                                              struct relume_vec3 position,
                                              struct relume_vec3 normal, struct relume_vec3 eye);

// relume_reflection_turn for all of them, in single precision, over several cores; `cpu_off` as
// relume_relight_params. Directions are replaced by the edited ones. Equal bits for any number of
// threads. RELUME_EUNFIT for edits that go along the surface; RELUME_ENOMEM.
relume_status relume_reflection_turn_all(const relume_reflection *reflection,
                                         const struct relume_reflection_places *places,
                                         unsigned cpu_off, int threads);

#endif
