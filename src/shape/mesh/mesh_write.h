// mesh_write.h - what the writers of meshes share: bytes that go out in order, through a buffer
#ifndef MESH_MESH_WRITE_H
#define MESH_MESH_WRITE_H

#include "core/base/outfile.h"

#include <relume/shape/mesh.h>

enum { SINK_BYTES = 1 << 20 };

// Once writing has failed `status` says so, and further bytes do nothing.
struct sink {
    outfile *file;
    char *buffer;  // [SINK_BYTES]
    size_t filled;
    off_t offset;  // of the buffer's first byte
    relume_status status;
};
void sink_put(struct sink *s, const void *bytes, size_t size);
__attribute__((format(printf, 2, 3))) void sink_print(struct sink *s, const char *format, ...);

// The name of the mesh's picture as its file `path` says it: without the folder, where that is the
// same.
const char *mesh_write_picture(const struct relume_mesh *mesh, const char *path);

// The three formats. Failure is the sink's, but for what cannot be written at all.
relume_status mesh_write_obj(struct sink *to, const struct relume_mesh *mesh, const char *path,
                             const struct relume_log *log);
relume_status mesh_write_ply(struct sink *to, const struct relume_mesh *mesh, const char *path,
                             const struct relume_log *log);
relume_status mesh_write_glb(struct sink *to, const struct relume_mesh *mesh, const char *path,
                             const struct relume_log *log);

#endif
