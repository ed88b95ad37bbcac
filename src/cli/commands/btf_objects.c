// btf_objects.c - relume btf render --mesh, or of a description of objects
#include "commands/btf_inputs.h"
#include "frame_options.h"
#include "output_name.h"

#include <math.h>
#include <string.h>

bool btf_is_objects(const struct args *args)
{
    const char *name = args_input(args, 1), *dot = strrchr(name, '.');
    return args_has(args, "--mesh") || (dot && !strcmp(dot, ".json"));
}

relume_status objects_open(relume_objects **out, const char *path, const struct args *args)
{
    return relume_objects_open(
        out, path, relume_objects_params(.log = args_log(args), .threads = args_threads(args)));
}

static relume_status open_them(relume_objects **out, const struct args *args)
{
    const char *input = args_input(args, 1), *mesh = args_text(args, "--mesh", NULL);
    *out = NULL;
    if (!mesh)
        return objects_open(out, input, args);
    return relume_objects_of_mesh(
        out, mesh, &input, 1, args_number(args, "--repeat", 1.0),
        relume_objects_params(.log = args_log(args), .threads = args_threads(args)));
}

static relume_status parse_window(struct relume_window *out, int size[2], const relume_objects *o,
                                  const struct args *args)
{
    const struct relume_objects_info *i = relume_objects_info(o);
    const struct relume_vec3 middle = {0.5 * (i->min.x + i->max.x), 0.5 * (i->min.y + i->max.y),
                                       0.5 * (i->min.z + i->max.z)};
    const double extent = sqrt(pow(i->max.x - i->min.x, 2) + pow(i->max.y - i->min.y, 2) +
                               pow(i->max.z - i->min.z, 2));
    struct relume_vec3 eye = {middle.x, middle.y + 0.6 * extent, middle.z + 1.8 * extent};
    struct relume_aim aim = {.aimed = args_has(args, "--look-at"),
                             .field_of_view_deg = args_number(args, "--fov", 0.0)};
    const char *text = args_text(args, "--picture", "512x512");
    char rest;
    if (sscanf(text, "%dx%d%c", &size[0], &size[1], &rest) != 2 || size[0] < 1 || size[0] > 16384 ||
        size[1] < 1 || size[1] > 16384)
        return usage_error("--picture: expected WIDTHxHEIGHT, at most 16384 a side; found '%s'",
                           text);
    relume_status status = RELUME_OK;
    if (args_has(args, "--eye"))
        status = args_vec3(&eye, "--eye", args_text(args, "--eye", NULL));
    if (!status && aim.aimed)
        status = args_vec3(&aim.at, "--look-at", args_text(args, "--look-at", NULL));
    if (!status && args_has(args, "--up"))
        status = args_vec3(&aim.up, "--up", args_text(args, "--up", NULL));
    if (!status && !relume_objects_window(out, o, eye, &aim, size[0], size[1]))
        status = usage_error("--eye: expected a point away from --look-at, and not straight above "
                             "or below it along --up");
    return status;
}

static relume_status render(struct relume_image *image, const relume_objects *o,
                            const struct relume_window *window, const struct args *args)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    relume_status status = parse_lights(args, &rig, &lights, &count);
    if (!status)
        status = relume_objects_render(
            image, o, window, lights, count,
            relume_render_params(.log = args_log(args), .samples = args_int(args, "--samples", 3),
                                 .no_shadows = args_has(args, "--no-shadows"),
                                 .threads = args_threads(args)));
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render_objects(const struct args *args)
{
    relume_objects *o = NULL;
    struct relume_window window;
    struct relume_image image = {0};
    int size[2];
    if (!args_has(args, "-o"))
        return usage_error("btf render: expected -o FILE");
    relume_status status = picture_name("-o", args_text(args, "-o", NULL));
    if (!status)
        status = open_them(&o, args);
    if (!status)
        status = parse_window(&window, size, o, args);
    if (!status)
        status = relume_image_create(&image, size[0], size[1], 3);
    if (!status)
        status = render(&image, o, &window, args);
    if (!status)
        status = relume_image_save(&image, args_text(args, "-o", NULL),
                                   relume_image_params(.log = args_log(args)));
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
    return status;
}
