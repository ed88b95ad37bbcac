// test_near.c - the weight grid against the coder itself; every near kind and environments on codes
// of every form against the slow reference, pixel by pixel
#include "flat_coder.h"
#include "learned_fixture.h"
#include "relight_fixture.h"

#include "core/base/memory.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/light/refit.h"
#include "relight/view/view.h"

// ---------------------------------------------------------------- the grid

// Smooth functions, and those that have their creases where the grid has nodes, agree to 1e-3,
// what is linear over triangles of the lights but for rounding. Cells of dct-resampled have creases
// inside grid cells: as wide as the cell, 1/10 of the spacing of 64 lights.
static double bound_of(const struct relume_basis *b)
{
    return b == &relume_basis_table ? 1e-5 : b == &relume_basis_dct_resampled ? 2e-2 : 1e-3;
}

static double grid_error(const struct learned *l, const relume_weight_grid *grid, uint32_t *seed)
{
    static const float one[3] = {1, 1, 1};
    float exact[LEARNED_PLANES], weights[LEARNED_PLANES] = {0}, constant[3], base[3] = {0};
    const struct relume_vec3 d = test_direction(seed);
    relume_coder_weights(l->coder, d, exact, constant);
    relume_weight_grid_add(weights, base, grid, d, one);
    double worst = 0;
    for (int x = 0; x < LEARNED_PIXELS; x += 11)
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(learned_show(l, x, c, exact, constant) -
                                     learned_show(l, x, c, weights, base)));
    return worst;
}

static void test_grid(void **state)
{
    (void)state;
    if (TEST_SANITIZED)
        skip();
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        // sphere, dome about z, about y: where the pole is does not matter to what was learned
        for (int half = (*b)->upper_only; half <= ((*b)->learned ? 1 : 2); half++) {
            static struct learned l;
            relume_weight_grid *grid;
            uint32_t seed = 3;
            double worst = 0, square = 0;
            learned_create(&l, *b, half > 0, half == 2, 0);
            CHECK_OK(relume_weight_grid_create(&grid, l.coder, NULL));
            for (int i = 0; i < 300; i++) {  // below the horizon of a dome as well
                const double error = grid_error(&l, grid, &seed);
                worst = fmax(worst, error);
                square += error * error / 300;
            }
            if (worst > bound_of(*b) || sqrt(square) > 5e-3)
                fail_msg("%s %d: off by %g, rms %g", (*b)->name, half, worst, sqrt(square));
            relume_weight_grid_destroy(&grid);
            learned_destroy(&l);
        }
}

// `delaunay` of any values in [0, 1] is reproduced: weights differ by rounding.
// Even lights all around, on a dome, on common circles, on a cap with a gap beyond, and few.
static void test_triangles(void **state)
{
    (void)state;
    static const struct {
        const char *pattern;
        int n;
        bool hemisphere;
        double lowest;
    } sets[] = {{"hammersley", 250, false, -1},
                {"hammersley", 100, true, 0},
                {"grid", 36, true, 0},
                {"hammersley", 64, false, 0.2},
                {"hammersley", 5, false, -1}};
    for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) {
        struct relume_vec3 lights[250];
        relume_coder *coder;
        relume_weight_grid *grid;
        uint32_t seed = 8;
        int n = 0;
        CHECK_OK(
            relume_directions_make(lights, sets[s].n, relume_pattern_find(sets[s].pattern),
                                   relume_directions_params(.hemisphere = sets[s].hemisphere)));
        for (int i = 0; i < sets[s].n; i++)
            if (lights[i].z >= sets[s].lowest)
                lights[n++] = lights[i];
        CHECK_OK(relume_coder_create(&coder, &relume_basis_table, lights, n,
                                     relume_coder_params(.hemispherical = sets[s].hemisphere,
                                                         .pole_y = s % 2, .decode = true)));
        CHECK_OK(relume_weight_grid_create(&grid, coder, NULL));
        const struct relume_weight_grid_info *info = relume_weight_grid_info(grid);
        assert_true(info->triangles > 0 && info->rows == 1 && info->columns == n);
        for (int i = 0; i < 2000; i++) {
            static const float one[3] = {1, 1, 1};
            float exact[3 * 250], weights[3 * 250] = {0}, constant[3], none[3] = {0};
            const struct relume_vec3 d =
                i < n ? relume_coder_info(coder)->directions[i] : test_direction(&seed);
            relume_coder_weights(coder, d, exact, constant);
            relume_weight_grid_add(weights, none, grid, d, one);
            double off = 0;
            for (int k = 0; k < n; k++)
                off += fabs((double)exact[k] - (double)weights[k]);
            CHECK_NEAR(off, 0, 2e-4);  // slivers between lights on a common circle
        }
        relume_weight_grid_destroy(&grid);
        relume_coder_destroy(&coder);
    }
    // three lights have no triangles, so a grid is made when it is wanted
    const struct relume_vec3 three[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    relume_coder *coder;
    relume_weight_grid *grid;
    CHECK_OK(relume_coder_create(&coder, &relume_basis_table, three, 3,
                                 relume_coder_params(.decode = true)));
    CHECK_OK(relume_weight_grid_create(&grid, coder, relume_weight_grid_params(.steps = 8)));
    assert_true(relume_weight_grid_info(grid)->triangles == 0);
    relume_weight_grid_destroy(&grid);
    relume_coder_destroy(&coder);
}

// The cusps of interpolants, where a plain grid is off by up to 0.1. Cells are judged in five
// places, in between they may be off by a few times as much.
static void test_cusps(void **state)
{
    (void)state;
    static const char *const names[] = {"chord", "angular"};
    for (int set = 0; set < 4; set++) {
        enum { N = 40, LOOKS = 1000 };
        struct relume_vec3 lights[N];
        relume_coder *coder;
        relume_weight_grid *grid;
        uint32_t seed = 5;
        double worst = 0, square = 0;
        const bool half = set / 2;
        CHECK_OK(relume_directions_make(lights, N, relume_pattern_find("hammersley"),
                                        relume_directions_params(.hemisphere = half)));
        CHECK_OK(relume_coder_create(
            &coder, &relume_basis_table, lights, N,
            relume_coder_params(.interpolant = relume_interpolant_find(names[set % 2]),
                                .hemispherical = half, .decode = true)));
        CHECK_OK(relume_weight_grid_create(&grid, coder, NULL));
        assert_true(relume_weight_grid_info(grid)->tiles > 0);
        for (int i = 0; i < LOOKS; i++) {
            static const float one[3] = {1, 1, 1};
            float exact[3 * N], weights[3 * N] = {0}, constant[3], none[3] = {0};
            const struct relume_vec3 l = lights[i % N], d = test_direction(&seed);
            const vec3 near = vec3_unit(vec3_add(l, vec3_scale(d, 0.02)));
            relume_coder_weights(coder, near, exact, constant);
            relume_weight_grid_add(weights, none, grid, near, one);
            double above = 0, below = 0;
            for (int k = 0; k < N; k++) {
                above += fmax((double)weights[k] - (double)exact[k], 0);
                below += fmax((double)exact[k] - (double)weights[k], 0);
            }
            worst = fmax(worst, fmax(above, below));
            square += fmax(above, below) * fmax(above, below) / LOOKS;
        }
        if (worst > 5.0 / 255 || sqrt(square) > 1.0 / 255)
            fail_msg("%s %d: off by %g, rms %g", names[set % 2], half, worst, sqrt(square));
        relume_weight_grid_destroy(&grid);
        relume_coder_destroy(&coder);
    }
}

// What the header says of the layout, so that others can read the grid: nodes hold the weights.
static void test_grid_layout(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        static struct learned l;
        relume_weight_grid *grid;
        uint32_t seed = 4;
        learned_create(&l, &relume_basis_pca, half, true, 5);
        CHECK_OK(relume_weight_grid_create(&grid, l.coder, relume_weight_grid_params(.steps = 8)));
        const struct relume_weight_grid_info *info = relume_weight_grid_info(grid);
        assert_true(info->sets == 3 && info->coefficients == 5 && info->stride == 18);
        assert_int_equal(info->columns, 33);
        for (int i = 0; i < 100; i++) {
            const struct relume_vec3 d = test_direction(&seed);
            const int m = (half ? info->rows : info->rows / 2) - 1;
            double xy[2];
            relume_weight_grid_place(xy, grid, d);
            const double phi = atan2(d.x, -d.z) * 180 / M_PI;  // pole +y
            const double theta = half && d.y < 0 ? 90 : acos(fabs(d.y)) * 180 / M_PI;
            const double y = m * (1 - sqrt(1 - theta / 90));
            CHECK_NEAR(xy[0], (phi + 180) * 32 / 360, 1e-9);
            CHECK_NEAR(xy[1], d.y < 0 && !half ? info->rows - 1 - y : y, 1e-9);
        }
        for (int row = 0; row < info->rows; row += 3) {  // the column of phi = 90: towards +x
            const int m = (half ? info->rows : info->rows / 2) - 1;
            const int step = row > m ? info->rows - 1 - row : row;
            const double t = (double)step / m, theta = M_PI / 2 * (2 * t - t * t);
            const struct relume_vec3 d = {sin(theta), row > m ? -cos(theta) : cos(theta), 0};
            float weights[LEARNED_PLANES], constant[3];
            relume_coder_weights(l.coder, d, weights, constant);
            const float *node = info->data + (row * info->columns + 24) * info->stride;
            for (int i = 0; i < 15; i++)
                CHECK_NEAR(node[i], weights[i], 1e-5);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(node[15 + c], constant[c], 1e-5);
        }
        relume_weight_grid_destroy(&grid);
        learned_destroy(&l);
    }
    relume_weight_grid *none;
    assert_int_equal(
        relume_weight_grid_create(&none, NULL, relume_weight_grid_params(.steps = 5000)),
        RELUME_EINVAL);
    assert_null(none);
}

// ---------------------------------------------------------------- near lights

enum { PIXELS = SIDE * SIDE };

// The codes with the same coefficients as bytes, words, halves, or vectors of a codebook.
struct stored {
    uint8_t byte[PLANES][PIXELS];
    uint16_t word[PLANES][PIXELS];
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
    float vector[2][PIXELS * PLANES];
    uint16_t index[2][PIXELS];
    const float *vectors[2];
    const uint16_t *indices[2];
    int counts[2];
};

static uint16_t half_of(float f)  // of normal numbers
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    const uint32_t magnitude = (u & 0x7fffffffu) + 0x1000u;
    return (uint16_t)((u >> 16 & 0x8000u) | ((magnitude - (112u << 23)) >> 13));
}

static void as_planes(struct stored *to, struct setup *s, enum relume_storage storage)
{
    const int top = relume_storage_top(storage);
    for (int p = 0; p < s->codes.planes; p++) {
        to->plane[p] = storage == RELUME_STORE_8 ? (void *)to->byte[p] : (void *)to->word[p];
        to->scale[p] = top ? s->scale[p] * 65535.0f / (float)top : 1.0f;
        to->offset[p] = top ? s->offset[p] : 0.0f;
        for (int i = 0; i < PIXELS; i++) {
            const int code = (int)((int64_t)s->words[p][i] * top / 65535);
            to->byte[p][i] = (uint8_t)code;
            to->word[p][i] = top ? (uint16_t)code : half_of((float)coefficient(s, i, p) + 0.001f);
        }
    }
    s->codes.storage = storage;
    s->codes.plane = to->plane;
    s->codes.scale = to->scale;
    s->codes.offset = to->offset;
}

static void as_books(struct stored *to, struct setup *s, int books)
{
    const int planes = s->codes.planes;
    for (int b = 0; b < books; b++) {
        for (int i = 0; i < PIXELS; i++) {
            to->index[b][i] = (uint16_t)((i * 37 + b * 5) % PIXELS);
            for (int p = 0; p < planes; p++)
                to->vector[b][to->index[b][i] * planes + p] =
                    (float)coefficient(s, i, p) / (float)books;
        }
        to->vectors[b] = to->vector[b];
        to->indices[b] = to->index[b];
        to->counts[b] = PIXELS;
    }
    s->codes.storage = 0;
    s->codes.plane = NULL;
    s->codes.books = books;
    s->codes.vectors = to->vectors;
    s->codes.index = to->indices;
    s->codes.book_codes = to->counts;
}

static const char table[] = "TILT=NONE\n1 1 1 3 2 1 2 0 0 0 1 1 1\n0 40 90\n0 90\n5 9 1 5 3 0\n";
static float picture_texels[3 * 3 * 2] = {1, 0, 0, 0, 1, 0, .2f, .3f, .4f,
                                          1, 1, 1, 0, 0, 1, 2,   1,   0};
static const struct relume_image picture = {3, 2, 3, .data = picture_texels};

// What a light gives a pixel by the double-precision reference; areas in `cut` x `cut` midpoints.
static void reference(double rgb[3], const struct setup *s, int pixel,
                      const struct relume_light *light, struct relume_vec3 p)
{
    enum { CUT = 60 };
    struct relume_light lamp = {.rgb = {0}};
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (light->kind != RELUME_LIGHT_AREA) {
        if (relume_light_at(&lamp.direction, lamp.rgb, light, p))
            relume_relight_pixel(rgb, &s->codes, pixel % SIDE, pixel / SIDE, &lamp, 1);
        return;
    }
    for (int i = 0; i < CUT * CUT; i++) {
        const double a = (i % CUT + 0.5) / CUT * 2 - 1,
                     b = (int)(i / CUT) * 2.0 / CUT + 1.0 / CUT - 1;
        const struct relume_light *l = light;
        const struct relume_vec3 d = {l->position.x + a * l->u.x + b * l->v.x - p.x,
                                      l->position.y + a * l->u.y + b * l->v.y - p.y,
                                      l->position.z + a * l->u.z + b * l->v.z - p.z};
        const struct relume_vec3 n = {l->u.y * l->v.z - l->u.z * l->v.y,
                                      l->u.z * l->v.x - l->u.x * l->v.z,
                                      l->u.x * l->v.y - l->u.y * l->v.x};
        const double square = vec3_dot(d, d), cosine = -vec3_dot(d, n) / sqrt(square);
        double one[3];
        lamp.direction = d;
        for (int c = 0; c < 3; c++)
            lamp.rgb[c] =
                (float)((double)l->rgb[c] * fmax(cosine, 0) / square * 4 / (CUT * CUT * M_PI));
        if (l->disc && a * a + b * b > 1)
            continue;
        relume_relight_pixel(one, &s->codes, pixel % SIDE, pixel / SIDE, &lamp, 1);
        for (int c = 0; c < 3; c++)
            rgb[c] += one[c];
    }
}

static struct relume_image plane_surface(void)
{
    const struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, SIDE, SIDE);
    struct relume_image surface;
    CHECK_OK(relume_view_positions(&surface, &g, NULL, NULL, SIDE, SIDE));
    surface.data[3 * 5 + 1] = INFINITY;  // one background pixel
    return surface;
}

// One grid serves all lights on a coder.
static void check_light(const struct setup *s, const relume_weight_grid *grid,
                        const struct relume_light *light, double tolerance)
{
    struct relume_image surface = plane_surface(), out = {0};
    CHECK_OK(relume_relight(&out, &s->codes, light, 1,
                            relume_relight_params(.surface = &surface, .grid = grid)));
    double biggest = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *at = surface.data + 3 * i;
        const struct relume_vec3 p = {(double)at[0], (double)at[1], (double)at[2]};
        double want[3] = {0};
        if (i != 5)
            reference(want, s, i, light, p);
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(out.data[3 * i + c], want[c], tolerance);
            biggest = fmax(biggest, fabs(want[c]));
        }
    }
    assert_true(biggest > 6 * tolerance);  // there was something to see
    relume_image_destroy(&surface);
    relume_image_destroy(&out);
}

static struct relume_light lights_of(int kind, const relume_ies *ies)
{
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_POINT, .position = {0.4, -0.2, 0.9}, .rgb = {1, .5f, .3f}},
        {.kind = RELUME_LIGHT_SPOT,
         .position = {0.4, -0.2, 1.5},
         .direction = {-0.3, 0.1, -1},
         .half_angle_deg = 30,
         .rgb = {1, 1, 2}},
        {.kind = RELUME_LIGHT_SLIDE,
         .position = {0, 0.1, 1.2},
         .direction = {0, 0, -1},
         .half_angle_deg = 35,
         .image = &picture,
         .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_AREA,
         .position = {0.2, 0.3, 1.1},
         .u = {0, .8, 0},
         .v = {.5, 0, .2},
         .rgb = {2, 1, 1}},
        {.kind = RELUME_LIGHT_IES,
         .position = {0.1, 0, 1},
         .direction = {0.2, 0, -1},
         .nofall = true,
         .ies = ies,
         .rgb = {1, 1, 1}},
    };
    return lights[kind];
}

// The grid is off by up to 1e-3 for light of value 1, lights here give up to 2; patches promise one
// percent of at most 1, for components, whose triangles have creases under the light, of at most 4;
// in the display domain what is dark is steeper by up to 2.3. Luminances are multiplied by colours
// of at most 0.1.
static double tolerance_of(const struct relume_light *light, const struct setup *s)
{
    const double area = light->kind != RELUME_LIGHT_AREA ? 0 : s->form == COMPONENTS ? 4e-2 : 1e-2;
    const double steep = s->codes.domain == RELUME_DOMAIN_DISPLAY ? 2.3 : 1;
    return (2 * GRID * steep + area) * (s->form == LUMINANCE ? 0.1 : 1);
}

static void test_kinds(void **state)
{
    (void)state;
    relume_ies *ies;
    CHECK_OK(relume_ies_parse(&ies, table, sizeof table - 1, "table", NULL));
    for (int form = 0; form < FORMS; form++)
        for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++) {
            struct setup s;
            relume_weight_grid *grid;
            make(&s, (enum form)form, (enum relume_domain)domain);
            CHECK_OK(relume_weight_grid_create(&grid, s.coder, NULL));
            for (int kind = 0; kind < 5; kind++) {
                const struct relume_light light = lights_of(kind, ies);
                check_light(&s, grid, &light, tolerance_of(&light, &s));
            }
            relume_weight_grid_destroy(&grid);
            relume_coder_destroy(&s.coder);
        }
    relume_ies_destroy(&ies);
}

static void test_storages(void **state)
{
    (void)state;
    static const enum relume_storage storages[] = {RELUME_STORE_8, RELUME_STORE_10, RELUME_STORE_12,
                                                   RELUME_STORE_16, RELUME_STORE_HALF};
    const struct relume_light light = lights_of(1, NULL);
    for (int form = 0; form < FORMS; form++)
        for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++) {
            static struct stored to;
            struct setup s;
            relume_weight_grid *grid;
            make(&s, (enum form)form, (enum relume_domain)domain);
            CHECK_OK(relume_weight_grid_create(&grid, s.coder, NULL));
            for (int i = 0; i < 5; i++) {
                as_planes(&to, &s, storages[i]);
                check_light(&s, grid, &light, tolerance_of(&light, &s));
            }
            for (int books = 1; books <= (form == LUMINANCE ? 1 : 2); books++) {
                as_books(&to, &s, books);
                check_light(&s, grid, &light, tolerance_of(&light, &s));
            }
            relume_weight_grid_destroy(&grid);
            relume_coder_destroy(&s.coder);
        }
}

// Many lights are the sum of each, far and near; the picture for the screen says the same.
static void test_together(void **state)
{
    (void)state;
    enum { N = 12 };
    for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++) {
        struct setup s;
        struct relume_light lights[N];
        struct relume_image surface = plane_surface(), all = {0}, one = {0};
        float sum[3 * PIXELS] = {0};
        uint8_t screen[4 * PIXELS];
        make(&s, SEPARATE, (enum relume_domain)domain);
        for (int i = 0; i < N; i++) {
            lights[i] = lights_of(i % 4, NULL);
            if (i % 3 == 0)
                lights[i] = (struct relume_light){.direction = {i, 1, 3}};
            lights[i].position.x -= 0.1 * i;
            for (int c = 0; c < 3; c++)
                lights[i].rgb[c] = 0.02f * (float)(i + c);
            CHECK_OK(relume_relight(&one, &s.codes, &lights[i], 1,
                                    relume_relight_params(.surface = &surface)));
            for (int k = 0; k < 3 * PIXELS; k++)
                sum[k] += one.data[k];
        }
        const struct relume_relight_params *p = relume_relight_params(.surface = &surface);
        CHECK_OK(relume_relight(&all, &s.codes, lights, N, p));
        CHECK_OK(relume_relight_rgba8(screen, &s.codes, lights, N, p));
        for (int k = 0; k < 3 * PIXELS; k++) {
            CHECK_NEAR(all.data[k], sum[k], 2e-5);  // single-precision sums of 12
            const float shown = relume_transfer_encode(s.codes.display, all.data[k]);
            CHECK_NEAR(screen[k / 3 * 4 + k % 3], 255 * fmin(fmax((double)shown, 0), 1), 0.51);
        }
        relume_image_destroy(&surface);
        relume_image_destroy(&all);
        relume_image_destroy(&one);
        relume_coder_destroy(&s.coder);
    }
}

// Light in the surface, at a pixel, far away, and 10,000 of them: never anything but finite.
static void test_odd_places(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    static struct relume_light lights[MANY];
    uint32_t seed = 2;
    struct setup s;
    struct relume_image surface = plane_surface(), out = {0};
    make(&s, SEPARATE, RELUME_DOMAIN_LINEAR);
    const float *p = surface.data + 3 * 9;
    for (int i = 0; i < MANY; i++)
        lights[i] = (struct relume_light){
            .kind = RELUME_LIGHT_POINT,
            .position = {2 * test_uniform(&seed) - 1, 2 * test_uniform(&seed) - 1, 0},
            .rgb = {1, 1, 1}};
    lights[0].position = (struct relume_vec3){(double)p[0], (double)p[1], (double)p[2]};
    lights[1].position = (struct relume_vec3){1e200, 0, 0};
    lights[2].position = (struct relume_vec3){(double)p[0] + 1e-5, (double)p[1], (double)p[2]};
    lights[2].rgb[0] = 1e9f;
    lights[3] = (struct relume_light){.kind = RELUME_LIGHT_AREA,  // in the surface itself
                                      .u = {1, 0, 0},
                                      .v = {0, 1, 0},
                                      .rgb = {1, 1, 1}};
    CHECK_OK(
        relume_relight(&out, &s.codes, lights, MANY, relume_relight_params(.surface = &surface)));
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(isfinite(out.data[i]));
    CHECK_OK(relume_relight(&out, &s.codes, lights, 1, relume_relight_params(.surface = &surface)));
    assert_true(out.data[27] == 0.0f && out.data[28] == 0.0f && out.data[29] == 0.0f);
    assert_true(out.data[30] != 0.0f);
    relume_image_destroy(&surface);
    relume_image_destroy(&out);
    relume_coder_destroy(&s.coder);
}

// ---------------------------------------------------------------- environments on codes

static relume_environment *sky(void)
{
    relume_environment *e;
    struct relume_image map;
    CHECK_OK(relume_image_create(&map, 32, 16, 3));
    for (int i = 0; i < 32 * 16; i++)
        for (int c = 0; c < 3; c++)
            map.data[3 * i + c] = (float)(i / 32 < 8 ? 1.0 + 0.1 * c : 0.2 + 0.02 * (i % 32));
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_image_destroy(&map);
    return e;
}

// What sums over environments show of a colour below 0: as much luminance, less colour, or black.
static void above_zero(double rgb[3])
{
    const double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
    const double grey = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    for (int c = 0; c < 3 && least < 0.0; c++)
        rgb[c] = grey > 0.0 ? grey + grey / (grey - least) * (rgb[c] - grey) : 0.0;
}

// Cell by cell as directional lights.
static void check_sky(const struct setup *s, const struct relume_light *light, double tolerance)
{
    int n;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, light->environment);
    struct relume_light *lamps = calloc((size_t)n, sizeof *lamps);
    struct relume_image out = {0};
    relume_coder *flat = flat_coder(s->codes.coder);
    struct relume_codes codes = s->codes;
    codes.coder = flat ? flat : codes.coder;
    for (int i = 0; i < n; i++) {
        lamps[i].direction = relume_environment_turn(cell[i].direction, light->rotate_deg);
        for (int c = 0; c < 3; c++)
            lamps[i].rgb[c] = cell[i].rgb[c] * light->rgb[c];
    }
    CHECK_OK(relume_relight(&out, &s->codes, light, 1, NULL));
    for (int i = 0; i < PIXELS; i += 9) {
        double want[3];
        relume_relight_pixel(want, &codes, i % SIDE, i / SIDE, lamps, n);
        above_zero(want);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(out.data[3 * i + c], want[c], tolerance);
    }
    relume_image_destroy(&out);
    relume_coder_destroy(&flat);
    free(lamps);
}

static relume_environment *sun(void)
{
    struct relume_image map;
    relume_environment *e;
    CHECK_OK(relume_image_create(&map, 64, 32, 3));
    for (int i = 0; i < 64 * 32 * 3; i++)
        map.data[i] = i / 3 == 10 * 64 + 50 ? 1e4f : 0.1f;
    CHECK_OK(relume_environment_create(&e, &map, NULL));
    relume_image_destroy(&map);
    return e;
}

// A sun over black pixels with a bright edge: the interpolants that extrapolate have weights below
// 0 there. Nothing of a sum may be; the total stays.
static void test_suns(void **state)
{
    (void)state;
    relume_environment *e = sun();
    for (int k = 0; k < 4; k++) {
        static struct learned l;
        const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                           .environment = e,
                                           .rotate_deg = 31.0 * k,
                                           .rgb = {1.0f, 1.0f, 1.0f}};
        float weights[LEARNED_PLANES] = {0.0f}, constant[3] = {0.0f};
        relume_weight_grid *grid;
        learned_create(&l, &relume_basis_table, true, false, 0);
        relume_coder *coder;
        const struct relume_coder_info *info = relume_coder_info(l.coder);
        CHECK_OK(relume_coder_create(
            &coder, &relume_basis_table, info->directions, info->lights,
            relume_coder_params(.hemispherical = true,
                                .interpolant = relume_interpolant_find("chord"))));
        CHECK_OK(relume_weight_grid_create(&grid, coder, relume_weight_grid_params(.sums = true)));
        relume_environment_weights(weights, constant, grid, &light);
        for (int i = 0; i < 3 * info->lights; i++)
            assert_true(weights[i] >= 0.0f);
        relume_weight_grid_destroy(&grid);
        relume_coder_destroy(&coder);
        learned_destroy(&l);
    }
    relume_environment_destroy(&e);
}

static void test_environments(void **state)
{
    (void)state;
    relume_environment *e = sky();
    const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = e,
                                       .rotate_deg = 20,
                                       .rgb = {0.5f, 0.4f, 0.3f}};
    for (int form = 0; form < FORMS; form++)
        for (int books = 0; books <= (form == LUMINANCE ? 1 : 2); books++) {
            static struct stored to;
            struct setup s;
            make(&s, (enum form)form, RELUME_DOMAIN_LINEAR);
            if (books)
                as_books(&to, &s, books);
            check_sky(&s, &light, 3 * GRID * (form == LUMINANCE ? 0.1 : 1));  // sums reach 1.5
            relume_coder_destroy(&s.coder);
        }
    relume_environment_destroy(&e);
}

// Display-domain codes of a coder that was taught: many pixels, so that pca has something to learn.
struct taught {
    struct learned l;
    uint16_t word[LEARNED_PLANES][LEARNED_PIXELS];
    const void *plane[LEARNED_PLANES];
    float scale[LEARNED_PLANES], offset[LEARNED_PLANES];
    struct relume_codes codes;
    float vectors[LEARNED_PLANES * LEARNED_PIXELS];
    uint16_t index[LEARNED_PIXELS];
    const float *book[1];
    const uint16_t *indices[1];
    int counts[1];
};

static void teach(struct taught *t, const struct relume_basis *basis, bool book)
{
    learned_create(&t->l, basis, true, false, 0);
    const int planes = relume_coder_info(t->l.coder)->planes;
    for (int p = 0; p < planes; p++) {
        t->plane[p] = t->word[p];
        t->scale[p] = 1;
        t->offset[p] = 0;
        for (int i = 0; i < LEARNED_PIXELS; i++) {
            const float v = t->l.planes[p * LEARNED_PIXELS + i];
            t->word[p][i] = fabsf(v) < 1e-4f ? 0 : half_of(v);
            t->vectors[i * planes + p] = v;
            t->index[i] = (uint16_t)i;
        }
    }
    t->book[0] = t->vectors;
    t->indices[0] = t->index;
    t->counts[0] = LEARNED_PIXELS;
    t->codes = (struct relume_codes){
        .coder = t->l.coder,
        .domain = RELUME_DOMAIN_DISPLAY,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = 20,
        .height = LEARNED_PIXELS / 20,
        .planes = planes,
        .storage = book ? 0 : RELUME_STORE_HALF,
        .plane = book ? NULL : t->plane,
        .scale = t->scale,
        .offset = t->offset,
        .books = book,
        .index = t->indices,
        .vectors = t->book,
        .book_codes = t->counts,
    };
}

// An environment on display-domain codes, against its cells decoded one by one; with a directional
// light beside it, which goes its own way.
static void test_refit(void **state)
{
    (void)state;
    if (TEST_SANITIZED)
        skip();
    // sh in planes, pca in a codebook
    static const struct relume_basis *const bases[] = {&relume_basis_sh, &relume_basis_pca};
    relume_environment *e = sky();
    for (int i = 0; i < 2; i++) {
        static struct taught t;
        struct test_log log;
        relume_refit *refit;
        struct relume_image out = {0}, again = {0};
        const struct relume_light lights[] = {
            {.kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {0.5f, 0.4f, 0.3f}},
            {.direction = {0.3, 0.2, 1}, .rgb = {0.5f, 0.5f, 0.5f}}};
        int n;
        const struct relume_environment_cell *cell = relume_environment_cells(&n, e);
        struct relume_light *lamps = calloc((size_t)n + 1, sizeof *lamps);
        int above = 0;
        for (int k = 0; k < n; k++) {
            if (cell[k].direction.z < 0)
                continue;
            lamps[above].direction = cell[k].direction;
            for (int c = 0; c < 3; c++)
                lamps[above].rgb[c] = cell[k].rgb[c] * lights[0].rgb[c];
            above++;
        }
        lamps[above++] = lights[1];
        test_log_init(&log);
        teach(&t, bases[i], i == 1);
        CHECK_OK(relume_refit_create(&refit, &t.codes, relume_refit_params(.log = &log.log)));
        assert_non_null(strstr(log.text, "converted to linear light"));
        assert_true(relume_refit_loss(refit) < 5e-3);
        CHECK_OK(relume_relight(&out, &t.codes, lights, 2, relume_relight_params(.refit = refit)));
        CHECK_OK(relume_relight(&again, &t.codes, lights, 2, NULL));
        double square[2] = {0, 0};  // by the refit, and by the captured lights
        for (int x = 70; x < LEARNED_PIXELS; x += 150) {
            double want[3];
            relume_relight_pixel(want, &t.codes, x % 20, x / 20, lamps, above);
            for (int c = 0; c < 3; c++) {
                for (int k = 0; k < 2; k++) {
                    const double d = (double)(k ? again : out).data[3 * x + c] - want[c];
                    square[k] += d * d / 6;  // 2 pixels
                }
            }
        }
        // Interpolated between 64 lights instead of the basis itself; the sums are near 0.5.
        for (int k = 0; k < 2; k++)
            if (!(sqrt(square[k]) < 0.01))
                fail_msg("%s %d, %d: off by %g", bases[i]->name, i, k, sqrt(square[k]));
        // without a refit nothing is lost to its components; between the lights both do alike
        assert_true(sqrt(square[1]) < sqrt(square[0]) + 2e-4);
        free(lamps);
        relume_refit_destroy(&refit);
        relume_image_destroy(&out);
        relume_image_destroy(&again);
        learned_destroy(&t.l);
    }
    relume_environment_destroy(&e);
}

// Under a sun a single captured light decides, whose codes a short pca may leave below 0; mirrored
// by the display's curve they were shown (-0.08 beside a mean of 1.2, a capture of 49 lights).
static void test_displayed_suns(void **state)
{
    (void)state;
    relume_environment *e = sun();
    for (int book = 0; book < 2; book++) {
        static struct taught t;
        struct relume_image out = {0};
        double below = 0.0;
        teach(&t, &relume_basis_pca, book);
        for (int k = 0; k < 4; k++) {
            const struct relume_light light = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                               .environment = e,
                                               .rotate_deg = 90.0 * k,
                                               .rgb = {1.0f, 0.5f, 0.25f}};
            CHECK_OK(relume_relight(&out, &t.codes, &light, 1, NULL));
            for (int i = 0; i < 3 * LEARNED_PIXELS; i++)
                below = fmin(below, (double)out.data[i]);
        }
        CHECK_NEAR(below, 0.0, 0.0);
        relume_image_destroy(&out);
        learned_destroy(&t.l);
    }
    relume_environment_destroy(&e);
}

// Memory that runs out at any place is said, and everything is given back (the sanitizer looks).
static void test_allocations(void **state)
{
    (void)state;
    static struct taught t;
    relume_environment *e = sky();
    const struct relume_light lights[] = {
        {.kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_AREA, .position = {0, 0, 2}, .u = {0, 1, 0}, .v = {1, 0, 0}},
        {.direction = {0, 0, 1}}};
    float points[LEARNED_PIXELS * 3] = {0};
    const struct relume_image surface = {20, LEARNED_PIXELS / 20, 3, .data = points};
    for (int book = TEST_SANITIZED; book < 2; book++) {
        teach(&t, &relume_basis_sh, book);
        t.codes.domain = RELUME_DOMAIN_DISPLAY;
        relume_status status = RELUME_ENOMEM;
        for (long n = 1; status; n *= 3) {  // of some thousand
            struct relume_image out = {0};
            mem_fail_after(n);
            status = relume_relight(&out, &t.codes, lights, 3,
                                    relume_relight_params(.surface = &surface, .threads = 1));
            assert_true(status == RELUME_OK || status == RELUME_ENOMEM);
            assert_true(n < 100000);
            if (mem_fail_pending())
                assert_int_equal(status, RELUME_OK);
            mem_fail_after(0);
            relume_image_destroy(&out);
        }
        learned_destroy(&t.l);
    }
    relume_environment_destroy(&e);
}

static void test_refusals(void **state)
{
    (void)state;
    struct setup s;
    struct test_log log;
    struct relume_image out = {0};
    relume_refit *refit;
    make(&s, SEPARATE, RELUME_DOMAIN_LINEAR);
    assert_int_equal(relume_refit_create(&refit, &s.codes, NULL), RELUME_EINVAL);
    const struct relume_light wrong[] = {
        {.direction = {1}}, {.kind = RELUME_LIGHT_SPOT, .direction = {1}, .half_angle_deg = 95}};
    test_log_init(&log);
    assert_int_equal(
        relume_relight(&out, &s.codes, wrong, 2, relume_relight_params(.log = &log.log)),
        RELUME_EINVAL);
    assert_non_null(strstr(log.text, "light 2: expected a half angle"));
    const struct relume_light area = lights_of(3, NULL);
    assert_int_equal(
        relume_relight(&out, &s.codes, &area, 1, relume_relight_params(.log = &log.log)),
        RELUME_EINVAL);
    assert_non_null(
        strstr(log.text, "(area) needs to know how far the surface is; expected depth"));
    assert_null(out.data);
    relume_coder_destroy(&s.coder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grid),         cmocka_unit_test(test_triangles),
        cmocka_unit_test(test_cusps),        cmocka_unit_test(test_grid_layout),
        cmocka_unit_test(test_kinds),        cmocka_unit_test(test_storages),
        cmocka_unit_test(test_together),     cmocka_unit_test(test_odd_places),
        cmocka_unit_test(test_environments), cmocka_unit_test(test_suns),
        cmocka_unit_test(test_refit),        cmocka_unit_test(test_displayed_suns),
        cmocka_unit_test(test_refusals),     cmocka_unit_test(test_allocations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
