// av1_serve.c - in the helper: libaom codes the pictures of the process that sent them
#include "format/lossy/av1_serve.h"

#include "core/base/channel.h"
#include "format/lossy/av1_writer.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

struct serving {
    struct av1_ask ask;
    struct av1_answer answer;
    int file;  // the memory that came with the message, or -1
    av1_writer *writer;
    int members;
    void *memory;
    size_t memory_bytes;
};

size_t av1_shared_bytes(const struct av1_shape *shape)
{
    return (size_t)shape->components * (size_t)shape->width * (size_t)shape->height *
           sizeof(uint16_t);
}

static void end(struct serving *s)
{
    av1_writer_destroy(&s->writer);
    if (s->memory)
        munmap(s->memory, s->memory_bytes);
    s->memory = NULL;
}

static relume_status begin(struct serving *s)
{
    const struct av1_ask *a = &s->ask;
    const struct av1_shape shape = {a->width, a->height, a->components, a->pictures, NULL};
    const struct av1_effort effort = {a->quantiser, (enum av1_preset_number)a->preset};
    end(s);
    s->members = a->members;
    s->memory_bytes = av1_shared_bytes(&shape);
    s->memory = s->file < 0 ? NULL : channel_map(s->file, s->memory_bytes);
    return s->memory ? av1_writer_open(&s->writer, &shape, a->members, &effort, a->threads)
                     : RELUME_ENOMEM;
}

static relume_status take(struct serving *s)
{
    const struct av1_bytes *b = av1_writer_bytes(s->writer, s->ask.member);
    const size_t from = s->ask.offset < b->size ? (size_t)s->ask.offset : b->size;
    const size_t left = b->size - from;
    memcpy(s->memory, b->byte + from, left < s->memory_bytes ? left : s->memory_bytes);
    s->answer.bytes = b->size;
    return RELUME_OK;
}

static relume_status obey(struct serving *s)
{
    const struct av1_ask *a = &s->ask;
    if (a->what == AV1_BEGIN)
        return begin(s);
    if (!s->writer || a->member < 0 || a->member >= s->members)
        return RELUME_EINVAL;
    if (a->what == AV1_PICTURE)
        return av1_writer_add(s->writer, s->memory, a->picture, a->member, a->halved);
    if (a->what == AV1_TAKE)
        return take(s);
    end(s);
    return RELUME_OK;
}

// False when nobody asks for long; a group that has begun goes on some day.
static bool wait_for_work(const struct serving *s, int channel)
{
    struct pollfd asked = {.fd = channel, .events = POLLIN};
    int waited;
    do
        waited = poll(&asked, 1, s->writer ? -1 : HELPER_IDLE_S * 1000);
    while (waited < 0 && errno == EINTR);
    return waited > 0;
}

void av1_serve(int channel, const void *bridge)
{
    struct serving s = {.file = -1};
    (void)bridge;
    while (wait_for_work(&s, channel) && channel_receive(channel, &s.ask, sizeof s.ask, &s.file)) {
        s.answer = (struct av1_answer){.status = RELUME_OK};
        s.answer.status = obey(&s);
        if (s.answer.status == RELUME_ESYSTEM)
            snprintf(s.answer.why, sizeof s.answer.why, "%s", av1_writer_error(s.writer));
        if (s.file >= 0)
            close(s.file);
        if (!channel_send(channel, &s.answer, sizeof s.answer, -1))
            break;
    }
    end(&s);
}
