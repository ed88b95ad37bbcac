// mesh_mtl.c - material libraries of Wavefront OBJ: newmtl, Kd, map_Kd, d (opacity), and of the
// physically based extension Pr and Pm (roughness, metal), Ke and map_Ke (emission) and norm (a
// picture of normals); every other keyword is passed over
#include "core/base/tree.h"
#include "core/base/infile.h"
#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "shape/mesh/mesh_file.h"

#include <stdio.h>
#include <string.h>

static const char SPACE[] = " \t";

void mesh_library_free(struct mesh_library *library)
{
    for (size_t i = 0; i < library->count; i++)
        mem_free(library->material[i].name);
    mem_free(library->material);
    *library = (struct mesh_library){0};
}

const struct mesh_look *mesh_library_find(const struct mesh_library *library, const char *name)
{
    for (size_t i = 0; i < library->count; i++)
        if (!strcmp(library->material[i].name, name))
            return &library->material[i].look;
    return NULL;
}

static relume_status begin(struct mesh_library *library, const char *name)
{
    if (!mem_grow(&library->material, library->count, sizeof *library->material))
        return RELUME_ENOMEM;
    struct mesh_library_look *m = &library->material[library->count];
    *m = (struct mesh_library_look){mem_text(name), mesh_look_white()};
    library->count += m->name != NULL;
    return m->name ? RELUME_OK : RELUME_ENOMEM;
}

// Up to `n` numbers, in [0, 1]; what is none stays as it was.
static void read_numbers(float *out, int n, const char *text)
{
    for (int i = 0; i < n; i++) {
        char *end;
        const double x = strtod(text, &end);
        if (end == text || !isfinite(x))
            return;
        out[i] = (float)fmin(fmax(x, 0.0), 1.0);
        text = end;
    }
}

// Files that say 0 mean nothing by it. (Tr is the same or its contrary, by who wrote the file.)
static void read_opacity(struct mesh_look *look, const char *text)
{
    read_numbers(&look->opacity, 1, text);
    look->cover = look->opacity > 0.0f && look->opacity < 1.0f ? MESH_BLENDED : MESH_WHOLE;
}

// Behind options the last word is the name.
static const char *name_in(const char *text)
{
    const char *space = *text == '-' ? strrchr(text, ' ') : NULL;
    return space ? space + 1 : text;
}

// `to` NULL: it is nobody's.
static relume_status read_picture(int *to, struct mesh_file *out, const char *text,
                                  const char *path, bool colour)
{
    if (!*name_in(text))
        return RELUME_OK;
    char *name = path_beside(path, name_in(text));
    const int number = name ? mesh_file_picture(out, name) : -1;
    if (number < 0) {
        mem_free(name);
        return RELUME_ENOMEM;
    }
    if (to)
        *to = number;
    if (out->picture || !colour)
        mem_free(name);
    else
        out->picture = name;
    return RELUME_OK;
}

static relume_status read_line(struct mesh_library *library, struct mesh_file *out, char *line,
                               const char *path)
{
    char *word = line + strspn(line, SPACE);
    word[strcspn(word, "\r\n")] = '\0';
    for (size_t n = strlen(word); n && strchr(SPACE, word[n - 1]); n--)
        word[n - 1] = '\0';
    char *rest = word + strcspn(word, SPACE);
    if (*rest)
        *rest++ = '\0';
    rest += strspn(rest, SPACE);
    struct mesh_look *look = library->count ? &library->material[library->count - 1].look : NULL;
    if (!strcmp(word, "newmtl"))
        return begin(library, rest);
    if (!strcmp(word, "map_Kd"))
        return read_picture(look ? &look->picture : NULL, out, rest, path, true);
    if (look && !strcmp(word, "norm"))
        return read_picture(&look->normal, out, rest, path, false);
    if (look && !strcmp(word, "map_Ke"))
        return read_picture(&look->emitted, out, rest, path, false);
    if (look && !strcmp(word, "d"))
        read_opacity(look, rest);
    else if (look && !strcmp(word, "Ke"))
        read_numbers(look->emission, 3, rest);
    else if (look && !strcmp(word, "Kd"))
        read_numbers(look->colour, 3, rest);
    else if (look && !strcmp(word, "Pr"))
        read_numbers(&look->roughness, 1, rest);
    else if (look && !strcmp(word, "Pm"))
        read_numbers(&look->metallic, 1, rest);
    return RELUME_OK;
}

// Files that leave the colour black behind a picture mean the picture.
static void mend(struct mesh_look *look)
{
    const float *c = look->colour;
    if (look->picture >= 0 && c[0] + c[1] + c[2] == 0.0f)
        look->colour[0] = look->colour[1] = look->colour[2] = 1.0f;
    const float *e = look->emission;
    if (look->emitted >= 0 && e[0] + e[1] + e[2] == 0.0f)
        look->emission[0] = look->emission[1] = look->emission[2] = 1.0f;
}

relume_status mesh_read_mtl(struct mesh_library *library, struct mesh_file *out, const char *path,
                            const struct relume_log *log)
{
    const size_t first = library->count;
    FILE *file = input_open(path, log);
    char line[4096];
    relume_status status = RELUME_OK;
    while (file && !status && fgets(line, sizeof line, file))
        status = read_line(library, out, line, path);
    for (size_t i = first; i < library->count; i++)
        mend(&library->material[i].look);
    if (file)
        fclose(file);
    return status;
}
