// frame_programs.c - programs that a renderer draws frames with, but for slabs and objects
#include "draw/frame_programs.h"

relume_status frame_programs_create(struct frame_programs *p, const struct gl *gl,
                                    const struct relume_geometry *geometry,
                                    const struct relume_log *log)
{
    const struct fragment_program list[] = {
        {&p->picture, &draw_picture_fragment}, {&p->ball, &draw_ball_fragment},
        {&p->source, &draw_source_fragment},   {&p->present, &draw_present_fragment},
        {&p->apart, &draw_apart_fragment},
    };
    const relume_status status =
        program_create_fragments(list, sizeof list / sizeof *list, gl, log);
    return status || geometry->projection < RELUME_CYLINDRICAL
               ? status
               : draw_panorama_create(&p->panorama, gl, geometry, log);
}

void frame_programs_destroy(struct frame_programs *p, const struct gl *gl)
{
    struct program *const all[] = {&p->picture, &p->panorama, &p->ball,
                                   &p->source,  &p->present,  &p->apart};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        program_destroy(all[i], gl);
}
