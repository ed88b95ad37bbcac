// cmd_import.c - relume import: files of other programs into a relume file
#include "cli.h"

static const struct option options[] = {
    {"-o", OPTION_RELUME, "FILE.exr", "the relume file to write", 0, 0},
    {"--compression", OPTION_TEXT, "C", "none, rle, zip or piz (all lossless); default: piz", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status run(const struct args *args)
{
    static const char *const names[] = {"none", "rle", "zip", "piz", NULL};
    struct relume_import_params p = {.log = args_log(args), .threads = args_threads(args)};
    const char *compression = args_text(args, "--compression", "piz");
    if (!args_has(args, "-o"))
        return usage_error("import: expected -o FILE.exr");
    if (relume_compression_parse(&p.compression, compression))
        return unknown_name("--compression", compression, names);
    return relume_import(args_input(args, 0), args_text(args, "-o", NULL), &p);
}

const struct command command_import = {
    .name = "import",
    .usage = "IN -o FILE.exr [OPTION ...]",
    .summary = "turn a .ptm, .rti, .hsh or a relight web folder into a relume file",
    .example = "relume import coin.ptm -o coin.exr",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
