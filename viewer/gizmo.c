#include "gizmo.h"

#include "lamps.h"

#include <math.h>

static const double grip = 10.0;  // pixels around a handle that count as on it

struct gizmo_circle gizmo_disc(const struct app *app)
{
    return (struct gizmo_circle){
        .x = 0.5 * app->width,
        .y = 0.5 * app->height,
        .radius = 0.42 * fmin(app->width, app->height),
    };
}

static bool place_direction(struct gizmo *out, const struct app *app, int light)
{
    const struct gizmo_circle disc = gizmo_disc(app);
    const struct relume_vec3 d = app_seen_light(app, light);
    *out = (struct gizmo){
        .x = disc.x + disc.radius * d.x,
        .y = disc.y - disc.radius * d.y,
        .behind = d.z < 0,
    };
    return true;
}

bool gizmo_of(struct gizmo *out, const struct app *app, int light)
{
    return place_direction(out, app, light);
}

int gizmo_hit(const struct app *app, double x, double y)
{
    int best = -1;
    double nearest = grip;
    for (int i = 0; i < app->now.lights; i++) {
        struct gizmo g;
        if (!gizmo_of(&g, app, i))
            continue;
        const double far = hypot(g.x - x, g.y - y);
        if (far < nearest) {
            nearest = far;
            best = i;
        }
    }
    return best;
}

static void drag_direction(struct app *app, int light, double x, double y)
{
    const struct gizmo_circle disc = gizmo_disc(app);
    const double side = app_seen_light(app, light).z < 0 ? -1 : 1;
    double dx = (x - disc.x) / disc.radius;
    double dy = (disc.y - y) / disc.radius;
    const double r = fmax(hypot(dx, dy), 1.0);
    dx /= r;
    dy /= r;
    const double z = sqrt(fmax(1 - dx * dx - dy * dy, 0));
    app_aim_light(app, light, (struct relume_vec3){dx, dy, side * z});
}

void gizmo_drag(struct app *app, int light, double x, double y)
{
    drag_direction(app, light, x, y);
}
