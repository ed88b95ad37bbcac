// draw_slabs.c - several slabs through one window, cell by cell, added up and then divided
//
// A cell of a turned slab is no rectangle of the frame as it is in draw_slab.c: what is drawn is a
// rectangle around it, and each pixel asks whether its ray passes the cell.
#include "common/vec.h"
#include "draw/draw.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <math.h>

enum {
    VIEW_00 = DRAW_OWN,
    PICTURE = VIEW_00 + 4,
    EYE,
    CORNER,
    RIGHT,
    DOWN,
    PLANES,
    GRID,
    SLACK,
    ST,
    CELL,
    BESIDE,
    PASSED,
    COMMON,
    NEAREST = COMMON,
    FLAT_COUNT,
    DISPARITY_00 = COMMON,
    RANGE = DISPARITY_00 + 4,
    EXTENT,
    HERE,
    DEPTH_COUNT,
};
#define COMMON_UNIFORMS                                                                            \
    "rectangle", "frame_size", "view00", "view10", "view01", "view11", "picture", "eye", "corner", \
        "right", "down", "planes", "grid", "slack", "st", "cell", "beside", "passed"
static const char *const flat_uniforms[] = {COMMON_UNIFORMS, "nearest"};
static const char *const depth_uniforms[] = {
    COMMON_UNIFORMS, "disparity00", "disparity10", "disparity01",
    "disparity11",   "range",       "extent",      "here",
};

const struct fragment draw_slabs_fragment = {"slabs.frag", flat_uniforms, FLAT_COUNT};
const struct fragment draw_slabs_depth_fragment = {"slabs_depth.frag", depth_uniforms, DEPTH_COUNT};

// One slab, the window in its own frame.
struct turned {
    const struct program *program;
    const struct gl *gl;
    const struct frame_area *area;
    const struct slabs_inputs *in;
    const struct relume_geometry *geometry;
    const relume_slab *slab;
    struct relume_slab_grid grid;
    struct relume_vec3 eye, corner, right, down;  // the last three from the eye
    double slack;
};

static struct turned turn(const struct program *program, const struct gl *gl,
                          const struct frame_area *area, const struct slabs_inputs *in, int slab)
{
    const struct relume_geometry *g = relume_slab_set_geometry(in->slabs, slab);
    const struct relume_window *w = in->window;
    struct turned t = {
        .program = program,
        .gl = gl,
        .area = area,
        .in = in,
        .geometry = g,
        .slab = relume_slab_set_slab(in->slabs, slab),
        .eye = relume_pose_local(&g->pose, w->eye),
        .corner = relume_pose_turn_back(&g->pose, vec3_sub(w->corner, w->eye)),
        .right = relume_pose_turn_back(&g->pose, w->right),
        .down = relume_pose_turn_back(&g->pose, w->down),
    };
    t.grid = relume_slab_grid(t.slab);
    const double extent =
        fmax(t.grid.u[t.grid.columns - 1] - t.grid.u[0], t.grid.v[t.grid.rows - 1] - t.grid.v[0]);
    t.slack = 1e-6 * fmax(extent, fabs(g->uv_z - g->st_z));
    return t;
}

// ---------------------------------------------------------------- where a cell is seen

// Part of the picture, 0 to 1.
struct part {
    double min[2], max[2];
};

// Where rays through four points of a plane z lie in the picture, when all are on one side of the
// eye; else they may lie anywhere.
static void bound(struct part *part, const struct turned *t, const double low[2],
                  const double high[2], double z)
{
    const struct relume_vec3 normal = vec3_cross(t->right, t->down);
    const double size[2] = {vec3_dot(t->right, t->right), vec3_dot(t->down, t->down)};
    struct part found = {{2, 2}, {-1, -1}};
    int ahead = 0, behind = 0;
    for (int i = 0; i < 4; i++) {
        const struct relume_vec3 point = {i % 2 ? high[0] : low[0], i / 2 ? high[1] : low[1], z};
        const struct relume_vec3 way = vec3_sub(point, t->eye);
        const double reach = vec3_dot(way, normal) / vec3_dot(t->corner, normal);
        ahead += reach > 1e-6;
        behind += reach < -1e-6;
        const struct relume_vec3 hit = {way.x / reach, way.y / reach, way.z / reach};
        const struct relume_vec3 from = vec3_sub(hit, t->corner);
        const double at[2] = {vec3_dot(from, t->right) / size[0],
                              vec3_dot(from, t->down) / size[1]};
        for (int axis = 0; axis < 2; axis++) {
            found.min[axis] = fmin(found.min[axis], at[axis]);
            found.max[axis] = fmax(found.max[axis], at[axis]);
        }
    }
    for (int axis = 0; (ahead == 4 || behind == 4) && axis < 2; axis++) {
        part->min[axis] = fmax(part->min[axis], found.min[axis]);
        part->max[axis] = fmin(part->max[axis], found.max[axis]);
    }
}

// A pixel more to all sides: the shader decides.
static bool find_rectangle(struct app_rectangle *out, const struct turned *t, const double low[2],
                           const double high[2])
{
    const struct relume_geometry *g = t->geometry;
    const struct app_rectangle *p = &t->area->picture;
    const double width = p->right - p->left, height = p->bottom - p->top;
    struct part part = {{0, 0}, {1, 1}};
    if (!t->in->others)
        bound(&part, t, g->st_min, g->st_max, g->st_z);
    if (!t->in->passed && fabs(t->eye.z - g->uv_z) > 1e-3 * fabs(g->uv_z - g->st_z))
        bound(&part, t, low, high, g->uv_z);
    *out = (struct app_rectangle){
        .left = fmax(p->left, p->left + part.min[0] * width - 1),
        .top = fmax(p->top, p->top + part.min[1] * height - 1),
        .right = fmin(p->right, p->left + part.max[0] * width + 1),
        .bottom = fmin(p->bottom, p->top + part.max[1] * height + 1),
    };
    return out->left < out->right && out->top < out->bottom;
}

// ---------------------------------------------------------------- drawing

static void draw_cell(const struct turned *t, int column, int row)
{
    const struct relume_slab_grid *grid = &t->grid;
    const int right = grid->columns > 1 ? column + 1 : column;
    const int below = grid->rows > 1 ? row + 1 : row;
    const int *first = &grid->view[(size_t)row * (size_t)grid->columns];
    const int *second = &grid->view[(size_t)below * (size_t)grid->columns];
    const int cell[4] = {first[column], first[right], second[column], second[right]};
    const double low[2] = {grid->u[column] - t->slack, grid->v[row] - t->slack};
    const double high[2] = {grid->u[right] + t->slack, grid->v[below] + t->slack};
    struct app_rectangle rectangle;
    if (!draw_use_cell(t->gl, t->in->views, t->in->disparity, cell) ||
        !find_rectangle(&rectangle, t, low, high))
        return;
    if (t->in->disparity) {
        float here[4];
        for (int i = 0; i < 4; i++)
            here[i] = t->in->views[cell[i]] ? 1 : 0;
        t->gl->Uniform4f(t->program->at[HERE], here[0], here[1], here[2], here[3]);
    }
    t->gl->Uniform4f(t->program->at[CELL], (float)grid->u[column], (float)grid->v[row],
                     (float)grid->u[right], (float)grid->v[below]);
    draw_rectangle(t->gl, t->program, t->area, rectangle);
}

static void set_vector(const struct turned *t, int uniform, struct relume_vec3 v)
{
    t->gl->Uniform3f(t->program->at[uniform], (float)v.x, (float)v.y, (float)v.z);
}

static void draw_slab_cells(const struct turned *t)
{
    const struct gl *gl = t->gl;
    const struct relume_geometry *g = t->geometry;
    const struct relume_slab_grid *grid = &t->grid;
    const GLint *at = t->program->at;
    set_vector(t, EYE, t->eye);
    set_vector(t, CORNER, t->corner);
    set_vector(t, RIGHT, t->right);
    set_vector(t, DOWN, t->down);
    gl->Uniform2f(at[PLANES], (float)g->uv_z, (float)g->st_z);
    gl->Uniform4f(at[GRID], (float)grid->u[0], (float)grid->v[0], (float)grid->u[grid->columns - 1],
                  (float)grid->v[grid->rows - 1]);
    gl->Uniform1f(at[SLACK], (float)t->slack);
    gl->Uniform4f(at[ST], (float)g->st_min[0], (float)g->st_min[1], (float)g->st_max[0],
                  (float)g->st_max[1]);
    for (int row = 0; row == 0 || row < grid->rows - 1; row++)
        for (int column = 0; column == 0 || column < grid->columns - 1; column++)
            draw_cell(t, column, row);
}

static void begin_slabs(const struct program *program, const struct gl *gl,
                        const struct frame_area *area, const struct slabs_inputs *in)
{
    const struct app_rectangle *p = &area->picture;
    gl->UseProgram(program->id);
    for (int i = 0; i < 4; i++)
        gl->Uniform1i(program->at[VIEW_00 + i], i);
    gl->Uniform4f(program->at[PICTURE], (float)p->left, (float)p->top, (float)p->right,
                  (float)p->bottom);
    gl->Uniform1i(program->at[BESIDE], in->passed != NULL);
    gl->Uniform1i(program->at[PASSED], 8);
    if (in->passed)
        texture_use(gl, 8, GL_TEXTURE_2D, in->passed->texture);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
}

void draw_slabs(const struct program *program, const struct gl *gl, const struct frame_area *area,
                const struct slabs_inputs *in, bool nearest)
{
    begin_slabs(program, gl, area, in);
    gl->Uniform1i(program->at[NEAREST], nearest);
    for (int i = 0; i < relume_slab_set_count(in->slabs); i++) {
        const struct turned t = turn(program, gl, area, in, i);
        draw_slab_cells(&t);
    }
    gl->Disable(GL_BLEND);
}

// Of the views of a slab that are there.
static void set_range(const struct turned *t)
{
    double farthest = (double)INFINITY, nearest = -(double)INFINITY;
    for (int i = 0; i < t->grid.columns * t->grid.rows; i++) {
        const int view = t->grid.view[i];
        if (!t->in->views[view])
            continue;
        farthest = fmin(farthest, t->in->range[view][0]);
        nearest = fmax(nearest, t->in->range[view][1]);
    }
    t->gl->Uniform2f(t->program->at[EXTENT], (float)farthest, (float)nearest);
    nearest = fmin(nearest, relume_slab_eye_disparity(t->slab, t->eye));
    t->gl->Uniform2f(t->program->at[RANGE], (float)farthest, (float)nearest);
}

void draw_slabs_depth(const struct program *program, const struct gl *gl,
                      const struct frame_area *area, const struct slabs_inputs *in)
{
    begin_slabs(program, gl, area, in);
    for (int i = 0; i < 4; i++)
        gl->Uniform1i(program->at[DISPARITY_00 + i], 4 + i);
    for (int i = 0; i < relume_slab_set_count(in->slabs); i++) {
        const struct turned t = turn(program, gl, area, in, i);
        set_range(&t);
        draw_slab_cells(&t);
    }
    gl->Disable(GL_BLEND);
}
