// instant.c - light gathered from virtual lights
//
// 1. Virtual lights are drawn on the scene. 2. Each gets two shadow maps: of the scene before it,
// and of the objects' ball. 3. Places spread over the objects gather from them, and virtual lights
// are drawn from what these send; they light each other as often as there are bounces. 4. Every
// site gathers from a part of all lights, its neighbours from the others ("interleaved sampling":
// Keller and Heidrich 2001), and means over neighbours put them together.
//
// Where no object is in the way, `with` is the same number as `without`.
#include "world/transport/instant.h"

#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"

// A map draws a point for so many of its texels.
enum { POINTS = 4 };
enum { SCENE_POINTS = 1 << 16, OBJECT_POINTS = 1 << 14 };

// ---------------------------------------------------------------- what is in the way

static bool is_open_by_rays(bool *past_objects, const struct world *w,
                            const struct virtual_light *light, const struct site *site,
                            const struct sight *sight)
{
    const double SHORT = 1.0 - 1e-4;  // of what lies at the light
    float from[3], along[3];
    struct trace_hit hit;
    const double distance = SHORT * sight->distance;
    const vec3 at = site->start, to = sight->towards;
    (void)light;
    if (!scenery_reached(w->scenery, at, to, distance))
        return false;
    from[0] = (float)at.x, from[1] = (float)at.y, from[2] = (float)at.z;
    along[0] = (float)to.x, along[1] = (float)to.y, along[2] = (float)to.z;
    *past_objects =
        !trace_closest(w->objects, from, along, &hit) || (double)hit.distance >= distance;
    return true;
}

// False: the scene hides the light.
static bool is_open(bool *past_objects, const struct world *w, const struct instant *s, size_t i,
                    const struct site *site, const struct sight *sight)
{
    if (s->params.rays)
        return is_open_by_rays(past_objects, w, &s->light[i], site, sight);
    if (!maps_open(&s->of_scene, i, site->position, site->normal))
        return false;
    *past_objects = maps_open(&s->of_objects, i, site->position, site->normal);
    return true;
}

static void gather_one(const struct world *w, const struct instant *s, const struct site *site,
                       size_t i, double times, take_arrival *arrive, void *context)
{
    const struct virtual_light *light = &s->light[i];
    struct sight sight;
    bool past = true;
    if (!virtual_sight(&sight, light, site) || !is_open(&past, w, s, i, site, &sight))
        return;
    struct arrival a = {.towards = sight.towards, .share = sight.share * times};
    for (int c = 0; c < 3; c++) {
        a.without[c] = light->without[c];
        a.with[c] = past ? light->with[c] : 0.0f;
    }
    arrive(context, &a);
}

enum { TOGETHER = 16 };

// Which of some lights are near, as positive numbers; whether any is.
static bool find_near(float near[TOGETHER], const struct instant *s, const float at[3],
                      size_t first)
{
    const float *x = s->reach[0] + first, *y = s->reach[1] + first, *z = s->reach[2] + first,
                *reach = s->reach[3] + first;
    float most = 0.0f;
    for (size_t k = 0; k < TOGETHER; k++) {
        const float dx = x[k] - at[0], dy = y[k] - at[1], dz = z[k] - at[2];
        near[k] = reach[k] - (dx * dx + dy * dy + dz * dz);
    }
    for (size_t k = 0; k < TOGETHER; k++)
        most = near[k] > most ? near[k] : most;
    return most > 0.0f;
}

void instant_gather(const struct world *w, const struct site *site, take_arrival *arrive,
                    void *context)
{
    const struct instant *s = w->state;
    const size_t step = (size_t)s->params.pattern * (size_t)s->params.pattern;
    const float at[3] = {(float)site->start.x, (float)site->start.y, (float)site->start.z};
    size_t own = site->key % step;
    for (size_t first = 0; first < s->lights; first += TOGETHER) {
        float near[TOGETHER];
        const bool any = find_near(near, s, at, first);
        for (size_t i = first; any && i < first + TOGETHER && i < s->lights; i++)
            if (near[i - first] > 0.0f)
                gather_one(w, s, site, i, 1.0, arrive, context);
        for (; own < first + TOGETHER && own < s->lights; own += step)
            if (!(near[own - first] > 0.0f))
                gather_one(w, s, site, own, (double)step, arrive, context);
    }
}

static void set_reach(struct instant *s, size_t first, size_t end)
{
    const int step = s->params.pattern * s->params.pattern;
    for (size_t i = first; i < end; i++) {
        const struct virtual_light *v = &s->light[i];
        s->reach[0][i] = (float)v->place.x;
        s->reach[1][i] = (float)v->place.y;
        s->reach[2][i] = (float)v->place.z;
        s->reach[3][i] = v->far || step == 1 ? 0.0f : (float)(step * v->size / M_PI);
    }
}

// Senders gather from every `step`-th of the lights from `first` on.
static void gather_some(const struct world *w, const struct instant *s, const struct site *site,
                        size_t first, size_t end, size_t step, take_arrival *arrive, void *context)
{
    for (size_t i = first; i < end; i += step)
        gather_one(w, s, site, i, (double)step, arrive, context);
}

// ---------------------------------------------------------------- maps

static vec3 middle_of(const struct world *w)
{
    const struct bounds b = mesh_bounds(w->mesh);
    return vec3_scale(vec3_add(b.min, b.max), 0.5);
}

static void look(struct instant *s, const struct world *w, size_t i, vec3 middle)
{
    const struct virtual_light *v = &s->light[i];
    const double WIDER = 1.02;  // than the ball about the objects
    if (v->far) {
        s->of_scene.look[i] = map_of_far(v->normal, middle, 4.0 * w->radius);
        s->of_objects.look[i] = map_of_far(v->normal, middle, w->radius);
    } else {
        s->of_scene.look[i] = map_of_hemisphere(v->place, v->normal);
        s->of_objects.look[i] = map_of_ball(v->place, v->normal, middle, WIDER * w->radius);
    }
}

static relume_status draw_some(struct maps *m, size_t first, size_t end,
                               const struct points *points, const struct instant_params *p,
                               int threads)
{
    const size_t texels = (size_t)m->size * (size_t)m->size;
    struct maps some = {m->look + first, m->depth + first * texels, end - first, m->size, 0.0};
    const relume_status status = maps_draw(
        &some, points,
        &(struct maps_params){.points = p->points, .unfilled = p->unfilled, .threads = threads});
    m->square = some.square;
    return status;
}

static relume_status draw_maps(struct instant *s, const struct world *w, size_t first, size_t end)
{
    const double began = processor_s();
    if (s->params.rays || first == end)
        return RELUME_OK;
    const vec3 middle = middle_of(w);
    for (size_t i = first; i < end; i++)
        look(s, w, i, middle);
    relume_status status = draw_some(&s->of_scene, first, end, &s->scene, &s->params, w->threads);
    if (!status)
        status = draw_some(&s->of_objects, first, end, &s->objects, &s->params, w->threads);
    s->seconds[INSTANT_MAPS] += processor_s() - began;
    return status;
}

static relume_status make_maps(struct maps *m, size_t lights, int size)
{
    *m = (struct maps){.count = lights, .size = size};
    m->look = mem_zeroed(lights, sizeof *m->look);
    m->depth = mem_array(lights * (size_t)size * (size_t)size, sizeof *m->depth);
    return m->look && m->depth ? RELUME_OK : RELUME_ENOMEM;
}

static void forget_maps(struct maps *m)
{
    mem_free(m->look);
    mem_free(m->depth);
}

// ---------------------------------------------------------------- bounces

struct bounce {
    const struct world *w;
    const struct instant *s;
    struct sender *sender;
    size_t senders;
    bool failed;
};

struct arrivals {
    struct arrival *at;
    int n, most;
};

static void collect_arrival(void *context, const struct arrival *a)
{
    struct arrivals *to = context;
    if (to->n < to->most && (a->with[0] > 0.0f || a->with[1] > 0.0f || a->with[2] > 0.0f))
        to->at[to->n++] = *a;
}

enum { GATHERED = 128 };  // of the lights of the scene, and of the objects, at each sender

static size_t step_of(size_t lights)
{
    return (lights + GATHERED - 1) / GATHERED;
}

static void gather_at_sender(void *context, size_t i, int worker)
{
    (void)worker;
    const struct bounce *b = context;
    const struct instant *s = b->s;
    struct sender *sender = &b->sender[i];
    struct arrival arrival[2 * GATHERED];
    struct arrivals arrivals = {arrival, 0, 2 * GATHERED};
    const uint64_t key = random_mix(i);
    const size_t a = step_of(s->on_scene), on_objects = s->lights - s->on_scene;
    if (a)
        gather_some(b->w, s, &sender->site, key % a, s->on_scene, a, collect_arrival, &arrivals);
    const size_t c = step_of(on_objects);
    if (c)
        gather_some(b->w, s, &sender->site, s->on_scene + key % c, s->lights, c, collect_arrival,
                    &arrivals);
    if (sender->site.shines)
        points_object_mean(sender->sent, b->w, &sender->point, key, arrival, arrivals.n);
    else
        points_object_sent(sender->sent, b->w, &sender->point, key, arrival, arrivals.n);
}

static void send(const struct bounce *b, struct instant *s, const size_t *number)
{
    for (size_t i = s->on_scene; i < s->lights; i++)
        for (int c = 0; c < 3; c++)
            s->light[i].with[c] = fmaxf(b->sender[number[i - s->on_scene]].sent[c], 0.0f);
}

// `count` lights on the objects, behind those of the scene. What is found in further bounces is
// sent by the lights of the first.
static relume_status light_objects(struct instant *s, const struct world *w, size_t count)
{
    enum { SENDERS = 4 };  // for each light
    struct bounce b = {.w = w, .s = s};
    size_t *number = mem_array(count, sizeof *number), found = 0;
    relume_status status = number ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = virtual_senders(&b.sender, &b.senders, w, &s->objects, SENDERS * count);
    if (!status) {
        thread_for(w->threads, b.senders, gather_at_sender, &b);
        status =
            virtual_of_senders(s->light + s->on_scene, number, &found, b.sender, b.senders, count);
    }
    if (!status && found) {
        s->lights += found;
        send(&b, s, number);
        set_reach(s, s->on_scene, s->lights);
        status = draw_maps(s, w, s->on_scene, s->lights);
    }
    for (int i = 1; i < w->bounces && !status && found; i++) {
        thread_for(w->threads, b.senders, gather_at_sender, &b);
        send(&b, s, number);
    }
    mem_free(b.sender);
    mem_free(number);
    return status;
}

// ---------------------------------------------------------------- all of it

// The atlas of the paper holds 1024 maps of 128 x 128; here there are as many maps again, and a
// quarter of all that for lights on objects: at most 160 MB. Maps of 64 x 64 show as much as larger
// ones (docs/measurements/transport.md); many lights have smaller ones.
enum { ATLAS = 4096 * 4096 / 4 * 5, USUAL = 64, LEAST = 8 };

static int size_for(size_t lights)
{
    size_t size = USUAL;
    while (size > LEAST && lights * size * size > ATLAS)
        size /= 2;
    return (int)size;
}

static relume_status make_points(struct instant *s, const struct world *w)
{
    const double began = processor_s();
    relume_status status =
        s->params.rays ? RELUME_OK : points_of_scene(&s->scene, w->scenery, SCENE_POINTS);
    if (!status)
        status = points_of_objects(&s->objects, w->mesh, w->objects, OBJECT_POINTS, w->threads);
    s->seconds[INSTANT_POINTS] += processor_s() - began;
    return status;
}

static relume_status make_lights(struct instant *s, const struct world *w, size_t count,
                                 size_t on_objects)
{
    double began = processor_s();
    relume_status status = virtual_of_scene(s->light, &s->on_scene, w, count);
    s->lights = s->on_scene;
    s->seconds[INSTANT_LIGHTS] = processor_s() - began;
    if (status)
        return status;
    set_reach(s, 0, s->lights);
    status = draw_maps(s, w, 0, s->lights);
    began = processor_s() - s->seconds[INSTANT_MAPS];  // which go on there
    if (!status && w->bounces > 0)
        status = light_objects(s, w, on_objects);
    s->seconds[INSTANT_OBJECTS] = processor_s() - s->seconds[INSTANT_MAPS] - began;
    return status;
}

static relume_status allocate_maps(struct instant *s, size_t lights, const struct relume_log *log)
{
    const size_t maps = s->params.rays ? 0 : lights, side = (size_t)s->params.size;
    relume_status status = limits_memory(
        NULL, (uint64_t)lights * sizeof *s->light + 2 * maps * side * side * sizeof(float),
        "virtual lights", log);
    if (status)
        return status;
    s->light = mem_array(lights, sizeof *s->light);
    status = s->light ? RELUME_OK : RELUME_ENOMEM;
    for (int k = 0; k < 4 && !status; k++) {
        s->reach[k] = mem_zeroed(lights + TOGETHER, sizeof *s->reach[k]);
        status = s->reach[k] ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status)
        status = make_maps(&s->of_scene, maps, s->params.size);
    return status ? status : make_maps(&s->of_objects, maps, s->params.size);
}

static relume_status check_size(const struct instant *s, size_t each, const struct world *w,
                                size_t lights, const struct relume_log *log)
{
    const size_t side = (size_t)s->params.size;
    if (s->params.rays || s->params.size > LEAST || lights * side * side <= ATLAS)
        return RELUME_OK;
    return log_fail(log, RELUME_ELIMIT,
                    "%d samples are %zu virtual lights, which have no room for their shadow maps; "
                    "at most %zu samples, or --transport radiosity, which has no maps",
                    w->samples, each * (size_t)w->samples, ATLAS / 5 * 4 / (LEAST * LEAST) / each);
}

relume_status instant_begin(struct world *w, const struct instant_params *p,
                            const struct relume_log *log)
{
    const size_t each = (size_t)p->pattern * (size_t)p->pattern, samples = (size_t)w->samples;
    const size_t count = each * samples, on_objects = each * (samples / 4 ? samples / 4 : 1);
    struct instant *s = mem_zeroed(1, sizeof *s);
    w->state = s;
    if (!s)
        return RELUME_ENOMEM;
    s->params = *p;
    if (!p->size)
        s->params.size = size_for(count + on_objects);
    if (!p->points)
        s->params.points = (size_t)s->params.size * (size_t)s->params.size / POINTS;
    relume_status status = check_size(s, each, w, count + on_objects, log);
    if (!status)
        status = allocate_maps(s, count + on_objects, log);
    if (!status)
        status = make_points(s, w);
    return status ? status : make_lights(s, w, count, on_objects);
}

void instant_end(struct world *w)
{
    struct instant *s = w->state;
    w->state = NULL;
    if (!s)
        return;
    points_forget(&s->scene);
    points_forget(&s->objects);
    forget_maps(&s->of_scene);
    forget_maps(&s->of_objects);
    for (int k = 0; k < 4; k++)
        mem_free(s->reach[k]);
    mem_free(s->light);
    mem_free(s);
}
