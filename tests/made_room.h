// made_room.h - a room and the same room with a ball in it, for light between scenes and objects:
// three walls and a floor, one of them red, seen from the middle; light falls in from the open
// side. The ball stands on the floor.
#ifndef MADE_ROOM_H
#define MADE_ROOM_H

#include "world/stage/scene.h"

#include <stdio.h>

static const struct relume_vec3 light_direction = {0.55, 0.75, 0.6};
static const double ball[3] = {0.3, -0.6, -1.0}, ball_radius = 0.4;
static const float ball_grey = 0.8f;

static inline void add_wall(struct relume_scene_builder *b, vec3 corner, vec3 u, vec3 v, float r,
                            float g, float blue)
{
    struct mesh part = {0};
    shape_quad(&part, corner, u, v);
    build_put_exact(b, &part, build_material(b, build_matte(r, g, blue)));
}

static relume_status build_room(struct relume_scene_builder *b)
{
    add_wall(b, vec3_of(-2, -1, 2), vec3_of(4, 0, 0), vec3_of(0, 0, -4), 0.7f, 0.7f, 0.7f);
    add_wall(b, vec3_of(-2, -1, -2), vec3_of(4, 0, 0), vec3_of(0, 3, 0), 0.6f, 0.6f, 0.6f);
    add_wall(b, vec3_of(-2, -1, 2), vec3_of(0, 0, -4), vec3_of(0, 3, 0), 0.7f, 0.15f, 0.1f);
    return RELUME_OK;
}

static relume_status build_room_with_ball(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_sphere(&part, vec3_of(ball[0], ball[1], ball[2]), ball_radius, 64);
    build_put_exact(b, &part, build_material(b, build_matte(ball_grey, ball_grey, ball_grey)));
    return build_room(b);
}

static const struct relume_scene_kind room = {.name = "room",
                                              .summary = "three walls",
                                              .projection = RELUME_SPHERICAL,
                                              .build = build_room},
                                      room_with_ball = {.name = "room-with-ball",
                                                        .summary = "three walls and a ball",
                                                        .projection = RELUME_SPHERICAL,
                                                        .build = build_room_with_ball};

// As Wavefront OBJ, of radius 1 about the origin; false: it could not be written.
static inline bool write_ball_mesh(const char *path, int segments, bool flipped)
{
    struct mesh m = {0};
    shape_sphere(&m, vec3_of(0, 0, 0), 1.0, segments);
    FILE *file = fopen(path, "w");
    for (size_t i = 0; i < m.vertex_count && file; i++) {
        const struct vertex *v = &m.vertices[i];
        fprintf(file, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", (double)v->position[0],
                (double)v->position[1], (double)v->position[2], (double)v->normal[0],
                (double)v->normal[1], (double)v->normal[2]);
    }
    for (size_t i = 0; i < m.triangle_count && file; i++) {
        const uint32_t *v = m.triangles[i].vertex, a = v[0] + 1, b = v[flipped ? 2 : 1] + 1,
                       c = v[flipped ? 1 : 2] + 1;
        fprintf(file, "f %u//%u %u//%u %u//%u\n", a, a, b, b, c, c);
    }
    if (file && flipped)
        fprintf(file, "f 1//1 1//1 2//2\n");
    mesh_free(&m);
    return file && !fclose(file);
}

// The description of a matte ball at its place.
static inline void ball_text(char *text, size_t size, const char *mesh, vec3 at, float grey)
{
    snprintf(text, size,
             "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"%s\","
             "\"pose\":{\"scale\":%g,\"translate\":[%g,%g,%g]},\"parts\":[{\"material\":"
             "{\"diffuse\":%g}}]}]}",
             mesh, ball_radius, at.x, at.y, at.z, (double)grey);
}

#endif
