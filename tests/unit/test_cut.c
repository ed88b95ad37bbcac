// Small pictures drawn from trees of points: form factors in closed form; what the trees hold;
// points that are none.
#include "test.h"
#include "world/transport/cut.h"
#include "world/transport/warp.h"

#include "core/base/memory.h"

#include <string.h>

// ---------------------------------------------------------------- squares

// Pieces of a parallelogram, front towards `u` x `v`.
static struct piece *rectangle(size_t across, size_t down, vec3 corner, vec3 u, vec3 v)
{
    struct piece *pieces = malloc(across * down * sizeof *pieces);
    const vec3 area = vec3_scale(vec3_cross(u, v), 1.0 / (double)(across * down));
    for (size_t i = 0; i < across * down; i++) {
        const double x = ((double)(i % across) + 0.5) / (double)across,
                     y = ((double)(i / across) + 0.5) / (double)down;
        const vec3 at = vec3_along(vec3_along(corner, u, x), v, y);
        pieces[i] = (struct piece){{(float)at.x, (float)at.y, (float)at.z},
                                   {(float)area.x, (float)area.y, (float)area.z}};
    }
    return pieces;
}

static struct hierarchy tree_of(struct piece *pieces, size_t count, size_t leaves)
{
    struct hierarchy h;
    CHECK_OK(hierarchy_create(&h, pieces, count, leaves, 1));
    for (size_t i = 0; i < h.leaves; i++)
        h.sent[hierarchy_leaf(&h, i)] = (struct sent){{1, 1, 1}, {1, 1, 1}};
    hierarchy_light(&h);
    free(pieces);
    return h;
}

// What objects cover of all that a matte surface sees, by cosine.
static double covered(const struct hierarchy *h, int side, vec3 at, vec3 normal)
{
    static struct cut_view view;
    static struct cut_cell cells[CUT_MOST * CUT_MOST];
    struct cut_list list = {0};
    struct cut_place place;
    double sum = 0.0;
    cut_view_create(&view, side);
    cut_place_at(&place, &view, at, normal);
    memset(cells, 0, sizeof cells);
    cut_objects(cells, &list, h, &place);
    for (int i = 0; i < side * side; i++) {
        const struct cut_pixel *p = &view.pixel[i];
        if (p->share > 0.0f)
            sum += (double)(p->share * (cells[i].object_close
                                            ? 1.0f
                                            : fminf(cells[i].covered / p->inside, 1.0f)));
    }
    return sum;
}

// From a place below a corner of a rectangle of sides a and b at distance c, parallel (Howell's
// catalogue, B-4).
static double corner_factor(double a, double b, double c)
{
    const double x = a / c, y = b / c, p = sqrt(1.0 + x * x), q = sqrt(1.0 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2.0 * M_PI);
}

// From (x, y, 0), below the unit square at z = 1.
static double place_factor(double x, double y)
{
    return corner_factor(x, y, 1.0) + corner_factor(1.0 - x, y, 1.0) +
           corner_factor(x, 1.0 - y, 1.0) + corner_factor(1.0 - x, 1.0 - y, 1.0);
}

// Two unit squares face each other at distance 1: the textbook's 0.1998. Solid angles add up
// whatever the size of the picture.
static void squares_have_their_form_factor(void **state)
{
    (void)state;
    enum { SITES = 12 };
    static const int sides[] = {4, 8, 16, 24};
    struct hierarchy h = tree_of(
        rectangle(64, 64, vec3_of(0, 1, 1), vec3_of(1, 0, 0), vec3_of(0, -1, 0)), 64 * 64, 4096);
    for (int k = 0; k < 4; k++) {
        double sum = 0.0, wrong = 0.0;
        for (int i = 0; i < SITES * SITES; i++) {
            const double x = (i % SITES + 0.5) / SITES, y = (i / SITES + 0.5) / SITES;
            const double got = covered(&h, sides[k], vec3_of(x, y, 0), vec3_of(0, 0, 1));
            sum += got / (SITES * SITES);
            wrong += pow(got - place_factor(x, y), 2.0) / (SITES * SITES);
        }
        const double error = sqrt(wrong);
        printf("%d^2: %.5f, places off by %.5f\n", sides[k], sum, error);
        CHECK_NEAR(sum, 0.19982, 0.0005);
        assert_true(error < 0.001);
    }
    hierarchy_forget(&h);
}

// A wall that rises from the horizon to an elevation keeps (1 - cos) / 2 of even light from the
// plane before it, by the cosine to that.
static void a_wall_takes_its_part(void **state)
{
    (void)state;
    const double tall = 1.0;
    struct hierarchy h =
        tree_of(rectangle(1024, 16, vec3_of(-32, 0, 0), vec3_of(64, 0, 0), vec3_of(0, 0, tall)),
                1024 * 16, 1 << 14);
    for (double before = 0.5; before < 5.0; before *= 2.0) {
        const double want = 0.5 * (1.0 - cos(atan2(tall, before)));
        const double got = covered(&h, 24, vec3_of(0, -before, 0), vec3_of(0, 0, 1));
        printf("%g before the wall: %.4f, truth %.4f\n", before, got, want);
        CHECK_NEAR(got, want, 0.02 * want + 0.004);
    }
    hierarchy_forget(&h);
}

// ---------------------------------------------------------------- warped by the material

// Phong's lobe about where a mirror would show, over a little of a matte one.
struct lobe {
    vec3 mirrored;
    double sharp;
};

static double returned(const struct lobe *l, vec3 towards)
{
    const double MATTE = 0.05, along = fmax(vec3_dot(l->mirrored, towards), 0.0);
    return MATTE + 0.5 * (l->sharp + 2.0) * pow(along, l->sharp);
}

static void answer(float rgb[3], const void *context, vec3 towards)
{
    rgb[0] = rgb[1] = rgb[2] = (float)returned(context, towards);
}

// All that it returns of light of 1 within a strip of the disc of z = 0's directions.
static double return_between(const struct lobe *l, double from, double to, double low, double high)
{
    enum { FINE = 64 };
    double sum = 0.0;
    for (int i = 0; i < FINE * FINE; i++) {
        const double u = from + (to - from) * (i % FINE + 0.5) / FINE, h = sqrt(1.0 - u * u);
        const double v = h * (low + (high - low) * (i / FINE + 0.5) / FINE);
        const vec3 towards = vec3_of(u, v, sqrt(1.0 - u * u - v * v));
        sum += returned(l, towards) * h * (to - from) * (high - low) / (FINE * FINE) / M_PI;
    }
    return sum;
}

static struct cut_place place_of(const struct cut_view *view, vec3 at)
{
    struct cut_place place;
    cut_place_at(&place, view, at, vec3_of(0, 0, 1));
    return place;
}

// Pixels take up the whole disc, all of one weight, of which a twentieth is spread evenly; what
// they return is what the surface does.
static void warped_pixels_are_worth_the_same(void **state)
{
    (void)state;
    enum { SIDE = 8, PIXELS = SIDE * SIDE };
    static const double sharp[] = {1.0, 5.0, 20.0, 100.0};
    static struct warp w;
    for (int k = 0; k < 4; k++) {
        const struct lobe l = {vec3_unit(vec3_of(0, 0.6, 1)), sharp[k]};
        struct cut_place place = place_of(NULL, vec3_of(0, 0, 0));
        double all = 0.0, share = 0.0, weight_off = 0.0;
        assert_true(warp_create(&w, &place, SIDE, l.mirrored, answer, &l));
        for (int i = 0; i < PIXELS; i++)
            all += (double)w.answer[i][1], share += (double)w.view.pixel[i].share;
        const double up = (double)place.frame[1][1], across = (double)place.frame[0][0];
        for (int i = 0; i < PIXELS; i++) {
            const double weight =
                0.95 * (double)w.answer[i][1] / all + 0.05 * (double)w.view.pixel[i].share;
            weight_off = fmax(weight_off, fabs(PIXELS * weight - 1.0));
        }
        const double truth = return_between(&l, -1.0, 1.0, -1.0, 1.0);
        printf("lobe %g: returns %.4f of %.4f, weights off by %.4f\n", sharp[k], all, truth,
               weight_off);
        CHECK_NEAR(up, 1.0, 1e-6);  // the picture is turned as the lobe is
        CHECK_NEAR(fabs(across), 1.0, 1e-6);
        CHECK_NEAR(share, 1.0, 1e-5);
        CHECK_NEAR(all, truth, 0.03 * truth);
        CHECK_NEAR(weight_off, 0.0, 0.03);
    }
}

// What is spread evenly over the disc covers all pixels alike.
static void warped_pixels_are_evenly_covered(void **state)
{
    (void)state;
    enum { SIDE = 8, ACROSS = 1000 };
    static struct warp w;
    const struct lobe l = {vec3_unit(vec3_of(0.3, -0.4, 1)), 30.0};
    double covers[SIDE * SIDE] = {0.0};
    struct cut_place place = place_of(NULL, vec3_of(0, 0, 0));
    assert_true(warp_create(&w, &place, SIDE, l.mirrored, answer, &l));
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        const double u = 2.0 * (i % ACROSS + 0.5) / ACROSS - 1.0;
        const double v = 2.0 * (i / ACROSS + 0.5) / ACROSS - 1.0;
        struct warp_parts p;
        if (u * u + v * v >= 1.0)
            continue;
        warp_parts(&p, &w, (float)u, (float)v);
        for (int n = 0; n < 4; n++)
            covers[p.pixel[n]] += (double)p.weight[n] * 4.0 / (ACROSS * ACROSS);
    }
    for (int i = 0; i < SIDE * SIDE; i++)
        CHECK_NEAR(covers[i], 1.0, 0.08);
}

// What a place throws back of a square of light.
static double shown(const struct hierarchy *h, const struct lobe *l, int side, vec3 at, bool warped)
{
    static struct cut_view view;
    static struct warp w;
    static struct cut_cell cells[CUT_MOST * CUT_MOST];
    struct cut_list list = {0};
    struct cut_place place = place_of(&view, at);
    double sum = 0.0;
    cut_view_create(&view, side);
    if (warped)
        assert_true(warp_create(&w, &place, side, l->mirrored, answer, l));
    memset(cells, 0, sizeof cells);
    cut_objects(cells, &list, h, &place);
    for (int i = 0; i < side * side; i++) {
        const struct cut_pixel *p = &place.view->pixel[i];
        if (!(p->share > 0.0f))
            continue;
        const double worth = warped ? (double)w.answer[i][1]
                                    : (double)p->share * returned(l, cut_direction(&place, p));
        sum += worth *
               (double)(cells[i].object_close ? 1.0f : fminf(cells[i].covered / p->inside, 1.0f));
    }
    return sum;
}

static double square_returned(const struct lobe *l, vec3 at)
{
    enum { FINE = 200 };
    double sum = 0.0;
    for (int i = 0; i < FINE * FINE; i++) {
        const vec3 to =
            vec3_of((i % FINE + 0.5) / FINE - at.x, (i / FINE + 0.5) / FINE - at.y, 1.0);
        const double square = vec3_dot(to, to), cosine = 1.0 / sqrt(square);
        sum += returned(l, vec3_scale(to, cosine)) * cosine * cosine / square / (FINE * FINE);
    }
    return sum / M_PI;
}

// A square of light above glossy places: warped pictures are nearer to the integral than even ones.
static void warped_pictures_show_lobes(void **state)
{
    (void)state;
    enum { SITES = 6, SIDE = 8 };
    struct hierarchy h =
        tree_of(rectangle(128, 128, vec3_of(0, 1, 1), vec3_of(1, 0, 0), vec3_of(0, -1, 0)),
                128 * 128, 1 << 14);
    for (double sharp = 20.0; sharp < 400.0; sharp *= 4.0) {
        const struct lobe l = {vec3_unit(vec3_of(0.5, 0.25, 1)), sharp};
        double wrong[2] = {0.0, 0.0}, all = 0.0;
        for (int i = 0; i < SITES * SITES; i++) {
            const vec3 at = vec3_of(1.6 * (i % SITES + 0.5) / SITES - 0.8,
                                    1.6 * (i / SITES + 0.5) / SITES - 0.6, 0.0);
            const double want = square_returned(&l, at);
            all += want * want;
            for (int warped = 0; warped < 2; warped++)
                wrong[warped] += pow(shown(&h, &l, SIDE, at, warped) - want, 2.0);
        }
        const double even = sqrt(wrong[0] / all), warped = sqrt(wrong[1] / all);
        printf("lobe %g: off by %.4f, warped %.4f\n", sharp, even, warped);
        assert_true(warped < 0.12 && warped < (sharp < 50.0 ? 0.9 : 0.4) * even);
    }
    hierarchy_forget(&h);
}

static void nothing(float rgb[3], const void *context, vec3 towards)
{
    (void)context, (void)towards;
    rgb[0] = NAN, rgb[1] = -1.0f, rgb[2] = 0.0f;
}

static void what_returns_nothing_is_not_warped(void **state)
{
    (void)state;
    static struct cut_view view;
    static struct warp w;
    struct cut_place place = place_of(&view, vec3_of(0, 0, 0));
    assert_false(warp_create(&w, &place, 8, vec3_of(0, 0, 1), nothing, NULL));
    assert_ptr_equal(place.view, &view);
    assert_null(place.warp);
}

// ---------------------------------------------------------------- trees

static void check_ball(const struct hierarchy *h, const struct piece *pieces, size_t leaf)
{
    for (int level = h->levels - 1, up = 0; level >= 0; level--, up++) {
        const size_t at = leaf >> (3 * up);
        const struct group *g = &h->groups[h->first[level] + at / HIERARCHY_WAYS];
        const size_t k = at % HIERARCHY_WAYS;
        for (size_t i = h->begins[leaf]; i < h->begins[leaf + 1]; i++) {
            const float *p = pieces[h->order[i]].place;
            const vec3 off = vec3_of((double)(p[0] - g->x[k]), (double)(p[1] - g->y[k]),
                                     (double)(p[2] - g->z[k]));
            assert_true(vec3_length(off) <= (double)g->radius[k] * 1.0001 + 1e-6);
        }
    }
}

// Every piece is in one leaf, and in the balls of all nodes above that.
static void trees_hold_all_pieces(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 2, 3, 7, 8, 9, 63, 64, 65, 1000};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        struct piece pieces[1000];
        bool seen[1000] = {false};
        struct hierarchy h;
        const size_t n = counts[c];
        for (size_t i = 0; i < n; i++)  // many of them at one place
            pieces[i] = (struct piece){{(float)(i * 7 % 13), (float)(i * 5 % 11), (float)(i % 3)},
                                       {0, 0, 1.0f + (float)(i % 2)}};
        CHECK_OK(hierarchy_create(&h, pieces, n, 256, 3));
        assert_true(h.leaves <= n && h.leaves <= 256 && (2 * h.leaves > n || h.leaves == 256));
        assert_int_equal(h.begins[0], 0);
        assert_int_equal(h.begins[h.leaves], n);
        for (size_t leaf = 0; leaf < h.leaves; leaf++) {
            assert_true(h.begins[leaf] < h.begins[leaf + 1]);
            for (size_t i = h.begins[leaf]; i < h.begins[leaf + 1]; i++) {
                assert_false(seen[h.order[i]]);
                seen[h.order[i]] = true;
            }
            check_ball(&h, pieces, leaf);
            h.sent[hierarchy_leaf(&h, leaf)].with[1] = (float)leaf;
        }
        hierarchy_light(&h);
        double mean = 0.0, area = 0.0, root = 0.0;
        for (size_t leaf = 0; leaf < h.leaves; leaf++) {
            const double own = (double)h.area[hierarchy_leaf(&h, leaf)];
            mean += own * (double)leaf;
            area += own;
        }
        for (size_t k = 0; k < HIERARCHY_WAYS; k++)
            root += (double)(h.area[k] * h.sent[k].with[1]);
        CHECK_NEAR(root / area, mean / area, 1e-4 * (mean / area + 1.0));
        hierarchy_forget(&h);
    }
}

static void pieces_that_are_none_do_not_count(void **state)
{
    (void)state;
    const float huge = 3e38f;
    const struct piece pieces[] = {{{0, 0, 0}, {0, 0, 0}},
                                   {{NAN, 0, 0}, {0, 0, 1}},
                                   {{0, 0, 0}, {0, INFINITY, 0}},
                                   {{0, 0, 0}, {huge, huge, 0}},
                                   {{1, 2, 3}, {0, 0, 1}}};
    struct hierarchy h;
    CHECK_OK(hierarchy_create(&h, pieces, 5, 64, 1));
    assert_int_equal(h.leaves, 1);
    assert_int_equal(h.order[0], 4);
    CHECK_NEAR(covered(&h, 8, vec3_of(1, 2, 3.0001), vec3_of(0, 0, 1)), 0.0, 1e-6);
    CHECK_NEAR(covered(&h, 8, vec3_of(1, 2, 3), vec3_of(0, 0, 1)), 0.0, 1e-6);
    hierarchy_forget(&h);
    CHECK_OK(hierarchy_create(&h, pieces, 4, 64, 1));
    assert_int_equal(h.levels, 0);
    CHECK_NEAR(covered(&h, 8, vec3_of(0, 0, 0), vec3_of(0, 0, 1)), 0.0, 0.0);
    hierarchy_forget(&h);
    const float sizes[] = {1e-25f, 1e25f};  // whose squares are no floats
    for (int i = 0; i < 2; i++) {
        const struct piece one = {{1, 2, 3}, {0, 0, sizes[i]}};
        CHECK_OK(hierarchy_create(&h, &one, 1, 64, 1));
        assert_int_equal(h.leaves, 1);
        CHECK_NEAR(h.groups[0].radius[0] / sqrt((double)sizes[i] / M_PI), 1.0, 1e-6);
        hierarchy_forget(&h);
    }
    CHECK_OK(hierarchy_create(&h, NULL, 0, 64, 1));
    hierarchy_forget(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(squares_have_their_form_factor),
        cmocka_unit_test(a_wall_takes_its_part),
        cmocka_unit_test(warped_pixels_are_worth_the_same),
        cmocka_unit_test(warped_pixels_are_evenly_covered),
        cmocka_unit_test(warped_pictures_show_lobes),
        cmocka_unit_test(what_returns_nothing_is_not_warped),
        cmocka_unit_test(trees_hold_all_pieces),
        cmocka_unit_test(pieces_that_are_none_do_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
