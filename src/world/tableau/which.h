// which.h - what a ray of a scene hits
#ifndef TABLEAU_WHICH_H
#define TABLEAU_WHICH_H

#include <relume/world/tableau.h>

// Which entity each pixel shows, one channel: its number in relume_tableau_info, -1 for none. Of
// captures, background is none. `*out` is created. Errors as above.
relume_status relume_tableau_which(struct relume_image *out, relume_tableau *tableau,
                                   const struct relume_camera *camera);

#endif
