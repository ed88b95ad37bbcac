// oiio.h - every image format but EXR output, through OpenImageIO
//
// OpenImageIO brings over 200 shared libraries, a third of a second at every start. So the C++ that
// knows it (oiio.cpp) is a module of its own, librelume-oiio.so, which oiio_load.c opens when the
// first image is asked for; nobody else notices.
#ifndef IMAGE_OIIO_H
#define IMAGE_OIIO_H

#include <relume/base.h>
#include <relume/photograph.h>

#ifdef __cplusplus
extern "C" {
#endif

// An open image file. Thread-safety: one thread at a time.
typedef struct oiio_reader oiio_reader;

struct oiio_info {
    int width, height;
    int x, y;      // where the data window begins
    int channels;  // as read_* delivers them
    int rgb[3];    // which channel is red, green, blue; all equal for grey
    bool bytes;    // 8-bit integers: oiio_read_bytes works
    bool floats;   // floating point: values do not end at 1
    bool linear;   // float samples, or an integer file that says it is linear
};

// RELUME_EDATA with a sentence that names the file.
relume_status oiio_open(oiio_reader **out, const char *path, const struct relume_limits *limits,
                        const struct relume_log *log);
const struct oiio_info *oiio_info_of(const oiio_reader *reader);
// Code values of `rows` rows from `row` on, out[row][x][channel]; integers map to [0, 1].
// The log may be NULL where threads must not speak; oiio_error then tells.
relume_status oiio_read_floats(oiio_reader *reader, int row, int rows, float *out);
relume_status oiio_read_bytes(oiio_reader *reader, int row, int rows, uint8_t *out);
// What the camera noted: all but the profile. The ICC profile, NULL when there is none; belongs to
// the reader.
void oiio_notes(const oiio_reader *reader, struct relume_notes *out);
const void *oiio_profile(const oiio_reader *reader, size_t *size);
// What went wrong last, for a sentence; "" when nothing did. Belongs to the reader.
const char *oiio_error(const oiio_reader *reader);
void oiio_close(oiio_reader **reader);

// Write interleaved samples, whole or not at all: floats for formats that hold them, else bytes.
// RELUME_EINVAL for an extension that nobody writes, RELUME_EIO.
bool oiio_writes_floats(const char *path);
relume_status oiio_write_bytes(const char *path, int width, int height, int channels,
                               const uint8_t *samples, const struct relume_log *log);
relume_status oiio_write_floats(const char *path, int width, int height, int channels,
                                const float *samples, const struct relume_log *log);

typedef relume_status oiio_save(const char *path, const void *bytes, size_t size,
                                const struct relume_log *log);

// What the module exports, as `relume_oiio_bridge`; the functions above forward to it.
struct oiio_bridge {
    const char *version;  // RELUME_VERSION of its build; another one's is not used
    relume_status (*open)(oiio_reader **out, const char *path, const struct relume_limits *limits,
                          const struct relume_log *log);
    const struct oiio_info *(*info_of)(const oiio_reader *reader);
    relume_status (*read_floats)(oiio_reader *reader, int row, int rows, float *out);
    relume_status (*read_bytes)(oiio_reader *reader, int row, int rows, uint8_t *out);
    void (*notes)(const oiio_reader *reader, struct relume_notes *out);
    const void *(*profile)(const oiio_reader *reader, size_t *size);
    const char *(*error)(const oiio_reader *reader);
    void (*close)(oiio_reader **reader);
    // `save` is the library's own outfile_save.
    relume_status (*write_bytes)(const char *path, int width, int height, int channels,
                                 const uint8_t *samples, oiio_save *save,
                                 const struct relume_log *log);
    relume_status (*write_floats)(const char *path, int width, int height, int channels,
                                  const float *samples, oiio_save *save,
                                  const struct relume_log *log);
};

#ifdef __cplusplus
}
#endif
#endif
