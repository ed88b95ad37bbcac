// figures.c - draws what the tools cannot of the figures in docs/figures.md (scripts/figures.sh).
// Uses the public headers only.
//
//   figures blob FILE X Y R OUT     the reflectance of a pixel as a surface r = rho(direction); the
//   value R
//                                   reaches the border of the picture
//   figures disc FILE X Y OUT       the same on the stereographic disc (Wong 1998, Eq. 9.3, 9.4)
//   figures resampled FILE OUT L    FILE relit from its 50 x 50 samples of the disc, bilinear
//   figures errors FILE X,Y,W,H L OTHER...
//                                   RMS error of others against FILE, under light L and 16 more
//   figures row OUT [columns=N] [crop=X,Y,W,H] [frame=X,Y,W,H] [scale=K] [gain=G] PICTURE...
//                                   pictures side by side, N in a row (16); what stands before one
//                                   holds from there on, `crop=` and `frame=` alone end it; with a
//                                   gain, what is brighter than white burns out to white
//   figures column OUT PICTURE...   pictures of one width, one below the other
//   figures film TRUTH FILM N       folders with 1.exr to N.exr: PSNR of the frames, of what
//   changes
//                                   from frame to frame, and how strong that is (RMS, truth: 1)
#define RELUME_VEC3_SHORT
#include <relume/extensions.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRID = 50, TEST_LIGHTS = 16, MOST_PANELS = 16, GAP = 4 };

static void fail(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fputs("figures: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    exit(1);
}

static void must(relume_status status, const char *what)
{
    if (status)
        fail("%s: %s", what, relume_status_text(status));
}

static void *memory(size_t n, size_t size)
{
    void *p = calloc(n, size);
    if (!p)
        fail("out of memory");
    return p;
}

static void print(void *user, enum relume_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "figures: %s\n", text);
}

static const struct relume_log to_stderr = {.message = print};

// ---------------------------------------------------------------- files

struct file {
    relume_pack *pack;
    const struct relume_codes *codes;
};

static struct file open_file(const char *path)
{
    struct file f;
    must(relume_pack_open(&f.pack, path, relume_pack_params(.log = &to_stderr)), path);
    must(relume_pack_codes(&f.codes, f.pack, 0), path);
    return f;
}

static void close_file(struct file *f)
{
    relume_pack_destroy(&f->pack);
}

static void save(const struct relume_image *image, const char *path)
{
    must(relume_image_save(image, path, relume_image_params(.log = &to_stderr)), path);
}

static struct relume_image new_image(int width, int height, float value)
{
    struct relume_image image;
    must(relume_image_create(&image, width, height, 3), "a picture");
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
        image.data[i] = value;
    return image;
}

static float *at(const struct relume_image *image, int x, int y)
{
    return image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static struct relume_image relit(const struct file *f, const struct relume_light *lights, int n)
{
    struct relume_image image = {0};
    must(relume_relight(&image, f->codes, lights, n, relume_relight_params(.log = &to_stderr)),
         "relighting");
    return image;
}

// ---------------------------------------------------------------- one pixel

// Stored coefficients of one pixel, and memory for the functions that they belong to.
struct pixel {
    const relume_coder *coder;
    relume_coder *own;  // or NULL: that of a file
    const struct relume_coder_info *info;
    double *coefficients;  // [K][rgb]
    double *raw;           // [functions]
    bool whole;            // the functions exist below the horizon too
};

static struct pixel new_pixel(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    return (struct pixel){
        .coder = coder,
        .info = info,
        .coefficients = memory(3 * (size_t)info->coefficients, sizeof(double)),
        .raw = memory((size_t)info->functions, sizeof(double)),
        .whole = !info->hemispherical || (!info->basis->interpolates && !info->basis->upper_only),
    };
}

static struct pixel open_pixel(const struct file *f, int x, int y)
{
    const struct relume_codes *c = f->codes;
    const struct relume_coder_info *info = relume_coder_info(c->coder);
    if (x < 0 || y < 0 || x >= c->width || y >= c->height)
        fail("no pixel %d, %d; the file has %d x %d", x, y, c->width, c->height);
    if (info->joint || c->books || c->storage != RELUME_STORE_16 ||
        c->domain != RELUME_DOMAIN_LINEAR)
        fail("expected a linear file of 16 bits whose colours are apart");
    struct pixel p = new_pixel(c->coder);
    for (int i = 0; i < 3 * info->coefficients; i++) {
        const uint16_t *plane = c->plane[i];
        const double code = plane[(size_t)y * (size_t)c->width + (size_t)x];
        p.coefficients[i] = code * (double)c->scale[i] + (double)c->offset[i];
    }
    return p;
}

static void close_pixel(struct pixel *p)
{
    free(p->coefficients);
    free(p->raw);
    relume_coder_destroy(&p->own);
}

// The basis itself is asked, not relume_coder_weights, which answers with the horizon for
// directions below the horizon of a hemispherical capture.
static void reflectance(const struct pixel *p, vec3 d, double rgb[3])
{
    const struct relume_coder_info *info = p->info;
    info->basis->evaluate(p->coder, d, p->raw);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int k = 0; k < info->coefficients; k++) {
        double value = info->transform ? 0.0 : p->raw[k];
        for (int i = 0; info->transform && i < info->functions; i++)
            value += (double)info->transform[(size_t)k * (size_t)info->functions + (size_t)i] *
                     p->raw[i];
        for (int c = 0; c < 3; c++)
            rgb[c] += p->coefficients[3 * k + c] * value;
    }
}

static vec3 direction(double theta_rad, double phi_rad)
{
    return (vec3){sin(theta_rad) * cos(phi_rad), sin(theta_rad) * sin(phi_rad), cos(theta_rad)};
}

// Below the horizon of `p`: linear in the angle from the value at the horizon of the same azimuth
// to the mean of the horizon at the far pole (Wong 1998, 9.1.4). `d` lies above, mirrored.
static void below(const struct pixel *p, vec3 d, const double mean[3], float rgb[3])
{
    double horizon[3];
    const double t = asin(fmin(d.z, 1.0)) / (0.5 * M_PI);
    reflectance(p, direction(0.5 * M_PI, atan2(d.y, d.x)), horizon);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)((1.0 - t) * horizon[c] + t * mean[c]);
}

static void mean_horizon(const struct pixel *p, double mean[3])
{
    enum { STEPS = 360 };
    memset(mean, 0, 3 * sizeof *mean);
    for (int i = 0; i < STEPS; i++) {
        double rgb[3];
        reflectance(p, direction(0.5 * M_PI, 2.0 * M_PI * i / STEPS), rgb);
        for (int c = 0; c < 3; c++)
            mean[c] += rgb[c] / STEPS;
    }
}

static struct pixel filled_and_fitted(const struct pixel *p, int coefficients)
{
    const int n = p->info->lights;
    vec3 *lights = memory(2 * (size_t)n, sizeof *lights);
    float *samples = memory(6 * (size_t)n, sizeof *samples);
    float *planes = memory(3 * (size_t)coefficients, sizeof *planes);
    double mean[3], rgb[3];
    mean_horizon(p, mean);
    for (int i = 0; i < n; i++) {
        const vec3 d = p->info->directions[i];
        lights[i] = d;
        lights[n + i] = (vec3){d.x, d.y, -d.z};
        reflectance(p, d, rgb);
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)rgb[c];
        below(p, d, mean, samples + 3 * (n + i));
    }
    relume_coder *coder;
    must(relume_coder_create(&coder, &relume_basis_sh, lights, 2 * n,
                             relume_coder_params(.log = &to_stderr, .coefficients = coefficients)),
         "spherical harmonics");
    must(relume_coder_apply(coder, samples, 3, 1, planes, 1), "spherical harmonics");
    struct pixel out = new_pixel(coder);
    out.own = coder;
    for (int i = 0; i < 3 * coefficients; i++)
        out.coefficients[i] = (double)planes[i];
    free(lights);
    free(samples);
    free(planes);
    return out;
}

static double grey(const struct pixel *p, vec3 d)
{
    double rgb[3];
    reflectance(p, d, rgb);
    return fmax((rgb[0] + rgb[1] + rgb[2]) / 3.0, 0.0);
}

// ---------------------------------------------------------------- blob

static vec3 unit(vec3 a)
{
    const double length = sqrt(vec3_dot(a, a));
    return length > 0.0 ? (vec3){a.x / length, a.y / length, a.z / length} : a;
}

// A picture seen along `-back` without perspective; the origin is its middle.
struct stage {
    struct relume_image image;
    double *depth;  // [height][width], along `back`
    vec3 right, up, back, light;
    double scale;  // pixels per unit
};

static struct stage open_stage(int side, double reach)
{
    const double azimuth_rad = -1.0, elevation_rad = 0.35;
    struct stage s = {.image = new_image(side, side, 1.0f), .scale = 0.5 * side / reach};
    const size_t pixels = (size_t)side * (size_t)side;
    s.depth = memory(pixels, sizeof *s.depth);
    for (size_t i = 0; i < pixels; i++)
        s.depth[i] = -HUGE_VAL;
    s.back = direction(0.5 * M_PI - elevation_rad, azimuth_rad);
    s.right = (vec3){-sin(azimuth_rad), cos(azimuth_rad), 0.0};
    s.up = vec3_cross(s.back, s.right);
    s.light = unit(vec3_along(vec3_along(s.back, s.up, 0.7), s.right, -0.7));
    return s;
}

static void splat(struct stage *s, vec3 p, const float rgb[3])
{
    const int side = s->image.width;
    const int x = (int)floor(0.5 * side + s->scale * vec3_dot(p, s->right));
    const int y = (int)floor(0.5 * side - s->scale * vec3_dot(p, s->up));
    if (x < 0 || y < 0 || x >= side || y >= side)
        return;
    double *depth = s->depth + (size_t)y * (size_t)side + (size_t)x;
    if (vec3_dot(p, s->back) <= *depth)
        return;
    *depth = vec3_dot(p, s->back);
    memcpy(at(&s->image, x, y), rgb, 3 * sizeof *rgb);
}

// The quadrilateral between corner[v][u], so densely that no hole is left.
static void splat_quad(struct stage *s, const vec3 corner[2][2])
{
    const vec3 along_u = vec3_sub(corner[0][1], corner[0][0]),
               along_v = vec3_sub(corner[1][0], corner[0][0]),
               across = vec3_sub(corner[1][1], corner[0][0]);
    // Of the diagonals: one side may be a point.
    vec3 normal = unit(vec3_cross(across, vec3_sub(corner[1][0], corner[0][1])));
    if (vec3_dot(normal, s->back) < 0.0)
        normal = vec3_sub((vec3){0.0, 0.0, 0.0}, normal);
    const float shade = (float)(0.06 + 0.8 * fmax(vec3_dot(normal, s->light), 0.0));
    const float rgb[3] = {shade, shade, shade};
    const double longest = sqrt(fmax(vec3_dot(across, across),
                                     fmax(vec3_dot(along_u, along_u), vec3_dot(along_v, along_v))));
    const int steps = 2 + (int)(2.0 * s->scale * longest);
    for (int j = 0; j < steps; j++)
        for (int i = 0; i < steps; i++) {
            const double u = (i + 0.5) / steps, v = (j + 0.5) / steps;
            const vec3 p = {
                (1 - v) * ((1 - u) * corner[0][0].x + u * corner[0][1].x) +
                    v * ((1 - u) * corner[1][0].x + u * corner[1][1].x),
                (1 - v) * ((1 - u) * corner[0][0].y + u * corner[0][1].y) +
                    v * ((1 - u) * corner[1][0].y + u * corner[1][1].y),
                (1 - v) * ((1 - u) * corner[0][0].z + u * corner[0][1].z) +
                    v * ((1 - u) * corner[1][0].z + u * corner[1][1].z),
            };
            splat(s, p, rgb);
        }
}

static void splat_surface(struct stage *s, const struct pixel *p)
{
    enum { ROWS = 120, COLUMNS = 240 };
    const int rows = p->whole ? ROWS : ROWS / 2;
    vec3 *point = memory((size_t)(rows + 1) * (COLUMNS + 1), sizeof *point);
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j <= COLUMNS; j++) {
            const vec3 d = direction(M_PI * i / ROWS, 2.0 * M_PI * j / COLUMNS);
            point[i * (COLUMNS + 1) + j] = vec3_scale(d, grey(p, d));
        }
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < COLUMNS; j++) {
            const vec3 *a = point + i * (COLUMNS + 1) + j, *b = a + COLUMNS + 1;
            splat_quad(s, (const vec3[2][2]){{a[0], a[1]}, {b[0], b[1]}});
        }
    free(point);
}

// The horizon, as far out as the picture goes.
static void splat_horizon(struct stage *s, double reach)
{
    static const float blue[3] = {0.05f, 0.2f, 0.6f};
    for (int i = 0; i < 8192; i++)
        for (int j = -2; j <= 2; j++)
            splat(s,
                  vec3_scale(direction(0.5 * M_PI, 2.0 * M_PI * i / 8192),
                             0.97 * reach + 0.5 * j / s->scale),
                  blue);
}

static struct relume_image halved(const struct relume_image *image)
{
    struct relume_image half = new_image(image->width / 2, image->height / 2, 0.0f);
    for (int y = 0; y < half.height; y++)
        for (int x = 0; x < half.width; x++)
            for (int c = 0; c < 3; c++)
                at(&half, x, y)[c] =
                    0.25f * (at(image, 2 * x, 2 * y)[c] + at(image, 2 * x + 1, 2 * y)[c] +
                             at(image, 2 * x, 2 * y + 1)[c] + at(image, 2 * x + 1, 2 * y + 1)[c]);
    return half;
}

static void blob(char **args)
{
    struct file f = open_file(args[0]);
    struct pixel p = open_pixel(&f, atoi(args[1]), atoi(args[2]));
    if (args[5]) {
        struct pixel table = p;
        p = filled_and_fitted(&table, atoi(args[5]));
        close_pixel(&table);
    }
    const double reach = atof(args[3]);
    struct stage s = open_stage(480, reach);
    splat_horizon(&s, reach);
    splat_surface(&s, &p);
    struct relume_image half = halved(&s.image);
    save(&half, args[4]);
    relume_image_destroy(&half);
    relume_image_destroy(&s.image);
    free(s.depth);
    close_pixel(&p);
    close_file(&f);
}

// ---------------------------------------------------------------- disc

// The direction at a point of the unit square (Wong 1998, Eq. 9.3, 9.4; row 0 is +y). Outside the
// disc it is the horizon's at the same azimuth.
static vec3 from_disc(double x, double y)
{
    const double u = 2.0 * x - 1.0, v = 1.0 - 2.0 * y, r = fmin(hypot(u, v), 1.0);
    return direction(2.0 * atan(r), atan2(v, u));
}

static void disc(char **args)
{
    struct file f = open_file(args[0]);
    struct pixel p = open_pixel(&f, atoi(args[1]), atoi(args[2]));
    struct relume_image image = new_image(GRID, GRID, 1.0f);
    for (int y = 0; y < GRID; y++)
        for (int x = 0; x < GRID; x++) {
            const double u = (x + 0.5) / GRID, v = (y + 0.5) / GRID;
            double rgb[3];
            reflectance(&p, from_disc(u, v), rgb);
            for (int c = 0; c < 3 && hypot(u - 0.5, v - 0.5) <= 0.5; c++)
                at(&image, x, y)[c] = (float)rgb[c];
        }
    save(&image, args[3]);
    relume_image_destroy(&image);
    close_pixel(&p);
    close_file(&f);
}

// `f` under `light` as its samples at the grid of the disc show it, blended bilinearly.
static struct relume_image resampled_image(const struct file *f, struct relume_light light)
{
    const vec3 d = unit(light.direction);
    const double t = 1.0 / (1.0 + d.z);  // tan(theta / 2) = sin theta / (1 + cos theta)
    const double x = 0.5 * (1.0 + t * d.x) * GRID - 0.5, y = 0.5 * (1.0 - t * d.y) * GRID - 0.5;
    struct relume_light four[4];
    for (int i = 0; i < 4; i++) {
        const double left = floor(x) + i % 2, top = floor(y) + (i >> 1);
        const double weight = (1.0 - fabs(x - left)) * (1.0 - fabs(y - top));
        four[i] = light;
        four[i].direction = from_disc((left + 0.5) / GRID, (top + 0.5) / GRID);
        for (int c = 0; c < 3; c++)
            four[i].rgb[c] *= (float)weight;
    }
    return relit(f, four, 4);
}

static struct relume_light light_of(const char *spec)
{
    relume_rig *rig;
    must(relume_rig_create(&rig), spec);
    must(relume_rig_add(rig, spec, NULL, &to_stderr), spec);
    const struct relume_light light = relume_rig_entry(rig, 0)->light;
    relume_rig_destroy(&rig);
    return light;
}

static void resampled(char **args)
{
    struct file f = open_file(args[0]);
    struct relume_image image = resampled_image(&f, light_of(args[2]));
    save(&image, args[1]);
    relume_image_destroy(&image);
    close_file(&f);
}

// ---------------------------------------------------------------- errors

struct box {
    int x, y, width, height;
};

static struct box box_of(const char *text)
{
    struct box b = {0};
    if (*text && (sscanf(text, "%d,%d,%d,%d", &b.x, &b.y, &b.width, &b.height) != 4 || b.x < 0 ||
                  b.y < 0 || b.width < 1 || b.height < 1))
        fail("expected X,Y,W,H; found '%s'", text);
    return b;
}

static struct relume_image cropped(const struct relume_image *image, struct box b)
{
    if (b.x + b.width > image->width || b.y + b.height > image->height)
        fail("a square outside the picture of %d x %d", image->width, image->height);
    struct relume_image out = new_image(b.width, b.height, 0.0f);
    for (int y = 0; y < b.height; y++)
        memcpy(at(&out, 0, y), at(image, b.x, b.y + y), 3 * sizeof(float) * (size_t)b.width);
    return out;
}

static double rms(const struct relume_image *a, const struct relume_image *b)
{
    struct relume_difference difference;
    must(relume_image_compare(&difference, a, b,
                              relume_compare_params(.no_ssim = true, .no_delta_e = true)),
         "comparing");
    return difference.rms;
}

// RMS error over the picture and over the square of it.
static void measure(double error[2], const struct relume_image *image,
                    const struct relume_image *reference, struct box square)
{
    struct relume_image a = cropped(image, square), b = cropped(reference, square);
    error[0] = rms(image, reference);
    error[1] = rms(&a, &b);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

static void print_errors(const char *name, const struct relume_image *images,
                         const struct relume_image *references, struct box square)
{
    double shown[2], error[2], mean[2] = {0.0, 0.0};
    measure(shown, &images[0], &references[0], square);
    for (int i = 1; i <= TEST_LIGHTS; i++) {
        measure(error, &images[i], &references[i], square);
        for (int j = 0; j < 2; j++)
            mean[j] += error[j] / TEST_LIGHTS;
    }
    printf("| %s | %.4f | %.4f | %.4f | %.4f |\n", name, shown[0], shown[1], mean[0], mean[1]);
}

static void destroy_all(struct relume_image *images)
{
    for (int i = 0; i <= TEST_LIGHTS; i++)
        relume_image_destroy(&images[i]);
}

static void errors(char **args)
{
    struct file table = open_file(args[0]);
    const struct box square = box_of(args[1]);
    vec3 directions[TEST_LIGHTS];
    must(relume_directions_make(directions, TEST_LIGHTS, relume_pattern_find("hammersley"),
                                relume_directions_params(.hemisphere = true)),
         "lights");
    struct relume_light light[TEST_LIGHTS + 1] = {light_of(args[2])};
    struct relume_image reference[TEST_LIGHTS + 1], image[TEST_LIGHTS + 1];
    for (int i = 1; i <= TEST_LIGHTS; i++)
        light[i] = (struct relume_light){.direction = directions[i - 1], .rgb = {1, 1, 1}};
    puts("| coder | picture | square | picture, 16 lights | square, 16 lights |");
    puts("|---|---|---|---|---|");
    for (int i = 0; i <= TEST_LIGHTS; i++) {
        reference[i] = relit(&table, &light[i], 1);
        image[i] = resampled_image(&table, light[i]);
    }
    print_errors("disc 50 x 50", image, reference, square);
    destroy_all(image);
    for (args += 3; *args; args++) {
        struct file f = open_file(*args);
        const struct relume_coder_info *info = relume_coder_info(f.codes->coder);
        char name[64];
        snprintf(name, sizeof name, "%s %d", info->basis->name, info->coefficients);
        for (int i = 0; i <= TEST_LIGHTS; i++)
            image[i] = relit(&f, &light[i], 1);
        print_errors(name, image, reference, square);
        destroy_all(image);
        close_file(&f);
    }
    destroy_all(reference);
    close_file(&table);
}

// ---------------------------------------------------------------- row

// As film does: the colour of what is brighter than white goes as it exceeds white.
static void burn(float *rgb)
{
    const float most = fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    for (int c = 0; c < 3 && most > 1.0f; c++)
        rgb[c] = 1.0f + (fmaxf(rgb[c], 0.0f) / most - 1.0f) / most;
}

// Every pixel of `b` as a square of `scale` pixels.
static struct relume_image enlarged(const struct relume_image *image, struct box b, int scale,
                                    float gain)
{
    struct relume_image part = cropped(image, b),
                        out = new_image(b.width * scale, b.height * scale, 0.0f);
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            float *rgb = at(&out, x, y);
            for (int c = 0; c < 3; c++)
                rgb[c] = gain * at(&part, x / scale, y / scale)[c];
            if (gain != 1.0f)
                burn(rgb);
        }
    relume_image_destroy(&part);
    return out;
}

static void draw_frame(struct relume_image *image, struct box f)
{
    static const float yellow[3] = {1.0f, 0.8f, 0.0f};
    for (int y = f.y - 2; y < f.y + f.height + 2; y++)
        for (int x = f.x - 2; x < f.x + f.width + 2; x++) {
            const bool inside = x >= f.x && x < f.x + f.width && y >= f.y && y < f.y + f.height;
            if (!inside && x >= 0 && y >= 0 && x < image->width && y < image->height)
                memcpy(at(image, x, y), yellow, sizeof yellow);
        }
}

static struct box scaled(struct box frame, struct box crop, int scale)
{
    return (struct box){(frame.x - crop.x) * scale, (frame.y - crop.y) * scale, frame.width * scale,
                        frame.height * scale};
}

struct panel_options {
    struct box crop, frame;
    int scale, columns;
    float gain;
};

static bool panel_option(struct panel_options *o, const char *arg)
{
    if (!strncmp(arg, "crop=", 5))
        o->crop = box_of(arg + 5);
    else if (!strncmp(arg, "frame=", 6))
        o->frame = box_of(arg + 6);
    else if (!strncmp(arg, "scale=", 6))
        o->scale = atoi(arg + 6) > 1 ? atoi(arg + 6) : 1;
    else if (!strncmp(arg, "columns=", 8))
        o->columns = atoi(arg + 8) > 1 ? atoi(arg + 8) : 1;
    else if (!strncmp(arg, "gain=", 5))
        o->gain = (float)atof(arg + 5);
    else
        return false;
    return true;
}

static struct relume_image panel(const struct panel_options *o, const char *path)
{
    struct relume_image image = {0};
    must(relume_image_load(&image, path, relume_image_params(.log = &to_stderr)), path);
    const struct box all = {0, 0, image.width, image.height}, crop = o->crop.width ? o->crop : all;
    struct relume_image out = enlarged(&image, crop, o->scale, o->gain);
    if (o->frame.width)
        draw_frame(&out, scaled(o->frame, crop, o->scale));
    relume_image_destroy(&image);
    return out;
}

// Side by side, `columns` in a row.
static struct relume_image arranged(const struct relume_image *panels, int n, int columns)
{
    int x[MOST_PANELS], y[MOST_PANELS], width = 0, height = 0;
    for (int i = 0, top = 0; i < n; i++) {
        const bool begins = i % columns == 0;
        top = begins && i ? height + GAP : top;
        x[i] = begins ? 0 : x[i - 1] + panels[i - 1].width + GAP;
        y[i] = top;
        width = x[i] + panels[i].width > width ? x[i] + panels[i].width : width;
        height = top + panels[i].height > height ? top + panels[i].height : height;
    }
    struct relume_image out = new_image(width, height, 1.0f);
    for (int i = 0; i < n; i++)
        for (int row = 0; row < panels[i].height; row++)
            memcpy(at(&out, x[i], y[i] + row), at(&panels[i], 0, row),
                   3 * sizeof(float) * (size_t)panels[i].width);
    return out;
}

static void row(char **args)
{
    const char *path = *args++;
    struct panel_options o = {.scale = 1, .columns = MOST_PANELS, .gain = 1.0f};
    struct relume_image panels[MOST_PANELS];
    int n = 0;
    for (; *args; args++) {
        if (panel_option(&o, *args))
            continue;
        if (n == MOST_PANELS)
            fail("more than %d pictures", MOST_PANELS);
        panels[n++] = panel(&o, *args);
    }
    if (!n)
        fail("row: expected a picture");
    struct relume_image out = arranged(panels, n, o.columns);
    save(&out, path);
    relume_image_destroy(&out);
    for (int i = 0; i < n; i++)
        relume_image_destroy(&panels[i]);
}

static void column(char **args)
{
    const char *path = *args++;
    struct relume_image out = {0};
    for (; *args; args++) {
        struct relume_image next = {0}, both;
        must(relume_image_load(&next, *args, relume_image_params(.log = &to_stderr)), *args);
        if (out.data && next.width != out.width)
            fail("%s: expected a width of %d; found %d", *args, out.width, next.width);
        const int above = out.data ? out.height + GAP : 0;
        both = new_image(next.width, above + next.height, 1.0f);
        for (int y = 0; y < out.height; y++)
            memcpy(at(&both, 0, y), at(&out, 0, y), 3 * sizeof(float) * (size_t)out.width);
        for (int y = 0; y < next.height; y++)
            memcpy(at(&both, 0, above + y), at(&next, 0, y),
                   3 * sizeof(float) * (size_t)next.width);
        relume_image_destroy(&out);
        relume_image_destroy(&next);
        out = both;
    }
    save(&out, path);
    relume_image_destroy(&out);
}

// ---------------------------------------------------------------- films

// As it is displayed.
static struct relume_image frame_of(const char *folder, int number)
{
    static const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    char path[4096];
    struct relume_image image = {0};
    snprintf(path, sizeof path, "%s/%d.exr", folder, number);
    must(relume_image_load(&image, path, relume_image_params(.log = &to_stderr)), path);
    const size_t n = 3 * (size_t)image.width * (size_t)image.height;
    for (size_t i = 0; i < n; i++)
        image.data[i] = relume_transfer_encode(srgb, fminf(fmaxf(image.data[i], 0.0f), 1.0f));
    return image;
}

// Mean squares of display values.
struct film_error {
    double frames, changes, shown, wanted;
};

static void add_frames(struct film_error *e, const struct relume_image *want,
                       const struct relume_image *got, const struct relume_image *before)
{
    const size_t n = 3 * (size_t)want->width * (size_t)want->height;
    if (got->width != want->width || got->height != want->height)
        fail("film: expected frames of %d x %d pixels", want->width, want->height);
    for (size_t i = 0; i < n; i++) {
        const double off = (double)(got->data[i] - want->data[i]);
        e->frames += off * off / (double)n;
        if (!before[0].data)
            continue;
        const double wanted = (double)(want->data[i] - before[0].data[i]);
        const double shown = (double)(got->data[i] - before[1].data[i]);
        e->changes += (shown - wanted) * (shown - wanted) / (double)n;
        e->wanted += wanted * wanted / (double)n;
        e->shown += shown * shown / (double)n;
    }
}

static void film(char **args)
{
    const int n = atoi(args[2]);
    struct film_error e = {0};
    struct relume_image before[2] = {{0}, {0}};
    if (n < 2)
        fail("film: expected two frames or more");
    for (int i = 1; i <= n; i++) {
        struct relume_image now[2] = {frame_of(args[0], i), frame_of(args[1], i)};
        add_frames(&e, &now[0], &now[1], before);
        for (int k = 0; k < 2; k++) {
            relume_image_destroy(&before[k]);
            before[k] = now[k];
        }
    }
    printf("%s: frames %.1f dB, changes %.1f dB, %.2f as strong\n", args[1],
           -10.0 * log10(e.frames / n), -10.0 * log10(e.changes / (n - 1)),
           sqrt(e.shown / e.wanted));
    relume_image_destroy(&before[0]);
    relume_image_destroy(&before[1]);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        int least, most;
        void (*run)(char **args);
    } commands[] = {
        {"blob", 5, 6, blob},      {"disc", 4, 4, disc}, {"resampled", 3, 3, resampled},
        {"errors", 4, 99, errors}, {"row", 2, 99, row},  {"column", 2, 99, column},
        {"film", 3, 3, film},
    };
    for (size_t i = 0; argc > 1 && i < sizeof commands / sizeof *commands; i++)
        if (!strcmp(argv[1], commands[i].name) && argc - 2 >= commands[i].least &&
            argc - 2 <= commands[i].most) {
            commands[i].run(argv + 2);
            return 0;
        }
    fail("usage: figures blob|disc|resampled|errors|row|column|film ...; see samples/figures.c");
}
