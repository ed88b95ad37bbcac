// kind.c - what lies under a name: one table of all kinds, with the names people read and the marks
// that tell them apart
#include "exchange/formats/kind.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "image/image/picture.h"
#include "image/image/picture_kind.h"

#include <relume/capture.h>
#include <stdio.h>
#include <string.h>

enum { HEAD = 4096, FORMAT = 32 };

// An input that is looked at.
struct subject {
    const char *path;
    const struct relume_log *log;
    bool is_folder;
    bool is_exr;
    char format[FORMAT];  // "format" of a JSON file, or empty
    char head[HEAD + 1];  // first bytes of a file, and a zero
    size_t size;          // number of these bytes
};

static bool head_has(const struct subject *s, const char *text, size_t size)
{
    return memmem(s->head, s->size, text, size);
}

static bool folder_has(const struct subject *s, const char *name)
{
    char *path = mem_format("%s/%s", s->path, name);
    const bool found = path && input_exists(path, s->log);
    mem_free(path);
    return found;
}

// ---------------------------------------------------------------- marks of single kinds

// info.json of a web folder.
static bool is_web_info(const struct subject *s)
{
    return !s->is_folder && path_ends(s->path, ".json") && !*s->format &&
           (path_ends(s->path, "info.json") || head_has(s, "colorspace", strlen("colorspace")));
}

static bool is_relume(const struct subject *s)
{
    return picture_head_is_relume(s->head, s->size);
}

// A folder or layered EXR of a light stage, or a folder with one list of lights.
static bool is_captured(const struct subject *s)
{
    if ((s->is_folder || s->is_exr) && relume_capture_is_olat(s->path, s->log))
        return true;
    char *list = s->is_folder ? tree_only(s->path, ".lp") : NULL;
    if (!list && s->is_folder)
        list = tree_only_below(s->path, ".lp");
    mem_free(list);
    return list != NULL;
}

static bool is_exr(const struct subject *s)
{
    return s->is_exr;
}

static bool is_picture_name(const char *path)
{
    return relume_image_can_save(path) || picture_is_raw_name(path);
}

// ---------------------------------------------------------------- all kinds

// A kind and its marks; a mark that is NULL is not looked for. Contents decide first, in the order
// of the rows: the first row with a mark that is there. Endings decide afterwards.
struct kind_marks {
    enum relume_kind kind;
    const char *name;                     // in sentences
    const char *entry;                    // a folder with this file
    const char *attribute;                // an EXR file with this attribute
    const char *format;                   // a JSON file of this "format"
    bool (*is)(const struct subject *s);  // other contents
    const char *const *endings;           // of files' names; ends with NULL
    bool (*is_name)(const char *path);    // other names of files
};

static const struct kind_marks kinds[] = {
    {
        .kind = RELUME_KIND_FOREIGN,
        .name = "RTI of another format",
        .entry = "info.json",
        .is = is_web_info,
        .endings = (const char *const[]){".ptm", ".lptm", ".rti", ".hsh", NULL},
    },
    {
        .kind = RELUME_KIND_SURFACE,
        .name = "surface of a measured material",
        .entry = "surface.json",
    },
    {
        .kind = RELUME_KIND_FITTED,
        .name = "model of a measured material",
        .entry = "model.json",
        .attribute = "gbrdfVersion",
    },
    {
        .kind = RELUME_KIND_MATERIAL,
        .name = "measured material",
        .entry = "btf.json",
        .endings = (const char *const[]){".btf", NULL},
    },
    {
        .kind = RELUME_KIND_BAKED,
        .name = "baked object",
        .attribute = "bakedVersion",
    },
    {
        .kind = RELUME_KIND_RELUME,
        .name = "relume file",
        .is = is_relume,
        .endings = (const char *const[]){".exr", NULL},
    },
    {
        .kind = RELUME_KIND_MAPS,
        .name = "folder of maps",
        .entry = "maps.json",
    },
    {
        .kind = RELUME_KIND_CAPTURE,
        .name = "capture",
        .entry = "capture.json",
        .format = "relume-capture",
        .is = is_captured,
        .endings = (const char *const[]){".lp", NULL},
    },
    {
        .kind = RELUME_KIND_SCENE,
        .name = "scene file",
        .format = "relume-scene",
    },
    {
        .kind = RELUME_KIND_OBJECTS,
        .name = "description of objects",
        .format = "relume-objects",
        .endings = (const char *const[]){".json", NULL},
    },
    {
        .kind = RELUME_KIND_MODEL,
        .name = "3D model",
        .endings = (const char *const[]){".obj", ".ply", ".gltf", ".glb", ".fbx", ".dae", ".stl",
                                         ".3ds", ".off", NULL},
    },
    {
        .kind = RELUME_KIND_PICTURE,
        .name = "picture",
        .is = is_exr,
        .is_name = is_picture_name,
    },
    {
        .kind = RELUME_KIND_UNKNOWN,
        .name = "nothing known",
    },
};

// ---------------------------------------------------------------- looking

// Copies the text member "format" of a JSON text, if it names a format of relume. A name that goes
// on behind the first bytes is left out.
static void find_format(struct subject *s)
{
    static const char key[] = "\"format\"", prefix[] = "\"relume-";
    const char *end = s->head + s->size, *p = s->head;
    while (!*s->format && (p = memmem(p, (size_t)(end - p), key, strlen(key)))) {
        p += strlen(key);
        const char *text = p + strspn(p, " \t\r\n:");
        const size_t length = strncmp(text, prefix, strlen(prefix)) ? 0 : strcspn(text + 1, "\"");
        if (length && (text + 1 + length < end || s->size < HEAD))
            snprintf(s->format, FORMAT, "%.*s", (int)length, text + 1);
    }
}

// Takes "format" from the whole file, whose first bytes do not reach it.
static void load_format(struct subject *s)
{
    const struct relume_log silent = {.context = s->log ? s->log->context : NULL};
    jvalue *root = NULL;
    if (!jvalue_load(&root, s->path, &silent)) {
        const char *format = jvalue_text(jvalue_member(root, "format"));
        snprintf(s->format, FORMAT, "%s", format ? format : "");
    }
    jvalue_free(&root);
}

static void look_at_file(struct subject *s)
{
    static const char exr_magic[] = "\x76\x2f\x31\x01";
    FILE *f = input_open(s->path, s->log);
    s->size = f ? fread(s->head, 1, HEAD, f) : 0;
    if (f)
        fclose(f);
    s->is_exr = s->size > 4 && !memcmp(s->head, exr_magic, 4);
    if (!path_ends(s->path, ".json"))
        return;
    find_format(s);
    if (!*s->format && s->size == HEAD && !is_web_info(s))
        load_format(s);
}

static bool has_content(const struct kind_marks *k, const struct subject *s)
{
    if (s->is_folder && k->entry && folder_has(s, k->entry))
        return true;
    if (s->is_exr && k->attribute && head_has(s, k->attribute, strlen(k->attribute) + 1))
        return true;
    return (k->format && !strcmp(k->format, s->format)) || (k->is && k->is(s));
}

static bool has_name(const struct kind_marks *k, const char *path)
{
    const char *const *ending = k->endings;
    while (ending && *ending && !path_ends(path, *ending))
        ending++;
    return (ending && *ending) || (k->is_name && k->is_name(path));
}

enum { KINDS = sizeof kinds / sizeof *kinds };

enum relume_kind exchange_kind_of(const char *path, const struct relume_log *log)
{
    struct subject s = {.path = path, .log = log};
    const enum input_kind where = input_kind(path, log);
    if (where == INPUT_NONE)
        return RELUME_KIND_UNKNOWN;
    s.is_folder = where == INPUT_FOLDER;
    if (!s.is_folder)
        look_at_file(&s);
    for (int i = 0; i < KINDS; i++)
        if (has_content(&kinds[i], &s))
            return kinds[i].kind;
    for (int i = 0; i < KINDS && !s.is_folder; i++)
        if (has_name(&kinds[i], path))
            return kinds[i].kind;
    return RELUME_KIND_UNKNOWN;
}

enum relume_kind relume_kind_of(const char *path)
{
    return exchange_kind_of(path, NULL);
}

const char *relume_kind_name(enum relume_kind kind)
{
    int i = 0;
    while (i < KINDS - 1 && kinds[i].kind != kind)
        i++;
    return kinds[i].name;
}
