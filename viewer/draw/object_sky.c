// object_sky.c - environments on objects: what the materials show of them in the open,
// times the share that arrives. Twins: add_sky and share_of_sky of world/object/render.c.
#include "draw/objects_drawer_parts.h"

enum {
    SHARE_PLACE = DRAW_OWN,
    SHARE_NORMAL,
    TOWARDS,
    SHARE_RGB,
    SHARE_SHADOW,
    SHARE_COUNT = SHARE_SHADOW + SHADOW_UNIFORMS
};
static const char *const share_uniforms[] = {"rectangle", "frame_size", "place",     "normal_s",
                                             "towards",   "rgb",        SHADOW_NAMES};
enum { SHOWN = DRAW_OWN, SENT, ARRIVED, SKY_COUNT };
static const char *const sky_uniforms[] = {"rectangle", "frame_size", "shown", "sent", "arrived"};

relume_status object_sky_create(struct object_sky *s, const struct gl *gl,
                                const struct relume_log *log)
{
    *s = (struct object_sky){.maps = {.gl = gl, .log = log}};
    const relume_status status =
        program_create(&s->share, gl, "btf_share.frag", share_uniforms, SHARE_COUNT, log);
    return status ? status
                  : program_create(&s->sky, gl, "btf_sky.frag", sky_uniforms, SKY_COUNT, log);
}

static void destroy_targets(struct object_sky *s, const struct gl *gl)
{
    target_destroy(&s->shown, gl);
    target_destroy(&s->sent, gl);
    target_destroy(&s->arrived, gl);
    gl->DeleteFramebuffers(1, &s->share_buffer);
    s->share_buffer = 0;
}

void object_sky_destroy(struct object_sky *s, const struct gl *gl)
{
    program_destroy(&s->share, gl);
    program_destroy(&s->sky, gl);
    destroy_targets(s, gl);
    sky_maps_forget(&s->maps);
}

relume_status object_sky_need(struct object_sky *s, const struct gl *gl, int width, int height,
                              const struct relume_log *log)
{
    struct target *const shares[] = {&s->sent, &s->arrived};
    if (s->share_buffer && s->shown.width == width && s->shown.height == height)
        return RELUME_OK;
    destroy_targets(s, gl);
    relume_status status = target_create(&s->shown, gl, width, height, log);
    for (int i = 0; i < 2 && !status; i++)
        status = target_create(shares[i], gl, width, height, log);
    if (!status)
        status = object_surface_join(&s->share_buffer, gl, (const struct target *const *)shares, 2,
                                     0, log);
    if (status)
        destroy_targets(s, gl);
    return status;
}

relume_status objects_drawer_show_sky(struct objects_drawer *t, const struct relume_light *light)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct object_parts parts = objects_drawer_parts(t);
    relume_status status = RELUME_OK;
    target_begin(&t->sky.shown, gl);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < info->parts && !status; i++)
        status = objects_drawer_shade_sky(t, i, object_parts_material(&parts, i), light);
    gl->Disable(GL_BLEND);
    return status;
}

static void add_share(struct objects_drawer *t, int number)
{
    const struct gl *gl = t->gl;
    const struct relume_light *light_sample = &t->lights.sample[number].light;
    const struct frame_area whole = {.width = t->sky.sent.width, .height = t->sky.sent.height};
    objects_drawer_draw_shadow(t, number);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->sky.share_buffer);
    gl->Viewport(0, 0, whole.width, whole.height);
    gl->UseProgram(t->sky.share.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->surface.position.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->surface.normal.texture);
    gl->Uniform1i(t->sky.share.at[SHARE_PLACE], 0);
    gl->Uniform1i(t->sky.share.at[SHARE_NORMAL], 1);
    gl->Uniform3f(t->sky.share.at[TOWARDS], (float)light_sample->direction.x,
                  (float)light_sample->direction.y, (float)light_sample->direction.z);
    gl->Uniform3f(t->sky.share.at[SHARE_RGB], light_sample->rgb[0], light_sample->rgb[1],
                  light_sample->rgb[2]);
    object_shadows_use(&t->shadows, gl, t->sky.share.at + SHARE_SHADOW, 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(gl, &t->sky.share, &whole);
    gl->Disable(GL_BLEND);
}

static void find_share(struct objects_drawer *t, int number)
{
    const struct gl *gl = t->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->sky.share_buffer);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    for (int i = 0; i < t->lights.samples && !t->shadows.off; i++)
        if (t->lights.sample[i].number == number)
            add_share(t, i);
}

relume_status objects_drawer_add_sky(struct objects_drawer *t, int number)
{
    const struct gl *gl = t->gl;
    const struct frame_area whole = {.width = t->sky.shown.width, .height = t->sky.shown.height};
    const relume_status status = objects_drawer_show_sky(t, &t->lights.light[number]);
    if (status)
        return status;
    find_share(t, number);
    target_resume(&t->shaded, gl);
    gl->UseProgram(t->sky.sky.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->sky.shown.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->sky.sent.texture);
    texture_use(gl, 2, GL_TEXTURE_2D, t->sky.arrived.texture);
    gl->Uniform1i(t->sky.sky.at[SHOWN], 0);
    gl->Uniform1i(t->sky.sky.at[SENT], 1);
    gl->Uniform1i(t->sky.sky.at[ARRIVED], 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(gl, &t->sky.sky, &whole);
    gl->Disable(GL_BLEND);
    return RELUME_OK;
}
