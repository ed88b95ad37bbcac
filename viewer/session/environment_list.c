// environment_list.c - environment maps that lie in one folder, for the panel to choose from
#include "session/environment_list.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static int is_map(const struct dirent *entry)
{
    static const char *const endings[] = {".hdr", ".exr", ".pfm"};
    const char *dot = strrchr(entry->d_name, '.');
    for (size_t i = 0; dot && dot != entry->d_name && i < sizeof endings / sizeof *endings; i++)
        if (!strcasecmp(dot, endings[i]))
            return 1;
    return 0;
}

relume_status environment_list_read(struct environment_list *maps, const char *folder)
{
    struct dirent **entry;
    const int found = scandir(folder, &entry, is_map, alphasort);
    const int n = found < 0 ? 0 : found < ENVIRONMENT_LIST_MAX ? found : ENVIRONMENT_LIST_MAX;
    *maps = (struct environment_list){.folder = strdup(folder),
                                      .name = calloc((size_t)n + 1, sizeof(char *))};
    bool good = maps->folder && maps->name;
    for (int i = 0; good && i < n; i++) {
        good = (maps->name[i] = strdup(entry[i]->d_name)) != NULL;
        maps->count += good;
    }
    for (int i = 0; i < found; i++)
        free(entry[i]);
    if (found >= 0)
        free(entry);
    if (!good)
        environment_list_destroy(maps);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void environment_list_destroy(struct environment_list *maps)
{
    for (int i = 0; i < maps->count; i++)
        free(maps->name[i]);
    free(maps->name);
    free(maps->folder);
    *maps = (struct environment_list){0};
}
