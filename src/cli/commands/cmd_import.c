// cmd_import.c - relume import: files of other programs into a relume file
#include "cli/cli.h"
#include "cli/kept_notes.h"

struct import_options {
    struct args args;
    const char *output;
    enum relume_compression compression;
};
#define OPTIONS struct import_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_RELUME, output, "FILE.exr", "the relume file to write"),
    NAME("--compression", compression, "C", "none, rle, zip or piz (all lossless); default: piz",
         RELUME_COMPRESS_NONE, "none", "rle", "zip", "piz"),
    {0},
};

static relume_status run_import(const struct args *args)
{
    const struct import_options *o = (const void *)args;
    struct kept_notes kept;
    kept_notes_read(&kept, o->output);
    const relume_status status =
        relume_import(args->input[0], o->output,
                      relume_import_params(.log = args->log, .threads = args->threads,
                                           .compression = o->compression));
    return kept_notes_write(&kept, o->output, status, args);
}

const struct command command_import = {
    COMMAND(run_import, "import", "IN -o FILE.exr [OPTION ...]",
            "turn a .ptm, .rti, .hsh or a relight web folder into a relume file",
            "relume import coin.ptm -o coin.exr", 1, 1),
};
