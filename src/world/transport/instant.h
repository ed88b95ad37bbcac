// instant.h - light gathered from virtual lights (Keller 1997, "Instant radiosity"): what ways that
// differ in how they look for shadows share
#ifndef TRANSPORT_INSTANT_H
#define TRANSPORT_INSTANT_H

#include "world/transport/maps.h"
#include "world/transport/virtual.h"

enum { INSTANT_SAMPLES = 16, INSTANT_PATTERN = 8 };

struct instant_params {
    int pattern;    // of the way
    bool rays;      // shadows by exact rays; else by imperfect shadow maps
    int size;       // of each map: a power of two up to 256; 0: the largest that fits the memory
    size_t points;  // of the scene in each map, and of the objects; 0: as its size asks for
    bool unfilled;  // holes of maps are left
};
enum instant_stage {
    INSTANT_LIGHTS,
    INSTANT_POINTS,
    INSTANT_MAPS,
    INSTANT_OBJECTS,
    INSTANT_STAGES
};

struct instant {
    struct instant_params params;
    struct points scene, objects;
    struct virtual_light *light;  // those of the scene, and behind them those of the objects
    size_t lights, on_scene;
    float *reach[4];  // [lights + more]: their places, and how near a site takes each, squared
    struct maps of_scene, of_objects;  // [lights]: what hides them
    double seconds[INSTANT_STAGES];    // of processor time
};

// World.samples are virtual lights of the scene at each site, of which pattern x pattern sites have
// different ones; a quarter as many more are on the objects. RELUME_ENOMEM, RELUME_ELIMIT with a
// sentence.
relume_status instant_begin(struct world *w, const struct instant_params *p,
                            const struct relume_log *log);
void instant_end(struct world *w);
void instant_gather(const struct world *w, const struct site *site, take_arrival *arrive,
                    void *context);

#endif
