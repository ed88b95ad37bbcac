// print.c - texts and numbers of others, as people and programs may read them
#include "cli.h"

#include <math.h>

const char *shown(struct shown *out, const char *text)
{
    snprintf(out->text, sizeof out->text, "%s", text);
    return relume_printable(out->text);
}

const char *judgement(double psnr_db)
{
    return psnr_db >= 45.0   ? "not visible"
           : psnr_db >= 38.0 ? "hardly visible"
           : psnr_db >= 30.0 ? "visible"
                             : "clearly visible";
}

struct jwriter json_to(FILE *out)
{
    return (struct jwriter){.file = out, .style = JSON_TERMINAL};
}

struct jwriter json_dense(void)
{
    return (struct jwriter){.file = stdout, .style = JSON_TERMINAL | JSON_DENSE};
}

void json_measure(struct jwriter *w, const char *key, double value)
{
    if (value == floor(value))
        jput_fixed(w, key, value, 0);
    else
        jput_number(w, key, value, 9);
}
