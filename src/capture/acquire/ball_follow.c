// ball_follow.c - the outline of a ball, followed along its radii
//
// Each radius is searched for the steepest change of log light; a robust fit keeps what agrees on
// one circle (or cone), and the search narrows around it.
#include "capture/acquire/ball.h"

#include "core/base/memory.h"
#include "core/math/sort.h"

#include <string.h>

enum { ROUNDS = 8, MOST_STEPS = 256 };
static const double LEAST_EDGE = 3.0;  // of the median change along the radii
static const double NEAR = 0.02;       // share of the radius within which an edge agrees

struct follower {
    struct relume_ball *ball;
    const struct relume_ball_camera *camera;
    const struct relume_image *edges;
    int angles;
    struct ball_point *point;  // [angles]; weight 0: no edge seen
    float *change;             // [angles], of the edges
    float *scratch;            // [angles]
    double step;               // along a radius, pixels
};

static bool is_inside(const struct relume_image *image, double x, double y)
{
    return x >= 1.0 && y >= 1.0 && x <= image->width - 1.0 && y <= image->height - 1.0;
}

// The steepest change on one radius, near its expected place preferred.
static void search_radius(const struct follower *f, int i, double reach)
{
    const struct relume_ball *b = f->ball;
    const double a = 2.0 * M_PI * i / f->angles, cx = cos(a), cy = sin(a);
    int n = relume_whole(2.0 * reach / f->step) + 1;
    n = n > MOST_STEPS ? MOST_STEPS : n;
    float change[MOST_STEPS] = {0};
    double best = 0.0;
    int found = -1;
    for (int k = 0; k < n; k++) {
        const double off = (k - 0.5 * (n - 1)) * f->step, r = b->radius + off;
        const double in = r - f->step, out = r + f->step;
        if (is_inside(f->edges, b->x + out * cx, b->y + out * cy))
            change[k] = fabsf(ball_at(f->edges, b->x + out * cx, b->y + out * cy) -
                              ball_at(f->edges, b->x + in * cx, b->y + in * cy));
        const double near = (double)change[k] * exp(-off * off / (reach * reach));
        if (near > best) {
            best = near;
            found = k;
        }
    }
    f->point[i].weight = 0.0;
    f->change[i] = 0.0f;
    if (found < 0)
        return;
    double sub = 0.0;
    if (found > 0 && found < n - 1) {
        const double l = (double)change[found - 1], m = (double)change[found],
                     h = (double)change[found + 1], bend = l - 2.0 * m + h;
        sub = bend < 0.0 ? 0.5 * (l - h) / bend : 0.0;
    }
    const double r = b->radius + (found - 0.5 * (n - 1) + fmin(fmax(sub, -1.0), 1.0)) * f->step;
    f->point[i] = (struct ball_point){b->x + r * cx, b->y + r * cy, 1.0};
    f->change[i] = change[found];
}

// The median change between neighbours on circles well inside and outside of the outline.
static float background(const struct follower *f)
{
    const struct relume_ball *b = f->ball;
    for (int i = 0; i < f->angles; i++) {
        const double a = 2.0 * M_PI * i / f->angles, r = b->radius * (i % 2 ? 1.25 : 0.75);
        const double x = b->x + r * cos(a), y = b->y + r * sin(a);
        f->scratch[i] = fabsf(ball_at(f->edges, x + f->step * cos(a), y + f->step * sin(a)) -
                              ball_at(f->edges, x - f->step * cos(a), y - f->step * sin(a)));
    }
    sort_floats(f->scratch, (size_t)f->angles);
    return f->scratch[f->angles / 2];
}

// Cauchy weights by the distance from the outline.
static void weigh(const struct follower *f, double tolerance)
{
    for (int i = 0; i < f->angles; i++) {
        struct ball_point *p = &f->point[i];
        if (p->weight <= 0.0)
            continue;
        const double d = ball_distance(f->ball, f->camera, p->x, p->y) / (0.5 * tolerance);
        p->weight = fmax(1.0 / (1.0 + d * d), 1e-9);
    }
}

static void drop_weak(const struct follower *f)
{
    const float least = (float)LEAST_EDGE * background(f);
    for (int i = 0; i < f->angles; i++)
        if (!(f->change[i] > least))
            f->point[i].weight = 0.0;
}

// Share of the outline with an edge on it, and how well that fixes the middle.
static void judge(const struct follower *f)
{
    struct relume_ball *b = f->ball;
    const double tolerance = fmax(0.01 * b->radius, 1.0);
    double squares = 0.0;
    int n = 0;
    for (int i = 0; i < f->angles; i++) {
        const double d = ball_distance(b, f->camera, f->point[i].x, f->point[i].y);
        if (f->point[i].weight <= 0.0 || fabs(d) > tolerance)
            continue;
        squares += d * d;
        n++;
    }
    b->coverage = (double)n / f->angles;
    // Neighbouring radii share pixels: about one in four counts.
    b->sigma = n > 12 ? sqrt(squares / n * 2.0 * 4.0 / n) : b->radius;
}

static bool follow(struct follower *f, double reach)
{
    for (int round = 0; round < ROUNDS; round++) {
        f->step = fmax(reach / (0.5 * (MOST_STEPS - 1)), fmin(1.0, 0.1 * f->ball->radius));
        for (int i = 0; i < f->angles; i++)
            search_radius(f, i, reach);
        drop_weak(f);
        for (int k = 0; k < 6; k++) {
            if (!ball_fit(f->ball, f->camera, f->point, f->angles))
                return false;
            weigh(f, fmax(fmax(NEAR * f->ball->radius, 0.3 * reach), 1.0));
        }
        reach = fmin(reach, fmax(0.6 * reach, fmax(0.05 * f->ball->radius, 3.0)));
    }
    // At the end the search is wide again, so that texture scatters and does not count.
    for (int i = 0; i < f->angles; i++)
        search_radius(f, i, fmax(0.08 * f->ball->radius, 5.0));
    drop_weak(f);
    judge(f);
    return true;
}

relume_status ball_follow(struct relume_ball *ball, const struct relume_ball_camera *camera,
                          const struct relume_image *edges, int angles, double reach)
{
    struct follower f = {
        .ball = ball,
        .camera = camera,
        .edges = edges,
        .angles = angles,
        .point = mem_zeroed((size_t)angles, sizeof *f.point),
        .change = mem_zeroed((size_t)angles, sizeof *f.change),
        .scratch = mem_zeroed((size_t)angles, sizeof *f.scratch),
    };
    relume_status status = f.point && f.change && f.scratch ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !follow(&f, reach * ball->radius))
        status = RELUME_EUNFIT;
    mem_free(f.point);
    mem_free(f.change);
    mem_free(f.scratch);
    return status;
}
