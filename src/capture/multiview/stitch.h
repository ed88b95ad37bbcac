// stitch.h - which way photographs of one viewpoint looked, found by OpenCV
//
// OpenCV brings many shared libraries, so the C++ that knows it (stitch.cpp) is a module of its
// own, librelume-stitch.so, which is built where OpenCV is and opened when it is asked for.
#ifndef MULTIVIEW_STITCH_H
#define MULTIVIEW_STITCH_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// A picture for finding features: 8 bits, grey.
struct stitch_picture {
    int width, height;
    const uint8_t *grey;
};

// A camera without lens distortion: pixels of its picture, the middle of the upper left one at 0,
// 0.
struct stitch_pose {
    double focal, center[2];
    double rotation[9];  // row by row: the camera's x (right), y (down), z (ahead) -> the world's
                         // x, y, z
};

// Up and ahead of the world are those of the cameras together; `*stray` is the first picture that
// overlaps none of the others, or -1. RELUME_EUNFIT with a text in why[300].
typedef relume_status stitch_function(struct stitch_pose *poses, int *stray, char *why,
                                      const struct stitch_picture *pictures, int n);

struct stitch_bridge {
    const char *version;  // RELUME_VERSION of its build; another one's is not used
    stitch_function *find;
};

// The same, through the module. RELUME_EIO where it cannot be loaded; the log has heard why.
relume_status stitch_find(struct stitch_pose *poses, int *stray, char *why,
                          const struct stitch_picture *pictures, int n,
                          const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
