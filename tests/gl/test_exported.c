// Exported eigenimages, relit by the shader that is written beside them, and by the library
#include "test.h"

#include "capture_fixture.h"
#include "format/coder/coding.h"
#include "gl/target.h"
#include "window/context.h"

enum { SIDE = 16, TERMS = 6, LIGHTS = 40, FACE = 32, HEAD = 148, BPTC = 0x8e8c, CUBES = 0x9009 };

typedef void compressed(GLenum, GLint, GLenum, GLsizei, GLsizei, GLsizei, GLint, GLsizei,
                        const void *);

static void *context;
static struct gl gl;
static char folder[64], out[128], pack_path[128];

static int setup(void **state)
{
    (void)state;
    static const struct fixture f = {.width = SIDE, .height = SIDE, .lights = LIGHTS, .views = 1};
    struct relume_capture *capture;
    relume_coder *coder;
    relume_pack *pack;
    enum relume_domain domain;
    struct relume_transfer display;
    fixture_write(&f, test_folder(folder));
    snprintf(out, sizeof out, "%s/textures", folder);
    snprintf(pack_path, sizeof pack_path, "%s/pack.exr", folder);
    if (relume_domain_parse(&domain, &display, "log:0.02") ||
        relume_capture_open(&capture, folder, NULL) ||
        relume_coder_learn(&coder, &relume_basis_eigen, capture,
                           relume_coder_params(.coefficients = TERMS),
                           relume_project_params(.domain = domain, .display = display)) ||
        relume_pack_encode(capture, coder, pack_path, NULL,
                           relume_pack_encode_params(.domain = domain, .display = display,
                                                     .storage = RELUME_STORE_HALF)) ||
        relume_pack_open(&pack, pack_path, NULL) ||
        relume_export(pack, out, RELUME_EXCHANGE_BC7, NULL, NULL))
        return 1;
    relume_pack_destroy(&pack);
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    if (context_osmesa.open(&context, 1, 1, "test", NULL))
        return 1;
    return gl_load(&gl, context_osmesa.get_proc, NULL) != 0;
}

static int teardown(void **state)
{
    (void)state;
    context_osmesa.close(context);
    test_folder_remove(folder);
    return 0;
}

static size_t read_file(char *to, size_t most, const char *name, int number)
{
    char path[256];
    snprintf(path, sizeof path, number < 0 ? "%s/%s" : "%s/%s%02d.dds", out, name, number);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    const size_t n = fread(to, 1, most - 1, f);
    fclose(f);
    to[n] = '\0';
    return n;
}

static GLuint compile(GLenum kind, const char *text)
{
    char said[2000] = "";
    GLint good = 0;
    const GLuint shader = gl.CreateShader(kind);
    gl.ShaderSource(shader, 1, &text, NULL);
    gl.CompileShader(shader);
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        gl.GetShaderInfoLog(shader, sizeof said, NULL, said);
        print_error("%s\n", said);
    }
    assert_true(good);
    return shader;
}

static GLuint link_program(void)
{
    static const char vertex[] =
        "#version 330\nvoid main() { gl_Position = vec4(vec2(gl_VertexID % 2,"
        " gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }\n";
    static char text[8000], relit[6000];
    (void)read_file(relit, sizeof relit, "relit.glsl", -1);
    snprintf(text, sizeof text,
             "#version 330\n#extension GL_ARB_texture_cube_map_array : require\n%s"
             "uniform vec3 lamp;\nout vec4 color;\n"
             "void main() { color = vec4(relit(gl_FragCoord.xy / %d.0, lamp), 1.0); }\n",
             relit, SIDE);
    GLint good = 0;
    const GLuint program = gl.CreateProgram();
    gl.AttachShader(program, compile(GL_VERTEX_SHADER, vertex));
    gl.AttachShader(program, compile(GL_FRAGMENT_SHADER, text));
    gl.LinkProgram(program);
    gl.GetProgramiv(program, GL_LINK_STATUS, &good);
    assert_true(good);
    return program;
}

static void upload(void)
{
    static char blocks[TERMS][SIDE * SIDE], faces[TERMS][6 * FACE * FACE],
        file[HEAD + 6 * FACE * FACE + 1];
    for (int k = 0; k < TERMS; k++) {
        assert_int_equal(read_file(file, sizeof file, "eigenimage", k), HEAD + SIDE * SIDE);
        memcpy(blocks[k], file + HEAD, SIDE * SIDE);
        assert_int_equal(read_file(file, sizeof file, "weight", k), HEAD + 6 * FACE * FACE);
        memcpy(faces[k], file + HEAD, 6 * FACE * FACE);
    }
    GLuint texture[2];
    gl.GenTextures(2, texture);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    texture_use(&gl, 0, GL_TEXTURE_2D_ARRAY, texture[0]);
    ((compressed *)context_osmesa.get_proc("glCompressedTexImage3D"))(
        GL_TEXTURE_2D_ARRAY, 0, BPTC, SIDE, SIDE, TERMS, 0, sizeof blocks, blocks);
    texture_settings(&gl, GL_TEXTURE_2D_ARRAY);
    texture_use(&gl, 1, CUBES, texture[1]);
    gl.TexImage3D(CUBES, 0, GL_R8, FACE, FACE, 6 * TERMS, 0, GL_RED, GL_UNSIGNED_BYTE, faces);
    texture_settings(&gl, CUBES);
    assert_int_equal(gl_check(&gl, "uploading", NULL), RELUME_OK);
}

static void set_ranges(GLuint program)
{
    static char json[8000];
    char name[40];
    (void)read_file(json, sizeof json, "eigenimages.json", -1);
    const char *at = json;
    for (int k = 0; k < TERMS; k++) {
        float low[3], high[3], w[2];
        at = strstr(at, "\"min\"");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "\"min\": [%f, %f, %f], \"max\": [%f, %f, %f]", low, low + 1,
                                low + 2, high, high + 1, high + 2),
                         6);
        at = strstr(at, "\"weight_min\"");
        assert_int_equal(sscanf(at, "\"weight_min\": %f, \"weight_max\": %f", w, w + 1), 2);
        snprintf(name, sizeof name, "least[%d]", k);
        gl.Uniform3f(gl.GetUniformLocation(program, name), low[0], low[1], low[2]);
        snprintf(name, sizeof name, "most[%d]", k);
        gl.Uniform3f(gl.GetUniformLocation(program, name), high[0], high[1], high[2]);
        snprintf(name, sizeof name, "weight_range[%d]", k);
        gl.Uniform2f(gl.GetUniformLocation(program, name), w[0], w[1]);
    }
    gl.Uniform1i(gl.GetUniformLocation(program, "eigenimages"), 0);
    gl.Uniform1i(gl.GetUniformLocation(program, "weights"), 1);
}

static double difference(const struct relume_image *a, const struct relume_image *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
        sum += fabs((double)a->data[i] - (double)b->data[i]) / (3 * SIDE * SIDE);
    return sum;
}

// A texel of each face, off its middle, so that a face that is turned or mirrored is another light.
static void the_shader_relights(void **state)
{
    (void)state;
    const double s = 2.0 * 24.5 / FACE - 1.0, t = 2.0 * 4.5 / FACE - 1.0;
    const struct relume_vec3 faces[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                         {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    relume_pack *pack;
    const struct relume_codes *codes;
    struct target target;
    struct relume_image want[6] = {{0}}, got;
    const GLuint program = link_program();
    GLuint vertices;
    CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
    CHECK_OK(relume_pack_codes(&codes, pack, 0));
    for (int i = 0; i < 6; i++)
        CHECK_OK(relume_relight(
            &want[i], codes,
            &(const struct relume_light){.direction = faces[i], .rgb = {1.0f, 1.0f, 1.0f}}, 1,
            NULL));
    CHECK_OK(target_create(&target, &gl, SIDE, SIDE, NULL));
    gl.GenVertexArrays(1, &vertices);
    gl.BindVertexArray(vertices);
    upload();
    gl.UseProgram(program);
    set_ranges(program);
    for (int i = 0; i < 6; i++) {
        target_begin(&target, &gl);
        gl.UseProgram(program);
        gl.Uniform3f(gl.GetUniformLocation(program, "lamp"), (float)faces[i].x, (float)faces[i].y,
                     (float)faces[i].z);
        gl.DrawArrays(GL_TRIANGLES, 0, 3);
        CHECK_OK(target_read(&got, &target, &gl));
        // eight bits of pictures and of weights, in logarithms of which one is 4 of light
        print_message("  face %d: %.4f apart, of the next face %.4f\n", i,
                      difference(&got, &want[i]), difference(&got, &want[(i + 1) % 6]));
        assert_true(difference(&got, &want[i]) < 0.008);
        assert_true(difference(&got, &want[(i + 1) % 6]) > 0.04);
        relume_image_destroy(&got);
    }
    assert_int_equal(gl_check(&gl, "relighting", NULL), RELUME_OK);
    for (int i = 0; i < 6; i++)
        relume_image_destroy(&want[i]);
    target_destroy(&target, &gl);
    relume_pack_destroy(&pack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_shader_relights)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
