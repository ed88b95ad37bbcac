// btf_report.c - the rows of `relume btf compare` and `eval`
#include "cli/materials/btf_report.h"

#include "cli/program/clock.h"

#include <math.h>

static void put_error(struct jwriter *w, const struct relume_btf_error *e)
{
    jput_number(w, "mae_avg", e->mean_avg, 9);
    jput_number(w, "mae_min", e->mean_min, 9);
    jput_number(w, "mae_max", e->mean_max, 9);
    jput_number(w, "rms", e->rms, 9);
    jput_number(w, "relative_rms", e->relative, 9);
    jput_number(w, "delta_e", e->delta_e, 9);
    jput_number(w, "ssim", e->ssim, 9);
}

static double bytes_per_texel(const struct relume_btf_fitted_info *info)
{
    return (double)info->bytes / ((double)info->width * info->height);
}

double btf_speed(const relume_btf_fitted *fitted)
{
    enum { BATCH = 256 };
    static const double LONG_ENOUGH_S = 0.1;
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(fitted);
    const double start = now_s();
    double taken = 0.0, count = 0.0;
    for (uint32_t n = 0; taken < LONG_ENOUGH_S; taken = now_s() - start)
        for (int i = 0; i < BATCH; i++, n++, count++) {
            // an even spread of texels and of directions down to 66 degrees from the pole
            const double a = 2.399963 * n, b = 1.7 * n, r = 0.91 * sqrt(n % 97 / 97.0);
            const double s = 0.91 * sqrt(n % 89 / 89.0);
            const struct relume_vec3 v = {r * cos(a), r * sin(a), sqrt(1.0 - r * r)};
            const struct relume_vec3 l = {s * cos(b), s * sin(b), sqrt(1.0 - s * s)};
            float rgb[3];
            relume_btf_fitted_evaluate(fitted, (int)(n * 7919u % (uint32_t)info->width),
                                       (int)(n * 104729u % (uint32_t)info->height), v, l, rgb);
        }
    return count / taken;
}

void btf_heading(bool held_out)
{
    printf("model   mean abs   min      max      RMS %%   rel. %%  dE2000  SSIM    bytes/texel"
           "   total MiB   fit s   ops       fetches   frames/s%s\n",
           held_out ? "   left out: mean   RMS %" : "");
}

// As many evaluations as a frame of the papers has pixels, on one processor.
static double frames_per_second(const struct btf_row *row)
{
    return row->evaluations / (1280.0 * 1024.0);
}

// What was not measured is a dash.
static const char *or_dash(char text[16], int digits, double value)
{
    if (isfinite(value))
        snprintf(text, 16, "%.*f", digits, value);
    else
        snprintf(text, 16, "-");
    return text;
}

void btf_print(const struct btf_row *row)
{
    const struct relume_btf_error *e = &row->error;
    char ops[16], fetches[16], delta_e[16], ssim[16], fit_s[16];
    snprintf(ops, sizeof ops, "%d+%d", row->cost.ops, row->cost.light_ops);
    snprintf(fetches, sizeof fetches, "%d+%d", row->cost.fetches, row->cost.light_fetches);
    printf("%-7s %-9.4f  %-7.4f  %-7.4f  %-6.2f  %-6.1f  %-6s  %-6s  %-12.1f  %-10.3f  %-6s"
           "  %-8s  %-8s  %-7.2g",
           relume_btf_model_name(row->info.model), e->mean_avg, e->mean_min, e->mean_max,
           100.0 * e->rms, 100.0 * e->relative, or_dash(delta_e, 2, e->delta_e),
           or_dash(ssim, 4, e->ssim), bytes_per_texel(&row->info),
           (double)row->info.bytes / 1048576.0, or_dash(fit_s, 1, row->fit_s), ops, fetches,
           frames_per_second(row));
    if (row->held_out)
        printf("            %-7.4f  %-6.2f", row->held_out->mean_avg, 100.0 * row->held_out->rms);
    printf("\n");
}

void btf_put_row(struct jwriter *w, const struct btf_row *row)
{
    jopen_object(w, NULL);
    jput_text(w, "model", relume_btf_model_name(row->info.model));
    put_error(w, &row->error);
    jput_integer(w, "bytes", (long long)row->info.bytes);
    jput_number(w, "bytes_per_texel", bytes_per_texel(&row->info), 9);
    jput_number(w, "fit_seconds", row->fit_s, 9);
    jput_integer(w, "ops", row->cost.ops);
    jput_integer(w, "fetches", row->cost.fetches);
    jput_integer(w, "light_ops", row->cost.light_ops);
    jput_integer(w, "light_fetches", row->cost.light_fetches);
    jput_number(w, "evaluations_per_second", row->evaluations, 9);
    jput_number(w, "frames_per_second", frames_per_second(row), 9);
    if (row->held_out) {
        jput_number(w, "left_out_mae", row->held_out->mean_avg, 9);
        jput_number(w, "left_out_rms", row->held_out->rms, 9);
    }
    jclose(w);
}
