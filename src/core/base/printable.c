// printable.c - texts that a terminal shows and does not obey
//
// File names, notes in pictures and fields of other people's files go into messages. Escape
// sequences, the C1 controls (U+009B starts one too), line breaks, and the characters that turn the
// direction of what follows (Unicode TR 36) would act on the terminal or make a name look like
// another.
#include <relume/base.h>

enum { REPLACEMENT = 0xfffd };

// The bytes that a character's first byte announces; 0 where none begins so.
static int announced(unsigned char first)
{
    return first < 0x80                    ? 1
           : first >= 0xc2 && first < 0xe0 ? 2
           : first >= 0xe0 && first < 0xf0 ? 3
           : first >= 0xf0 && first < 0xf5 ? 4
                                           : 0;
}

int relume_text_step(uint32_t *code, const char *text)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *at = (const unsigned char *)text;
    const int n = announced(*at);
    *code = n == 1 ? *at : *at & (0xffu >> (n + 1));
    for (int i = 1; i < n; i++) {
        if ((at[i] & 0xc0) != 0x80) {
            *code = REPLACEMENT;
            return 1;
        }
        *code = *code << 6 | (at[i] & 0x3fu);
    }
    const bool surrogate = *code >= 0xd800 && *code < 0xe000;
    if (n && *code >= least[n] && *code <= 0x10ffff && !surrogate)
        return *at ? n : 0;
    *code = REPLACEMENT;
    return 1;
}

bool relume_text_harmless(uint32_t code)
{
    static const uint32_t harmful[][2] = {
        {0x00, 0x1f},       {0x7f, 0x9f},     {0x061c, 0x061c},  // controls; Arabic letter mark
        {0x200b, 0x200f},   {0x2028, 0x202e},  // no width, marks, line ends, turns
        {0x2060, 0x206f},   {0xfeff, 0xfeff}, {0xfff9, 0xfffb},  // isolates; no width; annotation
        {0xe0000, 0xe007f},                                      // tags
    };
    for (size_t i = 0; i < sizeof harmful / sizeof *harmful; i++)
        if (code >= harmful[i][0] && code <= harmful[i][1])
            return false;
    return code != REPLACEMENT;
}

char *relume_printable(char *text)
{
    uint32_t code;
    char *to = text;
    const char *from = text;
    for (int n = relume_text_step(&code, from); n; n = relume_text_step(&code, from)) {
        if (relume_text_harmless(code))
            for (int i = 0; i < n; i++)
                *to++ = from[i];
        else
            *to++ = '?';
        from += n;
    }
    *to = '\0';
    return text;
}
