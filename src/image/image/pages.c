// pages.c - TIFF files of several pages, each of which is a picture: "stack.tif#3" is the third
#include "image/image/pages.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "image/image/picture_kind.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PAGES_MOST = 65536 };

static uint64_t whole_at(const uint8_t *at, int bytes, bool big)
{
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++)
        v |= (uint64_t)at[i] << 8 * (big ? bytes - 1 - i : i);
    return v;
}

// Directories follow each other (TIFF 6.0; BigTIFF): so many entries, then where the next one is.
// -1 where one lies beyond the end of the file. Readers of pictures take that for the last one.
int tiff_pages(struct infile *in)
{
    uint8_t word[16] = {0};
    bool good = infile_read(in, word, sizeof word, 0) >= 8;
    const bool big_end = word[0] == 'M', wide = whole_at(word + 2, 2, big_end) == 43;
    const int place = wide ? 8 : 4, number = wide ? 8 : 2, entry = wide ? 20 : 12;
    uint64_t at = whole_at(word + (wide ? 8 : 4), place, big_end);
    int count = 0;
    for (; good && at && count <= PAGES_MOST; count++) {
        good = at < in->size && infile_read(in, word, (size_t)number, at) == number;
        const uint64_t entries = whole_at(word, number, big_end);
        good = good && entries < 65536;
        at += (uint64_t)number + entries * (uint64_t)entry;
        good = good && infile_read(in, word, (size_t)place, at) == place;
        at = whole_at(word, place, big_end);
    }
    return good ? count : -1;
}

int picture_pages(const char *path, const struct relume_log *log)
{
    struct infile in;
    if (!picture_has_extension(path, ".tif") && !picture_has_extension(path, ".tiff"))
        return 1;
    if (!infile_open(&in, path, NULL, log))
        return 1;
    const int count = tiff_pages(&in);
    infile_close(&in);
    return count > 1 ? count : 1;
}

int page_of(char file[PAGE_PATH], const char *path)
{
    const char *mark = strrchr(path, '#');
    char *end = NULL;
    const long page = mark ? strtol(mark + 1, &end, 10) : 0;
    const bool names = page >= 1 && page <= PAGES_MOST && end > mark + 1 && !*end &&
                       mark - path < PAGE_PATH && access(path, F_OK) != 0;
    snprintf(file, PAGE_PATH, "%.*s", names ? (int)(mark - path) : PAGE_PATH - 1, path);
    return names ? (int)page : 0;
}

relume_status page_open(picture_reader **out, const char *path, const struct relume_limits *limits,
                        const struct relume_log *log)
{
    char file[PAGE_PATH];
    const int page = page_of(file, path);
    relume_status status = picture_open(out, page ? file : path, NULL, limits, log);
    if (status || page <= 1)
        return status;
    status = picture_turn(*out, page - 1, limits);
    if (status && status != RELUME_ENOMEM)
        (void)log_fail(log, status, "%s: %s", path, picture_error(*out));
    if (status)
        picture_close(out);
    return status;
}
