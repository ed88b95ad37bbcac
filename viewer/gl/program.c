// program.c - shaders from the tree, linked, with their uniforms found once by name
#include "gl/program.h"

#include "cli/program/say.h"

#include <assert.h>
#include <string.h>

// The first line says the version; `defines` follow it.
static void set_source(const struct gl *gl, GLuint shader, const struct shader_source *source,
                       const char *defines)
{
    enum { MOST = 1024 };
    const char *line[MOST + 1];
    assert(source->lines <= MOST);
    line[0] = source->line[0];
    line[1] = defines ? defines : "";
    memcpy(line + 2, source->line + 1, (source->lines - 1) * sizeof *line);
    gl->ShaderSource(shader, (GLsizei)source->lines + 1, line, NULL);
}

static relume_status compile(GLuint *out, const struct gl *gl, GLenum stage, const char *name,
                             const char *defines, const struct relume_log *log)
{
    const struct shader_source *source = shader_sources;
    while (source->name && strcmp(source->name, name))
        source++;
    assert(source->name);
    GLint done = 0;
    *out = gl->CreateShader(stage);
    set_source(gl, *out, source, defines);
    gl->CompileShader(*out);
    gl->GetShaderiv(*out, GL_COMPILE_STATUS, &done);
    if (done)
        return RELUME_OK;
    char text[512] = "";
    gl->GetShaderInfoLog(*out, sizeof text, NULL, text);
    text[strcspn(text, "\r\n")] = '\0';  // the first mistake is enough
    return say(log, RELUME_ESYSTEM, "shader %s does not compile; %s", name, text);
}

static relume_status link_program(struct program *program, const struct gl *gl,
                                  const GLuint stages[2], const char *name,
                                  const struct relume_log *log)
{
    GLint done = 0;
    program->id = gl->CreateProgram();
    for (int i = 0; i < 2; i++)
        if (stages[i])
            gl->AttachShader(program->id, stages[i]);
    gl->LinkProgram(program->id);
    gl->GetProgramiv(program->id, GL_LINK_STATUS, &done);
    if (done)
        return RELUME_OK;
    char text[512] = "";
    gl->GetProgramInfoLog(program->id, sizeof text, NULL, text);
    text[strcspn(text, "\r\n")] = '\0';
    return say(log, RELUME_ESYSTEM, "shader %s does not link; %s", name, text);
}

// The stages belong to it.
static relume_status link_stages(struct program *program, const struct gl *gl,
                                 const GLuint stages[2], const char *name,
                                 const char *const *uniforms, int n, relume_status status,
                                 const struct relume_log *log)
{
    assert(n <= PROGRAM_UNIFORMS);
    *program = (struct program){0};
    if (!status)
        status = link_program(program, gl, stages, name, log);
    gl->DeleteShader(stages[0]);
    gl->DeleteShader(stages[1]);
    for (int i = 0; !status && i < n; i++)
        program->at[i] = gl->GetUniformLocation(program->id, uniforms[i]);
    return status;
}

static relume_status create(struct program *program, const struct gl *gl, const char *vertex,
                            const char *fragment, const char *defines, const char *const *uniforms,
                            int n, const struct relume_log *log)
{
    GLuint stages[2] = {0, 0};
    relume_status status = compile(&stages[0], gl, GL_VERTEX_SHADER, vertex, NULL, log);
    if (!status)
        status = compile(&stages[1], gl, GL_FRAGMENT_SHADER, fragment, defines, log);
    return link_stages(program, gl, stages, fragment, uniforms, n, status, log);
}

relume_status program_create_with(struct program *program, const struct gl *gl, const char *vertex,
                                  const char *fragment, const char *const *uniforms, int n,
                                  const struct relume_log *log)
{
    return create(program, gl, vertex, fragment, NULL, uniforms, n, log);
}

relume_status program_create_variant(struct program *program, const struct gl *gl,
                                     const char *fragment, const char *defines,
                                     const char *const *uniforms, int n,
                                     const struct relume_log *log)
{
    return create(program, gl, "rectangle.vert", fragment, defines, uniforms, n, log);
}

relume_status program_create_compute(struct program *program, const struct gl *gl,
                                     const char *compute, const char *defines,
                                     const char *const *uniforms, int n,
                                     const struct relume_log *log)
{
    GLuint stages[2] = {0, 0};
    const relume_status status = compile(&stages[0], gl, GL_COMPUTE_SHADER, compute, defines, log);
    return link_stages(program, gl, stages, compute, uniforms, n, status, log);
}

relume_status program_create_fragments(const struct fragment_program *list, size_t n,
                                       const struct gl *gl, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (size_t i = 0; i < n && !status; i++)
        status = program_create_fragment(list[i].program, gl, list[i].fragment, log);
    return status;
}

relume_status program_create_shaders(const struct compute_shader *list, size_t n,
                                     const struct gl *gl, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < n; i++)
        status = program_create_compute(list[i].program, gl, list[i].name, NULL, list[i].uniforms,
                                        list[i].count, log);
    return status;
}

relume_status program_create(struct program *program, const struct gl *gl, const char *fragment,
                             const char *const *uniforms, int n, const struct relume_log *log)
{
    return program_create_variant(program, gl, fragment, NULL, uniforms, n, log);
}

relume_status program_create_fragment(struct program *program, const struct gl *gl,
                                      const struct fragment *fragment, const struct relume_log *log)
{
    return program_create(program, gl, fragment->name, fragment->uniforms, fragment->count, log);
}

void program_destroy(struct program *program, const struct gl *gl)
{
    gl->DeleteProgram(program->id);
    *program = (struct program){0};
}
