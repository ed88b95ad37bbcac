// joined.c - targets that are drawn at once
#include "draw/joined.h"

#include "cli/program/say.h"

relume_status joined_create(struct joined *j, const struct gl *gl, int count, int width, int height,
                            const struct relume_log *log)
{
    const struct target *all[JOINED_MAX];
    relume_status status = RELUME_OK;
    joined_destroy(j, gl);
    for (; j->count < count && !status; j->count++) {
        all[j->count] = &j->target[j->count];
        status = target_create(&j->target[j->count], gl, width, height, log);
    }
    if (status)
        return status;
    return target_join(&j->framebuffer, gl, all, count, 0)
               ? gl_check(gl, "light between objects and scene", log)
               : say(log, RELUME_ESYSTEM, "OpenGL: cannot draw %d float pictures at once", count);
}

void joined_destroy(struct joined *j, const struct gl *gl)
{
    for (int i = 0; i < j->count; i++)
        target_destroy(&j->target[i], gl);
    gl->DeleteFramebuffers(1, &j->framebuffer);
    *j = (struct joined){.count = 0};
}

void joined_resume(const struct joined *j, const struct gl *gl)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, j->framebuffer);
    gl->Viewport(0, 0, j->target[0].width, j->target[0].height);
}

void joined_begin(const struct joined *j, const struct gl *gl)
{
    joined_resume(j, gl);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
}
