// cmd_info.c - relume info: what a file holds
#include "cli/cli.h"

#include <math.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

struct info_options {
    struct args args;
    bool json;
    bool allow_outside, keep_going;
};
#define OPTIONS struct info_options

static const struct option options[] = {
    GROUP("output"),   FLAG("--json", json, "one JSON object"),
    GROUP("input"),    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION, {0},
};

// Of the file that was named; NAN for folders and for lists of other files.
static double bytes_of(const char *path, enum relume_kind kind, const struct relume_pack_info *i)
{
    const char *dot = strrchr(path, '.');
    struct stat s;
    if (kind == RELUME_KIND_RELUME)
        return (double)i->file_bytes;
    if (kind == RELUME_KIND_CAPTURE || (dot && !strcasecmp(dot, ".json")))
        return (double)NAN;
    return !stat(path, &s) && S_ISREG(s.st_mode) ? (double)s.st_size : (double)NAN;
}

static double bits_per_pixel(const struct relume_pack_info *i, double bytes)
{
    return 8.0 * bytes / ((double)i->views * (double)i->width * (double)i->height);
}

static void put_sizes(struct jwriter *w, const struct relume_pack_info *i,
                      const struct relume_coder_info *c, enum relume_kind kind)
{
    const bool slab = i->geometry.projection == RELUME_SLAB;
    jput_text(w, "format", "relume");
    jput_text(w, "source", relume_kind_name(kind));
    jput_integer(w, "version", i->version);
    jput_text(w, "projection", relume_projection_name(i->geometry.projection));
    jput_integer(w, "views", i->views);
    jput_integer(w, "width", i->width);
    jput_integer(w, "height", i->height);
    jput_integer(w, "lights", c->lights);
    jput_truth(w, "hemispherical", c->hemispherical);
    jput_truth(w, "discs", i->geometry.disc);
    jput_integer(w, "slabs", i->slabs ? i->slabs : slab);
}

static void put_coding(struct jwriter *w, const struct relume_pack_info *i,
                       const struct relume_coder_info *c, const char *display)
{
    jput_text(w, "basis", c->basis->name);
    jput_integer(w, "coefficients", i->coefficients);
    jput_integer(w, "planes", i->planes);
    jput_text(w, "interpolant", c->interpolant ? c->interpolant->name : NULL);
    jput_text(w, "domain", relume_domain_name(i->domain, i->display));
    jput_text(w, "display", display);
    jput_text(w, "bits", relume_storage_name(i->storage));
    jput_text(w, "compression", i->compression);
    jput_integer(w, "levels", i->levels);
    jput_integer(w, "tile", i->tile);
}

static void print_json(const struct relume_pack_info *i, const struct relume_coder_info *c,
                       const char *display, enum relume_kind kind, double bytes)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    put_sizes(&w, i, c, kind);
    put_coding(&w, i, c, display);
    jput_truth(&w, "check_sums", kind == RELUME_KIND_RELUME && i->has_sums);
    jput_raw(&w, "made_from", i->provenance);
    jput_integer(&w, "books", i->books);
    jput_integer(&w, "codes", i->codes);
    jput_truth(&w, "shared", i->shared);
    jput_number(&w, "fit_rms", i->report.fit_rms, 9);
    jput_number(&w, "store_rms", i->report.store_rms, 9);
    jput_truth(&w, "depth", i->has_depth);
    jput_truth(&w, "mask", i->has_mask);
    jput_truth(&w, "shadows", i->has_shadow);
    jput_truth(&w, "highlights", i->has_gloss);
    jput_fixed(&w, "file_bytes", bytes, 0);
    jput_number(&w, "bits_per_pixel", bits_per_pixel(i, bytes), 9);
    jend(&w);
}

// A share of white, as people say it.
static const char *percent(char text[24], double share)
{
    if (share < 1e-4)
        snprintf(text, 24, share > 0.0 ? "below 0.01 %%" : "0 %%");
    else
        snprintf(text, 24, "%.*f %%", share < 0.01 ? 2 : 1, 100.0 * share);
    return text;
}

static const char *yes_or_no(bool has_sums)
{
    return has_sums ? "yes; 'relume check' finds any byte that has changed"
                    : "no; made by an earlier version";
}

static void print_text(const struct relume_pack_info *i, const struct relume_coder_info *c,
                       const char *display, enum relume_kind kind, double bytes)
{
    char model[24], rounding[24];
    if (kind != RELUME_KIND_RELUME)
        printf("source        %s; the lines below describe it as relume reads it\n",
               relume_kind_name(kind));
    printf("projection    %s%s\n", relume_projection_name(i->geometry.projection),
           i->geometry.disc ? ", with end discs" : "");
    if (i->slabs)
        printf("slabs         %d\n", i->slabs);
    printf("views         %d of %d x %d pixels\n", i->views, i->width, i->height);
    printf("lights        %d, %s\n", c->lights,
           c->hemispherical ? "one hemisphere" : "whole sphere");
    printf("basis         %s, %d coefficient%s %s\n", c->basis->name, i->coefficients,
           relume_plural(i->coefficients),
           c->luminance ? "and a colour"
           : c->joint   ? "for all channels"
                        : "per channel");
    if (c->interpolant)
        printf("interpolant   %s\n", c->interpolant->name);
    if (i->domain == RELUME_DOMAIN_LINEAR)
        printf("domain        linear\n");
    else
        printf("domain        %s (%s)\n", relume_domain_name(i->domain, i->display), display);
    printf("storage       %s%s, %s\n", relume_storage_name(i->storage),
           relume_storage_top(i->storage) ? " bits" : "", i->compression);
    if (i->books)
        printf("codebooks     %d of %d vector%s, %s\n", i->books, i->codes, relume_plural(i->codes),
               i->shared ? "for all views" : "for each view");
    if (isfinite(i->report.fit_rms))
        printf("error         %s of white from the model, %s from rounding (RMS over the "
               "photographs)\n",
               percent(model, i->report.fit_rms), percent(rounding, i->report.store_rms));
    if (i->levels)
        printf("pyramid       %d smaller level%s, tiles of %d pixels\n", i->levels,
               relume_plural(i->levels), i->tile);
    const char *extra[] = {i->has_depth ? "depth" : NULL, i->has_shadow ? "shadows" : NULL,
                           i->has_gloss ? "highlights" : NULL, i->has_mask ? "mask" : NULL};
    int extras = 0;
    printf("extras        ");
    for (size_t k = 0; k < sizeof extra / sizeof *extra; k++)
        if (extra[k])
            printf("%s%s", extras++ ? ", " : "", extra[k]);
    puts(extras ? "" : "none");
    if (i->provenance)
        puts("made from     camera, exposure and check sum of each photograph: --json lists them");
    if (kind == RELUME_KIND_RELUME)
        printf("check sums    %s\n", yes_or_no(i->has_sums));
    if (isfinite(bytes))
        printf("file          %.0f bytes, %.3f bits per pixel and view\n", bytes,
               bits_per_pixel(i, bytes));
}

static void print_part_json(const struct relume_pack_part *p)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_text(&w, "format", "relume part");
    jput_integer(&w, "part", p->part);
    jput_integer(&w, "parts", p->parts);
    jput_integer(&w, "first_view", p->first);
    jput_integer(&w, "views", p->views);
    jput_integer(&w, "all_views", p->all_views);
    jput_integer(&w, "first_row", p->row);
    jput_integer(&w, "rows", p->rows);
    jput_integer(&w, "tiles", p->tiles);
    jput_integer(&w, "all_tiles", p->all_tiles);
    jput_text(&w, "options", p->options);
    jput_truth(&w, "check_sums", p->has_sums);
    jput_integer(&w, "file_bytes", (long long)p->file_bytes);
    jend(&w);
}

static void print_part(const struct relume_pack_part *p, bool json)
{
    struct shown text;
    if (json) {
        print_part_json(p);
        return;
    }
    printf("part          %d of %d; 'relume join' makes one file of all parts\n", p->part,
           p->parts);
    if (p->coded)
        printf("views         %d of %d, in groups of neighbours\n", p->views, p->all_views);
    else
        printf("views         %d to %d of %d\n", p->first, p->first + p->views - 1, p->all_views);
    if (p->rows)
        printf("rows          %d to %d\n", p->row, p->row + p->rows - 1);
    if (p->tiles < p->all_tiles)
        printf("tiles         %d of %d of these views\n", p->tiles, p->all_tiles);
    printf("options       %s\n", p->options[0] ? shown(&text, p->options) : "none");
    printf("check sums    %s\n", yes_or_no(p->has_sums));
    printf("file          %llu bytes\n", (unsigned long long)p->file_bytes);
}

// ---------------------------------------------------------------- scene files

static void put_entity(struct jwriter *w, const struct relume_tableau_entity *e)
{
    jopen_object(w, NULL);
    jput_text(w, "name", e->name);
    if (e->pack) {
        const struct relume_geometry *g = &relume_pack_info(e->pack)->geometry;
        jput_text(w, "kind", relume_projection_name(g->projection));
        jput_integer(w, "instead_of", e->instead_of);
    } else {
        jput_text(w, "kind", "mesh");
        jput_integer(w, "triangles", (long long)e->triangles);
    }
    jclose(w);
}

static void print_scene_json(const struct relume_tableau_info *info)
{
    const struct relume_camera *c = &info->camera;
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_text(&w, "format", "relume scene");
    jput_integer(&w, "captures", info->captures);
    jput_integer(&w, "objects", info->entities - info->captures);
    jopen_array(&w, "entities");
    for (int i = 0; i < info->entities; i++)
        put_entity(&w, &info->entity[i]);
    jclose(&w);
    jput_vector(&w, "eye", c->eye, 9);
    jput_vector(&w, "look_at", c->look_at.at, 9);
    jput_number(&w, "fov", c->look_at.field_of_view_deg, 9);
    jput_integer(&w, "width", c->width);
    jput_integer(&w, "height", c->height);
    jend(&w);
}

static void print_scene_text(const struct relume_tableau_info *info)
{
    const struct relume_camera *c = &info->camera;
    struct shown text;
    const int objects = info->entities - info->captures;
    printf("scene         %d capture%s, %d object%s\n", info->captures,
           relume_plural(info->captures), objects, relume_plural(objects));
    for (int i = 0; i < info->entities; i++) {
        const struct relume_tableau_entity *e = &info->entity[i];
        printf("%-13s ", e->pack ? "capture" : "object");
        if (e->pack) {
            const struct relume_pack_info *p = relume_pack_info(e->pack);
            printf("%s: %s, %d view%s of %d x %d pixels", shown(&text, e->name),
                   relume_projection_name(p->geometry.projection), p->views,
                   relume_plural(p->views), p->width, p->height);
        } else {
            printf("%s: %zu triangles", shown(&text, e->name), e->triangles);
        }
        if (e->instead_of >= 0)
            printf(", from afar instead of %s", shown(&text, info->entity[e->instead_of].name));
        printf("\n");
    }
    printf("camera        at %g,%g,%g, looks at %g,%g,%g, %.3g degrees, %d x %d pixels\n", c->eye.x,
           c->eye.y, c->eye.z, c->look_at.at.x, c->look_at.at.y, c->look_at.at.z,
           c->look_at.field_of_view_deg, c->width, c->height);
}

static relume_status tell_scene(const struct info_options *o)
{
    relume_tableau *tableau;
    const relume_status status = relume_tableau_open(
        &tableau, o->args.input[0],
        relume_tableau_params(.log = o->args.log, .limits = &o->args.limits,
                              .threads = o->args.threads, .allow_outside = o->allow_outside,
                              .keep_going = o->keep_going));
    if (!status)
        (o->json ? print_scene_json : print_scene_text)(relume_tableau_info(tableau));
    relume_tableau_destroy(&tableau);
    return status;
}

static relume_status tell_baked(const struct info_options *o)
{
    relume_baked *baked = NULL;
    const relume_status status =
        relume_baked_open(&baked, o->args.input[0], &o->args.limits, o->args.log);
    if (!status)
        print_baked(o->args.input[0], baked, o->json);
    relume_baked_destroy(&baked);
    return status;
}

// ---------------------------------------------------------------- the command

static relume_status run_info(const struct args *args)
{
    const struct info_options *o = (const void *)args;
    const char *path = o->args.input[0];
    const enum relume_kind kind = relume_kind_of(path);
    if (kind == RELUME_KIND_SCENE)
        return tell_scene(o);
    if (kind == RELUME_KIND_BAKED)
        return tell_baked(o);
    struct relume_pack_part part;
    if (is_part(&part, path)) {
        print_part(&part, o->json);
        return RELUME_OK;
    }
    relume_pack *pack;
    const relume_status status =
        relume_open(&pack, path,
                    relume_open_params(.log = o->args.log, .allow_outside = o->allow_outside,
                                       .keep_going = o->keep_going));
    if (status)
        return status;
    const struct relume_pack_info *info = relume_pack_info(pack);
    char display[32];
    relume_transfer_text(info->display, display, sizeof display);
    (o->json ? print_json : print_text)(info, relume_coder_info(info->coder), display, kind,
                                        bytes_of(path, kind, info));
    relume_pack_destroy(&pack);
    return RELUME_OK;
}

const struct command command_info = {
    COMMAND(
        run_info, "info", "FILE [--json]",
        "show what a file holds: a relume file, scene file, baked object, .ptm, .rti, web folder, "
        "capture, HDR picture",
        "relume info statue.exr --json", 1, 1),
};
