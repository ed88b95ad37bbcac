// panel_font.cpp - the letters of the panel: a TrueType file, else those that Dear ImGui brings
#include "panel/panel_parts.h"

#include <imgui_internal.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>

// Latin with all its accents, Greek and Cyrillic (names of files), punctuation, currencies, arrows.
static const ImWchar letters[] = {0x0020, 0x052f, 0x1e00, 0x1eff, 0x2010, 0x205e,
                                  0x20a0, 0x20bf, 0x2190, 0x2195, 0};

static size_t number(const unsigned char *at, int bytes)
{
    size_t n = 0;
    for (int i = 0; i < bytes; i++)
        n = n << 8 | at[i];
    return n;
}

// Dear ImGui trusts a font; that all its tables lie in the file is looked at here.
static bool is_font(const unsigned char *file, size_t size)
{
    const size_t head = 12, entry = 16;
    if (size < head || std::memcmp(file, "\0\1\0", 4))
        return false;
    const size_t tables = number(file + 4, 2);
    if (size < head + entry * tables)
        return false;
    for (size_t i = 0; i < tables; i++) {
        const unsigned char *at = file + head + entry * i;
        const size_t from = number(at + 8, 4);
        if (from > size || number(at + 12, 4) > size - from)
            return false;
    }
    return tables > 0;
}

// Dear ImGui would take all memory for a folder, and wait for a pipe.
static void *load(const char *path, size_t *size)
{
    struct stat about;
    const bool fits = !stat(path, &about) && S_ISREG(about.st_mode) && about.st_size < 64 << 20;
    return fits ? ImFileLoadToMemory(path, "rb", size) : nullptr;
}

bool panel_add_font(const char *path, float scale)
{
    size_t size = 0;
    void *file = load(path, &size);
    if (!file || !is_font((const unsigned char *)file, size)) {
        ImGui::MemFree(file);
        return false;
    }
    ImFontConfig config;
    config.OversampleH = scale < 2 ? 2 : 1;
    config.PixelSnapH = true;
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    atlas->AddFontFromMemoryTTF(file, (int)size, std::floor(15 * scale), &config, letters);
    if (atlas->Build())
        return true;
    atlas->Clear();
    return false;
}

void panel_add_plain_font(float scale)
{
    ImFontConfig config;
    config.SizePixels = std::floor(13 * scale);
    ImGui::GetIO().Fonts->AddFontDefault(&config);
}
