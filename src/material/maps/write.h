// write.h - what the files of a folder of maps have in common
#ifndef APPEARANCE_WRITE_H
#define APPEARANCE_WRITE_H

#include <relume/material/maps.h>
#include <stdio.h>

struct writing {
    const struct relume_maps *maps;
    const struct relume_maps_write_params *params;
    const char *folder;
    const char *gl_normal;  // the normal map whose green points up
    double metres;          // of a world unit
    double specular_most;   // of specular.png: what its colour 1 stands for, of common glass's F0
    bool masked;            // some pixels are not known
};

// A file of text, or of text that `put` prints.
relume_status write_text(const struct writing *w, const char *name,
                         void (*put)(const void *w, FILE *f));
relume_status write_bytes(const struct writing *w, const char *name, const void *bytes,
                          size_t size);

// model.gltf and model.bin; model.mtlx.
relume_status write_gltf(const struct writing *w);
relume_status write_materialx(const struct writing *w);

#endif
