// draw_slab.c - each cell between four cameras is a rectangle of the frame (Wong 1998, 8.1, Fig
// 8-13)
//
// u depends on s alone and v on t alone, so the part of the window that looks through one cell of
// the uv plane is a rectangle; a cell needs only its own four views, however large the slab is.
#include "draw.h"

#include <math.h>

enum { VIEW_00 = DRAW_OWN, VIEW_10, VIEW_01, VIEW_11, PICTURE, ST, CELL, EYE, EXPOSURE, COUNT };
static const char *const uniforms[] = {
    "rectangle", "frame_size", "view00", "view10", "view01",   "view11",
    "picture",   "st",         "cell",   "eye",    "exposure",
};

relume_status draw_slab_create(struct program *program, const struct gl *gl,
                               const struct relume_log *log)
{
    return program_create(program, gl, "slab.frag", uniforms, COUNT, log);
}

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
// st. Cells at the border are open a hair wider, as relume_slab_blend has it.
static bool find_strip(struct strip *strip, const double *lines, int n, int i, double eye,
                       double reach, const double window[2])
{
    const double slack = 1e-6 * (1.0 + fabs(lines[0]) + fabs(lines[n - 1]));
    const int high = n > 1 ? i + 1 : i;
    const double low_u = lines[i] - (i == 0 ? slack : 0.0);
    const double high_u = lines[high] + (high == n - 1 ? slack : 0.0);
    *strip = (struct strip){.low = i, .high = high};
    if (reach != 0.0)
        return clip(strip, eye + (low_u - eye) / reach, eye + (high_u - eye) / reach, window);
    // An eye on the uv plane sees the whole window through one point of it.
    const bool last = high == n - 1;
    return eye >= low_u && (eye < high_u || (last && eye <= high_u)) &&
           clip(strip, window[0], window[1], window);
}

// Views of weight 0 were not relit: another one of the cell stands in.
static void use_views(const struct gl *gl, const struct target *const views[4])
{
    const struct target *any = NULL;
    for (int i = 0; i < 4; i++)
        any = views[i] ? views[i] : any;
    for (int i = 0; any && i < 4; i++)
        texture_use(gl, i, GL_TEXTURE_2D, (views[i] ? views[i] : any)->texture);
}

struct cells {
    const struct program *program;
    const struct gl *gl;
    const struct place *place;
    const struct relume_geometry *geometry;
    struct relume_slab_grid grid;
    const struct target *const *views;
};

static struct app_rectangle pixels_of(const struct cells *c, const struct strip *across,
                                      const struct strip *down)
{
    const struct app_rectangle *p = &c->place->picture;
    const struct relume_geometry *g = c->geometry;
    const double per_s = (p->right - p->left) / (g->st_max[0] - g->st_min[0]);
    const double per_t = (p->bottom - p->top) / (g->st_max[1] - g->st_min[1]);
    return (struct app_rectangle){
        .left = p->left + (across->from - g->st_min[0]) * per_s,
        .top = p->top + (g->st_max[1] - down->to) * per_t,
        .right = p->left + (across->to - g->st_min[0]) * per_s,
        .bottom = p->top + (g->st_max[1] - down->from) * per_t,
    };
}

static void draw_cell(const struct cells *c, const struct strip *across, const struct strip *down)
{
    const struct relume_slab_grid *grid = &c->grid;
    const int *low = &grid->view[(size_t)down->low * (size_t)grid->columns];
    const int *high = &grid->view[(size_t)down->high * (size_t)grid->columns];
    const struct target *const views[4] = {
        c->views[low[across->low]],
        c->views[low[across->high]],
        c->views[high[across->low]],
        c->views[high[across->high]],
    };
    use_views(c->gl, views);
    c->gl->Uniform4f(c->program->at[CELL], (float)grid->u[across->low], (float)grid->v[down->low],
                     (float)grid->u[across->high], (float)grid->v[down->high]);
    draw_rectangle(c->gl, c->program, c->place, pixels_of(c, across, down));
}

static void set_uniforms(const struct cells *c, struct relume_vec3 eye, double reach)
{
    const struct gl *gl = c->gl;
    const struct relume_geometry *g = c->geometry;
    const struct app_rectangle *p = &c->place->picture;
    const GLint *at = c->program->at;
    gl->UseProgram(c->program->id);
    for (int i = 0; i < 4; i++)
        gl->Uniform1i(at[VIEW_00 + i], i);
    gl->Uniform4f(at[PICTURE], (float)p->left, (float)p->top, (float)p->right, (float)p->bottom);
    gl->Uniform4f(at[ST], (float)g->st_min[0], (float)g->st_min[1], (float)g->st_max[0],
                  (float)g->st_max[1]);
    gl->Uniform3f(at[EYE], (float)eye.x, (float)eye.y, (float)reach);
    gl->Uniform1f(at[EXPOSURE], c->place->exposure);
}

void draw_slab(const struct program *program, const struct gl *gl, const struct place *place,
               const relume_slab *slab, const struct relume_geometry *geometry,
               struct relume_vec3 eye, const struct target *const *views)
{
    const struct relume_geometry *g = geometry;
    const struct cells cells = {program, gl, place, g, relume_slab_grid(slab), views};
    const struct relume_slab_grid *grid = &cells.grid;
    const double reach = (g->uv_z - eye.z) / (g->st_z - eye.z);
    const double s[2] = {g->st_min[0], g->st_max[0]};
    const double t[2] = {g->st_min[1], g->st_max[1]};
    set_uniforms(&cells, eye, reach);
    struct strip across, down;
    for (int j = 0; j == 0 || j < grid->rows - 1; j++) {
        if (!find_strip(&down, grid->v, grid->rows, j, eye.y, reach, t))
            continue;
        for (int i = 0; i == 0 || i < grid->columns - 1; i++)
            if (find_strip(&across, grid->u, grid->columns, i, eye.x, reach, s))
                draw_cell(&cells, &across, &down);
    }
}
