// maps_edit.c - relume maps edit: folders of maps that people change
#include "cli/materials/maps_edit.h"

#include "cli/edit_options.h"

struct maps_edit_options {
    struct args args;
    const char *output;
    int mesh;
    bool force, directx;
    struct edit_options edit;
};
#define OPTIONS struct maps_edit_options

static const struct option options[] = {
    EDIT_OPTIONS,
    EDIT_LIST_OPTIONS,
    GROUP("output"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "DIR", "write the edited maps into this folder"),
    FLAG("--force", force, "replace a folder that relume made"),
    FLAG("--directx", directx,
         "normal.png with green pointing down, as DirectX programs want it; default: as it was"),
    INT("--mesh", mesh, "N",
        "model.gltf: a mesh of N columns displaced by the height; default: a plane", 1, 1024),
    {0},
};

static relume_status run_maps_edit(const struct args *args)
{
    struct maps_edit_options o = *(const struct maps_edit_options *)(const void *)args;
    struct relume_maps maps = {0};
    relume_edits *edits = NULL;
    o.edit.list |= !o.output && !edit_is_asked(args, &o.edit);
    if (!o.output && (o.directx || o.mesh))
        return usage_error("--directx and --mesh are about what is written; expected -o DIR");
    relume_status status = o.output ? relume_folder_check(o.output, o.force, args->log) : RELUME_OK;
    if (!status)
        status = relume_maps_open(&maps, args->input[0], args->log);
    if (!status)
        status = edit_list_of_line(&edits, relume_maps_fingerprint(&maps), args, &o.edit);
    if (!status)
        status = relume_maps_edit(&maps, edits, args->threads, args->log);
    if (!status && o.output)
        status = relume_maps_write(
            &maps, o.output,
            relume_maps_write_params(.log = args->log, .threads = args->threads, .force = o.force,
                                     .directx = o.directx, .mesh = o.mesh));
    if (!status)
        status = edit_list_end(edits, args, &o.edit);
    relume_edits_destroy(&edits);
    relume_maps_destroy(&maps);
    return status;
}

const struct command maps_task_edit = {
    COMMAND(run_maps_edit, "maps edit", "DIR [-o DIR] [OPTION ...]",
            "change maps by a list of edits that is kept with them",
            "relume maps edit statue-maps --tint 1,0.9,0.7 -o statue-gold", 1, 1),
};
