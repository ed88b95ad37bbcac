// film_frames.h - photographs out of a film in which a lamp moves
#ifndef COMMANDS_FILM_FRAMES_H
#define COMMANDS_FILM_FRAMES_H

#include <relume/base.h>

enum { FILM_FRAMES_MOST = 512 };

// Pictures in a folder that vanishes with them.
struct film_frames {
    relume_making *folder;
    int frames;  // of the film
    int count;
    char *path[FILM_FRAMES_MOST];  // [count]
};

// Returns true for names that end as films do: .mp4, .mov, .m4v, .mkv, .avi, .webm.
bool film_frames_named(const char *path);
// Reads a film by ffmpeg and keeps at most `most` frames, from 3 to FILM_FRAMES_MOST: sharp ones
// under the lights that differ most. RELUME_EUNFIT (a film that cannot be read, or shows fewer than
// 3 lights), RELUME_ESYSTEM (no ffmpeg), RELUME_EIO, RELUME_ENOMEM.
relume_status film_frames_open(struct film_frames *out, const char *path, int most,
                               const struct relume_log *log);
void film_frames_close(struct film_frames *frames);

#endif
