// picture_serve.c - in the helper: one file, read by OpenImageIO for the process that sent it
#include "image/picture_serve.h"

#include "base/channel.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/sandbox.h"
#include "image/picture.h"
#include "image/picture_format.h"

#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

struct serving {
    int channel;
    const struct oiio_bridge *bridge;
    picture_reader *reader;
    struct picture_ask ask;
    struct picture_answer answer;
    int file;  // what came with the message, or -1
    void *band;
    size_t band_bytes;
};

size_t picture_row_bytes(const struct picture_info *info, bool floats)
{
    return (size_t)info->width * (size_t)info->channels * (floats ? sizeof(float) : 1);
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

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void open_file(struct serving *s)
{
    const struct picture_ask *ask = &s->ask;
    const struct relume_log log = {.message = hear_why, .user = &s->answer};
    const uint64_t most = ask->limits.max_memory;
    enum { FIRST_SECONDS = 10, BYTES_A_SECOND = 4 << 20, SAMPLES_A_SECOND = 1000000 };
    sandbox_memory(least(most, HEADER_MEMORY + 64 * ask->file_bytes));
    sandbox_time(FIRST_SECONDS + (unsigned)(ask->file_bytes / BYTES_A_SECOND));
    sandbox_close();
    s->answer.status =
        s->bridge->open(&s->reader, s->file, ask->format, ask->name, &ask->limits, &log);
    if (s->answer.status)
        return;
    s->answer.info = s->reader->info;
    s->reader->format->notes(s->reader, &s->answer.notes);
    size_t profile;
    (void)s->reader->format->profile(s->reader, &profile);
    s->answer.profile_bytes = profile;
    const uint64_t samples =
        (uint64_t)s->reader->info.height * picture_row_bytes(&s->reader->info, false);
    sandbox_memory(least(most, HEADER_MEMORY + 64 * ask->file_bytes + 24 * samples));
    sandbox_time(2 * FIRST_SECONDS + (unsigned)least(samples / SAMPLES_A_SECOND, 100000));
}

static void hand_profile(struct serving *s)
{
    size_t size;
    const void *profile = s->reader->format->profile(s->reader, &size);
    void *to = profile ? channel_map(s->file, size) : NULL;
    if (to) {
        memcpy(to, profile, size);
        munmap(to, size);
    }
    s->answer.status = to ? RELUME_OK : RELUME_EDATA;
}

static void take_band(struct serving *s)
{
    s->band_bytes =
        (size_t)s->ask.rows * picture_row_bytes(&s->reader->info, !s->reader->info.bytes);
    s->band = channel_map(s->file, s->band_bytes);
    s->answer.status = s->band ? RELUME_OK : RELUME_ENOMEM;
}

static void read_rows(struct serving *s, bool floats)
{
    const struct picture_format *format = s->reader->format;
    const int row = s->ask.row, rows = s->ask.rows;
    const size_t bytes = (size_t)rows * picture_row_bytes(&s->reader->info, floats);
    if (!s->band || row < 0 || rows < 1 || rows > s->reader->info.height - row ||
        bytes > s->band_bytes)
        s->answer.status = RELUME_EINVAL;
    else
        s->answer.status = floats ? format->read_floats(s->reader, row, rows, s->band)
                                  : format->read_bytes(s->reader, row, rows, s->band);
    snprintf(s->answer.why, sizeof s->answer.why, "%s", format->error(s->reader));
}

static void obey(struct serving *s)
{
    const bool open = s->ask.what == PICTURE_OPEN;
    s->answer = (struct picture_answer){.status = RELUME_EINVAL};
    if (open == !!s->reader)
        return;
    switch (s->ask.what) {
    case PICTURE_OPEN: open_file(s); break;
    case PICTURE_PROFILE: hand_profile(s); break;
    case PICTURE_BAND: take_band(s); break;
    case PICTURE_READ_BYTES: read_rows(s, false); break;
    case PICTURE_READ_FLOATS: read_rows(s, true); break;
    }
}

void picture_serve(int channel, const void *bridge)
{
    struct serving *s = mem_zeroed(1, sizeof *s);
    if (!s)
        return;
    s->channel = channel;
    s->bridge = bridge;
    while (channel_receive(channel, &s->ask, sizeof s->ask, &s->file)) {
        obey(s);
        // the picture's own file stays open for its reader
        if (s->file >= 0 && s->ask.what != PICTURE_OPEN)
            close(s->file);
        if (!channel_send(channel, &s->answer, sizeof s->answer, -1))
            return;
    }
}
