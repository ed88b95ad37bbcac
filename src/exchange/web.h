// web.h - relight's folders for web viewers: info.json and plane_0.jpg, plane_1.jpg, ...
#ifndef EXCHANGE_WEB_H
#define EXCHANGE_WEB_H

#include "exchange/foreign.h"

// `path` is the folder or its info.json. ptm, hsh, sh, rbf and bilinear in rgb, lrgb, ycc, mrgb and
// mycc, as far as the pairs exist. RELUME_EDATA with a sentence that names the file at fault.
relume_status web_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log);

#endif
