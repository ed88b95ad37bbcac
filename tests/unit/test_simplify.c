// test_simplify.c - fewer triangles: known surfaces, what must stay, replayed steps
#include "test.h"

#include "shape/mesh/simplify.h"

struct surface {
    int across, down;  // squares
    bool around;       // the last column is the first one's place
    bool closed;       // the last row is the first one's place
    bool textured;
    vec3 (*place)(double s, double t);
    vec3 (*normal)(double s, double t);
};

// A grid of (across + 1) x (down + 1) vertices.
static struct relume_mesh make(const struct surface *f)
{
    const int w = f->across + 1, h = f->down + 1;
    struct relume_mesh m = {.vertex_count = (size_t)(w * h),
                            .triangle_count = (size_t)(2 * f->across * f->down)};
    m.position = malloc(m.vertex_count * sizeof *m.position);
    m.normal = malloc(m.vertex_count * sizeof *m.normal);
    m.texture = f->textured ? malloc(m.vertex_count * sizeof *m.texture) : NULL;
    m.triangle = malloc(m.triangle_count * sizeof *m.triangle);
    for (int i = 0; i < w * h; i++) {
        const double s = (double)(i % w) / f->across, t = (double)(i / w) / f->down;
        const double at = f->around && i % w == f->across ? 0.0 : s;
        const double down = f->closed && i / w == f->down ? 0.0 : t;
        const vec3 p = f->place(at, down), n = f->normal(at, down);
        memcpy(m.position[i], (float[]){(float)p.x, (float)p.y, (float)p.z}, 12);
        memcpy(m.normal[i], (float[]){(float)n.x, (float)n.y, (float)n.z}, 12);
        if (m.texture)
            memcpy(m.texture[i], (float[]){(float)s, (float)t}, 8);
    }
    for (int i = 0; i < f->across * f->down; i++) {
        const uint32_t a = (uint32_t)(i / f->across * w + i % f->across), b = a + (uint32_t)w;
        memcpy(m.triangle[2 * i], (uint32_t[]){a, a + 1, b}, 12);
        memcpy(m.triangle[2 * i + 1], (uint32_t[]){a + 1, b + 1, b}, 12);
    }
    return m;
}

static vec3 sheet(double s, double t)
{
    return vec3_of(s, t, 0);
}
static vec3 up(double s, double t)
{
    (void)s, (void)t;
    return vec3_of(0, 0, 1);
}
static vec3 torus_normal(double s, double t)
{
    const double a = 2 * M_PI * s, b = 2 * M_PI * t;
    return vec3_of(cos(a) * cos(b), sin(a) * cos(b), sin(b));
}
static vec3 torus(double s, double t)
{
    const vec3 n = torus_normal(s, t);
    const double a = 2 * M_PI * s;
    return vec3_along(vec3_of(cos(a), sin(a), 0), n, 0.4);
}
static vec3 tube_normal(double s, double t)
{
    (void)t;
    return vec3_of(cos(2 * M_PI * s), sin(2 * M_PI * s), 0);
}
static vec3 tube(double s, double t)
{
    const vec3 n = tube_normal(s, t);
    return vec3_of(n.x, n.y, 3 * t);
}

// A sheet whose rim is a comb.
static vec3 comb(double s, double t)
{
    return vec3_of(s, t + (1 - t) * 0.3 * fabs(sin(5 * M_PI * s)), 0);
}

static const struct surface comb_of = {30, 30, false, false, false, comb, up};
static const struct surface plane_of = {20, 20, false, false, false, sheet, up};
static const struct surface torus_of = {48, 32, true, true, false, torus, torus_normal};
static const struct surface tube_of = {40, 30, true, false, true, tube, tube_normal};

static vec3 at(const struct relume_mesh *m, uint32_t v)
{
    return vec3_of((double)m->position[v][0], (double)m->position[v][1], (double)m->position[v][2]);
}

static double to_segment(vec3 p, vec3 a, vec3 b)
{
    const vec3 ab = vec3_sub(b, a);
    const double t = vec3_dot(vec3_sub(p, a), ab) / vec3_dot(ab, ab);
    return vec3_length(vec3_sub(p, vec3_along(a, ab, fmin(fmax(t, 0.0), 1.0))));
}

// Slowly, by the plane where the foot is inside, else the edges.
static double to_triangle(const struct relume_mesh *m, const uint32_t t[3], vec3 p)
{
    const vec3 a = at(m, t[0]), b = at(m, t[1]), c = at(m, t[2]);
    const vec3 n = vec3_unit(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
    if (vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(p, a)), n) >= 0 &&
        vec3_dot(vec3_cross(vec3_sub(c, b), vec3_sub(p, b)), n) >= 0 &&
        vec3_dot(vec3_cross(vec3_sub(a, c), vec3_sub(p, c)), n) >= 0)
        return fabs(vec3_dot(vec3_sub(p, a), n));
    return fmin(to_segment(p, a, b), fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

static double distance_of(const struct relume_mesh *from, const struct relume_mesh *to)
{
    double worst = 0.0;
    for (uint32_t v = 0; v < from->vertex_count; v++) {
        double best = INFINITY;
        for (size_t t = 0; t < to->triangle_count; t++)
            best = fmin(best, to_triangle(to, to->triangle[t], at(from, v)));
        worst = fmax(worst, best);
    }
    return worst;
}

static double diagonal_of(const struct relume_mesh *m)
{
    vec3 low = at(m, 0), high = low;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const vec3 p = at(m, v);
        low = vec3_of(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_of(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    return vec3_length(vec3_sub(high, low));
}

// Every edge of a closed surface has an opposite, the other way round; points of seams are one.
static bool is_closed(const struct relume_mesh *m)
{
    for (size_t t = 0; t < m->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const vec3 a = at(m, m->triangle[t][k]), b = at(m, m->triangle[t][(k + 1) % 3]);
            int opposites = 0;
            for (size_t u = 0; u < m->triangle_count; u++)
                for (int j = 0; j < 3; j++)
                    opposites += !vec3_length(vec3_sub(at(m, m->triangle[u][j]), b)) &&
                                 !vec3_length(vec3_sub(at(m, m->triangle[u][(j + 1) % 3]), a));
            if (opposites != 1)
                return false;
        }
    return true;
}

static void test_plane(void **state)
{
    (void)state;
    struct relume_mesh m = make(&plane_of), small;
    struct relume_simplified r;
    CHECK_OK(relume_mesh_simplify(&small, &r, &m, relume_simplify_params(.error = 1e-5)));
    assert_int_equal(small.triangle_count, 2);
    assert_int_equal(small.vertex_count, 4);
    assert_int_equal(r.steps, m.vertex_count - 4);
    CHECK_NEAR(r.error, 0.0, 1e-6);
    free(r.step);
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

static void test_torus(void **state)
{
    (void)state;
    struct relume_mesh m = make(&torus_of), small;
    struct relume_simplified r;
    const double diagonal = diagonal_of(&m);
    CHECK_OK(
        relume_mesh_simplify(&small, &r, &m, relume_simplify_params(.error = 0.005, .jnd = 4)));
    assert_true(small.triangle_count < m.triangle_count / 3);
    // the wraps in t have vertices of their own, at the same places
    assert_true(is_closed(&small));
    const double d = distance_of(&m, &small) / diagonal;
    assert_true(d <= 0.005 + 1e-6);
    assert_true(r.error <= 0.005 + 1e-6 && d <= r.error + 1e-6);
    assert_true(r.distance <= 0.005 * 1719.0);
    CHECK_NEAR(distance_of(&small, &m), 0.0, 1e-6);  // vertices are the original's
    free(r.step);
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// Triangles across the gaps of a comb would have all vertices of the original near them, or on
// them, and would not be near it themselves.
static void test_both_ways(void **state)
{
    (void)state;
    const double error = 0.02;
    struct relume_mesh m = make(&comb_of), small;
    const double diagonal = diagonal_of(&m);
    CHECK_OK(
        relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = error, .jnd = 100)));
    assert_true(small.triangle_count < m.triangle_count / 2);
    double worst = 0.0;
    for (size_t t = 0; t < small.triangle_count; t++) {
        const vec3 p[3] = {at(&small, small.triangle[t][0]), at(&small, small.triangle[t][1]),
                           at(&small, small.triangle[t][2])};
        for (int k = 0; k < 4; k++) {
            const vec3 sum = vec3_add(vec3_add(p[0], p[1]), p[2]);
            const vec3 q = k == 3 ? vec3_scale(sum, 1.0 / 3.0)
                                  : vec3_scale(vec3_add(p[k], p[(k + 1) % 3]), 0.5);
            double best = INFINITY;
            for (size_t u = 0; u < m.triangle_count; u++)
                best = fmin(best, to_triangle(&m, m.triangle[u], q));
            worst = fmax(worst, best);
        }
    }
    assert_true(worst <= error * diagonal * (1.0 + 1e-6));
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// Errors that are allowed shrink the mesh, and so do differences that may be seen.
static void test_what_counts(void **state)
{
    (void)state;
    static const struct relume_simplify_params tries[] = {
        {.error = 0.002, .jnd = 2},
        {.error = 0.01, .jnd = 2},
        {.error = 0.01, .jnd = 8},
    };
    struct relume_mesh m = make(&torus_of), small;
    size_t last = m.triangle_count;
    for (int i = 0; i < 3; i++) {
        CHECK_OK(relume_mesh_simplify(&small, NULL, &m, &tries[i]));
        assert_true(small.triangle_count < last);
        last = small.triangle_count;
        relume_mesh_free(&small);
    }
    relume_mesh_free(&m);
}

static void test_visible(void **state)
{
    (void)state;
    struct visible matte, glossy;
    CHECK_OK(visible_create(&matte, 1.0, 0.0, 200.0));
    CHECK_OK(visible_create(&glossy, 1.0, 60.0, 200.0));
    CHECK_NEAR(visible_finest(&matte, 0.0, 0.0), 0.0, 0.0);
    double last = 0.0;
    bool glossier = false;
    for (double a = 0.0; a < 1.0; a += 0.01) {
        const double f = visible_finest(&matte, a, 0.2);
        assert_true(f >= last);  // larger differences are seen in finer patterns
        assert_true(visible_finest(&matte, a, 0.5) <= f);  // and less in rough surroundings
        glossier |= visible_finest(&glossy, a, 0.2) > f;
        last = f;
    }
    assert_true(glossier && last > 10.0 && last < 60.0);
}

// The mean angle between normals of the original and those shown where it lies, degrees.
static double turned(const struct relume_mesh *m, const struct relume_mesh *small)
{
    double sum = 0.0;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        double least = INFINITY, w[3];
        vec3 shown = vec3_of(0, 0, 1);
        for (size_t t = 0; t < small->triangle_count; t++) {
            const uint32_t *c = small->triangle[t];
            const vec3 p[3] = {at(small, c[0]), at(small, c[1]), at(small, c[2])};
            nearest_place(p, at(m, v), w);
            vec3 there = vec3_of(0, 0, 0), n = there;
            for (int k = 0; k < 3; k++) {
                there = vec3_along(there, p[k], w[k]);
                n = vec3_along(n, vec3_floats(small->normal[c[k]]), w[k]);
            }
            const double off = vec3_length(vec3_sub(there, at(m, v)));
            if (off < least) {
                least = off;
                shown = vec3_unit(n);
            }
        }
        sum += vec3_angle(shown, vec3_floats(m->normal[v])) * 180.0 / 3.14159265358979;
    }
    return sum / m->vertex_count;
}

// A sheet whose normals tremble: those of the vertices that are left are means of what has gone.
// With steps they stay those of the original, and show it worse.
static void test_fitted_normals(void **state)
{
    (void)state;
    struct relume_mesh m = make(&plane_of), fitted, kept;
    struct relume_simplified r;
    uint32_t seed = 1;
    for (uint32_t v = 0; v < m.vertex_count; v++) {
        float *n = m.normal[v];
        for (int k = 0; k < 2; k++) {
            seed = seed * 1664525u + 1013904223u;
            n[k] = 0.2f * ((float)(seed >> 8) / 16777216.0f - 0.5f);
        }
        vec3_store(n, vec3_unit(vec3_floats(n)));
    }
    const struct relume_simplify_params p = {.error = 0.01, .jnd = 100};
    CHECK_OK(relume_mesh_simplify(&fitted, NULL, &m, &p));
    CHECK_OK(relume_mesh_simplify(&kept, &r, &m, &p));
    assert_true(fitted.triangle_count < m.triangle_count / 10);
    for (uint32_t v = 0; v < fitted.vertex_count; v++)
        CHECK_NEAR(vec3_length(vec3_floats(fitted.normal[v])), 1.0, 1e-6);
    assert_true(turned(&m, &fitted) < 0.9 * turned(&m, &kept));
    for (uint32_t v = 0; v < kept.vertex_count; v++) {
        uint32_t same = 0;
        while (same < m.vertex_count && memcmp(m.normal[same], kept.normal[v], sizeof *m.normal))
            same++;
        assert_true(same < m.vertex_count);
    }
    free(r.step);
    relume_mesh_free(&fitted);
    relume_mesh_free(&kept);
    relume_mesh_free(&m);
}

// A step sends a vertex onto another; where the last ones lead are the triangles that are left.
static void test_steps(void **state)
{
    (void)state;
    struct relume_mesh m = make(&torus_of), small;
    struct relume_simplified r;
    CHECK_OK(relume_mesh_simplify(&small, &r, &m, relume_simplify_params(.error = 0.01)));
    uint32_t *onto = malloc(m.vertex_count * sizeof *onto);
    for (uint32_t v = 0; v < m.vertex_count; v++)
        onto[v] = v;
    float error = 0.0f;
    for (size_t i = 0; i < r.steps; i++) {
        assert_int_equal(onto[r.step[i].vertex], r.step[i].vertex);
        onto[r.step[i].vertex] = r.step[i].onto;
        assert_true(r.step[i].error >= error);
        error = r.step[i].error;
    }
    size_t n = 0;
    for (size_t t = 0; t < m.triangle_count; t++) {
        vec3 p[3];
        for (int k = 0; k < 3; k++) {
            uint32_t v = m.triangle[t][k];
            while (onto[v] != v)
                v = onto[v];
            p[k] = at(&m, v);
        }
        if (vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]))) == 0.0)
            continue;
        assert_true(n < small.triangle_count);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(vec3_length(vec3_sub(p[k], at(&small, small.triangle[n][k]))), 0.0, 0.0);
        n++;
    }
    assert_int_equal(n, small.triangle_count);
    free(onto);
    free(r.step);
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// A tube's texture has a seam: vertices stay vertices of the original, and the texture slides by
// no more than the surface may.
static void test_texture(void **state)
{
    (void)state;
    struct relume_mesh m = make(&tube_of), small;
    CHECK_OK(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 0.01)));
    assert_true(small.triangle_count < m.triangle_count / 2);
    for (uint32_t v = 0; v < small.vertex_count; v++) {
        const vec3 p = tube((double)small.texture[v][0], (double)small.texture[v][1]);
        CHECK_NEAR(vec3_length(vec3_sub(p, at(&small, v))), 0.0, 1e-5);
    }
    for (size_t t = 0; t < small.triangle_count; t++) {  // none leaps over the seam
        double low = 1.0, high = 0.0;
        for (int k = 0; k < 3; k++) {
            low = fmin(low, (double)small.texture[small.triangle[t][k]][0]);
            high = fmax(high, (double)small.texture[small.triangle[t][k]][0]);
        }
        assert_true(high - low < 0.5);
    }
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// The line between two parts of a plane stays where it is, and so does the rim.
static void test_parts(void **state)
{
    (void)state;
    struct relume_mesh m = make(&plane_of), small;
    double area[2] = {0, 0};
    m.part = malloc(m.triangle_count * sizeof *m.part);
    for (size_t t = 0; t < m.triangle_count; t++)
        m.part[t] = t / 2 % 20 >= 7;
    CHECK_OK(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 1e-5)));
    assert_int_equal(small.triangle_count, 4);
    for (size_t t = 0; t < 4; t++) {
        const vec3 a = at(&small, small.triangle[t][0]);
        area[small.part[t]] += 0.5 * vec3_cross(vec3_sub(at(&small, small.triangle[t][1]), a),
                                                vec3_sub(at(&small, small.triangle[t][2]), a))
                                         .z;
    }
    CHECK_NEAR(area[0], 0.35, 1e-5);
    CHECK_NEAR(area[1], 0.65, 1e-5);
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// Triangles that face inwards by more than a right angle.
static int turned_over(const struct relume_mesh *m)
{
    int n = 0;
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *v = m->triangle[t];
        const float *g = m->normal[v[0]];
        const vec3 a = at(m, v[0]);
        const vec3 across = vec3_cross(vec3_sub(at(m, v[1]), a), vec3_sub(at(m, v[2]), a));
        n += vec3_dot(across, vec3_of((double)g[0], (double)g[1], (double)g[2])) < 0.0;
    }
    return n;
}

static void test_count(void **state)
{
    (void)state;
    struct relume_mesh m = make(&torus_of), small;
    static const size_t want[] = {2000, 500, 60};
    for (int i = 0; i < 3; i++) {
        CHECK_OK(
            relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.triangles = want[i])));
        assert_true(small.triangle_count <= want[i] && small.triangle_count + 2 >= want[i]);
        assert_true(is_closed(&small));
        relume_mesh_free(&small);
    }
    CHECK_OK(relume_mesh_simplify(&small, NULL, &m,
                                  relume_simplify_params(.triangles = 300, .quadrics = true)));
    assert_int_equal(turned_over(&m) + turned_over(&small), 0);
    relume_mesh_free(&small);
    relume_mesh_free(&m);
}

// Vertices of the original, some of them, to the new surface; in diagonals.
static double some_distance(const struct relume_mesh *from, const struct relume_mesh *to, int step)
{
    double worst = 0.0;
    for (uint32_t v = 0; v < from->vertex_count; v += (uint32_t)step) {
        double best = INFINITY;
        for (size_t t = 0; t < to->triangle_count; t++)
            best = fmin(best, to_triangle(to, to->triangle[t], at(from, v)));
        worst = fmax(worst, best);
    }
    return worst / diagonal_of(from);
}

// Memory for an eighth: as many triangles but a few, closed, within the same error, and steps that
// lead there.
static void test_in_parts(void **state)
{
    (void)state;
    struct surface big = torus_of;
    big.across = 144, big.down = 96;
    struct relume_mesh m = make(&big), whole, small;
    struct relume_simplified r;
    struct relume_simplify_params p = *relume_simplify_params(.error = 0.004, .jnd = 50);
    CHECK_OK(relume_mesh_simplify(&whole, NULL, &m, &p));
    p.memory = 1500000;
    CHECK_OK(relume_mesh_simplify(&small, &r, &m, &p));
    assert_true(small.triangle_count != whole.triangle_count);
    assert_true((double)small.triangle_count < 1.1 * (double)whole.triangle_count);
    assert_true(is_closed(&small) && r.error <= 0.004 && r.steps > 0);
    assert_true(some_distance(&m, &small, 29) <= r.error + 1e-6);
    assert_int_equal(turned_over(&small), 0);
    for (size_t i = 1; i < r.steps; i++)
        assert_true(r.step[i].error >= r.step[i - 1].error);
    free(r.step);
    relume_mesh_free(&small);
    p = *relume_simplify_params(.triangles = 700, .memory = 1500000, .no_steps = true);
    CHECK_OK(relume_mesh_simplify(&small, &r, &m, &p));
    assert_true(small.triangle_count <= 700 && small.triangle_count >= 690 && is_closed(&small));
    assert_null(r.step);
    relume_mesh_free(&small);
    p.memory = 10000;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, &p), RELUME_ELIMIT);
    relume_mesh_free(&whole);
    relume_mesh_free(&m);
}

// Three leaves at one edge, a triangle of two points, one without a length.
static void test_broken(void **state)
{
    (void)state;
    float position[][3] = {{0, 0, 0},     {0, 0, 1},      {1, 0, 0.5f},
                           {-1, 1, 0.5f}, {-1, -1, 0.5f}, {0, 0, 0}};
    float normal[6][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    uint32_t triangle[][3] = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 5, 1}, {2, 2, 2}};
    struct relume_mesh m = {.vertex_count = 6,
                            .triangle_count = 5,
                            .position = position,
                            .normal = normal,
                            .triangle = triangle},
                       small;
    CHECK_OK(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.triangles = 1)));
    assert_int_equal(small.triangle_count, 3);
    relume_mesh_free(&small);
    m.triangle_count = 0;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 0.1)),
                     RELUME_EINVAL);
    m.triangle_count = 1;
    triangle[0][2] = 6;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 0.1)),
                     RELUME_EINVAL);
    triangle[0][2] = 5;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 0.1)),
                     RELUME_EUNFIT);
    triangle[0][2] = 2;
    position[3][1] = NAN;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = 0.1)),
                     RELUME_EINVAL);
    position[3][1] = 1;
    assert_int_equal(relume_mesh_simplify(&small, NULL, &m, relume_simplify_params(.error = -1)),
                     RELUME_EINVAL);
    assert_null(small.position);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),          cmocka_unit_test(test_torus),
        cmocka_unit_test(test_what_counts),    cmocka_unit_test(test_visible),
        cmocka_unit_test(test_fitted_normals), cmocka_unit_test(test_steps),
        cmocka_unit_test(test_texture),        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_count),          cmocka_unit_test(test_broken),
        cmocka_unit_test(test_both_ways),      cmocka_unit_test(test_in_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
