// names.h - names of pages and folders that every server and file system takes
#ifndef PUBLISH_NAMES_H
#define PUBLISH_NAMES_H

#include <relume/base.h>

enum { SITE_NAME = 64 };  // with its end

// The file's name without folder and ending, for people; NULL when memory is short.
char *names_stem(const char *path);
// names[count] of small letters, digits, '-' and '_', from the stems, all different.
void names_make(char (*names)[SITE_NAME], char *const *stems, int count);

#endif
