// moving.c - what shadows or highlights of a view move by, as pictures
#include "site/publish/moving.h"

#include "core/base/memory.h"
#include "exchange/formats/sheet.h"
#include "format/pack/views.h"
#include "relight/shadow/moving.h"
#include "site/publish/levels.h"

#include <float.h>
#include <math.h>

_Static_assert(MOVING_NUMBERS == (int)RELUME_SHADOW_CHANNELS &&
                   MOVING_NUMBERS == (int)RELUME_GLOSS_CHANNELS,
               "both models are written by one function");

// Of the quantiser, in codes. Under captured lights what is lost cancels out.
#define STEP 4.0
// Codes above the last finite one are infinite; coding errs by less than half of what lies between.
enum { LAST = 239, INFINITE = 255 };

static const float APART = 0.125f;  // two kinds keep away from each other

// To what has even steps.
static float to_even(float value, int number, bool gloss)
{
    const float root = sqrtf(fabsf(value));
    if (!gloss)
        return number == RELUME_SHADOW_THICK ? log2f(fmaxf(value, 1e-9f)) : copysignf(root, value);
    return number < RELUME_GLOSS_NORMAL   ? copysignf(root, value)
           : number == RELUME_GLOSS_SHINE ? copysignf(root + APART, value)
                                          : value;
}

// One number of all pixels as codes of 0 to 1.
static void code_plane(struct moving *m, float *to, const struct relume_image *model, int number,
                       bool gloss)
{
    const size_t n = (size_t)model->width * (size_t)model->height;
    const int last = !gloss && number == RELUME_SHADOW_THICK ? LAST : INFINITE;
    float least = FLT_MAX, most = -FLT_MAX;
    for (size_t i = 0; i < n; i++) {
        to[i] = to_even(model->data[MOVING_NUMBERS * i + (size_t)number], number, gloss);
        least = isfinite(to[i]) ? fminf(least, to[i]) : least;
        most = isfinite(to[i]) ? fmaxf(most, to[i]) : most;
    }
    m->offset[number] = least <= most ? least : 0.0f;
    m->scale[number] = fmaxf((most - m->offset[number]) / (float)last, 1e-6f);
    for (size_t i = 0; i < n; i++)
        to[i] = isfinite(to[i]) ? (to[i] - m->offset[number]) / m->scale[number] / INFINITE : 1.0f;
}

static relume_status encode(struct moving *m, struct sheet_result *sheets,
                            const struct relume_image *model, bool gloss)
{
    const size_t n = (size_t)model->width * (size_t)model->height;
    float *scratch = mem_array(SHEET_PLANES * n, sizeof *scratch);
    relume_status status = scratch ? RELUME_OK : RELUME_ENOMEM;
    for (int first = 0; !status && first < MOVING_NUMBERS; first += SHEET_PLANES) {
        struct sheet s = {.width = model->width, .height = model->height, .fixed = true};
        for (; s.planes < SHEET_PLANES && first + s.planes < MOVING_NUMBERS; s.planes++) {
            float *to = scratch + (size_t)s.planes * n;
            code_plane(m, to, model, first + s.planes, gloss);
            s.plane[s.planes] = to;
            s.maximum[s.planes] = s.weight[s.planes] = 1.0;
        }
        status = sheet_encode(&sheets[first / SHEET_PLANES], &s, STEP / 255.0);
    }
    mem_free(scratch);
    return status;
}

// Where one goes on without what is damaged, whether there is a sound model.
static relume_status find_sound(bool *sound, relume_pack *pack, int view)
{
    relume_shadows *shadows = NULL;
    const relume_status status = relume_shadows_open(&shadows, pack, view);
    *sound = shadows != NULL;
    relume_shadows_destroy(&shadows);
    return status;
}

relume_status moving_write(struct moving *out, const struct site *site, const char *name,
                           relume_pack *pack, int view)
{
    enum { SHEETS = (MOVING_NUMBERS + SHEET_PLANES - 1) / SHEET_PLANES };
    const bool gloss = relume_pack_info(pack)->has_gloss;
    struct sheet_result sheets[SHEETS] = {{.bytes = NULL}};
    struct relume_image model = {0};
    bool sound = true;
    uint8_t *bytes = NULL;
    size_t size = 0;
    char *path = mem_format("%s/moving.bin", name);
    *out = (struct moving){.there = false};
    relume_status status = site->params->keep_going ? find_sound(&sound, pack, view) : RELUME_OK;
    if (!status && sound)
        status =
            gloss ? relume_pack_gloss(&model, pack, view) : relume_pack_shadow(&model, pack, view);
    out->there = !status && model.data;
    if (!status && !path)
        status = RELUME_ENOMEM;
    if (!status && out->there)
        status = encode(out, sheets, &model, gloss);
    if (!status && out->there)
        status = levels_join(sheets, SHEETS, &bytes, &size);
    if (!status && out->there)
        status = site_save_data(site, path, bytes, size);
    for (int i = 0; i < SHEETS; i++)
        mem_free(sheets[i].bytes);
    mem_free(bytes);
    mem_free(path);
    relume_image_destroy(&model);
    return status;
}
