// An OpenGL that fails: one line says what, the status is the machine's, and nothing is left behind
#include "fixture.h"
#include "request.h"

static char said[1024];
static int lines;

static void keep_message(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    snprintf(said, sizeof said, "%s", text);
    lines++;
}
static const struct relume_log keep = {.message = keep_message};

static void expect_one_line(const char *pattern)
{
    print_message("  %s\n", said);
    assert_int_equal(lines, 1);
    assert_non_null(strstr(said, pattern));
    assert_null(strchr(said, '\n'));
}

// A driver that compiles nothing.
static void APIENTRY refuse_shader(GLuint shader, GLenum what, GLint *value)
{
    fixture_gl.GetShaderiv(shader, what, value);
    if (what == GL_COMPILE_STATUS)
        *value = 0;
}

static void APIENTRY refuse_words(GLuint shader, GLsizei size, GLsizei *length, char *text)
{
    (void)shader, (void)length;
    snprintf(text, (size_t)size, "0:1(1): error: out of luck\n0:2(1): error: again\n");
}

static void APIENTRY refuse_program(GLuint program, GLenum what, GLint *value)
{
    fixture_gl.GetProgramiv(program, what, value);
    if (what == GL_LINK_STATUS)
        *value = 0;
}

static GLenum APIENTRY refuse_framebuffer(GLenum target)
{
    (void)target;
    return GL_FRAMEBUFFER_UNSUPPORTED;
}

static GLenum APIENTRY no_memory(void)
{
    return GL_OUT_OF_MEMORY;
}

// Before the second frame, which is drawn when there is one.
static void (*meanwhile)(void);

static relume_status draw_with(const struct gl *gl)
{
    struct fixture_file f = fixture_make(1, 8, 8, RELUME_STORE_8, RELUME_DOMAIN_LINEAR, false);
    const struct relume_geometry geometry = {.projection = RELUME_PLANAR};
    const struct code_source source = {.codes = fixture_fetch, .user = &f};
    const struct app_file file = {.geometry = geometry, .width = 8, .height = 8, .views = 1};
    const struct app_state start = {0};
    struct gl_renderer r;
    OWNED_APP app;
    said[0] = '\0';
    lines = 0;
    assert_int_equal(app_start(&app, &file, &start, false, &keep), RELUME_OK);
    relume_status status = gl_renderer_create(&r, gl, &source, &geometry, NULL, 1, &keep);
    if (!status)
        status = draw_app(&r, &app);
    if (!status && meanwhile) {
        meanwhile();
        status = draw_app(&r, &app);
    }
    gl_renderer_destroy(&r);
    fixture_free(&f);
    (void)fixture_gl.GetError();
    return status;
}

static void shaders_that_do_not_compile(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.GetShaderiv = refuse_shader;
    gl.GetShaderInfoLog = refuse_words;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("does not compile; 0:1(1): error: out of luck");
}

static void shaders_that_do_not_link(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.GetProgramiv = refuse_program;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("does not link");
}

static void pictures_that_are_too_large(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.max_texture = 7;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("picture of 8 x 8: OpenGL draws at most 7 x 7 here");
}

static void targets_that_cannot_be_drawn_into(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.CheckFramebufferStatus = refuse_framebuffer;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("cannot draw into a float texture");
}

static void memory_that_is_full(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.GetError = no_memory;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("the graphics memory is full");
}

static GLenum APIENTRY guilty(void)
{
    return GL_GUILTY_CONTEXT_RESET;
}

static GLenum APIENTRY lost(void)
{
    return GL_CONTEXT_LOST;
}

static void cards_that_are_reset(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.reset_status = guilty;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("the graphics card was reset");
    gl = fixture_gl;
    gl.GetError = lost;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    expect_one_line("the graphics card was reset");
}

// A card that goes away after a frame: the next one says so, and all that is left can be put away.
static GLenum later;

static GLenum APIENTRY reset_later(void)
{
    return later;
}

static void reset_now(void)
{
    later = GL_UNKNOWN_CONTEXT_RESET;
}

static void cards_that_are_reset_later(void **state)
{
    (void)state;
    struct gl gl = fixture_gl;
    gl.reset_status = reset_later;
    later = GL_NO_ERROR;
    meanwhile = reset_now;
    assert_int_equal(draw_with(&gl), RELUME_ESYSTEM);
    meanwhile = NULL;
    expect_one_line("drawing: the graphics card was reset");
}

static gl_proc nothing_of(const char *name)
{
    return strcmp(name, "glDrawElements") ? context_osmesa.get_proc(name) : NULL;
}

static void functions_that_are_missing(void **state)
{
    (void)state;
    struct gl gl;
    said[0] = '\0';
    lines = 0;
    assert_int_equal(gl_load(&gl, nothing_of, &keep), RELUME_ESYSTEM);
    expect_one_line("expected version 3.3; glDrawElements is missing");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_that_do_not_compile),
        cmocka_unit_test(shaders_that_do_not_link),
        cmocka_unit_test(pictures_that_are_too_large),
        cmocka_unit_test(targets_that_cannot_be_drawn_into),
        cmocka_unit_test(memory_that_is_full),
        cmocka_unit_test(cards_that_are_reset),
        cmocka_unit_test(cards_that_are_reset_later),
        cmocka_unit_test(functions_that_are_missing),
    };
    return cmocka_run_group_tests(tests, fixture_open, fixture_close);
}
