// fuzz_subject.c - subjects made of noise; what is accepted lives for a second, and where it stands
// in its own light every number must be finite
#include "relight/eye/pupil.h"

#include "fuzz.h"

static const char *const words[] = {"format",     "relume-subject",
                                    "version",    "seed",
                                    "pupil",      "cornea",
                                    "lens",       "fibres",
                                    "vitreous",   "lids",
                                    "optics",     "count",
                                    "spread",     "radius_mm",
                                    "kick",       "damping",
                                    "halo_deg",   "squint",
                                    "1e308",      "-0",
                                    "nan",        "20000",
                                    "0.001",      "1e-300",
                                    "true",       "null",
                                    "{",          "}",
                                    ",",          "\"",
                                    "hippus",     "lashes",
                                    "lash_image", "opacity",
                                    "nucleus",    "inner_mm",
                                    "spokes",     "body_radius_mm",
                                    "blink_s",    "outer_mm",
                                    "width_mm",   "age",
                                    NULL};

static void check_numbers(const float *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(numbers[i]))
            abort();
}

static void live(const struct relume_subject *subject)
{
    relume_eye *eye;
    if (relume_eye_create(&eye, subject, 1.0))
        return;  // only memory can be short
    if (relume_eye_advance(eye, 0.1, 1e4) || relume_eye_advance(eye, 3600.0, 0.0))
        abort();
    const struct relume_aperture *const a = relume_eye_aperture(eye);
    const size_t discs = (size_t)(a->vitreous.first + a->vitreous.count);
    const size_t strokes = (size_t)(a->lashes.first + a->lashes.count);
    check_numbers(&a->pupil_radius, 1);
    check_numbers((const float *)a->disc, discs * sizeof *a->disc / sizeof(float));
    check_numbers((const float *)a->stroke, strokes * sizeof *a->stroke / sizeof(float));
    relume_eye_destroy(&eye);
}

static bool one(struct fuzz *f, struct bytes b)
{
    struct relume_subject subject;
    fuzz_store(f->path, b);
    if (relume_subject_load(&subject, f->path, NULL))
        return false;
    live(&subject);
    return true;
}

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_subject", argc, argv);
    fuzz_add(&f, text("{\"format\":\"relume-subject\",\"version\":1}"));
    fuzz_add(&f,
             text("{\"format\":\"relume-subject\",\"version\":1,\"seed\":3,\"lens\":{\"count\":5,"
                  "\"radius_mm\":0.05,\"spread\":2,\"travel_mm\":0.1},\"lids\":{\"squint\":0.2}}"));
    fuzz_add(&f, text("{\"format\":\"relume-subject\",\"version\":1,\"fibres\":{\"halo_deg\":2,"
                      "\"inner_mm\":1,\"outer_mm\":3,\"opacity\":1},\"vitreous\":{\"count\":9,"
                      "\"damping\":0.1,\"kick\":10,\"saccades_per_s\":20}}"));
    return fuzz_run(&f, argc, argv, one);
}
