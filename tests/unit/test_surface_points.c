// Surfaces as trees of points for those who gather light themselves: areas, balls, what leaves
// stand for; nothing known, wrong sizes.
#include "world/object/object_points.h"

#include "test.h"

#include <stdio.h>

enum { W = 64, H = 32 };
static const double RADIUS = 2.0;

static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};

// All around the eye at one distance, or nowhere (NaN).
static struct relume_image places_at_distance(double distance)
{
    struct relume_image places;
    CHECK_OK(relume_image_create(&places, W, H, 3));
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double down = M_PI * (y + 0.5) / H, turn = 2.0 * M_PI * (x + 0.5) / W - M_PI;
            float *p = places.data + 3 * (y * W + x);
            p[0] = (float)(distance * sin(down) * sin(turn));
            p[1] = (float)(distance * cos(down));
            p[2] = (float)(-distance * sin(down) * cos(turn));
        }
    return places;
}

static double length_of(const float v[3])
{
    return sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
}

// A node has the area of its children, whose middles lie in its ball.
static void check_tree(const struct relume_points *p)
{
    for (size_t i = 0; i < p->nodes; i++) {
        const struct relume_points_node *n = &p->node[i];
        double area = 0.0;
        if (n->radius < 0.0f || n->child < 0)
            continue;
        for (int k = 0; k < RELUME_POINTS_WAYS; k++) {
            const struct relume_points_node *c = &p->node[n->child + k];
            float off[3];
            if (c->radius < 0.0f)
                continue;
            area += (double)c->area;
            for (int d = 0; d < 3; d++)
                off[d] = c->middle[d] - n->middle[d];
            assert_true(length_of(off) <= (double)n->radius * 1.0001);
        }
        CHECK_NEAR(area / (double)n->area, 1.0, 1e-4);
    }
}

static double area_of(const struct relume_points *p)
{
    double area = 0.0;
    for (size_t i = p->first[p->levels - 1]; i < p->first[p->levels]; i++)
        area += p->node[i].radius < 0.0f ? 0.0 : (double)p->node[i].area;
    return area;
}

static void a_room_is_known(void **state)
{
    (void)state;
    const double all = 4.0 * M_PI * RADIUS * RADIUS;
    struct relume_image places = places_at_distance(RADIUS);
    struct relume_points p;
    CHECK_OK(relume_points_of_scene(&p, &sphere, &places, NULL, NULL));
    check_tree(&p);
    CHECK_NEAR(area_of(&p) / all, 1.0, 0.02);  // triangles between 64 x 32 places
    CHECK_NEAR(p.area * (double)p.spots / all, 1.0, 0.02);
    assert_int_equal(p.across, W);
    assert_int_equal(p.side, 1);
    for (size_t i = 0; i < p.leaves; i++) {
        const float *at = p.leaf[i].place, *n = p.leaf[i].normal;
        double weight = 0.0;
        for (uint32_t k = p.begins[i]; k < p.begins[i + 1]; k++) {
            assert_true(p.block[k].block < W * H);
            weight += (double)p.block[k].weight;
        }
        CHECK_NEAR(weight, 1.0, 1e-5);
        CHECK_NEAR((at[0] * n[0] + at[1] * n[1] + at[2] * n[2]) / length_of(at), -1.0, 0.02);
        assert_false(p.leaf[i].is_far);
    }
    relume_points_free(&p);
    assert_null(p.node);
    relume_image_destroy(&places);
}

// It is all background, of the whole solid angle.
static void nothing_is_known(void **state)
{
    (void)state;
    struct relume_image places = places_at_distance(NAN);
    struct relume_points p;
    CHECK_OK(relume_points_of_scene(&p, &sphere, &places, NULL, NULL));
    double angle = 0.0;
    for (size_t i = p.first[p.levels - 1]; i < p.first[p.levels]; i++) {
        const double away = length_of(p.node[i].middle);
        angle += p.node[i].radius < 0.0f ? 0.0 : (double)p.node[i].area / (away * away);
    }
    for (size_t i = 0; i < p.leaves; i++)
        assert_true(p.leaf[i].is_far);
    CHECK_NEAR(angle / (4.0 * M_PI), 1.0, 0.01);
    assert_int_equal(p.spots, 0);
    relume_points_free(&p);
    relume_image_destroy(&places);
}

static relume_objects *open_square(const char *folder)
{
    char path[96];
    relume_objects *objects;
    snprintf(path, sizeof path, "%s/square.obj", folder);
    FILE *f = fopen(path, "w");
    fputs("v -0.4 -0.4 0.3\nv 0.4 -0.4 0.3\nv 0.4 0.4 0.3\nv -0.4 0.4 0.3\nvt 0 0\nvt 1 0\nvt 1 1\n"
          "vt 0 1\nf 1/1 2/2 3/3 4/4\n",
          f);
    fclose(f);
    snprintf(path, sizeof path, "%s/objects.json", folder);
    f = fopen(path, "w");
    fputs("{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"square.obj\","
          "\"parts\":[{\"material\":{\"diffuse\":[0.8,0.4,0]}}]}]}",
          f);
    fclose(f);
    CHECK_OK(relume_objects_open(&objects, path, NULL));
    return objects;
}

static void a_sheet_has_two_sides(void **state)
{
    (void)state;
    static const float want[3] = {0.8f, 0.4f, 0.0f};
    static const int wrong[] = {-64, 32, 100, 131072};
    char folder[64];
    struct relume_points p[2];
    test_folder(folder);
    relume_objects *objects = open_square(folder);
    CHECK_OK(relume_points_of_objects(p, objects, relume_points_params(.leaves = 64)));
    for (int side = 0; side < 2; side++) {
        check_tree(&p[side]);
        CHECK_NEAR(area_of(&p[side]), 0.64, 1e-4);
        assert_int_equal(p[side].leaves, 64);
        for (size_t i = 0; i < p[side].leaves; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(p[side].leaf[i].returned[c], want[c], 0.01);
    }
    CHECK_NEAR(p[0].leaf[0].normal[2] + p[1].leaf[0].normal[2], 0.0, 1e-6);
    assert_true(p[0].spot[0].both);
    for (int side = 0; side < 2; side++)
        relume_points_free(&p[side]);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(
            relume_points_of_objects(p, objects, relume_points_params(.leaves = wrong[i])),
            RELUME_EINVAL);
    relume_objects_destroy(&objects);
    test_folder_remove(folder);
}

static void places_have_three_channels(void **state)
{
    (void)state;
    struct relume_image grey;
    struct relume_points p;
    CHECK_OK(relume_image_create(&grey, W, H, 1));
    assert_int_equal(relume_points_of_scene(&p, &sphere, &grey, NULL, NULL), RELUME_EINVAL);
    assert_null(p.node);
    relume_image_destroy(&grey);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_room_is_known), cmocka_unit_test(nothing_is_known),
        cmocka_unit_test(a_sheet_has_two_sides), cmocka_unit_test(places_have_three_channels)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
