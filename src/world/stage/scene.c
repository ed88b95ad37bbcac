// scene.c - the inside of a relume_scene
#include "world/stage/scene.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"

#include <string.h>

const struct relume_scene_kind *const relume_scenes[] = {
    &scene_box,        &scene_teapot,    &scene_bust,    &scene_attic,
    &scene_chessboard, &scene_colonnade, &scene_cornell, NULL,
};

const struct relume_scene_kind *relume_scene_find(const char *name)
{
    for (const struct relume_scene_kind *const *k = relume_scenes; *k; k++)
        if (!strcmp((*k)->name, name))
            return *k;
    return NULL;
}

static relume_status build(relume_scene *scene, const struct relume_log *log)
{
    const relume_status status = scene->kind->build(&scene->stage);
    if (status)
        return status;
    if (scene->stage.mesh.failed)
        return RELUME_ENOMEM;
    scene->bounds = mesh_bounds(&scene->stage.mesh);
    return trace_create(&scene->tracer, &scene->stage.mesh, log);
}

relume_status relume_scene_create(relume_scene **out, const struct relume_scene_kind *kind,
                                  const struct relume_scene_params *params)
{
    const struct relume_scene_params p = PARAMS(relume_scene_params, params);
    *out = NULL;
    if (p.mesh && !kind->takes_mesh)
        return log_fail(p.log, RELUME_EINVAL,
                        "%s: this scene cannot take a --mesh; expected the scene bust", kind->name);
    relume_scene *scene = mem_zeroed(1, sizeof *scene);
    if (!scene)
        return RELUME_ENOMEM;
    scene->kind = kind;
    scene->stage = (struct relume_scene_builder){
        .log = p.log,
        .mesh_path = p.mesh,
        .frame = frame_world,
        .random = random_stream(1, 0, 0),
    };
    const relume_status status = build(scene, p.log);
    scene->stage.log = NULL;
    if (status) {
        relume_scene_destroy(&scene);
        return status;
    }
    *out = scene;
    return RELUME_OK;
}

void relume_scene_destroy(relume_scene **scene)
{
    relume_scene *s = *scene;
    *scene = NULL;
    if (!s)
        return;
    trace_destroy(&s->tracer);
    mesh_free(&s->stage.mesh);
    for (int i = 0; i < s->stage.picture_count; i++)
        relume_image_destroy(&s->stage.pictures[i]);
    mem_free(s);
}
