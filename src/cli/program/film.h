// film.h - pictures one after the other: numbered files, a folder or a film
#ifndef PROGRAM_FILM_H
#define PROGRAM_FILM_H

#include <relume/image.h>

// `path` with one %d or %0Nd: files of these names; ending in .mp4 or .mkv: a film by ffmpeg;
// otherwise a folder of 0000.png and so on.
struct film;
// Whether `path` names many pictures.
bool film_is(const char *path);
// `fps` pictures a second; `numbers`: a %d in the name is a number, else a folder may be called so.
// Nothing stands under the name of a folder or film before film_close. RELUME_EINVAL (a folder
// that is there and not empty), RELUME_EIO, RELUME_ENOMEM with a sentence.
relume_status film_open(struct film **out, const char *path, double fps, bool numbers,
                        const struct relume_log *log);
// The name that decides how the next picture is developed.
const char *film_name(struct film *film);
// The next picture, linear light in [0, 1]; all have one size, else RELUME_EINVAL. RELUME_EIO,
// RELUME_ENOMEM, RELUME_ESYSTEM (no ffmpeg).
relume_status film_add(struct film *film, const struct relume_image *image);
// A folder or a film gets its name with the last picture; what was written of it vanishes when
// `keep` is false. Frees `*film`, which may be NULL.
relume_status film_close(struct film **film, bool keep);

#endif
