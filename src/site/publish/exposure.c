// exposure.c - the exposure that a page opens with; the page itself finds that of dropped files so
// (web/measure.js)
#include "site/publish/exposure.h"

#include "core/base/memory.h"
#include "core/math/sort.h"
#include "site/publish/picture.h"

#include <math.h>
#include <relume/core/vec.h>
#include <relume/relight/tone.h>

enum { SIDE = 128 };
#define MOST_EV    2.0
#define WHITE_PART 0.99  // of the pixels are not beyond white

// The exposure that takes the brightest channels to white.
static relume_status brightest(double *ev, const struct relume_image *picture)
{
    const size_t n = (size_t)picture->width * (size_t)picture->height;
    double *most = mem_array(n, sizeof *most);
    if (!most)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const float *p = picture->data + 3 * i;
        most[i] = (double)fmaxf(p[0], fmaxf(p[1], p[2]));
    }
    sort_doubles(most, n);
    *ev = -log2(fmax(most[(size_t)(WHITE_PART * (double)(n - 1) + 0.5)], 1e-6));
    mem_free(most);
    return RELUME_OK;
}

relume_status exposure_find(double *ev, relume_pack *pack, const struct site *site)
{
    const bool around = relume_pack_info(pack)->geometry.projection >= RELUME_CYLINDRICAL;
    // as firstLight of web/lights.js
    const struct relume_vec3 first =
        around ? (struct relume_vec3){-0.5, 0.8, 0.33} : (struct relume_vec3){-0.62, 0.55, 0.56};
    const struct relume_vec3 front =
        around ? (struct relume_vec3){0, 1, 0} : (struct relume_vec3){0, 0, 1};
    struct relume_image picture = {0};
    double metered = 0.0, most = 0.0;
    relume_status status = picture_lit(&picture, pack, SIDE, false, relume_vec3_unit(first), site);
    if (!status)
        metered = relume_tone_meter(&picture);
    relume_image_destroy(&picture);
    if (!status)
        status = picture_lit(&picture, pack, SIDE, false, front, site);
    if (!status)
        status = brightest(&most, &picture);
    relume_image_destroy(&picture);
    *ev = rint(10.0 * fmax(fmin(fmin(metered, most), MOST_EV) - 0.05, 0.0)) / 10.0;
    return status;
}
