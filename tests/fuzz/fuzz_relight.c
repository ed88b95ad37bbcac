// fuzz_relight.c - codes, steps and lights taken from bytes: both kernels must survive and agree
#include "format/coder/coding.h"

#include "fuzz.h"

struct reader {
    const uint8_t *at, *end;
};

static uint32_t take(struct reader *r, int bytes)
{
    uint32_t v = 0;
    for (int i = 0; i < bytes; i++)
        v = v << 8 | (r->at < r->end ? *r->at++ : 0u);
    return v;
}

static float take_float(struct reader *r)
{
    const uint32_t bits = take(r, 4);
    float f;
    memcpy(&f, &bits, 4);
    return isfinite(f) ? f : 0.0f;  // files with others are refused
}

static double plane_bound(const struct relume_codes *codes, int plane)
{
    const double top = codes->storage == RELUME_STORE_8 ? 255.0 : 65535.0;  // halves end at 60000
    return fabs((double)codes->scale[plane]) * top + fabs((double)codes->offset[plane]);
}

// Sums in another order: every term may be rounded once more, at the size of the largest sum.
static double largest(const struct relume_codes *codes, const struct relume_light *light)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const struct relume_vec3 d = light->direction;
    const double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    struct relume_vec3 from;
    float weights[3 * 64], constant[3];
    double most = 0.0;
    const double share = relume_coder_clamp(
        &from, codes->coder, (struct relume_vec3){d.x / length, d.y / length, d.z / length});
    relume_coder_weights(codes->coder, from, weights, constant);
    for (int c = 0; c < 3; c++) {
        double sum = fabs((double)constant[c]);
        for (int k = 0; k < info->coefficients; k++)
            sum += fabs((double)weights[c * info->coefficients + k]) *
                   plane_bound(codes, relume_coder_plane(info, k, c));
        sum *= info->luminance ? plane_bound(codes, info->coefficients + c) : 1.0;
        sum *= share * fabs((double)light->rgb[c]);
        most = isfinite(sum) ? fmax(most, sum) : INFINITY;
    }
    return most;
}

static bool one(struct fuzz *f, struct bytes b)
{
    enum { MOST = 64, BASES = 8, INTERPOLANTS = 8 };
    static const struct relume_basis *const bases[BASES] = {
        &relume_basis_table, &relume_basis_sh,  &relume_basis_ptm,           &relume_basis_hsh,
        &relume_basis_pca,   &relume_basis_dct, &relume_basis_dct_resampled, &relume_basis_eigen,
    };
    static const enum relume_storage storages[] = {
        RELUME_STORE_8, RELUME_STORE_16, RELUME_STORE_HALF, RELUME_STORE_10, RELUME_STORE_12};
    (void)f;
    struct reader r = {b.data, b.data + b.size};
    const int width = 1 + (int)(take(&r, 1) % 70), height = 1 + (int)(take(&r, 1) % 5);
    const int n = 1 + (int)(take(&r, 1) % 16), count = (int)(take(&r, 1) % 4);
    const enum relume_storage storage = storages[take(&r, 1) % 5];
    const struct relume_basis *basis = bases[take(&r, 1) % BASES];
    struct relume_vec3 lights[16];
    for (int i = 0; i < n; i++) {
        const double x = (int)take(&r, 1) - 128, y = (int)take(&r, 1) - 128, z = take(&r, 1);
        const double length = sqrt(x * x + y * y + z * z) + 1e-9;
        lights[i] = (struct relume_vec3){x / length, y / length, (z + 1e-9) / length};
    }
    relume_coder *coder;
    float transform[3 * MOST * 16], mean[3 * 16];
    struct relume_coder_params how = {
        .coefficients = basis->learned ? 1 + (int)(take(&r, 1) % 48) : 0,
        .hemispherical = take(&r, 1) % 2,
        .pole_y = take(&r, 1) % 2,
        .luminance = !basis->learned && take(&r, 1) % 2,
        .interpolant = relume_interpolants[take(&r, 1) % INTERPOLANTS],
        .decode = true,
        .force = true,
    };
    for (int i = 0; i < 4; i++)
        how.parameter[i] = take(&r, 1) % 4 ? 0.0 : ldexp((double)take(&r, 1), -5);
    for (size_t i = 0; basis->learned && i < sizeof transform / sizeof *transform; i++)
        transform[i] = ldexpf((float)(int8_t)take(&r, 1), -7);
    for (size_t i = 0; i < sizeof mean / sizeof *mean; i++)
        mean[i] = ldexpf((float)take(&r, 1), -8);
    if (basis->learned) {
        how.transform = transform;
        how.mean = mean;
    }
    if (relume_coder_create(&coder, basis, lights, n, &how))
        return false;
    const int planes = relume_coder_info(coder)->planes;
    const size_t pixels = (size_t)width * (size_t)height, size = storage == RELUME_STORE_8 ? 1 : 2;
    uint8_t *data = malloc((size_t)planes * pixels * size);
    const void *plane[MOST];
    float scale[MOST], offset[MOST];
    for (int p = 0; p < planes; p++) {
        plane[p] = data + (size_t)p * pixels * size;
        scale[p] = ldexpf((float)(int8_t)take(&r, 1), -8);
        offset[p] = ldexpf((float)(int8_t)take(&r, 1), -4);
    }
    for (size_t i = 0; i < (size_t)planes * pixels * size; i++)
        data[i] = (uint8_t)take(&r, 1) & (storage == RELUME_STORE_HALF ? 0xbb : 0xff);
    const struct relume_codes codes = {.coder = coder,
                                       .domain = 1 + take(&r, 1) % 2,
                                       .display = {.curve = RELUME_CURVE_GAMMA, .gamma = 0.5f},
                                       .width = width,
                                       .height = height,
                                       .planes = planes,
                                       .storage = storage,
                                       .plane = plane,
                                       .scale = scale,
                                       .offset = offset};
    struct relume_light lamp[4];
    for (int i = 0; i < count; i++)
        lamp[i] = (struct relume_light){.direction = {take_float(&r), take_float(&r), 1.0},
                                        .rgb = {1.0f, ldexpf((float)take(&r, 1), -7), 0.0f}};
    struct relume_image fast = {0}, plain = {0};
    double tolerance = 0.0;
    for (int i = 0; i < count; i++)
        tolerance += 4e-6 * largest(&codes, &lamp[i]);  // 2^-24 x 48 terms
    const relume_status a = relume_relight(&fast, &codes, lamp, count, NULL);
    const relume_status c = relume_relight(&plain, &codes, lamp, count,
                                           relume_relight_params(.cpu_off = ~0u, .threads = 1));
    if (!a && !c && codes.domain == RELUME_DOMAIN_LINEAR && isfinite(tolerance))
        for (size_t i = 0; i < 3 * pixels; i++)
            if (!(fabs((double)fast.data[i] - (double)plain.data[i]) <= tolerance)) {
                printf("sample %zu: %.9g and %.9g\n", i, (double)fast.data[i],
                       (double)plain.data[i]);
                abort();
            }
    relume_image_destroy(&fast);
    relume_image_destroy(&plain);
    relume_coder_destroy(&coder);
    free(data);
    return !a;
}

int main(int argc, char **argv)
{
    struct fuzz f = {0};
    fuzz_begin(&f, "fuzz_relight", argc, argv);
    while (f.seeds < 6) {
        struct bytes b = {malloc(8000), 8000};
        for (size_t i = 0; i < b.size; i++)
            b.data[i] = (uint8_t)fuzz_random(&f);
        if (one(&f, b))
            fuzz_add(&f, b);
        else
            free(b.data);
    }
    return fuzz_run(&f, argc, argv, one);
}
