// fuzz_look.h - objects that were accepted are looked at, where every value must be finite
#ifndef FUZZ_LOOK_H
#define FUZZ_LOOK_H

#include "fuzz.h"

#include <math.h>
#include <relume/core/vec.h>
#include <relume/world/object.h>

static inline void look(const relume_objects *o)
{
    const struct relume_light light = {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}};
    struct relume_window window;
    struct relume_image image;
    mem_fail_after(0);
    if (!relume_objects_window(&window, o, (struct relume_vec3){0.7, 1.1, 2.9}, NULL, 6, 5))
        return;
    if (relume_image_create(&image, 6, 5, 3) ||
        relume_objects_render(&image, o, &window, &light, 1, relume_render_params(.threads = 1)))
        abort();
    for (int i = 0; i < 6 * 5 * 3; i++)
        if (!isfinite(image.data[i]))
            abort();
    relume_image_destroy(&image);
    for (int i = 0; i < 6 * 5; i++) {
        const struct relume_vec3 at =
            relume_vec3_along(relume_vec3_along(window.corner, window.right, (i % 6 + 0.5) / 6.0),
                              window.down, (i / 6 + 0.5) / 5.0);
        struct relume_object_reflection seen;
        if (relume_objects_reflect(&seen, o, window.eye, relume_vec3_sub(at, window.eye)) &&
            !(fabs(relume_vec3_length(seen.edited) - 1.0) < 1e-6))
            abort();
    }
}

// A BTF in the folder, called "btf".
static inline void make_material(struct fuzz *f)
{
    static const struct relume_vec3 d[4] = {
        {0, 0, 1}, {0.8, 0, 0.6}, {-0.48, 0.64, 0.6}, {-0.48, -0.64, 0.6}};
    const struct relume_btf_info info = {
        .name = "made", .width = 2, .height = 2, .views = 4, .lights = 4, .view = d, .light = d};
    char path[128];
    relume_btf *btf;
    snprintf(path, sizeof path, "%s/btf", f->folder);
    if (relume_btf_create(&btf, &info, NULL) || relume_btf_save(btf, path, NULL))
        abort();
    relume_btf_destroy(&btf);
}

#endif
