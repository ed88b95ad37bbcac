// picture_serve.c - in the helper: files, read by OpenImageIO for the process that sent them
#include "image/image/picture_serve.h"

#include "core/base/channel.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/sandbox.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// An open picture.
struct place {
    picture_reader *reader;  // NULL: free
    void *band;
    size_t band_bytes;
    uint64_t memory;  // what it may take
    bool limited;     // to less than its kind should
    double seconds;   // what is left of its time
};

struct serving {
    const struct oiio_bridge *bridge;
    struct picture_ask ask;
    struct picture_answer answer;
    int file;  // what came with the message, until somebody takes it over; or -1
    struct place *places;
    int count;
    bool machine_has_less;
};

size_t picture_row_bytes(const struct picture_info *info, bool floats)
{
    return (size_t)info->width * (size_t)info->channels * (floats ? sizeof(float) : 1);
}

enum { FIRST_SECONDS = 10, BYTES_A_SECOND = 4 << 20, SAMPLES_A_SECOND = 1000000 };

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

double picture_open_s(uint64_t file_bytes)
{
    return FIRST_SECONDS + (double)file_bytes / BYTES_A_SECOND;
}

static uint64_t samples_of(const struct picture_info *info)
{
    return (uint64_t)info->height * picture_row_bytes(info, false);
}

double picture_read_s(const struct picture_info *info)
{
    return 2 * FIRST_SECONDS + (double)least(samples_of(info) / SAMPLES_A_SECOND, 100000);
}

static void hear_why(void *user, enum relume_level level, const char *text)
{
    struct picture_answer *answer = user;
    if (level == RELUME_ERROR)
        snprintf(answer->why, sizeof answer->why, "%s", text);
}

// A header takes little; what pixels take is known once it is read. Decoders hold the picture up to
// six times: as it is coded, as planes, as floats.
static const uint64_t HEADER_MEMORY = 256 << 20;

// What `p` may take, beside what the others may.
static void allow(struct serving *s, struct place *p, uint64_t memory, double seconds)
{
    const uint64_t most = s->ask.limits.max_memory;
    uint64_t all = 0;
    p->memory = least(memory, most);
    p->limited = most < memory;
    p->seconds = seconds;
    for (int i = 0; i < s->count; i++)
        all += s->places[i].memory;
    s->machine_has_less = !sandbox_memory(all);
    sandbox_time(seconds);
}

static struct place *free_place(struct serving *s)
{
    for (int i = 0; i < s->count; i++)
        if (!s->places[i].reader)
            return &s->places[i];
    const int more = s->count ? 2 * s->count : 8;
    struct place *places = mem_resize(s->places, (size_t)more, sizeof *places);
    if (!places)
        return NULL;
    memset(places + s->count, 0, (size_t)(more - s->count) * sizeof *places);
    struct place *first = places + s->count;
    s->places = places;
    s->count = more;
    return first;
}

static void close_picture(struct place *p)
{
    if (p->reader)
        p->reader->format->close(p->reader);
    if (p->band)
        munmap(p->band, p->band_bytes);
    *p = (struct place){0};
}

static void open_file(struct serving *s, struct place *p)
{
    const struct picture_ask *ask = &s->ask;
    const struct relume_log log = {.message = hear_why, .user = &s->answer};
    const uint64_t first = HEADER_MEMORY + 64 * ask->file_bytes;
    allow(s, p, first, picture_open_s(ask->file_bytes));
    sandbox_close();
    s->answer.status =
        s->bridge->open(&p->reader, s->file, ask->format, ask->name, &ask->limits, &log);
    s->file = -1;
    if (s->answer.status)
        return;
    s->answer.place = (int)(p - s->places);
    s->answer.info = p->reader->info;
    p->reader->format->notes(p->reader, &s->answer.notes);
    size_t profile;
    (void)p->reader->format->profile(p->reader, &profile);
    s->answer.profile_bytes = profile;
    allow(s, p, first + 24 * samples_of(&p->reader->info), picture_read_s(&p->reader->info));
}

static void hand_profile(struct serving *s, struct place *p)
{
    size_t size;
    const void *profile = p->reader->format->profile(p->reader, &size);
    void *to = profile ? channel_map(s->file, size) : NULL;
    if (to) {
        memcpy(to, profile, size);
        munmap(to, size);
    }
    s->answer.status = to ? RELUME_OK : RELUME_EDAMAGED;
}

static void take_band(struct serving *s, struct place *p)
{
    const size_t bytes =
        (size_t)s->ask.rows * picture_row_bytes(&p->reader->info, !p->reader->info.bytes);
    void *band = p->band ? NULL : channel_map(s->file, bytes);
    s->answer.status = band ? RELUME_OK : RELUME_ENOMEM;
    if (band) {
        p->band = band;
        p->band_bytes = bytes;
    }
}

static void read_rows(struct serving *s, struct place *p, bool floats)
{
    const struct picture_format *format = p->reader->format;
    const int row = s->ask.row, rows = s->ask.rows;
    const size_t bytes = (size_t)rows * picture_row_bytes(&p->reader->info, floats);
    if (!p->band || row < 0 || rows < 1 || rows > p->reader->info.height - row ||
        bytes > p->band_bytes)
        s->answer.status = RELUME_EINVAL;
    else
        s->answer.status = floats ? format->read_floats(p->reader, row, rows, p->band)
                                  : format->read_bytes(p->reader, row, rows, p->band);
    snprintf(s->answer.why, sizeof s->answer.why, "%s", format->error(p->reader));
}

static void turn_page(struct serving *s, struct place *p)
{
    const struct picture_format *format = p->reader->format;
    s->answer.status =
        format->turn ? format->turn(p->reader, s->ask.row, &s->ask.limits) : RELUME_ENOTFOUND;
    s->answer.info = p->reader->info;
    snprintf(s->answer.why, sizeof s->answer.why, "%s", format->error(p->reader));
    p->seconds += picture_read_s(&p->reader->info);
}

static void obey(struct serving *s, struct place *p)
{
    s->answer.status = RELUME_OK;
    sandbox_time(p->seconds);
    switch (s->ask.what) {
    case PICTURE_OPEN: open_file(s, p); break;
    case PICTURE_PROFILE: hand_profile(s, p); break;
    case PICTURE_BAND: take_band(s, p); break;
    case PICTURE_READ_BYTES: read_rows(s, p, false); break;
    case PICTURE_READ_FLOATS: read_rows(s, p, true); break;
    case PICTURE_CLOSE: close_picture(p); break;
    case PICTURE_TURN: turn_page(s, p); break;
    }
}

static void answer(struct serving *s)
{
    const bool open = s->ask.what == PICTURE_OPEN;
    const int place = s->ask.place;
    s->answer = (struct picture_answer){.status = RELUME_EINVAL};
    struct place *p = open                             ? free_place(s)
                      : place >= 0 && place < s->count ? &s->places[place]
                                                       : NULL;
    if (!p || (!open && !p->reader))
        return;
    const double start = sandbox_time_used();
    obey(s, p);
    p->seconds -= sandbox_time_used() - start;
    s->answer.memory = s->machine_has_less ? HELPER_SHORT_MACHINE
                       : p->limited        ? HELPER_SHORT_LIMIT
                                           : HELPER_SHORT_FILE;
    if (!p->reader)
        close_picture(p);  // it may take nothing any more
}

static bool is_idle(const struct serving *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->places[i].reader)
            return false;
    return true;
}

// False when nobody asks for long; what is open is asked for some day.
static bool wait_for_work(const struct serving *s, int channel)
{
    struct pollfd asked = {.fd = channel, .events = POLLIN};
    int waited;
    do
        waited = poll(&asked, 1, is_idle(s) ? HELPER_IDLE_S * 1000 : -1);
    while (waited < 0 && errno == EINTR);
    return waited > 0;
}

void picture_serve(int channel, const void *bridge)
{
    struct serving *s = mem_zeroed(1, sizeof *s);
    if (!s)
        return;
    s->bridge = bridge;
    while (wait_for_work(s, channel) &&
           channel_receive(channel, &s->ask, sizeof s->ask, &s->file)) {
        answer(s);
        if (s->file >= 0)
            close(s->file);
        if (!channel_send(channel, &s->answer, sizeof s->answer, -1))
            return;
    }
}
