// glare_pattern.h - an eye's pattern as pictures and diagrams (`relume glare --psf`)
#ifndef CLI_GLARE_PATTERN_H
#define CLI_GLARE_PATTERN_H

#include "cli/glare_options.h"

// `path` with an extension: the pattern alone; else a folder with psf.exr, psf.png, aperture.png,
// pupil.svg (Fig. 8.3) and observer.svg (against the CIE's), both as .png too.
relume_status save_pattern(struct viewer_eye *eye, const struct args *args, const char *path);

#endif
