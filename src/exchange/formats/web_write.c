// web_write.c - planes become a folder that relight and OpenLIME read
#include "exchange/formats/web.h"

#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/thread.h"
#include "core/math/sort.h"
#include "image/image/trellis.h"

#include <math.h>
#include <stdio.h>

static int min_of(int a, int b)
{
    return a < b ? a : b;
}

// The plan's plane that stands at place `p` of the folder: lrgb begins with the colour; ycc with
// Y0, Cb, Cr, then only first planes are used.
static int plane_at(const struct plan *plan, int p)
{
    if (plan->form == FOREIGN_YCC)
        return p % 3 == 0 ? p / 3 : p < 3 ? plan->terms + p - 1 : -1;
    if (plan->form != FOREIGN_LUMINANCE)
        return p;
    return p < 3 ? plan->terms + p : p - 3;
}

static int folder_planes(const struct plan *plan)
{
    return plan->form == FOREIGN_YCC ? 3 * plan->terms : plan->planes;
}

struct sheet web_sheet(const struct web_folder *w, int index)
{
    const struct plan *plan = w->plan;
    struct sheet s = {
        .width = w->planes->width,
        .height = w->planes->height,
        .planes = plan->form == FOREIGN_YCC && index > 0
                      ? 1
                      : min_of(folder_planes(plan) - 3 * index, SHEET_PLANES),
        .ycbcr = plan->form == FOREIGN_CHANNELS,
        .fixed = plan->form == FOREIGN_LUMINANCE && index == 0,
    };
    for (int c = 0; c < s.planes; c++) {
        const int p = plane_at(plan, 3 * index + c);
        s.plane[c] = planes_at(w->planes, p);
        s.minimum[c] = w->planes->minimum[p];
        s.maximum[c] = w->planes->maximum[p];
        s.weight[c] = plan->weight[p];
    }
    return s;
}

struct job {
    struct web_folder *w;
    double step;
    relume_status *status;
};

static void free_sheet(struct sheet_result *sheet)
{
    mem_free(sheet->bytes);
    mem_free(sheet->block);
    *sheet = (struct sheet_result){0};
}

static void encode_one(void *context, size_t item, int worker)
{
    (void)worker;
    const struct job *job = context;
    struct sheet s = web_sheet(job->w, (int)item);
    s.blocks = job->w->blocks;
    free_sheet(&job->w->sheet[item]);
    job->status[item] = sheet_encode(&job->w->sheet[item], &s, job->step);
}

// Joint planes come in the order of what they are worth: keep as many sheets as lower
// error + price x bits.
static void choose_kept(struct web_folder *w, double step, bool all)
{
    const struct plan *plan = w->plan;
    const double pixels = (double)w->planes->width * w->planes->height;
    const double price = SHEET_LAMBDA * step * step;
    double left = plan->lost, best = 1e300, spent = 0.0, bits = 0.0;
    for (int p = 0; p < plan->planes; p++)
        left += plan->energy[p];
    for (int i = 0; i < w->sheets; i++) {
        bits += 8.0 * (double)w->sheet[i].size;
        for (int c = 0; c < SHEET_PLANES; c++)
            spent += w->sheet[i].distortion[c];
        for (int p = 3 * i; p < min_of(3 * i + 3, plan->planes); p++)
            left -= plan->energy[p];
        const double cost = left + spent + price * bits / pixels;
        if (cost < best || all || plan->form != FOREIGN_JOINT) {
            best = cost;
            w->kept = i + 1;
            w->error = left + spent;
        }
    }
    w->bytes = 0;
    for (int i = 0; i < w->kept; i++)
        w->bytes += w->sheet[i].size;
}

relume_status web_encode(struct web_folder *w, double step, bool all, int threads)
{
    w->sheets = (folder_planes(w->plan) + SHEET_PLANES - 1) / SHEET_PLANES;
    if (!w->sheet)
        w->sheet = mem_zeroed((size_t)w->sheets, sizeof *w->sheet);
    struct job job = {w, step, mem_zeroed((size_t)w->sheets, sizeof *job.status)};
    relume_status status = w->sheet && job.status ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, (size_t)w->sheets, encode_one, &job);
    for (int i = 0; !status && i < w->sheets; i++)
        status = job.status[i];
    if (!status)
        choose_kept(w, step, all);
    mem_free(job.status);
    return status;
}

// A blank plane costs two bits a block: its DC and its end.
#define BLANK_BITS (2.0 / 64.0)

int web_useful_chroma(const struct web_folder *w, double step)
{
    const double cost = SHEET_LAMBDA * step * step * 2.0 * BLANK_BITS;
    for (int i = w->plan->chroma - 1; i > 0; i--) {
        const double *energy = w->plan->energy + 3 * i, *distortion = w->sheet[i].distortion;
        if (energy[1] + energy[2] - distortion[1] - distortion[2] > cost)
            return i + 1;
    }
    return 1;
}

// ---------------------------------------------------------------- the visible error

// Texture hides errors: the threshold of seeing rises with the 0.7th power of what is there (Watson
// 1993, contrast masking). Below so many levels of 255 nothing is hidden.
#define MASKING_LEVELS 1.0
#define MASKING_POWER  0.7
#define SEEN_OF_BLOCKS 0.95

static double levels_of(double square)
{
    return 255.0 * sqrt(square / (3.0 * 64.0));
}

// Flat blocks of nothing, as around a masked object, would hide the others in a share of all.
static double seen_in_block(const struct web_folder *w, size_t b)
{
    double error = 0.0, texture = 0.0;
    for (int i = 0; i < w->sheets; i++) {
        const struct sheet_block *block = &w->sheet[i].block[b];
        error += (double)(i < w->kept ? block->error : block->energy);
        texture += (double)block->texture;
    }
    const double there = levels_of(texture) / MASKING_LEVELS;
    return texture > 0.0 ? levels_of(error) / fmax(1.0, pow(there, MASKING_POWER)) : 0.0;
}

relume_status web_visible_error(const struct web_folder *w, double *levels)
{
    const size_t blocks = trellis_blocks(w->planes->width, w->planes->height);
    double *seen = mem_array(blocks, sizeof *seen);
    size_t n = 0;
    *levels = 0.0;
    if (!seen)
        return RELUME_ENOMEM;
    for (size_t b = 0; b < blocks; b++) {
        seen[n] = seen_in_block(w, b);
        n += seen[n] > 0.0;
    }
    sort_doubles(seen, n);
    if (n)
        *levels = seen[(size_t)(SEEN_OF_BLOCKS * (double)(n - 1))];
    mem_free(seen);
    return RELUME_OK;
}

void web_folder_free(struct web_folder *w)
{
    for (int i = 0; w->sheet && i < w->sheets; i++)
        free_sheet(&w->sheet[i]);
    mem_free(w->sheet);
    *w = (struct web_folder){0};
}

int web_planes(const struct web_folder *w)
{
    return min_of(3 * w->kept, folder_planes(w->plan));
}

// ---------------------------------------------------------------- info.json

static void put_lights(struct jwriter *w, const struct functions *functions)
{
    jgap(w, "\n");
    jopen_array(w, "lights");
    for (int i = 0; i < functions->count; i++) {
        const struct relume_vec3 l = functions->lights[i];
        jput_fixed(w, NULL, l.x, 3);
        jput_fixed(w, NULL, l.y, 3);
        jput_fixed(w, NULL, l.z, 3);
    }
    jclose(w);
}

static int byte_of(double v)
{
    return (int)fmin(fmax(rint(v), 0.0), 255.0);
}

// 127 over the largest weight of the plane.
static double range_of(const struct plan *plan, int plane)
{
    const int n = plan->functions.count;
    double most = 1e-9;
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < n; j++)
            most = fmax(most, fabs(plan->transform[(c * plan->terms + plane) * n + j]));
    return 127.0 / most;
}

static void put_basis(struct jwriter *w, const struct plan *plan, int planes)
{
    const int n = plan->functions.count;
    jgap(w, "\n");
    jopen_array(w, "basis");
    w->style |= JSON_DENSE;
    for (int j = 0; j < n; j++)
        for (int c = 0; c < 3; c++)
            jput_integer(w, NULL, byte_of(255.0 * plan->mean[c * n + j]));
    for (int p = 0; p < planes; p++) {
        const double range = range_of(plan, p);
        for (int j = 0; j < n; j++)
            for (int c = 0; c < 3; c++)
                jput_integer(
                    w, NULL,
                    byte_of(127.0 + range * plan->transform[(c * plan->terms + p) * n + j]));
    }
    w->style &= ~(unsigned)JSON_DENSE;
    jclose(w);
}

enum column { SCALE, BIAS, RANGE };

static double entry(const struct web_folder *w, enum column column, int p)
{
    const struct sheet_result *sheet = &w->sheet[p / SHEET_PLANES];
    return column == SCALE  ? sheet->scale[p % SHEET_PLANES]
           : column == BIAS ? sheet->bias[p % SHEET_PLANES]
                            : range_of(w->plan, p);
}

static void put_column(struct jwriter *w, const struct web_folder *folder, const char *name,
                       enum column column)
{
    jgap(w, "\n");
    jopen_array(w, name);
    for (int p = 0; p < web_planes(folder); p++)
        jput_number(w, NULL, entry(folder, column, p), 8);
    jclose(w);
}

static void put_functions(struct jwriter *w, const struct plan *plan)
{
    static const char *const kinds[] = {"ptm", "hsh", "sh", "rbf", "bilinear"};
    static const char *const spaces[] = {"rgb", "lrgb", "mrgb", "ycc"};
    jgap(w, "\n");
    jput_text(w, "type", kinds[plan->functions.kind]);
    jgap(w, "\n");
    jput_text(w, "colorspace", plan->chroma > 0 ? "mycc" : spaces[plan->form]);
    if (plan->functions.kind == FUNCTIONS_GRID) {
        jgap(w, "\n");
        jput_integer(w, "resolution", plan->functions.resolution);
    }
    if (plan->functions.kind == FUNCTIONS_GAUSS) {
        jgap(w, "\n");
        jput_number(w, "sigma", plan->functions.sigma, 6);
        put_lights(w, &plan->functions);
    }
}

static void put_counts(struct jwriter *w, const struct web_folder *folder)
{
    const int planes = web_planes(folder);
    jgap(w, "\n");
    if (folder->plan->chroma > 0) {
        const int chroma = min_of(folder->plan->chroma, folder->kept);
        const double counts[] = {planes - 2 * chroma, chroma, chroma};
        jput_numbers(w, "yccplanes", counts, 3, 0);
    } else {
        jput_integer(w, "nplanes", planes);
    }
}

static void put_materials(struct jwriter *w, const struct web_folder *folder, bool joint)
{
    jgap(w, "\n");
    jopen_array(w, "materials");
    jgap(w, "\n");
    jopen_object(w, NULL);
    put_column(w, folder, "scale", SCALE);
    put_column(w, folder, "bias", BIAS);
    if (joint)
        put_column(w, folder, "range", RANGE);
    jgap(w, "\n");
    jclose(w);
    jgap(w, "\n");
    jclose(w);
}

relume_status web_write_info(const struct web_folder *folder, const char *path, int quality,
                             const struct relume_log *log)
{
    const bool joint = folder->plan->form == FOREIGN_JOINT;
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, "\n");
    jput_integer(&w, "width", folder->planes->width);
    jput_integer(&w, "height", folder->planes->height);
    jgap(&w, "\n");
    jput_text(&w, "format", "jpg");
    put_functions(&w, folder->plan);
    put_counts(&w, folder);
    jgap(&w, "\n");
    jput_integer(&w, "quality", quality);
    if (joint)
        put_basis(&w, folder->plan, web_planes(folder));
    put_materials(&w, folder, joint);
    jgap(&w, "\n");
    return jsave_in(&w, path, "info.json", log);
}

relume_status web_write_planes(const struct web_folder *w, const char *path,
                               const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < w->kept; i++) {
        char *name = mem_format("%s/plane_%d.jpg", path, i);
        status =
            name ? outfile_save(name, w->sheet[i].bytes, w->sheet[i].size, log) : RELUME_ENOMEM;
        mem_free(name);
    }
    return status;
}
