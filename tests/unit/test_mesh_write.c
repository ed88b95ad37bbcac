// Meshes written and read again, in every format; what no file can hold is refused.
#include <relume/shape/mesh.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char *name(const char *ending)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/relume-meshes-%ld%s", (long)getpid(), ending);
    return path;
}

// A tetrahedron with all there is; vertices differ, so that welding changes nothing.
static float position[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1.25f, 0}, {0, 0, -2}};
static float normal[4][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
static float texture[4][2] = {{0, 0}, {1, 0}, {0.25f, 0.75f}, {0.5f, 1}};
static uint8_t colour[4][4] = {
    {0, 51, 255, 255}, {17, 0, 0, 255}, {255, 255, 255, 255}, {1, 2, 3, 255}};
static uint32_t triangle[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
static uint32_t part[4] = {0, 0, 1, 1};
static char *part_name[2] = {(char[]){"brass"}, (char[]){"wood"}};

static struct relume_mesh whole(void)
{
    return (struct relume_mesh){.vertex_count = 4,
                                .triangle_count = 4,
                                .position = position,
                                .normal = normal,
                                .texture = texture,
                                .colour = colour,
                                .triangle = triangle};
}

static void write_and_read(struct relume_mesh *out, const struct relume_mesh *mesh,
                           const char *ending)
{
    const char *path = name(ending);
    assert_int_equal(relume_mesh_write(mesh, path, NULL), RELUME_OK);
    assert_int_equal(relume_mesh_read(out, path, NULL), RELUME_OK);
    unlink(path);
}

// Corner by corner: readers may number vertices anew.
static void expect_same(const struct relume_mesh *got, const struct relume_mesh *want)
{
    assert_int_equal(got->triangle_count, want->triangle_count);
    assert_int_equal(got->vertex_count, want->vertex_count);
    for (size_t i = 0; i < 3 * want->triangle_count; i++) {
        const uint32_t a = got->triangle[i / 3][i % 3], b = want->triangle[i / 3][i % 3];
        assert_memory_equal(got->position[a], want->position[b], sizeof *want->position);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(got->normal[a][c] - want->normal[b][c]) < 1e-6f);
        if (want->texture)
            assert_memory_equal(got->texture[a], want->texture[b], sizeof *want->texture);
        if (want->colour && got->colour)
            assert_memory_equal(got->colour[a], want->colour[b], sizeof *want->colour);
    }
}

static void test_ply_and_obj_keep_all(void **state)
{
    (void)state;
    struct relume_mesh mesh = whole(), got;
    for (int i = 0; i < 2; i++) {
        write_and_read(&got, &mesh, i ? ".obj" : ".ply");
        assert_non_null(got.colour);
        expect_same(&got, &mesh);
        relume_mesh_free(&got);
    }
}

static void test_parts_are_materials_of_obj(void **state)
{
    (void)state;
    struct relume_mesh mesh = whole(), got;
    mesh.part = part;
    mesh.part_name = part_name;
    mesh.parts = 2;
    write_and_read(&got, &mesh, ".obj");
    assert_int_equal(got.parts, 2);
    assert_string_equal(got.part_name[1], "wood");
    for (int i = 0; i < 4; i++)
        assert_int_equal(got.part[i], part[i]);
    relume_mesh_free(&got);
}

// Assimp reads it, as other programs do; it keeps no colours here.
static void test_glb_is_read_by_assimp(void **state)
{
    (void)state;
    struct relume_mesh mesh = whole(), got;
    write_and_read(&got, &mesh, ".glb");
    expect_same(&got, &mesh);
    relume_mesh_free(&got);
}

// The header and the chunks say what they hold, and the colours are linear.
static void test_glb_is_whole(void **state)
{
    (void)state;
    struct relume_mesh mesh = whole();
    uint8_t bytes[4096];
    uint32_t word[5], body[2];
    assert_int_equal(relume_mesh_write(&mesh, name(".glb"), NULL), RELUME_OK);
    FILE *file = fopen(name(".glb"), "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    unlink(name(".glb"));
    memcpy(word, bytes, sizeof word);
    assert_memory_equal(bytes, "glTF", 4);
    assert_int_equal(word[1], 2);
    assert_int_equal(word[2], size);
    assert_memory_equal(&word[4], "JSON", 4);
    memcpy(body, bytes + 20 + word[3], sizeof body);
    assert_memory_equal(&body[1], "BIN\0", 4);
    assert_int_equal(20 + word[3] + 8 + body[0], size);
    // the colours end the file: 51 / 255 is 0.2, in linear light 0.0331 (IEC 61966-2-1)
    uint16_t linear[4];
    memcpy(linear, bytes + size - 4 * sizeof linear, sizeof linear);
    assert_int_equal(linear[0], 0);
    assert_true(fabs(linear[1] / 65535.0 - 0.033105) < 1e-5);
    assert_int_equal(linear[2], 65535);
    assert_int_equal(linear[3], 65535);
}

static void test_empty_meshes_are_written(void **state)
{
    (void)state;
    const struct relume_mesh none = {0};
    const char *const endings[] = {".ply", ".obj", ".glb"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(relume_mesh_write(&none, name(endings[i]), NULL), RELUME_OK);
        assert_int_equal(access(name(endings[i]), R_OK), 0);
        unlink(name(endings[i]));
    }
}

static void test_what_no_file_holds(void **state)
{
    (void)state;
    struct relume_mesh mesh = whole();
    assert_int_equal(relume_mesh_write(&mesh, name(".stl"), NULL), RELUME_EINVAL);
    assert_int_equal(relume_mesh_check(name(""), NULL), RELUME_EINVAL);
    assert_int_equal(relume_mesh_check("/nowhere/x.ply", NULL), RELUME_EIO);
    triangle[2][1] = 4;
    assert_int_equal(relume_mesh_write(&mesh, name(".ply"), NULL), RELUME_EINVAL);
    assert_int_not_equal(access(name(".ply"), F_OK), 0);
    triangle[2][1] = 2;
}

// Of an OBJ every corner is a vertex of its own until those that are alike are one.
static void test_alike_vertices_are_one(void **state)
{
    (void)state;
    struct relume_mesh got;
    FILE *file = fopen(name(".obj"), "w");
    fputs("v 0 0 0\nv 1 0 0 \nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n", file);
    fclose(file);
    assert_int_equal(relume_mesh_read(&got, name(".obj"), NULL), RELUME_OK);
    unlink(name(".obj"));
    assert_int_equal(got.vertex_count, 4);
    assert_int_equal(got.triangle[1][0], got.triangle[0][0]);
    assert_int_equal(got.triangle[1][1], got.triangle[0][2]);
    assert_null(got.colour);
    assert_null(got.texture);
    relume_mesh_free(&got);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ply_and_obj_keep_all),
        cmocka_unit_test(test_parts_are_materials_of_obj),
        cmocka_unit_test(test_glb_is_read_by_assimp),
        cmocka_unit_test(test_glb_is_whole),
        cmocka_unit_test(test_empty_meshes_are_written),
        cmocka_unit_test(test_what_no_file_holds),
        cmocka_unit_test(test_alike_vertices_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
