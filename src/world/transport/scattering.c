// scattering.c - Jensen, Marschner, Levoy and Hanrahan 2001, Figure 5: measured of small spots of
// light. Wax is none of theirs: numbers that look like a candle's, whose white is the dipole's.
#include "world/transport/scattering.h"

#include <string.h>

// clang-format off
#define SKIN1 {{0.032f, 0.17f, 0.48f}, {0.74f, 0.88f, 1.01f}, 1.3f}, {0.44f, 0.22f, 0.13f}
const struct scattering_preset scattering_presets[] = {
    {"apple",      {{0.0030f, 0.0034f, 0.046f},  {2.29f, 2.39f, 1.97f},  1.3f}, {0.85f, 0.84f, 0.53f}},
    {"chicken1",   {{0.015f,  0.077f,  0.19f},   {0.15f, 0.21f, 0.38f},  1.3f}, {0.31f, 0.15f, 0.10f}},
    {"chicken2",   {{0.018f,  0.088f,  0.20f},   {0.19f, 0.25f, 0.32f},  1.3f}, {0.32f, 0.16f, 0.10f}},
    {"cream",      {{0.0002f, 0.0028f, 0.0163f}, {7.38f, 5.47f, 3.15f},  1.3f}, {0.98f, 0.90f, 0.73f}},
    {"ketchup",    {{0.061f,  0.97f,   1.45f},   {0.18f, 0.07f, 0.03f},  1.3f}, {0.16f, 0.01f, 0.00f}},
    {"marble",     {{0.0021f, 0.0041f, 0.0071f}, {2.19f, 2.62f, 3.00f},  1.5f}, {0.83f, 0.79f, 0.75f}},
    {"potato",     {{0.0024f, 0.0090f, 0.12f},   {0.68f, 0.70f, 0.55f},  1.3f}, {0.77f, 0.62f, 0.21f}},
    {"skimmilk",   {{0.0014f, 0.0025f, 0.0142f}, {0.70f, 1.22f, 1.90f},  1.3f}, {0.81f, 0.81f, 0.69f}},
    {"skin",       SKIN1},
    {"skin1",      SKIN1},
    {"skin2",      {{0.013f,  0.070f,  0.145f},  {1.09f, 1.59f, 1.79f},  1.3f}, {0.63f, 0.44f, 0.34f}},
    {"spectralon", {{0.0f,    0.0f,    0.0f},    {11.6f, 20.4f, 14.9f},  1.3f}, {1.00f, 1.00f, 1.00f}},
    {"wax",        {{0.0020f, 0.0055f, 0.026f},  {1.00f, 1.10f, 1.20f},  1.4f}, {0.79f, 0.70f, 0.51f}},
    {"wholemilk",  {{0.0011f, 0.0024f, 0.014f},  {2.55f, 3.21f, 3.77f},  1.3f}, {0.91f, 0.88f, 0.76f}},
    {0},
};
// clang-format on

const struct scattering_preset *scattering_find(const char *name)
{
    for (const struct scattering_preset *p = scattering_presets; p->name; p++)
        if (!strcmp(p->name, name))
            return p;
    return NULL;
}
