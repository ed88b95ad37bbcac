// draw_slab.c - each cell between four cameras is a rectangle of the frame (Wong 1998, 8.1, Fig
// 8-13)
//
// u depends on s alone and v on t alone, so the part of the window that looks through one cell of
// the uv plane is a rectangle; a cell needs only its own four views, however large the slab is.
#include "draw/draw.h"
#include "relight/view/view.h"

#include <math.h>

enum {
    VIEW_00 = DRAW_OWN,
    VIEW_10,
    VIEW_01,
    VIEW_11,
    PICTURE,  // of draw_use_window, to EYE
    ST,
    EYE,
    CELL,
    EXPOSURE,
    FIRST_LOW,
    FIRST_HIGH,
    WHOLE,
    COMMON,
    NEAREST = COMMON,
    LINEAR_COUNT,
    DISPARITY_00 = COMMON,
    RANGE = DISPARITY_00 + 4,
    HERE,
    DEPTH_COUNT,
};
#define COMMON_UNIFORMS                                                                            \
    "rectangle", "frame_size", "view00", "view10", "view01", "view11", "picture", "st", "eye",     \
        "cell", "exposure", "first_low", "first_high", "whole"
static const char *const linear_uniforms[] = {COMMON_UNIFORMS, "nearest"};
static const char *const depth_uniforms[] = {
    COMMON_UNIFORMS, "disparity00", "disparity10", "disparity01", "disparity11", "range", "here",
};

const struct fragment draw_slab_fragment = {"slab.frag", linear_uniforms, LINEAR_COUNT};
const struct fragment draw_slab_depth_fragment = {"slab_depth.frag", depth_uniforms, DEPTH_COUNT};

// Along one axis: the cameras on both sides of a cell and the part of the window seen through it.
struct strip {
    int low, high;    // lines of the grid
    double from, to;  // of the window, st units, from < to
};

static bool clip(struct strip *strip, double from, double to, const double window[2])
{
    strip->from = fmax(fmin(from, to), window[0]);
    strip->to = fmin(fmax(from, to), window[1]);
    return strip->from < strip->to;
}

// The strip of cell `i` of `n` lines, as seen from `eye` with the uv plane `reach` on the way to
// st. Cells at the border go on beyond it, as frames of the library do.
static bool find_strip(struct strip *strip, const double *lines, int n, int i, double eye,
                       double reach, const double window[2])
{
    const int high = n > 1 ? i + 1 : i;
    const bool last = high == n - 1;
    const double low_u = i == 0 ? -(double)INFINITY : lines[i];
    const double high_u = last ? (double)INFINITY : lines[high];
    *strip = (struct strip){.low = i, .high = high};
    if (reach != 0.0)
        return clip(strip, eye + (low_u - eye) / reach, eye + (high_u - eye) / reach, window);
    // An eye on the uv plane sees the whole window through one point of it.
    return eye >= low_u && eye < high_u && clip(strip, window[0], window[1], window);
}

bool draw_use_cell(const struct gl *gl, const struct target *const *views, const GLuint *disparity,
                   const int cell[4])
{
    int any = -1;
    for (int i = 0; i < 4; i++)
        any = views[cell[i]] ? cell[i] : any;
    for (int i = 0; any >= 0 && i < 4; i++) {
        const int shown = views[cell[i]] ? cell[i] : any;
        texture_use(gl, i, GL_TEXTURE_2D, views[shown]->texture);
        if (disparity)
            texture_use(gl, 4 + i, GL_TEXTURE_2D, disparity[shown]);
    }
    return any >= 0;
}

struct cells {
    const struct program *program;
    const struct gl *gl;
    const struct frame_area *area;
    const struct slab_inputs *in;
    struct relume_slab_grid grid;
    const GLuint *disparity;  // [views], or NULL
};

static struct app_rectangle pixels_of(const struct cells *c, const struct strip *across,
                                      const struct strip *down)
{
    const struct app_rectangle *p = &c->area->picture;
    const struct relume_geometry *g = c->in->geometry;
    const double per_s = (p->right - p->left) / (g->st_max[0] - g->st_min[0]);
    const double per_t = (p->bottom - p->top) / (g->st_max[1] - g->st_min[1]);
    return (struct app_rectangle){
        .left = p->left + (across->from - g->st_min[0]) * per_s,
        .top = p->top + (g->st_max[1] - down->to) * per_t,
        .right = p->left + (across->to - g->st_min[0]) * per_s,
        .bottom = p->top + (g->st_max[1] - down->from) * per_t,
    };
}

// Where the textures in use begin in their views.
static void set_parts(const struct cells *c, const int view[4])
{
    float first[4][2] = {{0}};
    int any = -1;
    for (int i = 0; i < 4; i++)
        any = c->in->views[view[i]] ? view[i] : any;
    for (int i = 0; c->in->part && any >= 0 && i < 4; i++) {
        const struct relume_rect *at = &c->in->part[c->in->views[view[i]] ? view[i] : any];
        first[i][0] = (float)at->left;
        first[i][1] = (float)at->top;
    }
    const GLint *at = c->program->at;
    c->gl->Uniform4f(at[FIRST_LOW], first[0][0], first[0][1], first[1][0], first[1][1]);
    c->gl->Uniform4f(at[FIRST_HIGH], first[2][0], first[2][1], first[3][0], first[3][1]);
    c->gl->Uniform2f(at[WHOLE], c->in->part ? (float)c->in->size[0] : 0.0f,
                     c->in->part ? (float)c->in->size[1] : 0.0f);
}

static void draw_cell(const struct cells *c, const struct strip *across, const struct strip *down)
{
    const struct relume_slab_grid *grid = &c->grid;
    const int *low = &grid->view[(size_t)down->low * (size_t)grid->columns];
    const int *high = &grid->view[(size_t)down->high * (size_t)grid->columns];
    const int view[4] = {low[across->low], low[across->high], high[across->low],
                         high[across->high]};
    (void)draw_use_cell(c->gl, c->in->views, c->disparity, view);
    set_parts(c, view);
    c->gl->Uniform4f(c->program->at[CELL], (float)grid->u[across->low], (float)grid->v[down->low],
                     (float)grid->u[across->high], (float)grid->v[down->high]);
    draw_rectangle(c->gl, c->program, c->area, pixels_of(c, across, down));
}

static double reach_of(const struct slab_inputs *in)
{
    const struct relume_geometry *g = in->geometry;
    return (g->uv_z - in->eye.z) / (g->st_z - in->eye.z);
}

void draw_use_window(const struct gl *gl, const struct frame_area *area,
                     const struct slab_inputs *in, const GLint at[3])
{
    const struct relume_geometry *g = in->geometry;
    const struct app_rectangle *p = &area->picture;
    gl->Uniform4f(at[0], (float)p->left, (float)p->top, (float)p->right, (float)p->bottom);
    gl->Uniform4f(at[1], (float)g->st_min[0], (float)g->st_min[1], (float)g->st_max[0],
                  (float)g->st_max[1]);
    gl->Uniform3f(at[2], (float)in->eye.x, (float)in->eye.y, (float)reach_of(in));
}

static void set_uniforms(const struct cells *c)
{
    const struct gl *gl = c->gl;
    const GLint *at = c->program->at;
    gl->UseProgram(c->program->id);
    for (int i = 0; i < 4; i++)
        gl->Uniform1i(at[VIEW_00 + i], i);
    draw_use_window(gl, c->area, c->in, at + PICTURE);
    gl->Uniform1f(at[EXPOSURE], c->area->exposure);
}

static void draw_cells(const struct cells *c)
{
    const struct relume_geometry *g = c->in->geometry;
    const struct relume_slab_grid *grid = &c->grid;
    const double reach = reach_of(c->in);
    const double s[2] = {g->st_min[0], g->st_max[0]};
    const double t[2] = {g->st_min[1], g->st_max[1]};
    struct strip across, down;
    for (int j = 0; j == 0 || j < grid->rows - 1; j++) {
        if (!find_strip(&down, grid->v, grid->rows, j, c->in->eye.y, reach, t))
            continue;
        for (int i = 0; i == 0 || i < grid->columns - 1; i++)
            if (find_strip(&across, grid->u, grid->columns, i, c->in->eye.x, reach, s))
                draw_cell(c, &across, &down);
    }
}

void draw_slab(const struct program *program, const struct gl *gl, const struct frame_area *area,
               const struct slab_inputs *in, bool nearest)
{
    const struct cells cells = {program, gl, area, in, relume_slab_grid(in->slab), NULL};
    set_uniforms(&cells);
    gl->Uniform1i(program->at[NEAREST], nearest);
    draw_cells(&cells);
}

void draw_slab_depth(const struct program *program, const struct gl *gl,
                     const struct frame_area *area, const struct slab_inputs *in,
                     const GLuint *disparity, const double range[2])
{
    const struct cells cells = {program, gl, area, in, relume_slab_grid(in->slab), disparity};
    const double nearest = fmin(range[1], relume_slab_eye_disparity(in->slab, in->eye));
    set_uniforms(&cells);
    for (int i = 0; i < 4; i++)
        gl->Uniform1i(program->at[DISPARITY_00 + i], 4 + i);
    gl->Uniform2f(program->at[RANGE], (float)range[0], (float)nearest);
    gl->Uniform4f(program->at[HERE], 1, 1, 1, 1);
    draw_cells(&cells);
}
