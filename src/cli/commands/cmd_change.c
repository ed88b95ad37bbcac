// cmd_change.c - relume change: what has changed between two captures of one object
#include "cli/cli.h"

struct change_options {
    struct args args;
    const char *output;
    int least_area, view_a, view_b;
    double least_deg, least_de, least_gloss, false_share, max_roll;
    bool force, json, keep_bend, skip_missing, allow_outside, keep_going;
};
#define OPTIONS struct change_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR", "the folder to make: report.html, pictures, measures"),
    FLAG("--force", force, "replace a folder that relume made"),
    FLAG("--json", json, "print one JSON object"),
    GROUP("what counts as change"),
    NUMBER("--least-angle", least_deg, "DEG", "smallest turn of the surface, degrees; default: 2",
           1e-6, 90),
    NUMBER("--least-colour", least_de, "DE",
           "smallest difference of colour, deltaE (CIEDE2000); default: 2", 1e-6, 100),
    NUMBER("--least-gloss", least_gloss, "PART",
           "smallest difference of highlights, a part of white; default: 0.03", 1e-6, 1),
    NUMBER("--false-share", false_share, "F",
           "of the marked pixels, at most this share may be marked by chance; default: 0.01", 1e-9,
           0.5),
    INT("--least-area", least_area, "PIXELS", "smallest place; default: 16", 1, 1 << 30),
    FLAG("--keep-bend", keep_bend,
         "count a smooth bend of the whole surface (warping wood, canvas) as change; default: it "
         "may come from the lights, and is taken away"),
    GROUP("input"),
    NUMBER("--max-roll", max_roll, "DEG",
           "how far B may be turned in its plane; default: 12; up to 180 takes longer", 1, 180),
    INT("--view-a", view_a, "N", "which view of a slab A; default: 0", 0, 65535),
    INT("--view-b", view_b, "N", "which view of a slab B; default: 0", 0, 65535),
    FLAG("--skip-missing", skip_missing, "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    {0},
};

// ---------------------------------------------------------------- what is said

static double percent_of(size_t area, const struct relume_change *c)
{
    return c->known ? 100.0 * (double)area / (double)c->known : 0.0;
}

static void say_result(const struct change_options *o, const struct relume_change *c)
{
    if (!c->places)
        announce(&o->args, RELUME_NOTE,
                 "%s: nothing has changed that is more than chance (normals are known to %.2f "
                 "degrees, colours to about %.1f deltaE)",
                 o->output, c->noise_deg, c->noise_de);
    else
        announce(&o->args, RELUME_NOTE,
                 "%s: %d place%s, %.3g %% of the surface, %s changed: %.3g %% in shape, %.3g %% in "
                 "colour, %.3g %% in gloss alone; see %s/report.html",
                 o->output, c->places, relume_plural(c->places), percent_of(c->area, c),
                 c->places == 1 ? "has" : "have", percent_of(c->shape, c), percent_of(c->colour, c),
                 percent_of(c->gloss_area, c), o->output);
    if (!c->gloss_known)
        announce(&o->args, RELUME_NOTE,
                 "%s: gloss was not compared; that takes more lamps near the mirror direction of "
                 "the surface",
                 o->output);
    if (c->misplaced > 0.5)
        announce(&o->args, RELUME_WARNING,
                 "%s: places are off by about %.1f pixels after alignment; fine changes at edges "
                 "are not seen. Same camera place and lens?",
                 o->output, c->misplaced);
}

static void put_place(struct jwriter *w, const struct relume_change_place *p)
{
    jopen_object(w, NULL);
    jput_integer(w, "x", p->box.left);
    jput_integer(w, "y", p->box.top);
    jput_integer(w, "width", p->box.width);
    jput_integer(w, "height", p->box.height);
    jput_integer(w, "area", p->area);
    jput_integer(w, "shape", p->shape);
    jput_integer(w, "colour", p->colour);
    jput_integer(w, "gloss", p->gloss);
    jput_number(w, "degrees", p->deg, 9);
    jput_number(w, "delta_e", p->delta_e, 9);
    jput_number(w, "gloss_by", p->gloss_by, 9);
    jput_number(w, "significance", p->significance, 9);
    jclose(w);
}

static void put_registration(struct jwriter *w, const struct relume_change *c)
{
    jput_number(w, "correlation", c->registered.correlation, 9);
    jput_number(w, "flow_pixels", c->flow, 9);
    jput_number(w, "misplaced_pixels", c->misplaced, 9);
    jput_number(w, "bend_degrees", c->bend_deg, 9);
    jput_numbers(w, "gain", c->gain, 3, 9);
    jopen_array(w, "homography");
    for (int i = 0; i < 9; i++)
        jput_number(w, NULL, c->registered.m[i / 3][i % 3], 9);
    jclose(w);
}

static void print_json(const struct relume_change *c)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "width", c->width);
    jput_integer(&w, "height", c->height);
    jput_integer(&w, "known", (long long)c->known);
    jput_integer(&w, "changed", (long long)c->area);
    jput_integer(&w, "shape", (long long)c->shape);
    jput_integer(&w, "colour", (long long)c->colour);
    jput_integer(&w, "gloss", (long long)c->gloss_area);
    jput_integer(&w, "gloss_known", (long long)c->gloss_known);
    jput_number(&w, "changed_percent", percent_of(c->area, c), 9);
    jput_number(&w, "noise_degrees", c->noise_deg, 9);
    jput_number(&w, "noise_delta_e", c->noise_de, 9);
    jput_number(&w, "noise_gloss", c->noise_gloss, 9);
    put_registration(&w, c);
    jopen_array(&w, "places");
    for (int i = 0; i < c->places; i++)
        put_place(&w, &c->place[i]);
    jend(&w);
}

// ---------------------------------------------------------------- the work

static relume_status open_input(struct relume_change_input *in, relume_capture **capture,
                                relume_pack **pack, const struct change_options *o, int which)
{
    const char *path = o->args.input[which];
    relume_status status;
    if (relume_kind_of(path) == RELUME_KIND_CAPTURE)
        status = relume_capture_open_photographs(
            capture, path,
            relume_capture_params(.log = o->args.log, .skip_missing = o->skip_missing,
                                  .allow_outside = o->allow_outside),
            NULL, NULL);
    else
        status = relume_open(pack, path,
                             relume_open_params(.log = o->args.log, .threads = o->args.threads,
                                                .keep_going = o->keep_going));
    *in = (struct relume_change_input){*capture, *pack, which ? o->view_b : o->view_a};
    return status;
}

static relume_status run_change(const struct args *args)
{
    const struct change_options *o = (const void *)args;
    struct relume_change_input in[2];
    relume_capture *capture[2] = {NULL, NULL};
    relume_pack *pack[2] = {NULL, NULL};
    struct relume_change change = {0};
    relume_status status = relume_folder_check(o->output, o->force, args->log);
    for (int i = 0; !status && i < 2; i++)
        status = open_input(&in[i], &capture[i], &pack[i], o, i);
    if (!status)
        status = relume_change_find(
            &change, &in[0], &in[1],
            relume_change_params(.log = args->log, .threads = args->threads,
                                 .least_deg = o->least_deg, .least_de = o->least_de,
                                 .false_share = o->false_share, .least_area = o->least_area,
                                 .least_gloss = o->least_gloss, .max_roll_deg = o->max_roll,
                                 .keep_bend = o->keep_bend));
    if (!status)
        status = relume_change_write(
            &change, o->output,
            relume_change_write_params(.log = args->log, .threads = args->threads,
                                       .force = o->force,
                                       .name = {args->input[0], args->input[1]}));
    if (!status)
        say_result(o, &change);
    if (!status && o->json)
        print_json(&change);
    relume_change_destroy(&change);
    for (int i = 0; i < 2; i++) {
        relume_capture_destroy(&capture[i]);
        relume_pack_destroy(&pack[i]);
    }
    return status;
}

const struct command command_change = {
    COMMAND(run_change, "change", "BEFORE AFTER -o DIR [OPTION ...]",
            "what has changed in shape, colour and gloss between two captures of one object",
            "relume change coin-2024 coin-2026 -o coin-change", 2, 2),
};
