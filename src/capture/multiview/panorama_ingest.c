// panorama_ingest.c - relume_panorama_ingest: pictures of all directions become a capture
#include "capture/multiview/panorama.h"
#include "core/math/bilinear.h"

#include "core/base/log.h"
#include "core/base/params.h"
#include "core/base/outdir.h"

#include <math.h>

const char *panorama_picture_name(struct panorama_job *job, int light)
{
    return job->view.images[light] = arena_format(&job->set.arena, "light%04d.exr", light);
}

relume_status panorama_load(struct relume_image *out, const struct panorama_job *job, int camera,
                            int light)
{
    return photo_load(out, &job->set, camera, light, job->common);
}

// ---------------------------------------------------------------- one picture

static relume_status save_upright(struct panorama_job *job)
{
    relume_status status = RELUME_OK;
    job->transfer = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    for (int k = 0; !status && k < job->set.lights; k++) {
        struct relume_image image;
        status = panorama_load(&image, job, 0, k);
        if (!status)
            status = panorama_picture_name(job, k) ? save_inside(job->folder, job->view.images[k],
                                                                 &image, true, job->common->log)
                                                   : RELUME_ENOMEM;
        relume_image_destroy(&image);
    }
    return status;
}

static relume_status one_picture(struct panorama_job *job)
{
    const struct camera_photos *c = &job->set.camera[0];
    if (job->set.count != 1)
        return log_fail(job->common->log, RELUME_EUNFIT,
                        "%s: one of %d pictures; expected one picture of all directions", c->name,
                        job->set.count);
    job->width = job->set.width;
    job->height = job->set.height;
    job->transfer = job->common->transfer;
    if (job->set.turned)
        return save_upright(job);
    for (int k = 0; k < job->set.lights; k++)
        if (!(job->view.images[k] =
                  path_from(&job->set.arena, job->folder, job->dir, c->images[k])))
            return RELUME_ENOMEM;
    return RELUME_OK;
}

static relume_status from_sphere(struct panorama_job *job)
{
    const relume_status status = one_picture(job);
    if (status)
        return status;
    job->geometry = relume_geometry_default(RELUME_SPHERICAL, job->width, job->height);
    if (job->width != 2 * job->height)
        log_line(job->common->log, RELUME_WARNING,
                 "%s: %d x %d pixels; expected twice as wide as high; shown as a whole sphere",
                 job->set.camera[0].name, job->width, job->height);
    return RELUME_OK;
}

// Square pixels on the horizon, which lies in the middle.
static relume_status from_cylinder(struct panorama_job *job)
{
    const relume_status status = one_picture(job);
    if (status)
        return status;
    const double reach = acos(-1.0) * job->height / job->width;
    job->geometry = relume_geometry_default(RELUME_CYLINDRICAL, job->width, job->height);
    const bool given = job->p->v_min != 0.0 || job->p->v_max != 0.0;
    job->geometry.v_min = given ? job->p->v_min : -reach;
    job->geometry.v_max = given ? job->p->v_max : reach;
    if (job->geometry.v_min < job->geometry.v_max)
        return RELUME_OK;
    return log_fail(job->common->log, RELUME_EINVAL,
                    "cylinder: expected v_min < v_max; found %g, %g", job->p->v_min, job->p->v_max);
}

// ---------------------------------------------------------------- depth

// Across the wrap; beside infinity the nearest.
static float resampled(const struct relume_image *image, double x, double y)
{
    const struct bilinear b = bilinear_at(x, y, image->width, image->height, EDGE_WRAPPED);
    const float mean = bilinear_valuef(&b, image->data, 1, 0);
    return isfinite(mean) ? mean : image->data[b.at[(b.across >= 0.5) + 2 * (b.down >= 0.5)]];
}

// Grey to distances: white and black are the ends of the range.
static relume_status to_distances(struct relume_image *depth, const struct panorama_job *job)
{
    const double *range = job->p->depth_range;
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    if (relume_image_saves_linear(job->p->depth))
        return RELUME_OK;
    if (!(range[0] > 0.0) || !(range[1] > 0.0))
        return log_fail(job->common->log, RELUME_EINVAL,
                        "%s: grey values for depth; expected the distances of white and black "
                        "(--depth-range)",
                        job->p->depth);
    for (size_t i = 0; i < n; i++)
        depth->data[i] = (float)(range[1] + (double)depth->data[i] * (range[0] - range[1]));
    return RELUME_OK;
}

static relume_status add_depth(struct panorama_job *job)
{
    struct relume_image in, out = {0};
    const struct relume_transfer as_stored = {.curve = RELUME_CURVE_LINEAR};
    relume_status status = relume_image_load(
        &in, job->p->depth,
        relume_image_params(.log = job->common->log, .channels = 1, .transfer = as_stored));
    if (!status)
        status = to_distances(&in, job);
    if (!status)
        status = relume_image_create(&out, job->width, job->height, 1);
    for (int y = 0; !status && y < job->height; y++)
        for (int x = 0; x < job->width; x++)
            out.data[(size_t)y * (size_t)job->width + (size_t)x] =
                resampled(&in, (x + 0.5) * in.width / job->width - 0.5,
                          (y + 0.5) * in.height / job->height - 0.5);
    job->view.depth = "depth.exr";
    if (!status)
        status = save_inside(job->folder, job->view.depth, &out, false, job->common->log);
    relume_image_destroy(&in);
    relume_image_destroy(&out);
    return status;
}

// ---------------------------------------------------------------- all

static relume_status (*const sources[])(struct panorama_job *job) = {
    [RELUME_PANORAMA_SPHERE] = from_sphere,
    [RELUME_PANORAMA_CYLINDER] = from_cylinder,
    [RELUME_PANORAMA_CUBE] = panorama_from_cube,
    [RELUME_PANORAMA_STITCH] = panorama_from_stitch,
};

static relume_status write_manifest(const struct panorama_job *job)
{
    const struct relume_manifest m = {
        .transfer = job->transfer,
        .geometry = job->geometry,
        .lights = job->set.lights,
        .directions = job->set.directions,
        .views = 1,
        .view = &job->view,
    };
    return save_manifest(job->folder, &m, job->common->log);
}

static relume_status make_folder(struct panorama_job *job, enum relume_panorama_source source)
{
    outdir *folder;
    relume_status status = outdir_open(&folder, job->dir, job->common->force, job->common->log);
    if (status)
        return status;
    job->folder = folder;
    job->view.images =
        arena_array(&job->set.arena, (size_t)job->set.lights, sizeof *job->view.images);
    status = job->view.images ? sources[source](job) : RELUME_ENOMEM;
    if (!status && job->p->depth)
        status = add_depth(job);
    if (!status)
        status = write_manifest(job);
    return outdir_end(&folder, status);
}

relume_status relume_panorama_ingest(const char *dir, const char *const *photos, int n,
                                     enum relume_panorama_source source,
                                     const struct relume_panorama_params *panorama,
                                     const struct relume_ingest_params *params)
{
    const struct relume_panorama_params own = PARAMS(relume_panorama_params, panorama);
    const struct relume_ingest_params common = PARAMS_WORK(relume_ingest_params, params);
    struct panorama_job job = {.p = &own, .common = &common, .dir = dir};
    if ((unsigned)source >= sizeof sources / sizeof *sources)
        return RELUME_EINVAL;
    if (job.p->depth && source > RELUME_PANORAMA_CYLINDER)
        return log_fail(job.common->log, RELUME_EINVAL,
                        "%s: depth; expected only with a sphere or a cylinder", job.p->depth);
    relume_status status = photo_set_open(&job.set, photos, n, job.common);
    if (!status)
        status = make_folder(&job, source);
    photo_set_free(&job.set);
    return status;
}
