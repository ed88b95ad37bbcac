// pictures.c - a BTF as the Bonn laboratory hands it out: a folder of pictures named by the angles
// of light and view, tl (light from the pole), pl (light azimuth), tv, pv, in whole degrees or not
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/base/tree.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

struct angles {
    double theta_deg, phi_deg;
};

struct picture {
    char *name;
    struct angles light, view;
    int at[2];         // view, light
    size_t saturated;  // pixels with a value at the end of the scale
};

struct pictures {
    const char *path;
    const struct relume_btf_params *params;
    const struct relume_log *log;
    struct picture *all;
    size_t count;
    struct angles *views, *lights;
    int view_count, light_count;
    const struct picture **grid;  // [view][light], NULL: missing
};

// ---------------------------------------------------------------- names

// The number behind a two-letter key; the key must not follow a letter.
static bool angle_in(const char *name, const char *key, double *out)
{
    for (const char *at = strstr(name, key); at; at = strstr(at + 1, key)) {
        const char before = at == name ? '_' : at[-1], after = at[2];
        if (((before | 32) >= 'a' && (before | 32) <= 'z') || after < '0' || after > '9')
            continue;
        char digits[16];
        const size_t n = strspn(at + 2, "0123456789");
        const bool fraction = at[2 + n] == '.' && at[3 + n] >= '0' && at[3 + n] <= '9';
        const size_t length = fraction ? n + 1 + strspn(at + 3 + n, "0123456789") : n;
        if (length >= sizeof digits)
            return false;
        memcpy(digits, at + 2, length);
        digits[length] = '\0';
        *out = strtod(digits, NULL);
        return true;
    }
    return false;
}

static struct angles normal_angles(double theta_deg, double phi_deg)
{
    return (struct angles){theta_deg, theta_deg > 0.0 ? fmod(phi_deg, 360.0) : 0.0};
}

// How many of the four angles are there: light from the pole, around; view from the pole, around.
static int angles_in(const char *name, double angle[4])
{
    return angle_in(name, "tl", &angle[0]) + angle_in(name, "pl", &angle[1]) +
           angle_in(name, "tv", &angle[2]) + angle_in(name, "pv", &angle[3]);
}

// 1: a picture of the BTF; 0: some other file; -1: angles that cannot be. The folder may name the
// view for all that is in it.
static int parse(struct picture *p, const char *name)
{
    double a[4];
    const int found = angles_in(path_name(name), a);
    if (found == 0)
        return 0;
    if (found < 4 && angles_in(name, a) < 4)
        return -1;
    p->light = normal_angles(a[0], a[1]);
    p->view = normal_angles(a[2], a[3]);
    return a[0] < 90.0 && a[2] < 90.0 && a[1] <= 360.0 && a[3] <= 360.0 ? 1 : -1;
}

static relume_status add(struct pictures *p, const char *name)
{
    struct picture one = {.name = NULL};
    const int kind = parse(&one, name);
    if (!kind)
        return RELUME_OK;
    if (kind < 0)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s/%s: angles; expected tl and tv from 0 to below 90, pl and pv from 0 "
                        "to 360, all four",
                        p->path, name);
    one.name = mem_text(name);
    if (!one.name || !mem_grow(&p->all, p->count, sizeof *p->all)) {
        mem_free(one.name);
        return RELUME_ENOMEM;
    }
    p->all[p->count++] = one;
    return RELUME_OK;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const struct picture *)a)->name, ((const struct picture *)b)->name);
}

static relume_status list_folder(struct pictures *p, const char *inside);

static relume_status list_entry(struct pictures *p, const char *inside, const char *entry)
{
    const bool top = !*inside;
    char *name = top ? mem_text(entry) : mem_format("%s/%s", inside, entry);
    char *path = name ? mem_format("%s/%s", p->path, name) : NULL;
    relume_status status = path ? RELUME_OK : RELUME_ENOMEM;
    if (path && !tree_is_folder(path))
        status = add(p, name);
    else if (path && top)
        status = list_folder(p, name);
    mem_free(path);
    mem_free(name);
    return status;
}

// The pictures of a folder inside that of the BTF ("": this itself) and there of folders one level
// below: Bonn keeps each view in its own, tv000_pv000/00001 tl000 pl000 tv000 pv000.jpg.
static relume_status list_folder(struct pictures *p, const char *inside)
{
    relume_status status = RELUME_OK;
    char *path = *inside ? mem_format("%s/%s", p->path, inside) : mem_text(p->path);
    if (!path)
        return RELUME_ENOMEM;
    DIR *dir = opendir(path);
    if (!dir)
        status = relume_input_fail(p->log, path, "cannot be read", errno);
    mem_free(path);
    const struct dirent *e;
    while (dir && !status && (e = readdir(dir)))
        status = e->d_name[0] == '.' ? RELUME_OK : list_entry(p, inside, e->d_name);
    if (dir)
        closedir(dir);
    return status;
}

static relume_status list(struct pictures *p)
{
    const relume_status status = list_folder(p, "");
    if (!status && !p->count)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: expected btf.json, or pictures named like tl030_pl120_tv045_pv020.png",
                        p->path);
    if (p->count)
        qsort(p->all, p->count, sizeof *p->all, by_name);
    return status;
}

// ---------------------------------------------------------------- the grid of directions

static int by_angle(const void *a, const void *b)
{
    const struct angles *x = a, *y = b;
    if (x->theta_deg != y->theta_deg)
        return x->theta_deg < y->theta_deg ? -1 : 1;
    return x->phi_deg < y->phi_deg ? -1 : x->phi_deg > y->phi_deg;
}

static int distinct(struct angles *a, size_t n)
{
    size_t kept = 0;
    qsort(a, n, sizeof *a, by_angle);
    for (size_t i = 0; i < n; i++)
        if (!kept || by_angle(&a[kept - 1], &a[i]))
            a[kept++] = a[i];
    return (int)kept;
}

static int find(const struct angles *a, int n, struct angles which)
{
    const struct angles *at = bsearch(&which, a, (size_t)n, sizeof *a, by_angle);
    return (int)(at - a);
}

static relume_status missing(const struct pictures *p, int view, int light)
{
    const struct angles v = p->views[view], l = p->lights[light];
    return log_fail(p->log, RELUME_ENOTFOUND,
                    "%s: no picture for tl%03g_pl%03g_tv%03g_pv%03g; expected one of every light "
                    "and view, or --fill to interpolate",
                    p->path, l.theta_deg, l.phi_deg, v.theta_deg, v.phi_deg);
}

// Pictures that have direction `which` of the views or lights, and the first of them.
static int count_of(const struct pictures *p, bool view, int which, const struct picture **first)
{
    const int n = view ? p->light_count : p->view_count;
    int count = 0;
    *first = NULL;
    for (int i = 0; i < n; i++) {
        const int v = view ? which : i, l = view ? i : which;
        const struct picture *one = p->grid[(size_t)v * (size_t)p->light_count + (size_t)l];
        *first = *first ? *first : one;
        count += one != NULL;
    }
    return count;
}

// A direction of far fewer pictures than others was not measured: somebody mistyped an angle.
static relume_status find_strays_of(const struct pictures *p, bool view)
{
    enum { FEW = 4 };  // less than one for so many of another direction
    const int n = view ? p->view_count : p->light_count;
    const struct picture *first;
    int most = 0;
    for (int i = 0; i < n; i++) {
        const int count = count_of(p, view, i, &first);
        most = count > most ? count : most;
    }
    for (int i = 0; i < n; i++) {
        const int count = count_of(p, view, i, &first);
        const struct angles a = view ? p->views[i] : p->lights[i];
        if (count * FEW < most)
            return log_fail(p->log, RELUME_EUNFIT,
                            "%s/%s: the angles seem wrong; expected pictures of t%c%03g_p%c%03g "
                            "for %d %s, as of others; found %d",
                            p->path, first->name, view ? 'v' : 'l', a.theta_deg, view ? 'v' : 'l',
                            a.phi_deg, most, view ? "lights" : "views", count);
    }
    return RELUME_OK;
}

static relume_status find_strays(const struct pictures *p)
{
    const relume_status status = find_strays_of(p, false);
    return status ? status : find_strays_of(p, true);
}

static relume_status place_pictures(struct pictures *p)
{
    for (size_t i = 0; i < p->count; i++) {
        struct picture *one = &p->all[i];
        one->at[0] = find(p->views, p->view_count, one->view);
        one->at[1] = find(p->lights, p->light_count, one->light);
        const struct picture **cell =
            &p->grid[(size_t)one->at[0] * (size_t)p->light_count + (size_t)one->at[1]];
        if (*cell)
            return log_fail(p->log, RELUME_EUNFIT, "%s/%s: the same angles as %s", p->path,
                            one->name, (*cell)->name);
        *cell = one;
    }
    const relume_status status = find_strays(p);
    if (status)
        return status;
    for (int v = 0; v < p->view_count; v++)
        for (int l = 0; l < p->light_count; l++)
            if (!p->grid[(size_t)v * (size_t)p->light_count + (size_t)l] &&
                !(p->params && p->params->fill))
                return missing(p, v, l);
    return RELUME_OK;
}

static relume_status make_grid(struct pictures *p)
{
    p->views = mem_array(p->count, sizeof *p->views);
    p->lights = mem_array(p->count, sizeof *p->lights);
    if (!p->views || !p->lights)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < p->count; i++) {
        p->views[i] = p->all[i].view;
        p->lights[i] = p->all[i].light;
    }
    p->view_count = distinct(p->views, p->count);
    p->light_count = distinct(p->lights, p->count);
    p->grid = mem_zeroed((size_t)p->view_count * (size_t)p->light_count, sizeof(void *));
    return p->grid ? place_pictures(p) : RELUME_ENOMEM;
}

static vec3 *directions(const struct angles *a, int n)
{
    vec3 *d = mem_array((size_t)n, sizeof *d);
    for (int i = 0; d && i < n; i++) {
        const double theta = a[i].theta_deg * M_PI / 180.0, phi = a[i].phi_deg * M_PI / 180.0;
        d[i] = vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    }
    return d;
}

// ---------------------------------------------------------------- the pictures

static relume_status load(const struct pictures *p, size_t index, struct relume_image *image,
                          const struct relume_log *log)
{
    char *path = mem_format("%s/%s", p->path, p->all[index].name);
    const relume_status status =
        path ? relume_image_load(
                   image, path,
                   relume_image_params(.log = log, .limits = p->params ? p->params->limits : NULL))
             : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

static bool is_finite(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height * 3;
    for (size_t i = 0; i < n; i++)
        if (!isfinite(image->data[i]))
            return false;
    return true;
}

// Pictures of integers end at 1, where light that was brighter is cut off; halfs at 65504.
static size_t saturated(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const float *rgb = image->data + 3 * i;
        const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
        count += most == 1.0f || most > 65504.0f;
    }
    return count;
}

static relume_status store(const struct pictures *p, relume_btf *btf, size_t index,
                           const struct relume_log *log)
{
    struct picture *one = &p->all[index];
    struct relume_image image = {0};
    relume_status status = load(p, index, &image, log);
    if (!status && (image.width != btf->info.width || image.height != btf->info.height))
        status = log_fail(log, RELUME_EUNFIT, "%s/%s: %d x %d pixels; expected %d x %d as in %s",
                          p->path, one->name, image.width, image.height, btf->info.width,
                          btf->info.height, p->all[0].name);
    if (!status && !is_finite(&image))
        status = log_fail(log, RELUME_EDAMAGED, "%s/%s: NaN or infinity; expected finite values",
                          p->path, one->name);
    if (!status) {
        one->saturated = saturated(&image);
        relume_btf_store(btf, one->at[0], one->at[1], image.data);
    }
    relume_image_destroy(&image);
    return status;
}

static void tell_saturated(const struct pictures *p, const relume_btf *btf)
{
    size_t count = 0, worst = 0;
    for (size_t i = 0; i < p->count; i++) {
        count += p->all[i].saturated;
        worst = p->all[i].saturated > p->all[worst].saturated ? i : worst;
    }
    if (count)
        log_line(p->log, RELUME_WARNING,
                 "%s: %.2g %% of all texels are saturated, most in %s; highlights are cut off",
                 p->path, 100.0 * (double)count / ((double)p->count * (double)btf_texels(btf)),
                 p->all[worst].name);
}

struct storing {
    const struct pictures *pictures;
    relume_btf *btf;
    size_t first;
    relume_status *status;
};

static void store_one(void *context, size_t item, int worker)
{
    (void)worker;
    struct storing *s = context;
    s->status[item] = store(s->pictures, s->btf, s->first + item, NULL);
}

// The log may only be called from here, so what failed silently is tried once more aloud.
static relume_status store_all(const struct pictures *p, relume_btf *btf)
{
    enum { GROUP = 64 };
    relume_status each[GROUP], status = RELUME_OK;
    struct storing s = {p, btf, 0, each};
    for (; s.first < p->count && !status; s.first += GROUP) {
        const size_t n = p->count - s.first < GROUP ? p->count - s.first : GROUP;
        thread_for(p->params ? p->params->threads : 0, n, store_one, &s);
        for (size_t i = 0; i < n && !status; i++)
            status = each[i] ? store(p, btf, s.first + i, p->log) : RELUME_OK;
        if (!status && !log_progress(p->log, "reading", (double)(s.first + n) / (double)p->count))
            status = RELUME_ECANCEL;
    }
    return status;
}

// A missing picture becomes the mean of the three of its view whose lights are nearest, by the
// inverse of their angle.
static relume_status fill_one(const struct pictures *p, relume_btf *btf, int view, int light)
{
    const size_t n = btf_texels(btf) * 3;
    float *sum = mem_zeroed(n, sizeof *sum);
    bool *taken = mem_zeroed((size_t)p->light_count, sizeof *taken);
    double total = 0.0;
    relume_status status = sum && taken ? RELUME_OK : RELUME_ENOMEM;
    for (int k = 0; k < 3 && !status; k++) {
        int best = -1;
        for (int l = 0; l < p->light_count; l++)
            if (p->grid[(size_t)view * (size_t)p->light_count + (size_t)l] && !taken[l] &&
                (best < 0 || vec3_angle(btf->light[l], btf->light[light]) <
                                 vec3_angle(btf->light[best], btf->light[light])))
                best = l;
        if (best < 0)
            break;
        taken[best] = true;
        const double w = 1.0 / vec3_angle(btf->light[best], btf->light[light]);
        const uint16_t *from = relume_btf_picture(btf, view, best);
        for (size_t i = 0; i < n; i++)
            sum[i] += (float)w * float_from_half(from[i]);
        total += w;
    }
    if (!status && !(total > 0.0))
        status = missing(p, view, light);
    for (size_t i = 0; i < n && !status; i++)
        sum[i] /= (float)total;
    if (!status)
        relume_btf_store(btf, view, light, sum);
    mem_free(sum);
    mem_free(taken);
    return status;
}

static relume_status fill_gaps(const struct pictures *p, relume_btf *btf)
{
    int filled = 0;
    relume_status status = RELUME_OK;
    for (int v = 0; v < p->view_count && !status; v++)
        for (int l = 0; l < p->light_count && !status; l++)
            if (!p->grid[(size_t)v * (size_t)p->light_count + (size_t)l]) {
                status = fill_one(p, btf, v, l);
                filled++;
            }
    if (!status && filled)
        log_line(p->log, RELUME_WARNING, "%s: %d missing picture%s interpolated", p->path, filled,
                 filled == 1 ? " was" : "s were");
    return status;
}

static relume_status make_btf(relume_btf **out, const struct pictures *p)
{
    struct relume_image first = {0};
    vec3 *view = directions(p->views, p->view_count);
    vec3 *light = directions(p->lights, p->light_count);
    const char *name = path_name(p->path);
    relume_status status = view && light ? load(p, 0, &first, p->log) : RELUME_ENOMEM;
    const struct relume_btf_info info = {
        .name = *name ? name : p->path,
        .width = first.width,
        .height = first.height,
        .views = p->view_count,
        .lights = p->light_count,
        .view = view,
        .light = light,
    };
    if (!status)
        status = btf_start(out, &info, p->path, p->log);
    if (!status)
        status = btf_allocate(*out, p->params);
    relume_image_destroy(&first);
    mem_free(view);
    mem_free(light);
    return status;
}

relume_status btf_open_pictures(relume_btf **out, const char *path,
                                const struct relume_btf_params *params)
{
    struct pictures p = {.path = path, .params = params, .log = params ? params->log : NULL};
    *out = NULL;
    relume_status status = list(&p);
    if (!status)
        status = make_grid(&p);
    if (!status)
        status = make_btf(out, &p);
    if (!status)
        status = store_all(&p, *out);
    if (!status)
        status = fill_gaps(&p, *out);
    if (!status)
        tell_saturated(&p, *out);
    if (status)
        relume_btf_destroy(out);
    for (size_t i = 0; i < p.count; i++)
        mem_free(p.all[i].name);
    mem_free(p.all);
    mem_free(p.views);
    mem_free(p.lights);
    mem_free(p.grid);
    return status;
}
