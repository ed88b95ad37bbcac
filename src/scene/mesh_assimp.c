// mesh_assimp.c - the one file that knows Assimp; a module of its own (mesh_other.h)
#include "scene/mesh_other.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

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

static const struct aiScene *import(const char *path, unsigned steps,
                                    const struct aiPropertyStore *settings, bool *dropped)
{
    static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;  // all hear all messages
    const struct aiLogStream stream = {hear, (char *)dropped};
    pthread_mutex_lock(&one_at_a_time);
    aiAttachLogStream(&stream);
    const struct aiScene *scene = aiImportFileExWithProperties(path, steps, NULL, settings);
    aiDetachLogStream(&stream);
    pthread_mutex_unlock(&one_at_a_time);
    return scene;
}

static bool read(struct mesh_file *out, const char *path, char why[MESH_OTHER_WHY])
{
    bool dropped = false;
    const unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices |
                           aiProcess_SortByPType | aiProcess_ValidateDataStructure;
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    // lines and points are no surface
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const struct aiScene *scene = import(path, steps, settings, &dropped);
    aiReleasePropertyStore(settings);
    if (!scene || dropped) {
        snprintf(why, MESH_OTHER_WHY, "%s",
                 dropped ? "faces of vertices that are not there" : aiGetErrorString());
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
const struct assimp_bridge relume_assimp_bridge = {RELUME_VERSION, read};
