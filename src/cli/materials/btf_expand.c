// btf_expand.c - relume btf plant and expand: values out of models
#include "cli/materials/btf_inputs.h"

relume_status btf_check_model_output(const struct btf_options *o)
{
    // a file appears whole or not at all without asking
    return btf_is_model_file(o->output) ? RELUME_OK
                                        : relume_folder_check(o->output, o->force, o->args.log);
}

relume_status btf_plant(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf_fitted *planted = NULL;
    relume_status status = btf_check_model_output(o);
    if (!status)
        status = relume_gbrdf_plant(&planted,
                                    relume_gbrdf_plant_params(.log = args->log, .size = o->size,
                                                              .directions = o->directions,
                                                              .seed = (uint64_t)o->seed));
    if (!status)
        status = relume_btf_fitted_save(planted, o->output,
                                        relume_btf_params(.log = args->log, .force = o->force));
    relume_btf_fitted_destroy(&planted);
    return status;
}

relume_status btf_expand(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf_fitted *model = NULL;
    relume_btf *btf = NULL;
    relume_status status = relume_folder_check(o->output, o->force, args->log);
    if (!status)
        status =
            relume_btf_fitted_open(&model, args->input[0], relume_btf_params(.log = args->log));
    if (!status)
        status = relume_btf_expand(&btf, model,
                                   relume_btf_params(.log = args->log, .threads = args->threads));
    if (!status)
        status =
            relume_btf_save(btf, o->output, relume_btf_params(.log = args->log, .force = o->force));
    relume_btf_fitted_destroy(&model);
    relume_btf_destroy(&btf);
    return status;
}
