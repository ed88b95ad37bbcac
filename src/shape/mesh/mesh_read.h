// mesh_read.h - models from files: Wavefront OBJ and PLY, others by Assimp
#ifndef MESH_MESH_READ_H
#define MESH_MESH_READ_H

#include "shape/mesh/mesh_file.h"

// Chosen by the extension. Polygons are triangulated as fans, missing normals are made smooth, the
// picture is what the model names, else the PNG or JPEG of the same base name beside it.
// Returns an input status with a sentence, RELUME_ENOMEM.
relume_status mesh_read(struct mesh_file *out, const char *path, const struct relume_log *log);

#endif
