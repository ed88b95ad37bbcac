// web.h - relight's folders for web viewers: info.json and plane_0.jpg, plane_1.jpg, ...
#ifndef EXCHANGE_WEB_H
#define EXCHANGE_WEB_H

#include "exchange/foreign/planes.h"
#include "exchange/formats/sheet.h"

// `path` is the folder or its info.json. ptm, hsh, sh, rbf and bilinear in rgb, lrgb, ycc, mrgb and
// mycc, as far as the pairs exist. An input status with a sentence that names the file at fault.
relume_status web_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log);

// Whether folders of the type have that many functions.
static inline bool web_has_count(enum function_kind kind, int count)
{
    return functions_has_count(kind, count) && (kind != FUNCTIONS_HSH || count <= 9);
}

// A folder being made: planes as JPEGs at a step, the number of planes by what they are worth.
struct web_folder {
    const struct plan *plan;
    const struct planes *planes;
    struct sheet_result *sheet;  // [sheets]
    int sheets;                  // of the plan
    int kept;                    // sheets worth their bytes
    size_t bytes;                // of those
    bool blocks;                 // the sheets report their blocks
    double error;                // expected squared error, summed over the channels
};

// Encode every sheet at `step`. `all`: keep even those that are not worth their bytes.
relume_status web_encode(struct web_folder *w, double step, bool all, int threads);
// Of an encoded plan with chroma planes: how many of the pairs say more than a pair of blank planes
// costs, at least 1.
int web_useful_chroma(const struct web_folder *w, double step);
// Of an encoded folder with blocks: the visible error of its quantising, in levels of 255.
// Nineteen of twenty blocks show less.
relume_status web_visible_error(const struct web_folder *w, double *levels);
void web_folder_free(struct web_folder *w);
// Writes info.json into the folder `path`. RELUME_EIO, RELUME_ENOMEM.
relume_status web_write_info(const struct web_folder *folder, const char *path, int quality,
                             const struct relume_log *log);
// Writes the JPEG of each kept sheet into the folder `path`. RELUME_EIO, RELUME_ENOMEM.
relume_status web_write_planes(const struct web_folder *w, const char *path,
                               const struct relume_log *log);
// Sheet `index` as it is encoded.
struct sheet web_sheet(const struct web_folder *w, int index);
int web_planes(const struct web_folder *w);

#endif
