// picture_serve.h - pictures read in other processes: what one is asked, and what it answers
#ifndef IMAGE_PICTURE_SERVE_H
#define IMAGE_PICTURE_SERVE_H

#include "core/base/helper.h"
#include "image/image/picture.h"

// Messages to the process, which may have many pictures open; each is answered.
enum picture_ask_what {
    PICTURE_OPEN,        // with the file; the answer's `place` is what the others name
    PICTURE_PROFILE,     // with memory for the profile, which is put there
    PICTURE_BAND,        // with memory for `rows` rows
    PICTURE_READ_BYTES,  // rows `row` to row + rows - 1 into the band
    PICTURE_READ_FLOATS,
    PICTURE_CLOSE,
    PICTURE_TURN,  // to page `row`, with `limits`; the answer has its `info`
};
struct picture_ask {
    int what, place;
    int row, rows;
    struct relume_limits limits;  // PICTURE_OPEN, PICTURE_TURN
    uint64_t file_bytes;
    char format[16];  // OpenImageIO's name; "": any
    char name[256];   // of the file, for its extension
};
struct picture_answer {
    int status;         // relume_status
    int memory, place;  // RELUME_ENOMEM: enum helper_short; PICTURE_OPEN
    char why[HELPER_WHY];
    struct picture_info info;  // PICTURE_OPEN, PICTURE_TURN
    struct relume_exif notes;
    uint64_t profile_bytes;
};

// What the process may take of a processor to open a picture and to read it all.
double picture_open_s(uint64_t file_bytes);
double picture_read_s(const struct picture_info *info);
// Bytes of a row as READs deliver it.
size_t picture_row_bytes(const struct picture_info *info, bool floats);

// What the process does until its channel is closed; `bridge` is the module's.
void picture_serve(int channel, const void *bridge);

#endif
