// capture_times.h - exposure times from a file
#ifndef CLI_CAPTURE_TIMES_H
#define CLI_CAPTURE_TIMES_H

#include "cli/cli.h"

// Fills notes[i].time_s from lines "seconds", one for each photograph in order (or for each of
// every so many: brackets that follow each other), or "name seconds"; seconds as 0.5 or 1/2; #
// begins a remark. Aperture and ISO are then taken as constant. An input status with a sentence.
relume_status read_times(const char *path, const struct relume_photographs *list,
                         struct relume_exif *notes, const struct relume_log *log);

#endif
