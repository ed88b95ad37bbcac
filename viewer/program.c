#include "program.h"

#include "say.h"

#include <assert.h>
#include <string.h>

static const struct shader_source *find_source(const char *name)
{
    const struct shader_source *s = shader_sources;
    while (s->name && strcmp(s->name, name))
        s++;
    assert(s->name);
    return s;
}

static relume_status compile(GLuint *out, const struct gl *gl, GLenum stage, const char *name,
                             const struct relume_log *log)
{
    const struct shader_source *source = find_source(name);
    GLint done = 0;
    *out = gl->CreateShader(stage);
    gl->ShaderSource(*out, (GLsizei)source->lines, source->line, NULL);
    gl->CompileShader(*out);
    gl->GetShaderiv(*out, GL_COMPILE_STATUS, &done);
    if (done)
        return RELUME_OK;
    char text[512] = "";
    gl->GetShaderInfoLog(*out, sizeof text, NULL, text);
    return say(log, RELUME_ESYSTEM, "shader %s does not compile; %s", name, text);
}

static relume_status link_program(struct program *program, const struct gl *gl, GLuint vertex,
                                  GLuint fragment, const char *name, const struct relume_log *log)
{
    GLint done = 0;
    program->id = gl->CreateProgram();
    gl->AttachShader(program->id, vertex);
    gl->AttachShader(program->id, fragment);
    gl->LinkProgram(program->id);
    gl->GetProgramiv(program->id, GL_LINK_STATUS, &done);
    if (done)
        return RELUME_OK;
    char text[512] = "";
    gl->GetProgramInfoLog(program->id, sizeof text, NULL, text);
    return say(log, RELUME_ESYSTEM, "shader %s does not link; %s", name, text);
}

relume_status program_create_with(struct program *program, const struct gl *gl, const char *vertex,
                                  const char *fragment, const char *const *uniforms, int n,
                                  const struct relume_log *log)
{
    assert(n <= PROGRAM_UNIFORMS);
    *program = (struct program){0};
    GLuint stages[2] = {0, 0};
    relume_status status = compile(&stages[0], gl, GL_VERTEX_SHADER, vertex, log);
    if (!status)
        status = compile(&stages[1], gl, GL_FRAGMENT_SHADER, fragment, log);
    if (!status)
        status = link_program(program, gl, stages[0], stages[1], fragment, log);
    gl->DeleteShader(stages[0]);
    gl->DeleteShader(stages[1]);
    for (int i = 0; !status && i < n; i++)
        program->at[i] = gl->GetUniformLocation(program->id, uniforms[i]);
    return status;
}

relume_status program_create(struct program *program, const struct gl *gl, const char *fragment,
                             const char *const *uniforms, int n, const struct relume_log *log)
{
    return program_create_with(program, gl, "rectangle.vert", fragment, uniforms, n, log);
}

void program_destroy(struct program *program, const struct gl *gl)
{
    gl->DeleteProgram(program->id);
    *program = (struct program){0};
}
