// cmd_import.c - relume import: files of other programs into a relume file
#include "cli.h"

struct import_options {
    struct args args;
    const char *output, *compression;
};
#define OPTIONS struct import_options

static const struct option options[] = {
    TEXT_AS(OPTION_RELUME, "-o", output, "output", "FILE.exr", "the relume file to write"),
    TEXT("--compression", compression, "output", "C",
         "none, rle, zip or piz (all lossless); default: piz"),
    {0},
};

static relume_status run(const struct args *args)
{
    const struct import_options *o = (const void *)args;
    static const char *const names[] = {"none", "rle", "zip", "piz", NULL};
    struct relume_import_params p = {.log = o->args.log, .threads = o->args.threads};
    const char *compression = o->compression;
    if (!o->output)
        return usage_error("import: expected -o FILE.exr");
    if (relume_compression_parse(&p.compression, compression))
        return unknown_name("--compression", compression, names);
    return relume_import(o->args.input[0], o->output, &p);
}

const struct command command_import = {
    .name = "import",
    .usage = "IN -o FILE.exr [OPTION ...]",
    .summary = "turn a .ptm, .rti, .hsh or a relight web folder into a relume file",
    .example = "relume import coin.ptm -o coin.exr",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct import_options),
    .defaults = &(const struct import_options){.compression = "piz"},
    .run = run,
};
