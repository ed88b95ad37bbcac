// spec.c - a light in words
#include "relight/light/spec.h"

#include "core/base/log.h"
#include "core/base/json_write.h"
#include "core/base/memory.h"
#include "relight/light/light.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

// The words of a kind, in order: vectors of the light, a half angle, a file name.
struct grammar {
    enum relume_light_kind kind;
    const char *form;
    size_t vectors[3];  // offsets in struct relume_light
    int vector_count;
    bool angle, file, rotate, falls;
};

#define AT(field) offsetof(struct relume_light, field)

static const struct grammar grammars[] = {
    {RELUME_LIGHT_DIRECTIONAL, "dir x y z", {AT(direction)}, 1, false, false, false, false},
    {RELUME_LIGHT_POINT, "point px py pz", {AT(position)}, 1, false, false, false, true},
    {RELUME_LIGHT_SPOT,
     "spot px py pz dx dy dz half_angle",
     {AT(position), AT(direction)},
     2,
     true,
     false,
     false,
     true},
    {RELUME_LIGHT_SLIDE,
     "slide px py pz dx dy dz half_angle picture",
     {AT(position), AT(direction)},
     2,
     true,
     true,
     false,
     true},
    {RELUME_LIGHT_AREA,
     "area px py pz ux uy uz vx vy vz [disc]",
     {AT(position), AT(u), AT(v)},
     3,
     false,
     false,
     false,
     false},
    {RELUME_LIGHT_ENVIRONMENT, "env map [rotate]", {0}, 0, false, true, true, false},
    {RELUME_LIGHT_IES,
     "ies px py pz dx dy dz file",
     {AT(position), AT(direction)},
     2,
     false,
     true,
     false,
     true},
    {RELUME_LIGHT_GONIO,
     "gonio px py pz dx dy dz map",
     {AT(position), AT(direction)},
     2,
     false,
     true,
     false,
     true},
};
enum { GRAMMARS = sizeof grammars / sizeof *grammars };

static struct relume_vec3 *vector_at(struct relume_light *light, size_t offset)
{
    return (struct relume_vec3 *)(void *)((char *)light + offset);
}

// ---------------------------------------------------------------- reading

static const char *skip_blanks(const char *t)
{
    return t + strspn(t, " \t");
}

static bool take_number(const char **text, double *out)
{
    char *end;
    *out = strtod(*text, &end);
    if (end == *text || !isfinite(*out) || (*end && !strchr(" \t", *end)))
        return false;
    *text = end;
    return true;
}

static bool take_vector(const char **text, struct relume_vec3 *out)
{
    return take_number(text, &out->x) && take_number(text, &out->y) && take_number(text, &out->z);
}

static bool take_word(const char **text, const char *word)
{
    const char *t = skip_blanks(*text);
    const size_t n = strlen(word);
    if (strncmp(t, word, n) || (t[n] && !strchr(" \t", t[n])))
        return false;
    *text = t + n;
    return true;
}

// A word, or what stands between two quotes of the same kind. RELUME_EINVAL, RELUME_ENOMEM.
static relume_status take_name(const char **text, char **out)
{
    const char *t = skip_blanks(*text);
    const bool quoted = *t == '\'' || *t == '"';
    const char quote[2] = {*t, '\0'};
    const char *begin = t + quoted;
    const size_t length = strcspn(begin, quoted ? quote : " \t");
    if (length == 0 || (quoted && begin[length] != *t))
        return RELUME_EINVAL;
    *out = mem_format("%.*s", (int)length, begin);
    *text = begin + length + quoted;
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

static const struct grammar *take_kind(const char **text)
{
    for (int i = 0; i < GRAMMARS; i++)
        if (take_word(text, relume_light_kind_name(grammars[i].kind)))
            return &grammars[i];
    return NULL;
}

static bool take_numbers(const char **text, const struct grammar *g, struct relume_light *light)
{
    for (int i = 0; i < g->vector_count; i++)
        if (!take_vector(text, vector_at(light, g->vectors[i])))
            return false;
    return !g->angle || take_number(text, &light->half_angle_deg);
}

static bool take_colour(const char **text, struct relume_light *light)
{
    struct relume_vec3 rgb;
    if (!take_vector(text, &rgb))
        return false;
    light->rgb[0] = (float)rgb.x;
    light->rgb[1] = (float)rgb.y;
    light->rgb[2] = (float)rgb.z;
    return true;
}

// What may follow in any order: rgb r g b, nofall, disc.
static bool take_rest(const char **text, const struct grammar *g, struct relume_light *light)
{
    while (*skip_blanks(*text))
        if (take_word(text, "rgb")) {
            if (!take_colour(text, light))
                return false;
        } else if (g->falls && take_word(text, "nofall")) {
            light->nofall = true;
        } else if (g->kind == RELUME_LIGHT_AREA && take_word(text, "disc")) {
            light->disc = true;
        } else {
            return false;
        }
    return true;
}

static relume_status unknown_kind(const char *text, const struct relume_log *log)
{
    const char *names[GRAMMARS + 1] = {NULL};
    char given[32];
    const char *word = skip_blanks(text);
    snprintf(given, sizeof given, "%.*s", (int)strcspn(word, " \t") % 31, word);
    for (int i = 0; i < GRAMMARS; i++)
        names[i] = relume_light_kind_name(grammars[i].kind);
    if (!strcmp(given, "raking"))
        return log_fail(log, RELUME_EINVAL,
                        "light '%.200s': raking light needs the captured lights of a file; "
                        "relume relight, query and capture know it, elsewhere write dir x y z",
                        text);
    const char *near = relume_name_nearest(given, names);
    double v[3];
    if (sscanf(word, "%lf%*[ \t,]%lf%*[ \t,]%lf", &v[0], &v[1], &v[2]) == 3)
        return log_fail(
            log, RELUME_EINVAL,
            "light '%.200s': its kind is missing; did you mean 'dir %g %g %g'? Expected "
            "dir, point, spot, slide, area, env, ies or gonio first",
            text, v[0], v[1], v[2]);
    return log_fail(log, RELUME_EINVAL,
                    "light '%.200s': unknown kind%s%s%s; expected dir, point, spot, slide, area, "
                    "env, ies or gonio",
                    text, near ? ", did you mean '" : "", near ? near : "", near ? "'?" : "");
}

// Up to the first word that does not fit. RELUME_EINVAL, RELUME_ENOMEM.
static relume_status take_words(const char **text, const struct grammar *g, struct spec *out)
{
    if (!take_numbers(text, g, &out->light))
        return RELUME_EINVAL;
    const relume_status status = g->file ? take_name(text, &out->file) : RELUME_OK;
    if (status)
        return status;
    if (g->rotate)
        take_number(text, &out->light.rotate_deg);
    return take_rest(text, g, &out->light) ? RELUME_OK : RELUME_EINVAL;
}

relume_status spec_parse(struct spec *out, const char *text, const struct relume_log *log)
{
    const char *t = text;
    *out = (struct spec){0};
    const struct grammar *g = take_kind(&t);
    if (!g)
        return unknown_kind(text, log);
    out->light = (struct relume_light){.kind = g->kind, .rgb = {1.0f, 1.0f, 1.0f}};
    relume_status status = take_words(&t, g, out);
    t = skip_blanks(t);
    if (status == RELUME_EINVAL)
        log_fail(log, status, "light '%.200s': expected \"%s%s [rgb r g b]\", found '%.40s'", text,
                 g->form, g->falls ? " [nofall]" : "", *t ? t : "the end");
    const char *wrong = status ? NULL : light_complaint(&out->light, false);
    if (wrong)
        status = log_fail(log, RELUME_EINVAL, "light '%.200s': %s", text, wrong);
    if (status) {
        mem_free(out->file);
        *out = (struct spec){0};
    }
    return status;
}

// ---------------------------------------------------------------- writing

// A string that grows; `text` is NULL once memory was short.
struct words {
    char *text;
};

static void append(struct words *w, char *more)
{
    char *both = w->text && more ? mem_format("%s%s", w->text, more) : NULL;
    mem_free(w->text);
    mem_free(more);
    w->text = both;
}

static void append_number(struct words *w, double number)
{
    append(w, mem_format(" %s", jnumber_text(number).text));
}

static void append_vector(struct words *w, struct relume_vec3 v)
{
    append_number(w, v.x);
    append_number(w, v.y);
    append_number(w, v.z);
}

static void append_name(struct words *w, const char *name)
{
    const char *quote = strchr(name, '"') ? "'" : strpbrk(name, " \t'") ? "\"" : "";
    append(w, mem_format(" %s%s%s", quote, name, quote));
}

static const struct grammar *grammar_of(enum relume_light_kind kind)
{
    int i = 0;
    while (grammars[i].kind != kind)
        i++;
    return &grammars[i];
}

char *spec_text(const struct relume_light *light, const char *file)
{
    const struct grammar *g = grammar_of(light->kind);
    struct relume_light copy = *light;
    struct words w = {mem_text(relume_light_kind_name(light->kind))};
    for (int i = 0; i < g->vector_count; i++)
        append_vector(&w, *vector_at(&copy, g->vectors[i]));
    if (g->angle)
        append_number(&w, light->half_angle_deg);
    if (g->file)
        append_name(&w, file);
    if (g->rotate && light->rotate_deg != 0.0)
        append_number(&w, light->rotate_deg);
    if (light->disc && g->kind == RELUME_LIGHT_AREA)
        append(&w, mem_text(" disc"));
    if (light->nofall && g->falls)
        append(&w, mem_text(" nofall"));
    return w.text;
}
