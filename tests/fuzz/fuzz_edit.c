// fuzz_edit.c - lists of edits made of noise, read and applied to a g-BRDF
#include "fuzz.h"

#include <relume/material/edit.h>

static const char *const words[] = {
    "relumeEdits", "fingerprint", "undone",    "operations", "operation", "emboss", "engrave",
    "roughness",   "tint",        "channels",  "swap",       "turn",      "label",  "add-material",
    "drawing",     "mask",        "height",    "at",         "size",      "factor", "factors",
    "degrees",     "r0",          "highlight", "labels",     "colour",    "GBR",    "packed",
    "width",       "AAAA",        "gQA=",      "//8=",       "1e308",     "-1",     "63",
    "[0, 1]",      "0.1",         "{",         "}",          ",",         NULL};

static relume_btf_fitted *planted;

// The folder stands for the g-BRDF: of that only its name counts.
static bool one(struct fuzz *f, struct bytes b)
{
    char path[160];
    relume_edits *edits;
    relume_btf_fitted *edited;
    snprintf(path, sizeof path, "%s/edits.json", f->folder);
    fuzz_store(path, b);
    if (relume_edits_open(&edits, f->folder, relume_btf_fitted_fingerprint(planted), NULL))
        return false;
    const bool fits = !relume_btf_fitted_edit(&edited, planted, edits, NULL);
    relume_btf_fitted_destroy(&edited);
    relume_edits_destroy(&edits);
    return fits;
}

// A picture of `n` x `n` levels.
static struct relume_image picture(int n)
{
    struct relume_image image;
    if (relume_image_create(&image, n, n, 1))
        abort();
    for (int i = 0; i < n * n; i++)
        image.data[i] = (float)(i % 5) / 4.0f;
    return image;
}

static void add(relume_edits *edits, const char *operation, const char *value,
                const char *parameter, const char *text, bool masked)
{
    const struct relume_edit_operation *o = relume_edit_operation_find(operation);
    struct relume_edit e = relume_edit_of(o);
    if (value ? relume_edit_set(&e, relume_edit_operation_parameter(o, 0), value, NULL)
              : (e.drawing = picture(4), 0))
        abort();
    if (masked)
        e.mask = picture(3);
    if ((parameter && relume_edit_set(&e, parameter, text, NULL)) ||
        relume_edits_add(edits, &e, NULL))
        abort();
    relume_edit_destroy(&e);
}

// All operations, a few at a time.
static void add_seeds(struct fuzz *f)
{
    char path[160];
    snprintf(path, sizeof path, "%s/edits.json", f->folder);
    for (int k = 0; k < 4; k++) {
        relume_edits *edits;
        if (relume_edits_create(&edits, relume_btf_fitted_fingerprint(planted)))
            abort();
        if (k == 0) {
            add(edits, "emboss", NULL, "at", "0.1,0.9", false);
            add(edits, "engrave", NULL, "size", "0.5", false);
        } else if (k == 1) {
            add(edits, "roughness", "0.5", "label", "1", false);
            add(edits, "tint", "1,0.5,2", NULL, NULL, true);
        } else if (k == 2) {
            add(edits, "channels", "GBR", "label", "0", false);
            add(edits, "swap", "0,2", NULL, NULL, true);
            add(edits, "turn", "90", NULL, NULL, false);
        } else {
            add(edits, "add-material", "0.4", "colour", "0.1,0.2,0.3", true);
            (void)relume_edits_undo(edits);
        }
        if (relume_edits_save(edits, f->folder, NULL))
            abort();
        relume_edits_destroy(&edits);
        fuzz_add(f, fuzz_load(path));
    }
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_edit", argc, argv);
    if (relume_gbrdf_plant(
            &planted,
            relume_gbrdf_plant_params(.size = 4, .directions = relume_btf_set_find("coarse"))))
        abort();
    add_seeds(&f);
    return fuzz_run(&f, argc, argv, one);
}
