// session_pictures.c - frames, shots and recordings as files
#include "session.h"

#include "lamps.h"
#include "say.h"

#include <relume/tone.h>

static bool sees_something(const struct session *s)
{
    for (int i = 0; i < s->renderer.views; i++)
        if (s->renderer.needed[i])
            return true;
    return false;
}

static relume_status save(struct session *s, struct relume_image *image, const char *path)
{
    const relume_status status = relume_image_save(image, path, relume_image_params(.log = s->log));
    relume_image_destroy(image);
    return status;
}

// The last frame; `linear` or by the app's tone.
static relume_status read_frame(struct relume_image *image, struct session *s, bool linear)
{
    const struct relume_tone_params tone = {.tone = relume_tones[s->app.now.tone],
                                            .white = s->app.now.white};
    *image = (struct relume_image){0};
    if (!sees_something(s))
        return say(s->log, RELUME_EDATA, "%s: the eye sees nothing of the slab", s->name);
    relume_status status = renderer_read(image, &s->renderer);
    if (!status && !linear)
        status = relume_tone_apply(image, &tone);
    return status;
}

relume_status session_frame(struct session *s, const char *path)
{
    struct relume_image image;
    relume_status status = session_draw(s);
    if (!status)
        status = read_frame(&image, s, relume_image_saves_linear(path));
    return status ? status : save(s, &image, path);
}

static relume_status add_pictures(struct session *s, struct record *record, enum record_kind kind,
                                  int frames)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < frames; i++) {
        struct relume_image image = {0};
        status = record_pose(&s->app, kind, (double)i / frames, s->log);
        if (!status)
            status = renderer_draw(&s->renderer, &s->app);
        if (!status)
            status = read_frame(&image, s, false);
        if (!status)
            status = record_add(record, &image);
        relume_image_destroy(&image);
    }
    return status;
}

relume_status session_record(struct session *s, enum record_kind kind, const char *path, int frames)
{
    struct app_state before = {0};
    struct record *record;
    if (!lamps_copy(&before, &s->app.now))
        return RELUME_ENOMEM;
    relume_status status = record_open(&record, path, s->log);
    if (status) {
        lamps_release(&before);
        return status;
    }
    s->app.now.ball = false;
    status = add_pictures(s, record, kind, frames);
    lamps_release(&s->app.now);
    s->app.now = before;
    if (!status)
        return record_commit(&record);
    record_abort(&record);
    return status;
}

static relume_status prepare_screen(struct session *s)
{
    if (s->screen.width == s->app.width && s->screen.height == s->app.height)
        return RELUME_OK;
    if (s->screen.texture)
        target_destroy(&s->screen, &s->gl);
    return target_create(&s->screen, &s->gl, s->app.width, s->app.height, s->log);
}

// The screen's first row is the lowest, and its values are coded.
static void turn_over_and_decode(struct relume_image *image)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t row = 3 * (size_t)image->width;
    for (int y = 0; y < image->height / 2; y++) {
        float *top = image->data + (size_t)y * row;
        float *low = image->data + (size_t)(image->height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) {
            const float keep = top[i];
            top[i] = low[i];
            low[i] = keep;
        }
    }
    for (size_t i = 0; i < row * (size_t)image->height; i++)
        image->data[i] = relume_transfer_decode(srgb, image->data[i]);
}

relume_status session_shot(struct session *s, const char *path)
{
    struct relume_image image;
    relume_status status = session_draw(s);
    if (!status)
        status = prepare_screen(s);
    if (status)
        return status;
    session_present(s, s->screen.framebuffer);
    status = target_read(&image, &s->screen, &s->gl);
    if (status)
        return status;
    turn_over_and_decode(&image);
    return save(s, &image, path);
}
