// The GPU's relighting from codebooks against the library's
#include "fixture.h"

static const struct relume_light lights[] = {
    {.direction = {0.2, 0.3, 0.8}, .rgb = {1, 0.9f, 0.8f}},
    {.direction = {-2, 1, 0.5}, .rgb = {0.1f, 0.4f, 1.2f}},
    {.direction = {0, -1, -1}, .rgb = {0.5f, 0.5f, 0}},
};
enum { LIGHTS = sizeof lights / sizeof *lights, W = 41, H = 19, PIXELS = W * H, MOST_BOOKS = 3 };
static const int counts[MOST_BOOKS] = {3000, 1, 1024};

struct books_file {
    relume_coder *coder;
    float *vectors[MOST_BOOKS];
    uint16_t *index[MOST_BOOKS];
    struct relume_codes codes;
    int dropped;
};

static void make(struct books_file *f, int books, enum relume_domain domain)
{
    uint64_t random = 5;
    *f = (struct books_file){.coder = fixture_coder(false)};
    for (int b = 0; b < MOST_BOOKS; b++) {
        f->vectors[b] = malloc((size_t)(counts[b] * FIXTURE_PLANES) * sizeof(float));
        f->index[b] = malloc(PIXELS * sizeof(uint16_t));
        for (int i = 0; i < counts[b] * FIXTURE_PLANES; i++)
            f->vectors[b][i] =
                (float)((i % FIXTURE_PLANES < 3 ? 1.0 : 0.2) * uniform(&random) - 0.1);
        for (int i = 0; i < PIXELS; i++)
            f->index[b][i] = (uint16_t)(counts[b] * uniform(&random));
    }
    f->codes = (struct relume_codes){
        .coder = f->coder,
        .domain = domain,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = W,
        .height = H,
        .planes = FIXTURE_PLANES,
        .books = books,
        .index = (const uint16_t *const *)f->index,
        .vectors = (const float *const *)f->vectors,
        .book_codes = counts,
    };
}

static relume_status fetch(const struct relume_codes **out, void *user, int view)
{
    (void)view;
    *out = &((struct books_file *)user)->codes;
    return RELUME_OK;
}

// What has been uploaded may be overwritten.
static void forget(void *user, int view)
{
    struct books_file *f = user;
    (void)view;
    if (f->dropped++)
        return;
    for (int b = 0; b < MOST_BOOKS; b++) {
        memset(f->vectors[b], 0xff, (size_t)(counts[b] * FIXTURE_PLANES) * sizeof(float));
        memset(f->index[b], 0xff, PIXELS * sizeof(uint16_t));
    }
}

static void drop(struct books_file *f)
{
    for (int b = 0; b < MOST_BOOKS; b++) {
        free(f->vectors[b]);
        free(f->index[b]);
    }
    relume_coder_destroy(&f->coder);
}

// Sums of 3 x 27 float products of size 1; in the display domain the curve's slope, at most 3.
static void run(int books, enum relume_domain domain, double bound)
{
    struct books_file f;
    struct relume_image want[LIGHTS + 1] = {{0}};
    struct gl_relighter r;
    make(&f, books, domain);
    for (int n = 0; n <= LIGHTS; n++)
        assert_int_equal(relume_relight(&want[n], &f.codes, lights, n, NULL), RELUME_OK);
    const struct code_source source = {fetch, forget, &f, NULL, NULL};
    assert_int_equal(gl_relighter_create(&r, &fixture_gl, &source, 1, &fixture_log), RELUME_OK);
    for (int n = 0; n <= LIGHTS; n++) {
        const struct target *target;
        struct relume_image got;
        char what[64];
        snprintf(what, sizeof what, "%d books, domain %d, %d lights", books, (int)domain, n);
        assert_int_equal(gl_relighter_begin(&r, lights, n), RELUME_OK);
        assert_int_equal(gl_relighter_view(&target, &r, 0), RELUME_OK);
        assert_int_equal(target_read(&got, target, &fixture_gl), RELUME_OK);
        assert_below(what, fixture_difference(&got, &want[n]), bound);
        relume_image_destroy(&got);
        relume_image_destroy(&want[n]);
    }
    assert_int_equal(f.dropped, 1);
    gl_relighter_destroy(&r);
    drop(&f);
}

static void linear_books(void **state)
{
    (void)state;
    for (int books = 1; books <= MOST_BOOKS; books++)
        run(books, RELUME_DOMAIN_LINEAR, 1e-5);
}

static void display_books(void **state)
{
    (void)state;
    for (int books = 1; books <= MOST_BOOKS; books++)
        run(books, RELUME_DOMAIN_DISPLAY, 5e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_books),
        cmocka_unit_test(display_books),
    };
    return cmocka_run_group_tests_name("books", tests, fixture_open, fixture_close);
}
