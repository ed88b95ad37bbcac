// rays.c - where lamps stand, by rays from several balls
//
// A ball at b from the balls' middle turns its ray by |b'| dr / r^2 when a lamp at the distance r
// moves away by dr. Here b' is across its direction. So log r has the variance
// s^2 r^2 / sum |b'|^2 for an error s of rays. Lamps of a dome scatter less. Therefore log r
// shrinks to its mean by as much as noise explains (Efron, Morris 1975).
#include "capture/acquire/rays.h"

#include "capture/acquire/ball.h"
#include "core/math/vec.h"

// The F ratio of both models for two balls and noise alone stays below 4 from 6 photographs on.
static const double CLEARLY = 6.0;
static const double LEAST_PARALLAX = 0.5 * M_PI / 180.0;  // radians: less turns no surface visibly
static const double FAR = 20.0;                           // world units: ten widths of the picture

static vec3 mean_origin(const struct ball_rays *r)
{
    vec3 sum = vec3_of(0.0, 0.0, 0.0);
    for (int b = 0; b < r->n; b++)
        sum = vec3_along(sum, r->origin[b], 1.0 / r->n);
    return sum;
}

static vec3 mean_direction(const struct ball_rays *r)
{
    vec3 sum = vec3_of(0.0, 0.0, 0.0);
    for (int b = 0; b < r->n; b++)
        sum = vec3_add(sum, r->direction[b]);
    return vec3_unit(sum);
}

static bool meet(vec3 *point, const struct ball_rays *r)
{
    double sigma;
    return r->n > 1 && !relume_light_triangulate(point, &sigma, r->origin, r->direction, r->n);
}

// Sum of squared angles between rays and the directions to a lamp; NULL: their mean direction.
static double miss_squares(const struct ball_rays *r, const vec3 *lamp)
{
    const vec3 mean = mean_direction(r);
    double sum = 0.0;
    for (int b = 0; b < r->n; b++) {
        const vec3 to = lamp ? vec3_unit(vec3_sub(*lamp, r->origin[b])) : mean;
        sum += pow(vec3_angle(to, r->direction[b]), 2.0);
    }
    return sum;
}

struct rays_fit rays_compare(const struct ball_rays *rays, int photographs)
{
    double distant = 0.0, near = 0.0, distant_freedom = 0.0, near_freedom = 0.0, logs = 0.0;
    int met = 0;
    for (int i = 0; i < photographs; i++) {
        const struct ball_rays *r = &rays[i];
        vec3 point;
        if (r->n < 2)
            continue;
        const bool meets = meet(&point, r);
        const double parallel = miss_squares(r, NULL);
        distant += parallel;
        distant_freedom += 2.0 * r->n - 2.0;
        near += meets ? miss_squares(r, &point) : parallel;
        near_freedom += 2.0 * r->n - (meets ? 3.0 : 2.0);
        logs += meets ? log(vec3_length(vec3_sub(point, mean_origin(r)))) : 0.0;
        met += meets;
    }
    return (struct rays_fit){
        .distant = distant_freedom > 0.0 ? sqrt(distant / distant_freedom) : 0.0,
        .near = near_freedom > 0.0 ? sqrt(near / near_freedom) : 0.0,
        .distance = met ? exp(logs / met) : 0.0,
    };
}

bool rays_show_near(const struct rays_fit *fit)
{
    return fit->distance > 0.0 && fit->distance < FAR && fit->distant > LEAST_PARALLAX &&
           fit->distant * fit->distant > CLEARLY * fit->near * fit->near;
}

// Logarithm of a lamp's distance and its variance.
struct distance {
    double log, variance;  // infinite: not known
};

static struct distance find_distance(const struct ball_rays *r, double sigma)
{
    const vec3 middle = mean_origin(r), along = mean_direction(r);
    double across = 0.0;
    vec3 point;
    if (!meet(&point, r))
        return (struct distance){0.0, INFINITY};
    const double far = vec3_length(vec3_sub(point, middle));
    for (int b = 0; b < r->n; b++) {
        const vec3 arm = vec3_sub(r->origin[b], middle);
        const double shadow = vec3_dot(arm, along);
        across += fmax(vec3_dot(arm, arm) - shadow * shadow, 0.0);
    }
    return (struct distance){log(far), across > 0.0 ? pow(sigma * far, 2.0) / across : INFINITY};
}

// Mean and variance of the lamps' true distances, without noise.
static struct distance find_spread(const struct ball_rays *rays, int photographs, double sigma)
{
    struct distance mean = {0.0, 0.0};
    for (int round = 0; round < 20; round++) {
        double weight = 0.0, sum = 0.0, excess = 0.0;
        for (int i = 0; i < photographs; i++) {
            const struct distance d = find_distance(&rays[i], sigma);
            const double w = isinf(d.variance) ? 0.0 : 1.0 / (d.variance + mean.variance + 1e-12);
            weight += w;
            sum += w * d.log;
            excess += w > 0.0 ? w * (pow(d.log - mean.log, 2.0) - d.variance) : 0.0;
        }
        if (!(weight > 0.0))
            return (struct distance){0.0, INFINITY};
        mean.variance = round ? fmax(excess / weight, 0.0) : 0.0;
        mean.log = sum / weight;
    }
    return mean;
}

bool rays_place(vec3 *position, double *sigma, const struct ball_rays *rays, int photographs,
                double error)
{
    const struct distance mean = find_spread(rays, photographs, error);
    if (isinf(mean.variance))
        return false;
    for (int i = 0; i < photographs; i++) {
        const struct distance own = find_distance(&rays[i], error);
        const double share = isinf(own.variance) ? 0.0
                             : own.variance <= 1e-12
                                 ? 1.0
                                 : mean.variance / (mean.variance + own.variance);
        const double far = exp(mean.log + share * (own.log - mean.log));
        const double radial = isinf(own.variance) ? mean.variance : share * own.variance;
        vec3 point, along = mean_direction(&rays[i]);
        const vec3 middle = mean_origin(&rays[i]);
        if (meet(&point, &rays[i]))
            along = vec3_unit(vec3_sub(point, middle));
        position[i] = vec3_along(middle, along, far);
        sigma[i] = far * sqrt(radial + 2.0 * error * error / rays[i].n);
    }
    return true;
}
