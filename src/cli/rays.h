// rays.h - a list of rays
#ifndef CLI_RAYS_H
#define CLI_RAYS_H

#include <relume/extensions.h>

// One ray a line, eye and direction, six numbers with spaces or commas between them; empty lines
// and what follows a # are passed over. "-" is stdin. `*out` from malloc. An input status with a
// sentence that names the line, RELUME_ENOMEM.
relume_status rays_read(struct relume_ray **out, int *count, const char *path,
                        const struct relume_log *log);

#endif
