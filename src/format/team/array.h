// array.h - results that are one array of numbers, as a piece
#ifndef TEAM_ARRAY_H
#define TEAM_ARRAY_H

#include "format/team/share.h"

// Items of a share. Their number may differ from member to member: `begin` of the work sets it.
struct team_array {
    void *items;
    size_t size;  // bytes
};
// A piece is the items alone; one of another size is damaged.
extern const struct team_bytes team_array_bytes;  // of a struct team_array

#endif
