// cmd_join.c - relume join: the parts of a relume file become the file
#include "cli/cli.h"
#include "cli/kept_notes.h"

struct join_options {
    struct args args;
    const char *output;
};
#define OPTIONS struct join_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_RELUME, output, "FILE.exr", "the relume file to write"),
    {0},
};

static relume_status run_join(const struct args *args)
{
    const struct join_options *o = (const void *)args;
    struct relume_fidelity report;
    struct kept_notes kept;
    kept_notes_read(&kept, o->output);
    const relume_status status = relume_pack_join(
        args->input, args->inputs, o->output, &report,
        relume_pack_params(.log = args->log, .limits = &args->limits, .threads = args->threads));
    if (!status)
        announce(args, RELUME_NOTE,
                 "%s: reproduces your photographs at %.1f dB PSNR (differences %s); joined from "
                 "%d part%s",
                 o->output, report.psnr_db, judgement(report.psnr_db), args->inputs,
                 relume_plural(args->inputs));
    return kept_notes_write(&kept, o->output, status, args);
}

const struct command command_join = {
    COMMAND(run_join, "join", "PART... -o FILE.exr",
            "make one relume file of the parts that 'relume encode --part' has made",
            "relume join statue.*of8.part -o statue.exr", 1, MOST_ARGUMENTS),
};
