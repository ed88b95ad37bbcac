// mesh_assimp.c - the one file that knows Assimp; a module of its own, in the helper (mesh_other.h)
#include "mesh/mesh_bridge.h"

#include "base/memory.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
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

static int part_of(struct mesh_file *out, const struct aiScene *scene, const struct aiMesh *mesh)
{
    struct aiString name = {.length = 0};
    char number[32];
    if (mesh->mMaterialIndex < scene->mNumMaterials)
        (void)aiGetMaterialString(scene->mMaterials[mesh->mMaterialIndex], AI_MATKEY_NAME, &name);
    snprintf(number, sizeof number, "%u", mesh->mMaterialIndex);
    return mesh_file_part(out, name.length ? name.data : number);
}

static bool add_mesh(struct mesh_file *out, const struct aiScene *scene, const struct aiMesh *from)
{
    const int part = part_of(out, scene, from);
    const uint32_t first = (uint32_t)out->mesh.vertex_count;
    if (part < 0)
        return false;
    out->has_uv |= from->mTextureCoords[0] != NULL;
    for (unsigned i = 0; i < from->mNumVertices; i++) {
        const vec3 n = vector(from->mNormals, i);
        mesh_vertex(&out->mesh, vector(from->mVertices, i),
                    vec3_length(n) > 0.0 ? vec3_unit(n) : vec3_of(0, 0, 1),
                    vector(from->mTextureCoords[0], i));
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
    bool good = true;
    for (unsigned i = 0; i < scene->mNumMeshes && good; i++)
        good = add_mesh(out, scene, scene->mMeshes[i]);
    aiReleaseImport(scene);
    return good;
}

__attribute__((visibility("default"))) extern const struct assimp_bridge relume_assimp_bridge;
const struct assimp_bridge relume_assimp_bridge = {RELUME_VERSION, read_model};
