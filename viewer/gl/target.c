// target.c - a float texture that can be drawn into; row 0 is the top of the picture
#include "gl/target.h"

#include "cli/program/say.h"

#include <stdlib.h>

void texture_settings(const struct gl *gl, GLenum kind)
{
    gl->TexParameteri(kind, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(kind, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexParameteri(kind, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(kind, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(kind, GL_TEXTURE_MAX_LEVEL, 0);
}

void texture_use(const struct gl *gl, int unit, GLenum kind, GLuint texture)
{
    gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    gl->BindTexture(kind, texture);
}

relume_status target_create(struct target *target, const struct gl *gl, int width, int height,
                            const struct relume_log *log)
{
    *target = (struct target){.width = width, .height = height};
    if (width > gl->max_texture || height > gl->max_texture)
        return say(log, RELUME_ESYSTEM, "picture of %d x %d: OpenGL draws at most %d x %d here",
                   width, height, gl->max_texture, gl->max_texture);
    gl->GenTextures(1, &target->texture);
    texture_use(gl, 0, GL_TEXTURE_2D, target->texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->GenFramebuffers(1, &target->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target->texture,
                             0);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return gl_check(gl, "picture", log);
    target_destroy(target, gl);
    return say(log, RELUME_ESYSTEM, "OpenGL: cannot draw into a float texture of %d x %d", width,
               height);
}

void target_destroy(struct target *target, const struct gl *gl)
{
    gl->DeleteFramebuffers(1, &target->framebuffer);
    gl->DeleteTextures(1, &target->texture);
    *target = (struct target){0};
}

relume_status target_need(struct target *target, const struct gl *gl, int width, int height,
                          const struct relume_log *log)
{
    if (target->width == width && target->height == height)
        return RELUME_OK;
    target_destroy(target, gl);
    return target_create(target, gl, width, height, log);
}

void target_resume(const struct target *target, const struct gl *gl)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->Viewport(0, 0, target->width, target->height);
}

void target_begin(const struct target *target, const struct gl *gl)
{
    target_resume(target, gl);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
}

bool target_join(GLuint *framebuffer, const struct gl *gl, const struct target *const *target,
                 int n, GLuint depth)
{
    GLenum buffers[TARGET_JOINED];
    gl->GenFramebuffers(1, framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
    for (int i = 0; i < n; i++) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, target[i]->texture, 0);
    }
    gl->DrawBuffers(n, buffers);
    if (depth)
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    return gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

relume_status target_read(struct relume_image *out, const struct target *target,
                          const struct gl *gl)
{
    const relume_status status = relume_image_create(out, target->width, target->height, 3);
    if (status)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, target->width, target->height, GL_RGB, GL_FLOAT, out->data);
    return RELUME_OK;
}

void target_write(const struct target *target, const struct gl *gl,
                  const struct relume_image *image)
{
    texture_use(gl, 0, GL_TEXTURE_2D, target->texture);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, target->width, target->height, 0, GL_RGB, GL_FLOAT,
                   image->data);
}
