// provenance.c - what a capture or a file remembers of its photographs
#include "capture/manifest/provenance.h"

#include "core/base/json.h"

#include <math.h>
#include <stdio.h>

static void read_part(struct provenance *out, const jvalue *part)
{
    double at[4];
    if (jvalue_numbers(part, at, 4) && fmin(at[0], at[1]) >= 0.0 && fmin(at[2], at[3]) >= 1.0 &&
        fmax(fmax(at[0], at[1]), fmax(at[2], at[3])) <= 1e9)
        out->part = (struct relume_rect){(int)at[0], (int)at[1], (int)at[2], (int)at[3]};
}

static void read_balls(struct provenance *out, const jvalue *balls)
{
    double at[3];
    for (size_t i = 0; i < jvalue_count(balls) && i < PROVENANCE_BALLS; i++)
        if (jvalue_numbers(jvalue_item(balls, i), at, 3) && at[2] > 0.0)
            out->ball[out->balls++] = (struct relume_ball){
                .x = at[0] - out->part.left, .y = at[1] - out->part.top, .radius = at[2]};
}

void provenance_read(struct provenance *out, const char *text)
{
    jvalue *root = NULL;
    *out = (struct provenance){.balls = 0};
    if (!text || jvalue_parse(&root, text, NULL))
        return;
    const jvalue *first = jvalue_item(jvalue_member(root, "photographs"), 0);
    const char *sum = jvalue_text(jvalue_member(first, "sha256"));
    snprintf(out->photograph, sizeof out->photograph, "%s", sum ? sum : "");
    read_part(out, jvalue_member(root, "crop"));
    read_balls(out, jvalue_member(root, "balls"));
    jvalue_free(&root);
}

char *provenance_crop(const char *text, const struct relume_rect *part)
{
    struct provenance before;
    jvalue *root = NULL;
    char *cropped = NULL;
    provenance_read(&before, text);
    const int crop[4] = {before.part.left + part->left, before.part.top + part->top, part->width,
                         part->height};
    if (!jvalue_parse(&root, text, NULL) && jvalue_set_integers(root, "crop", crop, 4))
        cropped = jvalue_print(root);
    jvalue_free(&root);
    return cropped;
}
