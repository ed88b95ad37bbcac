// Meshes: the readers on good and broken files, the solids, the teapot.
#include "shape/mesh/mesh_read.h"
#include "world/stage/shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void check_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("found %.9g; expected %.9g within %g", got, want, tolerance);
}

static int sentences;

static void count_sentence(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    assert_true(strlen(text) > 0 && !strchr(text, '\n'));
    sentences++;
}

static const struct relume_log counting = {.message = count_sentence};

// Through a file of that extension, as users do.
static relume_status read_bytes(struct mesh_file *out, const char *extension, const void *bytes,
                                size_t size)
{
    char path[64];
    snprintf(path, sizeof path, "/tmp/relume-mesh-%ld%s", (long)getpid(), extension);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    sentences = 0;
    const relume_status status = mesh_read(out, path, &counting);
    unlink(path);
    assert_int_equal(sentences, relume_status_is_input(status) ? 1 : 0);
    return status;
}

static relume_status read_text(struct mesh_file *out, const char *extension, const char *text)
{
    return read_bytes(out, extension, text, strlen(text));
}

static double volume(const struct mesh *m)
{
    double six = 0.0;
    for (size_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *v = m->triangles[i].vertex;
        const vec3 a = vertex_position(&m->vertices[v[0]]), b = vertex_position(&m->vertices[v[1]]);
        six += vec3_dot(a, vec3_cross(b, vertex_position(&m->vertices[v[2]])));
    }
    return six / 6.0;
}

static double least_agreement(const struct mesh *m)
{
    double least = 1.0;
    for (size_t i = 0; i < m->triangle_count; i++) {
        vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vertex_position(&m->vertices[m->triangles[i].vertex[k]]);
        const vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        for (int k = 0; k < 3 && vec3_length(n) > 1e-9; k++)
            least = fmin(least, vec3_dot(vec3_unit(n),
                                         vertex_normal(&m->vertices[m->triangles[i].vertex[k]])));
    }
    return least;
}

static const char cube[] = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                           "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf -8 -4 -1 -5\nf 2 3 7 6\n";

static void obj_polygons_and_negative_indices(void **state)
{
    (void)state;
    struct mesh_file f;
    assert_int_equal(read_text(&f, ".obj", cube), RELUME_OK);
    assert_int_equal(f.mesh.triangle_count, 12);
    check_near(volume(&f.mesh), 8.0, 1e-6);
    // Smooth normals of a cube point along its diagonals.
    check_near(f.mesh.vertices[0].normal[0], -1.0 / sqrt(3.0), 1e-6);
    assert_false(f.has_uv);
    mesh_file_free(&f);
}

static void obj_corners_comments_and_continuations(void **state)
{
    (void)state;
    struct mesh_file f;
    assert_int_equal(read_text(&f, ".obj",
                               "# a comment\r\nmtllib none.mtl\r\no thing\r\nv 0 0 0 1 0 0\r\n"
                               "v 1 0 0\r\nv 0 1 0\r\nvt 0.25 0.5\r\nvt 1 0\r\nvt 0 1\r\n"
                               "vn 0 0 2\r\ns off\r\nf 1/1/1 2/2/1 \\\n 3/3/1"),
                     RELUME_OK);
    assert_int_equal(f.mesh.triangle_count, 1);
    assert_true(f.has_uv);
    check_near(f.mesh.vertices[0].texture[0], 0.25, 0.0);
    check_near(f.mesh.vertices[0].normal[2], 1.0, 0.0);
    mesh_file_free(&f);
}

static void broken_obj_files_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "hello\n",
        "v 0 0 0\n",
        "v 0 0\nf 1 1 1\n",
        "v 0 0 nan\n",
        "v inf 0 0\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3x\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n",
        "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n",
        "vt nan 0\n",
        "v 0 0 0\nf\n",
    };
    struct mesh_file f;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_true(relume_status_is_input(read_text(&f, ".obj", texts[i])));
        assert_null(f.mesh.vertices);
    }
    assert_true(relume_status_is_input(read_bytes(&f, ".obj", "v 0 0 0\n\0\n", 10)));
    assert_true(relume_status_is_input(read_text(&f, ".stl", "solid")));
    assert_true(relume_status_is_input(mesh_read(&f, "/nowhere/model.obj", NULL)));
    assert_true(relume_status_is_input(mesh_read(&f, "/tmp", NULL)));
}

static const char ply_header[] = "ply\nformat %s 1.0\ncomment of no use\nelement vertex 4\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property uchar red\nelement face 1\n"
                                 "property list uchar int vertex_indices\nend_header\n";
static const float square[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};

static void put(unsigned char **at, const void *bytes, size_t size, bool big)
{
    for (size_t i = 0; i < size; i++)
        *(*at)++ = ((const unsigned char *)bytes)[big ? size - 1 - i : i];
}

static size_t binary_ply(unsigned char *out, size_t capacity, bool big)
{
    int used = snprintf((char *)out, capacity, ply_header,
                        big ? "binary_big_endian" : "binary_little_endian");
    unsigned char *at = out + used;
    for (int i = 0; i < 4; i++) {
        for (int c = 0; c < 3; c++)
            put(&at, &square[i][c], sizeof(float), big);
        *at++ = 200;
    }
    *at++ = 4;
    for (int32_t i = 0; i < 4; i++)
        put(&at, &i, sizeof i, big);
    return (size_t)(at - out);
}

static void check_square(const struct mesh_file *f)
{
    assert_int_equal(f->mesh.vertex_count, 4);
    assert_int_equal(f->mesh.triangle_count, 2);
    check_near(f->mesh.vertices[2].position[1], 2.0, 0.0);
    check_near(f->mesh.vertices[3].normal[2], 1.0, 1e-6);
}

static void ply_in_three_forms(void **state)
{
    (void)state;
    struct mesh_file f;
    for (int big = 0; big < 2; big++) {
        unsigned char bytes[1024];
        const size_t size = binary_ply(bytes, sizeof bytes, big);
        assert_int_equal(read_bytes(&f, ".ply", bytes, size), RELUME_OK);
        check_square(&f);
        mesh_file_free(&f);
        // Cut anywhere, it is refused.
        for (size_t cut = 0; cut < size; cut += 3)
            assert_true(relume_status_is_input(read_bytes(&f, ".ply", bytes, cut)));
    }
    char text[1024];
    const int used = snprintf(text, sizeof text, ply_header, "ascii");
    snprintf(text + used, sizeof text - (size_t)used,
             "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n4 0 1 2 3\n");
    assert_int_equal(read_text(&f, ".ply", text), RELUME_OK);
    check_square(&f);
    mesh_file_free(&f);
}

static void broken_ply_files_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "plyx\n",
        "ply\n",
        "ply\nend_header\n",
        "ply\nformat weird 1.0\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n",
        "ply\nformat ascii 1.0\nproperty float x\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty blob x\nend_header\n0\n",
        "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n0 1 2\n",
        "ply\nformat ascii 1.0\nelement face 4000000000\nend_header\n",
    };
    static const char *const faces[] = {"3 0 1 4", "3 0 1 -1", "3 0 1 nan", "-1",
                                        "5000",    "3 0 1",    "3 0 1 x",   ""};
    struct mesh_file f;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_true(relume_status_is_input(read_text(&f, ".ply", texts[i])));
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        char text[1024];
        const int used = snprintf(text, sizeof text, ply_header, "ascii");
        snprintf(text + used, sizeof text - (size_t)used,
                 "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n%s\n", faces[i]);
        assert_true(relume_status_is_input(read_text(&f, ".ply", text)));
    }
}

static void solids_face_outwards_and_have_their_volume(void **state)
{
    (void)state;
    static const struct lathe_point cone[] = {{0, 0, true}, {1, 0, true}, {0, 3, true}};
    struct mesh m = {0};
    shape_box(&m, vec3_of(0, 0, 0), vec3_of(1, 2, 3));
    check_near(volume(&m), 6.0, 1e-6);
    mesh_free(&m);
    shape_chamfered(&m, vec3_of(0, 0, 0), vec3_of(1, 1, 1), 0.1);
    // A chamfer takes e^2 / 2 per unit of the 12 edges of length 0.8, and 5/6 e^3 at each corner.
    check_near(volume(&m), 1.0 - 12 * 0.8 * 0.005 - 8 * 5.0 / 6.0 * 0.001, 1e-6);
    assert_true(least_agreement(&m) > 0.999);
    mesh_free(&m);
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, 128);
    check_near(volume(&m), 4.0 / 3.0 * M_PI, 0.005);
    assert_true(least_agreement(&m) > 0.99);
    mesh_free(&m);
    shape_lathe(&m, cone, 3, 4, 256);
    check_near(volume(&m), M_PI, 1e-3);
    assert_true(least_agreement(&m) > 0.999);
    mesh_free(&m);
}

static void the_teapot_is_newells(void **state)
{
    (void)state;
    struct mesh m = {0};
    shape_teapot(&m, 16);
    assert_int_equal(m.triangle_count, 32 * 16 * 16 * 2);
    const struct bounds b = mesh_bounds(&m);
    // Handle to spout, the belly, foot to knob: the extent of every published tessellation.
    check_near(b.min.x, -3.0, 1e-3);
    check_near(b.max.x, 3.434, 2e-3);
    check_near(b.min.y, 0.0, 1e-6);
    check_near(b.max.y, 3.15, 1e-6);
    check_near(b.max.z, 2.0, 1e-3);
    check_near(b.min.z, -b.max.z, 1e-6);
    assert_true(volume(&m) > 15.0 && volume(&m) < 30.0);
    assert_true(least_agreement(&m) > 0.5);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_polygons_and_negative_indices),
        cmocka_unit_test(obj_corners_comments_and_continuations),
        cmocka_unit_test(broken_obj_files_are_refused),
        cmocka_unit_test(ply_in_three_forms),
        cmocka_unit_test(broken_ply_files_are_refused),
        cmocka_unit_test(solids_face_outwards_and_have_their_volume),
        cmocka_unit_test(the_teapot_is_newells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
