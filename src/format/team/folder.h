// folder.h - a team whose members share pieces by files in a folder
#ifndef TEAM_FOLDER_H
#define TEAM_FOLDER_H

#include <relume/format/team.h>

// Pieces as files in a folder.
typedef struct relume_team_files relume_team_files;
// A team whose pieces are files in the folder `path`, "samples.3of8": read where they are there,
// else made, whoever's they are, and left for the others. The folder is made if need be.
// `about` says in one line what pieces belong together: a piece of others is RELUME_EUNFIT with a
// sentence. With `own_only` a member makes its own piece alone: `share` then returns
// RELUME_ECANCEL unless all pieces are there. Errors: RELUME_EINVAL (member out of range),
// RELUME_ENOMEM.
relume_status relume_team_folder(relume_team_files **out, const char *path, int member, int members,
                                 const char *about, bool own_only, const struct relume_log *log);
// It belongs to the folder. Not close.
const struct relume_team *relume_team_of_folder(const relume_team_files *folder);
// Whether pieces of others were missing in the last `share` of a folder with `own_only`.
bool relume_team_folder_waits(const relume_team_files *folder);
void relume_team_folder_destroy(relume_team_files **folder);

#endif
