// bench_seeing.c - glare in the viewer: compute passes of OpenGL against the library, stage by
// stage On a graphics card where EGL finds one, else by llvmpipe. Usage: bench_seeing [WIDTHxHEIGHT
// [SIZE]]; default 1280x720 with a pattern of 512 in software, 1920x1080 with 1536 on a card
#include "bench.h"

#include "glare/gl_glare.h"
#include "relight/eye/pattern.h"
#include "relight/eye/pupil.h"
#include "window/context_offscreen.h"

enum { RUNS = 5 };

static struct gl gl;
static int width = 1280, height = 720, size = 512;
static const double field_deg = 4.0;

enum { APERTURE, PATTERN, FRAME, SAME_FRAME, ALL, STAGES };
static const char *const names[STAGES] = {"aperture", "diffraction and colours",
                                          "convolution, new frame", "convolution, same frame",
                                          "all of a frame that rests"};

static void fill(struct relume_image *frame)
{
    bench_check(relume_image_create(frame, width, height, 3));
    for (int i = 0; i < 3 * width * height; i++)
        frame->data[i] = (float)(i * 2654435761u >> 8 & 0xffff) / 65536.0f;
    for (int i = 0; i < 20; i++)
        frame->data[3 * (i * 37 % height * width + i * 101 % width)] = 1e5f;
}

static double since(double *then)
{
    gl.Finish();
    const double now = now_s(), s = now - *then;
    *then = now;
    return s;
}

static const struct relume_glare_params view = {.fov_deg = 45};

static void run_passes(struct times bench[STAGES], relume_eye *eye,
                       const struct relume_image *frame)
{
    const struct relume_psf_params params = {.size = size, .half_field_deg = field_deg};
    struct gl_glare card = {.capacity = 0};
    struct target from, seen;
    bench_check(target_create(&from, &gl, width, height, NULL));
    bench_check(target_create(&seen, &gl, width, height, NULL));
    target_write(&from, &gl, frame);
    bench_check(gl_glare_prepare(&card, &gl, &params));
    for (int run = -1; run < RUNS; run++) {
        struct gl_glare_facts facts = {.greatest = 1e5};
        bool fits = true;
        bench_check(relume_eye_advance(eye, 0.04, 100));
        double then = now_s();
        gl_aperture_draw(&card.psf.aperture, &gl, relume_eye_aperture(eye));
        const double drawn = since(&then);
        bench_check(gl_glare_update(&card, &gl, eye, NULL));
        const double updated = since(&then);
        bench_check(gl_glare_apply(&card, &gl, &seen, &from, &facts, eye, &view, &fits, NULL));
        const double fresh = since(&then);
        facts.same = true;
        bench_check(gl_glare_apply(&card, &gl, &seen, &from, &facts, eye, &view, &fits, NULL));
        const double same = since(&then);
        if (!fits)
            fprintf(stderr, "bench: the card has no room for this frame\n");
        const double s[STAGES] = {drawn, updated - drawn, fresh, same, updated + same};
        for (int i = 0; run >= 0 && i < STAGES; i++)
            times_add(&bench[i], s[i]);
    }
    gl_glare_destroy(&card, &gl);
    target_destroy(&from, &gl);
    target_destroy(&seen, &gl);
}

static void run_library(struct times bench[STAGES], relume_eye *eye,
                        const struct relume_image *frame, enum relume_glare_mode mode)
{
    struct relume_glare_params params = view;
    struct relume_image out;
    relume_psf *psf;
    relume_glare *work;
    params.mode = mode;
    bench_check(
        relume_psf_create(&psf, relume_psf_params(.size = size, .half_field_deg = field_deg)));
    bench_check(relume_glare_create(&work));
    for (int run = -1; run < RUNS; run++) {
        bench_check(relume_eye_advance(eye, 0.04, 100));
        bench_check(relume_psf_update(psf, eye));
        const struct relume_psf_times t = relume_psf_times(psf);
        double then = now_s();
        bench_check(relume_glare_apply(&out, work, frame, false, psf, &params));
        const double fresh = since(&then);
        relume_image_destroy(&out);
        bench_check(relume_glare_apply(&out, work, frame, true, psf, &params));
        const double same = since(&then);
        relume_image_destroy(&out);
        const double pattern = t.diffraction_s + t.chromatic_s;
        const double s[STAGES] = {t.aperture_s, pattern, fresh, same,
                                  t.aperture_s + pattern + same};
        for (int i = 0; run >= 0 && i < STAGES; i++)
            times_add(&bench[i], s[i]);
    }
    relume_glare_destroy(&work);
    relume_psf_destroy(&psf);
}

int main(int argc, char **argv)
{
    static struct times passes[STAGES], library[2][STAGES];
    const struct context_backend *backend = context_offscreen("auto");
    struct relume_image frame;
    relume_eye *eye;
    void *context;
    if (backend == &context_egl_card) {
        width = 1920;
        height = 1080;
        size = 1536;
    }
    if ((argc > 1 && sscanf(argv[1], "%5dx%5d", &width, &height) != 2) ||
        (argc > 2 && sscanf(argv[2], "%5d", &size) != 1))
        return 2;
    bench_check(backend->open(&context, 1, 1, "", NULL));
    bench_check(gl_load(&gl, backend->get_proc, NULL));
    printf("glare: frame of %d x %d, pattern of %d, drawn by %s\n", width, height, size,
           backend->name);
    bench_check(relume_eye_create(&eye, NULL, 100));
    fill(&frame);
    const struct relume_psf_params pattern = {.size = size, .half_field_deg = field_deg};
    if (gl_psf_fits(&gl, &pattern))
        run_passes(passes, eye, &frame);
    run_library(library[0], eye, &frame, RELUME_GLARE_FFT);
    run_library(library[1], eye, &frame, RELUME_GLARE_HYBRID);
    const struct {
        const char *what;
        const struct times *bench;
    } rows[] = {
        {"compute passes", passes}, {"library, FFT", library[0]}, {"library, hybrid", library[1]}};
    for (int r = 0; r < 3; r++) {
        printf("%s\n", rows[r].what);
        for (int i = 0; rows[r].bench->n && i < STAGES; i++)
            bench_print(names[i], &rows[r].bench[i]);
    }
    for (int i = 0; passes->n && i < STAGES; i++)
        printf("  %-44s %8.2f passes / library\n", names[i],
               times_median(&passes[i]) / times_median(&library[0][i]));
    relume_image_destroy(&frame);
    relume_eye_destroy(&eye);
    backend->close(context);
    return 0;
}
