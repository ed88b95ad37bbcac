// windows.h - components and pictures compared by windows of a view
#ifndef ENCODE_WINDOWS_H
#define ENCODE_WINDOWS_H

#include "encode/encode/rate.h"

// How good components (0) and the pictures themselves (1) are about at the target, as rate_merit()
// says it: windows of the middle view are coded by the fast coder at two steps, and a line goes
// through them. Where the coarse step alone shows that one is better by more than `clearly`, they
// are the least of that one and the most of the other. `left_out` is the PSNR at which lights are
// shown then that all others foretell, by what coding left of these; 0 where one is clearly better,
// or the interpolant does not say it. header[2]: bytes beside the planes. An input status,
// RELUME_ENOMEM, RELUME_EIO, RELUME_ESYSTEM.
relume_status windows_compare(double merit[2], double left_out[2],
                              const relume_coder *const coder[2], const relume_capture *capture,
                              const struct rate_target *target, const double header[2],
                              double clearly, const struct relume_project_params *encode);

#endif
