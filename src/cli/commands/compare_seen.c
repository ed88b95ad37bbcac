// compare_seen.c - relume compare --metric jnd|vdp: preparing pictures, looking, telling
#include "cli/commands/compare_seen.h"

#include <math.h>

static bool is_same_size(const struct relume_image *a, const struct relume_image *b)
{
    return a->width == b->width && a->height == b->height;
}

// `b` as the camera of `a` would have seen it; where it does not reach does not count.
static relume_status align(const struct relume_image *a, struct relume_image *b,
                           struct relume_image *mask, const struct args *args)
{
    const struct relume_align_params *p =
        relume_align_params(.log = args->log, .threads = args->threads);
    struct relume_homography h;
    struct relume_image moved = {0}, valid = {0};
    relume_status status = relume_align_homography(&h, a, b, p);
    if (status == RELUME_EUNFIT || (!status && h.correlation < 0.3))
        return data_error("%s: cannot be aligned with %s; do both show one scene?", args->input[1],
                          args->input[0]);
    if (!status)
        status = relume_warp_homography(&moved, &valid, b, &h, p);
    if (!status) {
        relume_image_destroy(b);
        *b = moved;
        for (size_t i = 0; mask->data && i < (size_t)a->width * (size_t)a->height; i++)
            valid.data[i] = fminf(valid.data[i], mask->data[i]);
        relume_image_destroy(mask);
        *mask = valid;
    }
    return status;
}

static relume_status reduce(struct relume_image *image, int by, const struct args *args)
{
    struct relume_image small = {0};
    if (!image->data || by <= 1)
        return RELUME_OK;
    const int width = image->width / by, height = image->height / by;
    if (width < 1 || height < 1)
        return data_error("--reduce %d: leaves nothing of %d x %d pixels", by, image->width,
                          image->height);
    const relume_status status = relume_image_scale(&small, image, width, height,
                                                    relume_scale_params(.threads = args->threads));
    if (!status) {
        relume_image_destroy(image);
        *image = small;
    }
    return status;
}

static double grey_of(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static double mean_grey(const struct relume_image *image, const struct relume_image *mask)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    double sum = 0.0;
    size_t n = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (mask->data && !(mask->data[i] > 0.5f))
            continue;
        sum += grey_of(image->data + 3 * i);
        n++;
    }
    return n ? sum / (double)n : 0.0;
}

static void make_grey(struct relume_image *image, double scale)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        float *const v = image->data + 3 * i;
        v[0] = v[1] = v[2] = (float)(scale * grey_of(v));
    }
}

static relume_status load_mask(struct relume_image *mask, const struct relume_image *a,
                               const char *path, const struct args *args)
{
    const relume_status status =
        relume_image_load(mask, path, relume_image_params(.log = args->log, .channels = 1));
    if (!status && !is_same_size(mask, a))
        return data_error("%s: %d x %d pixels; expected %d x %d as in %s", path, mask->width,
                          mask->height, a->width, a->height, args->input[0]);
    return status;
}

relume_status compare_prepare(struct relume_image *a, struct relume_image *b,
                              struct relume_image *mask, const struct compare_look *look,
                              const struct args *args)
{
    double matrix[3][3];
    relume_status status = look->mask ? load_mask(mask, a, look->mask, args) : RELUME_OK;
    if (!status && look->align)
        status = align(a, b, mask, args);
    if (!status)
        status = reduce(a, look->reduce, args);
    if (!status)
        status = reduce(b, look->reduce, args);
    if (!status)
        status = reduce(mask, look->reduce, args);
    if (!status && look->colours) {
        status = relume_colours_fit(matrix, b, a, mask->data ? mask : NULL);
        if (status == RELUME_EUNFIT)
            return data_error("%s: black, or not finite; its colours cannot be fitted",
                              args->input[1]);
        if (!status)
            status = relume_colours_apply(b, (const double(*)[3])matrix);
    }
    if (!status && look->grey) {
        const double to = mean_grey(a, mask), from = mean_grey(b, mask);
        make_grey(a, 1.0);
        make_grey(b, from > 0.0 ? to / from : 1.0);
    }
    return status;
}

relume_status compare_look_at(struct compare_seen *seen, const struct relume_image *a,
                              const struct relume_image *b, const struct relume_image *mask,
                              const struct compare_look *look, const struct args *args)
{
    const struct relume_jnd_params *p =
        relume_jnd_params(.threads = args->threads, .pixels_per_degree = look->ppd,
                          .white = look->white, .mask = mask->data ? mask : NULL);
    return seen->metric == COMPARE_JND ? relume_image_jnd(&seen->jnd, &seen->map, b, a, p)
                                       : relume_image_vdp(&seen->vdp, &seen->map, b, a, p);
}

void compare_print_seen(const struct compare_seen *seen, bool json)
{
    const struct row {
        const char *name;
        double value;
    } jnd[] = {{"jnd_mean", seen->jnd.mean},
               {"jnd_99", seen->jnd.most},
               {"jnd_max", seen->jnd.max},
               {"seen", seen->jnd.seen}},
      vdp[] = {{"p75", seen->vdp.p75}, {"p95", seen->vdp.p95}, {"p_mean", seen->vdp.mean}};
    const struct row *rows = seen->metric == COMPARE_JND ? jnd : vdp;
    const size_t count =
        seen->metric == COMPARE_JND ? sizeof jnd / sizeof *jnd : sizeof vdp / sizeof *vdp;
    struct jwriter w = json_to(stdout);
    if (json)
        jopen_object(&w, NULL);
    for (size_t i = 0; i < count; i++) {
        if (json)
            jput_number(&w, rows[i].name, rows[i].value, 9);
        else
            printf("%-8s %.6g\n", rows[i].name, rows[i].value);
    }
    if (json)
        jend(&w);
}

// Between black, blue, green, yellow and red, in linear light.
static void colour_of(float rgb[3], float t)
{
    static const float stops[5][3] = {{0.0f, 0.0f, 0.0f},
                                      {0.02f, 0.1f, 0.6f},
                                      {0.02f, 0.5f, 0.1f},
                                      {0.9f, 0.7f, 0.0f},
                                      {0.9f, 0.03f, 0.0f}};
    const float at = 4.0f * fminf(fmaxf(t, 0.0f), 1.0f);
    const int i = at < 3.0f ? (int)at : 3;
    for (int c = 0; c < 3; c++)
        rgb[c] = stops[i][c] + (at - (float)i) * (stops[i + 1][c] - stops[i][c]);
}

relume_status compare_save_map(const struct compare_seen *seen, const char *path,
                               const struct args *args)
{
    const struct relume_image_params *save = relume_image_params(.log = args->log);
    const float red = seen->metric == COMPARE_JND ? 4.0f : 1.0f;
    struct relume_image picture;
    if (relume_image_saves_linear(path))
        return relume_image_save(&seen->map, path, save);
    relume_status status = relume_image_create(&picture, seen->map.width, seen->map.height, 3);
    for (size_t i = 0; !status && i < (size_t)picture.width * (size_t)picture.height; i++)
        colour_of(picture.data + 3 * i, seen->map.data[i] / red);
    if (!status)
        status = relume_image_save(&picture, path, save);
    relume_image_destroy(&picture);
    return status;
}

void compare_seen_free(struct compare_seen *seen)
{
    relume_image_destroy(&seen->map);
}
