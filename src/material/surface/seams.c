// seams.c - how much a map differs from its sample where it was cut
#include "core/base/log.h"
#include "material/surface/features.h"
#include "material/surface/surface.h"

#include "core/math/random.h"

struct steps {
    double sum;  // of squares
    size_t count;
};

static double root_mean(const struct steps *s)
{
    return s->count ? sqrt(s->sum / (double)s->count) : 0.0;
}

static void add(struct steps *s, const struct features *f, size_t a, size_t b)
{
    s->sum += (double)features_apart(f, a, b);
    s->count++;
}

static void measure_sample(struct steps *inside, struct steps *unrelated, const struct features *f)
{
    const size_t width = (size_t)f->width, n = width * (size_t)f->height;
    struct random random = random_stream(0, n, 0);
    for (size_t i = 0; i < n; i++) {
        if ((i + 1) % width)
            add(inside, f, i, i + 1);
        if (i + width < n)
            add(inside, f, i, i + width);
        add(unrelated, f, i, (size_t)(random_next(&random) * (double)n));
    }
}

// Neighbours of the surface, over the borders of tiles as well.
static void measure_map(struct steps *across, size_t *all, const struct relume_btf_map_info *m,
                        const struct features *f)
{
    const int width = m->columns * m->width, height = m->rows * m->height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const uint32_t at = map_at(m, x, y), right = map_at(m, x + 1, y);
            const uint32_t down = map_at(m, x, y + 1), columns = (uint32_t)m->sample_width;
            if (right != at + 1 || right % columns == 0)
                add(across, f, at, right);
            if (down != at + columns)
                add(across, f, at, down);
            *all += 2;
        }
}

relume_status relume_btf_map_seams(struct relume_btf_seams *out, const relume_btf_map *map,
                                   const relume_btf_fitted *sample, const struct relume_log *log)
{
    struct features f;
    struct steps inside = {0}, across = {0}, unrelated = {0};
    size_t all = 0;
    if (map->info.sample_width != sample->width || map->info.sample_height != sample->height)
        return log_fail(log, RELUME_EINVAL, "map: of a sample of %d x %d texels; expected %d x %d",
                        map->info.sample_width, map->info.sample_height, sample->width,
                        sample->height);
    const relume_status status = features_make(&f, sample, 0);
    if (status)
        return status;
    measure_sample(&inside, &unrelated, &f);
    measure_map(&across, &all, &map->info, &f);
    *out = (struct relume_btf_seams){.inside = root_mean(&inside),
                                     .across = root_mean(&across),
                                     .unrelated = root_mean(&unrelated),
                                     .share = (double)across.count / (double)all};
    features_free(&f);
    return RELUME_OK;
}
