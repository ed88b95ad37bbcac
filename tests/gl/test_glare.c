// Glare: the compute passes against the library, the eye's time, and what is kept from frame to
// frame
#include "app/events.h"
#include "app/fov.h"
#include "app/frame_request.h"
#include "fixture.h"

#include "app/light_list.h"
#include "app/observer.h"
#include "draw/visible_lights.h"
#include "glare/gl_glare.h"
#include "glare/glare.h"
#include "glare/glare_view.h"
#include "relight/eye/pattern.h"
#include "relight/eye/pupil.h"
#include "relight/eye/veil.h"
#include "relight/frame/viewport.h"

static struct relume_eye *made_eye(double seconds)
{
    relume_eye *eye;
    assert_int_equal(relume_eye_create(&eye, NULL, 30), RELUME_OK);
    assert_int_equal(relume_eye_advance(eye, seconds, 30), RELUME_OK);
    return eye;
}

// ---------------------------------------------------------------- transforms

static double worst_against_dft(const float *in, const float *out, int n, bool inverse)
{
    double most = 0;
    for (int k = 0; k < n; k++) {
        double re = 0, im = 0;
        for (int i = 0; i < n; i++) {
            const double a = (inverse ? 2 : -2) * acos(-1) * ((double)i * k / n);
            re += in[2 * i] * cos(a) - in[2 * i + 1] * sin(a);
            im += in[2 * i] * sin(a) + in[2 * i + 1] * cos(a);
        }
        most = fmax(most, hypot(re - (double)out[2 * k], im - (double)out[2 * k + 1]));
    }
    return most;
}

// Columns of a picture, the second to the last but one; the others stay.
static void transform_length(int n, bool inverse)
{
    enum { LINES = 4 };
    struct gl_fft fft = {0};
    const size_t size = 2 * (size_t)n * LINES * sizeof(float);
    float *in = malloc(size), *out = malloc(size), column[2][2 * 512];
    uint64_t random = (uint64_t)n;
    for (int i = 0; i < 2 * n * LINES; i++)
        in[i] = (float)uniform(&random) - 0.5f;
    const GLuint buffer = gl_storage(&fixture_gl, size, in);
    fixture_gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    const struct gl_fft_lines lines = {n, 1, LINES - 2, 1, {LINES, 1, 0}, inverse};
    assert_int_equal(gl_fft_run(&fft, &fixture_gl, &lines, &fixture_log), RELUME_OK);
    fixture_gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    fixture_gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    fixture_gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, out);
    for (int line = 0; line < LINES; line++) {
        for (int i = 0; i < 2 * n; i++) {
            const int at = 2 * (i / 2 * LINES + line) + i % 2;
            column[0][i] = in[at];
            column[1][i] = out[at];
        }
        const bool kept = line == 0 || line == LINES - 1;
        if (kept)
            assert_memory_equal(column[0], column[1], 2 * (size_t)n * sizeof(float));
        else  // sums of n floats near 1/2, log2 n roundings each
            assert_below("transform", worst_against_dft(column[0], column[1], n, inverse),
                         6e-8 * n);
    }
    fixture_gl.DeleteBuffers(1, &buffer);
    gl_fft_destroy(&fft, &fixture_gl);
    free(in);
    free(out);
}

static void transforms_of_every_radix_are_exact(void **state)
{
    (void)state;
    static const int lengths[] = {64, 80, 96, 128, 320, 384};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++)
        transform_length(lengths[i], i % 2 == 1);
}

static void lengths_are_the_least_that_suit(void **state)
{
    (void)state;
    struct gl small = fixture_gl;
    assert_int_equal(gl_fft_length(&fixture_gl, 1), 64);
    assert_int_equal(gl_fft_length(&fixture_gl, 65), 80);
    assert_int_equal(gl_fft_length(&fixture_gl, 321), 384);
    assert_int_equal(gl_fft_length(&fixture_gl, 1025), 1280);
    small.shared_bytes = 1024 * 8;
    assert_int_equal(gl_fft_length(&small, 1024), 1024);
    assert_int_equal(gl_fft_length(&small, 1025), 0);
    small.compute = false;
    assert_true(gl_psf_fits(&fixture_gl, relume_psf_params(.size = 64)));
    assert_false(gl_psf_fits(&small, relume_psf_params(.size = 64)));
    assert_false(gl_psf_fits(&fixture_gl, relume_psf_params(.size = 100)));
}

// ---------------------------------------------------------------- the pattern

static struct relume_image read_texture(const struct gl_aperture *a)
{
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, a->size, a->size, 1), RELUME_OK);
    fixture_gl.BindFramebuffer(GL_FRAMEBUFFER, a->framebuffer);
    fixture_gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    fixture_gl.ReadPixels(0, 0, a->size, a->size, GL_RED, GL_FLOAT, image.data);
    return image;
}

static double most_apart(const struct relume_image *a, const struct relume_image *b)
{
    double most = 0;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->channels, b->channels);
    for (int i = 0; i < a->width * a->height * a->channels; i++) {
        const double d = fabs((double)a->data[i] - (double)b->data[i]);
        most = d > most || isnan(d) ? d : most;
    }
    return most;
}

struct pair {
    relume_eye *eye;
    relume_psf *library;
    struct gl_glare card;
};

// A whole eye, and its pupil alone: programs take long to make.
// `folded` has a field so wide that the pupil is folded.
static struct pair whole, pupil, folded;

static struct pair make_pair(int size, double half_field_deg, unsigned parts_off)
{
    const struct relume_psf_params params = {.log = &fixture_log,
                                             .size = size,
                                             .half_field_deg = half_field_deg,
                                             .parts_off = parts_off};
    struct pair p = {.eye = made_eye(0.3)};
    assert_int_equal(relume_psf_create(&p.library, &params), RELUME_OK);
    assert_int_equal(relume_psf_update(p.library, p.eye), RELUME_OK);
    assert_int_equal(gl_glare_prepare(&p.card, &fixture_gl, &params), RELUME_OK);
    assert_int_equal(gl_glare_update(&p.card, &fixture_gl, p.eye, &fixture_log), RELUME_OK);
    return p;
}

static void free_pair(struct pair *p)
{
    gl_glare_destroy(&p->card, &fixture_gl);
    relume_psf_destroy(&p->library);
    relume_eye_destroy(&p->eye);
}

// Both cover texels exactly along x and by lines along y: 4 to 24 of them, here 8 or 16, whose ends
// differ by up to an eighth of a texel at the top of a disc.
static void apertures_agree(void **state)
{
    (void)state;
    struct pair *const pairs[] = {&whole, &pupil};
    for (size_t i = 0; i < 2; i++) {
        struct relume_image theirs, ours = read_texture(&pairs[i]->card.psf.aperture);
        assert_int_equal(relume_psf_aperture(&theirs, pairs[i]->library), RELUME_OK);
        double sum[2] = {0, 0};
        for (int k = 0; k < ours.width * ours.height; k++) {
            sum[0] += (double)ours.data[k];
            sum[1] += (double)theirs.data[k];
        }
        assert_below("transmittance", most_apart(&ours, &theirs), i ? 3e-6 : 0.13);
        assert_below("light, relative", fabs(sum[0] / sum[1] - 1), i ? 1e-6 : 1e-3);
        const double lids = pairs[i]->card.psf.light - relume_psf_light(pairs[i]->library);
        assert_below("lids", fabs(lids), 1e-3);
        relume_image_destroy(&ours);
        relume_image_destroy(&theirs);
    }
}

static struct relume_image read_colours(const struct gl_psf *psf)
{
    const int field = psf->shape.field;
    struct relume_image image;
    float(*rgba)[4] = malloc((size_t)field * (size_t)field * sizeof *rgba);
    double sum[3] = {0, 0, 0};
    assert_int_equal(relume_image_create(&image, field, field, 3), RELUME_OK);
    fixture_gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    fixture_gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, psf->colours);
    fixture_gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                                field * field * (GLsizeiptr)sizeof *rgba, rgba);
    for (int i = 0; i < field * field; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)rgba[i][c];
    for (int i = 0; i < field * field; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = (float)((double)rgba[i][c] / sum[c]);
    free(rgba);
    return image;
}

// The whole of both patterns is 1; what apertures differ by is spread over the field.
static void patterns_agree(void **state)
{
    (void)state;
    struct pair *const pairs[] = {&whole, &pupil, &folded};
    for (size_t i = 0; i < 3; i++) {
        struct relume_image theirs, ours = read_colours(&pairs[i]->card.psf);
        assert_int_equal(relume_psf_image(&theirs, pairs[i]->library), RELUME_OK);
        double apart = 0;
        for (int k = 0; k < 3 * theirs.width * theirs.height; k++)
            apart += fabs((double)ours.data[k] - (double)theirs.data[k]) / 3;
        assert_below("pattern, sum of differences", apart, i == 1 ? 5e-6 : 6e-3);
        relume_image_destroy(&ours);
        relume_image_destroy(&theirs);
    }
}

// ---------------------------------------------------------------- frames

static struct relume_image made_frame(int width, int height)
{
    struct relume_image image;
    uint64_t random = 7;
    assert_int_equal(relume_image_create(&image, width, height, 3), RELUME_OK);
    for (int i = 0; i < 3 * width * height; i++)
        image.data[i] = (float)uniform(&random);
    return image;
}

static void set(struct relume_image *image, int x, int y, float r, float g, float b)
{
    float *p = image->data + 3 * (y * image->width + x);
    p[0] = r;
    p[1] = g;
    p[2] = b;
}

static struct relume_image seen_by_card(struct pair *p, const struct relume_image *frame,
                                        const struct relume_glare_params *view)
{
    struct target from, seen;
    struct gl_glare_facts facts;
    struct relume_image image;
    bool fits;
    assert_int_equal(target_create(&from, &fixture_gl, frame->width, frame->height, NULL), 0);
    assert_int_equal(target_create(&seen, &fixture_gl, frame->width, frame->height, NULL), 0);
    target_write(&from, &fixture_gl, frame);
    assert_int_equal(gl_glare_watch(&facts, &p->card, &fixture_gl, &from, &fixture_log), 0);
    assert_float_equal(facts.luminance / relume_glare_luminance(frame), 1, 1e-5);
    assert_int_equal(gl_glare_apply(&p->card, &fixture_gl, &seen, &from, &facts, p->eye, view,
                                    &fits, &fixture_log),
                     RELUME_OK);
    assert_true(fits);
    assert_int_equal(target_read(&image, &seen, &fixture_gl), RELUME_OK);
    target_destroy(&from, &fixture_gl);
    target_destroy(&seen, &fixture_gl);
    return image;
}

static struct relume_image seen_by_library(struct pair *p, const struct relume_image *frame,
                                           const struct relume_glare_params *view)
{
    struct relume_image image;
    relume_glare *work;
    assert_int_equal(relume_glare_create(&work), RELUME_OK);
    assert_int_equal(relume_glare_apply(&image, work, frame, false, p->library, view), RELUME_OK);
    relume_glare_destroy(&work);
    return image;
}

// The patterns differ by 3e-3 in all, which a pixel of a source of 1000 shares with many: 0.17 is
// the most that was seen, between its core and its needles.
static void glared_frames_agree(void **state)
{
    (void)state;
    static const struct relume_glare_params views[] = {
        {.fov_deg = 40}, {.fov_deg = 2, .no_veil = true}, {.fov_deg = 20, .magnify = 3}};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        struct relume_image frame = made_frame(90, 70);
        set(&frame, 40, 30, 1000, 0, 0);
        set(&frame, 2, 60, 0, 1000, 500);
        struct relume_image ours = seen_by_card(&whole, &frame, &views[i]);
        struct relume_image theirs = seen_by_library(&whole, &frame, &views[i]);
        double sum[2] = {0, 0};
        for (int k = 0; k < 3 * 90 * 70; k++) {
            sum[0] += (double)ours.data[k];
            sum[1] += (double)theirs.data[k];
        }
        assert_below("frame, most", most_apart(&ours, &theirs), 0.4);
        assert_below("frame, light", fabs(sum[0] / sum[1] - 1), 5e-5);
        relume_image_destroy(&ours);
        relume_image_destroy(&theirs);
        relume_image_destroy(&frame);
    }
}

static void spoiled_and_tiny_frames_are_seen(void **state)
{
    (void)state;
    static const struct relume_glare_params view = {.fov_deg = 30};
    struct relume_image frame = made_frame(33, 17);
    set(&frame, 3, 3, NAN, 1, 1);
    set(&frame, 8, 8, INFINITY, -INFINITY, 2);
    struct relume_image ours = seen_by_card(&pupil, &frame, &view);
    struct relume_image theirs = seen_by_library(&pupil, &frame, &view);
    assert_below("spoiled frame", most_apart(&ours, &theirs), 1e-4);
    relume_image_destroy(&ours);
    relume_image_destroy(&theirs);
    relume_image_destroy(&frame);
    frame = made_frame(1, 1);
    ours = seen_by_card(&pupil, &frame, &view);
    theirs = seen_by_library(&pupil, &frame, &view);
    assert_below("one pixel", most_apart(&ours, &theirs), 1e-5);
    relume_image_destroy(&ours);
    relume_image_destroy(&theirs);
    relume_image_destroy(&frame);
}

// ---------------------------------------------------------------- the eye in the viewer

// A look into a panorama that is nothing but a frame here.
struct stage {
    struct app app;
    struct glare glare;
    struct target frame;
    struct relume_image image;
};

static void open_stage(struct stage *s, bool by_library)
{
    const struct app_file file = {
        .geometry = {.projection = RELUME_SPHERICAL}, .width = 64, .height = 32, .views = 1};
    const struct app_state start = {.camera = {.width = 48, .height = 40, .look = {.zoom = 40}},
                                    .observer = {.on = true, .mode = OBSERVER_FFT}};
    *s = (struct stage){.image = made_frame(48, 40)};
    assert_int_equal(app_start(&s->app, &file, &start, true, NULL), RELUME_OK);
    glare_begin(&s->glare, &fixture_gl, &fixture_log);
    s->glare.by_library = by_library;
    s->glare.size = 64;
    s->glare.field_deg = 0.5;
    assert_int_equal(target_create(&s->frame, &fixture_gl, 48, 40, NULL), RELUME_OK);
    set(&s->image, 20, 20, 500, 400, 300);
    target_write(&s->frame, &fixture_gl, &s->image);
}

static void close_stage(struct stage *s)
{
    glare_end(&s->glare);
    target_destroy(&s->frame, &fixture_gl);
    relume_image_destroy(&s->image);
    app_release(&s->app);
}

static struct relume_image look(struct stage *s)
{
    struct relume_image image;
    struct frame_request q = {0};
    assert_int_equal(frame_request_make(&q, &s->app), RELUME_OK);
    q.exposure = 1;
    assert_int_equal(glare_see(&s->glare, &s->frame, &q), RELUME_OK);
    frame_request_free(&q);
    assert_int_equal(target_read(&image, &s->glare.seen, &fixture_gl), RELUME_OK);
    return image;
}

// How much looking again differs, after what the caller changed.
static double changed(struct stage *s, struct relume_image *before)
{
    struct relume_image now = look(s);
    const double most = most_apart(before, &now);
    relume_image_destroy(before);
    *before = now;
    return most;
}

static void the_eye_lives_with_the_app(void **state)
{
    struct stage s;
    open_stage(&s, *state != NULL);
    struct relume_image seen = look(&s);
    assert_true(changed(&s, &seen) == 0);  // no time passed
    (void)app_advance(&s.app, 0.25);
    assert_true(changed(&s, &seen) > 0.01);
    assert_float_equal(relume_eye_state(s.glare.eye)->time_s, 0.25, 1e-12);
    s.app.now.observer.paused = true;
    (void)app_advance(&s.app, 5);
    assert_true(changed(&s, &seen) == 0);
    assert_float_equal(relume_eye_state(s.glare.eye)->time_s, 0.25, 1e-12);
    s.app.now.observer.squint = 0.6;
    assert_true(changed(&s, &seen) > 0.01);
    s.app.now.observer.magnify = 4;
    assert_true(changed(&s, &seen) > 0.01);
    s.app.now.observer.parts_off = RELUME_EYE_LENS;
    assert_true(changed(&s, &seen) > 0.01);
    relume_image_destroy(&seen);
    close_stage(&s);
}

// A loop of 0.4 s is at 0.5 s where it was at 0.1 s; an eye that lives on is elsewhere.
static void a_loop_goes_around(void **state)
{
    struct stage s;
    (void)state;
    open_stage(&s, false);
    s.app.now.observer.cycle_s = 0.4;
    (void)app_advance(&s.app, 0.1);
    struct relume_image first = look(&s), seen = look(&s);
    assert_true(s.glare.loop.cycle && !s.glare.by_gpu);
    (void)app_advance(&s.app, 0.2);
    assert_true(changed(&s, &seen) > 0.01);
    (void)app_advance(&s.app, 0.2);
    (void)changed(&s, &seen);
    // times of the app are sums of its steps; a part of 1e-12 between two patterns
    assert_below("after a loop", most_apart(&first, &seen), 1e-3);
    s.app.now.observer.squint = 0.6;
    assert_true(changed(&s, &seen) > 0.01);
    s.app.now.observer.cycle_s = 0;
    (void)changed(&s, &seen);
    assert_null(s.glare.loop.cycle);
    relume_image_destroy(&first);
    relume_image_destroy(&seen);
    close_stage(&s);
}

// What is kept of a frame is not shown for another, and time in other steps leads to the same.
static void nothing_of_an_old_frame_stays(void **state)
{
    struct stage s, fresh;
    open_stage(&s, *state != NULL);
    open_stage(&fresh, *state != NULL);
    struct relume_image seen = look(&s), other = look(&fresh);
    for (int i = 0; i < 30; i++) {
        (void)app_advance(&s.app, 1.0 / 60);
        if (i == 20) {  // a light moves; the field is as bright
            set(&s.image, 30, 10, 500, 400, 300);
            set(&s.image, 20, 20, 0.5f, 0.5f, 0.5f);
            target_write(&s.frame, &fixture_gl, &s.image);
        }
        if (i % 10 == 0)
            (void)changed(&s, &seen);
    }
    (void)changed(&s, &seen);
    (void)app_advance(&fresh.app, 0.5);
    target_write(&fresh.frame, &fixture_gl, &s.image);
    (void)changed(&fresh, &other);
    // The field's luminance differs by the two pixels, for as long as they were there.
    assert_below("seen in many steps and in one", most_apart(&seen, &other), 1e-2);
    assert_true(other.data[3 * (10 * 48 + 30)] > 100);
    assert_true(other.data[3 * (20 * 48 + 20)] < 20);
    relume_image_destroy(&seen);
    relume_image_destroy(&other);
    close_stage(&s);
    close_stage(&fresh);
}

static void without_compute_the_library_sees(void **state)
{
    (void)state;
    struct gl old = fixture_gl;
    struct stage s, library;
    old.compute = false;
    open_stage(&s, false);
    open_stage(&library, true);
    s.glare.gl = &old;
    struct relume_image seen = look(&s), theirs = look(&library);
    assert_true(s.glare.by_library && most_apart(&seen, &theirs) == 0);
    relume_image_destroy(&seen);
    relume_image_destroy(&theirs);
    close_stage(&s);
    close_stage(&library);
}

// ---------------------------------------------------------------- view, words, lamps

static void fields_of_view_follow_the_camera(void **state)
{
    (void)state;
    const struct app_file file = {
        .geometry = {.projection = RELUME_SPHERICAL}, .width = 64, .height = 32, .views = 1};
    const struct app_state start = {.camera = {.width = 100, .height = 50}};
    struct relume_psf_geometry pattern;
    struct app app;
    assert_int_equal(relume_psf_geometry(&pattern, NULL), RELUME_OK);
    assert_int_equal(app_start(&app, &file, &start, true, NULL), RELUME_OK);
    assert_float_equal(app_fov_deg(&app), 90, 1e-9);
    app.now.camera.look.zoom = 2;
    assert_float_equal(app_fov_deg(&app), 2 * atan(0.5) * 180 / acos(-1), 1e-9);
    app.now.camera.look.zoom = 1e9;
    assert_float_equal(app_fov_deg(&app), 0.01, 1e-9);
    app.now.camera.look.zoom = 57;
    app.now.observer.magnify = 1000;
    struct frame_request q = {0};
    assert_int_equal(frame_request_make(&q, &app), RELUME_OK);
    const struct relume_glare_params p = glare_view(&q, &pattern);
    frame_request_free(&q);
    assert_true(p.no_veil &&
                p.magnify * pattern.radius <= 51 * relume_glare_pixel(p.fov_deg, app.width));
    app_release(&app);
}

static void words_change_the_observer_or_nothing(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",       "maybe",    "magnify",    "magnify nan",
                                        "nits 0", "squint 1", "mode quick", "lens",
                                        "on off", "lids of"};
    const char *expected;
    struct observer s = {0};
    assert_true(observer_say(&s, "on", &expected) && s.on);
    assert_true(observer_say(&s, " magnify 3 ", &expected) && s.magnify == 3);
    assert_true(observer_say(&s, "lens off", &expected) && s.parts_off == RELUME_EYE_LENS);
    assert_true(observer_say(&s, "lens on", &expected) && s.parts_off == 0);
    assert_true(observer_say(&s, "cycle 4", &expected) && s.cycle_s == 4);
    assert_true(observer_say(&s, "mode hybrid", &expected) && s.mode == OBSERVER_HYBRID);
    assert_true(observer_say(&s, "pause", &expected) && s.paused && !observer_lives(&s));
    const struct observer before = s;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(observer_say(&s, wrong[i], &expected));
        assert_true(expected[0] && !memcmp(&s, &before, sizeof s));
    }
}

// A lamp of value 1 at distance 2 sends the eye pi / 4: pixels of that solid angle hold it.
static void lamps_in_view_send_what_they_send(void **state)
{
    (void)state;
    const struct app_file file = {
        .geometry = {.projection = RELUME_SPHERICAL}, .width = 64, .height = 32, .views = 1};
    const struct app_state start = {.camera = {.width = 100, .height = 50}};
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_POINT, .position = {0, 0, -2}, .rgb = {1, 0.5f, 0}},
        {.kind = RELUME_LIGHT_POINT, .position = {0, 0, 2}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_DIRECTIONAL, .direction = {0.5, 0, -1}, .rgb = {1, 1, 1}}};
    struct relume_visible_light *seen = malloc(RELUME_VISIBLE_LIGHTS_MOST * sizeof *seen);
    struct app app;
    assert_int_equal(app_start(&app, &file, &start, true, NULL), RELUME_OK);
    struct frame_request q = {0};
    assert_int_equal(frame_request_make(&q, &app), RELUME_OK);
    assert_int_equal(visible_lights(seen, &q, lights, 3, NULL), 2);
    frame_request_free(&q);
    assert_float_equal(seen[0].x, 50, 1e-9);
    assert_float_equal(seen[0].y, 25, 1e-9);
    assert_float_equal((double)seen[0].rgb[0], acos(-1) / 4 * 2500, 0.01);  // (1 / 50)^2 sr
    assert_float_equal((double)seen[0].rgb[1], acos(-1) / 8 * 2500, 0.01);
    assert_float_equal(seen[1].x, 75, 1e-3);
    free(seen);
    app_release(&app);
}

static int open_pairs(void **state)
{
    if (fixture_open(state))
        return -1;
    whole = make_pair(128, 0, 0);
    pupil = make_pair(128, 0, RELUME_EYE_ALL);
    folded = make_pair(128, 1, 0);
    return 0;
}

static int close_pairs(void **state)
{
    free_pair(&whole);
    free_pair(&pupil);
    free_pair(&folded);
    return fixture_close(state);
}

int main(void)
{
    static int library = 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_of_every_radix_are_exact),
        cmocka_unit_test(lengths_are_the_least_that_suit),
        cmocka_unit_test(apertures_agree),
        cmocka_unit_test(patterns_agree),
        cmocka_unit_test(glared_frames_agree),
        cmocka_unit_test(spoiled_and_tiny_frames_are_seen),
        cmocka_unit_test(the_eye_lives_with_the_app),
        cmocka_unit_test_prestate(the_eye_lives_with_the_app, &library),
        cmocka_unit_test(a_loop_goes_around),
        cmocka_unit_test(nothing_of_an_old_frame_stays),
        cmocka_unit_test_prestate(nothing_of_an_old_frame_stays, &library),
        cmocka_unit_test(without_compute_the_library_sees),
        cmocka_unit_test(fields_of_view_follow_the_camera),
        cmocka_unit_test(words_change_the_observer_or_nothing),
        cmocka_unit_test(lamps_in_view_send_what_they_send),
    };
    return cmocka_run_group_tests(tests, open_pairs, close_pairs);
}
