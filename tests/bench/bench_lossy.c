// bench_lossy.c - bytes, quality and seconds of every preset of AV1, for captures: what the efforts
// of `encode` are chosen by. Usage: bench_lossy [--components N] [--psnr DB] [--only NAME] CAPTURE
// ...
//
// The planes of each capture are coded by each preset at several quantisers. Bytes at the wanted
// quality lie on the line through the two nearest. Quality is that of the captured lights before
// values are clamped; components miss what was left out of them as well. Seconds are of the
// processor, for one run.
#include "bench.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/lossy/lossy.h"

enum { QUANTISERS = 5 };
static const int quantisers[QUANTISERS] = {12, 20, 28, 38, 50};

struct point {
    double bytes, psnr_db, encode_s, decode_s;
};

struct planes {
    relume_coefficients *coefficients;
    const struct relume_coefficients_info *info;
    double *worth;    // [planes]: squared display values of the lights for a squared step
    double left_out;  // squared error of what the coder does not keep
};

static double cpu_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// A step of plane k adds worth[k] to the mean square over lights and channels.
static void weigh(struct planes *p)
{
    const struct relume_coder_info *c = relume_coder_info(p->info->coder);
    float *w = malloc(3 * (size_t)c->coefficients * sizeof *w), constant[3];
    memset(p->worth, 0, (size_t)p->info->planes * sizeof *p->worth);
    for (int i = 0; i < c->lights; i++) {
        relume_coder_weights(p->info->coder, c->directions[i], w, constant);
        for (int k = 0; k < c->coefficients; k++)
            for (int channel = 0; channel < 3; channel++) {
                const double v = (double)w[3 * k + channel];
                p->worth[relume_coder_plane(c, k, channel)] += v * v / (3.0 * c->lights);
            }
    }
    for (int k = 0; k < p->info->planes; k++)
        p->worth[k] *= (double)p->info->scale[k] * (double)p->info->scale[k];
    free(w);
}

static double error_of(const struct planes *p, const uint16_t *before, const uint16_t *after)
{
    const size_t pixels = (size_t)p->info->width * (size_t)p->info->height;
    double sum = 0.0;
    for (size_t k = 0; k < (size_t)p->info->planes; k++) {
        double plane = 0.0;
        for (size_t i = 0; i < pixels; i++) {
            const double d = (double)before[k * pixels + i] - (double)after[k * pixels + i];
            plane += d * d;
        }
        sum += plane * p->worth[k] / (double)pixels;
    }
    return sum;
}

static void read_codes(uint16_t *codes, const struct planes *p)
{
    const size_t width = (size_t)p->info->width, n = (size_t)p->info->planes;
    uint16_t *row = malloc(n * width * sizeof *row);
    for (int y = 0; y < p->info->height; y++) {
        bench_check(relume_coefficients_read(p->coefficients, y, 1, row));
        for (size_t k = 0; k < n; k++)
            memcpy(codes + (k * (size_t)p->info->height + (size_t)y) * width, row + k * width,
                   width * sizeof *row);
    }
    free(row);
}

static void say(void *nobody, enum relume_level level, const char *text)
{
    (void)nobody, (void)level;
    fprintf(stderr, "bench: %s\n", text);
}

static struct point measure(const struct planes *p, const struct av1_effort *effort,
                            const uint16_t *before, uint16_t *after)
{
    int *order = lossy_order(p->info->coder);
    const struct lossy_shape shape = {p->info->width,  p->info->height,
                                      p->info->planes, lossy_in_colour(p->info->coder),
                                      order,           NULL};
    const struct relume_rect all = {0, 0, p->info->width, p->info->height};
    const struct relume_log log = {.message = say};
    struct lossy_words words;
    struct point out;
    double t = cpu_s();
    bench_check(lossy_encode(&words, &p->coefficients, 1, effort, 0, &log));
    out.encode_s = cpu_s() - t;
    t = cpu_s();
    bench_check(lossy_decode(after, &shape, &all, &words, NULL, 0, NULL));
    out.decode_s = cpu_s() - t;
    out.bytes = 4.0 * (double)words.count;
    out.psnr_db = -10.0 * log10(p->left_out + error_of(p, before, after));
    mem_free(words.word);
    mem_free(order);
    return out;
}

// On the line through the points nearest to the quality, the finest first.
static struct point at_quality(const struct point *p, double db)
{
    int i = 0;
    while (i + 2 < QUANTISERS && p[i + 1].psnr_db > db)
        i++;
    const double t = (db - p[i].psnr_db) / (p[i + 1].psnr_db - p[i].psnr_db);
    const struct point a = p[i], b = p[i + 1];
    return (struct point){exp(log(a.bytes) + t * log(b.bytes / a.bytes)), db,
                          a.encode_s + t * (b.encode_s - a.encode_s),
                          a.decode_s + t * (b.decode_s - a.decode_s)};
}

static void open_planes(struct planes *p, relume_coder **coder, relume_capture **capture,
                        const char *path, int components)
{
    const struct relume_project_params encode = {.domain = RELUME_DOMAIN_DISPLAY,
                                                 .storage = RELUME_STORE_12};
    bench_check(relume_capture_open(capture, path, NULL));
    bench_check(relume_coder_learn(coder, components ? &relume_basis_pca : &relume_basis_table,
                                   *capture, relume_coder_params(.coefficients = components),
                                   &encode));
    bench_check(relume_project(&p->coefficients, *coder, *capture, 0, &encode));
    p->info = relume_coefficients_info(p->coefficients);
    p->worth = malloc((size_t)p->info->planes * sizeof *p->worth);
    const struct relume_fidelity f = relume_coefficients_report(p->coefficients);
    p->left_out = components ? pow(10.0, -0.1 * f.psnr_db) : 0.0;
}

static void bench_capture(const char *path, int components, double db, const char *some)
{
    struct planes p = {0};
    relume_coder *coder;
    relume_capture *capture;
    open_planes(&p, &coder, &capture, path, components);
    const size_t samples = (size_t)p.info->planes * (size_t)p.info->width * (size_t)p.info->height;
    uint16_t *before = malloc(samples * sizeof *before), *after = malloc(samples * sizeof *after);
    printf("%s: %d planes of %d x %d; bytes, encode s, decode s at %.1f dB; dB at each quantiser\n",
           path, p.info->planes, p.info->width, p.info->height, db);
    for (int i = 0; i < AV1_PRESETS; i++) {
        struct point point[QUANTISERS];
        if (!strstr(av1_presets[i].name, some))
            continue;
        bench_check(coefficients_share_steps(&p.coefficients, 1, false, RELUME_STEP_HALVED));
        weigh(&p);
        read_codes(before, &p);
        for (int q = 0; q < QUANTISERS; q++)
            point[q] = measure(&p, &(const struct av1_effort){quantisers[q] * AV1_STEPS, i}, before,
                               after);
        const struct point at = at_quality(point, db);
        printf("  %-20s %9.0f %8.2f %6.2f  ", av1_presets[i].name, at.bytes, at.encode_s,
               at.decode_s);
        for (int q = 0; q < QUANTISERS; q++)
            printf(" %.2f", point[q].psnr_db);
        printf("\n");
        fflush(stdout);
    }
    free(before);
    free(after);
    free(p.worth);
    relume_coefficients_destroy(&p.coefficients);
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
}

int main(int argc, char **argv)
{
    int components = 0, i = 1;
    double db = 38.0;
    const char *some = "";
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2)
        if (!strcmp(argv[i], "--components"))
            components = atoi(argv[i + 1]);
        else if (!strcmp(argv[i], "--psnr"))
            db = atof(argv[i + 1]);
        else if (!strcmp(argv[i], "--only"))
            some = argv[i + 1];
    for (; i < argc; i++)
        bench_capture(argv[i], components, db, some);
    return 0;
}
