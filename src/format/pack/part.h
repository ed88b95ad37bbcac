// part.h - an open part of a relume file whose work was shared
#ifndef PACK_PART_H
#define PACK_PART_H

#include "format/lossy/lossy.h"
#include "image/image/exr.h"

#include <relume/format/pack_write.h>

struct part_file {
    exr_file *file;
    const char *path;
    struct relume_pack_part info;
    bool free_storage;
    int books;   // that all views share, behind the first part
    int groups;  // of views whose planes are coded with loss, from this one on
    int first_group;
};

// The file `path`, which must outlive it, or what `from` reads. With `sums` its header, and all
// that is read of it from now on, is compared with its check sums. An input status with a sentence
// when it is no part, RELUME_ENOMEM.
relume_status part_open(struct part_file *out, const char *path, const struct relume_reader *from,
                        const struct relume_limits *limits, bool sums,
                        const struct relume_log *log);
// The next view of the list of a group, and the words of its planes and its depth, or NULL; -1:
// there is none, or it is damaged.
int part_next_member(const char **list, int views, size_t words[2]);
// The tiles that part `exr` of the file, a group, has of its views, and how many these have; false:
// it does not say.
bool part_tiles(struct lossy_held *out, const struct part_file *part, int exr);
// What was measured of the view whose rows are part `exr` of the file.
bool part_measured(struct relume_fidelity *out, const struct part_file *part, int exr);
// RELUME_EUNFIT with a sentence where nobody asked for the storage and its steps are too coarse.
relume_status part_is_coarse(const struct part_file *part, const struct relume_fidelity *all,
                             const struct relume_log *log);
void part_close(struct part_file *part);

#endif
