// bracket.c - the photographs of one radiance map on their way through `relume hdr`
#include "cli/commands/bracket.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Shutters are off by 0.1 EV, their round names (1/60 for 1/64) by as much.
static const double clear_bias_ev = 0.2;

// ---------------------------------------------------------------- leaving out

// Errors of photographs that are left out are warnings.
static void say_softly(void *user, enum relume_level level, const char *text)
{
    const struct relume_log *log = user;
    log->message(log->user, level == RELUME_ERROR ? RELUME_WARNING : level, text);
}

// The log, or with --skip-bad one that says it so, which lives in `soft`.
static const struct relume_log *softly(struct relume_log *soft, const struct hdr_options *o)
{
    *soft = *o->args.log;
    soft->message = say_softly;
    soft->user = (void *)o->args.log;
    return o->skip_bad ? soft : o->args.log;
}

void bracket_drop(struct bracket *b, int i)
{
    relume_image_destroy(&b->codes[i]);
    relume_image_destroy(&b->masks[i]);
    b->anchor -= i < b->anchor;
    for (b->n--; i < b->n; i++) {
        b->path[i] = b->path[i + 1];
        b->notes[i] = b->notes[i + 1];
        b->codes[i] = b->codes[i + 1];
        b->masks[i] = b->masks[i + 1];
        b->exposure[i] = b->exposure[i + 1];
        b->shift[i] = b->shift[i + 1];
    }
    b->codes[b->n] = b->masks[b->n] = (struct relume_image){0};
}

relume_status bracket_remains(const struct bracket *b)
{
    return b->n > 0
               ? RELUME_OK
               : data_error("capture: none of the photographs can be used; expected at least one");
}

// ---------------------------------------------------------------- reading

relume_status bracket_load(struct bracket *b, const struct hdr_options *o)
{
    struct relume_log soft;
    const struct relume_log *log = softly(&soft, o);
    const struct relume_image *first = &b->codes[0];
    for (int i = 0; i < b->n;) {
        const struct relume_exif noted = b->notes[i];
        relume_status status =
            relume_photograph_load(&b->codes[i], &b->notes[i], b->path[i],
                                   relume_photograph_params(.log = log, .codes = true));
        b->notes[i].time_s = noted.time_s;
        b->notes[i].f_number = noted.f_number;
        b->notes[i].iso = noted.iso;
        const struct relume_image *image = &b->codes[i];
        if (!status && (image->width != first->width || image->height != first->height))
            status =
                say(log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as in %s", b->path[i],
                    image->width, image->height, first->width, first->height, b->path[0]);
        if (relume_status_is_input(status) && o->skip_bad)
            bracket_drop(b, i);
        else if (status)
            return status;
        else
            i++;
    }
    for (int i = 0; i < b->n; i++)
        b->exposure[i] = relume_exif_exposure(&b->notes[i]);
    return bracket_remains(b);
}

// ---------------------------------------------------------------- alignment

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median_shift(const struct relume_displacements *d)
{
    const size_t n = (size_t)d->columns * (size_t)d->rows;
    double *length = malloc(n * sizeof *length);
    if (!length)
        return 0.0;
    for (size_t i = 0; i < n; i++)
        length[i] = hypot((double)d->d[i][0], (double)d->d[i][1]);
    qsort(length, n, sizeof *length, ascending);
    const double median = length[n / 2];
    free(length);
    return median;
}

static double middle_shift(const struct relume_homography *h, double x, double y)
{
    const double z = h->m[2][0] * x + h->m[2][1] * y + h->m[2][2];
    return hypot((h->m[0][0] * x + h->m[0][1] * y + h->m[0][2]) / z - x,
                 (h->m[1][0] * x + h->m[1][1] * y + h->m[1][2]) / z - y);
}

static relume_status align_one(struct bracket *b, int i, enum align_mode mode,
                               const struct relume_align_params *params)
{
    struct relume_image *image = &b->codes[i], *anchor = &b->codes[b->anchor], warped = {0};
    struct relume_displacements field = {0};
    struct relume_homography h;
    relume_status status;
    if (mode == ALIGN_BLOCKS) {
        status = relume_align_blocks(&field, anchor, image, params);
        if (!status)
            status = relume_warp_displacements(&warped, &b->masks[i], image, &field, params);
        if (!status)
            b->shift[i] = median_shift(&field);
        relume_displacements_destroy(&field);
    } else {
        status = relume_align_homography(&h, anchor, image, params);
        if (!status)
            status = relume_warp_homography(&warped, &b->masks[i], image, &h, params);
        if (!status)
            b->shift[i] = middle_shift(&h, 0.5 * image->width, 0.5 * image->height);
    }
    if (!status) {
        relume_image_destroy(image);
        *image = warped;
    }
    return status;
}

relume_status bracket_align(struct bracket *b, const struct hdr_options *o)
{
    struct relume_log soft;
    const struct relume_log *log = softly(&soft, o);
    b->anchor = relume_align_anchor(b->codes, b->n);
    b->aligned = o->align != ALIGN_NONE;
    for (int i = 0; b->aligned && i < b->n; i++) {
        struct prefix_log about;
        if (i == b->anchor)
            continue;
        const relume_status status =
            align_one(b, i, o->align,
                      relume_align_params(.log = prefix_log(&about, log, b->path[i]),
                                          .threads = o->args.threads));
        if (relume_status_is_input(status) && o->skip_bad)
            bracket_drop(b, i--);
        else if (status)
            return status;
        if (!log->progress(o->args.log->user, "aligning", (i + 1.0) / b->n))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- merge

static relume_status find_response(struct bracket *b, const struct hdr_options *o)
{
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    const bool known = given(o, &o->transfer);
    bool all_linear = true;
    struct prefix_log log;
    if (o->response) {
        b->response_source = o->response;
        return relume_response_load(&b->response, o->response, o->args.log);
    }
    for (int i = 0; i < b->n; i++)
        all_linear &= b->notes[i].linear;
    if (known || all_linear) {
        relume_transfer_text(known ? o->transfer : linear, b->response_name,
                             sizeof b->response_name);
        b->response_source = b->response_name;
        relume_response_of(&b->response, known ? o->transfer : linear);
        return RELUME_OK;
    }
    b->response_source = "recovered";
    return relume_response_recover(
        &b->response, b->codes, b->exposure, b->n,
        relume_recover_params(.log = prefix_log(&log, o->args.log, b->path[0]), .masks = b->masks));
}

// The last code that says nothing in any channel, as a part of full scale.
static double black_level(const struct relume_response *response)
{
    int last = 0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < RELUME_CODES && !(response->exposure[c][i] > 0.0f); i++)
            last = i > last ? i : last;
    return (double)last / (RELUME_CODES - 1);
}

static void combine(struct relume_image *mask, const struct relume_image *ghosts, double *part)
{
    const size_t pixels = (size_t)ghosts->width * (size_t)ghosts->height;
    double good = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        good += (double)ghosts->data[i];
        mask->data[i] *= ghosts->data[i];
    }
    *part = 1.0 - good / (double)pixels;
}

static relume_status leave_out_ghosts(struct bracket *b, double black, const struct hdr_options *o)
{
    struct relume_image ghosts[MAX_BRACKET];
    relume_status status = relume_ghost_masks(
        ghosts, b->codes, b->exposure, b->n, b->anchor,
        relume_ghost_params(.log = o->args.log, .threads = o->args.threads, .black = black));
    for (int i = 0; !status && i < b->n; i++) {
        if (b->masks[i].data) {
            combine(&b->masks[i], &ghosts[i], &b->ghosts[i]);
            relume_image_destroy(&ghosts[i]);
        } else {
            combine(&ghosts[i], &ghosts[i], &b->ghosts[i]);
            b->masks[i] = ghosts[i];
        }
    }
    return status;
}

// A response that was recovered may show a black level: below it all values look the same.
static relume_status find_response_and_ghosts(struct bracket *b, const struct hdr_options *o)
{
    const double dark = 0.05;
    relume_status status = find_response(b, o);
    if (status || !o->ghosts)
        return status;
    status = leave_out_ghosts(b, dark + black_level(&b->response), o);
    return status || strcmp(b->response_source, "recovered") != 0 ? status : find_response(b, o);
}

// The worst alone: where the curve is not known, an error of one time goes over into the curve and
// from there to the others' times, in part.
static void report_bias(const struct bracket *b, const struct hdr_options *o)
{
    int worst = 0, wrong = 0;
    double most = clear_bias_ev;
    for (int i = 0; i < b->n; i++) {  // no bias is known of what nothing overlaps: NaN
        const double bias = fabs(b->report[i].bias_ev);
        wrong += bias > clear_bias_ev;
        if (bias > most) {
            most = bias;
            worst = i;
        }
    }
    if (!wrong)
        return;
    const double time_s = b->notes[worst].time_s;
    announce(&o->args, RELUME_WARNING,
             "%s: its exposure time is given as %.4g s; its brightness fits %.4g s%s",
             b->path[worst], time_s, time_s * exp2(b->report[worst].bias_ev),
             wrong > 1 ? "; other times are wrong as well, by less" : "");
}

// Numbers of a float file do not end at 1: nothing is saturated there, and above 1, where the merge
// knows no codes, the shortest exposure says what there is.
static void continue_floats(struct bracket *b)
{
    int shortest = -1;
    for (int i = 0; i < b->n; i++) {
        if (!b->notes[i].floats)
            continue;
        b->report[i].saturated = 0.0;
        if (shortest < 0 || b->exposure[i] < b->exposure[shortest])
            shortest = i;
    }
    if (shortest < 0 || strcmp(b->response_source, "linear") != 0)
        return;
    const struct relume_image *mask = &b->masks[shortest], *codes = &b->codes[shortest];
    const size_t samples = 3 * (size_t)codes->width * (size_t)codes->height;
    for (size_t i = 0; i < samples; i++)
        if (codes->data[i] > 1.0f && !(mask->data && mask->data[i / 3] < 0.5f))
            b->out.data[i] = (float)((double)codes->data[i] / b->exposure[shortest]);
}

relume_status bracket_merge(struct bracket *b, const struct hdr_options *o)
{
    struct prefix_log log;
    relume_status status = find_response_and_ghosts(b, o);
    if (!status && o->save_response)
        status = relume_response_save(&b->response, o->save_response, o->args.log);
    if (!status)
        status = relume_merge(&b->out, b->report, b->codes, b->exposure, b->n, &b->response,
                              relume_merge_params(.log = prefix_log(&log, o->args.log, b->path[0]),
                                                  .weights = o->weights, .masks = b->masks,
                                                  .threads = o->args.threads));
    if (status)
        return status;
    continue_floats(b);
    report_bias(b, o);
    if (b->notes[b->anchor].profile)
        relume_primaries_apply(&b->out, b->notes[b->anchor].to_srgb);
    return RELUME_OK;
}

void bracket_free(struct bracket *b)
{
    for (int i = 0; i < MAX_BRACKET; i++) {
        relume_image_destroy(&b->codes[i]);
        relume_image_destroy(&b->masks[i]);
    }
    relume_image_destroy(&b->out);
}
