#include <relume/capture.h>

#include <string.h>

static const char *const names[] = {
    [RELUME_PLANAR] = "planar",       [RELUME_SLAB] = "slab", [RELUME_CYLINDRICAL] = "cylindrical",
    [RELUME_SPHERICAL] = "spherical", [RELUME_CUBE] = "cube",
};
enum { PROJECTIONS = sizeof names / sizeof *names };

const char *relume_projection_name(enum relume_projection projection)
{
    return (unsigned)projection < PROJECTIONS ? names[projection] : NULL;
}

relume_status relume_projection_parse(enum relume_projection *out, const char *name)
{
    for (int i = 0; i < PROJECTIONS; i++)
        if (!strcmp(name, names[i])) {
            *out = (enum relume_projection)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

struct relume_geometry relume_geometry_default(enum relume_projection projection, int width,
                                               int height)
{
    const double half_height = (double)height / (double)width;
    return (struct relume_geometry){
        .projection = projection,
        .window_min = {-1.0, -half_height},
        .window_max = {1.0, half_height},
        .camera_z = 4.0,
        .uv_z = 3.0,
        .st_min = {-1.0, -1.0},
        .st_max = {1.0, 1.0},
        .v_min = -1.0,
        .v_max = 1.0,
    };
}
