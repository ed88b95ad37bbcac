// ball_table.c - the outline of a mirror ball that stands on a table
//
// From above such a ball shows the table in a ring inside its outline, and beyond the table's edge
// a disc whose rim is often clearer than the outline. But the ring is a picture of the table around
// the ball, by the law of reflection: each outline predicts which pixel of the ring shows which of
// the table. The outline is the one whose ring agrees with the table best, over all photographs,
// whose shadows move; the mirror's colour and how brightly the table is lit drop out of the
// correlation of log light. The table is taken to be level: seen along its normal, somewhere below
// the ball.
#include "capture/acquire/ball.h"

#include "core/base/memory.h"

#include <stdlib.h>
#include <string.h>

// Rings as sin of the angle between normal and eye. Below sqrt(1/2) the ball shows what is above.
static const double COARSE[] = {0.87, 0.92, 0.955};
static const double FINE[] = {0.84, 0.87, 0.90, 0.92, 0.94, 0.955, 0.97, 0.98, 0.987};
static const double STANDS[] = {1.0, 1.15, 1.35, 1.6, 2.0, 2.6};  // table below the middle, radii
static const double SMALLEST = 1.06, WIDEST = 1.5;  // of the circle found; the horizon: 1.41
static const double PROMISING = 0.45;               // correlation on coarse rings, off the peak
// Right outlines of balls of 40 pixels and more agree to 0.8; by chance the best of all outlines
// reaches 0.6 where there are shadows, 0.7 on cloth with an even pattern. Of what moves, the
// shadows, the right ring agrees to 0.88, wrong ones to 0.67.
static const double LEAST = 0.7, LEAST_MOVING = 0.78;
// And shadows that lie across the circle agree with themselves: what is explained as well by the
// table that goes on behind a circle is no reflection. (Right ones: 0.35 and more.)
static const double MARGIN = 0.15;
static const double SIGMA = 0.003;      // of the outline so found, radii
static const double STREAK_STEP = 0.2;  // pixels
enum { COARSE_ANGLES = 48, FINE_ANGLES = 120, STREAK = 5, RADII = 19, STARTS = 5 };

struct outline {
    double p[4];  // x, y and radius, pixels (perspective: of the axis, and of the cone); stand
};

enum shown { REFLECTION, TABLE };  // what the ring may be

struct rings {
    const double *ring;
    int rings, angles;
    enum shown shown;
    bool moving;  // only what differs between photographs
};
static const struct rings COARSE_RINGS = {COARSE, sizeof COARSE / sizeof *COARSE, COARSE_ANGLES,
                                          REFLECTION, false};
static const struct rings FINE_RINGS = {FINE, sizeof FINE / sizeof *FINE, FINE_ANGLES, REFLECTION,
                                        false};

struct scene {
    const struct relume_ball_camera *camera;
    const struct relume_image *photo;  // log light
    int photos;
};

// The ball of radius 1 in the world: its middle from the eye, directions across the view of it.
struct place {
    const struct relume_ball_camera *camera;
    struct outline o;
    vec3 middle, to_eye, right, up;
    double half_angle;
};

static struct place place_of(const struct outline *o, const struct relume_ball_camera *camera)
{
    struct place p = {.camera = camera, .o = *o, .to_eye = vec3_of(0.0, 0.0, 1.0)};
    if (camera->focal_px > 0.0) {
        const vec3 axis = relume_ball_ray(camera, o->p[0], o->p[1]);
        p.half_angle = atan(o->p[2] * axis.z * axis.z / camera->focal_px);
        p.middle = vec3_scale(axis, 1.0 / sin(p.half_angle));
        p.to_eye = vec3_scale(axis, -1.0);
    }
    p.right = vec3_unit(vec3_cross(vec3_of(0.0, 1.0, 0.0), p.to_eye));
    p.up = vec3_cross(p.to_eye, p.right);
    return p;
}

// The pixel of a point given from the middle of the ball, in its radii.
static void project(double pixel[2], const struct place *p, vec3 at)
{
    const struct relume_ball_camera *c = p->camera;
    if (!(c->focal_px > 0.0)) {
        pixel[0] = p->o.p[0] + p->o.p[2] * at.x;
        pixel[1] = p->o.p[1] - p->o.p[2] * at.y;
        return;
    }
    const vec3 from_eye = vec3_add(p->middle, at);
    pixel[0] = 0.5 * c->width - c->focal_px * from_eye.x / from_eye.z;
    pixel[1] = 0.5 * c->height + c->focal_px * from_eye.y / from_eye.z;
}

// The ball's surface at sin `s` and angle `a` around the eye, and where on the table its mirror
// image lies; false where it shows what is above.
static bool reflect(double here[2], double there[2], const struct place *p, double s, double a)
{
    const double tilt = asin(s) * (1.0 - p->half_angle / (0.5 * M_PI));
    const vec3 across = vec3_along(vec3_scale(p->right, cos(a)), p->up, sin(a));
    const vec3 n = vec3_along(vec3_scale(p->to_eye, cos(tilt)), across, sin(tilt));
    const vec3 v =
        p->camera->focal_px > 0.0 ? vec3_unit(vec3_scale(vec3_add(p->middle, n), -1.0)) : p->to_eye;
    const vec3 r = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, v)), v);
    if (r.z > -0.05)
        return false;
    project(here, p, n);
    project(there, p, vec3_along(n, r, (-p->o.p[3] - n.z) / r.z));
    return true;
}

static bool is_inside(const struct relume_image *image, const double p[2])
{
    return p[0] >= 1.0 && p[1] >= 1.0 && p[0] <= image->width - 1.0 && p[1] <= image->height - 1.0;
}

struct moments {
    double x, y, xx, yy, xy;
};

static void add(struct moments *m, double x, double y)
{
    m->x += x;
    m->y += y;
    m->xx += x * x;
    m->yy += y * y;
    m->xy += x * y;
}

// A pixel, and the streak of the table that it shows.
struct pair {
    double here[2], there[STREAK][2];
};

// The pixel as far outside of the outline as `here` is inside.
static void fold_out(double there[2], const double here[2], const struct outline *o, double s)
{
    const double by = (2.03 - s) / s;
    there[0] = o->p[0] + (here[0] - o->p[0]) * by;
    there[1] = o->p[1] + (here[1] - o->p[1]) * by;
}

static bool pair_one(struct pair *out, const struct scene *s, const struct place *p, double ring,
                     double angle, enum shown shown)
{
    for (int j = 0; j < STREAK; j++) {
        const double at = fmin(ring + (j - STREAK / 2) * STREAK_STEP / p->o.p[2], 0.9999);
        double here[2];
        if (!reflect(here, out->there[j], p, at, angle))
            return false;
        if (shown == TABLE)
            fold_out(out->there[j], here, &p->o, at);
        if (!is_inside(s->photo, here) || !is_inside(s->photo, out->there[j]))
            return false;
        if (j == STREAK / 2)
            memcpy(out->here, here, sizeof here);
    }
    return true;
}

static int pair_up(struct pair *out, const struct scene *s, const struct outline *o,
                   const struct rings *r)
{
    const struct place p = place_of(o, s->camera);
    int n = 0;
    for (int k = 0; k < r->rings; k++)
        for (int i = 0; i < r->angles; i++)
            n += pair_one(&out[n], s, &p, r->ring[k], 2.0 * M_PI * i / r->angles, r->shown);
    return n;
}

// What photograph `i` shows of a pair; where only what moves counts, less what the one before
// shows.
static void look(double value[2], const struct scene *s, int i, const struct pair *pair,
                 bool moving)
{
    value[0] = (double)ball_at(&s->photo[i], pair->here[0], pair->here[1]);
    value[1] = 0.0;
    for (int j = 0; j < STREAK; j++)
        value[1] += (double)ball_at(&s->photo[i], pair->there[j][0], pair->there[j][1]) / STREAK;
    if (!moving)
        return;
    double before[2];
    look(before, s, (i + s->photos - 1) % s->photos, pair, false);
    value[0] -= before[0];
    value[1] -= before[1];
}

// How the ring agrees with the table, -1 to 1; 0 where too little of the table is in the picture.
static double agreement(const struct scene *s, const struct outline *o, const struct rings *r,
                        struct pair *pair)
{
    const int n = pair_up(pair, s, o, r);
    if (3 * n < r->rings * r->angles)
        return 0.0;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (int i = 0; i < s->photos; i++) {
        struct moments m = {0};
        for (int k = 0; k < n; k++) {
            double value[2];
            look(value, s, i, &pair[k], r->moving);
            add(&m, value[0], value[1]);
        }
        xx += m.xx - m.x * m.x / n;
        yy += m.yy - m.y * m.y / n;
        xy += m.xy - m.x * m.y / n;
    }
    return xx > 1e-9 && yy > 1e-9 ? xy / sqrt(xx * yy) : 0.0;
}

// The best outline of one radius around the circle found. In perspective its reflections lie nearer
// to the middle of the picture than it does.
static double search_radius(struct outline *best, const struct scene *s,
                            const struct relume_ball *found, double radius, struct pair *pair)
{
    const bool deep = s->camera->focal_px > 0.0;
    const double off[2] = {found->x - 0.5 * s->camera->width, found->y - 0.5 * s->camera->height};
    const double far = fmax(hypot(off[0], off[1]), 1e-9);
    const double out[2] = {deep ? off[0] / far : 1.0, deep ? off[1] / far : 0.0};
    const double step = 0.035 * found->radius;
    double most = 0.0;
    for (int i = -1; i <= (deep ? 5 : 1); i++)
        for (int j = -1; j <= 1; j++)
            for (size_t k = 0; k < sizeof STANDS / sizeof *STANDS; k++) {
                const struct outline o = {{found->x + step * (i * out[0] - j * out[1]),
                                           found->y + step * (i * out[1] + j * out[0]), radius,
                                           STANDS[k]}};
                const double here = agreement(s, &o, &COARSE_RINGS, pair);
                if (here > most) {
                    most = here;
                    *best = o;
                }
            }
    return most;
}

// Pattern search: a step (of the radius) along each parameter while it helps, then half of it. The
// table's depth and the radius make up for each other, so they are also changed together.
static double refine(struct outline *o, const struct scene *s, const struct rings *rings,
                     double step, double least, struct pair *pair)
{
    static const double MOVE[5][4] = {
        {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 4}, {0, 0, -0.25, 8}};
    double most = agreement(s, o, rings, pair);
    while (step > least) {
        bool better = false;
        for (int k = 0; k < 10; k++) {
            struct outline other = *o;
            for (int j = 0; j < 4; j++)
                other.p[j] += MOVE[k / 2][j] * (k % 2 ? step : -step) * (j < 3 ? o->p[2] : 1.0);
            other.p[3] = fmax(other.p[3], 1.0);
            const double here = agreement(s, &other, rings, pair);
            if (here <= most)
                continue;
            most = here;
            *o = other;
            better = true;
        }
        if (!better)
            step *= 0.5;
    }
    return most;
}

struct start {
    struct outline o;
    double agrees;
};

static int by_agreement(const void *a, const void *b)
{
    const double x = ((const struct start *)a)->agrees, y = ((const struct start *)b)->agrees;
    return (x < y) - (x > y);
}

// The peak is narrow: the best of some radii are followed before one is chosen.
static double search(struct outline *best, const struct scene *s, const struct relume_ball *found,
                     struct pair *pair)
{
    struct start start[RADII];
    double most = 0.0;
    for (int i = 0; i < RADII; i++) {
        const double scale = SMALLEST + (WIDEST - SMALLEST) * i / (RADII - 1);
        start[i].agrees = search_radius(&start[i].o, s, found, found->radius * scale, pair);
    }
    qsort(start, RADII, sizeof *start, by_agreement);
    for (int i = 0; i < STARTS && start[i].agrees > PROMISING; i++) {
        const double here = refine(&start[i].o, s, &COARSE_RINGS, 0.02, 0.004, pair);
        if (here > most) {
            most = here;
            *best = start[i].o;
        }
    }
    return most > 0.0 ? refine(best, s, &FINE_RINGS, 0.01, 0.0002, pair) : 0.0;
}

static bool outline_of(struct relume_ball *ball, const struct outline *o,
                       const struct relume_ball_camera *camera)
{
    enum { POINTS = 64 };
    struct ball_point point[POINTS];
    const struct place p = place_of(o, camera);
    for (int i = 0; i < POINTS; i++) {
        double at[2], table[2];
        if (!reflect(at, table, &p, 1.0, 2.0 * M_PI * i / POINTS))
            return false;
        point[i] = (struct ball_point){at[0], at[1], 1.0};
    }
    ball->x = o->p[0];
    ball->y = o->p[1];
    ball->radius = o->p[2];
    return ball_fit(ball, camera, point, POINTS);
}

// Whether the ring inside the outline is a reflection.
static bool is_reflection(const struct scene *s, const struct outline *o, double agrees,
                          struct pair *pair)
{
    struct rings table = FINE_RINGS, moving = FINE_RINGS;
    table.shown = TABLE;
    moving.moving = true;
    return agrees > LEAST && agreement(s, o, &moving, pair) > LEAST_MOVING &&
           agrees > agreement(s, o, &table, pair) + MARGIN;
}

relume_status ball_on_table(struct relume_ball *ball, bool *is,
                            const struct relume_ball_camera *camera,
                            const struct relume_image *photo, int photos)
{
    const struct scene s = {camera, photo, photos};
    struct outline best = {{0.0}};
    struct relume_ball outlined = *ball;
    struct pair *pair = mem_array(FINE_ANGLES * (sizeof FINE / sizeof *FINE), sizeof *pair);
    if (!pair)
        return RELUME_ENOMEM;
    const double agrees = search(&best, &s, ball, pair);
    *is = is_reflection(&s, &best, agrees, pair) && outline_of(&outlined, &best, camera);
    if (*is) {
        *ball = outlined;
        ball->sigma = SIGMA * ball->radius;
    }
    mem_free(pair);
    return RELUME_OK;
}
