// pages.h - TIFF files of several pages, each of which is a picture: "stack.tif#3" is the third
#ifndef IMAGE_PAGES_H
#define IMAGE_PAGES_H

#include "image/image/picture.h"

struct infile;

// Returns how many directories follow each other in a TIFF file; -1 where one is missing.
int tiff_pages(struct infile *in);
// The same of the file `path`; 1 for other formats and damaged files.
int picture_pages(const char *path, const struct relume_log *log);

enum { PAGE_PATH = 4096 };
// Splits the name of a page: returns its number, from 1, and its file in `file`. Returns 0 and
// `path` where no page is named, or a file has this name.
int page_of(char file[PAGE_PATH], const char *path);
// Opens a picture or the page of one, as picture_open does.
relume_status page_open(picture_reader **out, const char *path, const struct relume_limits *limits,
                        const struct relume_log *log);

#endif
