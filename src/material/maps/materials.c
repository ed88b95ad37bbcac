// materials.c - the codebook of gloss, learned from pixels all over the picture
//
// Every pixel is tried with every candidate of a coarse table. The codebook grows by the candidate
// that lowers the sum of the pixels' losses most, each pixel being free to choose, as long as that
// is worth an entry; then each entry is moved to where the pixels that chose it fit best.
#include "material/maps/materials.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

// A matte surface comes first, and what is found later has to be better: so that nothing shines
// that need not.
static const float TRIED_F0[] = {0.02f, 0.04f, 0.07f, 0.12f, 0.2f};
static const float MOST_F0 = 0.25f;  // of what is no metal: above that of diamond
static const float TRIED_ROUGHNESS[] = {0.1f,  0.16f, 0.22f, 0.28f, 0.34f, 0.41f,
                                        0.48f, 0.56f, 0.65f, 0.75f, 0.87f, 1.0f};
enum {
    F0S = sizeof TRIED_F0 / sizeof *TRIED_F0,
    ROUGHNESSES = sizeof TRIED_ROUGHNESS / sizeof *TRIED_ROUGHNESS,
    CANDIDATES = 1 + F0S * ROUGHNESSES + ROUGHNESSES,
    ROUNDS = 3,
    TRIED = 2,  // turns of a normal
    TURNS = 4,
};
static const float WORTH = 0.01f;  // of the loss that an entry must take away
// Losses of metals count so much more: they are rare, and a rough one is much like a matte surface.
static const float METALLIC = 1.5f, ROUGHEST_METAL = 0.6f;
static const float NOTHING = 1e-6f;  // a mean loss that is none: a step of 8 bits is 1e-5

static struct gloss candidate(int i)
{
    const int r = (i - 1) % ROUGHNESSES, f = (i - 1) / ROUGHNESSES;
    if (i == 0)
        return (struct gloss){.roughness = 1.0f};
    return (struct gloss){f == F0S, f < F0S ? TRIED_F0[f] : 1.0f, TRIED_ROUGHNESS[r]};
}

static float penalty(const struct gloss *g)
{
    return !g->metal ? 1.0f : g->roughness > ROUGHEST_METAL ? INFINITY : METALLIC;
}

struct learning {
    struct learner *learner;
    size_t learners;
    int threads;
    struct materials *found;
    float *loss;  // [learners][CANDIDATES]
    float *best;  // [learners]
    // of one entry that is moved
    int entry;
    struct gloss moved;
};

// The loss where the normal may follow, which it becomes.
static float loss_with(float normal[3], const struct learner *l, const struct gloss *g, int turns)
{
    float colour[3], start[3];
    gloss_start(start, &l->look, g, l->matte);
    for (int c = 0; c < 3; c++)
        normal[c] = start[c];
    gloss_try(colour, &l->look, g, normal, l->albedo);
    return penalty(g) * gloss_straighten(normal, colour, &l->look, g, start, turns);
}

static void try_candidates(void *context, size_t item, int worker)
{
    (void)worker;
    const struct learning *s = context;
    for (int i = 0; i < CANDIDATES; i++) {
        const struct gloss g = candidate(i);
        float normal[3];
        s->loss[item * CANDIDATES + (size_t)i] = loss_with(normal, &s->learner[item], &g, TRIED);
    }
}

// The sum of losses with candidate `i` beside the entries that are there.
static double sum_with(const struct learning *s, int i)
{
    double sum = 0.0;
    for (size_t p = 0; p < s->learners; p++)
        sum += (double)fminf(s->best[p], s->loss[p * CANDIDATES + (size_t)i]);
    return sum;
}

static void grow(struct learning *s, int most)
{
    double before = 1e30;
    for (size_t p = 0; p < s->learners; p++)
        s->best[p] = 1e10f;
    while (s->found->count < most) {
        const bool first = s->found->count == 0;
        int chosen = 0;
        double least = sum_with(s, 0);
        for (int i = 1; i < CANDIDATES; i++) {
            const double sum = sum_with(s, i);
            // of two that are as good the one that came first
            if (sum < least * (1.0 - 1e-4) - (double)s->learners * 1e-9)
                chosen = i, least = sum;
        }
        if (!first && (least > before * (1.0 - (double)WORTH) ||
                       before < (double)NOTHING * (double)s->learners))
            break;
        s->found->gloss[s->found->count++] = candidate(chosen);
        for (size_t p = 0; p < s->learners; p++)
            s->best[p] = fminf(s->best[p], s->loss[p * CANDIDATES + (size_t)chosen]);
        before = least;
    }
}

static void choose(void *context, size_t item, int worker)
{
    (void)worker;
    const struct learning *s = context;
    struct learner *l = &s->learner[item];
    float least = 1e30f;
    for (int i = 0; i < s->found->count; i++) {
        float normal[3];
        const float loss = loss_with(normal, l, &s->found->gloss[i], TURNS);
        if (loss >= least)
            continue;
        l->material = i, least = loss;
        for (int c = 0; c < 3; c++)
            l->normal[c] = normal[c];
    }
}

// ---------------------------------------------------------------- an entry is moved

static void lose(void *context, size_t item, int worker)
{
    (void)worker;
    const struct learning *s = context;
    const struct learner *l = &s->learner[item];
    float colour[3];
    s->best[item] =
        l->material == s->entry
            ? penalty(&s->moved) * gloss_try(colour, &l->look, &s->moved, l->normal, l->albedo)
            : 0.0f;
}

static double loss_of_entry(struct learning *s, struct gloss moved)
{
    double sum = 0.0;
    s->moved = moved;
    thread_for(s->threads, s->learners, lose, s);
    for (size_t p = 0; p < s->learners; p++)
        sum += (double)s->best[p];
    return sum;
}

// By patterns that shrink: roughness in steps, f0 in factors.
static void move(struct learning *s, int entry)
{
    struct gloss *g = &s->found->gloss[entry];
    s->entry = entry;
    if (!g->metal && g->f0 == 0.0f)
        return;
    double least = loss_of_entry(s, *g);
    for (float step = 1.0f; step > 0.03f; step *= 0.5f)
        for (int way = 0; way < (g->metal ? 2 : 4); way++) {
            const float to = way % 2 ? -step : step;
            struct gloss next = *g;
            if (way < 2)
                next.roughness = fminf(fmaxf(g->roughness + 0.06f * to, GGX_LEAST_ROUGHNESS), 1.0f);
            else
                next.f0 = fminf(g->f0 * exp2f(0.6f * to), MOST_F0);
            const double loss = loss_of_entry(s, next);
            if (loss < least)
                *g = next, least = loss;
        }
}

static void learn(struct learning *s, int most)
{
    thread_for(s->threads, s->learners, try_candidates, s);
    grow(s, most);
    thread_for(s->threads, s->learners, choose, s);
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < s->found->count; i++)
            move(s, i);
        thread_for(s->threads, s->learners, choose, s);
    }
}

relume_status materials_learn(struct materials *out, struct learner *learner, size_t learners,
                              int most, bool matte, int threads)
{
    struct learning s = {learner, learners, threads, out, NULL, NULL, 0, {0}};
    *out = (struct materials){.count = 1, .gloss = {{.roughness = 1.0f}}};
    if (matte)
        return RELUME_OK;
    s.loss = mem_array(learners * CANDIDATES, sizeof *s.loss);
    s.best = mem_array(learners, sizeof *s.best);
    const relume_status status = s.loss && s.best ? RELUME_OK : RELUME_ENOMEM;
    out->count = 0;
    if (!status)
        learn(&s, most);
    mem_free(s.loss);
    mem_free(s.best);
    return status;
}
