// field.c - the material of many pixels, and their normals
#include "capture/stereo/field.h"

#include "core/base/memory.h"

static size_t slot_floats(const struct stereo_field *f)
{
    return 2 * (size_t)f->stride + reflect_floats(f->lights);
}

// Floats of each learner, which it keeps when it is forgotten.
static void prepare_learners(struct stereo_field *f)
{
    for (int i = 0; i < STEREO_LEARNERS; i++) {
        float *const floats = f->learner_floats + (size_t)i * slot_floats(f);
        f->learner_lights[i] =
            (struct reflect_lights){f->lights, f->stride, .at = floats + 2 * (size_t)f->stride};
        f->learner[i] = (struct stereo_pixel){
            .lights = f->is_shared ? f->around : f->learner_lights + i,
            .value = floats,
            .weight = floats + f->stride,
        };
    }
}

relume_status stereo_field_create(struct stereo_field *out, int lights, int threads,
                                  const vec3 *direction, vec3 eye, size_t every)
{
    const size_t stride = (size_t)reflect_stride(lights), floats = reflect_floats(lights);
    const size_t workers = (size_t)threads;
    struct stereo_field *const f = out;
    *f = (struct stereo_field){.lights = lights,
                               .stride = (int)stride,
                               .threads = threads,
                               .is_shared = direction != NULL,
                               .every = every};
    f->scratch = mem_zeroed(workers, sizeof *f->scratch);
    f->around = mem_zeroed(workers, sizeof *f->around);
    f->around_floats = mem_array(workers * floats, sizeof *f->around_floats);
    f->value = mem_array(workers * stride, sizeof *f->value);
    f->learner = mem_array(STEREO_LEARNERS, sizeof *f->learner);
    f->learner_lights = mem_array(STEREO_LEARNERS, sizeof *f->learner_lights);
    f->learner_floats = mem_array(STEREO_LEARNERS * slot_floats(f), sizeof *f->learner_floats);
    if (!f->scratch || !f->around || !f->around_floats || !f->value || !f->learner ||
        !f->learner_lights || !f->learner_floats)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (size_t i = 0; i < workers && !status; i++) {
        f->around[i] = (struct reflect_lights){
            lights, (int)stride, .at = f->around_floats + (direction ? 0 : i * floats)};
        if (direction)
            reflect_lights_set(f->around + i, direction, eye);
        status = stereo_scratch_create(f->scratch + i, lights);
    }
    prepare_learners(f);
    return status;
}

void stereo_field_destroy(struct stereo_field *f)
{
    for (int i = 0; f->scratch && i < f->threads; i++)
        stereo_scratch_destroy(f->scratch + i);
    mem_free(f->scratch);
    mem_free(f->around);
    mem_free(f->around_floats);
    mem_free(f->value);
    mem_free(f->learner);
    mem_free(f->learner_lights);
    mem_free(f->learner_floats);
    stereo_table_destroy(&f->table);
    *f = (struct stereo_field){0};
}

// ---------------------------------------------------------------- learning

bool stereo_field_next(struct stereo_field *f)
{
    return f->seen++ % f->every == 0;
}

static void forget_half(struct stereo_field *f)
{
    for (int i = 0; i < STEREO_LEARNERS / 2; i++) {
        const struct stereo_pixel forgotten = f->learner[i];
        f->learner[i] = f->learner[2 * i];
        f->learner[2 * i] = forgotten;
    }
    f->learners = STEREO_LEARNERS / 2;
    f->every *= 2;
}

static void clear_behind(const struct stereo_field *f, float *value)
{
    for (int i = f->lights; i < f->stride; i++)
        value[i] = -1.0f;
}

float *stereo_field_add(struct stereo_field *f, vec3 normal, const vec3 *direction, vec3 eye)
{
    if (f->learners == STEREO_LEARNERS)
        forget_half(f);
    struct stereo_pixel *const p = f->learner + f->learners++;
    float *const value = p->weight - f->stride;
    if (!f->is_shared)
        reflect_lights_set(f->learner_lights + (size_t)(value - f->learner_floats) / slot_floats(f),
                           direction, eye);
    p->normal = normal;
    clear_behind(f, value);
    return value;
}

relume_status stereo_field_learn(struct stereo_field *f)
{
    f->is_matte = !stereo_learn(&f->material, f->learner, f->learners, f->scratch, f->threads);
    return f->is_shared && !f->is_matte
               ? stereo_table_create(&f->table, &f->material, f->around, f->scratch)
               : RELUME_OK;
}

// ---------------------------------------------------------------- solving

float *stereo_field_values(struct stereo_field *f, int worker)
{
    float *const value = f->value + worker * f->stride;
    clear_behind(f, value);
    return value;
}

// Of few lights a material may be learnt that is not there. It errs otherwise than Lambert's law,
// with which the normal was guessed: from 6 to 19 lights the normal lies between both.
static const double of_few = 0.6, of_each = 0.02;

float stereo_field_solve(struct stereo_field *f, int worker, const vec3 *direction, vec3 eye,
                         vec3 *normal)
{
    struct stereo_pixel pixel = {
        .lights = f->around + worker,
        .value = f->value + worker * f->stride,
        .normal = *normal,
    };
    if (!f->is_shared)
        reflect_lights_set(f->around + worker, direction, eye);
    if (!stereo_solve(&pixel, &f->material, f->is_shared ? &f->table : NULL, f->scratch + worker))
        return 0.0f;
    const double share = fmin(of_few + of_each * f->lights, 1.0);
    *normal = vec3_unit(vec3_along(vec3_scale(*normal, 1.0 - share), pixel.normal, share));
    return pixel.sure;
}
