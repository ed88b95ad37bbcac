// published.c - one file in the site: its planes, tiles and scene.json
//
// All views have one set of components and one scale per plane, so the ranges are found in all
// views first; the step is found on the middle one, as that of an export is.
#include "site/publish/published.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/math/scalar.h"
#include "exchange/foreign/measure.h"
#include "exchange/formats/web_step.h"
#include "site/publish/exposure.h"
#include "site/publish/guide.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { USUAL_PLANES = 27, CORRECTIONS = 8, TRIAL_PIXELS = 1 << 17 };

// Without a wish: a page differs from the file by less than 1/255 on average, which normal errors
// do at this PSNR. Where so many planes do not reach that there are more; and where those do not,
// as of hard shadows, the step is that of an error which is not seen beside what is missing.
#define USUAL_DB     47.5
#define USUAL_MARGIN 1.0
// A finer step that makes up for no more than this part of what lacks is of no use: planes lack.
#define LEAST_GAIN 0.2
// Linear light of so high a dynamic range that 8 bits show less than this of it is coded first, and
// ends at white.
#define POOR_DB 28.0
// Nor may it show less than this where shadows move, which hides no errors; black is exact in
// linear planes, so that this is as near on the mean as 47 dB of coded ones.
#define POOR_MOVING_DB 42.5
// Nor does it become finer than this without anybody\'s wish.
#define USUAL_FINER 2.0
#define USUAL_SLACK 0.8  // measured values are rounded to 8 bits

// What the page loads before it shows something: of 150 kB what the viewer itself leaves. What
// scene.json says of lights is a part of it, packed.
enum { FIRST_BYTES = 51000, LEAST_BYTES = 12000, FIRST_VIEWS = 4, LEAST_SIDE = 16 };
#define PACKED_FLOAT 3.7  // bytes
#define LEVEL_RATIO  3.0

static int middle_of(const struct published *f)
{
    return relume_pack_info(f->pack)->views / 2;
}

// The codes of the middle view stay: the source of the components reads them.
static void drop(const struct published *f, int view)
{
    if (view != middle_of(f))
        relume_pack_drop(f->pack, view);
}

static relume_status planes_of(struct planes *out, const struct published *f, int view)
{
    const struct relume_codes *codes;
    struct source source = {0};
    relume_status status = relume_pack_codes(&codes, f->pack, view);
    if (!status)
        status = source_open(&source, codes, f->common.kind, f->site->log);
    if (!status)
        status =
            planes_make(out, &f->common.plan, &source, f->site->path, f->site->params->threads);
    if (!status && f->common.guided)
        guide_find_ranges(out, f->site->params->threads);
    source_close(&source);
    drop(f, view);
    return status;
}

// The smallest and largest values of all views; the planes of the middle one stay in `middle`.
static relume_status find_ranges(struct published *f, struct planes *middle, double *minimum,
                                 double *maximum)
{
    const int views = relume_pack_info(f->pack)->views, n = f->common.plan.planes;
    relume_status status = RELUME_OK;
    for (int p = 0; p < n; p++) {
        minimum[p] = DBL_MAX;
        maximum[p] = -DBL_MAX;
    }
    for (int i = 0; !status && i < views; i++) {
        struct planes view = {0};
        status = planes_of(&view, f, i);
        for (int p = 0; !status && p < n; p++) {
            minimum[p] = fmin(minimum[p], view.minimum[p]);
            maximum[p] = fmax(maximum[p], view.maximum[p]);
            if (!isfinite(minimum[p]) || !isfinite(maximum[p]))
                status = log_fail(f->site->log, RELUME_EDAMAGED,
                                  "view %d holds values that are no numbers", i);
        }
        if (!status && i == middle_of(f))
            *middle = view;
        else if (!status)
            planes_free(&view);
        if (!status && !log_progress(f->site->log, "ranges", (i + 1.0) / views))
            status = RELUME_ECANCEL;
    }
    for (int p = 0; !status && p < n; p++) {
        middle->minimum[p] = minimum[p];
        middle->maximum[p] = maximum[p];
    }
    return status;
}

// ---------------------------------------------------------------- the step

static double lost_from(const struct plan *plan, int planes)
{
    double lost = plan->lost;
    for (int i = planes; i < plan->planes; i++)
        lost += plan->energy[i];
    return lost;
}

// Than the error that trials see.
static double better(const struct published *f)
{
    return f->common.guided ? GUIDE_DB : 0.0;
}

static relume_status choose_usual(struct published *f, struct web_trials *t)
{
    if (decibels(t->plan->lost / 3.0) < USUAL_DB + USUAL_MARGIN)
        return web_step_unseen(&f->levels.step, &f->report->quality, t);
    t->all = f->usual = true;
    return web_step_of_psnr(&f->levels.step, t, USUAL_DB - better(f));
}

static relume_status choose_step(struct published *f, const struct planes *planes, int *kept)
{
    const struct relume_publish_params *p = f->site->params;
    struct web_trials t = {.plan = &f->common.plan,
                           .planes = planes,
                           .all = p->coefficients > 0,
                           .rough = true,
                           .threads = p->threads,
                           .log = f->site->log};
    double *step = &f->levels.step;
    relume_status status = RELUME_OK;
    f->report->quality = p->quality;
    if (p->bytes_per_pixel > 0.0)
        status = web_step_of_bytes(step, &t, p->bytes_per_pixel);
    else if (p->psnr_db > 0.0)
        status = web_step_of_psnr(step, &t, p->psnr_db - better(f));
    else if (p->quality)
        *step = web_step_of_quality(p->quality);
    else
        status = choose_usual(f, &t);
    struct web_folder w = {.plan = t.plan, .planes = planes};
    if (!status)
        status = web_encode(&w, *step, t.all, p->threads);
    *kept = status ? 0 : web_planes(&w);
    web_folder_free(&w);
    return status;
}

static relume_status find_step(struct published *f, const struct planes *middle)
{
    const double pixels = (double)middle->width * middle->height;
    const int every = (int)(pixels / TRIAL_PIXELS) + 1;
    struct planes sample = {0};
    int kept = 0;
    const bool own = every > 1 || f->common.guided;
    relume_status status =
        own ? planes_sample(&sample, middle, every, f->site->path, f->site->log) : RELUME_OK;
    if (!status && f->common.guided)
        guide_divide(&sample);
    if (!status)
        status = choose_step(f, own ? &sample : middle, &kept);
    if (!status) {
        common_keep(&f->common, kept);
        f->levels.planes = f->report->planes = kept;
        f->report->linear = f->common.source.coding.curve == RELUME_CURVE_LINEAR;
    }
    planes_free(&sample);
    return status;
}

static void weights_at(const void *user, struct relume_vec3 light, double *weights,
                       double constant[3])
{
    common_weights(user, light, weights, constant);
}

static relume_status measure(struct published *f, const struct planes *middle, uint8_t *codes)
{
    const struct foreign coded = {.width = middle->width,
                                  .height = middle->height,
                                  .form = FOREIGN_JOINT,
                                  .terms = f->levels.planes,
                                  .planes = f->levels.planes,
                                  .codes = codes,
                                  .scale = f->levels.scale,
                                  .offset = f->levels.offset,
                                  .knee = f->common.guided ? GUIDE_KNEE : 0.0f};
    const struct measure_weights how = {weights_at, &f->common};
    return measure_psnr(&f->report->psnr_db, &coded, &f->common.source, &how,
                        f->site->params->threads);
}

static relume_status scratch_failed(const struct published *f, size_t size)
{
    return errno == ENOMEM
               ? RELUME_ENOMEM
               : log_fail(f->site->params->log, RELUME_EIO,
                          "%s: no temporary file of %zu bytes can be made beside it; %s",
                          f->site->path, size, strerror(errno));
}

static relume_status give_up(const struct published *f, double found)
{
    const struct relume_publish_params *p = f->site->params;
    if (p->bytes_per_pixel > 0.0)
        return log_fail(f->site->log, RELUME_EUNFIT,
                        "%g bytes a pixel is too small; %.3f is possible", p->bytes_per_pixel,
                        found);
    return f->usual ? RELUME_OK
                    : log_fail(f->site->log, RELUME_EUNFIT,
                               "%g dB cannot be reached with %d planes; the best is %.2f dB",
                               p->psnr_db, f->levels.planes, f->report->psnr_db);
}

// Planes of the first picture.
static double first_most(const struct published *f)
{
    const double numbers = 3.0 * (f->levels.planes + 1) * f->common.functions;
    return fmax(FIRST_BYTES - PACKED_FLOAT * numbers, LEAST_BYTES);
}

// Many planes, or fine ones, are large at a size that is small for others: levels, each of which
// takes a third of the one before, until the last is small enough to be the first picture. `bytes`:
// of one view.
static void add_levels(struct published *f, uint64_t bytes)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    const int longer = larger_of(info->width, info->height);
    double last = (double)bytes * smaller_of(info->views, FIRST_VIEWS) /
                  pow(LEVEL_RATIO, f->levels.count - 1);
    for (; last > first_most(f) && longer >> f->levels.count >= LEAST_SIDE; last /= LEVEL_RATIO)
        f->levels.count++;
}

// Finer until the PSNR is reached that is wanted, coarser until the size is.
static relume_status correct_step(struct published *f, const struct planes *middle)
{
    const struct relume_publish_params *p = f->site->params;
    const size_t pixels = (size_t)middle->width * (size_t)middle->height;
    const double wanted = f->usual ? USUAL_DB - USUAL_SLACK : p->psnr_db;
    const size_t size = (size_t)f->levels.planes * pixels;
    uint8_t *codes = scratch_map(f->site->path, size);
    relume_status status = codes ? RELUME_OK : scratch_failed(f, size);
    const double first = f->levels.step;
    double before = 0.0, lacked = 0.0;
    for (int i = 0; !status; i++) {
        uint64_t bytes = 0;
        status = levels_try(middle, &f->levels, &bytes, codes);
        add_levels(f, bytes);
        if (!status)
            status = measure(f, middle, codes);
        const double found = (double)bytes / (double)pixels;
        const double lacks = wanted - f->report->psnr_db;
        const bool large = p->bytes_per_pixel > 0.0 && found > p->bytes_per_pixel;
        if (status || (!large && !(wanted > 0.0 && lacks > 0.0)))
            break;
        if (i == CORRECTIONS ||
            (!large && i && f->report->psnr_db - before < LEAST_GAIN * lacked)) {
            status = give_up(f, found);
            break;
        }
        before = f->report->psnr_db;
        lacked = lacks;
        f->levels.step *= large ? pow(found / p->bytes_per_pixel, 1.3) * 1.002
                                : pow(10.0, -(lacks + 0.05) / 12.0);
        if (f->usual)
            f->levels.step = fmax(f->levels.step, first / USUAL_FINER);
    }
    scratch_unmap(codes, size);
    return status;
}

// ---------------------------------------------------------------- tiles

static relume_status write_views(struct published *f, struct planes *middle, uint64_t *bytes,
                                 uint64_t *avif)
{
    const int views = relume_pack_info(f->pack)->views;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < views; i++) {
        const bool is_middle = i == middle_of(f);
        struct planes view = {0};
        char name[128];
        snprintf(name, sizeof name, "%s/v%d", f->name, i);
        if (!is_middle)
            status = planes_of(&view, f, i);
        if (!status)
            status = levels_write(f->site, name, is_middle ? middle : &view, &f->levels, bytes,
                                  avif, NULL);
        if (!status)
            status = layers_write(&f->layers[i], f->site, name, f->pack, i);
        if (!status)
            status = moving_write(&f->moving[i], f->site, name, f->pack, i);
        planes_free(is_middle ? middle : &view);
        if (!status && !log_progress(f->site->log, "tiles", (i + 1.0) / views))
            status = RELUME_ECANCEL;
    }
    return status;
}

// The finest that is small enough; of a slab an eye sees four views.
static void choose_first(struct published *f, const uint64_t *bytes)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    const uint64_t shown = (uint64_t)smaller_of(info->views, FIRST_VIEWS);
    int level = f->levels.count - 1;
    const double most = first_most(f);
    while (level > 0 && (double)(bytes[level - 1] * shown / (uint64_t)info->views) <= most)
        level--;
    f->first_level = level;
    f->report->first_bytes = bytes[level] * shown / (uint64_t)info->views;
}

static relume_status allocate(struct published *f)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    const size_t n = (size_t)f->common.plan.planes;
    f->layers = mem_zeroed((size_t)info->views, sizeof *f->layers);
    f->moving = mem_zeroed((size_t)info->views, sizeof *f->moving);
    f->minimum = mem_array(n, sizeof *f->minimum);
    f->maximum = mem_array(n, sizeof *f->maximum);
    f->levels = (struct levels){.planes = (int)n,
                                .guided = f->common.guided,
                                .layers = f->site->params->layers,
                                .count = levels_count(info->width, info->height, info->views),
                                .minimum = f->minimum,
                                .maximum = f->maximum,
                                .scale = mem_zeroed(n, sizeof *f->levels.scale),
                                .offset = mem_zeroed(n, sizeof *f->levels.offset),
                                .threads = f->site->params->threads};
    return f->layers && f->moving && f->minimum && f->maximum && f->levels.scale && f->levels.offset
               ? RELUME_OK
               : RELUME_ENOMEM;
}

static void forget(struct published *f)
{
    mem_free(f->layers);
    mem_free(f->moving);
    mem_free(f->minimum);
    mem_free(f->maximum);
    mem_free(f->levels.scale);
    mem_free(f->levels.offset);
    common_free(&f->common);
    f->layers = NULL;
    f->moving = NULL;
    f->minimum = f->maximum = NULL;
    f->levels = (struct levels){0};
}

static relume_status find_components(struct published *f, enum source_kind kind)
{
    const struct relume_publish_params *p = f->site->params;
    struct plan *plan = &f->common.plan;
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    // of linear light more planes of 8 bits are more noise
    const bool many = info->has_shadow || info->domain != RELUME_DOMAIN_LINEAR;
    const relume_status status = common_find(&f->common, f->pack, kind,
                                             p->coefficients ? p->coefficients
                                             : many          ? PUBLISH_MOST_PLANES
                                                             : PUBLISH_USUAL_PLANES,
                                             p->threads, f->site->log);
    if (!status && !p->coefficients && plan->planes > USUAL_PLANES &&
        decibels(lost_from(plan, USUAL_PLANES) / 3.0) >= USUAL_DB + USUAL_MARGIN)
        common_keep(&f->common, USUAL_PLANES);
    return status;
}

// Components, ranges and step of the file as a source of that kind.
static relume_status prepare(struct published *f, enum source_kind kind, struct planes *middle)
{
    relume_status status = find_components(f, kind);
    if (!status)
        status = allocate(f);
    if (!status)
        status = find_ranges(f, middle, f->minimum, f->maximum);
    if (!status)
        status = find_step(f, middle);
    return status ? status : correct_step(f, middle);
}

relume_status published_write(struct published *f)
{
    uint64_t bytes[LEVELS_MOST] = {0}, avif[LEVELS_MOST] = {0};
    struct planes middle = {0};
    relume_status status = prepare(f, SOURCE_WHOLE, &middle);
    const double poor =
        f->usual && relume_pack_info(f->pack)->has_shadow ? POOR_MOVING_DB : POOR_DB;
    if (!status && f->report->linear && f->report->psnr_db < poor) {
        planes_free(&middle);
        forget(f);
        f->usual = false;
        status = prepare(f, SOURCE_CODED, &middle);
    }
    if (!status)
        status = write_views(f, &middle, bytes, avif);
    if (!status)
        status = exposure_find(&f->exposure, f->pack, f->site);
    if (!status)
        status = relume_relief_find(
            &f->relief, f->pack,
            relume_relief_params(.log = f->site->log, .threads = f->site->params->threads));
    if (!status) {
        f->metered = true;
        choose_first(f, f->levels.layers == RELUME_PUBLISH_AVIF ? avif : bytes);
        for (int i = 0; i < LEVELS_MOST; i++) {
            f->report->bytes += bytes[i] + avif[i];
            f->report->avif_bytes += avif[i];
        }
        status = published_write_json(f);
    }
    planes_free(&middle);
    return status;
}

void published_free(struct published *f)
{
    forget(f);
    relume_relief_destroy(&f->relief);
    relume_pack_destroy(&f->pack);
}
