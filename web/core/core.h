// core.h - what a page calls of the library (core.c says what it all means)
#ifndef CORE_CORE_H
#define CORE_CORE_H

struct core;

void *core_allocate(int bytes);
void core_free(void *memory);
struct core *core_open(const char *basis, const char *interpolant, const double *parameter,
                       int coefficients, int hemispherical, int pole_y, const double *xyz, int n);
void core_close(struct core *core);
int core_functions(const struct core *core);
int core_turn(struct core *core, const float *transform, const float *mean, int planes);
double core_weights(struct core *core, double x, double y, double z, float *out);
const double *core_from(const struct core *core);
int core_triangles(const struct core *core, float *out, int most);
int core_environment(const struct core *core, float *rgb, int width, int height, double rotate_deg,
                     double *out);

#endif
