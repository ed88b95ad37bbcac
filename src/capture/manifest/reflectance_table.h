// reflectance_table.h - the reflectance table of a view: bands of rows under all lights
#ifndef MANIFEST_REFLECTANCE_TABLE_H
#define MANIFEST_REFLECTANCE_TABLE_H

#include <relume/capture.h>

// Whether `path` is what light stages leave, one light at a time, and relume_capture_open takes as
// well: an EXR with three layers or more of red, green and blue (directions in its attribute
// olat.directions, or in a list beside it), or a folder of pictures with such a list (light_dirs,
// light_directions, lights, directions or dirs; .txt, .csv, .json), in the order of their numbers.
bool relume_capture_is_olat(const char *path, const struct relume_log *log);

// A fingerprint of the capture: of the lights, the geometry and the transfer, and of every
// image its size and some bytes from its middle; not of names and dates. An input status,
// RELUME_ENOMEM.
relume_status relume_capture_digest(char text[RELUME_DIGEST], const relume_capture *capture,
                                    const struct relume_log *log);

// As relume_capture_image, black where the view's mask leaves out.
relume_status relume_capture_masked(struct relume_image *out, const relume_capture *capture,
                                    int view, int light, const struct relume_log *log);

// The reflectance table of one view, read from the top in bands of rows; memory does not grow with
// the image's height. Thread-safety: one thread at a time.
typedef struct relume_table relume_table;

// How a table reads. `log` is used as long as the table lives; the rest is copied.
struct relume_table_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    struct relume_transfer display;  // values are coded by this curve; default: linear light
    int threads;                     // default: all cores
    bool keep_near;  // near lights: values as each pixel sees them, only fall-off is divided out
};
#define relume_table_params(...)                                                                   \
    (&(const struct relume_table_params){RELUME_SIZED(relume_table_params), __VA_ARGS__})

// `capture` must outlive the table. Returns an input status, RELUME_ENOMEM.
relume_status relume_table_open(relume_table **out, const relume_capture *capture, int view,
                                const struct relume_table_params *params);
// The next `rows` rows of every light: out[light][row][x][rgb], light intensity divided out. Where
// lights are near (positions; planar views, slabs, spheres and cylinders with depth) values are
// those under distant lights from the manifest's directions. Asking for more rows than are left is
// RELUME_EINVAL.
relume_status relume_table_read(relume_table *table, int rows, float *out);
// The same, and in `near`, of the same size, what near lights really show at each pixel: fall-off
// is divided out, directions are the pixel's own. Where lights are distant both are the same.
relume_status relume_table_read_near(relume_table *table, int rows, float *out, float *near);
// Whether the table's lights are near.
bool relume_table_is_near(const relume_table *table);
// Unit directions to the lights, from where the surface lies at a place of the picture (pixel
// centres at + 0.5), the mean over `reach` pixels around it: direction[lights].
void relume_table_directions(const relume_table *table, double x, double y, int reach,
                             struct relume_vec3 *direction);
// The next `rows` rows, at most RELUME_TABLE_ROWS, kept inside the table, 8-bit photographs as they
// are: relume_table_planes then gives what relume_table_read would.
enum { RELUME_TABLE_ROWS = 16 };
// An input status when an image is broken, RELUME_ENOMEM.
relume_status relume_table_fetch(relume_table *table, int rows);
// Leave out the next `rows` rows, which takes less time than reading them where the format allows.
// As relume_table_fetch.
relume_status relume_table_skip(relume_table *table, int rows);
// `count` pixels from `first` on of the rows fetched last, under one light:
// out[channel * stride + pixel]. Thread-safety: any number of threads between fetches.
void relume_table_planes(const relume_table *table, int light, size_t first, size_t count,
                         float *out, size_t stride);
// Pixels of `light` that have been repaired in the rows read so far.
size_t relume_table_repaired(const relume_table *table, int light);
void relume_table_destroy(relume_table **table);

#endif
