// output_name.c - the ending of an output's name says its format: asked before any work is done
#include "cli/program/output_name.h"

#include "cli/program/say.h"

#include <string.h>
#include <strings.h>

const char *name_ending(const char *path)
{
    const char *name = path_name(path);
    const char *dot = strrchr(name, '.');
    return dot && dot > name ? dot : "";
}

bool has_words(const char *path)
{
    const char *ending = name_ending(path);
    return !strcasecmp(ending, ".png") || !strcasecmp(ending, ".tif") ||
           !strcasecmp(ending, ".tiff");
}

relume_status picture_name(const struct relume_log *log, const char *option, const char *path)
{
    if (relume_image_can_save(path))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: %s: no picture format for this ending; expected .exr, .hdr or .pfm "
               "(linear light), .png, .jpg, .tif, .webp, ...",
               option, path);
}

relume_status floats_name(const struct relume_log *log, const char *option, const char *path)
{
    const char *ending = name_ending(path);
    if (!strcasecmp(ending, ".exr") || !strcasecmp(ending, ".pfm") || has_words(path) ||
        (!*ending && relume_image_can_save(path)))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: %s: this picture has values below 0 or above 1; expected .exr or .pfm, "
               "which can hold them, or .png or .tif, scaled to 16 bits",
               option, path);
}

relume_status relume_name(const struct relume_log *log, const char *option, const char *path)
{
    const char *ending = name_ending(path);
    if (!strcmp(path, "-"))
        return say(log, RELUME_EINVAL,
                   "%s: %s: expected the name of a file; /dev/stdout writes into a pipe", option,
                   path);
    if (!*ending || !strcasecmp(ending, ".exr") || !strcasecmp(ending, ".part"))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: %s: a relume file is an OpenEXR file; expected a name that ends in "
               ".exr%s",
               option, path,
               relume_image_can_save(path) ? " ('relume relight' writes pictures)" : "");
}

relume_status rig_name(const struct relume_log *log, const char *option, const char *path)
{
    const char *ending = name_ending(path);
    if (!*ending || !strcasecmp(ending, ".json"))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: %s: a rig is a JSON file; expected a name that ends in .json", option, path);
}
