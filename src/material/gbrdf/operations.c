// operations.c - what can be done to a material, and what it takes
#include "material/gbrdf/operations.h"

#include "core/base/log.h"
#include "material/gbrdf/edit_table.h"
#include "material/gbrdf/on_maps.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define NUMBERS(called, member, n, low, high, shape)                                               \
    {                                                                                              \
        .name = called, .kind = PARAMETER_NUMBERS, .count = n,                                     \
        .offset = offsetof(struct relume_edit, member), .least = low, .most = high, .form = shape  \
    }
#define PICTURE(called, member, may)                                                               \
    {                                                                                              \
        .name = called, .kind = PARAMETER_PICTURE, .offset = offsetof(struct relume_edit, member), \
        .optional = may, .form = "a picture"                                                       \
    }

static const struct edit_parameter
    drawing = PICTURE("drawing", drawing, false),
    mask = PICTURE("mask", mask, true),
    height = NUMBERS("height", height, 1, 1e-6, 1.0, "widths of the sample, up to 1"),
    at = NUMBERS("at", at, 2, 0.0, 1.0, "X,Y, each 0 to 1"),
    size = NUMBERS("size", size, 1, 1e-4, 1.0, "widths of the sample, up to 1"),
    factor = NUMBERS("factor", factor, 1, 0.1, 10.0, "0.1 to 10"),
    factors = NUMBERS("factors", factors, 3, 0.0, 16.0, "R,G,B, each 0 to 16"),
    degrees = NUMBERS("degrees", degrees, 1, -3600.0, 3600.0, "degrees, -3600 to 3600"),
    roughness = NUMBERS("roughness", roughness, 1, 0.1, 1.0, "0.1 to 1"),
    r0 = NUMBERS("r0", r0, 1, 0.0, 1.0, "0 to 1"),
    highlight = NUMBERS("highlight", highlight, 3, 0.0, 1.0, "R,G,B, each 0 to 1"),
    colour = {.name = "colour",
              .kind = PARAMETER_NUMBERS,
              .count = 3,
              .offset = offsetof(struct relume_edit, colour),
              .most = 1.0,
              .optional = true,
              .form = "R,G,B, each 0 to 1"},
    channels = {.name = "channels",
                .kind = PARAMETER_CHANNELS,
                .offset = offsetof(struct relume_edit, channels),
                .form = "three of R, G and B, as GBR"},
    labels = {.name = "labels",
              .kind = PARAMETER_LABELS,
              .count = 2,
              .offset = offsetof(struct relume_edit, labels),
              .form = "two different labels, as 0,2"},
    label = {.name = "label",
             .kind = PARAMETER_LABELS,
             .count = 1,
             .offset = offsetof(struct relume_edit, label),
             .optional = true,
             .form = "a label, from 0"};

static const struct relume_edit_operation
    emboss = {"emboss",
              "raise a drawing",
              {&drawing, &height, &at, &size},
              gbrdf_emboss,
              maps_emboss},
    engrave = {"engrave",
               "sink a drawing",
               {&drawing, &height, &at, &size},
               gbrdf_engrave,
               maps_engrave},
    rougher = {"roughness",
               "multiply the roughness",
               {&factor, &label, &mask},
               gbrdf_roughness,
               maps_roughness},
    tint = {"tint", "multiply the colours", {&factors, &label, &mask}, gbrdf_tint, maps_tint},
    permute = {"channels",
               "exchange red, green and blue",
               {&channels, &label, &mask},
               gbrdf_channels,
               maps_channels},
    swap = {"swap", "exchange two materials", {&labels, &mask}, gbrdf_swap, NULL},
    turn = {"turn", "turn brushed materials", {&degrees, &label, &mask}, gbrdf_turn, NULL},
    add = {"add-material",
           "lay a synthetic material on",
           {&roughness, &r0, &colour, &highlight, &mask},
           gbrdf_add_material,
           maps_add_material};

const struct relume_edit_operation *const relume_edit_operations[] = {
    &emboss, &engrave, &rougher, &tint, &permute, &swap, &turn, &add, NULL};

const struct relume_edit_operation *relume_edit_operation_find(const char *name)
{
    for (const struct relume_edit_operation *const *o = relume_edit_operations; *o; o++)
        if (!strcmp((*o)->name, name))
            return *o;
    return NULL;
}

const char *relume_edit_operation_name(const struct relume_edit_operation *operation)
{
    return operation->name;
}

const char *relume_edit_operation_summary(const struct relume_edit_operation *operation)
{
    return operation->summary;
}

bool relume_edit_operation_on_maps(const struct relume_edit_operation *operation)
{
    return operation->maps != NULL;
}

const char *relume_edit_operation_parameter(const struct relume_edit_operation *operation, int i)
{
    for (int k = 0; k < MOST_PARAMETERS && operation->parameter[k]; k++)
        if (k == i)
            return operation->parameter[k]->name;
    return NULL;
}

const struct edit_parameter *operation_parameter(const struct relume_edit_operation *o,
                                                 const char *name)
{
    for (int k = 0; k < MOST_PARAMETERS && o->parameter[k]; k++)
        if (!strcmp(o->parameter[k]->name, name))
            return o->parameter[k];
    return NULL;
}

struct relume_edit relume_edit_of(const struct relume_edit_operation *operation)
{
    return (struct relume_edit){
        .operation = operation,
        .height = 0.02,
        .at = {0.5, 0.5},
        .size = 1.0,
        .factor = (double)NAN,
        .factors = {(double)NAN, (double)NAN, (double)NAN},
        .labels = {-1, -1},
        .degrees = (double)NAN,
        .roughness = (double)NAN,
        .r0 = 0.04,
        .colour = {(double)NAN, (double)NAN, (double)NAN},
        .highlight = {1.0, 1.0, 1.0},
        .label = -1,
    };
}

void relume_edit_destroy(struct relume_edit *edit)
{
    relume_image_destroy(&edit->drawing);
    relume_image_destroy(&edit->mask);
}

// ---------------------------------------------------------------- values

bool parameter_given(const struct edit_parameter *p, const struct relume_edit *edit)
{
    const void *value = parameter_of(p, edit);
    switch (p->kind) {
    case PARAMETER_NUMBERS:
        for (int i = 0; i < p->count; i++)
            if (!isnan(((const double *)value)[i]))
                return true;
        return false;
    case PARAMETER_LABELS: return *(const int *)value != -1;
    case PARAMETER_CHANNELS: return *(const char *)value != '\0';
    case PARAMETER_PICTURE: return ((const struct relume_image *)value)->data != NULL;
    }
    return false;
}

static bool numbers_are_good(const struct edit_parameter *p, const double *v)
{
    for (int i = 0; i < p->count; i++)
        if (!(v[i] >= p->least && v[i] <= p->most))
            return false;
    return true;
}

static bool labels_are_good(const struct edit_parameter *p, const int *v)
{
    for (int i = 0; i < p->count; i++)
        if (v[i] < 0 || v[i] >= GBRDF_MOST_MATERIALS)
            return false;
    return p->count < 2 || v[0] != v[1];
}

static bool picture_is_good(const struct relume_image *image)
{
    if (!image->data || image->width < 1 || image->height < 1 || image->channels != 1)
        return false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        if (!isfinite(image->data[i]))
            return false;
    return true;
}

bool parameter_is_good(const struct edit_parameter *p, const struct relume_edit *edit)
{
    const void *value = parameter_of(p, edit);
    switch (p->kind) {
    case PARAMETER_NUMBERS: return numbers_are_good(p, value);
    case PARAMETER_LABELS: return labels_are_good(p, value);
    case PARAMETER_CHANNELS: return strlen(value) == 3 && strspn(value, "RGB") == 3;
    case PARAMETER_PICTURE: return picture_is_good(value);
    }
    return false;
}

const struct edit_parameter *edit_fault(const struct relume_edit *edit)
{
    const struct relume_edit_operation *o = edit->operation;
    for (int k = 0; k < MOST_PARAMETERS && o->parameter[k]; k++) {
        const struct edit_parameter *p = o->parameter[k];
        if (!(p->optional && !parameter_given(p, edit)) && !parameter_is_good(p, edit))
            return p;
    }
    return NULL;
}

relume_status edit_refuse(const struct relume_edit_operation *o, const struct edit_parameter *p,
                          const char *found, const struct relume_log *log)
{
    const bool other = strcmp(o->name, p->name) != 0;  // than what is named already
    return log_fail(log, RELUME_EINVAL, "%s%s%s: expected %s%s%s%s", o->name, other ? ": " : "",
                    other ? p->name : "", p->form, found ? "; found '" : "", found ? found : "",
                    found ? "'" : "");
}
