// develop.c - how a linear frame becomes a picture to look at: exposure and tone
#include "develop.h"

#include <math.h>
#include <string.h>

relume_status parse_developing(const struct develop_options *options, struct developing *d)
{
    const char *exposure = options->exposure ? options->exposure : "0";
    const char *tone = options->tone ? options->tone : relume_tone_linear.name;
    const char *names[16] = {NULL};
    *d = (struct developing){.automatic = !strcmp(exposure, "auto")};
    if (!d->automatic && (!parse_numbers(exposure, &d->tone.exposure_ev, 1) ||
                          !(fabs(d->tone.exposure_ev) <= 100.0)))
        return usage_error("--exposure: expected a number from -100 to 100, or auto; found '%s'",
                           exposure);
    for (int i = 0; relume_tones[i]; i++)
        names[i] = relume_tones[i]->name;
    d->tone.white = options->white;
    d->tone.tone = relume_tone_find(tone);
    return d->tone.tone ? RELUME_OK : unknown_name("--tone", tone, names);
}

static void expose(struct relume_image *frame, double ev)
{
    const float gain = exp2f((float)ev);
    const size_t samples = (size_t)frame->width * (size_t)frame->height * 3;
    for (size_t i = 0; i < samples; i++)
        frame->data[i] *= gain;
}

relume_status develop(struct relume_image *frame, struct developing d, const char *path)
{
    if (d.automatic)
        d.tone.exposure_ev = relume_tone_meter(frame);
    if (!relume_image_saves_linear(path))
        return relume_tone_apply(frame, &d.tone);
    expose(frame, d.tone.exposure_ev);
    return RELUME_OK;
}
