// bracket_check.c - whether the exposures show one scene, and times fit their brightness
#include "cli/commands/bracket.h"

#include <math.h>

enum { THUMB = 320 };
static const double least_similarity = 0.15;
static const double at_the_ends = 0.995;  // share of samples black or saturated: shows nothing
static const double clear_ratio = 1.4, clear_codes = 0.02;  // longer must not be darker

static relume_status shrink(struct relume_image *out, const struct relume_image *image)
{
    const int longer = image->width > image->height ? image->width : image->height;
    const int step = (longer + THUMB - 1) / THUMB;
    const relume_status status =
        relume_image_create(out, image->width / step, image->height / step, 3);
    if (status)
        return status;
    for (int y = 0; y < out->height * step; y++)
        for (int x = 0; x < out->width * step; x++)
            for (int c = 0; c < 3; c++)
                out->data[3 * (y / step * out->width + x / step) + c] +=
                    image->data[3 * ((size_t)y * (size_t)image->width + (size_t)x) + (size_t)c] /
                    (float)(step * step);
    return RELUME_OK;
}

static double mean_code(const struct relume_image *codes)
{
    const size_t samples = 3 * (size_t)codes->width * (size_t)codes->height;
    double sum = 0.0;
    for (size_t i = 0; i < samples; i++)
        sum += (double)codes->data[i];
    return sum / (double)samples;
}

// Float files do not end at 1.
static bool shows_nothing(const struct relume_image *codes, bool floats)
{
    const size_t samples = 3 * (size_t)codes->width * (size_t)codes->height;
    size_t ends = 0;
    for (size_t i = 0; i < samples; i++)
        ends += (!floats && codes->data[i] >= 0.995f) || codes->data[i] <= 0.005f;
    return (double)ends > at_the_ends * (double)samples;
}

// One exposure that is white or black all over does no harm; a bracket of them shows no scene.
static relume_status check_exposure(const struct bracket *b, bool *blank)
{
    int blanks = 0;
    for (int i = 0; i < b->n; i++)
        blanks += blank[i] = shows_nothing(&b->codes[i], b->notes[i].floats);
    if (b->n < 2 || blanks < b->n)
        return RELUME_OK;
    const bool white = mean_code(&b->codes[0]) > 0.5;
    return data_error("%s: %s, as are the other %d exposures; expected %s ones", b->path[0],
                      white ? "saturated" : "black", b->n - 1, white ? "shorter" : "longer");
}

// Exposures next to each other show the same edges; so do the next but one. Where one of them is
// blank there are none to compare.
static relume_status check_scene(struct bracket *b, const int *order, const bool *blank,
                                 const struct hdr_options *o)
{
    struct relume_image thumb[MAX_BRACKET] = {{0}};
    double similarity[MAX_BRACKET];
    relume_status status = RELUME_OK;
    int foreign = -1;
    for (int i = 0; !status && i < b->n; i++)
        status = shrink(&thumb[i], &b->codes[order[i]]);
    for (int i = 0; i < b->n; i++)
        similarity[i] = (double)NAN;
    for (int i = 0; !status && i < b->n; i++)
        for (int j = i + 1; j < b->n && j <= i + 2; j++) {
            if (blank[order[i]] || blank[order[j]])
                continue;
            const double l = relume_edge_correlation(&thumb[i], &thumb[j]);
            similarity[i] = fmax(similarity[i], l);
            similarity[j] = fmax(similarity[j], l);
        }
    for (int i = 0; !status && b->n > 1 && i < b->n; i++)
        if (similarity[i] < least_similarity &&
            (foreign < 0 || similarity[i] < similarity[foreign]))
            foreign = i;
    for (int i = 0; i < b->n; i++)
        relume_image_destroy(&thumb[i]);
    if (status || foreign < 0)
        return status;
    const char *path = b->path[order[foreign]];
    const bool all_hang_on_it = b->aligned && order[foreign] == b->anchor;
    if (!o->skip_bad || all_hang_on_it)
        return data_error(
            "%s: shows another scene than the other exposures, or the camera moved (similarity "
            "%.2f; expected %.2f or more); leave it out, or try --align or --skip-bad",
            path, similarity[foreign], least_similarity);
    announce(&o->args, RELUME_WARNING,
             "%s: shows another scene than the other exposures (similarity %.2f); left out", path,
             similarity[foreign]);
    bracket_drop(b, order[foreign]);
    if (!b->aligned)
        b->anchor = relume_align_anchor(b->codes, b->n);
    return bracket_remains(b);
}

static relume_status check_order(const struct bracket *b, const int *order)
{
    double mean[MAX_BRACKET];
    for (int i = 0; i < b->n; i++)
        mean[i] = mean_code(&b->codes[order[i]]);
    for (int i = 0; i + 1 < b->n; i++)
        if (b->exposure[order[i + 1]] > clear_ratio * b->exposure[order[i]] &&
            mean[i + 1] < mean[i] - clear_codes)
            return data_error("%s: darker than %s though its exposure is %.3g times as long; give "
                              "the true exposure times with --times",
                              b->path[order[i + 1]], path_name(b->path[order[i]]),
                              b->exposure[order[i + 1]] / b->exposure[order[i]]);
    return RELUME_OK;
}

static void sort_by_exposure(const struct bracket *b, int *order)
{
    for (int i = 0; i < b->n; i++) {
        int at = i;
        for (; at > 0 && b->exposure[order[at - 1]] > b->exposure[i]; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

relume_status bracket_check(struct bracket *b, const struct hdr_options *o)
{
    int order[MAX_BRACKET];
    bool blank[MAX_BRACKET];
    sort_by_exposure(b, order);
    const int before = b->n;
    relume_status status = check_exposure(b, blank);
    if (!status)
        status = check_scene(b, order, blank, o);
    if (!status && b->n < before)
        sort_by_exposure(b, order);
    return status ? status : check_order(b, order);
}
