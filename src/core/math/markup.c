// markup.c - texts of people in pages, and what reports look like
#include "core/math/markup.h"

const char markup_style[] =
    "body{margin:2em auto;padding:0 1em;color:#222}h1{font-size:22px}"
    "h2{font-size:17px;margin-top:1.8em}figure{margin:0;max-width:100%}"
    ".row{display:flex;flex-wrap:wrap;gap:16px}.over{position:relative}"
    "table{border-collapse:collapse}td,th{padding:2px 10px;text-align:right}"
    "th{border-bottom:1px solid #999}td:first-child,th:first-child{text-align:left}"
    ".good{color:#060}.warn{background:#fff3d6;border-left:4px solid #e0a000;padding:4px 10px}";

// The next character, a blank for line ends and '?' for what is no text; 0 at the end.
static uint32_t next(const char **text, int *bytes)
{
    uint32_t code;
    *bytes = relume_text_step(&code, *text);
    *text += *bytes;
    return !*bytes                        ? 0
           : code == '\n' || code == '\t' ? ' '
           : relume_text_harmless(code)   ? code
                                          : '?';
}

void markup_escape(FILE *to, const char *text, const char *(*escape)(uint32_t code))
{
    int n = 0;
    for (uint32_t code; text && (code = next(&text, &n));) {
        const char *instead = escape(code);
        if (instead)
            fputs(instead, to);
        else if (code < 0x80)
            putc((int)code, to);
        else
            fwrite(text - n, 1, (size_t)n, to);
    }
}

static const char *html(uint32_t code)
{
    switch (code) {
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '&': return "&amp;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return NULL;
    }
}

void markup_text(FILE *to, const char *text)
{
    markup_escape(to, text, html);
}
