// session_pictures.c - frames and shots as files
#include "session/session.h"

#include "cli/program/say.h"

#include <relume/relight/tone.h>

static bool sees_something(const struct session *s)
{
    for (int i = 0; i < s->renderer.views.count; i++)
        if (s->renderer.views.needed[i])
            return true;
    return s->renderer.stage;
}

static relume_status save_image(struct session *s, struct relume_image *image, const char *path)
{
    const relume_status status = relume_image_save(image, path, relume_image_params(.log = s->log));
    relume_image_destroy(image);
    return status;
}

relume_status session_read(struct relume_image *image, struct session *s, bool linear)
{
    const struct relume_tone_params tone = {.tone = relume_tones[s->app.now.tone],
                                            .white = s->app.now.white};
    *image = (struct relume_image){0};
    if (!sees_something(s))
        return say(s->log, RELUME_EUNFIT, "%s: the eye sees nothing of the slab", s->document.name);
    relume_status status = gl_renderer_read(image, &s->renderer);
    if (!status && !linear)
        status = relume_tone_apply(image, &tone);
    return status;
}

static relume_status draw_finished(struct session *s)
{
    s->finishes = true;
    const relume_status status = session_draw(s);
    s->finishes = false;
    return status;
}

relume_status session_frame(struct session *s, const char *path)
{
    struct relume_image image;
    relume_status status = draw_finished(s);
    if (!status)
        status = session_read(&image, s, relume_image_saves_linear(path));
    return status ? status : save_image(s, &image, path);
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

// Linear, as the screen would show it.
static relume_status read_screen(struct relume_image *image, struct session *s)
{
    relume_status status = draw_finished(s);
    if (!status)
        status = session_window_need_screen(&s->window, app_window_width(&s->app), s->app.height,
                                            s->log);
    if (status)
        return status;
    session_present(s, s->window.screen.framebuffer);
    status = target_read(image, &s->window.screen, &s->window.gl);
    if (!status)
        turn_over_and_decode(image);
    return status;
}

relume_status session_shot(struct session *s, const char *path)
{
    struct relume_image image;
    const relume_status status = read_screen(&image, s);
    return status ? status : save_image(s, &image, path);
}

relume_status session_film(struct session *s)
{
    struct relume_image image;
    const relume_status status = read_screen(&image, s);
    return status ? status : session_film_add(s, s->film, &image);
}
