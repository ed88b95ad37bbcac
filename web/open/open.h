// open.h - what a page calls to read a relume file that was dropped onto it
#ifndef OPEN_OPEN_H
#define OPEN_OPEN_H

struct opened;

// The page's own: `size` bytes of the file from `offset` on. 0: they cannot be read.
int page_read(void *bytes, double offset, int size);

// Memory for the page to write into, which stays.
void *open_allocate(int bytes);
// The file of that name, which must stay, and size. NULL without memory; else open_why says why it
// cannot be shown, or nothing.
struct opened *open_file(char *name, double size);
// What went wrong last, a sentence without its full stop; nothing: "".
const char *open_why(const struct opened *o);
// Its scene.json, which web/published.js reads.
const char *open_json(const struct opened *o);
// Whether tiles hold bytes; else they hold halves.
int open_is_bytes(const struct opened *o);
// [layers][height][width][4] of a tile of a level, and [height][width][4] of a mask or a depth
// (layers.h). It stays until the next call. NULL: open_why.
const void *open_tile(struct opened *o, int view, int level, int x, int y);
const void *open_picture(struct opened *o, int view, int mask);
// depth_min and depth_step of the last depth.
const double *open_range(const struct opened *o);
// [height][width][8]: what shadows or highlights of a view move by (relume/relight/shadow.h), of files
// where scene.json says that they do.
const float *open_model(struct opened *o, int view);
void open_close(struct opened *o);

#endif
