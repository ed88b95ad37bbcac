// gl.c - the functions of OpenGL 3.3 core that the viewer uses, loaded from the context; compute
// compute shaders of 4.3 where there are any
#include "gl/gl.h"

#include "cli/program/say.h"

#include <string.h>

static bool is_software(const char *renderer)
{
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "Software",
                                        "SwiftShader"};
    for (size_t i = 0; renderer && i < sizeof names / sizeof *names; i++)
        if (strstr(renderer, names[i]))
            return true;
    return false;
}

static bool has_extension(const struct gl *gl, const char *name)
{
    GLint n = 0;
    gl->GetIntegerv(GL_NUM_EXTENSIONS, &n);
    for (GLint i = 0; i < n; i++) {
        const char *have = (const char *)gl->GetStringi(GL_EXTENSIONS, (GLuint)i);
        if (have && !strcmp(have, name))
            return true;
    }
    return false;
}

// Only of what the context says it has: drivers hand out functions that they do not have.
static PFNGLGETGRAPHICSRESETSTATUSPROC find_reset_status(const struct gl *gl,
                                                         gl_proc (*get_proc)(const char *name))
{
    const char *name = has_extension(gl, "GL_KHR_robustness")   ? "glGetGraphicsResetStatus"
                       : has_extension(gl, "GL_ARB_robustness") ? "glGetGraphicsResetStatusARB"
                                                                : NULL;
    return name ? (PFNGLGETGRAPHICSRESETSTATUSPROC)get_proc(name) : NULL;
}

static void load_compute(struct gl *gl, gl_proc (*get_proc)(const char *name))
{
    GLint major = 0, minor = 0, bytes = 0;
    gl->GetIntegerv(GL_MAJOR_VERSION, &major);
    gl->GetIntegerv(GL_MINOR_VERSION, &minor);
    gl->compute = major > 4 || (major == 4 && minor >= 3);
#define GL_LOAD(type, name)                                                                        \
    gl->name = gl->compute ? (type)get_proc("gl" #name) : NULL;                                    \
    gl->compute &= gl->name != NULL;
    GL_COMPUTE_FUNCTIONS(GL_LOAD)
#undef GL_LOAD
    if (!gl->compute)
        return;
    gl->GetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &gl->shared_bytes);
    gl->GetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    gl->storage_bytes = bytes < 0 ? 0x7fffffff : bytes;  // more than an int can say
}

relume_status gl_load(struct gl *gl, gl_proc (*get_proc)(const char *name),
                      const struct relume_log *log)
{
#define GL_LOAD(type, name)                                                                        \
    gl->name = (type)get_proc("gl" #name);                                                         \
    if (!gl->name)                                                                                 \
        return say(log, RELUME_ESYSTEM, "OpenGL: expected version 3.3; gl" #name " is missing");
    GL_FUNCTIONS(GL_LOAD)
#undef GL_LOAD
    gl->GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &gl->max_layers);
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &gl->max_texture);
    load_compute(gl, get_proc);
    gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &gl->max_buffer);
    gl->reset_status = find_reset_status(gl, get_proc);
    gl->software = is_software((const char *)gl->GetString(GL_RENDERER));
    return RELUME_OK;
}

relume_status gl_check(const struct gl *gl, const char *doing, const struct relume_log *log)
{
    const GLenum error = gl->GetError();
    if (error == GL_CONTEXT_LOST || (gl->reset_status && gl->reset_status() != GL_NO_ERROR))
        return say(log, RELUME_ESYSTEM,
                   "%s: the graphics card was reset and its contents are lost; start again", doing);
    if (error == GL_NO_ERROR)
        return RELUME_OK;
    if (error == GL_OUT_OF_MEMORY)
        return say(log, RELUME_ESYSTEM, "%s: the graphics memory is full", doing);
    return say(log, RELUME_ESYSTEM, "%s: OpenGL error 0x%04x", doing, error);
}

GLuint gl_storage(const struct gl *gl, size_t bytes, const void *data)
{
    GLuint buffer;
    gl->GenBuffers(1, &buffer);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)bytes, data, GL_DYNAMIC_COPY);
    return buffer;
}
