// inspect.h - the reflectance function of the pixel under the cursor, as a disc of directions
//
// The disc's middle is light along the pole (from the viewer; in panoramas from above), its rim
// light from the horizon. Colours are what the pixel shows under a light of 1 from there; dots
// stand at the captured directions, filled with what was measured there when the photographs are at
// hand; crosses at the directional lights. Magnified, a part of the disc around the selected light.
#ifndef VIEWER_INSPECT_H
#define VIEWER_INSPECT_H

#include "app/app.h"
#include "relight/view/view.h"
#include "relit/loader.h"

#include <relume/pack.h>

enum { INSPECT_GRID = 48, INSPECT_SIDE = 3 * INSPECT_GRID };

struct inspector {
    const relume_capture *capture;  // the photographs, or NULL
    float *measured;                // [lights][height][width][3] of `measured_view`, linear
    int measured_view;
    const struct relume_pack_info *info;
    struct code_source source;
    const struct relume_codes *codes;  // of `view`, held until another one is looked at
    const relume_slab *grid;           // of a slab, or NULL
    double zoom, at[2];                // 1: the whole disc; the middle of what is shown, -1 to 1
    float *weights;                    // [INSPECT_GRID^2][3][K], zero outside the disc
    float (*constant)[3];              // [INSPECT_GRID^2]
    float *share;                      // [INSPECT_GRID^2]: relume_coder_clamp
    float *coefficient;                // [3][K] of the pixel
    int view, x, y;                    // shown now; view -1: none
    struct relume_image plot;          // display values
    char text[128];
};

// The file that `info` describes, its source and the photographs (of its size; NULL: none) must
// outlive it. RELUME_ENOMEM.
relume_status inspect_create(struct inspector *inspector, const struct relume_pack_info *info,
                             const struct code_source *source, const relume_slab *grid,
                             const relume_capture *capture);
void inspect_destroy(struct inspector *inspector);

// The view and pixel that the frame shows at (x, y); of a slab in the camera nearest to the ray.
bool inspect_pick(int *view, int pixel[2], const struct app *app, const relume_slab *grid, double x,
                  double y);

// Plot the pixel under the app's cursor. False when there is none. An input status, RELUME_ENOMEM.
relume_status inspect_update(struct inspector *inspector, const struct app *app, bool *shown);

// What the pixel of `codes` shows under a light of 1, given basis weights and constants as
// relume_coder_weights has them; linear. `coefficient` holds 3 K values.
void inspect_coefficients(float *coefficient, float colour[3], const struct relume_codes *codes,
                          int x, int y);
void inspect_value(float rgb[3], const struct relume_codes *codes, const float *coefficient,
                   const float colour[3], const float *weights, const float constant[3]);

#endif
