// folder.h - files of a folder that is being made
#ifndef APPEARANCE_FOLDER_H
#define APPEARANCE_FOLDER_H

#include <relume/image.h>

// `image` as the file `name` of the folder; errors of relume_image_save.
relume_status folder_save(const char *folder, const char *name, const struct relume_image *image,
                          int threads, const struct relume_log *log);
// What `put` prints; errors of relume_file_print.
relume_status folder_print(const char *folder, const char *name,
                           void (*put)(const void *context, FILE *f), const void *context,
                           const struct relume_log *log);

#endif
