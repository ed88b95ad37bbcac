// edit_text.c - edits as people write and read them
#include "core/base/log.h"
#include "material/gbrdf/operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool read_numbers(double *out, int count, const char *text)
{
    for (int i = 0; i < count; i++) {
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || *end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

static bool read_labels(int *out, int count, const char *text)
{
    double number[2];
    if (!read_numbers(number, count, text))
        return false;
    for (int i = 0; i < count; i++) {
        if (!(number[i] >= 0.0 && number[i] < GBRDF_MOST_MATERIALS) ||
            number[i] != floor(number[i]))
            return false;
        out[i] = (int)number[i];
    }
    return true;
}

// Heights and shares are what a file's numbers say: nothing is decoded as light.
static relume_status read_picture(struct relume_image *out, const char *path,
                                  const struct relume_log *log)
{
    relume_image_destroy(out);
    return relume_image_load(
        out, path,
        relume_image_params(.log = log, .channels = 1, .transfer = {RELUME_CURVE_LINEAR}));
}

static bool read_value(const struct edit_parameter *p, void *value, const char *text)
{
    switch (p->kind) {
    case PARAMETER_NUMBERS: return read_numbers(value, p->count, text);
    case PARAMETER_LABELS: return read_labels(value, p->count, text);
    case PARAMETER_CHANNELS: return snprintf(value, 4, "%s", text) == 3;
    case PARAMETER_PICTURE: break;
    }
    return false;
}

relume_status relume_edit_set(struct relume_edit *edit, const char *parameter, const char *text,
                              const struct relume_log *log)
{
    const struct relume_edit_operation *o = edit->operation;
    const struct edit_parameter *p = operation_parameter(o, parameter);
    if (!p)
        return log_fail(log, RELUME_EINVAL, "%s: has no %s", o->name, parameter);
    if (p->kind == PARAMETER_PICTURE)
        return read_picture(parameter_of(p, edit), text, log);
    struct relume_edit tried = *edit;
    const bool read = read_value(p, parameter_of(p, &tried), text);
    if (!read || !parameter_is_good(p, &tried))
        return edit_refuse(o, p, text, log);
    *edit = tried;
    return RELUME_OK;
}

// ---------------------------------------------------------------- to read

static void put_value(FILE *to, const struct edit_parameter *p, const struct relume_edit *edit)
{
    const void *value = parameter_of(p, edit);
    const struct relume_image *image = value;
    switch (p->kind) {
    case PARAMETER_NUMBERS:
        for (int i = 0; i < p->count; i++)
            fprintf(to, "%s%g", i ? "," : "", ((const double *)value)[i]);
        break;
    case PARAMETER_LABELS:
        for (int i = 0; i < p->count; i++)
            fprintf(to, "%s%d", i ? "," : "", ((const int *)value)[i]);
        break;
    case PARAMETER_CHANNELS: fputs(value, to); break;
    case PARAMETER_PICTURE: fprintf(to, "%dx%d", image->width, image->height); break;
    }
}

void relume_edit_text(const struct relume_edit *edit, char *text, size_t size)
{
    const struct relume_edit_operation *o = edit->operation;
    FILE *to = size ? fmemopen(text, size, "w") : NULL;
    if (size)
        *text = '\0';
    if (!to)
        return;
    fputs(o->name, to);
    for (int k = 0; k < MOST_PARAMETERS && o->parameter[k]; k++)
        if (parameter_given(o->parameter[k], edit)) {
            const char *name = o->parameter[k]->name;
            fprintf(to, " %s%s", strcmp(name, o->name) ? name : "",
                    strcmp(name, o->name) ? " " : "");
            put_value(to, o->parameter[k], edit);
        }
    fclose(to);
    text[size - 1] = '\0';
}
