// between_frame.c - targets of light between a panorama and objects in a frame
#include "draw/between_frame.h"

relume_status between_frame_create(struct between_frame *f, const struct gl *gl,
                                   const struct relume_log *log)
{
    const relume_status status = target_create(&f->even, gl, 1, 1, log);
    return status ? status : joined_create(&f->by_lamps, gl, JOINED_MAX, 1, 1, log);
}

static void destroy_sized(struct between_frame *f, const struct gl *gl)
{
    struct joined *const joined[] = {&f->nearest, &f->by_lamps, &f->gathered, &f->smoothed};
    struct target *const single[] = {&f->behind, &f->show, &f->thrown, &f->sum};
    for (size_t i = 0; i < sizeof joined / sizeof *joined; i++)
        joined_destroy(joined[i], gl);
    for (size_t i = 0; i < sizeof single / sizeof *single; i++)
        target_destroy(single[i], gl);
    gl->DeleteTextures(1, &f->behind_depth);
    f->behind_depth = 0;
}

void between_frame_destroy(struct between_frame *f, const struct gl *gl)
{
    destroy_sized(f, gl);
    target_destroy(&f->even, gl);
}

// With depths of their own.
static relume_status create_behind(struct between_frame *f, const struct gl *gl, int width,
                                   int height, const struct relume_log *log)
{
    const relume_status status = target_create(&f->behind, gl, width, height, log);
    if (status)
        return status;
    gl->GenTextures(1, &f->behind_depth);
    texture_use(gl, 0, GL_TEXTURE_2D, f->behind_depth);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->BindFramebuffer(GL_FRAMEBUFFER, f->behind.framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, f->behind_depth,
                             0);
    return gl_check(gl, "light between objects and scene", log);
}

// `show` is the last one: it tells that all are there.
relume_status between_frame_need(struct between_frame *f, const struct gl *gl, int width,
                                 int height, const struct target *surface,
                                 const struct relume_log *log)
{
    const struct {
        struct joined *joined;
        int count;
    } list[] = {{&f->nearest, 3}, {&f->by_lamps, 4}, {&f->gathered, 2}, {&f->smoothed, 2}};
    relume_status status = RELUME_OK;
    if (f->show.width == width && f->show.height == height)
        return RELUME_OK;
    destroy_sized(f, gl);
    for (size_t i = 0; i < sizeof list / sizeof *list && !status; i++)
        status = joined_create(list[i].joined, gl, list[i].count, width, height, log);
    if (!status)
        status = create_behind(f, gl, width, height, log);
    if (!status)
        status = target_create(&f->thrown, gl, width, height, log);
    if (!status)
        status = target_create(&f->sum, gl, surface->width, surface->height, log);
    return status ? status : target_create(&f->show, gl, width, height, log);
}
