// capture_hdr.c - relume capture --hdr: exposures of one picture become one radiance map
#include "capture_hdr.h"

#include "capture_times.h"
#include "photo_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status capture_hdr(const struct args *args)
{
    struct photo_list list;
    relume_status status = photo_list_make(&list, args);
    if (status)
        return status;
    const int n = list.count;
    struct relume_notes *notes = calloc((size_t)n, sizeof *notes);
    struct relume_image *codes = calloc((size_t)n, sizeof *codes);
    double *t = calloc((size_t)n, sizeof *t);
    for (int i = 0; !status && i < n; i++)
        status =
            relume_photograph_load(&codes[i], &notes[i], list.path[i],
                                   relume_photograph_params(.log = args_log(args), .codes = true));
    if (!status && args_has(args, "--times"))
        status = read_times(args_text(args, "--times", NULL), &list, notes);
    for (int i = 0; i < n; i++)
        t[i] = relume_notes_exposure(&notes[i]);
    struct relume_response r;
    if (!status)
        status =
            relume_response_recover(&r, codes, t, n, relume_recover_params(.log = args_log(args)));
    if (!status && args_has(args, "--save-response"))
        status = relume_response_save(&r, args_text(args, "--save-response", NULL), args_log(args));
    struct relume_image out;
    enum relume_merge_weights w;
    struct relume_exposure_report *rep = calloc((size_t)n, sizeof *rep);
    if (!status)
        status = relume_merge_weights_parse(&w, args_text(args, "--weights", "spline"));
    if (!status)
        status = relume_merge(&out, rep, codes, t, n, &r,
                              relume_merge_params(.log = args_log(args), .weights = w));
    for (int i = 0; !status && i < n; i++)
        printf("%s %g res %.4f bias %.4f noise %.4f sat %.3f black %.3f used %.3f\n",
               base_name(list.path[i]), t[i], rep[i].residual_ev, rep[i].bias_ev, rep[i].noise_ev,
               rep[i].saturated, rep[i].black, rep[i].used);
    if (!status)
        status = relume_image_save(&out, args_text(args, "-o", NULL),
                                   relume_image_params(.log = args_log(args)));
    return status;
}
