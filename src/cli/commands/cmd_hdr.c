// cmd_hdr.c - relume hdr: exposures of one picture become one radiance map
#include "cli/commands/bracket.h"
#include "cli/commands/capture_times.h"
#include "cli/fill.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OPTIONS struct hdr_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT",
           "the picture to write; for several brackets the folder of their pictures"),
    FLAG("--json", json, "print one JSON object"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; default: by file"),
    FLAG("--skip-bad", skip_bad, "leave out photographs that cannot be read or used"),
    FLAG("--hdr", old, NULL),  // of relume capture
    GROUP("exposures"),
    TEXT("--times", times, "FILE", "exposure times: a text file with lines 'name seconds'"),
    TEXT("--response", response, "FILE", "use this response curve of the camera"),
    TEXT_AS(OPTION_OUTPUT, "--save-response", save_response, "FILE",
            "write the response curve that was found"),
    NAME("--weights", weights, "W",
         "how much each brightness counts: spline (default), hat or gaussian", RELUME_MERGE_SPLINE,
         "spline", "hat", "gaussian"),
    NAME("--align", align, "A",
         "move the photographs onto each other: none, blocks or homography; default: none",
         ALIGN_NONE, "none", "blocks", "homography"),
    FLAG("--ghosts", ghosts, "leave out what moved between exposures"),
    GROUP("corrections"),
    NUMBERS("--white", white, "x,y,w,h",
            "a grey region of the picture: removes the colour of the lamps", 4),
    TEXT("--flat", flat, "PATH",
         "photograph of an even white surface: removes uneven light; one, or one for each "
         "photograph"),
    FLAG("--radial", radial,
         "--flat: use only how it falls off from the middle, as a smooth curve"),
    {0},
};

// -o names one picture: all photographs are one bracket.
static bool is_file(const char *output)
{
    return strchr(path_name(output), '.') || relume_image_saves_linear(output);
}

// ---------------------------------------------------------------- report

static void put_photo(struct jwriter *w, const struct bracket *b, int i)
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
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_text(w, "file", b->path[i]);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        jput_number(w, numbers[k].name, numbers[k].value, 9);
    jclose(w);
}

static void put_bracket(struct jwriter *w, const struct bracket *b, const char *output, int index)
{
    if (index)
        jgap(w, "\n  ");
    jopen_object(w, NULL);
    jput_text(w, "output", output);
    jput_integer(w, "width", b->out.width);
    jput_integer(w, "height", b->out.height);
    jput_text(w, "anchor", b->path[b->anchor]);
    jput_text(w, "response", b->response_source);
    jopen_array(w, "photos");
    for (int i = 0; i < b->n; i++)
        put_photo(w, b, i);
    jclose_levels(w, 2);
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
                shown(&name, path_name(b->path[i])), b->notes[i].time_s, r->residual_ev, r->bias_ev,
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

static relume_status whiten(struct bracket *b, const struct hdr_options *o)
{
    float gain[3];
    int w[4];
    struct prefix_log log;
    for (int i = 0; i < 4; i++)
        w[i] = fabs(o->white[i]) < 1e6 ? (int)o->white[i] : -1;
    const relume_status status = relume_white_measure(gain, &b->out, w[0], w[1], w[2], w[3],
                                                      prefix_log(&log, o->args.log, "--white"));
    if (!status)
        relume_white_apply(&b->out, gain);
    return status;
}

// Into the file `to`, which will be called `output`.
static relume_status run_bracket(struct bracket *b, const char *output, const char *to, int index,
                                 struct jwriter *report, const struct hdr_options *o)
{
    const int threads = o->args.threads > 0 ? o->args.threads : relume_cpu_count();
    relume_status status = bracket_load(b, o);
    if (!status)
        status = bracket_align(b, o);
    if (!status)
        status = bracket_check(b, o);
    if (!status)
        status = bracket_merge(b, o);
    if (!status && o->flat)
        status = divide_flat(b, o->flat, o);
    if (!status && given(o, &o->white))
        status = whiten(b, o);
    if (!status)
        status = relume_image_save(&b->out, to,
                                   relume_image_params(.log = o->args.log, .threads = threads));
    if (!status && o->json)
        put_bracket(report, b, output, index);
    else if (!status)
        print_table(report->file, b, output);
    return status;
}

// ---------------------------------------------------------------- all of them

static relume_status read_notes(struct relume_exif *notes, struct relume_photographs *list,
                                const struct hdr_options *o)
{
    const struct relume_log silent = {.context = o->args.log->context};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < list->count; i++) {
        status = relume_exif_read(&notes[i], list->path[i], o->skip_bad ? &silent : o->args.log);
        if (o->skip_bad && relume_status_is_input(status))
            status = RELUME_OK;
    }
    if (!status && o->times)
        status = read_times(o->times, list, notes, o->args.log);
    for (int i = 0; !status && i < list->count; i++)
        if (!(notes[i].time_s > 0.0) && notes[i].width > 0)
            return data_error("%s: no exposure time in its EXIF; expected --times FILE",
                              list->path[i]);
    return status;
}

// Of a bracket into `to`, a file or a folder.
static void output_name(char *out, size_t size, const struct bracket *b, const char *to, bool file)
{
    const char *name = path_name(b->path[0]);
    const char *dot = strrchr(name, '.');
    if (file)
        snprintf(out, size, "%s", to);
    else
        snprintf(out, size, "%s/%.*s.exr", to, dot ? (int)(dot - name) : (int)strlen(name), name);
}

static relume_status run_group(const struct relume_photographs *list,
                               const struct relume_exif *notes, const int *group, int which,
                               const char *to, struct jwriter *report, const struct hdr_options *o)
{
    char output[4096], written[4096];
    struct bracket *b = calloc(1, sizeof *b);
    if (!b)
        return RELUME_ENOMEM;
    int n = 0;
    for (int i = 0; i < list->count; i++)
        if (group[i] == which && n++ < MAX_BRACKET) {
            b->path[b->n] = list->path[i];
            b->notes[b->n++] = notes[i];
        }
    output_name(output, sizeof output, b, o->output, is_file(o->output));
    output_name(written, sizeof written, b, to, is_file(o->output));
    const relume_status status =
        n > MAX_BRACKET ? data_error("%s: %d photographs in one bracket; expected at most %d",
                                     list->path[0], n, MAX_BRACKET)
                        : run_bracket(b, output, written, which, report, o);
    bracket_free(b);
    free(b);
    return status;
}

static relume_status run_groups(struct relume_photographs *list, struct relume_exif *notes,
                                int *group, struct jwriter *report, const struct hdr_options *o)
{
    int groups = 1;
    struct fill folder = {.path = o->output};
    relume_status status = read_notes(notes, list, o);
    if (!status && !is_file(o->output)) {
        groups = relume_exif_brackets(group, notes, list->count, 0.0);
        status = groups > 0 ? fill_open(&folder, folder.path, o->args.log) : RELUME_ENOMEM;
    }
    if (o->json) {
        jopen_object(report, NULL);
        jopen_array(report, "brackets");
    }
    for (int i = 0; !status && i < groups; i++)
        status = run_group(list, notes, group, i, folder.path, report, o);
    if (o->json)
        jend(report);
    return fill_end(&folder, status);
}

// The report is printed when all went well.
static relume_status run_hdr(const struct args *args)
{
    const struct hdr_options *o = (const void *)args;
    struct relume_photographs list;
    char *text = NULL;
    size_t size = 0;
    relume_status status =
        is_file(o->output) ? picture_name(args->log, "-o", o->output) : RELUME_OK;
    if (!status)
        status = relume_photographs_list(
            &list, o->args.input, o->args.inputs,
            relume_photographs_params(.log = o->args.log, .by_products = true));
    if (status)
        return status;
    struct relume_exif *notes = calloc((size_t)list.count, sizeof *notes);
    int *group = calloc((size_t)list.count, sizeof *group);
    struct jwriter report = json_to(open_memstream(&text, &size));
    status =
        notes && group && report.file ? run_groups(&list, notes, group, &report, o) : RELUME_ENOMEM;
    if (report.file && fclose(report.file) && !status)
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
    COMMAND(run_hdr, "hdr", "PHOTO... -o OUT.exr|DIR [OPTION ...]",
            "merge exposures of one picture into an HDR picture",
            "relume hdr church/*.jpg --align blocks -o church.exr", 1, 4096),
};
