// functions.c - whole steps of learned functions, by a range coder, as digits of 64
#include "format/pack/functions.h"

#include "core/base/memory.h"
#include "core/math/base64.h"
#include "format/lossy/entropy.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { BASE = 64, DIGIT_BITS = 6 };

// Steps are 2^-e: the digit of e, from the coarsest on.
enum { COARSEST = -32, FINEST = COARSEST + BASE - 1, MOST_STEPS = 32767 };

static int digit_of(char c)
{
    const char *found = c ? strchr(base64_digits, c) : NULL;
    return found ? (int)(found - base64_digits) : -1;
}

// ---------------------------------------------------------------- models

// One for each fineness, and whether a channel was foretold.
enum { FINENESS = 16 };

struct model {
    struct entropy_chance any, sign, more[ENTROPY_BITS + 1];
};

static struct model *create_models(void)
{
    struct model *m = mem_array(2 * FINENESS, sizeof *m);
    for (int i = 0; m && i < 2 * FINENESS; i++) {
        m[i].any = m[i].sign = ENTROPY_EVEN;
        for (int k = 0; k <= ENTROPY_BITS; k++)
            m[i].more[k] = ENTROPY_EVEN;
    }
    return m;
}

static struct entropy_whole chances(struct model *m, int exponent, bool foretold)
{
    const int fineness = exponent < 0 ? 0 : exponent < FINENESS ? exponent : FINENESS - 1;
    struct model *own = &m[2 * fineness + foretold];
    return (struct entropy_whole){&own->any, &own->sign, own->more};
}

// Least squares of the numbers so far over those of the channel before, in 1 / 256.
enum { RATIO_ONE = 256 };
struct ratio {
    int64_t products, squares;
};

static int limited(int64_t steps)
{
    return (int)(steps < -MOST_STEPS ? -MOST_STEPS : steps > MOST_STEPS ? MOST_STEPS : steps);
}

static int foretold(const struct ratio *r, int before)
{
    const int64_t ratio = r->squares ? limited(r->products * RATIO_ONE / r->squares) : 0;
    return limited(ratio * before / RATIO_ONE);
}

static void learn(struct ratio *r, int before, int steps)
{
    r->products += (int64_t)before * steps;
    r->squares += (int64_t)before * before;
}

// ---------------------------------------------------------------- steps

// The coarsest that is allowed, and not too fine for the largest number.
static int exponent_of(const float *numbers, int components, int each, float most, double allowed)
{
    float largest = 0.0f;
    int e = COARSEST;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < each; i++)
            largest = fmaxf(
                largest, fabsf(numbers[(size_t)c * (size_t)components * (size_t)each + (size_t)i]));
    while (e < FINEST && ldexp((double)most, -e) > allowed &&
           ldexp((double)largest, e + 1) <= MOST_STEPS)
        e++;
    return e;
}

struct steps {
    int *step;      // [3][components][each]
    int *exponent;  // [components]
    int components, each;
};

static bool create_steps(struct steps *s, int components, int each)
{
    *s = (struct steps){mem_array(3 * (size_t)components, (size_t)each * sizeof *s->step),
                        mem_array((size_t)components, sizeof *s->exponent), components, each};
    return s->step && s->exponent;
}

static void destroy_steps(struct steps *s)
{
    mem_free(s->step);
    mem_free(s->exponent);
}

static size_t row_of(const struct steps *s, int channel, int component)
{
    return ((size_t)channel * (size_t)s->components + (size_t)component) * (size_t)s->each;
}

// Row by row; `get` is NULL while they are put.
static void code_steps(struct steps *s, struct model *m, struct entropy_writer *put,
                       struct entropy_reader *get)
{
    for (int r = 0; r < 3 * s->components; r++) {
        const int channel = r / s->components, component = r % s->components;
        const struct entropy_whole by = chances(m, s->exponent[component], channel > 0);
        const int *before = channel ? s->step + row_of(s, channel - 1, component) : NULL;
        int *own = s->step + row_of(s, channel, component);
        struct ratio ratio = {0, 0};
        for (int i = 0; i < s->each; i++) {
            const int guess = before ? foretold(&ratio, before[i]) : 0;
            if (get)
                own[i] = limited((int64_t)guess + entropy_get_whole(get, &by));
            else
                entropy_put_whole(put, &by, own[i] - guess);
            if (before)
                learn(&ratio, before[i], own[i]);
        }
    }
}

// ---------------------------------------------------------------- text

// Zeros at the end are none of the text.
static char *text_of(const struct steps *s, const struct entropy_writer *w)
{
    size_t size = w->size;
    while (size && !w->byte[size - 1])
        size--;
    const size_t digits = (8 * size + DIGIT_BITS - 1) / DIGIT_BITS, head = (size_t)s->components;
    char *text = w->failed ? NULL : mem_array(head + digits + 1, 1);
    if (!text)
        return NULL;
    for (size_t k = 0; k < head; k++)
        text[k] = base64_digits[s->exponent[k] - COARSEST];
    for (size_t k = 0; k < digits; k++) {
        unsigned digit = 0;
        for (size_t bit = DIGIT_BITS * k; bit < DIGIT_BITS * (k + 1); bit++)
            digit = 2 * digit + (bit < 8 * size ? w->byte[bit / 8] >> (7 - bit % 8) & 1u : 0u);
        text[head + k] = base64_digits[digit];
    }
    text[head + digits] = 0;
    return text;
}

static relume_status bytes_of(unsigned char *byte, const char *text, size_t digits)
{
    for (size_t k = 0; k < digits; k++) {
        const int digit = digit_of(text[k]);
        if (digit < 0)
            return RELUME_EDAMAGED;
        for (size_t i = 0; i < DIGIT_BITS; i++) {
            const size_t bit = DIGIT_BITS * k + i;
            const unsigned set = (unsigned)digit >> (DIGIT_BITS - 1 - i) & 1u;
            byte[bit / 8] = (unsigned char)(byte[bit / 8] | set << (7 - bit % 8));
        }
    }
    return RELUME_OK;
}

char *functions_text(const float *numbers, int components, int each, const float *most,
                     double allowed)
{
    struct steps s;
    struct entropy_writer w = entropy_write();
    struct model *model = create_models();
    char *text = NULL;
    if (create_steps(&s, components, each) && model) {
        for (int k = 0; k < components; k++) {
            s.exponent[k] =
                exponent_of(numbers + (size_t)k * (size_t)each, components, each, most[k], allowed);
            for (int c = 0; c < 3; c++)
                for (size_t i = row_of(&s, c, k); i < row_of(&s, c, k) + (size_t)each; i++)
                    s.step[i] = limited(llrint(ldexp((double)numbers[i], s.exponent[k])));
        }
        code_steps(&s, model, &w, NULL);
        entropy_end(&w);
        text = text_of(&s, &w);
    }
    mem_free(w.byte);
    mem_free(model);
    destroy_steps(&s);
    return text;
}

relume_status functions_of_text(float *numbers, const char *text, int components, int each)
{
    const size_t length = strlen(text), head = (size_t)components;
    if (length < head)
        return RELUME_EDAMAGED;
    struct steps s;
    struct model *model = create_models();
    const size_t digits = length - head, size = (digits * DIGIT_BITS + 7) / 8;
    unsigned char *byte = mem_zeroed(size + 1, 1);
    const bool good = create_steps(&s, components, each);
    relume_status status = good && model && byte ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = bytes_of(byte, text + head, digits);
    for (int k = 0; !status && k < components; k++) {
        s.exponent[k] = COARSEST + digit_of(text[k]);
        if (s.exponent[k] < COARSEST)
            status = RELUME_EDAMAGED;
    }
    if (!status) {
        struct entropy_reader r = entropy_read(byte, size);
        code_steps(&s, model, NULL, &r);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < components; k++)
                for (size_t i = row_of(&s, c, k); i < row_of(&s, c, k) + (size_t)each; i++)
                    numbers[i] = ldexpf((float)s.step[i], -s.exponent[k]);
    }
    mem_free(byte);
    mem_free(model);
    destroy_steps(&s);
    return status;
}

bool functions_of_digits(float *numbers, const char *text, const float *most, int rows, int each)
{
    enum { NOTHING = BASE * BASE / 2, MOST = NOTHING - 1 };
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < each; i++, text += 2) {
            const int high = digit_of(text[0]), low = digit_of(text[1]);
            if (high < 0 || low < 0)
                return false;
            *numbers++ = most[r] * (float)(BASE * high + low - NOTHING) / (float)MOST;
        }
    return true;
}
