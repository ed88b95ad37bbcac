// way.c - ways of light between objects and scene, as people choose them
#include "app/way.h"

#include <relume/world/transport.h>

#include <stdio.h>
#include <string.h>

int way_count(void)
{
    int n = 0;
    while (relume_transports[n])
        n++;
    return n;
}

const char *way_name(int way)
{
    return relume_transport_name(relume_transports[way]);
}

bool way_gathers(int way)
{
    return relume_transport_samples(relume_transports[way]) > 0;
}

bool way_matters(const struct app *app)
{
    return app->file.between;
}

bool way_is_slow(const struct app *app)
{
    const struct app_state *now = &app->now;
    return app->file.scene || (way_matters(app) && (way_gathers(now->way) || now->ways));
}

void way_compare(struct app *app, enum app_split ways)
{
    struct app_state *now = &app->now;
    if (now->ways == APP_SPLIT_NONE && now->other_way == now->way)
        now->other_way = (now->way + 1) % way_count();
    now->ways = ways;
    if (ways != APP_SPLIT_NONE)
        now->split = APP_SPLIT_NONE;
}

void way_let_go(struct app *app)
{
    if (app->lookers.let_go)
        app->lookers.let_go(app->lookers.user);
}

// ---------------------------------------------------------------- words

static int find_way(const char *name)
{
    for (int i = 0; i < way_count(); i++)
        if (!strcmp(way_name(i), name))
            return i;
    return -1;
}

static void list_words(char expected[WAY_WORDS])
{
    size_t n = (size_t)snprintf(expected, WAY_WORDS,
                                "WAY, beside WAY, difference WAY or alone after transport; WAY is");
    for (int i = 0; i < way_count() && n < WAY_WORDS; i++)
        n += (size_t)snprintf(expected + n, WAY_WORDS - n, "%s%s",
                              i == 0                     ? " "
                              : relume_transports[i + 1] ? ", "
                                                         : " or ",
                              way_name(i));
}

bool way_say(struct app *app, const char *words, char expected[WAY_WORDS])
{
    char first[32] = "", second[32] = "", more[2] = "";
    const int n = sscanf(words, " %31s %31s %1s", first, second, more);
    const bool beside = !strcmp(first, "beside"), apart = !strcmp(first, "difference");
    const bool both = beside || apart, alone = !strcmp(first, "alone");
    const int way = find_way(both ? second : first);
    list_words(expected);
    if (n != (both ? 2 : 1) || (way < 0 && !alone))
        return false;
    if (!way_matters(app)) {
        snprintf(expected, WAY_WORDS,
                 "objects in a scene to send light between; see --objects, or a scene file");
        return false;
    }
    if (alone) {
        way_compare(app, APP_SPLIT_NONE);
    } else if (both) {
        way_compare(app, beside ? APP_SPLIT_SIDES : APP_SPLIT_DIFFERENCE);
        app->now.other_way = way;
    } else {
        app->now.way = way;
    }
    return true;
}
