// cmd_publish.c - relume publish: relightable files as a web site
#include "cli/commands/crop_option.h"

#include <relume/publish.h>
#include <string.h>

struct publish_options {
    struct args args;
    const char *output, *title, *maker, *licence, *object, *description, *metadata, *url;
    enum relume_publish_for target;
    enum relume_publish_layers layers;
    int coefficients, quality;
    double bytes_per_pixel, psnr, mm_per_pixel;
    struct crop crop;
    bool force, allow_outside, keep_going;
};
#define OPTIONS struct publish_options
enum { MOST_FILES = 256 };

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "SITE", "the folder to write"),
    FLAG("--force", force, "replace a folder that relume made"),
    NAME("--for", target, "WHERE",
         "both (default), web (smaller: works from a server only) or disk (works from a disk only)",
         RELUME_PUBLISH_BOTH, "both", "web", "disk"),
    GROUP("what visitors read"),
    PROSE("--title", title, "TEXT", "default: the name of the file"),
    PROSE("--maker", maker, "TEXT", "who made it"),
    PROSE("--licence", licence, "TEXT", "what others may do with it"),
    PROSE("--object", object, "TEXT", "number in the collection"),
    PROSE("--description", description, "TEXT", "a few sentences"),
    TEXT("--metadata", metadata, "FILE.json", "all of these for many files (docs/publish.md)"),
    PROSE("--url", url, "URL", "where the site will be, for links from elsewhere"),
    NUMBER("--mm-per-pixel", mm_per_pixel, "X", "scale of planar files", 1e-6, 1e6),
    GROUP("quality"),
    NAME("--layers", layers, "KIND",
         "jpeg (default: every browser), avif (smaller, slower to make; browsers since 2023) or "
         "both",
         RELUME_PUBLISH_JPEG, "jpeg", "avif", "both"),
    INT("--quality", quality, "Q",
        "10 less doubles the quantiser step; default: 95 or more, so that no blocks are seen", 1,
        100),
    NUMBER("--psnr", psnr, "DB", "at least this PSNR against the original", 1, 100),
    NUMBER("--bytes-per-pixel", bytes_per_pixel, "B", "size at full resolution, not exceeded",
           0.001, 100),
    INT("--coefficients", coefficients, "K", "planes; default: up to 27, as many as are worth it",
        1, 90),
    GROUP("input"),
    CROP_OPTION,
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    {0},
};

static void print_advice(const struct publish_options *o, const struct relume_publish_report *r)
{
    switch (r->advice) {
    case RELUME_PUBLISH_NO_ADVICE: break;
    case RELUME_PUBLISH_CODE_DISPLAY:
        announce(&o->args, RELUME_NOTE,
                 "%s/%s.html: dark places of linear files need more than its 8 bits; a file of "
                 "'relume encode --domain display' comes nearer",
                 o->output, r->name);
        break;
    case RELUME_PUBLISH_RAISE_QUALITY:
        announce(
            &o->args, RELUME_NOTE,
            "%s/%s.html: its hard shadows and highlights are softer than in the file, for they "
            "need more than %d planes; --quality 100 comes nearest",
            o->output, r->name, r->planes);
        break;
    }
}

static void print_report(const struct publish_options *o, const struct relume_publish_report *r)
{
    if (!r->views) {
        announce(&o->args, RELUME_NOTE, "%s/%s.html: an object, %.1f kB", o->output, r->name,
                 (double)r->bytes / 1e3);
        return;
    }
    announce(&o->args, RELUME_NOTE,
             "%s/%s.html: %d view%s, %d planes, %.1f kB, of which %.1f kB show the first picture; "
             "%.2f dB from the original (%s)",
             o->output, r->name, r->views, relume_plural(r->views), r->planes,
             (double)r->bytes / 1e3, (double)r->first_bytes / 1e3, r->psnr_db,
             judgement(r->psnr_db));
    if (r->avif_bytes && r->avif_bytes < r->bytes)
        announce(&o->args, RELUME_NOTE, "%s/%s.html: %.1f kB of it as AVIF, %.1f kB as JPEG",
                 o->output, r->name, (double)r->avif_bytes / 1e3,
                 (double)(r->bytes - r->avif_bytes) / 1e3);
    print_advice(o, r);
}

static struct relume_publish_params read_options(const struct publish_options *o)
{
    struct relume_publish_params p = {
        .struct_size = sizeof(struct relume_publish_params),
        .log = o->args.log,
        .title = o->title,
        .maker = o->maker,
        .licence = o->licence,
        .object = o->object,
        .description = o->description,
        .metadata = o->metadata,
        .coefficients = o->coefficients,
        .quality = o->quality,
        .psnr_db = o->psnr,
        .bytes_per_pixel = o->bytes_per_pixel,
        .target = o->target,
        .layers = o->layers,
        .mm_per_pixel = o->mm_per_pixel,
        .url = o->url,
        .force = o->force,
        .allow_outside = o->allow_outside,
        .keep_going = o->keep_going,
        .crop_auto = o->crop.automatic,
        .threads = o->args.threads,
    };
    memcpy(p.crop, o->crop.part, sizeof p.crop);
    return p;
}

static relume_status run_publish(const struct args *args)
{
    const struct publish_options *o = (const void *)args;
    const struct relume_publish_params params = read_options(o);
    struct relume_publish_report report[MOST_FILES];
    const relume_status status =
        relume_publish_files(o->output, args->input, args->inputs, &params, report);
    for (int i = 0; !status && i < args->inputs; i++)
        print_report(o, &report[i]);
    return status;
}

const struct command command_publish = {
    COMMAND(run_publish, "publish", "FILE ... -o SITE [OPTION ...]",
            "make a web site of relightable files, for any server or a disk",
            "relume publish coin.exr seal.exr -o site --title \"Coins\" --licence \"CC BY 4.0\"", 1,
            MOST_FILES),
};
