// light_names.c - whose light is whose: names in a list and names of photographs
#include "capture/manifest/light_names.h"

#include "core/base/arena.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// Ways to compare names, the strictest first. A later one sees only what earlier ones have left.
enum tier { TIER_FOLDER, TIER_NAME, TIER_STEM, TIER_LETTERS, TIER_NUMBERED, TIERS };

static bool is_slash(char c)
{
    return c == '/' || c == '\\';
}

const char *light_names_base(const char *path)
{
    const char *name = path + strlen(path);
    while (name > path && !is_slash(name[-1]))
        name--;
    return name;
}

// The dot of the ending of a picture, or the end of `name`.
static const char *picture_ending(const char *name)
{
    static const char *const endings[] = {
        "jpg", "jpeg", "png", "tif", "tiff", "exr", "hdr", "pfm",  "bmp",  "tga", "ppm", "pgm",
        "jp2", "webp", "dpx", "gif", "dng",  "cr2", "cr3", "nef",  "arw",  "orf", "raf", "rw2",
        "pef", "srw",  "crw", "nrw", "erf",  "3fr", "jxl", "heic", "avif", NULL};
    const char *dot = strrchr(name, '.');
    for (const char *const *e = endings; dot && *e; e++)
        if (!strcasecmp(dot + 1, *e))
            return dot;
    return name + strlen(name);
}

bool light_names_is_picture(const char *name)
{
    return *picture_ending(name) != '\0';
}

// ---------------------------------------------------------------- letters

// One code of UTF-8; a byte that does not belong to it is a letter of Latin-1.
static unsigned take_code(const char **at)
{
    const unsigned char *c = (const unsigned char *)*at;
    const int more = c[0] >= 0xf0 ? 3 : c[0] >= 0xe0 ? 2 : c[0] >= 0xc2 ? 1 : 0;
    unsigned code = more == 3 ? c[0] & 7u : more == 2 ? c[0] & 15u : c[0] & 31u;
    for (int i = 1; i <= more; i++) {
        if ((c[i] & 0xc0) != 0x80 || c[0] > 0xf4) {
            (*at)++;
            return c[0];
        }
        code = code << 6 | (c[i] & 0x3fu);
    }
    *at += more + 1;
    return more ? code : c[0];
}

// The plain letter in lower case under an accented one of Latin; 0: there is none.
static unsigned plain_letter(unsigned code)
{
    static const char latin[] =  // U+00C0 to U+017F
        "aaaaaa.ceeeeiiii.nooooo..uuuuy..aaaaaa.ceeeeiiii.nooooo..uuuuy.y"
        "aaaaaaccccccccdd..eeeeeeeeeegggggggghh..iiiiiiiii...jjkk.llllll."
        "...nnnnnn...oooooo..rrrrrrsssssssstttt..uuuuuuuuuuuuwwyyyzzzzzz.";
    static const char additional[] =  // U+1E00 to U+1EFF
        "aabbbbbbccddddddddddeeeeeeeeeeffgghhhhhhhhhhiiiikkkkkkllllllllmm"
        "mmmmnnnnnnnnoooooooopppprrrrrrrrssssssssssttttttttuuuuuuuuuuvvvv"
        "wwwwwwwwwwxxxxyyzzzzzzhtwy......aaaaaaaaaaaaaaaaaaaaaaaaeeeeeeee"
        "eeeeeeeeiiiioooooooooooooooooooooooouuuuuuuuuuuuuuyyyyyyyy......";
    const char *table = code >= 0xc0 && code < 0x180      ? latin + (code - 0xc0)
                        : code >= 0x1e00 && code < 0x1f00 ? additional + (code - 0x1e00)
                                                          : ".";
    return *table == '.' ? 0 : (unsigned char)*table;
}

// Lower case of ASCII and of the letters of Latin-1.
static unsigned lower(unsigned code)
{
    const bool upper =
        (code >= 'A' && code <= 'Z') || (code >= 0xc0 && code <= 0xde && code != 0xd7);
    return upper ? code + 32 : code;
}

static bool is_mark(unsigned code)
{
    return code >= 0x300 && code < 0x370;
}

// `text` up to `end` as codes that are equal where names are; `letters`: without marks.
static char *fold(struct arena *arena, const char *text, const char *end, bool letters)
{
    const size_t n = (size_t)(end - text);
    char *copy = arena_array(arena, n + 1, 1), *out = arena_array(arena, 8 * n + 1, 1), *to = out;
    if (!copy || !out)
        return NULL;
    memcpy(copy, text, n);
    for (const char *at = copy; *at;) {
        unsigned code = lower(take_code(&at));
        const unsigned plain = letters ? plain_letter(code) : 0;
        if (letters && is_mark(code))
            continue;
        code = plain ? plain : code == '\\' ? '/' : code;
        to += code < 0x80 ? snprintf(to, 2, "%c", (int)code) : snprintf(to, 9, "\x01%06x", code);
    }
    return out;
}

static const char *skip_number(const char *name)
{
    const char *at = name + strspn(name, "0123456789");
    return at > name && *at == ' ' ? at + strspn(at, " ") : name;
}

// The text by which a tier compares a name; "" leaves the name out. NULL without memory.
static char *make_key(struct arena *arena, const char *name, enum tier tier, bool listed)
{
    const char *base = light_names_base(name), *start = base;
    const char *end = tier >= TIER_STEM ? picture_ending(base) : base + strlen(base);
    if (tier == TIER_FOLDER) {
        while (start > name && start == base)
            start--;
        while (start > name && !is_slash(start[-1]))
            start--;
        end = start == base ? start : end;
    }
    if (tier == TIER_NUMBERED && listed)
        start = skip_number(base);
    return fold(arena, start, end, tier >= TIER_LETTERS);
}

// ---------------------------------------------------------------- pairing

struct key {
    const char *text;
    int light;
};

struct pairing {
    const struct light_names *list;
    const char *const *photograph;
    int photographs, matched;
    int *order;
    bool *used;         // lights
    int twice[2];       // lights of one name, -1: none
    int of_photograph;  // which it is
};

static int by_text(const void *a, const void *b)
{
    const struct key *one = a, *two = b;
    const int order = strcmp(one->text, two->text);
    return order ? order : one->light - two->light;
}

static int find_key(const struct key *keys, int n, const char *text)
{
    int low = 0, high = n;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (strcmp(keys[middle].text, text) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && !strcmp(keys[low].text, text) ? low : -1;
}

static relume_status pair_one(struct pairing *p, int i, const struct key *keys, int n,
                              enum tier tier, struct arena *arena)
{
    const char *text = make_key(arena, p->photograph[i], tier, false);
    if (!text)
        return RELUME_ENOMEM;
    const int k = *text ? find_key(keys, n, text) : -1;
    if (k < 0 || p->used[keys[k].light])
        return RELUME_OK;
    p->order[i] = keys[k].light;
    p->matched++;
    for (int same = k; same < n && !strcmp(keys[same].text, text); same++) {
        p->used[keys[same].light] = true;
        if (same > k && p->twice[0] < 0) {
            p->twice[0] = keys[k].light;
            p->twice[1] = keys[same].light;
            p->of_photograph = i;
        }
    }
    return RELUME_OK;
}

static relume_status pair_tier(struct pairing *p, enum tier tier)
{
    struct arena arena = {0};
    struct key *keys = arena_array(&arena, (size_t)p->list->count, sizeof *keys);
    relume_status status = keys ? RELUME_OK : RELUME_ENOMEM;
    int n = 0;
    for (int i = 0; !status && i < p->list->count; i++) {
        if (p->used[i])
            continue;
        keys[n] = (struct key){make_key(&arena, p->list->name[i], tier, true), i};
        if (!keys[n++].text)
            status = RELUME_ENOMEM;
    }
    if (!status)
        qsort(keys, (size_t)n, sizeof *keys, by_text);
    for (int i = 0; !status && i < p->photographs; i++)
        if (p->order[i] < 0)
            status = pair_one(p, i, keys, n, tier, &arena);
    arena_free(&arena);
    return status;
}

static int line_of(const struct light_names *list, int light)
{
    return list->line ? list->line[light] : light + 1;
}

static relume_status refuse_twice(const struct pairing *p, const struct relume_log *log)
{
    const char *never = NULL;
    for (int i = 0; !never && i < p->photographs; i++)
        if (p->order[i] < 0)
            never = light_names_base(p->photograph[i]);
    return log_fail(log, RELUME_EUNFIT,
                    "%s: '%s' is listed in %s %d and %d%s%s%s; expected each once", p->list->path,
                    light_names_base(p->photograph[p->of_photograph]),
                    p->list->line ? "lines" : "lights", line_of(p->list, p->twice[0]),
                    line_of(p->list, p->twice[1]), never ? "; '" : "", never ? never : "",
                    never ? "' is never listed" : "");
}

// An index whose photographs have other names gives the order, which must be that of the lines.
static relume_status check_index(const struct light_names *list, const struct relume_log *log)
{
    for (int i = 1; i < list->count; i++)
        if (!(strtod(list->name[i], NULL) > strtod(list->name[i - 1], NULL)))
            return log_fail(log, RELUME_EUNFIT,
                            "%s: %s %d has the index %s after %s; expected rising ones, or names "
                            "of photographs",
                            list->path, list->line ? "line" : "light", line_of(list, i),
                            list->name[i], list->name[i - 1]);
    return RELUME_OK;
}

relume_status light_names_pair(int *order, int *matched, const struct light_names *list,
                               const char *const *photograph, int photographs,
                               const struct relume_log *log)
{
    struct pairing p = {list, photograph, photographs, 0, order, NULL, {-1, -1}, 0};
    *matched = 0;
    for (int i = 0; i < photographs; i++)
        order[i] = -1;
    if (!list->name)
        return RELUME_OK;
    if (!(p.used = mem_zeroed((size_t)list->count, sizeof *p.used)))
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (enum tier t = 0; !status && t < TIERS && p.matched < photographs; t++)
        status = pair_tier(&p, t);
    const bool index = list->numbered && p.matched < photographs && p.matched < list->count;
    if (!status && index)
        status = check_index(list, log);
    else if (!status && p.twice[0] >= 0)
        status = refuse_twice(&p, log);
    mem_free(p.used);
    *matched = status || index ? 0 : p.matched;
    return status;
}

relume_status light_names_pair_all(int *order, int *matched, const struct light_names *list,
                                   const char *const *photograph, int photographs,
                                   const struct relume_log *log)
{
    const relume_status status =
        light_names_pair(order, matched, list, photograph, photographs, log);
    const bool named = list->name && !list->numbered;
    if (status || *matched)
        return status;
    if (list->count != photographs)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: %d light%s; expected %d, one for each photograph%s", list->path,
                        list->count, relume_plural(list->count), photographs,
                        named ? ", or their names" : "");
    for (int i = 0; i < photographs; i++)
        order[i] = i;
    if (named)
        log_line(log, RELUME_WARNING,
                 "%s: none of the listed images exists ('%.60s'); its lights are taken in the "
                 "order of its lines",
                 list->path, light_names_base(list->name[0]));
    return RELUME_OK;
}

// ---------------------------------------------------------------- sentences

struct sample {
    char text[160];
    int count;
};

static void add_name(struct sample *s, const char *name)
{
    const size_t n = strlen(s->text);
    if (s->count++ < 2)
        snprintf(s->text + n, sizeof s->text - n, "%s'%.60s'", n ? ", " : "",
                 light_names_base(name));
}

static const char *end_names(struct sample *s)
{
    const size_t n = strlen(s->text);
    if (s->count > 2)
        snprintf(s->text + n, sizeof s->text - n, " and %d more", s->count - 2);
    return s->text;
}

relume_status light_names_refuse(const struct light_names *list, const int *order,
                                 const char *const *photograph, int photographs, const char *advice,
                                 const struct relume_log *log)
{
    struct sample without = {0}, unused = {0};
    bool *used = mem_zeroed((size_t)list->count, sizeof *used);
    if (!used)
        return RELUME_ENOMEM;
    for (int i = 0; i < photographs; i++) {
        if (order[i] < 0)
            add_name(&without, photograph[i]);
        else
            used[order[i]] = true;
    }
    for (int i = 0; i < list->count; i++)
        if (!used[i])
            add_name(&unused, list->name[i]);
    mem_free(used);
    return log_fail(log, RELUME_EUNFIT, "%s: names no light for %s%s%s%s%s", list->path,
                    without.count ? end_names(&without) : "no photograph",
                    unused.count ? ", and no photograph is " : "",
                    unused.count ? end_names(&unused) : "", *advice ? "; " : "", advice);
}
