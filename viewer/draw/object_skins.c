// object_skins.c - opacity and emission of materials on the GPU. Twin: world/object/skin.c
#include "draw/object_skins.h"

#include "gl/target.h"

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

relume_status object_skins_create(struct object_skins *s, const struct gl *gl,
                                  const struct relume_objects_info *info,
                                  const struct relume_log *log)
{
    s->texture = calloc((size_t)info->materials, sizeof *s->texture);
    if (!s->texture)
        return RELUME_ENOMEM;
    for (int i = 0; i < info->materials; i++) {
        const struct relume_object_skin *skin = info->material[i].skin;
        if (!skin)
            continue;
        upload(&s->texture[i], gl, skin);
        s->sends |= skin->sends;
        s->holes |= skin->cover != RELUME_COVER_WHOLE;
    }
    return gl_check(gl, "uploading opacity and emission", log);
}

void object_skins_destroy(struct object_skins *s, const struct gl *gl,
                          const struct relume_objects_info *info)
{
    if (s->texture)
        gl->DeleteTextures(info->materials, s->texture);
    free(s->texture);
    *s = (struct object_skins){.texture = NULL};
}
