// trace.c - rays against triangles; the only door to Embree
#include "mesh/trace.h"

#include "base/log.h"
#include "base/memory.h"

#include <embree3/rtcore.h>
#include <string.h>

struct tracer {
    RTCDevice device;
    RTCScene scene;
};

// `stride` * `count` bytes of ours, shared with Embree, which reads 16 bytes at each position: the
// last one has its normal behind it.
static void share(RTCGeometry g, enum RTCBufferType type, enum RTCFormat format, const void *data,
                  size_t stride, size_t count)
{
    rtcSetSharedGeometryBuffer(g, type, 0, format, data, 0, stride, count);
}

static void build(tracer *t, const struct mesh *mesh)
{
    t->scene = rtcNewScene(t->device);
    rtcSetSceneFlags(t->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(t->scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    share(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh->vertices, sizeof *mesh->vertices,
          mesh->vertex_count);
    share(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh->triangles, sizeof *mesh->triangles,
          mesh->triangle_count);
    rtcCommitGeometry(g);
    rtcAttachGeometry(t->scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(t->scene);
}

relume_status trace_create(tracer **out, const struct mesh *mesh, const struct relume_log *log)
{
    *out = NULL;
    tracer *t = mem_zeroed(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
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
    build(t, mesh);
    if (rtcGetDeviceError(t->device) != RTC_ERROR_NONE) {
        trace_destroy(&t);
        return RELUME_ENOMEM;
    }
    *out = t;
    return RELUME_OK;
}

void trace_destroy(tracer **t)
{
    if (*t && (*t)->scene)
        rtcReleaseScene((*t)->scene);
    if (*t && (*t)->device)
        rtcReleaseDevice((*t)->device);
    mem_free(*t);
    *t = NULL;
}

bool trace_closest(const tracer *t, const float origin[3], const float direction[3],
                   struct trace_hit *hit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
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
    rtcIntersect1(t->scene, &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = (struct trace_hit){r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar};
    return true;
}

enum { PACKET = 16 };

static void packet_unblocked(const tracer *t, float (*origins)[3], int count,
                             const float direction[3], bool *seen)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    struct RTCRay16 ray;
    _Alignas(64) int valid[PACKET];
    for (int i = 0; i < PACKET; i++) {
        const float *origin = origins[i < count ? i : 0];
        valid[i] = i < count ? -1 : 0;
        ray.org_x[i] = origin[0], ray.org_y[i] = origin[1], ray.org_z[i] = origin[2];
        ray.dir_x[i] = direction[0], ray.dir_y[i] = direction[1], ray.dir_z[i] = direction[2];
        ray.tnear[i] = 0.0f, ray.tfar[i] = INFINITY;
        ray.time[i] = 0.0f, ray.mask[i] = ~0u, ray.id[i] = 0, ray.flags[i] = 0;
    }
    rtcOccluded16(valid, t->scene, &context, &ray);
    for (int i = 0; i < count; i++)
        seen[i] = ray.tfar[i] >= 0.0f;  // Embree marks a blocked ray by -inf
}

void trace_unblocked(const tracer *t, float (*origins)[3], int count, const float direction[3],
                     bool *seen)
{
    for (int i = 0; i < count; i += PACKET)
        packet_unblocked(t, origins + i, count - i < PACKET ? count - i : PACKET, direction,
                         seen + i);
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
