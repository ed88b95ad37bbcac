// lp.c - the light position files of RTI: a count, which some leave out, then "name x y z" a line
#include "capture/manifest/manifest.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"

#include <dirent.h>
#include <errno.h>
#include <libgen.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void draft_free(struct draft *draft)
{
    arena_free(&draft->arena);
    *draft = (struct draft){0};
}

bool direction_normalise(struct relume_vec3 *v)
{
    const double length = vec3_length(*v);
    if (!(length > 1e-4) || !isfinite(length))
        return false;
    *v = vec3_scale(*v, 1.0 / length);
    return true;
}

// ---------------------------------------------------------------- text

static char *trim(char *text)
{
    text += strspn(text, " \t\r\v\f");
    size_t n = strlen(text);
    while (n && strchr(" \t\r\v\f", text[n - 1]))
        text[--n] = '\0';
    return text;
}

// Cut the last blank-separated word off `text`; NULL when there is none.
static char *cut_last(char *text)
{
    char *word = text + strlen(text);
    while (word > text && !strchr(" \t", word[-1]))
        word--;
    if (!*word)
        return NULL;
    char *end = word;
    while (end > text && strchr(" \t", end[-1]))
        end--;
    if (end == text)  // the word is all there is: leave an empty name
        return NULL;
    *end = '\0';
    return word;
}

// Hand-made files hold decimal commas.
static bool parse_number(char *word, double *out)
{
    char *comma = strchr(word, ',');
    if (comma && !strchr(comma + 1, ','))
        *comma = '.';
    char *end;
    *out = strtod(word, &end);
    return end != word && !*end;
}

static bool parse_light(char *line, const char **name, struct relume_vec3 *v)
{
    double xyz[3];
    for (int i = 2; i >= 0; i--) {
        char *word = cut_last(line);
        if (!word || !parse_number(word, &xyz[i]))
            return false;
    }
    *name = line;
    *v = vec3_of(xyz[0], xyz[1], xyz[2]);
    return true;
}

static relume_status read_text(char **out, const char *path, const struct relume_log *log)
{
    enum { MOST = 64 << 20 };
    *out = NULL;
    FILE *file = input_open(path, log);
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    char block[65536];
    size_t n;
    while (memory && size < MOST && (n = fread(block, 1, sizeof block, file)) > 0) {
        fwrite(block, 1, n, memory);
        fflush(memory);
    }
    const bool failed = ferror(file);
    fclose(file);
    if (!memory || fclose(memory)) {
        mem_free_libc(text);
        return RELUME_ENOMEM;
    }
    relume_status status = RELUME_OK;
    if (failed)
        status = log_fail(log, RELUME_ENOTFOUND, "%s: cannot be read; expected a text file", path);
    else if (size >= MOST || memchr(text, '\0', size))
        status = log_fail(log, RELUME_EFORMAT, "%s: not a text file; expected a .lp file", path);
    if (status) {
        mem_free_libc(text);
        return status;
    }
    *out = mem_take(text);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

// Whether a line is the count and nothing else.
static bool parse_count(const char *line, long *out)
{
    char *end;
    *out = strtol(line, &end, 10);
    return end != line && !*end && *out > 0;
}

static relume_status parse_lines(struct draft *d, char *text, const char *path,
                                 const struct relume_limits *limits, const struct relume_log *log)
{
    int most = 1;
    for (const char *c = text; *c; c++)
        most += *c == '\n';
    d->directions = arena_array(&d->arena, (size_t)most, sizeof *d->directions);
    d->positions = arena_array(&d->arena, (size_t)most, sizeof *d->positions);
    const char **images = arena_array(&d->arena, (size_t)most, sizeof *images);
    d->view = arena_array(&d->arena, 1, sizeof *d->view);
    if (!d->directions || !d->positions || !images || !d->view)
        return RELUME_ENOMEM;

    long stated = 0;
    int n = 0, number = 0, filled = 0;
    char *save = NULL;
    for (char *line = text; line; line = save) {
        save = strchr(line, '\n');
        if (save)
            *save++ = '\0';
        number++;
        line = trim(line);
        if (!*line)
            continue;
        if (!filled++ && parse_count(line, &stated))
            continue;
        const char *name;
        struct relume_vec3 v;
        char shown[64];
        snprintf(shown, sizeof shown, "%s", line);
        if (!parse_light(line, &name, &v))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: line %d; expected %s'image x y z', found '%s'", path, number,
                            filled == 1 ? "the number of lights or " : "", shown);
        d->positions[n] = v;
        if (!direction_normalise(&v))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: line %d; expected a light direction, found '%s' (zero or not a "
                            "number)",
                            path, number, shown);
        d->directions[n] = v;
        images[n] = arena_text(&d->arena, name);
        if (!images[n++])
            return RELUME_ENOMEM;
    }
    if (n == 0)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: no lights; expected a count and 'image x y z' lines", path);
    if (n > limits_or_default(limits).max_lights)
        return log_fail(log, RELUME_ELIMIT, "%s: %d lights; expected at most %d", path, n,
                        limits_or_default(limits).max_lights);
    if (filled > n && stated != n)
        log_line(log, RELUME_WARNING,
                 "%s: its first line promises %ld lights; found %d, which are used", path, stated,
                 n);
    d->view[0].images = images;
    d->m = (struct relume_manifest){
        .geometry = relume_geometry_default(RELUME_PLANAR, 1, 1),
        .lights = n,
        .directions = d->directions,
        .views = 1,
        .view = d->view,
    };
    return RELUME_OK;
}

relume_status lp_read(struct draft *out, const char *path, const struct relume_limits *limits,
                      const struct relume_log *log)
{
    *out = (struct draft){0};
    char *text;
    relume_status status = read_text(&text, path, log);
    if (status)
        return status;
    const bool has_bom = !strncmp(text, "\xef\xbb\xbf", 3);
    status = parse_lines(out, text + (has_bom ? 3 : 0), path, limits, log);
    mem_free(text);
    if (status)
        draft_free(out);
    return status;
}

// ---------------------------------------------------------------- files

static int is_image(const struct dirent *entry)
{
    static const char *const extensions[] = {
        "jpg", "jpeg", "png", "tif", "tiff", "exr", "hdr", "pfm", "bmp", "tga",  "ppm", "pgm",
        "jp2", "webp", "dpx", "gif", "dng",  "cr2", "cr3", "nef", "arw", "heic", NULL};
    const char *dot = strrchr(entry->d_name, '.');
    for (const char *const *e = extensions; dot && *e; e++)
        if (!strcasecmp(dot + 1, *e))
            return 1;
    return 0;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strverscmp((*a)->d_name, (*b)->d_name);
}

static bool is_separator(char c)
{
    return c == '/' || c == '\\';
}

static const char *listed_name(const char *listed)
{
    const char *name = listed + strlen(listed);
    while (name > listed && !is_separator(name[-1]))
        name--;
    return name;
}

// In a project of RTIBuilder the list and its photographs lie in two folders side by side:
// "C:\\...\\jpeg-exports\\a.jpg" is also "../jpeg-exports/a.jpg". NULL when it is not.
static char *find_beside(struct draft *d, const char *folder, const char *listed,
                         const struct relume_log *log)
{
    const char *name = listed_name(listed), *end = name - 1, *start = end;
    if (name == listed)
        return NULL;
    while (start > listed && !is_separator(start[-1]))
        start--;
    if (start == end || *start == '.')
        return NULL;
    char *path = arena_format(&d->arena, "%s/../%.*s/%s", folder, (int)(end - start), start, name);
    return path && input_exists(path, log) ? path : NULL;
}

// The file that a listed name means: the path itself, else its base name in the folder in any case,
// else the same in the folder beside. A path that leaves the folder, and `project`, which holds it,
// is `refused` where only that exists.
static char *find_file(struct draft *d, const char *folder, const char *listed,
                       struct dirent *const *files, int file_count, bool project,
                       const struct relume_capture_params *p, bool *refused)
{
    char *path = listed[0] == '/' ? arena_text(&d->arena, listed)
                                  : arena_format(&d->arena, "%s/%s", folder, listed);
    const bool exists = path && input_exists(path, p->log);
    *refused = exists && !p->allow_outside && leaves_folder(listed);
    if (!path || (exists && !*refused))
        return path;
    const char *base = listed_name(listed);
    for (int exact = 1; exact >= 0; exact--)
        for (int i = 0; i < file_count; i++)
            if (exact ? !strcmp(files[i]->d_name, base) : !strcasecmp(files[i]->d_name, base)) {
                *refused = false;
                return arena_format(&d->arena, "%s/%s", folder, files[i]->d_name);
            }
    char *beside = find_beside(d, folder, listed, p->log);
    if (beside)
        *refused = !p->allow_outside && !project;
    return beside ? beside : path;
}

static relume_status resolve(struct draft *d, const char *path, const char *folder,
                             struct dirent *const *files, int file_count, bool project,
                             const struct relume_capture_params *p)
{
    const struct relume_log *log = p->log;
    const char **images = d->view[0].images;
    int missing = 0;
    const char *first = NULL;
    for (int i = 0; i < d->m.lights; i++) {
        const char *listed = images[i];
        bool refused;
        images[i] = find_file(d, folder, listed, files, file_count, project, p, &refused);
        if (!images[i])
            return RELUME_ENOMEM;
        if (refused)
            return log_fail(log, RELUME_ELIMIT,
                            "%s: names '%.200s', outside its folder; expected the image beside the "
                            ".lp file; if you trust it, --allow-outside",
                            path, listed);
        if (!input_exists(images[i], log) && missing++ == 0)
            first = listed;
    }
    if (missing == d->m.lights && file_count == d->m.lights) {
        log_line(log, RELUME_WARNING,
                 "%s: none of the listed images exists; the %d images of the folder are taken in "
                 "the order of their names",
                 path, file_count);
        for (int i = 0; i < file_count; i++)
            if (!(images[i] = arena_format(&d->arena, "%s/%s", folder, files[i]->d_name)))
                return RELUME_ENOMEM;
    } else if (missing && !p->skip_missing) {
        return log_fail(log, RELUME_ENOTFOUND,
                        "%s: image '%.200s' does not exist; %d of %d images %s missing; "
                        "--skip-missing continues without %s",
                        path, first, missing, d->m.lights, missing == 1 ? "is" : "are",
                        missing == 1 ? "it" : "them");
    }
    return RELUME_OK;
}

relume_status lp_resolve(struct draft *draft, const char *path, bool project,
                         const struct relume_capture_params *params)
{
    char *copy = mem_text(path);
    if (!copy)
        return RELUME_ENOMEM;
    const char *folder = dirname(copy);
    struct dirent **files = NULL;
    const int found = scandir(folder, &files, is_image, by_name);
    if (found < 0 && errno != ENOENT) {
        const relume_status status =
            relume_input_fail(params->log, folder, "cannot be listed", errno);
        mem_free(copy);
        return status;
    }
    const int file_count = found > 0 ? found : 0;
    const relume_status status = resolve(draft, path, folder, files, file_count, project, params);
    for (int i = 0; i < file_count; i++)
        mem_free_libc(files[i]);
    mem_free_libc(files);
    mem_free(copy);
    return status;
}
