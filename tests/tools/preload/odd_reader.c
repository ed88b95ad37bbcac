// odd_reader.c - in place of librelume-oiio.so: a reader of pictures of 8 x 8 pixels that does what
// the file's name begins with, as readers of hostile files do. loop: the header takes for ever;
// rows: so do the rows; sleep, nap: the same without work; hide: the reader closes its channel and
// sleeps; crash: the rows crash; memory: the header takes a gigabyte.
#include "image/image/picture_format.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct odd {
    picture_reader reader;
    char name[256];
} open_now[64];

static volatile int for_ever = 1;

static bool is(const struct odd *o, const char *what)
{
    return !strncmp(o->name, what, strlen(what));
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    (void)row;
    while (is((struct odd *)reader, "rows") && for_ever)
        ;
    while (is((struct odd *)reader, "nap") && for_ever)
        sleep(1);
    if (is((struct odd *)reader, "crash"))
        raise(SIGSEGV);
    memset(out, 128, (size_t)rows * 8 * 3);
    return RELUME_OK;
}

static void notes(const picture_reader *reader, struct relume_exif *out)
{
    (void)reader;
    out->orientation = 1;
}

static const void *profile(const picture_reader *reader, size_t *size)
{
    (void)reader;
    *size = 0;
    return NULL;
}

static const char *error(const picture_reader *reader)
{
    (void)reader;
    return "";
}

static void close_odd(picture_reader *reader)
{
    ((struct odd *)reader)->name[0] = '\0';
}

static const struct picture_format format = {.read_bytes = read_bytes,
                                             .notes = notes,
                                             .profile = profile,
                                             .error = error,
                                             .close = close_odd};

static relume_status open_odd(picture_reader **out, int file, const char *kind, const char *name,
                              const struct relume_limits *limits, const struct relume_log *log)
{
    struct odd *o = open_now;
    (void)kind, (void)limits, (void)log;
    close(file);
    while (o->name[0])
        o++;
    strncpy(o->name, name, sizeof o->name - 1);
    while (is(o, "loop") && for_ever)
        ;
    if (is(o, "hide"))
        close(3);
    while ((is(o, "sleep") || is(o, "hide")) && for_ever)
        sleep(1);
    if (is(o, "memory"))
        for (int i = 0; i < 1024; i++) {
            void *more = malloc(1 << 20);
            if (!more)
                return RELUME_ENOMEM;
            memset(more, i, 1 << 12);
        }
    o->reader = (picture_reader){
        .format = &format,
        .info = {.width = 8, .height = 8, .channels = 3, .rgb = {0, 1, 2}, .bytes = true}};
    *out = &o->reader;
    return RELUME_OK;
}

RELUME_API const struct oiio_bridge relume_oiio_bridge;
const struct oiio_bridge relume_oiio_bridge = {.version = RELUME_VERSION, .open = open_odd};
