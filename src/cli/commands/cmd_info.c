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

static void print_json(const struct relume_pack_info *i, const struct relume_coder_info *c,
                       const char *display, enum relume_kind kind, double bytes)
{
    printf("{\"format\": \"relume\", \"source\": \"%s\", \"version\": %d, \"projection\": \"%s\", "
           "\"views\": %d, "
           "\"width\": %d, \"height\": %d, \"lights\": %d, \"hemispherical\": %s, ",
           relume_kind_name(kind), i->version, relume_projection_name(i->geometry.projection),
           i->views, i->width, i->height, c->lights, c->hemispherical ? "true" : "false");
    printf("\"discs\": %s, ", i->geometry.disc ? "true" : "false");
    printf("\"slabs\": %d, ", i->slabs ? i->slabs : i->geometry.projection == RELUME_SLAB);
    printf("\"basis\": \"%s\", \"coefficients\": %d, \"planes\": %d, \"interpolant\": %s%s%s, "
           "\"domain\": \"%s\", "
           "\"display\": \"%s\", \"bits\": \"%s\", \"compression\": \"%s\", ",
           c->basis->name, i->coefficients, i->planes, c->interpolant ? "\"" : "",
           c->interpolant ? c->interpolant->name : "null", c->interpolant ? "\"" : "",
           relume_domain_name(i->domain, i->display), display, relume_storage_name(i->storage),
           i->compression);
    printf("\"levels\": %d, \"tile\": %d, ", i->levels, i->tile);
    printf("\"check_sums\": %s, ", kind == RELUME_KIND_RELUME && i->has_sums ? "true" : "false");
    printf("\"made_from\": %s, ", i->provenance ? i->provenance : "null");
    printf("\"books\": %d, \"codes\": %d, \"shared\": %s, ", i->books, i->codes,
           i->shared ? "true" : "false");
    printf("\"fit_rms\": ");
    json_number(stdout, i->report.fit_rms);
    printf(", \"store_rms\": ");
    json_number(stdout, i->report.store_rms);
    printf(", \"depth\": %s, \"mask\": %s, \"shadows\": %s, \"highlights\": %s, \"file_bytes\": ",
           i->has_depth ? "true" : "false", i->has_mask ? "true" : "false",
           i->has_shadow ? "true" : "false", i->has_gloss ? "true" : "false");
    if (isfinite(bytes))
        printf("%.0f", bytes);
    else
        json_number(stdout, bytes);
    printf(", \"bits_per_pixel\": ");
    json_number(stdout, bits_per_pixel(i, bytes));
    printf("}\n");
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

static void print_part(const struct relume_pack_part *p, bool json)
{
    struct shown text;
    if (json) {
        printf("{\"format\": \"relume part\", \"part\": %d, \"parts\": %d, \"first_view\": %d, "
               "\"views\": %d, \"all_views\": %d, \"first_row\": %d, \"rows\": %d, "
               "\"tiles\": %d, \"all_tiles\": %d, \"options\": ",
               p->part, p->parts, p->first, p->views, p->all_views, p->row, p->rows, p->tiles,
               p->all_tiles);
        json_text(stdout, p->options);
        printf(", \"check_sums\": %s, \"file_bytes\": %llu}\n", p->has_sums ? "true" : "false",
               (unsigned long long)p->file_bytes);
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

static void print_scene_json(const struct relume_tableau_info *info)
{
    const struct relume_camera *c = &info->camera;
    printf("{\"format\": \"relume scene\", \"captures\": %d, \"objects\": %d, \"entities\": [",
           info->captures, info->entities - info->captures);
    for (int i = 0; i < info->entities; i++) {
        const struct relume_tableau_entity *e = &info->entity[i];
        printf("%s{\"name\": ", i ? ", " : "");
        json_text(stdout, e->name);
        if (e->pack)
            printf(", \"kind\": \"%s\", \"instead_of\": %d}",
                   relume_projection_name(relume_pack_info(e->pack)->geometry.projection),
                   e->instead_of);
        else
            printf(", \"kind\": \"mesh\", \"triangles\": %zu}", e->triangles);
    }
    printf("], \"eye\": [%.9g, %.9g, %.9g], \"look_at\": [%.9g, %.9g, %.9g], \"fov\": %.9g, "
           "\"width\": %d, \"height\": %d}\n",
           c->eye.x, c->eye.y, c->eye.z, c->look_at.at.x, c->look_at.at.y, c->look_at.at.z,
           c->look_at.field_of_view_deg, c->width, c->height);
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

static relume_status run(const struct args *args)
{
    const struct info_options *o = (const void *)args;
    const char *path = o->args.input[0];
    if (relume_tableau_is(path))
        return tell_scene(o);
    if (relume_baked_is_file(path, &o->args.limits))
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
    const enum relume_kind kind = relume_kind_of(path);
    (o->json ? print_json : print_text)(info, relume_coder_info(info->coder), display, kind,
                                        bytes_of(path, kind, info));
    relume_pack_destroy(&pack);
    return RELUME_OK;
}

const struct command command_info = {
    COMMAND(
        "info", "FILE [--json]",
        "show what a file holds: a relume file, scene file, baked object, .ptm, .rti, web folder, "
        "capture, HDR picture",
        "relume info statue.exr --json", 1, 1),
};
