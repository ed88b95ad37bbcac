// glow.h - what leaves a body of scattering material, from the light at points of its surface
#ifndef TRANSPORT_GLOW_H
#define TRANSPORT_GLOW_H

#include "world/transport/dipole.h"
#include "world/transport/spread.h"

// Points of the surface, and a hierarchy over them. Never changes.
struct glow_node;
struct glow_tree {
    const struct spread_point *point;  // borrowed
    const bool *thin;                  // borrowed; [points]: both sides are the surface
    size_t points;
    struct glow_node *node;  // each before what is below it
    size_t nodes;
    struct dipole dipole;
    double near;          // within so much of a place, light counts as a mean of the points'
    float near_share[3];  // ... of what the place shows where light is even
    double reach;         // beyond it, pieces need not be divided: next to nothing arrives
    float (*part)[3];     // [points]: of what a plane would send on of its light
};
// RELUME_ENOMEM.
relume_status glow_tree_make(struct glow_tree *out, const struct spread *spread, const bool *thin,
                             const struct scattering *scattering, double mm, int threads);
void glow_tree_free(struct glow_tree *t);

// The same in some light.
struct glow_sum;
struct glow {
    const struct glow_tree *tree;
    float (*light)[3];     // [points]: what enters, in colours; set before glow_sum
    struct glow_sum *sum;  // [nodes]
};
// Dark. RELUME_ENOMEM.
relume_status glow_make(struct glow *out, const struct glow_tree *tree);
void glow_free(struct glow *g);
// What has entered counts from now on.
void glow_sum_up(struct glow *g);
// What leaves a place of the surface, all directions together, 1 being what a white matte surface
// sends in a light of 1. Pieces of it are taken as a whole where they are seen under a solid angle
// of less than `error`; 0: never. Returns how many pieces have been asked.
int glow_leaves(float rgb[3], const struct glow *g, vec3 place, vec3 normal, double error);

#endif
