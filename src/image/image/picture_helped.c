// picture_helped.c - pictures of other formats, read by OpenImageIO in other processes. What comes
// back is believed as little as the file.
#include "core/base/tree.h"
#include "core/base/channel.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"
#include "image/image/picture_serve.h"

#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

struct helped {
    picture_reader reader;  // first
    struct helper_job job;
    int place;          // there; -1: it is not open
    bool limit_is_set;  // of memory
    struct relume_exif notes;
    void *profile;
    size_t profile_bytes;
    uint8_t *band;  // memory shared with the process
    size_t band_bytes;
    char why[HELPER_WHY + 64];
};

enum { MOST_BAND_ROWS = 16, MOST_BAND_BYTES = 4 << 20 };

static relume_status ask(struct helped *h, struct picture_answer *answer, struct picture_ask what,
                         int file)
{
    what.place = h->place;
    const relume_status status =
        helper_ask(&h->job, &what, sizeof what, file, answer, sizeof *answer);
    if (status) {
        snprintf(h->why, sizeof h->why, "%s", h->job.why);
        return status;
    }
    answer->why[HELPER_WHY - 1] = '\0';
    const char *why = answer->why;
    if (answer->status == RELUME_ENOMEM &&
        !(why = helper_short_of(answer->memory, h->limit_is_set)))
        return RELUME_ENOMEM;
    snprintf(h->why, sizeof h->why, "%s", why);
    const bool said = relume_status_is_input(answer->status);
    return !answer->status || said ? answer->status : RELUME_EDAMAGED;
}

// Memory of both processes; the other one gets its descriptor.
static void *share(struct helped *h, size_t bytes, struct picture_ask what, relume_status *status)
{
    struct picture_answer answer;
    const int memory = channel_memory(bytes);
    void *map = memory < 0 ? NULL : channel_map(memory, bytes);
    *status = map ? ask(h, &answer, what, memory) : RELUME_ENOMEM;
    if (memory >= 0)
        close(memory);
    if (*status && map) {
        munmap(map, bytes);
        return NULL;
    }
    return map;
}

static relume_status fetch_profile(struct helped *h, uint64_t bytes)
{
    enum { MOST = 16 << 20 };
    const struct picture_ask what = {.what = PICTURE_PROFILE};
    relume_status status;
    if (bytes == 0 || bytes > MOST)
        return RELUME_OK;
    void *map = share(h, (size_t)bytes, what, &status);
    if (!map)
        return status;
    h->profile = mem_copy(map, (size_t)bytes, 1);
    h->profile_bytes = h->profile ? (size_t)bytes : 0;
    munmap(map, (size_t)bytes);
    return h->profile ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status make_band(struct helped *h)
{
    const size_t row = picture_row_bytes(&h->reader.info, !h->reader.info.bytes),
                 fit = MOST_BAND_BYTES / row;
    const struct picture_ask what = {.what = PICTURE_BAND,
                                     .rows = fit < 1                ? 1
                                             : fit < MOST_BAND_ROWS ? (int)fit
                                                                    : MOST_BAND_ROWS};
    relume_status status;
    h->job.processor_s += picture_read_s(&h->reader.info);
    h->band_bytes = (size_t)what.rows * row;
    h->band = share(h, h->band_bytes, what, &status);
    return status;
}

static relume_status read_rows(struct helped *h, int what, int row, int rows, uint8_t *out)
{
    struct picture_answer answer;
    relume_status status = h->band ? RELUME_OK : make_band(h);
    const size_t bytes = picture_row_bytes(&h->reader.info, what == PICTURE_READ_FLOATS);
    const int most = (int)(h->band_bytes / (bytes ? bytes : 1));
    if (!status && most < 1)  // floats of a picture of bytes
        return RELUME_EINVAL;
    while (!status && rows > 0) {
        const int n = rows < most ? rows : most;
        status = ask(h, &answer, (struct picture_ask){.what = what, .row = row, .rows = n}, -1);
        if (!status)
            memcpy(out, h->band, (size_t)n * bytes);
        out += (size_t)n * bytes;
        row += n;
        rows -= n;
    }
    return status;
}

static relume_status read_floats(picture_reader *reader, int row, int rows, float *out)
{
    return read_rows((struct helped *)reader, PICTURE_READ_FLOATS, row, rows, (uint8_t *)out);
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    return read_rows((struct helped *)reader, PICTURE_READ_BYTES, row, rows, out);
}

static void notes(const picture_reader *reader, struct relume_exif *out)
{
    *out = ((const struct helped *)reader)->notes;
}

static const void *profile(const picture_reader *reader, size_t *size)
{
    const struct helped *h = (const struct helped *)reader;
    *size = h->profile_bytes;
    return h->profile;
}

static const char *error(const picture_reader *reader)
{
    return ((const struct helped *)reader)->why;
}

static void close_helped(picture_reader *reader)
{
    struct helped *h = (struct helped *)reader;
    struct picture_answer answer;
    if (h->place >= 0)
        (void)!ask(h, &answer, (struct picture_ask){.what = PICTURE_CLOSE}, -1);
    helper_end(&h->job);
    if (h->band)
        munmap(h->band, h->band_bytes);
    mem_free(h->profile);
    mem_free(h);
}

static bool is_sound(const struct picture_info *i, const struct relume_limits *limits)
{
    enum { MOST_CHANNELS = 4096 };
    bool sound = limits_allow(limits, i->width, i->height) && i->channels >= 1 &&
                 i->channels <= MOST_CHANNELS;
    for (int c = 0; c < 3; c++)
        sound = sound && i->rgb[c] >= 0 && i->rgb[c] < i->channels;
    return sound;
}

// 0, which is not noted, for what no camera has.
static void make_likely(struct relume_exif *n)
{
    double *const numbers[] = {&n->time_s, &n->f_number, &n->iso, &n->focal_mm, &n->focal_35mm};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (!(*numbers[i] >= 1e-9 && *numbers[i] <= 1e9))
            *numbers[i] = 0.0;
    const int64_t most_s = (int64_t)1 << 40;
    if (n->taken_s < -most_s || n->taken_s > most_s)
        n->taken_s = 0;
}

static void make_whole(struct picture_answer *answer)
{
    struct picture_info *info = &answer->info;
    struct relume_exif *notes = &answer->notes;
    bool *const bools[] = {&info->bytes,   &info->floats, &info->linear,  &info->jumps,
                           &notes->linear, &notes->bytes, &notes->floats, &notes->profile};
    for (size_t i = 0; i < sizeof bools / sizeof *bools; i++)
        helper_bool(bools[i]);
    make_likely(notes);
    info->other[sizeof info->other - 1] = '\0';
    notes->camera[sizeof notes->camera - 1] = '\0';
}

static relume_status senseless(struct helped *h)
{
    snprintf(h->why, sizeof h->why,
             "its reader gave an answer that makes no sense; the file is probably damaged");
    return RELUME_EDAMAGED;
}

static relume_status turn(picture_reader *reader, int page, const struct relume_limits *limits)
{
    struct helped *h = (struct helped *)reader;
    struct picture_answer answer;
    const struct picture_ask what = {
        .what = PICTURE_TURN, .row = page, .limits = limits_or_default(limits)};
    const relume_status status = ask(h, &answer, what, -1);
    if (status)
        return status;
    make_whole(&answer);
    reader->info = answer.info;
    h->job.processor_s += picture_read_s(&reader->info);
    return is_sound(&reader->info, limits) ? RELUME_OK : senseless(h);
}

static const struct picture_format format = {read_floats, read_bytes,   notes, profile,
                                             error,       close_helped, turn};

static relume_status open_there(struct helped *h, int file, const char *path,
                                const struct picture_kind *kind, uint64_t file_bytes,
                                const struct relume_limits *limits)
{
    struct picture_answer answer;
    struct picture_ask what = {
        .what = PICTURE_OPEN, .limits = limits_or_default(limits), .file_bytes = file_bytes};
    snprintf(what.format, sizeof what.format, "%s", kind->reader);
    snprintf(what.name, sizeof what.name, "%s", path_name(path));
    h->job.processor_s = picture_open_s(file_bytes);
    const relume_status status = ask(h, &answer, what, file);
    if (status)
        return status;
    h->place = answer.place;
    make_whole(&answer);
    h->reader.info = answer.info;
    h->notes = answer.notes;
    return is_sound(&h->reader.info, limits) ? fetch_profile(h, answer.profile_bytes)
                                             : senseless(h);
}

relume_status helped_picture_open(picture_reader **out, int file, const char *path,
                                  const struct picture_kind *kind, uint64_t file_bytes,
                                  const struct relume_limits *limits, const struct relume_log *log)
{
    struct helped *h = mem_zeroed(1, sizeof *h);
    *out = NULL;
    if (!h)
        return RELUME_ENOMEM;
    h->reader.format = &format;
    h->place = -1;
    h->limit_is_set = limits && limits->max_memory;
    relume_status status = helper_start(&h->job, HELPER_PICTURE, path, log);
    if (!status && (status = open_there(h, file, path, kind, file_bytes, limits)) &&
        status != RELUME_ENOMEM)
        (void)log_fail(log, status, "%s: %s", path, h->why);
    if (status)
        close_helped(&h->reader);
    else
        *out = &h->reader;
    return status;
}
