#include "btf_report.h"

static void member(const char *name, double value)
{
    printf(", \"%s\": ", name);
    json_number(stdout, value);
}

static void members(const struct relume_btf_error *e)
{
    member("mae_avg", e->mean_avg);
    member("mae_min", e->mean_min);
    member("mae_max", e->mean_max);
    member("rms", e->rms);
    member("relative_rms", e->relative);
    member("delta_e", e->delta_e);
    member("ssim", e->ssim);
}

static double bytes_per_texel(const struct relume_btf_fitted_info *info)
{
    return (double)info->bytes / ((double)info->width * info->height);
}

void btf_heading(bool held_out)
{
    printf("model   mean abs   min      max      RMS %%   rel. %%  dE2000  SSIM    bytes/texel"
           "   total MiB   fit s%s\n",
           held_out ? "   left out: mean   RMS %" : "");
}

void btf_row(const struct relume_btf_fitted_info *info, const struct relume_btf_error *e,
             double fit_s, const struct relume_btf_error *held_out)
{
    printf("%-7s %-9.4f  %-7.4f  %-7.4f  %-6.2f  %-6.1f  %-6.2f  %-6.4f  %-12.1f  %-10.3f  %-6.1f",
           relume_btf_model_name(info->model), e->mean_avg, e->mean_min, e->mean_max,
           100.0 * e->rms, 100.0 * e->relative, e->delta_e, e->ssim, bytes_per_texel(info),
           (double)info->bytes / 1048576.0, fit_s);
    if (held_out)
        printf("           %-7.4f  %-6.2f", held_out->mean_avg, 100.0 * held_out->rms);
    printf("\n");
}

void btf_json_row(const struct relume_btf_fitted_info *info, const struct relume_btf_error *e,
                  double fit_s, const struct relume_btf_error *held_out)
{
    printf("{\"model\": \"%s\"", relume_btf_model_name(info->model));
    members(e);
    printf(", \"bytes\": %llu", (unsigned long long)info->bytes);
    member("bytes_per_texel", bytes_per_texel(info));
    member("fit_seconds", fit_s);
    if (held_out) {
        member("left_out_mae", held_out->mean_avg);
        member("left_out_rms", held_out->rms);
    }
    printf("}");
}
