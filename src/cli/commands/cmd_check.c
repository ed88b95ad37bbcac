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
    bool json;
    int count;
};

static void print_damage(void *user, const char *part, int row, int rows)
{
    struct findings *f = user;
    struct shown path, name;
    if (f->json) {
        printf("%s{\"part\": ", f->count ? ", " : "");
        json_text(stdout, part);
        printf(", \"first_row\": %d, \"rows\": %d}", row, rows);
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
        printf("%s{\"part\": ", f->count ? ", " : "");
        json_text(stdout, part);
        printf(
            ", \"column\": %d, \"row\": %d, \"x\": %d, \"y\": %d, \"width\": %d, \"height\": %d}",
            column, row, at->left, at->top, at->width, at->height);
    } else {
        printf("%s: part '%s', tile in column %d, row %d (pixels %d,%d to %d,%d): damaged\n",
               shown(&path, f->path), shown(&name, part), column, row, at->left, at->top,
               at->left + at->width - 1, at->top + at->height - 1);
    }
    f->count++;
}

static relume_status check_file(const struct check_options *o, const char *path)
{
    struct findings f = {.path = path, .json = o->json};
    struct relume_pack_part part;
    struct shown name;
    bool has_sums = false;
    if (f.json) {
        printf("{\"file\": ");
        json_text(stdout, path);
        printf(", \"damaged\": [");
    }
    const relume_status status = relume_pack_check(
        path, relume_pack_check_params(.log = o->args.log, .threads = o->args.threads,
                                       .found = print_damage, .tile = print_tile, .user = &f,
                                       .has_sums = &has_sums));
    const char *const unsure =
        has_sums ? "" : "; without check sums, so that not every changed byte is seen";
    if (f.json)
        printf("], \"check_sums\": %s, \"whole\": %s}", has_sums ? "true" : "false",
               status ? "false" : "true");
    else if (!status && is_part(&part, path))
        printf("%s: whole; part %d of %d%s\n", shown(&name, path), part.part, part.parts, unsure);
    else if (!status)
        printf("%s: whole%s\n", shown(&name, path), unsure);
    else if (f.count && relume_status_is_input(status))
        (void)data_error("%s: damaged; encode it again or take it from a copy", path);
    return status;
}

// All files are looked at; the worst status is the command's.
static relume_status run(const struct args *args)
{
    const struct check_options *o = (const void *)args;
    relume_status worst = RELUME_OK;
    if (o->json)
        printf("{\"files\": [");
    for (int i = 0; i < o->args.inputs && worst != RELUME_ECANCEL; i++) {
        if (o->json && i)
            printf(", ");
        const relume_status status = check_file(o, o->args.input[i]);
        worst = status && worst != RELUME_ENOMEM ? status : worst;
    }
    if (o->json)
        printf("]}\n");
    return worst;
}

const struct command command_check = {
    COMMAND("check", "FILE... [--json]",
            "read a whole relume file and report what is damaged, and where",
            "relume check archive/*.exr", 1, 4096),
};
