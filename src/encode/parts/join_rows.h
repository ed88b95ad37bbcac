// join_rows.h - parts that hold rows of views, not whole ones
#ifndef PACK_JOIN_ROWS_H
#define PACK_JOIN_ROWS_H

#include "format/coder/coefficients.h"
#include "format/pack/part.h"

// All `count` parts, in order and belonging together: their rows are quantised and written.
// `report` is filled in. An input status, RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status join_rows(const struct part_file *const *parts, int count, const char *path,
                        struct relume_fidelity *report, const struct relume_pack_params *p);

// What a part of rows has measured joins the sums of its view: errors of the model, and where its
// steps are known those of storing. False: it is damaged.
bool rows_add_errors(struct project_rows *s, const struct part_file *part, int lights);
// Pixels that it counted join `to`, and lights that shine on its rows those of its view: images are
// black where none did. False where it does not say them.
bool rows_add_census(struct relume_census *to, struct project_rows *s, const struct part_file *part,
                     int lights);
bool rows_add_stored(struct project_rows *s, const struct part_file *part);

#endif
