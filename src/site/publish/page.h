// page.h - the pages of a site
#ifndef PUBLISH_PAGE_H
#define PUBLISH_PAGE_H

#include "site/publish/details.h"
#include "site/publish/site.h"

// What a page says of a file.
struct page {
    const char *name;  // of it and its folder
    struct details details;
    int poster_width, poster_height;
    bool object;  // it is a baked object, which has a script of its own
};

// NAME.html; `site_title` is what its way back is called.
relume_status page_write(const struct site *site, const struct page *page, const char *site_title);
// index.html, of all of them.
relume_status page_write_index(const struct site *site, const struct page *pages, int count,
                               const struct details *details);
// open.html, onto which people drop a file of their own.
relume_status page_write_open(const struct site *site);

#endif
