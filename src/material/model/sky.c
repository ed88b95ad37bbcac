// sky.c - a model under an environment, for any orientation
//
// The exact weights of the measured lights (ambient.c) are integrals of the radiance against the
// pyramids of interpolation. A pyramid is all but round, and wherever the surface turns, it stays
// the same in the frame of the sample: so it is exchanged, once, for the cosine lobe that has its
// integral and its first moment, and the radiance under a lobe is in the prefiltered maps.
#include "material/model/ambient.h"

#include "core/base/memory.h"
#include "material/btf/values.h"
#include "material/model/environment.h"

static const double SHARPEST = 128.0;  // of the maps

// A lobe max(0, cos)^e has the mean cosine (e + 1) / (e + 2).
static double exponent_of(double mean_cosine)
{
    const double e = (2.0 * mean_cosine - 1.0) / fmax(1.0 - mean_cosine, 1e-9);
    return fmin(fmax(e, 1.0), SHARPEST);
}

static void add_direction(struct relume_btf_environment *s, vec3 d, double solid_angle)
{
    const struct relume_direction_blend b = relume_direction_mesh_at(s->model->light_mesh, d);
    const double arrives = (s->model->without_cosine ? d.z : b.rim / b.length) * solid_angle / M_PI;
    for (int i = 0; i < b.count; i++) {
        struct relume_btf_light_lobe *cone = &s->cone[b.index[i]];
        cone->weight += arrives * b.weight[i];
        cone->axis = vec3_along(cone->axis, d, arrives * b.weight[i]);
    }
}

static void fill_cones(struct relume_btf_environment *s)
{
    enum { ROWS = 48, COLUMNS = 128 };
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        const double z = (i / COLUMNS + 0.5) / ROWS, r = sqrt(1.0 - z * z);
        const double phi = (i % COLUMNS + 0.5) / COLUMNS * 2.0 * M_PI;
        add_direction(s, vec3_of(r * cos(phi), r * sin(phi), z), 2.0 * M_PI / (ROWS * COLUMNS));
    }
    for (int i = 0; i < s->model->lights; i++) {
        struct relume_btf_light_lobe *cone = &s->cone[i];
        const double length = vec3_length(cone->axis);
        const bool lit = length > 0.0;  // all but what is far below the grid
        cone->exponent = lit ? exponent_of(length / cone->weight) : 1.0;
        cone->axis = lit ? vec3_scale(cone->axis, 1.0 / length) : s->model->light[i];
    }
}

relume_status relume_btf_environment_create(relume_btf_environment **out,
                                            const relume_btf_fitted *model,
                                            const relume_prefiltered_maps *prefiltered)
{
    relume_btf_environment *s = mem_zeroed(1, sizeof *s);
    *out = s;
    if (!s)
        return RELUME_ENOMEM;
    s->model = model;
    s->prefiltered = prefiltered;
    s->cone = mem_zeroed((size_t)model->lights, sizeof *s->cone);
    if (s->cone)
        fill_cones(s);
    else
        relume_btf_environment_destroy(out);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void relume_btf_environment_destroy(relume_btf_environment **sky)
{
    if (*sky)
        mem_free((*sky)->cone);
    mem_free(*sky);
    *sky = NULL;
}

const struct relume_btf_light_lobe *relume_btf_environment_cones(const relume_btf_environment *sky)
{
    return sky->cone;
}

void relume_btf_environment_weight(float rgb[3], const relume_btf_environment *sky,
                                   const struct relume_btf_frame *f, int i)
{
    const struct relume_btf_light_lobe *cone = &sky->cone[i];
    const vec3 axis =
        vec3_add(vec3_scale(f->right, cone->axis.x),
                 vec3_along(vec3_scale(f->up, cone->axis.y), f->normal, cone->axis.z));
    relume_prefiltered_maps_specular(rgb, sky->prefiltered, axis, cone->exponent);
    for (int c = 0; c < 3; c++)
        rgb[c] *= (float)cone->weight;
}

struct relume_btf_oriented_light sky_ambient(const relume_btf_environment *sky,
                                             const struct relume_btf_frame *frame)
{
    const relume_btf_fitted *m = sky->model;
    struct relume_btf_oriented_light a = {
        .model = m, .prefiltered = sky->prefiltered, .frame = *frame};
    // the mean under a lobe of exponent 1 is the integral of n.l E / pi
    relume_prefiltered_maps_specular(a.even[1], sky->prefiltered, frame->normal, 1.0);
    relume_prefiltered_maps_diffuse(a.even[0], sky->prefiltered, frame->normal);
    for (int c = 0; c < 3 && m->without_cosine; c++)
        a.even[0][c] = a.even[1][c];
    return a;
}
