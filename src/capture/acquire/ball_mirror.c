// ball_mirror.c - the lamp's reflection in a mirror ball
//
// Every pixel of the spot shows a direction, v reflected at the ball: l = 2 (n.v) n - v. On an
// orthographic picture equal areas are equal solid angles (dw = 4 dA / r^2), so that the plain mean
// of the pixels' directions is the middle of the lamp. Clipped pixels weigh alike, those on the
// spot's slope by how far they stand above half of the peak.
#include "capture/acquire/ball.h"

#include "core/base/memory.h"

static const float DARK = 0.02f;   // peaks below are no lamp
static const float BRIGHT = 0.5f;  // a ball that is lit all over and darker shows no lamp
static const double RIM = 0.975;   // of the radius
static const double BORDER = 1.0;  // pixels: what lies behind the ball mixes in
static const double FULL = 0.15;   // share of the disc
static const double SECOND = 0.1;  // of the first spot's light

const char *relume_ball_finding_text(enum relume_ball_finding finding)
{
    static const char *const text[] = {
        [RELUME_BALL_SEEN] = "one highlight",   [RELUME_BALL_DARK] = "no highlight",
        [RELUME_BALL_FULL] = "bright all over", [RELUME_BALL_RIM] = "the highlight lies at the rim",
        [RELUME_BALL_TWO] = "two highlights",
    };
    return (unsigned)finding < sizeof text / sizeof *text ? text[finding] : "unknown";
}

// The square of pixels around a ball, and which of them are lit and not looked at yet.
struct window {
    const struct relume_image *image, *still;
    int x, y, width, height;
    float threshold;
    uint8_t *todo;  // [height][width]
    int *stack;
};

struct spot {
    double weight, x, y;
    vec3 sum;  // of directions
    // Sums over its border of weight^2, times 1, x, y and x^2 + y^2 from the window's corner
    double step, step_x, step_y, step_square;
};

static float value(const struct window *w, int x, int y)
{
    const float v = ball_grey(w->image, w->x + x, w->y + y);
    if (!w->still)
        return v;
    return fmaxf(
        v - w->still->data[(size_t)(w->y + y) * (size_t)w->image->width + (size_t)(w->x + x)],
        0.0f);
}

static bool cut_window(struct window *w, const struct relume_ball *ball,
                       const struct relume_image *image)
{
    const int x0 = relume_whole(floor(ball->x - ball->radius)),
              y0 = relume_whole(floor(ball->y - ball->radius));
    const int x1 = relume_whole(ceil(ball->x + ball->radius)),
              y1 = relume_whole(ceil(ball->y + ball->radius));
    w->image = image;
    w->x = x0 < 0 ? 0 : x0;
    w->y = y0 < 0 ? 0 : y0;
    w->width = (x1 > image->width ? image->width : x1) - w->x;
    w->height = (y1 > image->height ? image->height : y1) - w->y;
    return w->width > 0 && w->height > 0;
}

static float find_peak(const struct window *w, const struct relume_ball *ball,
                       const struct relume_ball_camera *camera)
{
    float peak = 0.0f;
    for (int y = 0; y < w->height; y++)
        for (int x = 0; x < w->width; x++)
            if (value(w, x, y) > peak &&
                ball_distance(ball, camera, w->x + x + 0.5, w->y + y + 0.5) < -BORDER)
                peak = value(w, x, y);
    return peak;
}

// Returns the share of the ball that is lit.
static double mark_lit(struct window *w, const struct relume_ball *ball,
                       const struct relume_ball_camera *camera)
{
    double lit = 0.0;
    for (int y = 0; y < w->height; y++)
        for (int x = 0; x < w->width; x++) {
            const bool is = value(w, x, y) > w->threshold &&
                            ball_distance(ball, camera, w->x + x + 0.5, w->y + y + 0.5) < -BORDER;
            w->todo[y * w->width + x] = is;
            lit += is;
        }
    return lit / (M_PI * ball->radius * ball->radius);
}

static void add_pixel(struct spot *s, const struct window *w, int x, int y,
                      const struct relume_ball *ball, const struct relume_ball_camera *camera)
{
    vec3 n, v;
    const double px = w->x + x + 0.5, py = w->y + y + 0.5;
    const double weight = (double)(value(w, x, y) - w->threshold);
    if (!ball_normal(&n, &v, ball, camera, px, py))
        return;
    const vec3 l = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, v)), v);
    s->sum = vec3_along(s->sum, l, weight);
    s->weight += weight;
    s->x += weight * px;
    s->y += weight * py;
}

// Adds the border between a pixel and its neighbour.
static void add_border(struct spot *s, const struct window *w, int x, int y, int nx, int ny)
{
    const double weight = (double)(value(w, x, y) - w->threshold);
    const double bx = 0.5 * (x + nx) + 0.5, by = 0.5 * (y + ny) + 0.5;
    s->step += weight * weight;
    s->step_x += weight * weight * bx;
    s->step_y += weight * weight * by;
    s->step_square += weight * weight * (bx * bx + by * by);
}

static void follow_border(struct spot *s, const struct window *w, int x, int y)
{
    for (int k = 0; k < 4; k++) {
        const int nx = x + (k == 0) - (k == 1), ny = y + (k == 2) - (k == 3);
        if (nx < 0 || ny < 0 || nx >= w->width || ny >= w->height ||
            !(value(w, nx, ny) > w->threshold))
            add_border(s, w, x, y, nx, ny);
    }
}

// The connected lit pixels around (x, y); each pixel is visited once.
static struct spot follow_spot(struct window *w, int x, int y, const struct relume_ball *ball,
                               const struct relume_ball_camera *camera)
{
    struct spot s = {0};
    int depth = 0;
    w->stack[depth++] = y * w->width + x;
    w->todo[y * w->width + x] = 0;
    while (depth > 0) {
        const int at = w->stack[--depth], cx = at % w->width, cy = at / w->width;
        add_pixel(&s, w, cx, cy, ball, camera);
        follow_border(&s, w, cx, cy);
        for (int k = 0; k < 9; k++) {
            const int nx = cx + k % 3 - 1, ny = cy + k / 3 - 1;
            if (nx < 0 || ny < 0 || nx >= w->width || ny >= w->height ||
                !w->todo[ny * w->width + nx])
                continue;
            w->todo[ny * w->width + nx] = 0;
            w->stack[depth++] = ny * w->width + nx;
        }
    }
    return s;
}

// The two spots with most light.
static void find_spots(struct window *w, const struct relume_ball *ball,
                       const struct relume_ball_camera *camera, struct spot best[2])
{
    best[0] = best[1] = (struct spot){0};
    for (int y = 0; y < w->height; y++)
        for (int x = 0; x < w->width; x++) {
            if (!w->todo[y * w->width + x])
                continue;
            const struct spot s = follow_spot(w, x, y, ball, camera);
            if (s.weight > best[0].weight) {
                best[1] = best[0];
                best[0] = s;
            } else if (s.weight > best[1].weight) {
                best[1] = s;
            }
        }
}

// Variance of a spot's middle along one axis, pixels. An edge between a dark pixel and one of the
// weight w lies anywhere between them. The sum of weights errs by w / sqrt(12) there. The middle
// errs by that times the edge's distance, over all weight. Steps along x and along y both sample
// the whole border, so half of the sum counts. Each axis has half of that.
static double spot_variance(const struct spot *s, const struct window *w)
{
    const double x = s->x / s->weight - w->x, y = s->y / s->weight - w->y;
    const double square =
        s->step_square - 2.0 * (x * s->step_x + y * s->step_y) + (x * x + y * y) * s->step;
    return fmax(square, 0.0) / 48.0 / (s->weight * s->weight);
}

// Standard error of a direction, degrees, at a surface of cosine c. An error e of
// the spot turns the reflected direction by 2 e / (r c) away from the axis of view. Around that
// axis it turns by 2 e c / r. An error of the radius counts by the spot's share of the radius, away
// from the axis alone. The radius has half the variance of the middle.
static double direction_sigma(const struct relume_ball *ball, double c, double spot)
{
    const double outline = ball->sigma * ball->sigma, sine2 = fmax(1.0 - c * c, 0.0);
    const double around = spot + outline, away = around + 0.5 * sine2 * outline;
    const double cosine2 = fmax(c * c, 4e-4);
    return 2.0 / ball->radius * sqrt(away / cosine2 + around * cosine2) * 180.0 / M_PI;
}

static struct relume_ball_light describe(const struct spot *s, const struct window *w,
                                         const struct relume_ball *ball,
                                         const struct relume_ball_camera *camera)
{
    struct relume_ball_light light = {.x = s->x / s->weight, .y = s->y / s->weight};
    vec3 n, v;
    const vec3 mean = vec3_scale(s->sum, 1.0 / s->weight);
    const double length = fmin(vec3_length(mean), 1.0);
    ball_normal(&n, &v, ball, camera, light.x, light.y);
    light.direction = vec3_unit(mean);
    light.origin = n;
    light.spread_deg = sqrt(2.0 * (1.0 - length)) * 180.0 / M_PI;
    light.sigma_deg = direction_sigma(ball, vec3_dot(n, v), spot_variance(s, w));
    return light;
}

static struct relume_ball_light look(struct window *w, const struct relume_ball *ball,
                                     const struct relume_ball_camera *camera)
{
    const float peak = find_peak(w, ball, camera);
    w->threshold = 0.5f * peak;
    if (peak < DARK)
        return (struct relume_ball_light){.finding = RELUME_BALL_DARK};
    if (mark_lit(w, ball, camera) > FULL)
        return (struct relume_ball_light){.finding =
                                              peak < BRIGHT ? RELUME_BALL_DARK : RELUME_BALL_FULL};
    struct spot spot[2];
    find_spots(w, ball, camera, spot);
    if (!(spot[0].weight > 0.0))
        return (struct relume_ball_light){.finding = RELUME_BALL_DARK};
    struct relume_ball_light light = describe(&spot[0], w, ball, camera);
    if (ball_distance(ball, camera, light.x, light.y) > (RIM - 1.0) * ball->radius)
        light.finding = RELUME_BALL_RIM;
    else if (spot[1].weight > SECOND * spot[0].weight)
        light.finding = RELUME_BALL_TWO;
    return light;
}

relume_status relume_ball_mirror(struct relume_ball_light *out, const struct relume_ball *ball,
                                 const struct relume_ball_camera *camera,
                                 const struct relume_image *photograph,
                                 const struct relume_image *still)
{
    struct window w;
    *out = (struct relume_ball_light){.finding = RELUME_BALL_DARK};
    if (!cut_window(&w, ball, photograph))
        return RELUME_OK;
    const size_t pixels = (size_t)w.width * (size_t)w.height;
    w.still = still;
    w.todo = mem_array(pixels, 1);
    w.stack = mem_array(pixels, sizeof *w.stack);
    const relume_status status = w.todo && w.stack ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        *out = look(&w, ball, camera);
    mem_free(w.todo);
    mem_free(w.stack);
    return status;
}
