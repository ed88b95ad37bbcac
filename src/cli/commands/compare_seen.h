// compare_seen.h - relume compare --metric: what people see of a difference
#ifndef COMMANDS_COMPARE_SEEN_H
#define COMMANDS_COMPARE_SEEN_H

#include "cli/cli.h"

enum compare_metric { COMPARE_ERRORS, COMPARE_JND, COMPARE_VDP };

// How two pictures are prepared and looked at.
struct compare_look {
    double ppd, white;
    const char *mask;
    int reduce;
    bool align, colours, grey;
};

struct compare_seen {
    enum compare_metric metric;
    struct relume_jnd jnd;
    struct relume_vdp vdp;
    struct relume_image map;
};

// A photograph `a` and a rendering `b`, or any two pictures, made alike in what does not count, in
// place. `mask` becomes what is to be compared, or is left empty. An input status with a sentence.
relume_status compare_prepare(struct relume_image *a, struct relume_image *b,
                              struct relume_image *mask, const struct compare_look *look,
                              const struct args *args);
// Fills `seen`, whose metric is set. RELUME_ENOMEM.
relume_status compare_look_at(struct compare_seen *seen, const struct relume_image *a,
                              const struct relume_image *b, const struct relume_image *mask,
                              const struct compare_look *look, const struct args *args);
// To standard output.
void compare_print_seen(const struct compare_seen *seen, bool json);
// Values where the format keeps them, else colours: from black by blue, green and yellow to red,
// which is 4 JND, or certainty.
relume_status compare_save_map(const struct compare_seen *seen, const char *path,
                               const struct args *args);
void compare_seen_free(struct compare_seen *seen);

#endif
