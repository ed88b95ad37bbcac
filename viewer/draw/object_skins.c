// object_skins.c - opacity and emission of materials on the GPU. Twin: world/object/skin.c
#include "draw/objects_drawer_parts.h"

#include <stdlib.h>

static void upload(GLuint *out, const struct gl *gl, const struct relume_object_skin *skin)
{
    gl->GenTextures(1, out);
    texture_use(gl, 0, GL_TEXTURE_2D, *out);
    for (int i = 0; i < skin->levels; i++)
        gl->TexImage2D(GL_TEXTURE_2D, i, GL_RGBA16F, skin->texels[i].width, skin->texels[i].height,
                       0, GL_RGBA, GL_FLOAT, skin->texels[i].data);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, skin->levels - 1);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

relume_status objects_drawer_upload_skins(struct objects_drawer *t)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    t->skin = calloc((size_t)info->materials, sizeof *t->skin);
    if (!t->skin)
        return RELUME_ENOMEM;
    for (int i = 0; i < info->materials; i++) {
        const struct relume_object_skin *skin = info->material[i].skin;
        if (!skin)
            continue;
        upload(&t->skin[i], t->gl, skin);
        t->sends |= skin->sends;
        t->holes |= skin->cover != RELUME_COVER_WHOLE;
    }
    return gl_check(t->gl, "uploading opacity and emission", t->log);
}

void objects_drawer_forget_skins(struct objects_drawer *t)
{
    if (t->skin)
        t->gl->DeleteTextures(relume_objects_info(t->objects)->materials, t->skin);
    free(t->skin);
    t->skin = NULL;
}

void objects_drawer_use_skin(const struct objects_drawer *t, const struct program *program,
                             int part)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const int material = t->only >= 0 ? t->only : info->part[part].material;
    const struct relume_object_skin *skin = info->material[material].skin;
    t->gl->Uniform1i(program->at[SURFACE_PART], part);
    t->gl->Uniform1i(program->at[SURFACE_SKIN], 0);
    t->gl->Uniform1i(program->at[SURFACE_COVER], skin ? (GLint)skin->cover : 0);
    t->gl->Uniform1i(program->at[SURFACE_SENDS], skin && skin->sends);
    t->gl->Uniform1f(program->at[SURFACE_CUTOFF], skin ? skin->cutoff : 0.0f);
    if (skin)
        texture_use(t->gl, 0, GL_TEXTURE_2D, t->skin[material]);
}
