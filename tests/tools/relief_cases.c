// relief_cases.c - lowest lights of a side as the library finds them, one case in JSON a line, for
// a script that compares the page's (web/raking.js)
#include <relume/relight/relief.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { CASES = 400, MOST = 70 };

static double uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

// Rings of lights, spread ones, and few, in turn; directions are rounded as in scene.json.
static int make_lights(struct relume_vec3 *d, int number, uint32_t *state)
{
    const bool rings = number % 3 == 0;
    const int n = number % 3 == 2 ? 1 + number % 5 : 12 + (int)(uniform(state) * (MOST - 12));
    for (int i = 0; i < n; i++) {
        const double a = rings ? i % 12 * M_PI / 6 : 2 * M_PI * uniform(state);
        const double e = rings ? (15 + 20 * (i / 12) % 80) * M_PI / 180 : acos(uniform(state));
        d[i] = (struct relume_vec3){cos(e) * cos(a), cos(e) * sin(a), sin(e)};
    }
    return n;
}

int main(void)
{
    uint32_t state = 11;
    for (int number = 0; number < CASES; number++) {
        struct relume_vec3 d[MOST];
        int light[MOST] = {0};
        const struct relume_relief relief = {make_lights(d, number, &state), light, d};
        const double a = number % 2 ? 2 * M_PI * uniform(&state) : number * M_PI / 12;
        const struct relume_vec3 side = {cos(a), sin(a), number % 7 ? uniform(&state) : 20};
        const int first = relume_relief_lowest(&relief, side, -1);
        printf("{\"directions\":[");
        for (int i = 0; i < relief.count; i++)
            printf("%s[%.9g,%.9g,%.9g]", i ? "," : "", d[i].x, d[i].y, d[i].z);
        printf("],\"side\":[%.17g,%.17g,%.17g],\"first\":%d,\"next\":%d}\n", side.x, side.y, side.z,
               first, relume_relief_lowest(&relief, side, first));
    }
    return 0;
}
