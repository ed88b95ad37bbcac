// Files of Bonn: known numbers come back, whatever the layout; everything else is one clear line.
#include "in_folder.h"
#include "made_ubo.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

static const double views[4][2] = {{0, 0}, {0.6, 0.3}, {0.7, 2.5}, {0.5, -1.8}};
static const double lights[5][2] = {{0, 0}, {0.4, 1.0}, {0.9, 2.2}, {1.3, -2.0}, {1.2, -0.6}};
enum { VIEWS = 4, LIGHTS = 5, PAIRS = VIEWS * LIGHTS, W = 3, H = 2 };

// Another value for every colour, pair and texel, exact in a half.
static double known(int colour, int pair, int texel)
{
    return (double)(1 + colour + 3 * (pair + PAIRS * texel)) / 512.0;
}

// The table as factors: one is the table, the other picks.
static double pick_pair(const struct made_ubo *m, int colour, int k, int pair)
{
    const bool together = m->signature[1] == 'F' && !m->turned;
    return k == (together ? 3 * pair + colour : pair);
}

static double pick_texel(const struct made_ubo *m, int colour, int k, int texel)
{
    const bool together = m->signature[1] == 'F' && !m->turned;
    return together ? known(k % 3, k / 3, texel) : known(colour, k, texel);
}

static struct made_ubo table(const char *signature)
{
    const int rank = signature[1] == 'F' ? 3 * PAIRS : PAIRS;
    return (struct made_ubo){.signature = signature,
                             .version = 4,
                             .description = "<xml/>",
                             .views = VIEWS,
                             .lights = LIGHTS,
                             .view = views,
                             .light = lights,
                             .width = W,
                             .height = H,
                             .extension = 2,
                             .scalar = {2, 2, 2},
                             .rank = {rank, rank, rank},
                             .pair = pick_pair,
                             .texel = pick_texel};
}

static char path[96];

static void write_bytes(struct made_bytes b)
{
    snprintf(path, sizeof path, "%s/made.btf", folder);
    test_write(path, b.data, b.size);
}

static relume_btf *open_made(const struct made_ubo *m, const struct relume_btf_params *p)
{
    struct made_bytes b = made_ubo(m);
    struct test_log log;
    test_log_init(&log);
    struct relume_btf_params params = p ? *p : (struct relume_btf_params){0};
    params.log = &log.log;
    relume_btf *btf;
    write_bytes(b);
    free(b.data);
    if (relume_btf_open(&btf, path, &params))
        fail_msg("%s", log.text);
    assert_int_equal(log.lines, 0);
    return btf;
}

static double value(const relume_btf *btf, int colour, int pair, int texel)
{
    const int n = relume_btf_info(btf)->lights;
    return (double)float_from_half(relume_btf_picture(btf, pair / n, pair % n)[3 * texel + colour]);
}

static void check_table(const struct made_ubo *m)
{
    relume_btf *btf = open_made(m, NULL);
    for (int pair = 0; pair < PAIRS; pair++)
        for (int texel = 0; texel < W * H; texel++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(value(btf, c, pair, texel), known(c, pair, texel), 0.0);
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- what is read

static void test_head(void **state)
{
    (void)state;
    struct made_ubo m = table("!DFMF08FCR");
    relume_btf *btf = open_made(&m, NULL);
    const struct relume_btf_info *i = relume_btf_info(btf);
    assert_string_equal(i->name, "made");
    assert_int_equal(i->width, W);
    assert_int_equal(i->height, H);
    assert_int_equal(i->views, VIEWS);
    assert_int_equal(i->lights, LIGHTS);
    assert_true(i->without_cosine);
    for (int l = 0; l < LIGHTS; l++) {
        CHECK_NEAR(i->light[l].x, sin(lights[l][0]) * cos(lights[l][1]), 1e-6);
        CHECK_NEAR(i->light[l].y, sin(lights[l][0]) * sin(lights[l][1]), 1e-6);
        CHECK_NEAR(i->light[l].z, cos(lights[l][0]), 1e-6);
    }
    CHECK_NEAR(i->view[3].y, sin(0.5) * sin(-1.8), 1e-6);
    relume_btf_destroy(&btf);
    m.cosine = true;
    btf = open_made(&m, NULL);
    assert_false(relume_btf_info(btf)->without_cosine);
    relume_btf_destroy(&btf);
}

static void test_layouts(void **state)
{
    (void)state;
    static const char *const signatures[] = {"!DFMF08FCR", "!DFMF08FC", "!FMF12FCER",
                                             "!FMF12FCE",  "!FMF06FCR", "!FMF06FC"};
    for (size_t s = 0; s < 6; s++)
        for (int version = 1; version <= 4; version++)
            for (int turned = 0; turned < 2; turned++) {
                struct made_ubo m = table(signatures[s]);
                m.version = version;
                m.turned = turned;
                m.rank[0] = turned ? PAIRS : m.rank[0];
                m.rotations = m.signature[strlen(m.signature) - 1] == 'R' ? version - 1 : 0;
                m.extension = version % 3;
                m.map_width = 2 * version, m.map_height = 3;
                check_table(&m);
            }
    // a header that begins with the byte of an 'R'
    struct made_ubo m = table("!FMF06FC");
    char text[128];
    memset(text, 'x', sizeof text);
    for (size_t n = 0; n < sizeof text; n++) {
        text[n] = '\0';
        m.description = text;
        struct made_bytes b = made_ubo(&m);
        const bool hit = b.data[8] == 'R';
        free(b.data);
        if (hit)
            check_table(&m);
        text[n] = 'x';
    }
}

static void test_scalars(void **state)
{
    (void)state;
    static const int mixed[][3] = {{4, 4, 4}, {8, 8, 8}, {2, 4, 8}};
    for (size_t i = 0; i < 3; i++) {
        struct made_ubo m = table("!DFMF08FCR");
        memcpy(m.scalar, mixed[i], sizeof m.scalar);
        check_table(&m);
    }
}

// By hand, after docs/btf-bonn.md: three views and lights, one texel, one component.
static void test_bytes(void **state)
{
    (void)state;
    static const uint8_t head[] = {
        '!', 'D', 'F', 'M', 'F', '0', '8', 'F', 'C', 'R',  //
        12,  1,   0,   0,   2,   0,   0,   0,              // 268 bytes, version 2
    };
    static const uint8_t directions[] = {
        3, 0, 0,    0,                       // views
        0, 0, 0,    0,    0, 0, 0,    0,     // 0, 0
        3, 0, 0,    0,                       // its lights
        0, 0, 0,    0,    0, 0, 0,    0,     // 0, 0
        0, 0, 0x80, 0x3f, 0, 0, 0,    0,     // 1, 0
        0, 0, 0x80, 0x3f, 0, 0, 0x80, 0x3f,  // 1, 1
    };
    static const uint8_t tail[] = {
        1, 0, 0, 0, 1,  0, 0, 0, 0, 0, 0, 0,  // 1 x 1 texels, no rotations
        1, 0, 0, 0, 11, 0, 0, 0,              // one component; log Y, U/Y, V/Y
    };
    static const uint8_t plane[] = {2, 1, 0, 0, 0, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    struct made_bytes b = {NULL, 0};
    made_add(&b, head, sizeof head);
    made_add(&b, NULL, 256);
    made_add(&b, "\1\0\0", 4);  // values hold the cosine
    made_add(&b, directions, sizeof directions);
    for (int v = 1; v < 3; v++) {
        const uint8_t view[8] = {
            0, 0, 0x80, 0x3f, 0, 0, (uint8_t)(v == 2 ? 0x80 : 0), v == 2 ? 0x3f : 0};
        made_add(&b, view, 8);
        made_add(&b, directions + 12, sizeof directions - 12);
    }
    made_add(&b, tail, sizeof tail);
    made_add(&b, NULL, 12 * 4);
    for (int c = 0; c < 3; c++) {
        made_add(&b, plane, sizeof plane);
        for (int pair = 0; pair < 9; pair++)
            made_add(&b, c == 0 && pair == 5 ? "\0\x3c" : "\0\0", 2);       // 1 in view 1, light 2
        made_add(&b, c == 0 ? "\0\xb8" : c == 1 ? "\0\x34" : "\0\x38", 2);  // -0.5, 0.25, 0.5
    }
    // U/Y and V/Y as well
    const size_t each = sizeof plane + 9 * 2 + 2, planes = b.size - 3 * each;
    for (size_t c = 1; c < 3; c++)
        memcpy(b.data + planes + c * each + sizeof plane + 2 * 5, "\0\x3c", 2);
    write_bytes(b);
    free(b.data);
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, path, NULL));
    assert_false(relume_btf_info(btf)->without_cosine);
    const double e = exp(-0.5), y = e - 1e-5, u = 0.25 * e, v = 0.5 * e;
    CHECK_NEAR(value(btf, 0, 5, 0), y + 1.13983 * v, 1e-3);
    CHECK_NEAR(value(btf, 1, 5, 0), y - 0.39465 * u - 0.5806 * v, 1e-3);
    CHECK_NEAR(value(btf, 2, 5, 0), y + 2.03211 * u, 1e-3);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(value(btf, c, 4, 0), 1.0 - 1e-5, 5e-4);
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- products and colours

// Numbers between -1 and 1 that have no pattern, as a half holds them.
static double noise(int colour, int k, int i, int which)
{
    uint32_t s = (uint32_t)(colour * 7919 + k * 104729 + i * 1299709 + which * 15485863 + 1);
    test_random(&s);
    return made_round(2.0 * test_uniform(&s) - 1.0);
}

static double noise_pair(const struct made_ubo *m, int colour, int k, int pair)
{
    (void)m;
    return noise(colour, k, pair, 0);
}

static double noise_texel(const struct made_ubo *m, int colour, int k, int texel)
{
    (void)m;
    return noise(colour, k, texel, 1);
}

// What the planes hold, and the colours of it, by Bonn's formulas.
static void expected(double rgb[3], const struct made_ubo *m, int pair, int texel)
{
    double v[3], t[3];
    for (int c = 0; c < 3; c++) {
        v[c] = 0.0;
        const int from = m->signature[1] == 'F' ? 0 : c;
        for (int k = 0; k < m->rank[from]; k++)
            v[c] += noise_pair(m, c, k, pair) * noise_texel(m, from, k, texel);
    }
    const double e = exp(v[0]), eps = 1e-5;
    switch (m->signature[1] == 'F' ? 12 * m->logarithm : m->colours) {
    case 3:
        for (int c = 0; c < 3; c++)
            rgb[c] = v[0] * (double)m->matrix[c] + v[1] * (double)m->matrix[3 + c] +
                     v[2] * (double)m->matrix[6 + c] + (double)m->mean[c];
        return;
    case 4:
        rgb[0] = v[0] + v[1] - v[2];
        rgb[1] = v[0] + v[2];
        rgb[2] = v[0] - v[1] - v[2];
        return;
    case 12:
        for (int c = 0; c < 3; c++)
            rgb[c] = exp(v[c]) - eps;
        return;
    case 0: memcpy(rgb, v, sizeof v); return;
    case 9: v[0] = e - eps; break;
    case 10:
        for (int c = 1; c < 3; c++)
            t[c] = exp(fabs(v[c]) + log(eps)), v[c] = v[c] < 0.0 ? -t[c] : t[c];
        v[0] = e - eps;
        break;
    case 11:
        v[0] = e - eps;
        for (int c = 1; c < 3; c++)
            v[c] *= v[0] + eps;
        break;
    default: break;
    }
    rgb[0] = v[0] + 1.13983 * v[2];
    rgb[1] = v[0] - 0.39465 * v[1] - 0.5806 * v[2];
    rgb[2] = v[0] + 2.03211 * v[1];
}

static void check_noise(const struct made_ubo *m)
{
    relume_btf *btf = open_made(m, NULL);
    for (int pair = 0; pair < m->views * m->lights; pair++)
        for (int texel = 0; texel < m->width * m->height; texel++) {
            double rgb[3];
            expected(rgb, m, pair, texel);
            for (int c = 0; c < 3; c++) {
                const double want = fmax(rgb[c], 0.0);
                // a half's step, and floats summed in some order
                CHECK_NEAR(value(btf, c, pair, texel), want, want * 0x1p-11 + 1e-6);
            }
        }
    relume_btf_destroy(&btf);
}

static struct made_ubo noisy(const char *signature)
{
    struct made_ubo m = table(signature);
    m.rank[0] = 5, m.rank[1] = 3, m.rank[2] = 1;
    m.pair = noise_pair, m.texel = noise_texel;
    return m;
}

static void test_colours(void **state)
{
    (void)state;
    static const int kinds[] = {0, 1, 3, 4, 9, 10, 11, 12};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct made_ubo m = noisy("!DFMF08FCR");
        m.colours = kinds[i];
        for (int k = 0; k < 9; k++)
            m.matrix[k] = 0.1f * (float)k;
        m.mean[0] = 1.0f, m.mean[1] = 0.5f, m.mean[2] = 2.0f;
        check_noise(&m);
    }
    for (int logarithm = 0; logarithm < 2; logarithm++) {
        struct made_ubo m = noisy("!FMF12FCER");
        m.logarithm = logarithm;
        check_noise(&m);
    }
}

static double (*many(int n))[2]
{
    double(*d)[2] = malloc((size_t)n * sizeof *d);
    assert_non_null(d);
    for (int i = 0; i < n; i++)
        d[i][0] = 1.3 * i / n, d[i][1] = fmod(2.4 * i, 6.2);
    return d;
}

// More pairs and texels than one tile has; equal bits for any number of threads.
static void test_tiles(void **state)
{
    (void)state;
    struct made_ubo m = noisy("!DFMF08FCR");
    double(*d)[2] = many(13);
    m.view = m.light = (const double(*)[2])d;
    m.views = m.lights = 13;
    m.width = 37, m.height = 23;
    m.colours = 11;
    check_noise(&m);
    relume_btf *one = open_made(&m, relume_btf_params(.threads = 1));
    const size_t bytes = relume_btf_bytes(37, 23, 13, 13);
    for (int threads = 2; threads < 8; threads += 5) {
        relume_btf *other = open_made(&m, relume_btf_params(.threads = threads));
        assert_memory_equal(one->values, other->values, bytes);
        relume_btf_destroy(&other);
    }
    // a part is that part
    relume_btf *part = open_made(&m, relume_btf_params(.crop = {5, 7, 30, 11}));
    assert_int_equal(relume_btf_info(part)->width, 30);
    assert_int_equal(relume_btf_info(part)->height, 11);
    for (int pair = 0; pair < 13 * 13; pair++)
        for (int y = 0; y < 11; y++)
            assert_memory_equal(
                relume_btf_picture(part, pair / 13, pair % 13) + 3 * 30 * y,
                relume_btf_picture(one, pair / 13, pair % 13) + 3 * (37 * (y + 7) + 5), 6 * 30);
    relume_btf_destroy(&part);
    relume_btf_destroy(&one);
    free(d);
}

static void test_outline(void **state)
{
    (void)state;
    struct made_ubo m = table("!DFMF08FCR");
    relume_btf *btf = open_made(&m, relume_btf_params(.outline = true, .scratch = "/nowhere"));
    assert_int_equal(relume_btf_info(btf)->lights, LIGHTS);
    assert_null(btf->values);
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- what is refused

// Must fail with one line that names the file and holds `text`.
static void refuse(struct made_bytes b, const struct relume_btf_params *p, relume_status want,
                   const char *text)
{
    struct test_log log;
    test_log_init(&log);
    struct relume_btf_params params = p ? *p : (struct relume_btf_params){0};
    params.log = &log.log;
    relume_btf *btf;
    write_bytes(b);
    free(b.data);
    const relume_status status = relume_btf_open(&btf, path, &params);
    if ((want ? status != want : !relume_status_is_input(status)) || log.lines != 1 ||
        !strstr(log.text, text) || strncmp(log.text, path, strlen(path)) != 0)
        fail_msg("status %d, %d lines, '%s'; expected '%s'", status, log.lines, log.text, text);
    assert_null(btf);
}

static void refuse_made(const struct made_ubo *m, const char *text)
{
    refuse(made_ubo(m), NULL, RELUME_OK, text);
}

static void test_signatures(void **state)
{
    (void)state;
    static const char *const other[][2] = {{"!PVF06FCR", "views factored each by itself"},
                                           {"!BDIF06R2!", "not factored (BDI)"},
                                           {"!DFMF09FCR", "not a BTF of Bonn"},
                                           {"\211PNG\r\n", "not a BTF of Bonn"}};
    for (size_t i = 0; i < 4; i++) {
        struct made_ubo m = table(other[i][0]);
        refuse_made(&m, other[i][1]);
    }
    refuse((struct made_bytes){calloc(1, 1), 0}, NULL, RELUME_EFORMAT, "found an empty file");
    refuse((struct made_bytes){calloc(1, 1), 1}, NULL, RELUME_EFORMAT, "not a BTF of Bonn");
}

// The word at an offset of the plain table becomes another.
static void refuse_word(size_t at, uint32_t w, const char *text)
{
    struct made_ubo m = table("!DFMF08FCR");
    struct made_bytes b = made_ubo(&m);
    const uint8_t bytes[4] = {(uint8_t)w, (uint8_t)(w >> 8), (uint8_t)(w >> 16),
                              (uint8_t)(w >> 24)};
    memcpy(b.data + at, bytes, 4);
    refuse(b, NULL, RELUME_OK, text);
}

static void test_words(void **state)
{
    (void)state;
    // signature 10, header 264 + cosine 4 + description 4 + 6 + colours 4 + 18 of names
    enum { HEAD = 10, TEXT = HEAD + 268, COLOURS = TEXT + 10, DIRECTIONS = HEAD + 300 };
    enum { EACH = 12 + 8 * LIGHTS, SIZE = DIRECTIONS + 4 + VIEWS * EACH, KIND = SIZE + 16 };
    enum { PLANE = KIND + 4 + 48 };
    refuse_word(HEAD, 303, "header of 303 bytes");
    refuse_word(HEAD, 0xffffffff, "header of 4294967295 bytes");
    refuse_word(HEAD + 4, 0, "header of version");
    refuse_word(TEXT, 0xffffffff, "ends within its description");
    refuse_word(COLOURS, 31, "expected 3 colours; found 31");
    refuse_word(COLOURS + 4, 0x7fffffff, "ends within the names of its colours");
    refuse_word(DIRECTIONS, 0, "expected 3 to 65536 views; found 0");
    refuse_word(DIRECTIONS, 0xffffffff, "expected 3 to 65536 views; found 4294967295");
    refuse_word(DIRECTIONS, 60000, "views");
    refuse_word(DIRECTIONS + 12, 2, "expected 3 to 65536 lights; found 2");
    refuse_word(DIRECTIONS + 12, 0xffffffff, "expected 3 to 65536 lights");
    refuse_word(DIRECTIONS + 12 + EACH, 4, "view 1 has 4 lights; expected 5");
    refuse_word(DIRECTIONS + 4, 0x7fc00000, "expected radians; found nan");
    refuse_word(DIRECTIONS + 4, 0x7f800000, "expected radians; found inf");
    refuse_word(DIRECTIONS + 4, 0x42960000, "expected radians; found 75");
    refuse_word(DIRECTIONS + 20, 0x43340000, "expected radians");
    refuse_word(DIRECTIONS + 4, 0x3fc90fdb,
                "view 0: 90 degrees from the pole; expected less than 90");
    refuse_word(DIRECTIONS + 16, 0x40000000, "view 0, light 0: 114.592 degrees");
    refuse_word(SIZE, 0, "0 x 2 texels");
    refuse_word(SIZE + 4, 0x10000, "factors of 20 and 6 rows; expected 20 and 196608");
    refuse_word(SIZE, 0xffffffff, "4294967295 x 2 texels");
    refuse_word(SIZE + 8, 0xffffffff, "ends within its rotations");
    refuse_word(KIND, 2, "colours of kind 2");
    refuse_word(KIND, 0xffffffff, "colours of kind -1");
    refuse_word(PLANE, 0x00000003, "numbers of 3 bytes");
    refuse_word(PLANE + 1, 0, "0 components");
    refuse_word(PLANE + 1, 4097, "4097 components");
    refuse_word(PLANE + 1, 4096, "ends within its values");
    refuse_word(PLANE + 1, 19, "");
    refuse_word(PLANE + 5, 21, "factors of 21 and 6 rows; expected 20 and 6 or 6 and 20");
    refuse_word(PLANE + 9, 0, "factors of 20 and 0 rows");
}

static void test_cuts(void **state)
{
    (void)state;
    static const char *const signatures[] = {"!DFMF08FCR", "!FMF12FCER"};
    for (size_t s = 0; s < 2; s++) {
        struct made_ubo m = table(signatures[s]);
        m.rank[0] = m.rank[1] = m.rank[2] = 1;
        m.map_width = m.map_height = 2;
        struct made_bytes whole = made_ubo(&m);
        for (size_t n = 1; n < whole.size; n++) {
            struct made_bytes b = {malloc(n), n};
            memcpy(b.data, whole.data, n);
            refuse(b, NULL, n < 9 ? RELUME_EFORMAT : RELUME_EDAMAGED,
                   n < 9 ? "not a BTF" : "ends within");
        }
        made_add(&whole, "", 1);
        refuse(whole, NULL, RELUME_EDAMAGED, "found 1 more");
    }
}

static double big_texel(const struct made_ubo *m, int colour, int k, int texel)
{
    (void)m, (void)k;
    return colour == 0 && texel == 4 ? 60000.0 : 0.5;
}

static double nan_pair(const struct made_ubo *m, int colour, int k, int pair)
{
    (void)m, (void)k;
    return colour == 1 && pair == 13 ? NAN : 1.0;
}

static void test_numbers(void **state)
{
    (void)state;
    struct made_ubo m = noisy("!DFMF08FCR");
    m.rank[0] = m.rank[1] = m.rank[2] = 1;
    m.pair = nan_pair, m.texel = big_texel;
    refuse_made(&m, "view 2, light 3: NaN or infinity");
    m.pair = noise_pair, m.colours = 11;
    refuse_made(&m, "NaN or infinity");
    // what a half cannot hold is cut off
    m.texel = noise_texel, m.colours = 3;
    m.matrix[0] = 1.0f, m.mean[0] = 1e6f, m.mean[1] = -3.0f;
    relume_btf *btf = open_made(&m, NULL);
    CHECK_NEAR(value(btf, 0, 0, 0), 65504.0, 0.0);
    CHECK_NEAR(value(btf, 1, 0, 0), 0.0, 0.0);
    relume_btf_destroy(&btf);
    m = table("!FMF12FCER");
    m.extension = 3;
    refuse_made(&m, "extension of version 3");
    m.extension = 2;
    m.map_width = 2;
    struct made_bytes b = made_ubo(&m);
    uint8_t *map = b.data + 10 + 300 + 4 + VIEWS * (12 + 8 * LIGHTS) + 12 + 5;
    memset(map, 0xff, 8);
    refuse(b, NULL, RELUME_EDAMAGED, "ends within its map of heights");
}

static void test_other_lights(void **state)
{
    (void)state;
    struct made_ubo m = table("!DFMF08FCR");
    struct made_bytes b = made_ubo(&m);
    const size_t at = 10 + 300 + 4 + 2 * (12 + 8 * LIGHTS) + 12 + 8 * 3;
    const float other = 0.7f;
    memcpy(b.data + at, &other, 4);
    struct made_bytes copy = {mem_copy(b.data, b.size, 1), b.size};
    refuse(b, NULL, RELUME_EUNFIT, "light 3 of view 2 is not that of view 0");
    struct test_log log;
    test_log_init(&log);
    write_bytes(copy);
    relume_free(copy.data);
    relume_btf *btf;
    CHECK_OK(relume_btf_open(&btf, path, relume_btf_params(.fill = true, .log = &log.log)));
    assert_non_null(strstr(log.text, "the lights of view 0 are used for all"));
    CHECK_NEAR(value(btf, 1, 13, 4), known(1, 13, 4), 0.0);
    relume_btf_destroy(&btf);
    // two lights in one place: the message names the file
    double same[LIGHTS][2] = {{0, 0}, {0.5, 0}, {0.7, 0}, {0.9, 0}, {1.1, 0}};
    m.light = (const double(*)[2])same;
    refuse_made(&m, "great circle");
}

static bool stop(void *user, const char *what, double done)
{
    (void)user, (void)what, (void)done;
    return false;
}

static void test_limits(void **state)
{
    (void)state;
    struct made_ubo m = table("!DFMF08FCR");
    static const int wrong[][4] = {{3, 0, 1, 1},         {0, 0, 4, 1}, {0, 1, 1, 2},
                                   {-1, 0, 1, 1},        {0, 0, 1, 0}, {2147483647, 0, 1, 1},
                                   {0, 0, 2147483647, 1}};
    for (size_t i = 0; i < 7; i++) {
        struct relume_btf_params p = {0};
        memcpy(p.crop, wrong[i], sizeof p.crop);
        refuse(made_ubo(&m), &p, RELUME_EINVAL, "expected one of 3 x 2");
    }
    refuse(made_ubo(&m), relume_btf_params(.scratch = "/nowhere"), RELUME_ESYSTEM,
           "no room for 6.71e-07 GiB of temporary data in /nowhere");
    const struct relume_limits small = {.max_views = 3}, few = {.max_lights = 4},
                               flat = {.max_side = 2};
    refuse(made_ubo(&m), relume_btf_params(.limits = &small), RELUME_ELIMIT,
           "3 to 3 views; found 4");
    refuse(made_ubo(&m), relume_btf_params(.limits = &few), RELUME_ELIMIT,
           "3 to 4 lights; found 5");
    refuse(made_ubo(&m), relume_btf_params(.limits = &flat), RELUME_ELIMIT, "3 x 2 texels");
    const struct relume_log log = {.progress = stop};
    struct made_bytes b = made_ubo(&m);
    write_bytes(b);
    free(b.data);
    relume_btf *btf;
    assert_int_equal(relume_btf_open(&btf, path, relume_btf_params(.log = &log)), RELUME_ECANCEL);
    assert_null(btf);
    // a part of a folder
    struct test_log told;
    test_log_init(&told);
    assert_int_equal(
        relume_btf_open(&btf, folder, relume_btf_params(.crop = {0, 0, 1, 1}, .log = &told.log)),
        RELUME_EINVAL);
    assert_non_null(strstr(told.text, "expected a .btf file"));
}

static void test_memory(void **state)
{
    (void)state;
    struct made_ubo m = table("!DFMF08FCR");
    struct made_bytes b = made_ubo(&m);
    write_bytes(b);
    free(b.data);
    for (long n = 1;; n++) {
        relume_btf *btf;
        mem_fail_after(n);
        const relume_status status = relume_btf_open(&btf, path, relume_btf_params(.threads = 2));
        const bool pending = mem_fail_pending();
        mem_fail_after(0);
        relume_btf_destroy(&btf);
        if (pending)
            break;
        assert_true(status == RELUME_ENOMEM || status == RELUME_ESYSTEM);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_head),    cmocka_unit_test(test_layouts),
        cmocka_unit_test(test_scalars), cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_colours), cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_outline), cmocka_unit_test(test_signatures),
        cmocka_unit_test(test_words),   cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_numbers), cmocka_unit_test(test_other_lights),
        cmocka_unit_test(test_limits),  cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
