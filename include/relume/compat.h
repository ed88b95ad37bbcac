// compat.h - names of version 0.1, for one version more
//
// In 0.1 relume.h had every header. Programs written for it include this one instead; new programs
// include relume.h and the extensions that they use.
#ifndef RELUME_COMPAT_H
#define RELUME_COMPAT_H

#include <relume/extensions.h>

#define relume_object_vertex relume_mesh_vertex
#define relume_encode_params relume_project_params
#define relume_encode_report relume_fidelity
#define relume_encode_census relume_census
#define relume_encode_domain relume_capture_domain

#define relume_baked_is_file(path, limits) (relume_kind_of(path) == RELUME_KIND_BAKED)
#define relume_tableau_is(path)            (relume_kind_of(path) == RELUME_KIND_SCENE)

#ifdef __cplusplus
extern "C" {
#endif

static inline relume_status relume_publish(const char *const *files, int count, const char *site,
                                           struct relume_publish_report *reports,
                                           const struct relume_publish_params *params)
{
    return relume_publish_files(site, files, count, params, reports);
}

#ifdef __cplusplus
}
#endif

#endif
