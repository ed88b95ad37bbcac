// scene_bust.c - a bust before the dark: a model from a file, or a marble head of our own
#include "core/base/log.h"
#include "shape/mesh/mesh_read.h"
#include "world/stage/scene.h"

static const double REACH = 0.93;  // of the window's half width

static struct material stone(void)
{
    return (struct material){
        .texture = {.color = texture_marble,
                    .a = {0.80f, 0.76f, 0.69f},
                    .b = {0.50f, 0.46f, 0.43f},
                    .scale = 1.1f},
        .f0 = {0.04f, 0.04f, 0.04f},
        .alpha = 0.3f,
    };
}

static void add_head(struct relume_scene_builder *b)
{
    static const struct lathe_point chest[] = {
        {0.34, -1.40, true},  {0.40, -1.32, false}, {0.52, -1.12, false},
        {0.50, -0.96, false}, {0.34, -0.84, false}, {0.27, -0.72, false},
        {0.25, -0.56, false}, {0.27, -0.40, false}, {0.20, -0.25, true},
    };
    static const struct lathe_point foot[] = {
        {0.42, -1.80, true},  {0.42, -1.72, true},  {0.37, -1.70, true}, {0.39, -1.66, false},
        {0.26, -1.58, false}, {0.24, -1.46, false}, {0.34, -1.40, true}, {0.0, -1.40, true},
    };
    const uint32_t marble = build_material(b, stone());
    const struct material black = {
        .texture = {.color = texture_marble,
                    .a = {0.045f, 0.05f, 0.055f},
                    .b = {0.30f, 0.28f, 0.25f},
                    .scale = 2.0f},
        .f0 = {0.05f, 0.05f, 0.05f},
        .alpha = 0.12f,
    };
    const struct frame place = frame_compose(frame_move(0, 0.32, 0), frame_scale(0.69, 0.69, 0.69));
    struct mesh part = {0};
    b->frame = frame_compose(place, frame_compose(frame_turn_y(-0.38), frame_turn_x(0.06)));
    shape_head(&part, 480);
    build_put_exact(b, &part, marble);
    // Shoulders are wider than deep; the neck above them stays about round.
    b->frame =
        frame_compose(place, frame_compose(frame_move(0, 0, -0.06), frame_scale(1.18, 1, 0.85)));
    shape_lathe(&part, chest, sizeof chest / sizeof *chest, 10, 160);
    build_put_exact(b, &part, marble);
    b->frame = frame_compose(place, frame_move(0, 0, -0.06));
    shape_lathe(&part, foot, sizeof foot / sizeof *foot, 8, 128);
    build_put_exact(b, &part, build_material(b, black));
}

static relume_status load_picture(struct relume_scene_builder *b, const char *path,
                                  struct material *material)
{
    struct relume_image *image = &b->pictures[b->picture_count];
    const relume_status status = relume_image_load(image, path, relume_image_params(.log = b->log));
    if (status)
        return status;
    b->picture_count++;
    material->texture = (struct texture){.color = texture_image, .image = image};
    return RELUME_OK;
}

// The model's bounding box, centred and scaled into the window.
static struct frame fit(const struct mesh *mesh)
{
    const struct bounds box = mesh_bounds(mesh);
    const vec3 size = vec3_sub(box.max, box.min);
    const vec3 middle = vec3_scale(vec3_add(box.max, box.min), 0.5);
    const double side = fmax(size.x, fmax(size.y, size.z));
    const double scale = 2.0 * REACH / side;
    return frame_compose(frame_scale(scale, scale, scale),
                         frame_move(-middle.x, -middle.y, -middle.z));
}

static relume_status add_model(struct relume_scene_builder *b)
{
    struct mesh_file file;
    relume_status status = mesh_read(&file, b->mesh_path, b->log);
    if (status)
        return status;
    struct material material = stone();
    if (file.picture)
        status = load_picture(b, file.picture, &material);
    b->frame = fit(&file.mesh);
    if (!status)
        build_put_exact(b, &file.mesh, build_material(b, material));
    mesh_file_free(&file);
    return status;
}

static relume_status build(struct relume_scene_builder *b)
{
    if (b->mesh_path)
        return add_model(b);
    add_head(b);
    return RELUME_OK;
}

const struct relume_scene_kind scene_bust = {
    .name = "bust",
    .summary = "a marble bust, or any OBJ or PLY model by --mesh",
    .projection = RELUME_PLANAR,
    .takes_mesh = true,
    .build = build,
};
