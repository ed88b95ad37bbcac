// .ptm and .rti written by hand and read back: every variant against the numbers that went in.
#include "foreign_pixel.h"
#include "in_folder.h"

#include "exchange/formats/ptm.h"
#include "exchange/formats/rti.h"
#include "exchange/formats/web.h"
#include "image/image/jpeg.h"
#include "image/image/trellis.h"

enum { W = 8, H = 5, PIXELS = W * H };

// The codes of a made-up picture: term `t` (0..5 as x2 y2 xy x y 1), channel c, from the top.
static uint8_t code(int t, int c, int x, int y)
{
    return (uint8_t)(37 * t + 11 * c + 5 * x + 23 * y + 3);
}

static const double scale[6] = {0.5, 1.25, 2.0, 0.75, 1.0, 1.5};
static const int bias[6] = {100, 3, 128, 77, 255, 0};

struct text {
    char *data;
    size_t size;
    FILE *file;
};

static void begin(struct text *t)
{
    t->file = open_memstream(&t->data, &t->size);
    assert_non_null(t->file);
}

static void header(FILE *f, const char *version, const char *format, const char *end, bool one_line)
{
    fprintf(f, "PTM_%s%s%s%s%d%s%d%s", version, end, format, end, W, one_line ? " " : end, H, end);
    for (int i = 0; i < 6; i++)
        fprintf(f, "%g ", scale[i]);
    fputs(end, f);
    for (int i = 0; i < 6; i++)
        fprintf(f, "%d ", bias[i]);
    fputs(end, f);
}

static void raw_rgb(FILE *f)
{
    for (int c = 0; c < 3; c++)
        for (int y = H - 1; y >= 0; y--)
            for (int x = 0; x < W; x++)
                for (int t = 0; t < 6; t++)
                    fputc(code(t, c, x, y), f);
}

static void terms_of(FILE *f, int x, int y)
{
    for (int t = 0; t < 6; t++)
        fputc(code(t, 0, x, y), f);
}

static void colour_of(FILE *f, int x, int y)
{
    for (int c = 0; c < 3; c++)
        fputc(code(6, c, x, y), f);
}

static const char *save(struct text *t, const char *name)
{
    static char path[128];
    fclose(t->file);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    test_write(path, t->data, t->size);
    free(t->data);
    return path;
}

static double polynomial(int c, int x, int y, struct relume_vec3 l)
{
    const double v[6] = {l.x * l.x, l.y * l.y, l.x * l.y, l.x, l.y, 1.0};
    double sum = 0.0;
    for (int t = 0; t < 6; t++)
        sum += (code(t, c, x, y) - bias[t]) * scale[t] * v[t];
    return sum / 255.0;
}

static void check_picture(const struct foreign *f, bool luminance)
{
    uint32_t seed = 1;
    for (int i = 0; i < 20; i++) {
        struct relume_vec3 l = test_direction(&seed);
        l.z = fabs(l.z);
        double w[18], constant[3], rgb[3];
        foreign_weights(f, l, w, constant);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                foreign_pixel(f, (size_t)(y * W + x), w, constant, rgb);
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(rgb[c],
                               luminance ? polynomial(0, x, y, l) * code(6, c, x, y) / 255.0
                                         : polynomial(c, x, y, l),
                               1e-6);
            }
    }
}

static void raw_rgb_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *version, *end;
        bool one_line;
    } kinds[] = {{"1.2", "\n", false},
                 {"1.2", "\r\n", false},
                 {"1.2", "\n", true},
                 {"1.1", " \n", true},
                 {"1.2", " \r\n", true}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct text t;
        struct foreign f;
        begin(&t);
        header(t.file, kinds[i].version, "PTM_FORMAT_RGB", kinds[i].end, kinds[i].one_line);
        raw_rgb(t.file);
        CHECK_OK(ptm_read(&f, save(&t, "a.ptm"), NULL, NULL));
        assert_int_equal(f.width, W);
        assert_int_equal(f.height, H);
        check_picture(&f, false);
        foreign_free(&f);
    }
}

static void raw_lrgb_is_read(void **state)
{
    (void)state;
    for (int interleaved = 0; interleaved < 2; interleaved++) {
        struct text t;
        struct foreign f;
        begin(&t);
        header(t.file, interleaved ? "1.1" : "1.2", "PTM_FORMAT_LRGB", "\n", false);
        for (int step = 0; step < 2 - interleaved; step++)
            for (int y = H - 1; y >= 0; y--)
                for (int x = 0; x < W; x++) {
                    if (interleaved || step == 0)
                        terms_of(t.file, x, y);
                    if (interleaved || step == 1)
                        colour_of(t.file, x, y);
                }
        CHECK_OK(ptm_read(&f, save(&t, "a.ptm"), NULL, NULL));
        check_picture(&f, true);
        foreign_free(&f);
    }
}

static void raw_files_come_back_byte_for_byte(void **state)
{
    (void)state;
    for (int luminance = 0; luminance < 2; luminance++) {
        struct text t;
        struct foreign f;
        begin(&t);
        header(t.file, "1.2", luminance ? "PTM_FORMAT_LRGB" : "PTM_FORMAT_RGB", "\n", false);
        if (luminance)
            for (int i = 0; i < 9 * PIXELS; i++)
                fputc(i % 251, t.file);
        else
            raw_rgb(t.file);
        fflush(t.file);
        const size_t size = t.size;
        char *copy = malloc(size);
        memcpy(copy, t.data, size);
        CHECK_OK(ptm_read(&f, save(&t, "a.ptm"), NULL, NULL));
        char path[128];
        snprintf(path, sizeof path, "%s/b.ptm", folder);
        CHECK_OK(ptm_write(&f, path, NULL, NULL));
        foreign_free(&f);
        FILE *back = fopen(path, "rb");
        char *bytes = malloc(size + 1);
        assert_int_equal(fread(bytes, 1, size + 1, back), size);
        fclose(back);
        assert_memory_equal(bytes, copy, size);
        free(bytes);
        free(copy);
    }
}

// ---------------------------------------------------------------- JPEG planes

static uint8_t *grey_jpeg(int seed, size_t *size, uint8_t decoded[PIXELS])
{
    float plane[PIXELS], dct[64];
    int16_t codes[64];
    for (int i = 0; i < PIXELS; i++)
        plane[i] = 60.0f * sinf((float)(i % W + seed) * 0.4f) + (float)(5 * seed);
    trellis_transform(plane, W, H, dct);
    trellis_quantise(dct, 1, 2.0, 0.0, codes);
    const struct jpeg_picture p = {
        .width = W, .height = H, .planes = 1, .step = {2}, .coefficients = {codes}};
    uint8_t *bytes;
    struct jpeg_codes back;
    CHECK_OK(jpeg_encode(&bytes, size, &p));
    CHECK_OK(jpeg_decode(&back, bytes, *size, "made", NULL, NULL));
    memcpy(decoded, back.data, PIXELS);
    jpeg_codes_free(&back);
    return bytes;
}

struct jpegs {
    int n;
    long field[7][18];
    uint8_t *bytes[18];
    uint8_t decoded[18][PIXELS];
};

static void make_jpegs(struct jpegs *j, int n)
{
    *j = (struct jpegs){.n = n};
    for (int i = 0; i < n; i++) {
        size_t size;
        j->bytes[i] = grey_jpeg(i, &size, j->decoded[i]);
        j->field[3][i] = n - 1 - i;  // decoded from the last to the first
        j->field[4][i] = -1;
        j->field[5][i] = (long)size;
    }
    // plane 1 is predicted from plane 4 and mended in one pixel, plane 0 from the inverse of 1
    j->field[4][1] = 4;
    j->field[6][1] = 5;
    j->field[0][0] = 1;
    j->field[4][0] = 1;
    // no transform without a reference, no motion without a vector, no vector without motion
    j->field[0][3] = 1;
    j->field[0][1] = 2;
    j->field[1][4] = j->field[2][4] = 3;
}

static const char *save_jpegs(const struct jpegs *j, const char *format)
{
    struct text t;
    begin(&t);
    header(t.file, "1.2", format, "\n", false);
    fputs("90\n", t.file);
    for (int f = 0; f < 7; f++) {
        for (int i = 0; i < j->n; i++)
            fprintf(t.file, "%ld ", j->field[f][i]);
        fputs("\n", t.file);
    }
    for (int i = 0; i < j->n; i++) {
        fwrite(j->bytes[i], 1, (size_t)j->field[5][i], t.file);
        if (j->field[6][i])
            fwrite("\0\0\0\12\311", 1, 5, t.file);  // pixel 10 becomes 201
    }
    return save(&t, "j.ptm");
}

static void free_jpegs(struct jpegs *j)
{
    for (int i = 0; i < j->n; i++)
        relume_free(j->bytes[i]);
}

static void jpeg_planes_are_read(void **state)
{
    (void)state;
    static const int place_of_term[6] = {5, 3, 4, 0, 2, 1};  // 1 x y x2 xy y2 among x2 y2 xy x y 1
    for (int n = 9; n <= 18; n += 9) {
        struct jpegs j;
        struct foreign f;
        make_jpegs(&j, n);
        CHECK_OK(ptm_read(&f,
                          save_jpegs(&j, n == 9 ? "PTM_FORMAT_JPEG_LRGB" : "PTM_FORMAT_JPEG_RGB"),
                          NULL, NULL));
        assert_int_equal(f.planes, n);
        for (int p = 0; p < n; p++) {
            const int file_plane =
                n == 9 ? (p < 6 ? place_of_term[p] : p) : p % 3 * 6 + place_of_term[p / 3];
            for (int i = 0; i < PIXELS; i++) {
                uint8_t want = j.decoded[file_plane][i];
                const uint8_t second =
                    i == 10 ? 201 : (uint8_t)(j.decoded[1][i] - 128 + j.decoded[4][i]);
                if (file_plane == 1)
                    want = second;
                if (file_plane == 0)
                    want = (uint8_t)(want - 128 + (255 - second));
                const int row = H - 1 - i / W;
                assert_int_equal(f.codes[p * PIXELS + row * W + i % W], want);
            }
        }
        foreign_free(&f);
        free_jpegs(&j);
    }
}

static void bad_jpeg_tables_are_errors(void **state)
{
    (void)state;
    static const struct {
        int field, plane;
        long value;
        const char *says;
    } cases[] = {
        {0, 2, 3, "transforms of the planes"},  {1, 1, 3, "predicted by motion"},
        {0, 2, -1, "transforms of the planes"}, {2, 1, -2, "predicted by motion"},
        {3, 0, 0, "order of the planes"},       {3, 0, 99, "order of the planes"},
        {4, 3, 9, "reference planes"},          {4, 4, 0, "decoded before"},
        {5, 0, 0, "sizes of the planes"},       {5, 8, 1000000, "truncated in plane 9"},
        {6, 2, 3, "side information in fives"}, {5, 0, 2, "j.ptm: plane 1: not a whole JPEG"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct jpegs j;
        struct foreign f;
        struct test_log log;
        make_jpegs(&j, 9);
        j.field[cases[i].field][cases[i].plane] = cases[i].value;
        if (cases[i].value == 1000000)
            j.bytes[8] = realloc(j.bytes[8], 1000000);
        const char *path = save_jpegs(&j, "PTM_FORMAT_JPEG_LRGB");
        if (cases[i].value == 1000000) {
            assert_int_equal(truncate(path, 4000), 0);
        }
        test_log_init(&log);
        assert_true(relume_status_is_input(ptm_read(&f, path, NULL, &log.log)));
        if (!strstr(log.text, cases[i].says))
            print_error("case %zu: %s\n", i, log.text);
        assert_non_null(strstr(log.text, cases[i].says));
        assert_int_equal(log.lines, 1);
        free_jpegs(&j);
    }
}

// ---------------------------------------------------------------- .rti

static void put_float(FILE *f, float v)
{
    fwrite(&v, 1, 4, f);
}

static void rti_is_read(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        const char *end = kind == 1 ? "\r\n" : "\n";
        const bool old = kind == 2;
        struct text t;
        struct foreign f;
        begin(&t);
        fprintf(t.file, "#HSH1.2%s# made by hand%s3%s%d %d 3%s4 2 1%s", end, end, end, W, H, end,
                end);
        for (int k = 0; k < 4; k++)
            put_float(t.file, old ? -1.0f - (float)k : 2.0f + (float)k);
        for (int k = 0; k < 4; k++)
            put_float(t.file, old ? 1.0f : -1.0f - (float)k);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                for (int c = 0; c < 3; c++)
                    for (int k = 0; k < 4; k++)
                        fputc(code(k, c, x, y), t.file);
        CHECK_OK(rti_read(&f, save(&t, "a.rti"), old, NULL, NULL));
        uint32_t seed = 2;
        for (int i = 0; i < 10; i++) {
            struct relume_vec3 l = test_direction(&seed);
            l.z = 0.1 + 0.9 * fabs(l.z);
            const double n = sqrt(l.x * l.x + l.y * l.y + l.z * l.z);
            l = (struct relume_vec3){l.x / n, l.y / n, l.z / n};
            const double q = sqrt(l.z - l.z * l.z), r = hypot(l.x, l.y);
            const double h[4] = {1.0 / sqrt(2.0 * M_PI), sqrt(6.0 / M_PI) * q * l.x / r,
                                 sqrt(1.5 / M_PI) * (2.0 * l.z - 1.0),
                                 sqrt(6.0 / M_PI) * q * l.y / r};
            double w[12], constant[3], rgb[3];
            foreign_weights(&f, l, w, constant);
            foreign_pixel(&f, 2 * W + 3, w, constant, rgb);
            for (int c = 0; c < 3; c++) {
                double want = 0.0;  // (scale, min) and (min, max) say the same here
                for (int k = 0; k < 4; k++)
                    want += (code(k, c, 3, 2) / 255.0 * (2.0 + k) - 1.0 - k) * h[k];
                CHECK_NEAR(rgb[c], want, 1e-5);
            }
        }
        if (!old) {
            char path[128];
            struct foreign back;
            snprintf(path, sizeof path, "%s/b.rti", folder);
            CHECK_OK(rti_write(&f, path, NULL, NULL));
            CHECK_OK(rti_read(&back, path, false, NULL, NULL));
            assert_memory_equal(back.codes, f.codes, 12 * PIXELS);
            assert_memory_equal(back.offset, f.offset, 12 * sizeof *f.offset);
            for (int p = 0; p < 12; p++)
                CHECK_NEAR((double)back.scale[p], (double)f.scale[p], 1e-9);
            foreign_free(&back);
        }
        foreign_free(&f);
    }
}

static void quantisers_hold_their_range(void **state)
{
    (void)state;
    static const double ranges[][2] = {{-3.0, 5.0}, {2.0, 200.0}, {-9.0, -1.0}, {0.0, 0.0}};
    for (size_t i = 0; i < 4; i++) {
        const struct ptm_quantiser q = ptm_quantiser(ranges[i][0], ranges[i][1]);
        assert_in_range(q.bias, 0, 255);
        assert_true((0 - q.bias) * q.scale <= fmin(ranges[i][0], 0.0) + 1e-9);
        assert_true((255 - q.bias) * q.scale >= fmax(ranges[i][1], 0.0) - 1e-9);
    }
}

// The functions of .rti files are orthonormal over the hemisphere, and the first of each degree
// stand where the format has them.
static void sixteen_harmonics(void **state)
{
    (void)state;
    enum { N = 16, RINGS = 400, STEPS = 32 };
    const struct functions f = {.kind = FUNCTIONS_HSH, .count = N};
    double gram[N][N] = {{0}}, v[N];
    for (int i = 0; i < RINGS; i++)
        for (int s = 0; s < STEPS; s++) {
            const double z = (i + 0.5) / RINGS, r = sqrt(1.0 - z * z);
            const double phi = 2.0 * M_PI * (s + 0.5) / STEPS;
            functions_at(&f, (struct relume_vec3){r * cos(phi), r * sin(phi), z}, v);
            for (int a = 0; a < N; a++)
                for (int b = 0; b < N; b++)
                    gram[a][b] += v[a] * v[b] * 2.0 * M_PI / (RINGS * STEPS);
        }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++)
            CHECK_NEAR(gram[a][b], a == b, 0.03);  // the functions stop at sin 0.01
    // Gautron et al. 2004 at c = 1/4, phi = 10 degrees: q^2 = 3/16
    functions_at(&f,
                 (struct relume_vec3){sqrt(15.0) / 4.0 * cos(M_PI / 18.0),
                                      sqrt(15.0) / 4.0 * sin(M_PI / 18.0), 0.25},
                 v);
    CHECK_NEAR(v[9], 2.0 * sqrt(35.0 / M_PI) * pow(3.0 / 16.0, 1.5) * cos(M_PI / 6.0), 1e-12);
    CHECK_NEAR(v[10], sqrt(210.0 / M_PI) * 3.0 / 32.0 * cos(M_PI / 9.0), 1e-12);
    CHECK_NEAR(v[12], sqrt(3.5 / M_PI) * 0.4375, 1e-12);
    CHECK_NEAR(v[15], 2.0 * sqrt(35.0 / M_PI) * pow(3.0 / 16.0, 1.5) * 0.5, 1e-12);
}

// Nodes are where they say: the functions at a node are 1 there and 0 elsewhere.
static void grid_nodes_are_nodes(void **state)
{
    (void)state;
    const struct functions f = {.kind = FUNCTIONS_GRID, .count = 49, .resolution = 7};
    for (int i = 0; i < 49; i++) {
        double v[49];
        functions_at(&f, functions_grid_node(7, i), v);
        for (int j = 0; j < 49; j++)
            CHECK_NEAR(v[j], i == j, 1e-12);
    }
}

// ---- what is to be seen of an export's JPEGs: by the pixels of the decoded file

enum { SIDE = 64, SEEN = SIDE * SIDE, SEEN_BLOCKS = SEEN / 64 };

// Blocks at the left are smooth shades, further right ever rougher.
static void shade(float *plane, int p)
{
    uint32_t noise = 12345u + (uint32_t)p;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            noise = noise * 1664525u + 1013904223u;
            const float rough = ((float)(noise >> 8) / 16777216.0f - 0.5f) * (float)(x / 8) / 40.0f;
            plane[y * SIDE + x] = 0.3f * sinf(0.07f * (float)(x + p * y)) + rough;
        }
}

static int rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double seen_by_pixels(const struct web_folder *w)
{
    struct jpeg_codes codes;
    double seen[SEEN_BLOCKS];
    CHECK_OK(jpeg_decode(&codes, w->sheet[0].bytes, w->sheet[0].size, "sheet", NULL, NULL));
    for (int b = 0; b < SEEN_BLOCKS; b++) {
        double error = 0.0, texture = 0.0;
        for (int p = 0; p < 3; p++) {
            double sum = 0.0, squares = 0.0;
            for (int i = 0; i < 64; i++) {
                const int at = (b / 8 * 8 + i / 8) * SIDE + b % 8 * 8 + i % 8;
                const double v = (double)planes_at(w->planes, p)[at];
                const double code = codes.data[p * SEEN + at];
                const double d = (code / 255.0 - w->sheet[0].bias[p]) * w->sheet[0].scale[p] - v;
                error += d * d;
                sum += v;
                squares += v * v;
            }
            texture += squares - sum * sum / 64.0;
        }
        seen[b] = 255.0 * sqrt(error / 192.0) / fmax(1.0, pow(255.0 * sqrt(texture / 192.0), 0.7));
    }
    jpeg_codes_free(&codes);
    qsort(seen, SEEN_BLOCKS, sizeof *seen, rising);
    return seen[(int)(0.95 * (SEEN_BLOCKS - 1))];
}

static void what_is_seen_of_jpeg(void **state)
{
    (void)state;
    static float data[3 * SEEN];
    double least[3] = {-0.5, -0.5, -0.5}, most[3] = {0.5, 0.5, 0.5}, one[3] = {1, 1, 1};
    double none[3] = {0};
    struct planes planes = {
        .width = SIDE, .height = SIDE, .count = 3, .data = data, .minimum = least, .maximum = most};
    const struct plan plan = {
        .form = FOREIGN_JOINT, .terms = 3, .planes = 3, .weight = one, .energy = none};
    double before = 0.0;
    for (int p = 0; p < 3; p++)
        shade(data + p * SEEN, p);
    for (int quality = 90; quality >= 60; quality -= 10) {
        struct web_folder w = {.plan = &plan, .planes = &planes, .blocks = true};
        double levels;
        CHECK_OK(web_encode(&w, 0.045 * exp2((80 - quality) / 10.0), true, 1));
        CHECK_OK(web_visible_error(&w, &levels));
        // the decoder rounds to whole codes: 0.29 levels RMS beside errors of 1.3 and more, 3 %
        CHECK_NEAR(levels, seen_by_pixels(&w), 0.05 * levels);
        assert_true(levels > before);
        before = levels;
        web_folder_free(&w);
    }
    memset(data, 0, sizeof data);
    struct web_folder w = {.plan = &plan, .planes = &planes, .blocks = true};
    double levels = 1.0;
    CHECK_OK(web_encode(&w, 0.045, true, 1));
    CHECK_OK(web_visible_error(&w, &levels));
    assert_true(levels == 0.0);
    web_folder_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raw_rgb_is_read),
        cmocka_unit_test(raw_lrgb_is_read),
        cmocka_unit_test(raw_files_come_back_byte_for_byte),
        cmocka_unit_test(jpeg_planes_are_read),
        cmocka_unit_test(bad_jpeg_tables_are_errors),
        cmocka_unit_test(rti_is_read),
        cmocka_unit_test(quantisers_hold_their_range),
        cmocka_unit_test(grid_nodes_are_nodes),
        cmocka_unit_test(sixteen_harmonics),
        cmocka_unit_test(what_is_seen_of_jpeg),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
