// between_programs.c - programs of light between a panorama and objects
#include "draw/between_programs.h"

#include "draw/between_uniforms.h"

static const char *const back_uniforms[] = {"clip", "front", "grid", "eye"};
static const char *const front_uniforms[] = {"rectangle", "frame_size", "scene", "objects",
                                             "normals",   "back",       "grid",  "eye"};
static const char *const lamps_uniforms[] = {
    "rectangle",       "frame_size",     "scene",          "scene_facing", "centre",
    "picture",         LIGHT_NAMES,      SHADOW_NAMES,     "captured",     "captured_clip",
    "captured_layers", "captured_light", "captured_texel",
};
static const char *const mean_uniforms[] = {"rectangle", "frame_size", "view", "elevation", "disc"};
static const char *const shown_uniforms[] = {"rectangle", "frame_size", "front",       "objects",
                                             "shaded",    "lone",       "let_without", "let_with",
                                             "mean",      "grid",       "emitted",     "sends"};
static const char *const gather_uniforms[] = {
    "rectangle",   "frame_size",   "view",   "elevation",  "disc",        "places",  "centre",
    "scene",       "scene_facing", "front",  "facing",     "shown",       "lone",    "mean",
    "all_without", "all_with",     "middle", "at_objects", "directional", "bounces", "samples",
    "pattern",     "radius",       "clip",   "eye",
};
static const char *const smooth_uniforms[] = {"rectangle", "frame_size", "first", "second",
                                              "place",     "facing",     "eye",   "size"};
static const char *const returned_uniforms[] = {"rectangle", "frame_size", "front", "gathered",
                                                "objects",   "white",      "grid"};
static const char *const scene_uniforms[] = {
    "rectangle",   "frame_size", "scene",   "lone",         "let_without", "let_with",
    "all_without", "all_with",   "without", "with_objects", "exposure"};

relume_status between_programs_create(struct between_programs *p, const struct gl *gl,
                                      const struct relume_geometry *geometry,
                                      const struct relume_log *log)
{
    const struct {
        struct program *program;
        const char *name, *const *uniforms;
        int count;
    } list[] = {
        {&p->front, "between_front.frag", front_uniforms, FRONT_COUNT},
        {&p->lamps, "between_lamps.frag", lamps_uniforms, LAMPS_COUNT},
        {&p->shown, "between_shown.frag", shown_uniforms, SHOWN_COUNT},
        {&p->smooth, "between_smooth.frag", smooth_uniforms, SMOOTH_COUNT},
        {&p->returned, "between_returned.frag", returned_uniforms, RETURNED_COUNT},
        {&p->scene, "between_scene.frag", scene_uniforms, SCENE_COUNT},
    };
    const char *panorama = draw_panorama_shader(geometry);
    relume_status status = program_create_with(&p->back, gl, "btf_surface.vert",
                                               "between_back.frag", back_uniforms, BACK_COUNT, log);
    for (size_t i = 0; i < sizeof list / sizeof *list && !status; i++)
        status =
            program_create(list[i].program, gl, list[i].name, list[i].uniforms, list[i].count, log);
    if (!status)
        status = program_create_variant(&p->mean, gl, panorama, "#define BETWEEN\n#define MEAN\n",
                                        mean_uniforms, MEAN_COUNT, log);
    if (!status)
        status = program_create_variant(&p->gather, gl, panorama, "#define BETWEEN\n",
                                        gather_uniforms, GATHER_COUNT, log);
    return status ? status : program_create_fragment(&p->picture, gl, &draw_picture_fragment, log);
}

void between_programs_destroy(struct between_programs *p, const struct gl *gl)
{
    struct program *const all[] = {&p->back,   &p->front,  &p->lamps,    &p->mean,  &p->shown,
                                   &p->gather, &p->smooth, &p->returned, &p->scene, &p->picture};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        program_destroy(all[i], gl);
}
