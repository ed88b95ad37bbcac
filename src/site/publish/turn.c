// turn.c - still pictures of a baked object
#include "site/publish/turn.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"
#include "site/publish/picture.h"

#include <math.h>
#include <relume/world/object.h>

// As the page opens: from a little above, lit from the upper left of who looks.
static relume_status write_one(const struct site *site, const struct page *page,
                               relume_objects *objects, int step, const char *path)
{
    const double angle = step * (2.0 * M_PI / TURN_STEPS), sine = sin(angle), cosine = cos(angle);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL,
        .direction = {-0.4 * cosine + 0.7 * sine, 0.6, 0.4 * sine + 0.7 * cosine},
        .rgb = {1.0f, 1.0f, 1.0f}};
    const struct relume_render_params params = {.struct_size = sizeof params,
                                                .log = site->log,
                                                .samples = 2,
                                                .threads = site->params->threads};
    const struct relume_objects_info *i = relume_objects_info(objects);
    const vec3 across = vec3_sub(i->max, i->min);
    const vec3 eye = vec3_along(vec3_scale(vec3_add(i->min, i->max), 0.5),
                                vec3_of(1.8 * sine, 0.6, 1.8 * cosine), vec3_length(across));
    const struct relume_look_at look = {.aimed = false};
    const int width = step ? TURN_WIDTH : POSTER_WIDTH, height = step ? TURN_HEIGHT : POSTER_HEIGHT;
    const struct relume_rect all = {0, 0, width, height};
    struct relume_image image = {0};
    struct relume_window window;
    if (!relume_objects_window(&window, objects, eye, &look, width, height))
        return log_fail(site->log, RELUME_EFORMAT, "%s: an object without extent", path);
    char *name = step ? mem_format("%s/iiif/turn-%d.jpg", page->name, step)
                      : mem_format("%s/poster.jpg", page->name);
    relume_status status = name ? relume_image_create(&image, width, height, 3) : RELUME_ENOMEM;
    if (!status)
        status = relume_objects_render(&image, objects, &window, &light, 1, &params);
    if (!status)
        status = picture_save_jpeg(site, name, &image, &all);
    relume_image_destroy(&image);
    mem_free(name);
    return status;
}

relume_status turn_write(const struct site *site, struct page *page, const char *path)
{
    relume_objects *objects = NULL;
    relume_status status =
        relume_objects_open(&objects, path,
                            relume_objects_params(.log = site->log, .limits = site->params->limits,
                                                  .threads = site->params->threads));
    for (int step = 0; !status && step < TURN_STEPS; step++)
        status = write_one(site, page, objects, step, path);
    page->poster_width = POSTER_WIDTH;
    page->poster_height = POSTER_HEIGHT;
    relume_objects_destroy(&objects);
    return status;
}
