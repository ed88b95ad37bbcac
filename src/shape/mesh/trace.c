// trace.c - rays against triangles; the only door to Embree
#include "shape/mesh/trace.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <string.h>

// What the parts of the scene are, by their numbers.
struct base {
    size_t first;                     // triangle of the mesh
    const struct trace_cloud *cloud;  // NULL: triangles
    const struct trace_holes *holes;  // NULL: none
};

struct tracer {
    RTCDevice device;
    RTCScene scene;
    struct trace_cloud *cloud;
    struct base *base;
    struct trace_holes holes;  // zeroed: none
};

// Embree hands it to filters.
struct query {
    struct RTCIntersectContext context;  // first
    bool layers;
};

static struct query begin(bool layers)
{
    struct query q = {.layers = layers};
    rtcInitIntersectContext(&q.context);
    return q;
}

// `stride` * `count` bytes of ours, shared with Embree, which reads 16 bytes at each position: the
// last one has its normal behind it.
static void share(RTCGeometry g, enum RTCBufferType type, enum RTCFormat format, const void *data,
                  size_t stride, size_t count)
{
    rtcSetSharedGeometryBuffer(g, type, 0, format, data, 0, stride, count);
}

// As `let_through` below has it; directions are in rows 4 to 6 of the ray.
static void let_through_holes(const struct RTCFilterFunctionNArguments *args)
{
    const struct base *const b = args->geometryUserPtr;
    const struct query *const q = (const struct query *)args->context;
    const float *const ray = (const void *)args->ray, *const hit = (const void *)args->hit;
    const unsigned *const numbers = (const void *)args->hit;
    const size_t n = args->N;
    for (size_t i = 0; i < n; i++) {
        const float direction[3] = {ray[4 * n + i], ray[5 * n + i], ray[6 * n + i]};
        if (args->valid[i] &&
            b->holes->let_through(b->holes->context, (uint32_t)b->first + numbers[5 * n + i],
                                  hit[3 * n + i], hit[4 * n + i], direction, q->layers))
            args->valid[i] = 0;
    }
}

// Triangles `first` to `first + count` of the mesh.
static void add_triangles(tracer *t, const struct mesh *mesh, size_t first, size_t count)
{
    if (!count)
        return;
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    share(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh->vertices, sizeof *mesh->vertices,
          mesh->vertex_count);
    share(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh->triangles + first,
          sizeof *mesh->triangles, count);
    struct base *base = &t->base[rtcAttachGeometry(t->scene, g)];
    *base = (struct base){first, NULL, t->holes.let_through ? &t->holes : NULL};
    if (base->holes) {
        rtcSetGeometryUserData(g, base);
        rtcSetGeometryIntersectFilterFunction(g, let_through_holes);
        rtcSetGeometryOccludedFilterFunction(g, let_through_holes);
    }
    rtcCommitGeometry(g);
    rtcReleaseGeometry(g);
}

static const struct relume_billboard_texel *texel_at(const struct relume_billboards *cloud,
                                                     unsigned number, float u, float v)
{
    const struct relume_billboard *const b = &cloud->billboard[number];
    const int x = (int)fminf(fmaxf(u, 0.0f) * (float)b->width, (float)(b->width - 1));
    const int y = (int)fminf(fmaxf(v, 0.0f) * (float)b->height, (float)(b->height - 1));
    return &cloud->texel[b->first + (size_t)y * (size_t)b->width + (size_t)x];
}

// Rays pass through what is mostly empty, and through planes that they begin on. Of N rays Embree
// gives each number in a row of N: places in rows 0 to 2, what they hit by u, v and number in rows
// 3 to 5.
static void let_through(const struct RTCFilterFunctionNArguments *args)
{
    const struct trace_cloud *const c = args->geometryUserPtr;
    const float *const ray = (const void *)args->ray, *const hit = (const void *)args->hit;
    const unsigned *const numbers = (const void *)args->hit;
    const size_t n = args->N;
    for (size_t i = 0; i < n; i++) {
        if (!args->valid[i])
            continue;
        const unsigned number = numbers[5 * n + i];
        const struct relume_billboard *const b = &c->cloud->billboard[number];
        float off = 0.0f;
        for (size_t k = 0; k < 3; k++)
            off += (ray[k * n + i] - b->corner[k]) * b->normal[k];
        const struct relume_billboard_texel *const t =
            texel_at(c->cloud, number, hit[3 * n + i], hit[4 * n + i]);
        if (t->coverage < 0.5f || fabsf(off) <= c->slack)
            args->valid[i] = 0;
    }
}

static bool add_cloud(tracer *t, const struct trace_cloud *c)
{
    enum { CORNERS = 4 };
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_QUAD);
    float(*const corner)[3] = rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof *corner, CORNERS * c->cloud->count);
    unsigned *const number = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                                     CORNERS * sizeof *number, c->cloud->count);
    for (size_t i = 0; corner && number && i < CORNERS * c->cloud->count; i++) {
        const struct relume_billboard *const b = &c->cloud->billboard[i / CORNERS];
        const float x = (float)(i % CORNERS == 1 || i % CORNERS == 2 ? b->width : 0);
        const float y = (float)(i % CORNERS >= 2 ? b->height : 0);
        for (int k = 0; k < 3; k++)
            corner[i][k] = b->corner[k] + c->cloud->side * (x * b->across[k] + y * b->up[k]);
        number[i] = (unsigned)i;
    }
    rtcSetGeometryUserData(g, (void *)c);
    rtcSetGeometryIntersectFilterFunction(g, let_through);
    rtcSetGeometryOccludedFilterFunction(g, let_through);
    rtcCommitGeometry(g);
    t->base[rtcAttachGeometry(t->scene, g)] = (struct base){c->first, c, NULL};
    rtcReleaseGeometry(g);
    return corner && number;
}

static bool build(tracer *t, const struct mesh *mesh, int clouds)
{
    size_t done = 0;
    bool good = true;
    t->scene = rtcNewScene(t->device);
    rtcSetSceneFlags(t->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(t->scene, RTC_BUILD_QUALITY_HIGH);
    for (int i = 0; i < clouds && good; i++) {
        add_triangles(t, mesh, done, t->cloud[i].first - done);
        good = add_cloud(t, &t->cloud[i]);
        done = t->cloud[i].first + t->cloud[i].count;
    }
    add_triangles(t, mesh, done, mesh->triangle_count - done);
    rtcCommitScene(t->scene);
    return good && rtcGetDeviceError(t->device) == RTC_ERROR_NONE;
}

relume_status trace_create_clouds(tracer **out, const struct mesh *mesh,
                                  const struct trace_cloud *cloud, int n,
                                  const struct trace_holes *holes, const struct relume_log *log)
{
    *out = NULL;
    tracer *t = mem_zeroed(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
    t->cloud = mem_array((size_t)n, sizeof *t->cloud);
    t->base = mem_array(2 * (size_t)n + 1, sizeof *t->base);
    if (!t->cloud || !t->base) {
        trace_destroy(&t);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < n; i++)
        t->cloud[i] = cloud[i];
    if (holes)
        t->holes = *holes;
    // One thread builds: the tree, and with it every tie between equal hits, is always the same.
    t->device = rtcNewDevice("threads=1");
    if (!t->device) {
        const relume_status status = log_fail(
            log, RELUME_ESYSTEM, "the ray tracer Embree cannot be used; %s",
            rtcGetDeviceError(NULL) == RTC_ERROR_UNSUPPORTED_CPU ? "this processor is not supported"
                                                                 : "it does not start");
        trace_destroy(&t);
        return status;
    }
    if (!build(t, mesh, n)) {
        trace_destroy(&t);
        return RELUME_ENOMEM;
    }
    *out = t;
    return RELUME_OK;
}

relume_status trace_create(tracer **out, const struct mesh *mesh, const struct relume_log *log)
{
    return trace_create_clouds(out, mesh, NULL, 0, NULL, log);
}

void trace_destroy(tracer **t)
{
    if (*t && (*t)->scene)
        rtcReleaseScene((*t)->scene);
    if (*t && (*t)->device)
        rtcReleaseDevice((*t)->device);
    if (*t) {
        mem_free((*t)->cloud);
        mem_free((*t)->base);
    }
    mem_free(*t);
    *t = NULL;
}

// What a texel shows takes the place of the billboard.
static struct trace_hit hit_of(const tracer *t, const struct RTCRayHit *r)
{
    const struct base base = t->base[r->hit.geomID];
    if (!base.cloud)
        return (struct trace_hit){(uint32_t)base.first + r->hit.primID, r->hit.u, r->hit.v,
                                  r->ray.tfar, 0};
    const struct relume_billboards *const cloud = base.cloud->cloud;
    const struct relume_billboard_texel *const texel =
        texel_at(cloud, r->hit.primID, r->hit.u, r->hit.v);
    const float *const n = cloud->billboard[r->hit.primID].normal;
    const bool before = r->ray.dir_x * n[0] + r->ray.dir_y * n[1] + r->ray.dir_z * n[2] <= 0.0f;
    return (struct trace_hit){(uint32_t)base.first + texel->triangle, texel->weight[0],
                              texel->weight[1], r->ray.tfar, before ? 1 : -1};
}

static bool closest(const tracer *t, const float origin[3], const float direction[3], bool layers,
                    struct trace_hit *hit)
{
    struct query query = begin(layers);
    struct RTCRayHit r = {
        .ray = {.org_x = origin[0],
                .org_y = origin[1],
                .org_z = origin[2],
                .dir_x = direction[0],
                .dir_y = direction[1],
                .dir_z = direction[2],
                .tfar = INFINITY,
                .mask = ~0u},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID},
    };
    rtcIntersect1(t->scene, &query.context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = hit_of(t, &r);
    return true;
}

bool trace_closest(const tracer *t, const float origin[3], const float direction[3],
                   struct trace_hit *hit)
{
    return closest(t, origin, direction, false, hit);
}

bool trace_layer(const tracer *t, const float origin[3], const float direction[3],
                 struct trace_hit *hit)
{
    return closest(t, origin, direction, true, hit);
}

bool trace_lets_through(const tracer *t, uint32_t triangle, float u, float v,
                        const float direction[3])
{
    return t->holes.let_through &&
           t->holes.let_through(t->holes.context, triangle, u, v, direction, false);
}

enum { PACKET = 16 };

// Rays along `end`, or to it: their length is 1 there.
static void packet_unblocked(const tracer *t, float (*origins)[3], int count, const float end[3],
                             bool is_place, bool *seen)
{
    struct query query = begin(false);
    query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    struct RTCRay16 ray;
    _Alignas(64) int valid[PACKET];
    for (int i = 0; i < PACKET; i++) {
        const float *origin = origins[i < count ? i : 0];
        valid[i] = i < count ? -1 : 0;
        ray.org_x[i] = origin[0], ray.org_y[i] = origin[1], ray.org_z[i] = origin[2];
        ray.dir_x[i] = is_place ? end[0] - origin[0] : end[0];
        ray.dir_y[i] = is_place ? end[1] - origin[1] : end[1];
        ray.dir_z[i] = is_place ? end[2] - origin[2] : end[2];
        ray.tnear[i] = 0.0f, ray.tfar[i] = is_place ? 1.0f : INFINITY;
        ray.time[i] = 0.0f, ray.mask[i] = ~0u, ray.id[i] = 0, ray.flags[i] = 0;
    }
    rtcOccluded16(valid, t->scene, &query.context, &ray);
    for (int i = 0; i < count; i++)
        seen[i] = ray.tfar[i] >= 0.0f;  // Embree marks a blocked ray by -inf
}

static void unblocked(const tracer *t, float (*origins)[3], int count, const float end[3],
                      bool is_place, bool *seen)
{
    for (int i = 0; i < count; i += PACKET)
        packet_unblocked(t, origins + i, count - i < PACKET ? count - i : PACKET, end, is_place,
                         seen + i);
}

void trace_unblocked(const tracer *t, float (*origins)[3], int count, const float direction[3],
                     bool *seen)
{
    unblocked(t, origins, count, direction, false, seen);
}

void trace_seen(const tracer *t, float (*origins)[3], int count, const float to[3], bool *seen)
{
    unblocked(t, origins, count, to, true, seen);
}

void trace_leave(const float p[3], const float normal[3], float out[3])
{
    const float near_zero = 1.0f / 32.0f;  // where steps of the own spacing get too short
    const float fixed_step = 1.0f / 65536.0f;
    const float spacings = 256.0f;
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(p[c]) >= near_zero)) {
            out[c] = p[c] + fixed_step * normal[c];
            continue;
        }
        const int32_t steps = relume_whole(spacings * normal[c]);
        int32_t bits;
        memcpy(&bits, &p[c], sizeof bits);
        bits += p[c] < 0.0f ? -steps : steps;
        memcpy(&out[c], &bits, sizeof bits);
    }
}
