// encode.c - from a capture to a file in one call
#include <relume/pack.h>

#include "base/memory.h"

#include <math.h>

struct material {
    struct relume_pack_view *view;
    relume_coefficients **coefficients;
    struct relume_image *depth, *mask;  // [views]
    int views;
};

static void destroy(struct material *m)
{
    for (int i = 0; i < m->views; i++) {
        if (m->coefficients)
            relume_coefficients_destroy(&m->coefficients[i]);
        if (m->depth)
            relume_image_destroy(&m->depth[i]);
        if (m->mask)
            relume_image_destroy(&m->mask[i]);
    }
    free(m->view);
    free(m->coefficients);
    free(m->depth);
    free(m->mask);
}

static bool create(struct material *m, int views)
{
    const size_t n = (size_t)views;
    m->views = views;
    m->view = mem_zeroed(n, sizeof *m->view);
    m->coefficients = mem_zeroed(n, sizeof *m->coefficients);
    m->depth = mem_zeroed(n, sizeof *m->depth);
    m->mask = mem_zeroed(n, sizeof *m->mask);
    return m->view && m->coefficients && m->depth && m->mask;
}

static relume_status encode_view(struct material *m, int i, const relume_coder *coder,
                                 const relume_capture *capture,
                                 const struct relume_encode_params *p)
{
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    relume_status status = relume_encode(&m->coefficients[i], coder, capture, i, p);
    if (!status)
        status = relume_capture_depth(&m->depth[i], capture, i, p->log);
    if (!status)
        status = relume_capture_mask(&m->mask[i], capture, i, p->log);
    m->view[i] = (struct relume_pack_view){
        .coefficients = m->coefficients[i],
        .uv = {manifest->view[i].uv[0], manifest->view[i].uv[1]},
        .depth = m->depth[i].data ? &m->depth[i] : NULL,
        .mask = m->mask[i].data ? &m->mask[i] : NULL,
    };
    return status;
}

// Root mean square over views.
static struct relume_encode_report mean_report(const struct material *m)
{
    struct relume_encode_report sum = {0.0, 0.0};
    for (int i = 0; i < m->views; i++) {
        const struct relume_encode_report r = relume_coefficients_report(m->coefficients[i]);
        sum.fit_rms += r.fit_rms * r.fit_rms / m->views;
        sum.store_rms += r.store_rms * r.store_rms / m->views;
    }
    return (struct relume_encode_report){sqrt(sum.fit_rms), sqrt(sum.store_rms)};
}

relume_status relume_pack_encode(const relume_capture *capture, const relume_coder *coder,
                                 const char *path, struct relume_encode_report *report,
                                 const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p =
        params ? *params : (struct relume_pack_encode_params){0};
    const struct relume_encode_params encode = {
        .log = p.log,
        .domain = relume_encode_domain(capture, p.domain),
        .storage = p.storage,
        .step = p.step,
        .threads = p.threads,
        .scratch = path,
    };
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    struct material m = {0};
    relume_status status = create(&m, manifest->views) ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < manifest->views; i++)
        status = encode_view(&m, i, coder, capture, &encode);
    if (!status) {
        const struct relume_pack_contents contents = {
            .coder = coder,
            .domain = encode.domain,
            .display = relume_encode_display(capture),
            .geometry = manifest->geometry,
            .views = manifest->views,
            .view = m.view,
            .report = mean_report(&m),
        };
        if (report)
            *report = contents.report;
        status = relume_pack_write(
            &contents, path,
            relume_pack_params(.log = p.log, .compression = p.compression, .threads = p.threads));
    }
    destroy(&m);
    return status;
}
