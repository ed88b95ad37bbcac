// btf_edit.c - relume btf edit and make: g-BRDFs that people change and make
#include "cli/materials/btf_inputs.h"
#include "cli/edit_options.h"

struct btf_edit_options {
    struct args args;
    const char *output;
    bool force;
    struct edit_options edit;
};
#define OPTIONS struct btf_edit_options

static const struct option edit_options[] = {
    EDIT_OPTIONS,
    TEXT("--label", edit.text, "K",
         "roughness, tint, channels, turn: only the material of this label; default: all"),
    GROUP("operations"),
    TEXT("--swap", edit.text, "A,B", "exchange two materials, by their labels"),
    TEXT("--turn", edit.text, "DEG", "turn brushed materials, counter-clockwise"),
    EDIT_LIST_OPTIONS,
    GROUP("output"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "OUT",
            "also write the edited g-BRDF as one that has no list: a folder or an .exr file"),
    FLAG("--force", force, "replace a folder that relume made"),
    {0},
};
#undef OPTIONS

static relume_status end_edit(const struct btf_edit_options *o, const relume_btf_fitted *model,
                              const relume_edits *edits)
{
    relume_btf_fitted *edited;
    relume_status status = relume_btf_fitted_edit(&edited, model, edits, o->args.log);
    if (!status && o->output)
        status = relume_btf_fitted_save(edited, o->output,
                                        relume_btf_params(.log = o->args.log, .force = o->force));
    relume_btf_fitted_destroy(&edited);
    return status ? status : edit_list_end(edits, &o->args, &o->edit);
}

static relume_status run_edit(const struct args *args)
{
    struct btf_edit_options o = *(const struct btf_edit_options *)(const void *)args;
    relume_btf_fitted *model = NULL;
    relume_edits *edits = NULL;
    o.edit.list |= !o.output && !edit_is_asked(args, &o.edit);
    relume_status status = o.output && !btf_is_model_file(o.output)
                               ? relume_folder_check(o.output, o.force, args->log)
                               : RELUME_OK;
    if (!status)
        status = relume_btf_fitted_open(&model, args->input[0],
                                        relume_btf_params(.log = args->log, .unedited = true));
    if (!status)
        status = edit_list_of_line(&edits, relume_btf_fitted_fingerprint(model), args, &o.edit);
    if (!status)
        status = end_edit(&o, model, edits);
    relume_edits_destroy(&edits);
    relume_btf_fitted_destroy(&model);
    return status;
}

const struct command btf_task_edit = {
    .name = "btf edit",
    .usage = "MODEL [OPTION ...]",
    .summary = "change a g-BRDF by a list of edits that is kept with it",
    .example = "relume btf edit planted.exr --roughness 0.6 --label 1 --tint 1,0.8,0.6",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = edit_options,
    .size = sizeof(struct btf_edit_options),
    .run = run_edit,
};

// ---------------------------------------------------------------- from photographs

struct make_options {
    struct args args;
    const char *output;
    bool force;
    int width;
    double relief, roughness, r0, turn;
    struct relume_vec3 shine;
};
#define OPTIONS struct make_options

static const struct option make_options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "the folder to make, or an .exr file"),
    FLAG("--force", force, "replace a folder that relume made"),
    GROUP("material"),
    INT("--width", width, "N",
        "width in texels; default: that of the first photograph, at most 256", 1, 1024),
    NUMBER("--relief", relief, "H",
           "height of white over black in the second photograph, in widths; default: 0.03", 1e-6,
           1),
    NUMBER("--roughness", roughness, "R", "roughness of the highlight (GGX); default: 0.5", 0.1, 1),
    NUMBER("--r0", r0, "R", "reflectance at normal incidence; default: 0.04", 1e-6, 1),
    NUMBER("--turn", turn, "DEG", "turn of the material, the same everywhere; default: 0", -3600,
           3600),
    POINT("--highlight", shine, "R,G,B", "colour of the highlight; default: 1,1,1"),
    {0},
};

static relume_status make(relume_btf_fitted **out, const struct make_options *o)
{
    const struct args *args = &o->args;
    struct relume_image colour = {.width = 0}, height = {.width = 0};
    relume_status status =
        relume_image_load(&colour, args->input[0], relume_image_params(.log = args->log));
    // heights are what a picture's numbers say
    if (!status)
        status = relume_image_load(&height, args->input[1],
                                   relume_image_params(.log = args->log, .channels = 1,
                                                       .transfer = {RELUME_CURVE_LINEAR}));
    if (!status)
        status = relume_gbrdf_make(
            out, &colour, &height,
            relume_gbrdf_make_params(.log = args->log, .width = o->width, .relief = o->relief,
                                     .roughness = o->roughness, .r0 = o->r0,
                                     .turn_degrees = o->turn, .shine = o->shine));
    relume_image_destroy(&colour);
    relume_image_destroy(&height);
    return status;
}

static relume_status run_make(const struct args *args)
{
    const struct make_options *o = (const void *)args;
    relume_btf_fitted *made = NULL;
    relume_status status = btf_is_model_file(o->output)
                               ? RELUME_OK
                               : relume_folder_check(o->output, o->force, args->log);
    if (!status)
        status = make(&made, o);
    if (!status)
        status = relume_btf_fitted_save(made, o->output,
                                        relume_btf_params(.log = args->log, .force = o->force));
    relume_btf_fitted_destroy(&made);
    return status;
}

const struct command btf_task_make = {
    .name = "btf make",
    .usage = "COLOUR HEIGHT -o OUT [OPTION ...]",
    .summary = "make a g-BRDF from two photographs: its colour, and its relief in grey",
    .example = "relume btf make planks.jpg planks-height.png -o planks.exr --relief 0.02",
    .min_inputs = 2,
    .max_inputs = 2,
    .options = make_options,
    .size = sizeof(struct make_options),
    .run = run_make,
};
