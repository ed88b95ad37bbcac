// on_gbrdf.c - the operations on a g-BRDF (Menzel 2011, section 6.4)
//
// A distribution is shared by all texels of a material. So an operation that changes distributions
// under a mask makes a copy of each material that the mask cuts, for the texels within.
#include "material/gbrdf/on_gbrdf.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/gbrdf/drawing.h"

#include <string.h>

static size_t texels_of(const struct edited_gbrdf *g)
{
    return (size_t)g->maps.width * (size_t)g->maps.height;
}

// What halfs hold: the product may be anything until it is limited.
static uint16_t half_times(uint16_t value, double factor)
{
    return half_from_float((float)fmin((double)float_from_half(value) * factor, 65504.0));
}

// ---------------------------------------------------------------- relief

static relume_status add_relief(struct edited_gbrdf *g, const struct relume_edit *e, double sign)
{
    struct relume_image relief;
    relume_status status = drawing_lay(&relief, e, g->maps.width, g->maps.height, true, g->log);
    for (size_t i = 0; !status && i < texels_of(g); i++) {
        g->maps.depth[i] += (float)(sign * e->height * (double)relief.data[i]);
        if (fabsf(g->maps.depth[i]) > 1.0f)
            status = log_fail(g->log, RELUME_EUNFIT,
                              "the relief becomes higher than one width of the sample; expected a "
                              "smaller height");
    }
    relume_image_destroy(&relief);
    return status;
}

relume_status gbrdf_emboss(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    return add_relief(g, edit, 1.0);
}

relume_status gbrdf_engrave(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    return add_relief(g, edit, -1.0);
}

// ---------------------------------------------------------------- materials

// One more, a copy of another, whose number is in *label.
static relume_status copy_material(struct edited_gbrdf *g, int from, int *label)
{
    struct gbrdf_maps *m = &g->maps;
    if (m->materials == GBRDF_MOST_MATERIALS)
        return log_fail(g->log, RELUME_EUNFIT,
                        "a g-BRDF has at most %d materials, and a mask makes new ones",
                        GBRDF_MOST_MATERIALS);
    uint16_t *ndf = mem_resize(m->ndf, ((size_t)m->materials + 1) * NDF_VALUES, sizeof *ndf);
    if (!ndf)
        return RELUME_ENOMEM;
    m->ndf = ndf;
    *label = m->materials++;
    memcpy(ndf + (size_t)*label * NDF_VALUES, ndf + (size_t)from * NDF_VALUES,
           NDF_VALUES * sizeof *ndf);
    return RELUME_OK;
}

static relume_status check_label(const struct edited_gbrdf *g, int label)
{
    return label < g->maps.materials
               ? RELUME_OK
               : log_fail(g->log, RELUME_EUNFIT,
                          "there is no material %d; expected a label from 0 to %d", label,
                          g->maps.materials - 1);
}

// The texels and materials that an operation is for.
struct chosen {
    bool *texel;
    bool material[GBRDF_MOST_MATERIALS];
};

static void chosen_free(struct chosen *c)
{
    mem_free(c->texel);
}

static relume_status choose_texels(struct chosen *c, const struct edited_gbrdf *g,
                                   const struct relume_edit *e)
{
    struct relume_image mask = {.width = 0};
    bool any = false;
    *c = (struct chosen){.texel = mem_array(texels_of(g), sizeof *c->texel)};
    relume_status status = c->texel ? RELUME_OK : RELUME_ENOMEM;
    if (!status && e->label >= 0)
        status = check_label(g, e->label);
    if (!status)
        status = mask_lay(&mask, e, g->maps.width, g->maps.height);
    for (size_t i = 0; !status && i < texels_of(g); i++) {
        c->texel[i] = mask.data[i] >= 0.5f && (e->label < 0 || g->maps.label[i] == e->label);
        any |= c->texel[i];
    }
    if (!status && e->mask.data && !any)
        status = log_fail(g->log, RELUME_EUNFIT,
                          "the mask leaves no texel; expected one that is white somewhere%s",
                          e->label < 0 ? "" : " within the material");
    relume_image_destroy(&mask);
    return status;
}

// Give the chosen texels materials of their own, where others have these as well.
static relume_status choose(struct chosen *c, struct edited_gbrdf *g, const struct relume_edit *e)
{
    bool within[GBRDF_MOST_MATERIALS] = {false}, beside[GBRDF_MOST_MATERIALS] = {false};
    const int materials = g->maps.materials;
    relume_status status = choose_texels(c, g, e);
    for (size_t i = 0; !status && i < texels_of(g); i++)
        (c->texel[i] ? within : beside)[g->maps.label[i]] = true;
    for (int k = 0; !status && k < materials; k++) {
        int own = k;
        if (!within[k])
            continue;
        if (beside[k])
            status = copy_material(g, k, &own);
        for (size_t i = 0; !status && own != k && i < texels_of(g); i++)
            if (c->texel[i] && g->maps.label[i] == k)
                g->maps.label[i] = (uint8_t)own;
        c->material[own] = g->touched[own] = true;
    }
    return status;
}

relume_status gbrdf_roughness(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    struct chosen c;
    const double factor = edit->factor * edit->factor;
    // what stays as it is has no material of its own
    const relume_status status = factor == 1.0 ? choose_texels(&c, g, edit) : choose(&c, g, edit);
    for (int k = 0; !status && k < g->maps.materials; k++) {
        uint16_t *ndf = g->maps.ndf + (size_t)k * NDF_VALUES;
        float value[NDF_VALUES];
        if (!c.material[k])
            continue;
        for (int i = 0; i < NDF_VALUES; i++)
            value[i] = float_from_half(ndf[i]);
        ndf_widen(value, factor);
        for (int i = 0; i < NDF_VALUES; i++)
            ndf[i] = half_from_float(fminf(value[i], 65504.0f));
    }
    chosen_free(&c);
    return status;
}

// ---------------------------------------------------------------- colours

// Every colour of what is chosen, by what a colour becomes.
static relume_status recolour(struct edited_gbrdf *g, const struct relume_edit *e,
                              void (*become)(uint16_t rgb[3], const struct relume_edit *e))
{
    struct chosen c;
    const relume_status status = choose(&c, g, e);
    for (size_t i = 0; !status && i < texels_of(g); i++)
        if (c.texel[i])
            become(g->maps.diffuse + 3 * i, e);
    for (int k = 0; !status && k < g->maps.materials; k++)
        for (int i = 0; c.material[k] && i < NDF_VALUES; i += 3)
            become(g->maps.ndf + (size_t)k * NDF_VALUES + i, e);
    chosen_free(&c);
    return status;
}

static void multiply(uint16_t rgb[3], const struct relume_edit *e)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = half_times(rgb[c], e->factors[c]);
}

static void exchange(uint16_t rgb[3], const struct relume_edit *e)
{
    const uint16_t old[3] = {rgb[0], rgb[1], rgb[2]};
    for (int c = 0; c < 3; c++)
        rgb[c] = old[strchr("RGB", e->channels[c]) - "RGB"];
}

relume_status gbrdf_tint(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    return recolour(g, edit, multiply);
}

relume_status gbrdf_channels(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    return recolour(g, edit, exchange);
}

// ---------------------------------------------------------------- labels, turn

relume_status gbrdf_swap(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    struct chosen c;
    const int a = edit->labels[0], b = edit->labels[1];
    relume_status status = choose_texels(&c, g, edit);
    for (int k = 0; !status && k < 2; k++)
        status = check_label(g, edit->labels[k]);
    for (size_t i = 0; !status && i < texels_of(g); i++) {
        uint8_t *label = &g->maps.label[i];
        if (c.texel[i] && (*label == a || *label == b))
            *label = (uint8_t)(*label == a ? b : a);
    }
    if (!status)
        g->touched[a] = g->touched[b] = true;
    chosen_free(&c);
    return status;
}

relume_status gbrdf_turn(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    struct chosen c;
    const double by = remainder(edit->degrees, 360.0) * (M_PI / 180.0);
    const relume_status status = choose_texels(&c, g, edit);
    for (size_t i = 0; !status && by != 0.0 && i < texels_of(g); i++) {
        uint16_t *r = &g->maps.rotation[i];
        if (c.texel[i])
            *r = half_from_float((float)remainder((double)float_from_half(*r) + by, 2.0 * M_PI));
    }
    chosen_free(&c);
    return status;
}

relume_status gbrdf_add_material(struct edited_gbrdf *g, const struct relume_edit *edit)
{
    struct chosen c;
    int label = 0;
    relume_status status = choose_texels(&c, g, edit);
    if (!status)
        status = copy_material(g, 0, &label);
    if (!status) {
        float value[NDF_VALUES];
        ndf_ggx(value, edit->roughness * edit->roughness, edit->highlight);
        for (int i = 0; i < NDF_VALUES; i++)
            g->maps.ndf[(size_t)label * NDF_VALUES + (size_t)i] = half_from_float(value[i]);
        g->touched[label] = true;
    }
    for (size_t i = 0; !status && i < texels_of(g); i++) {
        if (!c.texel[i])
            continue;
        g->maps.label[i] = (uint8_t)label;
        g->maps.r0[i] = half_from_float((float)edit->r0);
        for (size_t k = 0; !isnan(edit->colour[0]) && k < 3; k++)
            g->maps.diffuse[3 * i + k] = half_from_float((float)edit->colour[k]);
    }
    chosen_free(&c);
    return status;
}
