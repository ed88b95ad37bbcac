// program.h - shaders from the tree, linked, with their uniforms found once by name
#ifndef VIEWER_PROGRAM_H
#define VIEWER_PROGRAM_H

#include "gl/gl.h"
#include "gl/shaders.h"

enum { PROGRAM_UNIFORMS = 56 };

struct program {
    GLuint id;
    GLint at[PROGRAM_UNIFORMS];  // by the caller's enum; -1 when the shader does not use it
};

// Link rectangle.vert with `fragment` ("slab.frag"). `uniforms` is a list of `n` names in the order
// of the caller's enum. RELUME_ESYSTEM with the compiler's words.
relume_status program_create(struct program *program, const struct gl *gl, const char *fragment,
                             const char *const *uniforms, int n, const struct relume_log *log);
struct fragment {
    const char *name, *const *uniforms;
    int count;  // of uniforms
};
relume_status program_create_fragment(struct program *program, const struct gl *gl,
                                      const struct fragment *fragment,
                                      const struct relume_log *log);
// Several of them, up to the first that fails.
struct fragment_program {
    struct program *program;
    const struct fragment *fragment;
};
relume_status program_create_fragments(const struct fragment_program *list, size_t n,
                                       const struct gl *gl, const struct relume_log *log);
// The same with `defines`, lines that follow the first.
relume_status program_create_variant(struct program *program, const struct gl *gl,
                                     const char *fragment, const char *defines,
                                     const char *const *uniforms, int n,
                                     const struct relume_log *log);
// The same with a vertex shader of its own.
relume_status program_create_with(struct program *program, const struct gl *gl, const char *vertex,
                                  const char *fragment, const char *const *uniforms, int n,
                                  const struct relume_log *log);
// A compute shader ("glare_power.comp"); `defines` (may be NULL) are lines that follow the first.
relume_status program_create_compute(struct program *program, const struct gl *gl,
                                     const char *compute, const char *defines,
                                     const char *const *uniforms, int n,
                                     const struct relume_log *log);
// Several of them, up to the first that fails.
struct compute_shader {
    struct program *program;
    const char *name, *const *uniforms;
    int count;  // of uniforms
};
relume_status program_create_shaders(const struct compute_shader *list, size_t n,
                                     const struct gl *gl, const struct relume_log *log);
void program_destroy(struct program *program, const struct gl *gl);

static inline void gl_set_vec3(const struct gl *gl, GLint at, struct relume_vec3 v)
{
    gl->Uniform3f(at, (float)v.x, (float)v.y, (float)v.z);
}

// The buffer that shaders see at that binding.
static inline void gl_bind(const struct gl *gl, GLuint binding, GLuint buffer)
{
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

#endif
