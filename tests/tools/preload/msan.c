// msan.c - what MemorySanitizer has to be told of libraries that were not built for it
// (config=msan): Embree, libaom and dav1d, whose calls are linked to these (--wrap). Inside,
// nothing is checked; what they hand back counts as set.
#include <aom/aom_encoder.h>
#include <dav1d/dav1d.h>
#include <embree3/rtcore.h>
#include <ftw.h>
#include <sanitizer/msan_interface.h>

#define SET(object) __msan_unpoison(&(object), sizeof(object))
// `type name(parameters)` calls the library's with `arguments`; then `after`, which may use `r`.
#define WRAP(type, name, parameters, arguments, after)                                             \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        __msan_scoped_disable_interceptor_checks();                                                \
        type const r = __real_##name arguments;                                                    \
        __msan_scoped_enable_interceptor_checks();                                                 \
        after;                                                                                     \
        return r;                                                                                  \
    }
#define WRAP_VOID(name, parameters, arguments, after)                                              \
    void __real_##name parameters;                                                                 \
    void __wrap_##name parameters;                                                                 \
    void __wrap_##name parameters                                                                  \
    {                                                                                              \
        __msan_scoped_disable_interceptor_checks();                                                \
        __real_##name arguments;                                                                   \
        __msan_scoped_enable_interceptor_checks();                                                 \
        after;                                                                                     \
    }

WRAP(RTCDevice, rtcNewDevice, (const char *config), (config), (void)r)
WRAP_VOID(rtcReleaseDevice, (RTCDevice d), (d), (void)0)
WRAP_VOID(rtcCommitGeometry, (RTCGeometry g), (g), (void)0)
WRAP_VOID(rtcCommitScene, (RTCScene s), (s), (void)0)
WRAP_VOID(rtcReleaseScene, (RTCScene s), (s), (void)0)
WRAP_VOID(rtcIntersect1, (RTCScene s, struct RTCIntersectContext *c, struct RTCRayHit *ray),
          (s, c, ray), SET(*ray))
WRAP_VOID(rtcOccluded16,
          (const int *valid, RTCScene s, struct RTCIntersectContext *c, struct RTCRay16 *ray),
          (valid, s, c, ray), SET(*ray))

WRAP_VOID(dav1d_default_settings, (Dav1dSettings * s), (s), SET(*s))
WRAP(int, dav1d_open, (Dav1dContext * *c, const Dav1dSettings *s), (c, s), SET(*c))
WRAP_VOID(dav1d_close, (Dav1dContext * *c), (c), SET(*c))
WRAP(int, dav1d_data_wrap,
     (Dav1dData * data, const uint8_t *bytes, size_t size,
      void (*release)(const uint8_t *bytes, void *user), void *user),
     (data, bytes, size, release, user), SET(*data))
WRAP(int, dav1d_send_data, (Dav1dContext * c, Dav1dData *data), (c, data), SET(*data))

static void set_planes(Dav1dPicture *p)
{
    SET(*p);
    for (int i = 0; i < 3; i++) {
        const int below = i && p->p.layout == DAV1D_PIXEL_LAYOUT_I420;
        if (p->data[i])
            __msan_unpoison(p->data[i],
                            (size_t)p->stride[i > 0] * (size_t)((p->p.h + below) >> below));
    }
}
WRAP(int, dav1d_get_picture, (Dav1dContext * c, Dav1dPicture *p), (c, p), if (!r) set_planes(p))
WRAP_VOID(dav1d_picture_unref, (Dav1dPicture * p), (p), SET(*p))

WRAP(aom_codec_err_t, aom_codec_enc_config_default,
     (aom_codec_iface_t * codec, aom_codec_enc_cfg_t *c, unsigned usage), (codec, c, usage),
     SET(*c))
WRAP(aom_codec_err_t, aom_codec_enc_init_ver,
     (aom_codec_ctx_t * codec, aom_codec_iface_t *i, const aom_codec_enc_cfg_t *c,
      aom_codec_flags_t flags, int version),
     (codec, i, c, flags, version), SET(*codec))
WRAP(aom_codec_err_t, aom_codec_enc_config_set,
     (aom_codec_ctx_t * codec, const aom_codec_enc_cfg_t *c), (codec, c), SET(*codec))
WRAP(aom_image_t *, aom_img_alloc,
     (aom_image_t * image, aom_img_fmt_t format, unsigned width, unsigned height, unsigned align),
     (image, format, width, height, align), if (r) SET(*r))
WRAP(aom_codec_err_t, aom_codec_encode,
     (aom_codec_ctx_t * codec, const aom_image_t *image, aom_codec_pts_t at, unsigned long duration,
      aom_enc_frame_flags_t flags),
     (codec, image, at, duration, flags), SET(*codec))
WRAP(const aom_codec_cx_pkt_t *, aom_codec_get_cx_data,
     (aom_codec_ctx_t * codec, aom_codec_iter_t *at), (codec, at), {
         SET(*at);
         if (r) {
             SET(*(aom_codec_cx_pkt_t *)(uintptr_t)r);
             if (r->kind == AOM_CODEC_CX_FRAME_PKT)
                 __msan_unpoison(r->data.frame.buf, r->data.frame.sz);
         }
     })
WRAP(aom_codec_err_t, aom_codec_destroy, (aom_codec_ctx_t * codec), (codec), SET(*codec))

// The C library's own, which calls back with what it has set.
typedef int visit(const char *path, const struct stat *state, int type, struct FTW *place);
static visit *visitor;

static int visit_set(const char *path, const struct stat *state, int type, struct FTW *place)
{
    __msan_unpoison_string(path);
    __msan_unpoison(state, sizeof *state);
    SET(*place);
    return visitor(path, state, type, place);
}

int __real_nftw(const char *path, visit *with, int files, int flags);
int __wrap_nftw(const char *path, visit *with, int files, int flags);
int __wrap_nftw(const char *path, visit *with, int files, int flags)
{
    visitor = with;
    return __real_nftw(path, visit_set, files, flags);
}
