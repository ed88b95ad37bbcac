// cmd_hdr.c - relume hdr: exposures of one picture become one radiance map
#include "commands/bracket.h"
#include "commands/capture_times.h"
#include "fill.h"
#include "output_name.h"

#include <stdlib.h>
#include <string.h>

#define OPTIONS struct hdr_options

static const struct option options[] = {
    TEXT_AS(OPTION_OUTPUT, "-o", output, "output", "OUT",
            "the picture to write; for several brackets the folder of their pictures"),
    FLAG("--json", json, "output", "print one JSON object"),
    TEXT("--transfer", transfer, "input", "T", "linear, srgb or gamma:G; default: by file"),
    FLAG("--skip-bad", skip_bad, "input", "leave out photographs that cannot be read or used"),
    TEXT("--times", times, "exposures", "FILE", "exposure times, lines 'name seconds'"),
    TEXT("--response", response, "exposures", "FILE", "use this response curve of the camera"),
    TEXT_AS(OPTION_OUTPUT, "--save-response", save_response, "exposures", "FILE",
            "write the response that was found"),
    TEXT("--weights", weights, "exposures", "W", "spline (default), hat or gaussian"),
    TEXT("--align", align, "exposures", "A", "none, blocks or homography; default: none"),
    FLAG("--ghosts", ghosts, "exposures", "leave out what moved between exposures"),
    TEXT("--white", white, "corrections", "x,y,w,h",
         "a region that is grey: the lamps' colour is divided out"),
    TEXT("--flat", flat, "corrections", "PATH",
         "photograph of an even surface, divided out; one, or one under each light"),
    FLAG("--radial", radial, "corrections",
         "--flat: as a polynomial of the distance from the middle"),
    FLAG("--hdr", old, "input", NULL),  // of relume capture
    {0},
};

struct choices {
    enum relume_merge_weights weights;
    enum align_mode align;
    bool is_file;  // -o names one picture: all photographs are one bracket
    int white[4];
    bool has_white;
};

// ---------------------------------------------------------------- options

static relume_status parse_choices(struct choices *out, const struct hdr_options *o)
{
    static const char *const modes[] = {"none", "blocks", "homography", NULL};
    const char *names[8] = {NULL};
    const char *weights = o->weights;
    const char *align = o->align;
    const char *output = o->output;
    const char *white = o->white;
    double region[4];
    int mode = 0;
    *out = (struct choices){0};
    if (!output)
        return usage_error("hdr: expected -o OUT.exr, or a folder for several brackets");
    out->is_file = strchr(base_name(output), '.') || relume_image_saves_linear(output);
    if (out->is_file && picture_name("-o", output))
        return RELUME_EINVAL;
    for (int i = 0; relume_merge_weights_name((enum relume_merge_weights)i); i++)
        names[i] = relume_merge_weights_name((enum relume_merge_weights)i);
    if (relume_merge_weights_parse(&out->weights, weights))
        return unknown_name("--weights", weights, names);
    while (modes[mode] && strcmp(modes[mode], align))
        mode++;
    if (!modes[mode])
        return unknown_name("--align", align, modes);
    out->align = (enum align_mode)mode;
    out->has_white = white != NULL;
    if (white && !parse_numbers(white, region, 4))
        return usage_error("--white: expected x,y,width,height; found '%s'", white);
    for (int i = 0; white && i < 4; i++)
        out->white[i] = region[i] > -1e6 && region[i] < 1e6 ? (int)region[i] : -1;
    return RELUME_OK;
}

// ---------------------------------------------------------------- report

static void put_photo_json(FILE *out, const struct bracket *b, int i)
{
    const struct relume_exposure_report *r = &b->report[i];
    const struct {
        const char *name;
        double value;
    } numbers[] = {
        {"time_s", b->notes[i].time_s},
        {"exposure", b->exposure[i]},
        {"residual_ev", r->residual_ev},
        {"bias_ev", r->bias_ev},
        {"noise_ev", r->noise_ev},
        {"saturated", r->saturated},
        {"black", r->black},
        {"used", r->used},
        {"shift_px", b->shift[i]},
        {"ghosts", b->ghosts[i]},
    };
    fprintf(out, "%s\n    {\"file\": ", i ? "," : "");
    json_text(out, b->path[i]);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        fprintf(out, ", \"%s\": ", numbers[k].name);
        json_number(out, numbers[k].value);
    }
    fputc('}', out);
}

static void print_json(FILE *out, const struct bracket *b, const char *output, int index)
{
    fprintf(out, "%s{\"output\": ", index ? ",\n  " : "");
    json_text(out, output);
    fprintf(out, ", \"width\": %d, \"height\": %d, \"anchor\": ", b->out.width, b->out.height);
    json_text(out, b->path[b->anchor]);
    fprintf(out, ", \"response\": ");
    json_text(out, b->response_source);
    fprintf(out, ", \"photos\": [");
    for (int i = 0; i < b->n; i++)
        put_photo_json(out, b, i);
    fprintf(out, "]}");
}

static void print_table(FILE *out, const struct bracket *b, const char *output)
{
    struct shown name, source;
    fprintf(out, "%s: %d x %d pixels, response %s\n", shown(&name, output), b->out.width,
            b->out.height, shown(&source, b->response_source));
    fprintf(out, "%-24s %10s %9s %8s %8s %7s %7s %7s %7s\n", "photograph", "time s", "residual",
            "bias EV", "noise EV", "white", "black", "shift", "ghosts");
    for (int i = 0; i < b->n; i++) {
        const struct relume_exposure_report *r = &b->report[i];
        fprintf(out, "%-24s %10.5g %9.3f %8.3f %8.3f %6.1f%% %6.1f%% %7.2f %6.1f%%%s\n",
                shown(&name, base_name(b->path[i])), b->notes[i].time_s, r->residual_ev, r->bias_ev,
                r->noise_ev, 100.0 * r->saturated, 100.0 * r->black, b->shift[i],
                100.0 * b->ghosts[i], i == b->anchor ? "  anchor" : "");
    }
}

// ---------------------------------------------------------------- one bracket

static relume_status divide_flat(struct bracket *b, const char *flat, const struct hdr_options *o)
{
    struct relume_image image;
    struct prefix_log log;
    relume_status status = relume_photograph_load(
        &image, NULL, flat, relume_photograph_params(.log = o->args.log, .codes = true));
    if (status)
        return status;
    const size_t samples = 3 * (size_t)image.width * (size_t)image.height;
    for (size_t i = 0; i < samples; i++)
        image.data[i] = relume_response_decode(&b->response, (int)(i % 3), image.data[i]);
    if (o->radial) {
        struct relume_falloff falloff;
        status = relume_falloff_fit(&falloff, &image, prefix_log(&log, o->args.log, flat));
        if (!status)
            relume_falloff_divide(&b->out, &falloff);
    } else {
        status = relume_flat_divide(&b->out, &image, prefix_log(&log, o->args.log, flat));
    }
    relume_image_destroy(&image);
    return status == RELUME_EINVAL ? RELUME_EUNFIT : status;
}

static relume_status whiten(struct bracket *b, const struct choices *c, const struct hdr_options *o)
{
    float gain[3];
    struct prefix_log log;
    const relume_status status =
        relume_white_measure(gain, &b->out, c->white[0], c->white[1], c->white[2], c->white[3],
                             prefix_log(&log, o->args.log, "--white"));
    if (!status)
        relume_white_apply(&b->out, gain);
    return status;
}

static relume_status run_bracket(struct bracket *b, const struct choices *c, const char *output,
                                 const char *to, int index, FILE *report,
                                 const struct hdr_options *o)
{
    const char *flat = o->flat;
    relume_status status = bracket_load(b, o);
    if (!status)
        status = bracket_align(b, c->align, o);
    if (!status)
        status = bracket_check(b, o);
    if (!status)
        status = bracket_merge(b, c->weights, o);
    if (!status && flat)
        status = divide_flat(b, flat, o);
    if (!status && c->has_white)
        status = whiten(b, c, o);
    if (!status)
        status = relume_image_save(
            &b->out, to,
            relume_image_params(.log = o->args.log, .threads = o->args.threads > 0
                                                                   ? o->args.threads
                                                                   : relume_cpu_count()));
    if (status)
        return status;
    if (o->json)
        print_json(report, b, output, index);
    else
        print_table(report, b, output);
    return RELUME_OK;
}

// ---------------------------------------------------------------- all of them

static relume_status read_notes(struct relume_exif *notes, struct relume_photographs *list,
                                const struct hdr_options *o)
{
    const struct relume_log silent = {.inputs = o->args.log->inputs, .limits = o->args.log->limits};
    const bool skip = o->skip_bad;
    for (int i = 0; i < list->count; i++) {
        const relume_status status =
            relume_exif_read(&notes[i], list->path[i], skip ? &silent : o->args.log);
        if (status && !(skip && relume_status_is_input(status)))
            return status;
    }
    const char *times = o->times;
    const relume_status status = times ? read_times(times, list, notes, o->args.log) : RELUME_OK;
    for (int i = 0; !status && i < list->count; i++)
        if (!(notes[i].time_s > 0.0) && notes[i].width > 0)
            return data_error("%s: no exposure time in its EXIF; expected --times FILE",
                              list->path[i]);
    return status;
}

static int photos_of(struct bracket *b, const struct relume_photographs *list,
                     const struct relume_exif *notes, const int *group, int which)
{
    int n = 0;
    for (int i = 0; i < list->count; i++)
        if (group[i] == which && n++ < MAX_BRACKET) {
            b->path[n - 1] = list->path[i];
            b->notes[n - 1] = notes[i];
        }
    b->n = n < MAX_BRACKET ? n : MAX_BRACKET;
    return n;
}

static void output_name(char *out, size_t size, const struct choices *c, const struct bracket *b,
                        const char *output)
{
    const char *name = base_name(b->path[0]);
    const char *dot = strrchr(name, '.');
    const int length = dot ? (int)(dot - name) : (int)strlen(name);
    if (c->is_file)
        snprintf(out, size, "%s", output);
    else
        snprintf(out, size, "%s/%.*s.exr", output, length, name);
}

static relume_status run_group(const struct choices *c, const struct relume_photographs *list,
                               const struct relume_exif *notes, const int *group, int which,
                               const char *to, FILE *report, const struct hdr_options *o)
{
    char output[4096], written[4096];
    struct bracket *b = calloc(1, sizeof *b);
    if (!b)
        return RELUME_ENOMEM;
    const int n = photos_of(b, list, notes, group, which);
    output_name(output, sizeof output, c, b, o->output);
    output_name(written, sizeof written, c, b, to);
    const relume_status status =
        n > MAX_BRACKET ? data_error("%s: %d photographs in one bracket; expected at most %d",
                                     list->path[0], n, MAX_BRACKET)
                        : run_bracket(b, c, output, written, which, report, o);
    bracket_free(b);
    free(b);
    return status;
}

static relume_status run_groups(const struct choices *c, struct relume_photographs *list,
                                struct relume_exif *notes, int *group, FILE *report,
                                const struct hdr_options *o)
{
    const bool json = o->json;
    int groups = 1;
    struct fill folder = {.path = o->output};
    relume_status status = read_notes(notes, list, o);
    if (!status && !c->is_file) {
        groups = relume_exif_brackets(group, notes, list->count, 0.0);
        status = groups > 0 ? fill_open(&folder, folder.path, o->args.log) : RELUME_ENOMEM;
    }
    fputs(json ? "{\"brackets\": [" : "", report);
    for (int i = 0; !status && i < groups; i++)
        status = run_group(c, list, notes, group, i, folder.path, report, o);
    fputs(json ? "]}\n" : "", report);
    return fill_end(&folder, status);
}

// The report is printed when all went well.
static relume_status run(const struct args *args)
{
    const struct hdr_options *o = (const void *)args;
    struct choices choices;
    struct relume_photographs list;
    char *text = NULL;
    size_t size = 0;
    relume_status status = parse_choices(&choices, o);
    if (!status)
        status = relume_photographs_list(
            &list, o->args.input, o->args.inputs,
            relume_photographs_params(.log = o->args.log, .by_products = true));
    if (status)
        return status;
    struct relume_exif *notes = calloc((size_t)list.count, sizeof *notes);
    int *group = calloc((size_t)list.count, sizeof *group);
    FILE *report = open_memstream(&text, &size);
    status = notes && group && report ? run_groups(&choices, &list, notes, group, report, o)
                                      : RELUME_ENOMEM;
    if (report && fclose(report) && !status)
        status = RELUME_ENOMEM;
    if (!status)
        fputs(text, stdout);
    free(text);
    free(notes);
    free(group);
    relume_photographs_free(&list);
    return status;
}

const struct command command_hdr = {
    .name = "hdr",
    .usage = "PHOTO... -o OUT.exr|DIR [OPTION ...]",
    .summary = "merge exposures of one picture into an HDR picture",
    .example = "relume hdr church/*.jpg --align blocks -o church.exr",
    .min_inputs = 1,
    .max_inputs = 4096,
    .options = options,
    .size = sizeof(struct hdr_options),
    .defaults = &(const struct hdr_options){.weights = "spline", .align = "none"},
    .run = run,
};
