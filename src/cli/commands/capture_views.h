// capture_views.h - relume capture of many viewpoints: slabs, panoramas, depth from views
#ifndef CLI_CAPTURE_VIEWS_H
#define CLI_CAPTURE_VIEWS_H

#include "cli.h"

// Whether an option asks for it.
bool capture_views_asked(const struct args *args);
relume_status capture_views(const struct args *args);

// clang-format off
#define CAPTURE_VIEWS_OPTIONS \
    {"--slab", OPTION_FLAG, NULL, "photographs of a grid of cameras: a light slab", 0, 0}, \
    {"--names", OPTION_TEXT, "PATTERN", \
     "--slab: places in the names, with {row}, {column}, {n}, {u}, {v}, *; default: found", 0, 0}, \
    {"--fill", OPTION_FLAG, NULL, "--slab: a missing camera is filled by the nearest", 0, 0}, \
    {"--turn", OPTION_FLAG, NULL, "--slab: columns run to the left and rows upwards", 0, 0}, \
    {"--keep-order", OPTION_FLAG, NULL, \
     "--slab: keep the order of the names even if the photographs suggest another", 0, 0}, \
    {"--baseline", OPTION_NUMBER, "W", \
     "--slab: world units from the first to the last column of cameras; default 1", 1e-6, 1e6}, \
    {"--baseline-v", OPTION_NUMBER, "H", \
     "--slab: world units from the first to the last row; default: by positions in the names, " \
     "else rows are as far apart as columns", 1e-6, 1e6}, \
    {"--distance", OPTION_NUMBER, "D", \
     "--slab: world units from the cameras to the st plane, default 3; --colmap: units of " \
     "the model", 1e-6, 1e6}, \
    {"--st-z", OPTION_NUMBER, "Z", "--slab: height of the st plane; default 0", -1e6, 1e6}, \
    {"--window", OPTION_NUMBER, "W", "--slab: width of the st window; default 2", 1e-6, 1e6}, \
    {"--focus-disparity", OPTION_NUMBER, "PX", \
     "--slab: pixels by which a point on the st (focus) plane moves from one camera to the next; default 0", -4096, 4096}, \
    {"--colmap", OPTION_TEXT, "DIR", \
     "poses of the photographs (cameras.txt, images.txt): resampled to a slab", 0, 0}, \
    {"--views", OPTION_TEXT, "GxG", "--colmap: grid of cameras to make; default 5x5", 0, 0}, \
    {"--width", OPTION_INT, "N", "--colmap: width of a view; panorama stitch: of the sphere", 1, \
     65536}, \
    {"--bands", OPTION_INT, "N", \
     "panorama stitch: bands of blending, 1 to 10; 1: hard seams; default: by the photographs' size", \
     1, 10}, \
    {"--depth-from-views", OPTION_FLAG, NULL, "estimate the depth of a slab's views", 0, 0}, \
    {"--depth-range", OPTION_TEXT, "A,B", \
     "--depth-from-views: nearest and farthest distance from the camera plane; --depth: distance of white and of black", 0, 0}, \
    {"--panorama", OPTION_TEXT, "P", \
     "cube (six faces), sphere, cylinder, or stitch (overlapping photographs)", 0, 0}, \
    {"--depth", OPTION_TEXT, "FILE", "--panorama: a picture of its depth", 0, 0}
// clang-format on

#endif
