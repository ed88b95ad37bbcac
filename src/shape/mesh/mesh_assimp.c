// mesh_assimp.c - the one file that knows Assimp; a module of its own, in the helper (mesh_other.h)
#include "shape/mesh/mesh_bridge.h"

#include "core/base/memory.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static vec3 vector(const struct aiVector3D *list, unsigned i)
{
    return list ? vec3_of((double)list[i].x, (double)list[i].y, (double)list[i].z)
                : vec3_of(0, 0, 0);
}

// ---------------------------------------------------------------- materials

// Within the model; NULL: it is none of those. A star stands before a number.
static const struct aiTexture *texture_in(const struct aiScene *scene, const char *name)
{
    const unsigned long number = *name == '*' ? strtoul(name + 1, NULL, 10) : ULONG_MAX;
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        if (number == i || !strcmp(scene->mTextures[i]->mFilename.data, name))
            return scene->mTextures[i];
    return NULL;
}

// A picture within the model, or the name of a file; -1: it cannot be had.
static int picture_named(struct mesh_file *out, const struct aiScene *scene, const char *name)
{
    const struct aiTexture *t = texture_in(scene, name);
    if (!t)
        return mesh_file_picture(out, name);
    // without a height it is a file of that many bytes
    return t->mHeight ? -1 : mesh_file_picture_of(out, name, t->pcData, t->mWidth);
}

static int picture_of(struct mesh_file *out, const struct aiScene *scene,
                      const struct aiMaterial *material, enum aiTextureType type)
{
    struct aiString name = {.length = 0};
    const bool found = aiGetMaterialTexture(material, type, 0, &name, NULL, NULL, NULL, NULL, NULL,
                                            NULL) == aiReturn_SUCCESS;
    return found && name.length ? picture_named(out, scene, name.data) : -1;
}

static float within(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);  // NaN: 0
}

static bool read_float(float *to, const struct aiMaterial *material, const char *key, unsigned type)
{
    ai_real value = 0;
    unsigned most = 1;
    const bool is =
        aiGetMaterialFloatArray(material, key, type, 0, &value, &most) == aiReturn_SUCCESS;
    if (is)
        *to = (float)value;
    return is;
}

static void read_factor(float *to, const struct aiMaterial *material, const char *key)
{
    if (read_float(to, material, key, 0))
        *to = within(*to);
}

// What shines through. Of glTF the mode says so, of others the opacity.
static void read_cover(struct mesh_look *look, const struct aiMaterial *material)
{
    struct aiString mode = {.length = 0};
    read_factor(&look->opacity, material, "$mat.opacity");
    if (aiGetMaterialString(material, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS)
        look->cover = !strcmp(mode.data, "MASK")    ? MESH_CUT
                      : !strcmp(mode.data, "BLEND") ? MESH_BLENDED
                                                    : MESH_WHOLE;
    else
        look->cover = look->opacity > 0.0f && look->opacity < 1.0f ? MESH_BLENDED : MESH_WHOLE;
    read_factor(&look->cutoff, material, "$mat.gltf.alphaCutoff");
}

static void read_emission(struct mesh_look *look, const struct aiMaterial *material)
{
    const float MOST = 65504.0f;
    float strength = 1.0f;
    struct aiColor4D c;
    if (aiGetMaterialColor(material, AI_MATKEY_COLOR_EMISSIVE, &c) != aiReturn_SUCCESS)
        return;
    (void)read_float(&strength, material, "$mat.emissiveIntensity", 0);
    const float rgb[3] = {c.r, c.g, c.b};
    for (int i = 0; i < 3; i++)
        look->emission[i] = fminf(fmaxf(strength * rgb[i], 0.0f), MOST);
}

// Where the file is no glTF it may say only what is diffuse.
static struct mesh_look look_of(struct mesh_file *out, const struct aiScene *scene,
                                const struct aiMaterial *material)
{
    const float STEEPEST = 16.0f;
    struct mesh_look look = mesh_look_white();
    struct aiColor4D c;
    if (aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &c) == aiReturn_SUCCESS ||
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &c) == aiReturn_SUCCESS) {
        look.colour[0] = within(c.r);
        look.colour[1] = within(c.g);
        look.colour[2] = within(c.b);
        look.opacity = within(c.a);
    }
    read_factor(&look.metallic, material, "$mat.metallicFactor");
    read_factor(&look.roughness, material, "$mat.roughnessFactor");
    look.picture = picture_of(out, scene, material, aiTextureType_BASE_COLOR);
    if (look.picture < 0)
        look.picture = picture_of(out, scene, material, aiTextureType_DIFFUSE);
    look.surface = picture_of(out, scene, material, aiTextureType_UNKNOWN);
    look.normal = picture_of(out, scene, material, aiTextureType_NORMALS);
    if (read_float(&look.bump, material, "$tex.scale", aiTextureType_NORMALS))
        look.bump = fminf(fmaxf(look.bump, -STEEPEST), STEEPEST);
    look.emitted = picture_of(out, scene, material, aiTextureType_EMISSIVE);
    read_cover(&look, material);
    read_emission(&look, material);
    return look;
}

// Materials may share a name.
static int part_of(struct mesh_file *out, const struct aiScene *scene, const struct aiMesh *mesh,
                   int *part)
{
    const unsigned number = mesh->mMaterialIndex;
    struct aiString name = {.length = 0};
    char text[32];
    if (number >= scene->mNumMaterials)
        return mesh_file_part(out, "0");
    if (part[number] >= 0)
        return part[number];
    const struct aiMaterial *material = scene->mMaterials[number];
    (void)aiGetMaterialString(material, AI_MATKEY_NAME, &name);
    snprintf(text, sizeof text, "%u", number);
    part[number] = mesh_file_new_part(out, name.length ? name.data : text);
    if (part[number] >= 0)
        out->look[part[number]] = look_of(out, scene, material);
    return part[number];
}

// ---------------------------------------------------------------- meshes

static uint8_t srgb_byte(float linear)
{
    const double x = (double)within(linear);
    const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (uint8_t)lrint(255.0 * code);
}

// Colours of vertices are linear in glTF. Where only some meshes have them the others are white.
static bool add_colour(struct mesh_file *out, uint32_t vertex, const struct aiColor4D *c)
{
    uint8_t rgba[4] = {255, 255, 255, 255};
    if (!mem_grow(&out->colour, vertex, sizeof *out->colour))
        return false;
    if (c) {
        const float value[3] = {c->r, c->g, c->b};
        for (int i = 0; i < 3; i++)
            rgba[i] = srgb_byte(value[i]);
        rgba[3] = (uint8_t)lrintf(255.0f * within(c->a));
    }
    memcpy(out->colour[vertex], rgba, sizeof rgba);
    return true;
}

static bool add_mesh(struct mesh_file *out, const struct aiScene *scene, const struct aiMesh *from,
                     int *parts, bool coloured)
{
    const int part = part_of(out, scene, from, parts);
    const uint32_t first = (uint32_t)out->mesh.vertex_count;
    if (part < 0)
        return false;
    out->has_uv |= from->mTextureCoords[0] != NULL;
    for (unsigned i = 0; i < from->mNumVertices && !out->mesh.failed; i++) {
        const vec3 n = vector(from->mNormals, i);
        const uint32_t vertex = mesh_vertex(&out->mesh, vector(from->mVertices, i),
                                            vec3_length(n) > 0.0 ? vec3_unit(n) : vec3_of(0, 0, 1),
                                            vector(from->mTextureCoords[0], i));
        if (coloured && !out->mesh.failed)
            out->mesh.failed =
                !add_colour(out, vertex, from->mColors[0] ? &from->mColors[0][i] : NULL);
    }
    for (unsigned i = 0; i < from->mNumFaces; i++) {
        const struct aiFace *f = &from->mFaces[i];
        if (f->mNumIndices == 3 && f->mIndices[0] < from->mNumVertices &&
            f->mIndices[1] < from->mNumVertices && f->mIndices[2] < from->mNumVertices)
            mesh_triangle(&out->mesh, first + f->mIndices[0], first + f->mIndices[1],
                          first + f->mIndices[2], (uint32_t)part);
    }
    return !out->mesh.failed;
}

static bool add_meshes(struct mesh_file *out, const struct aiScene *scene)
{
    int *part = mem_array(scene->mNumMaterials, sizeof *part);
    bool good = part != NULL, coloured = false;
    for (unsigned i = 0; part && i < scene->mNumMaterials; i++)
        part[i] = -1;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        coloured |= scene->mMeshes[i]->mColors[0] != NULL;
    for (unsigned i = 0; i < scene->mNumMeshes && good; i++)
        good = add_mesh(out, scene, scene->mMeshes[i], part, coloured);
    mem_free(part);
    return good;
}

// Assimp leaves out faces of vertices that are not there, and says so in passing.
static void hear(const char *message, char *user)
{
    if (strstr(message, "out-of-range indices"))
        *(bool *)(void *)user = true;
}

// ---------------------------------------------------------------- files, as Assimp asks for them

struct stream {
    struct aiFile file;  // first
    int descriptor;
    size_t at, size;
};

static size_t stream_read(struct aiFile *file, char *to, size_t size, size_t count)
{
    struct stream *s = (struct stream *)file;
    size_t want, got = 0;
    if (!size || __builtin_mul_overflow(size, count, &want))
        return 0;
    while (got < want) {
        const ssize_t n = pread(s->descriptor, to + got, want - got, (off_t)(s->at + got));
        if (n <= 0)
            break;
        got += (size_t)n;
    }
    s->at += got;
    return got / size;
}

static size_t stream_write(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t stream_tell(struct aiFile *file)
{
    return ((const struct stream *)file)->at;
}

static size_t stream_size(struct aiFile *file)
{
    return ((const struct stream *)file)->size;
}

static void stream_flush(struct aiFile *file)
{
    (void)file;
}

static enum aiReturn stream_seek(struct aiFile *file, size_t by, enum aiOrigin from)
{
    struct stream *s = (struct stream *)file;
    const size_t at = by + (from == aiOrigin_CUR ? s->at : from == aiOrigin_END ? s->size : 0);
    if (at > s->size)
        return aiReturn_FAILURE;
    s->at = at;
    return aiReturn_SUCCESS;
}

static struct aiFile *stream_open(struct aiFileIO *io, const char *name, const char *mode)
{
    const struct mesh_source *source = (const struct mesh_source *)(const void *)io->UserData;
    struct stat st;
    const int descriptor = strchr(mode, 'w') ? -1 : source->open(source->context, name);
    struct stream *s = descriptor < 0 || fstat(descriptor, &st) ? NULL : mem_array(1, sizeof *s);
    if (!s) {
        if (descriptor >= 0)
            close(descriptor);
        return NULL;
    }
    *s = (struct stream){.file = {.ReadProc = stream_read,
                                  .WriteProc = stream_write,
                                  .TellProc = stream_tell,
                                  .FileSizeProc = stream_size,
                                  .SeekProc = stream_seek,
                                  .FlushProc = stream_flush},
                         .descriptor = descriptor,
                         .size = (size_t)st.st_size};
    return &s->file;
}

static void stream_close(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    close(((const struct stream *)file)->descriptor);
    mem_free(file);
}

// ---------------------------------------------------------------- models

static const struct aiScene *import(const struct mesh_source *source, unsigned steps,
                                    const struct aiPropertyStore *settings, bool *dropped)
{
    struct aiFileIO io = {stream_open, stream_close, (char *)(size_t)source};
    const struct aiLogStream stream = {hear, (char *)dropped};
    aiAttachLogStream(&stream);
    const struct aiScene *scene = aiImportFileExWithProperties(source->name, steps, &io, settings);
    aiDetachLogStream(&stream);
    return scene;
}

static bool read_model(struct mesh_file *out, const struct mesh_source *source,
                       char why[MESH_OTHER_WHY])
{
    bool dropped = false;
    const unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices |
                           aiProcess_SortByPType | aiProcess_ValidateDataStructure;
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    // lines and points are no surface
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const struct aiScene *scene = import(source, steps, settings, &dropped);
    aiReleasePropertyStore(settings);
    if (!scene || dropped) {
        const char *error = dropped ? "faces of vertices that are not there" : aiGetErrorString();
        snprintf(why, MESH_OTHER_WHY, "%s", strstr(error, "bad_alloc") ? "" : error);
        why[strcspn(why, "\r\n")] = '\0';
        aiReleaseImport(scene);
        return false;
    }
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        out->made_normals |= !scene->mMeshes[i]->mNormals;
    if (out->made_normals)
        (void)aiApplyPostProcessing(scene, aiProcess_GenSmoothNormals);
    const bool good = add_meshes(out, scene);
    aiReleaseImport(scene);
    return good;
}

__attribute__((visibility("default"))) extern const struct assimp_bridge relume_assimp_bridge;
const struct assimp_bridge relume_assimp_bridge = {RELUME_VERSION, read_model};
