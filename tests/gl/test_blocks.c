// BC1, BC6H and BC7 as the graphics card decodes them, beside our own decoders
#include "fixture.h"

#include "image/block/block.h"

enum { ACROSS = 16, SIDE = ACROSS * BLOCK_SIDE };
enum { DXT1 = 0x83f0, BPTC = 0x8e8c, BPTC_HALF = 0x8e8f };

typedef void compressed(GLenum, GLint, GLenum, GLsizei, GLsizei, GLint, GLsizei, const void *);
typedef void get_image(GLenum, GLint, GLenum, GLenum, void *);

static uint8_t picture[SIDE * SIDE][3];

// Smooth, rough and even parts.
static void paint(void)
{
    uint64_t random = 8;
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++) {
            const int x = i % SIDE, y = i / SIDE;
            const double smooth = 127.5 + 127.5 * sin(0.07 * x * (c + 1) + 0.05 * y);
            picture[i][c] = (uint8_t)(x < SIDE / 2   ? smooth
                                      : y < SIDE / 2 ? 255.0 * uniform(&random)
                                                     : 40.0 * c + x / 16);
        }
}

// The card may round colours between the ends in another way: by 1.
static void compare(const struct block_format *f, GLenum internal)
{
    static uint8_t coded[ACROSS * ACROSS * BLOCK_MOST_BYTES], ours[SIDE * SIDE][3];
    static uint8_t theirs[SIDE * SIDE][3];
    int most = 0;
    for (int b = 0; b < ACROSS * ACROSS; b++) {
        uint8_t rgb[BLOCK_PIXELS][3];
        for (int step = 0; step < 2; step++) {
            for (int i = 0; i < BLOCK_PIXELS; i++) {
                const int x = b % ACROSS * BLOCK_SIDE + i % BLOCK_SIDE;
                const int y = b / ACROSS * BLOCK_SIDE + i / BLOCK_SIDE;
                memcpy(step ? ours[y * SIDE + x] : rgb[i], step ? rgb[i] : picture[y * SIDE + x],
                       3);
            }
            if (!step) {
                f->encode(coded + (size_t)b * f->bytes, (const uint8_t(*)[3])rgb);
                f->decode(rgb, coded + (size_t)b * f->bytes);
            }
        }
    }
    compressed *upload = (compressed *)context_osmesa.get_proc("glCompressedTexImage2D");
    get_image *download = (get_image *)context_osmesa.get_proc("glGetTexImage");
    const struct gl *gl = &fixture_gl;
    GLuint texture;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    upload(GL_TEXTURE_2D, 0, internal, SIDE, SIDE, 0, (GLsizei)(ACROSS * ACROSS * f->bytes), coded);
    if (gl_check(gl, "uploading blocks", &fixture_log)) {
        print_message("skipped: %s: this driver has no such textures\n", f->name);
        gl->DeleteTextures(1, &texture);
        return;
    }
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    download(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, theirs);
    assert_int_equal(gl_check(gl, "reading blocks", &fixture_log), RELUME_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++) {
            const int d = abs(ours[i][c] - theirs[i][c]);
            most = d > most ? d : most;
        }
    print_message("  %s: %d codes apart at most\n", f->name, most);
    assert_true(most <= 1);
    gl->DeleteTextures(1, &texture);
}

// The same of half floats, which cards decode to the bit.
static void compare_halves(void)
{
    enum { BLOCKS = ACROSS * ACROSS };
    static uint8_t coded[BLOCKS * BLOCK_MOST_BYTES];
    static uint16_t ours[SIDE * SIDE][3], theirs[SIDE * SIDE][3];
    uint64_t random = 5;
    for (int b = 0; b < BLOCKS; b++) {
        uint16_t rgb[BLOCK_PIXELS][3];
        for (int i = 0; i < BLOCK_PIXELS; i++)
            for (int c = 0; c < 3; c++)
                rgb[i][c] = (uint16_t)(b % 3 == 0   ? 0x7bff * uniform(&random)
                                       : b % 3 == 1 ? 0x3c00 + 20 * c + i * b / 4
                                                    : 0x2c00 + 9 * b + (i + c) % 3);
        block_bc6h.encode_halves(coded + 16 * b, (const uint16_t(*)[3])rgb);
        block_bc6h.decode_halves(rgb, coded + 16 * b);
        for (int i = 0; i < BLOCK_PIXELS; i++)
            memcpy(ours[(b / ACROSS * BLOCK_SIDE + i / 4) * SIDE + b % ACROSS * 4 + i % 4], rgb[i],
                   sizeof rgb[i]);
    }
    compressed *upload = (compressed *)context_osmesa.get_proc("glCompressedTexImage2D");
    get_image *download = (get_image *)context_osmesa.get_proc("glGetTexImage");
    GLuint texture;
    fixture_gl.GenTextures(1, &texture);
    fixture_gl.BindTexture(GL_TEXTURE_2D, texture);
    upload(GL_TEXTURE_2D, 0, BPTC_HALF, SIDE, SIDE, 0, sizeof coded, coded);
    if (gl_check(&fixture_gl, "uploading blocks", &fixture_log)) {
        print_message("skipped: bc6h: this driver has no such textures\n");
    } else {
        fixture_gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        download(GL_TEXTURE_2D, 0, GL_RGB, GL_HALF_FLOAT, theirs);
        assert_int_equal(gl_check(&fixture_gl, "reading blocks", &fixture_log), RELUME_OK);
        assert_memory_equal(ours, theirs, sizeof ours);
    }
    fixture_gl.DeleteTextures(1, &texture);
}

static void blocks_are_read_as_we_read_them(void **state)
{
    (void)state;
    paint();
    compare(&block_bc1, DXT1);
    compare(&block_bc7, BPTC);
    compare_halves();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(blocks_are_read_as_we_read_them)};
    return cmocka_run_group_tests(tests, fixture_open, fixture_close);
}
