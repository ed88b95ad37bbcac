// mesh_other.h - models of every format that Assimp reads, glTF among them
//
// Assimp is 10 MB of C++ that only these formats need, so what knows it is a module of its own,
// librelume-assimp.so. The helper (core/base/helper.h) opens it and reads every model in a process
// of its own: what is damaged, or made to do harm, does none here.
#ifndef MESH_MESH_OTHER_H
#define MESH_MESH_OTHER_H

#include "shape/mesh/mesh_file.h"

// Triangles of all that the file shows, where it stands; parts are its materials. An input status
// with a sentence, RELUME_ENOMEM; RELUME_ESYSTEM when the module cannot be loaded. `log` says how
// much memory a model may take.
relume_status mesh_read_other(struct mesh_file *out, const char *path,
                              const struct relume_log *log);

#endif
