// cmd_check.c - relume check: reads all of a file and says what is damaged
#include "cli/cli.h"

struct check_options {
    struct args args;
    bool json;
};
#define OPTIONS struct check_options

static const struct option options[] = {
    GROUP("output"),
    FLAG("--json", json, "one JSON object"),
    {0},
};

struct findings {
    const char *path;
    struct jwriter *json;  // NULL: lines for people
    int count;
};

static void print_damage(void *user, const char *part, int row, int rows)
{
    struct findings *f = user;
    struct shown path, name;
    if (f->json) {
        jopen_object(f->json, NULL);
        jput_text(f->json, "part", part);
        jput_integer(f->json, "first_row", row);
        jput_integer(f->json, "rows", rows);
        jclose(f->json);
    } else {
        printf("%s: part '%s', rows %d to %d: missing or damaged\n", shown(&path, f->path),
               shown(&name, part), row, row + rows - 1);
    }
    f->count++;
}

static void print_tile(void *user, const char *part, int column, int row,
                       const struct relume_rect *at)
{
    struct findings *f = user;
    struct shown path, name;
    if (f->json) {
        jopen_object(f->json, NULL);
        jput_text(f->json, "part", part);
        jput_integer(f->json, "column", column);
        jput_integer(f->json, "row", row);
        jput_integer(f->json, "x", at->left);
        jput_integer(f->json, "y", at->top);
        jput_integer(f->json, "width", at->width);
        jput_integer(f->json, "height", at->height);
        jclose(f->json);
    } else {
        printf("%s: part '%s', tile in column %d, row %d (pixels %d,%d to %d,%d): damaged\n",
               shown(&path, f->path), shown(&name, part), column, row, at->left, at->top,
               at->left + at->width - 1, at->top + at->height - 1);
    }
    f->count++;
}

// Writes the findings to `json`, or says them where it is NULL.
static relume_status check_file(const struct check_options *o, const char *path,
                                struct jwriter *json)
{
    struct findings f = {.path = path, .json = json};
    struct relume_pack_part part;
    struct shown name;
    bool has_sums = false;
    if (f.json) {
        jopen_object(json, NULL);
        jput_text(json, "file", path);
        jopen_array(json, "damaged");
    }
    const relume_status status = relume_pack_check(
        path, relume_pack_check_params(.log = o->args.log, .threads = o->args.threads,
                                       .found = print_damage, .tile = print_tile, .user = &f,
                                       .has_sums = &has_sums));
    const char *const unsure =
        has_sums ? "" : "; without check sums, so that not every changed byte is seen";
    if (json) {
        jclose(json);
        jput_truth(json, "check_sums", has_sums);
        jput_truth(json, "whole", !status);
        jclose(json);
    } else if (!status && is_part(&part, path))
        printf("%s: whole; part %d of %d%s\n", shown(&name, path), part.part, part.parts, unsure);
    else if (!status)
        printf("%s: whole%s\n", shown(&name, path), unsure);
    else if (f.count && relume_status_is_input(status))
        (void)data_error("%s: damaged; encode it again or take it from a copy", path);
    return status;
}

// All files are looked at; the worst status is the command's.
static relume_status run_check(const struct args *args)
{
    const struct check_options *o = (const void *)args;
    relume_status worst = RELUME_OK;
    struct jwriter w = json_to(stdout);
    if (o->json) {
        jopen_object(&w, NULL);
        jopen_array(&w, "files");
    }
    for (int i = 0; i < o->args.inputs && worst != RELUME_ECANCEL; i++) {
        const relume_status status = check_file(o, o->args.input[i], o->json ? &w : NULL);
        worst = status && worst != RELUME_ENOMEM ? status : worst;
    }
    if (o->json)
        jend(&w);
    return worst;
}

const struct command command_check = {
    COMMAND(run_check, "check", "FILE... [--json]",
            "read a whole relume file and report what is damaged, and where",
            "relume check archive/*.exr", 1, 4096),
};
