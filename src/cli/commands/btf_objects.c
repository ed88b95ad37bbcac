// btf_objects.c - relume btf render --mesh, or of a description of objects
#include "commands/btf_inputs.h"
#include "frame_options.h"
#include "output_name.h"

#include <math.h>
#include <string.h>

bool btf_is_objects(const struct btf_options *o)
{
    const char *name = o->args.input[0], *dot = strrchr(name, '.');
    return o->mesh || (dot && !strcmp(dot, ".json"));
}

relume_status objects_open(relume_objects **out, const char *path, const struct args *args)
{
    return relume_objects_open(out, path,
                               relume_objects_params(.log = args->log, .threads = args->threads));
}

static relume_status open_them(relume_objects **out, const struct btf_options *o)
{
    const char *input = o->args.input[0], *mesh = o->mesh;
    *out = NULL;
    if (!mesh)
        return objects_open(out, input, &o->args);
    return relume_objects_of_mesh(
        out, mesh, &input, 1, o->repeat,
        relume_objects_params(.log = o->args.log, .threads = o->args.threads));
}

static relume_status parse_window(struct relume_window *out, int size[2],
                                  const relume_objects *objects, const struct btf_options *o)
{
    const struct relume_objects_info *i = relume_objects_info(objects);
    const struct relume_vec3 middle = {0.5 * (i->min.x + i->max.x), 0.5 * (i->min.y + i->max.y),
                                       0.5 * (i->min.z + i->max.z)};
    const double extent = sqrt(pow(i->max.x - i->min.x, 2) + pow(i->max.y - i->min.y, 2) +
                               pow(i->max.z - i->min.z, 2));
    struct relume_vec3 eye = {middle.x, middle.y + 0.6 * extent, middle.z + 1.8 * extent};
    struct relume_look_at aim = {.aimed = o->look_at, .field_of_view_deg = o->fov};
    const char *text = o->picture ? o->picture : "512x512";
    char rest;
    if (sscanf(text, "%dx%d%c", &size[0], &size[1], &rest) != 2 || size[0] < 1 || size[0] > 16384 ||
        size[1] < 1 || size[1] > 16384)
        return usage_error("--picture: expected WIDTHxHEIGHT, at most 16384 a side; found '%s'",
                           text);
    relume_status status = RELUME_OK;
    if (o->eye)
        status = args_vec3(&eye, "--eye", o->eye);
    if (!status && aim.aimed)
        status = args_vec3(&aim.at, "--look-at", o->look_at);
    if (!status && o->up)
        status = args_vec3(&aim.up, "--up", o->up);
    if (!status && !relume_objects_window(out, objects, eye, &aim, size[0], size[1]))
        status = usage_error("--eye: expected a point away from --look-at, and not straight above "
                             "or below it along --up");
    return status;
}

static relume_status render(struct relume_image *image, const relume_objects *objects,
                            const struct relume_window *window, const struct btf_options *o)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    relume_status status = parse_lights(&o->args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = relume_objects_render(
            image, objects, window, lights, count,
            relume_render_params(.log = o->args.log, .samples = o->samples,
                                 .no_shadows = o->no_shadows, .threads = o->args.threads));
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render_objects(const struct btf_options *o)
{
    relume_objects *objects = NULL;
    struct relume_window window;
    struct relume_image image = {0};
    int size[2];
    if (!o->output)
        return usage_error("btf render: expected -o FILE");
    relume_status status = picture_name("-o", o->output);
    if (!status)
        status = open_them(&objects, o);
    if (!status)
        status = parse_window(&window, size, objects, o);
    if (!status)
        status = relume_image_create(&image, size[0], size[1], 3);
    if (!status)
        status = render(&image, objects, &window, o);
    if (!status)
        status = relume_image_save(&image, o->output, relume_image_params(.log = o->args.log));
    relume_image_destroy(&image);
    relume_objects_destroy(&objects);
    return status;
}
