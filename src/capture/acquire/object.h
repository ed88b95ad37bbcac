// object.h - the object in photographs of one scene, found by its relief
#ifndef ACQUIRE_OBJECT_H
#define ACQUIRE_OBJECT_H

#include <relume/capture/ball.h>
#include <relume/image.h>

// Small photographs of one view, each under another light.
struct object_search {
    const struct relume_image *const *small;  // [count], three channels, of one size
    int count;
    double step;                     // a small pixel in pixels of the photographs,
    int width, height;               // which are so large
    const struct relume_ball *ball;  // [balls] that stand in them
    int balls;
};

// The object with a margin, without balls, in pixels of the photographs; width 0: it fills them, or
// (`*relief` is false) nothing in them has relief. RELUME_ENOMEM.
relume_status object_find(struct relume_rect *out, bool *relief,
                          const struct object_search *search);

#endif
