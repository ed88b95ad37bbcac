// object_sky.c - environments on objects: what the materials show of them in the open,
// times the share that arrives. Twins: add_sky, share_of_sky.
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

relume_status objects_drawer_create_sky(struct objects_drawer *t)
{
    const relume_status status =
        program_create(&t->share, t->gl, "btf_share.frag", share_uniforms, SHARE_COUNT, t->log);
    return status ? status
                  : program_create(&t->sky, t->gl, "btf_sky.frag", sky_uniforms, SKY_COUNT, t->log);
}

relume_status objects_drawer_show_sky(struct objects_drawer *t, const struct relume_light *light,
                                      int only)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    relume_status status = RELUME_OK;
    target_begin(&t->shown, gl);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < info->parts && !status; i++)
        status = objects_drawer_shade_sky(t, i, only >= 0 ? only : info->part[i].material, light);
    gl->Disable(GL_BLEND);
    return status;
}

static void add_share(struct objects_drawer *t, int number)
{
    const struct gl *gl = t->gl;
    const struct relume_light *light_sample = &t->light_sample[number].light;
    const struct frame_area whole = {.width = t->sent.width, .height = t->sent.height};
    objects_drawer_draw_shadow(t, number);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->share_buffer);
    gl->Viewport(0, 0, whole.width, whole.height);
    gl->UseProgram(t->share.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->place.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->normal.texture);
    gl->Uniform1i(t->share.at[SHARE_PLACE], 0);
    gl->Uniform1i(t->share.at[SHARE_NORMAL], 1);
    gl->Uniform3f(t->share.at[TOWARDS], (float)light_sample->direction.x,
                  (float)light_sample->direction.y, (float)light_sample->direction.z);
    gl->Uniform3f(t->share.at[SHARE_RGB], light_sample->rgb[0], light_sample->rgb[1],
                  light_sample->rgb[2]);
    shadow_map_use(&t->shadow, gl, t->share.at + SHARE_SHADOW, 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    objects_drawer_draw_whole(gl, &t->share, &whole);
    gl->Disable(GL_BLEND);
}

static void find_share(struct objects_drawer *t, int number)
{
    const struct gl *gl = t->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->share_buffer);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    for (int i = 0; i < t->light_samples && !t->no_shadows; i++)
        if (t->light_sample[i].number == number)
            add_share(t, i);
}

relume_status objects_drawer_add_sky(struct objects_drawer *t, int number, int only)
{
    const struct gl *gl = t->gl;
    const struct frame_area whole = {.width = t->shown.width, .height = t->shown.height};
    const relume_status status = objects_drawer_show_sky(t, &t->light[number], only);
    if (status)
        return status;
    find_share(t, number);
    target_resume(&t->shaded, gl);
    gl->UseProgram(t->sky.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->shown.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->sent.texture);
    texture_use(gl, 2, GL_TEXTURE_2D, t->arrived.texture);
    gl->Uniform1i(t->sky.at[SHOWN], 0);
    gl->Uniform1i(t->sky.at[SENT], 1);
    gl->Uniform1i(t->sky.at[ARRIVED], 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    objects_drawer_draw_whole(gl, &t->sky, &whole);
    gl->Disable(GL_BLEND);
    return RELUME_OK;
}
