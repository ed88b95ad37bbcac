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

void json_number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.9g", value);
    else
        fputs("null", out);
}

// Beyond the first 65536 characters JSON writes two halves.
static void json_escape(FILE *out, uint32_t code)
{
    if (code >= 0x10000)
        fprintf(out, "\\u%04x\\u%04x", (unsigned)(0xd800 + ((code - 0x10000) >> 10)),
                (unsigned)(0xdc00 + (code & 0x3ff)));
    else
        fprintf(out, "\\u%04x", (unsigned)code);
}

void json_text(FILE *out, const char *text)
{
    uint32_t code;
    fputc('"', out);
    for (int n = relume_text_step(&code, text); n; n = relume_text_step(&code, text)) {
        if (code == '"' || code == '\\')
            fprintf(out, "\\%c", (char)code);
        else if (relume_text_harmless(code))
            fwrite(text, 1, (size_t)n, out);
        else
            json_escape(out, code);
        text += n;
    }
    fputc('"', out);
}
