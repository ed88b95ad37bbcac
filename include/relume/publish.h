// publish.h - relightable files as a folder of web pages
//
// A site holds index.html, one page a file, and all that they load, by relative names: it works
// from a disk and from any server of files. docs/publish.md says what lies in it.
#ifndef RELUME_PUBLISH_H
#define RELUME_PUBLISH_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Browsers let a page that was opened from a disk load scripts and pictures only: what it reads has
// a script copy there, which holds the same bytes.
enum relume_publish_for {
    RELUME_PUBLISH_BOTH = 0,
    RELUME_PUBLISH_WEB,   // without the script copies
    RELUME_PUBLISH_DISK,  // the script copies alone
};

// What planes are coded as. Every browser with WebGL2 decodes JPEG; AVIF, which is smaller, those
// since 2023 (some since 2020).
enum relume_publish_layers {
    RELUME_PUBLISH_JPEG = 0,
    RELUME_PUBLISH_AVIF,
    RELUME_PUBLISH_JPEG_AND_AVIF,  // a page takes AVIF, and JPEG where that cannot be decoded
};

// Texts are UTF-8 and plain: what they hold of HTML is shown, not obeyed. Zero or NULL in a field
// means its default. Of quality, psnr_db and bytes_per_pixel at most one is given.
struct relume_publish_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    // Of the site; of its file too where there is but one. Defaults: the name of the file, nothing.
    const char *title, *maker, *licence, *object, *description;
    // A JSON file with members "title", "maker", "licence", "object", "description", each a text,
    // and "files": an object whose members, by the files' names without folder and ending, have
    // these members again. What is given above counts more.
    const char *metadata;
    int coefficients;        // planes, at most 90; default: up to 27 or 90 (45 of linear files
                             // whose shadows stay), as many as are worth their bytes
    int quality;             // [1, 100]; default: so high, 95 or more, that no error is seen
    double psnr_db;          // expected against the file's own pictures
    double bytes_per_pixel;  // of all views at full size, about
    enum relume_publish_for target;
    enum relume_publish_layers layers;  // of what is no baked object
    double mm_per_pixel;                // planar files: how large a pixel is; default: not known
    const char *url;     // where the site will be, for links from elsewhere: "https://..."
    bool force;          // replace a folder that relume made
    bool allow_outside;  // as relume_open_params
    bool keep_going;     // likewise
    int threads;         // default: all cores
    // Planar files and slabs: the part that the site shows, x, y, width, height in pixels; width 0:
    // all. Notes move with it; those beside it stay in the file's own list alone.
    int crop[4];
    bool crop_auto;  // the object, by its relief; all where it fills the picture
};
#define relume_publish_params(...)                                                                 \
    (&(const struct relume_publish_params){RELUME_SIZED(relume_publish_params), __VA_ARGS__})

// Advice that brings the page of a file nearer to it.
enum relume_publish_advice {
    RELUME_PUBLISH_NO_ADVICE = 0,  // differences are hardly visible, or quality was asked for
    RELUME_PUBLISH_CODE_DISPLAY,   // a file of display values: linear ones need more than 8 bits
    RELUME_PUBLISH_RAISE_QUALITY,  // quality 100: hard shadows and highlights were softened
};

// Report of one file that was published. Plain data.
struct relume_publish_report {
    char name[64];         // of its page, without ".html", and of its folder
    int views, planes;     // that its folder holds; 0 of a baked object
    int quality;           // asked for or chosen; 0: by size or PSNR
    uint64_t bytes;        // of its folder, script copies not counted
    uint64_t avif_bytes;   // of its folder: planes as AVIF
    uint64_t first_bytes;  // of what a page loads, before it shows something
    double psnr_db;  // of pictures: of one view, mean over at most 16 lights, 8-bit sRGB, against
                     // the file's own pictures
    bool linear;     // its planes hold linear light
    enum relume_publish_advice advice;
    int crop[4];  // x, y, width, height of the part that is shown; width 0: all
};

// Publishes `count` files, whatever relume_open or relume_baked_open opens, as the folder `site`:
// whole or not at all. `reports` (may be NULL) is an array of `count`. RELUME_EINVAL (no
// file, no name; a folder that is not empty, without `force` or that relume did not make), an input
// status, RELUME_EUNFIT (a size or PSNR that cannot be reached), RELUME_EUNSUPPORTED (slabs around
// an object; baked objects of wavelets, of views apart or too large for a page), RELUME_EIO,
// RELUME_ENOMEM, RELUME_ECANCEL. Output bytes do not depend on `threads`.
// `relume publish` makes the same call.
RELUME_RESULT relume_status relume_publish_files(const char *site, const char *const *files,
                                                 int count,
                                                 const struct relume_publish_params *params,
                                                 struct relume_publish_report *reports);

#ifdef __cplusplus
}
#endif
#endif
