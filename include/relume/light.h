// light.h - kinds of light, and what each sends to a point of the scene
#ifndef RELUME_LIGHT_H
#define RELUME_LIGHT_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// Kinds of light; in a SPEC by the names of relume_light_kind_name.
enum relume_light_kind {
    RELUME_LIGHT_DIRECTIONAL = 0,
    RELUME_LIGHT_ENVIRONMENT,  // distant as well: all directions at once
    RELUME_LIGHT_POINT,        // from here on near: the direction differs from pixel to pixel
    RELUME_LIGHT_SPOT,
    RELUME_LIGHT_SLIDE,
    RELUME_LIGHT_AREA,
    RELUME_LIGHT_IES,
    RELUME_LIGHT_GONIO,
};

typedef struct relume_ies relume_ies;                  // a goniometric distribution: a table
typedef struct relume_gonio relume_gonio;              // ... and as a picture
typedef struct relume_environment relume_environment;  // a map of distant radiance

// A light of value 1 (near ones: at distance 1) gives a white Lambertian surface facing it the
// value 1. Environments and areas are radiances E that weigh E dw / pi. Plain data.
struct relume_light {
    enum relume_light_kind kind;
    struct relume_vec3 direction;  // directional: towards the light; spot, slide, ies, gonio: the
                                   // axis along which it shines; any length but 0
    struct relume_vec3 position;   // near ones, world units; area: the centre
    struct relume_vec3 u, v;       // area: half edges; it emits towards u x v
    bool disc;                     // area: the ellipse inside, not the rectangle
    bool nofall;                   // all near ones but area: the same value at every distance
    double half_angle_deg;         // (0, 90). spot: full inside 0.9 of it, smoothstep to 0;
                                   // slide: half the width of the picture
    double rotate_deg;             // environment: > 0 turns it from -z towards +x
    float rgb[3];                  // linear value
    const struct relume_image *image;       // slide: the picture, linear, three channels; borrowed
    const relume_environment *environment;  // borrowed
    const relume_ies *ies;                  // borrowed
    const relume_gonio *gonio;              // borrowed
};

// "dir", "env", "point", ... as in a SPEC (rig.h); never NULL.
RELUME_API const char *relume_light_kind_name(enum relume_light_kind kind);

// Whether the light needs to know where the surface is.
static inline bool relume_light_is_near(enum relume_light_kind kind)
{
    return kind >= RELUME_LIGHT_POINT;
}

// Whether two lights are the same in everything; what they point at is the same object, whose
// content is not looked at.
RELUME_API bool relume_light_equal(const struct relume_light *a, const struct relume_light *b);

// RELUME_EINVAL with a sentence that begins with `name` unless every number is finite, directions
// have a length, angles are in range and what the kind needs is there.
RELUME_RESULT relume_status relume_light_check(const struct relume_light *light, const char *name,
                                               const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
